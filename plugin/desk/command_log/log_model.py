"""The log as a tree: a row for each command, newest on top, and beneath it a row for each step."""

from __future__ import annotations

import bisect
from collections.abc import Iterable

from qgis.PyQt.QtCore import QAbstractItemModel, QModelIndex, QObject, Qt
from qgis.PyQt.QtGui import QFont

from ....robot_bridge.messages import CommandReport
from ...language import tr
from ..colours import COMMAND_COLOURS, for_letters
from ..command_book import asked_at
from .entries import Filter, cells, step_cells

COLUMNS = (tr("Time"), tr("Command"), tr("State"), tr("Details"))
STATE = 2
COMMAND_ROLE = Qt.ItemDataRole.UserRole


class LogModel(QAbstractItemModel):
    """Lists what ``filter`` keeps. Of a step, the index holds the number of its command."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._filter = Filter()
        self._shown: list[CommandReport] = []
        self._numbers: dict[str, int] = {}
        self._by_number: dict[int, str] = {}
        self._rows: dict[str, int] = {}
        self._bold = QFont()
        self._bold.setPointSizeF(max(7.0, self._bold.pointSizeF() - 1.0))
        self._bold.setBold(True)

    # --- what Qt asks ---

    def index(self, row: int, column: int, parent: QModelIndex | None = None) -> QModelIndex:
        if not self.hasIndex(row, column, parent or QModelIndex()):
            return QModelIndex()
        if parent is None or not parent.isValid():
            return self.createIndex(row, column, 0)
        return self.createIndex(row, column, self._number(self._shown[parent.row()].command))

    def parent(self, index: QModelIndex | None = None) -> QModelIndex:
        if index is None or not index.isValid() or index.internalId() == 0:
            return QModelIndex()
        row = self._rows.get(self._by_number.get(int(index.internalId()), ""))
        return QModelIndex() if row is None else self.createIndex(row, 0, 0)

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        if parent is None or not parent.isValid():
            return len(self._shown)
        is_command = parent.internalId() == 0 and parent.column() == 0
        return len(self._shown[parent.row()].steps) if is_command else 0

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return COLUMNS[section]
        return None

    def data(self, index: QModelIndex, role: int = 0) -> object:
        report = self.report_at(index)
        if report is None:
            return None
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            return self._cells(index, report)[index.column()]
        if role == COMMAND_ROLE:
            return report.command
        if index.column() == STATE and role in (Qt.ItemDataRole.ForegroundRole, Qt.ItemDataRole.FontRole):
            state = report.state if index.internalId() == 0 else report.steps[index.row()].state
            if state not in COMMAND_COLOURS:
                return None
            return self._bold if role == Qt.ItemDataRole.FontRole else for_letters(COMMAND_COLOURS[state])
        return None

    # --- what it shows ---

    @property
    def filter(self) -> Filter:
        """What is listed."""
        return self._filter

    @property
    def shown(self) -> list[CommandReport]:
        """The commands that are listed, newest first."""
        return self._shown

    def show_all(self, reports: Iterable[CommandReport], filter: Filter) -> None:
        """Show those of ``reports`` that the filter keeps, and no others."""
        self.beginResetModel()
        self._filter = filter
        kept = [report for report in reports if filter.keeps(report)]
        # Of one time those that were told last come first.
        kept.sort(key=asked_at)
        self._shown = kept[::-1]
        # No index outlives this, so no number is needed any more: they would add up over a shift.
        self._numbers.clear()
        self._by_number.clear()
        self._count()
        self.endResetModel()

    def merge(self, reports: Iterable[CommandReport]) -> list[str]:
        """Take in new reports and return the commands that were not listed before."""
        added = []
        for report in reports:
            row = self._rows.get(report.command)
            if row is None:
                if self._filter.keeps(report):
                    self._insert(report)
                    added.append(report.command)
            elif self._filter.keeps(report):
                self._renew(row, report)
            else:
                self._remove(row)
        return added

    def report_at(self, index: QModelIndex) -> CommandReport | None:
        """Return the command of a row, be it its own or that of a step."""
        if not index.isValid():
            return None
        row = index.row() if index.internalId() == 0 else self.parent(index).row()
        return self._shown[row] if 0 <= row < len(self._shown) else None

    def row_of(self, command: str) -> int | None:
        """Return the row of a command, None where it is not listed."""
        return self._rows.get(command)

    def _insert(self, report: CommandReport) -> None:
        # Newest first, and of one time those that were told last.
        row = bisect.bisect_left(self._shown, -asked_at(report), key=lambda known: -asked_at(known))
        self.beginInsertRows(QModelIndex(), row, row)
        self._shown.insert(row, report)
        self._count()
        self.endInsertRows()

    def _renew(self, row: int, report: CommandReport) -> None:
        before = len(self._shown[row].steps)
        more = len(report.steps) - before
        top = self.index(row, 0)
        if more > 0:
            self.beginInsertRows(top, before, before + more - 1)
        self._shown[row] = report
        if more > 0:
            self.endInsertRows()
        self.dataChanged.emit(top, self.index(row, len(COLUMNS) - 1))

    def _remove(self, row: int) -> None:
        self.beginRemoveRows(QModelIndex(), row, row)
        del self._shown[row]
        self._count()
        self.endRemoveRows()

    def _count(self) -> None:
        self._rows = {report.command: row for row, report in enumerate(self._shown)}

    def _number(self, command: str) -> int:
        number = self._numbers.get(command)
        if number is None:
            number = self._numbers[command] = len(self._numbers) + 1
            self._by_number[number] = command
        return number

    def _cells(self, index: QModelIndex, report: CommandReport) -> tuple[str, str, str, str]:
        return cells(report) if index.internalId() == 0 else step_cells(report.steps[index.row()], report)
