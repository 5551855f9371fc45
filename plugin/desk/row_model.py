"""A table with one row for each thing that it is given."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from qgis.PyQt.QtCore import QAbstractTableModel, QModelIndex, QObject, Qt


class RowModel(QAbstractTableModel):
    """Holds :attr:`rows` under ``heads``; what a cell shows is for ``data`` of whoever derives from it."""

    def __init__(self, heads: Sequence[str], parent: QObject | None = None):
        super().__init__(parent)
        self._heads = heads
        self.rows: list[Any] = []

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.rows)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._heads)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return self._heads[section]
        return None

    def show_rows(self, rows: list[Any], key: Callable[[Any], object] | None = None) -> None:
        """Show these; where they are the same by ``key`` as before, rows keep their selection."""
        if key is not None and [key(row) for row in rows] == [key(row) for row in self.rows]:
            self.rows = rows
            if rows:
                self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, len(self._heads) - 1))
            return
        self.beginResetModel()
        self.rows = rows
        self.endResetModel()


class TextModel(RowModel):
    """Shows of each row the texts that ``cells`` makes of it, one for each head, and as tips too."""

    def __init__(
        self, heads: Sequence[str], cells: Callable[[Any], Sequence[str]], parent: QObject | None = None
    ):
        super().__init__(heads, parent)
        self._cells = cells

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            return self._cells(self.rows[index.row()])[index.column()]
        return None
