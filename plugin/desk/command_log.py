"""The log of commands: each with its steps beneath it."""

from __future__ import annotations

import time

from qgis.PyQt.QtCore import QModelIndex, Qt
from qgis.PyQt.QtGui import QStandardItem, QStandardItemModel
from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView, QTreeView, QWidget

from ...robot_bridge.messages import Abort, CommandReport, CommandState, CommandStep
from .colours import COMMAND_COLOURS
from .command_book import in_words
from .desk import Desk
from .robot_table import shrink

COLUMNS = ("Time", "Command", "State", "Details")
MOST_ROWS = 200


class CommandLog(QTreeView):
    """Newest command on top; the newest one lies open until the next comes."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_command_log")
        self._model = QStandardItemModel(0, len(COLUMNS), self)
        self._model.setHorizontalHeaderLabels(COLUMNS)
        self._rows: dict[str, QStandardItem] = {}
        self._opened: QStandardItem | None = None
        self.setModel(self._model)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAlternatingRowColors(True)
        self.setUniformRowHeights(True)
        self.setIndentation(14)
        shrink(self)
        for column, widest in enumerate(("00:00:00", "", "acknowledged", "00.00 m off")):
            width = self.fontMetrics().horizontalAdvance(widest)
            self.setColumnWidth(column, width + (2 * self.indentation() + 12 if column == 0 else 12))
        self.header().setStretchLastSection(False)
        self.header().setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)
        desk.commands_changed.connect(self.show_reports)
        desk.site_changed.connect(self._site_changed)
        self._desk = desk

    def show_reports(self, reports: list[CommandReport]) -> None:
        """Add what is new, and bring what is known up to date."""
        for report in reports:
            row = self._rows.get(report.command)
            if row is None:
                row = self._add(report)
            self._write(row, report)
        self._cut()

    def _add(self, report: CommandReport) -> QStandardItem:
        row = QStandardItem()
        row.setData(report.command, Qt.ItemDataRole.UserRole)
        self._model.insertRow(0, [row, *(QStandardItem() for _ in COLUMNS[1:])])
        self._rows[report.command] = row
        if self._opened is not None:
            self.collapse(self._opened.index())
        self._opened = row
        return row

    def _write(self, row: QStandardItem, report: CommandReport) -> None:
        first = report.steps[0].at if report.steps else None
        cells = (
            _clock(first),
            f"{report.robot} · {in_words(report)}",
            report.state.value,
            _details(report),
        )
        for column, text in enumerate(cells):
            self._fill(self._model.item(row.row(), column), text, report.state if column == 2 else None)
        for _ in range(row.rowCount(), len(report.steps)):
            row.appendRow([QStandardItem() for _ in COLUMNS])
        for number, step in enumerate(report.steps):
            for column, text in enumerate(_step_cells(step, report)):
                self._fill(row.child(number, column), text, step.state if column == 2 else None)
        if row is self._opened:
            self.expand(row.index())

    def _fill(self, item: QStandardItem, text: str, state: CommandState | None) -> None:
        item.setText(text)
        item.setToolTip(text)
        if state in COMMAND_COLOURS:
            item.setForeground(COMMAND_COLOURS[state])
            font = item.font()
            font.setBold(True)
            item.setFont(font)

    def _cut(self) -> None:
        while self._model.rowCount() > MOST_ROWS:
            (row, *_) = self._model.takeRow(self._model.rowCount() - 1)
            self._rows.pop(row.data(Qt.ItemDataRole.UserRole), None)

    def _site_changed(self) -> None:
        if len(self._desk.book) == 0:
            self._model.removeRows(0, self._model.rowCount(), QModelIndex())
            self._rows.clear()
            self._opened = None


def _step_cells(step: CommandStep, report: CommandReport) -> tuple[str, str, str, str]:
    off = _off(report) if step.state is CommandState.REACHED else ""
    return _clock(step.at), f"by {step.by}", step.state.value, step.reason or off


def _details(report: CommandReport) -> str:
    reason = report.steps[-1].reason if report.steps else None
    return _off(report) or reason or f"by {report.operator}"


def _off(report: CommandReport) -> str:
    """Return how far from its target a robot stands; an abort has no target."""
    if report.deviation is None or report.op == Abort.__name__:
        return ""
    return f"{report.deviation:.2f} m off"


def _clock(at: float | None) -> str:
    return time.strftime("%H:%M:%S", time.localtime(at)) if at is not None else ""
