"""Tables: models of rows, widths of columns, lists whose rows have a place on the map, CSV export."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from qgis.PyQt.QtCore import QAbstractTableModel, QEvent, QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView, QStyle, QTableView, QTreeView

from ...robot_bridge.core.files import replacement
from .errors import FleetError
from .language import plain_tip, short_time, tr


class RowModel(QAbstractTableModel):
    """Holds :attr:`rows` under ``heads``; subclasses implement ``data`` for the content of a cell."""

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
        """Show these rows; where they are the same by ``key`` as before, rows keep their selection."""
        if key is not None and [key(row) for row in rows] == [key(row) for row in self.rows]:
            self.rows = rows
            if rows:
                self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, len(self._heads) - 1))
            return
        self.beginResetModel()
        self.rows = rows
        self.endResetModel()


class TextModel(RowModel):
    """Shows for each row the texts of ``cells``, one for each head, and as tool tips too."""

    def __init__(
        self, heads: Sequence[str], cells: Callable[[Any], Sequence[str]], parent: QObject | None = None
    ):
        super().__init__(heads, parent)
        self._cells = cells

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if role not in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            return None
        text = self._cells(self.rows[index.row()])[index.column()]
        return text if role == Qt.ItemDataRole.DisplayRole else plain_tip(text)


def number_of(value: object) -> int:
    """Return the number of a Qt enum's member or flags, which are numbers themselves on Qt 5."""
    return int(getattr(value, "value", value))  # type: ignore[call-overload]


TO_THE_RIGHT = number_of(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
CHECKED = number_of(Qt.CheckState.Checked)
UNCHECKED = number_of(Qt.CheckState.Unchecked)


LOWEST = 44
"""Height in pixels of a table on a low screen: its head and a row or two."""


def shrink_view(view: QAbstractItemView) -> None:
    """Use a smaller font for cells and headers of a table in a narrow panel, and allow a low height."""
    view.setMinimumHeight(LOWEST)
    font = view.font()
    font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
    view.setFont(font)
    headers = [view.header()] if isinstance(view, QTreeView) else []
    if isinstance(view, QTableView):
        headers += [view.horizontalHeader(), view.verticalHeader()]
    for header in headers:
        header.setFont(font)


EDGES = 4
"""Pixels beside a head's words."""


def fit_headers(view: QTableView | QTreeView) -> None:
    """Widen each column whose head would be cut off, now and when it gets the sort indicator.

    None becomes narrower. The heads of ``view`` must have their font and their columns' first widths already.
    """
    header = _heads(view)
    widen_headers(view)
    # No function that holds the header itself: nothing else in Python would, so that Python collected
    # both, and the next click on a head crashed QGIS.
    header.sortIndicatorChanged.connect(lambda column, _order: _fit(_heads(view), column))


def widen_headers(view: QTableView | QTreeView) -> None:
    """Widen each column whose head would be cut off in its present font."""
    header = _heads(view)
    for column in range(header.count()):
        _fit(header, column)


def _heads(view: QTableView | QTreeView) -> QHeaderView:
    return view.header() if isinstance(view, QTreeView) else view.horizontalHeader()


def _fit(header: QHeaderView, column: int) -> None:
    if column < 0 or header.isSectionHidden(column):
        return
    head = header.model().headerData(column, Qt.Orientation.Horizontal, Qt.ItemDataRole.DisplayRole)
    width_needed = header.fontMetrics().horizontalAdvance(str(head or "")) + 2 * EDGES
    if header.isSortIndicatorShown() and header.sortIndicatorSection() == column:
        width_needed += header.style().pixelMetric(QStyle.PixelMetric.PM_HeaderMarkSize, None, header)
    header.resizeSection(column, max(header.sectionSize(column), width_needed))


TODAY = "00:00:00"


class TimeColumn:
    """The first column of ``view``, with ``beside`` pixels around a time; a width set by the user stays."""

    def __init__(self, view: QTableView | QTreeView, beside: int):
        self._view, self._beside = view, beside
        self._letters = 0
        self.make_room(None)

    def make_room(self, oldest: float | None) -> None:
        """Fit the width for times from ``oldest`` on, seconds since 1970: another day's have their date."""
        widest = max(TODAY, short_time(oldest), key=len)
        if len(widest) != self._letters:
            self._letters = len(widest)
            self._view.setColumnWidth(0, self._view.fontMetrics().horizontalAdvance(widest) + self._beside)


ENTER = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
ALONE = (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)


class ZoomMenu(QObject):
    """Signals a row of ``view`` at a double click on it, and at Enter for the selected one."""

    requested = pyqtSignal(QModelIndex)

    def __init__(self, view: QAbstractItemView):
        super().__init__(view)
        self._view = view
        view.doubleClicked.connect(self.requested)
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() != QEvent.Type.KeyPress or event.key() not in ENTER:
            return False
        if event.modifiers() not in ALONE:
            return False
        selection, index = self._view.selectionModel(), self._view.currentIndex()
        if not selection.isSelected(index):
            # A view that is updated all the time may have selected rows and no current one.
            index = next(iter(selection.selectedRows()), QModelIndex())
        if index.isValid():
            self.requested.emit(index)
        return True


_FORMULA = ("=", "+", "-", "@", "\t", "\r")


class CsvError(FleetError):
    """A table was not written."""


def write_csv(path: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> int:
    """Write a table as UTF-8 with a BOM for spreadsheets, and return the number of its rows.

    An older file is only replaced when the new one is complete.

    :raises CsvError: when the file cannot be written.
    """
    text = io.StringIO(newline="")
    table = csv.writer(text)
    table.writerow(head)
    count = 0
    for row in rows:
        table.writerow([_cell(value) for value in row])
        count += 1
    target = Path(path)
    try:
        with replacement(target) as part:
            part.write_text(text.getvalue(), encoding="utf-8-sig", newline="")
    except OSError as error:
        raise CsvError(
            tr(
                "{file} was not written ({why}). Choose another folder, or close the file where it is open.",
                file=target,
                why=error.strerror or error,
            )
        ) from error
    return count


def iso_time(at: float | None) -> str:
    """Return a time since 1970 as ISO 8601 in the computer's time zone; empty for None."""
    if at is None:
        return ""
    return datetime.fromtimestamp(at).astimezone().isoformat(timespec="milliseconds")


def _cell(value: object) -> object:
    # A spreadsheet would run a text such as =cmd() received from the network.
    if isinstance(value, str) and value.startswith(_FORMULA):
        return f"'{value}"
    return "" if value is None else value
