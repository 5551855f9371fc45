"""The table of the robots that may take part: which, how many cones they carry, how fast, how far."""

from __future__ import annotations

from dataclasses import replace
from itertools import zip_longest

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem, QWidget

from ...language import tr
from ..picture import RobotView
from .draft_plan import is_there
from .wanted_job import PlanSettings, RobotSettings

HEADS = (tr("Robot"), tr("Carries"), tr("Aboard"), tr("m/s"), tr("Range"))
SHOWN = 6
"""Rows that are shown without scrolling."""
_FIELDS = ("capacity", "aboard", "speed", "range_m")
_LEAST = {"capacity": 1, "aboard": 0, "speed": 0.05, "range_m": 0.0}
_Row = tuple[str, bool, RobotSettings]
"""A robot's name, whether it is there, and its settings."""


class RobotsForm(QTableWidget):
    """A row for each robot that was heard of; a range of 0 does not matter."""

    changed = pyqtSignal()
    refused = pyqtSignal(str)

    def __init__(self, parent: QWidget | None = None):
        super().__init__(0, len(HEADS), parent)
        self.setObjectName("fleet_plan_robots")
        self.setHorizontalHeaderLabels(HEADS)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(22)
        heads = self.horizontalHeader()
        heads.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        heads.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.setMinimumWidth(sum(map(heads.sectionSizeHint, range(len(HEADS)))) + 2 * self.frameWidth())
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setToolTip(
            tr("Aboard: cones on the robot now. Range: metres of battery, 0 if it does not matter")
        )
        self._rows: tuple[_Row, ...] = ()
        self.itemChanged.connect(self._edited)
        self._fit(0)

    def show_robots(self, views: list[RobotView], settings: PlanSettings) -> None:
        """Show robots with their settings; no row is written anew that is as it was.

        Of a thousand robots some are heard of again at any moment: all rows together take 60 ms.
        """
        rows = tuple((view.name, is_there(view), settings.of_robot(view.name)) for view in views)
        if rows == self._rows:
            return
        known, self._rows = self._rows, rows
        self.blockSignals(True)
        if len(rows) != self.rowCount():
            self.setRowCount(len(rows))
            self._fit(len(rows))
        for number, (row, before) in enumerate(zip_longest(rows, known[: len(rows)])):
            if row != before:
                self._write(number, row)
        self.blockSignals(False)

    def _write(self, number: int, row: _Row) -> None:
        name, there, one = row
        self.setItem(number, 0, _tick(name, one.used, there))
        for column, field in enumerate(_FIELDS, 1):
            item = QTableWidgetItem(f"{getattr(one, field):g}")
            item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            self.setItem(number, column, item)

    def settings(self, of: PlanSettings) -> PlanSettings:
        """Return ``of`` with what stands in the table; a number that is none is told and left as it was."""
        for row, (name, _, known) in enumerate(self._rows):
            ticked = self.item(row, 0).checkState() == Qt.CheckState.Checked
            values = {
                field: self._number(row, column, field, getattr(known, field))
                for column, field in enumerate(_FIELDS, 1)
            }
            of = of.with_robot(name, replace(known, used=ticked, **values))
        return of

    def _fit(self, rows: int) -> None:
        """Be as high as so many rows are, or as many as there is room for."""
        row, head = self.verticalHeader().defaultSectionSize(), self.horizontalHeader().sizeHint().height()
        self.setFixedHeight(head + row * min(max(rows, 2), SHOWN) + 2 * self.frameWidth() + 2)

    def _number(self, row: int, column: int, field: str, otherwise: float) -> float:
        text = self.item(row, column).text().strip().replace(",", ".")
        kind = type(RobotSettings.__dataclass_fields__[field].default)
        try:
            number = kind(text)
            if not _LEAST[field] <= number < 1e7:
                raise ValueError
        except ValueError:
            self.refused.emit(
                tr(
                    "{heads} of {rows} is {text!r}: give {least:g} or more.",
                    heads=HEADS[column],
                    rows=self._rows[row][0],
                    text=text,
                    least=_LEAST[field],
                )
            )
            self._rows = ()
            return otherwise
        return number

    def _edited(self, _: QTableWidgetItem) -> None:
        self.changed.emit()


def _tick(name: str, used: bool, there: bool) -> QTableWidgetItem:
    item = QTableWidgetItem(name)
    item.setFlags(Qt.ItemFlag.ItemIsUserCheckable | Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable)
    item.setCheckState(Qt.CheckState.Checked if used else Qt.CheckState.Unchecked)
    if not there:
        item.setForeground(Qt.GlobalColor.gray)
        item.setToolTip(tr("{name} is away: it takes no part", name=name))
    return item
