"""The table of the robots that may take part: which, how many cones they carry, how fast, how far."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView, QTableView, QWidget

from ...language import tr
from ..desk import Desk
from .available_robots import available
from .plan_settings import PlanSettings
from .robots_model import RobotsModel

SHOWN = 6
"""Rows that are shown without scrolling."""
WIDEST = ("", "100", "100", "0.05", "10000")
"""What each column has room for, if its head needs less."""
BESIDE_TEXT = 10
"""Pixels at the edges of a cell."""


class RobotsForm(QTableView):
    """A row for each robot that was heard of; a range of 0 does not matter."""

    edited = pyqtSignal(str, object)
    """The operator changed a robot: its name and its RobotSettings now."""
    refused = pyqtSignal(str)
    """What was written is no number that a robot can have."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_plan_robots")
        self._model = RobotsModel(self)
        self._model.edited.connect(self.edited)
        self._model.refused.connect(self.refused)
        self.setModel(self._model)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(22)
        self._fit_columns()
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setToolTip(
            tr("Aboard: cones on the robot now. Range: metres of battery, 0 if it does not matter")
        )
        self._fit_height()

    def show_robots(self, desk: Desk, settings: PlanSettings) -> None:
        """Show the robots that ``desk`` knows at this moment, with their settings."""
        robots, rows = desk.picture.arrays(desk.clock()), desk.picture.by_name()
        there = available(robots).tolist()
        count = self._model.rowCount()
        self._model.show_robots([robots.names[row] for row in rows], [there[row] for row in rows], settings)
        if self._model.rowCount() != count:
            self._fit_height()

    def _fit_columns(self) -> None:
        """Give the columns of numbers a width for good: fitted to their contents, a thousand robots would be
        measured at each change of one."""
        heads = self.horizontalHeader()
        heads.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        heads.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        widths = [
            max(heads.sectionSizeHint(column), self.fontMetrics().horizontalAdvance(widest) + BESIDE_TEXT)
            for column, widest in enumerate(WIDEST)
        ]
        for column, width in enumerate(widths):
            heads.resizeSection(column, width)
        self.setMinimumWidth(sum(widths) + 2 * self.frameWidth())

    def _fit_height(self) -> None:
        """Be as high as the rows are, or as many of them as there is room for."""
        row, head = self.verticalHeader().defaultSectionSize(), self.horizontalHeader().sizeHint().height()
        shown = min(max(self._model.rowCount(), 2), SHOWN)
        self.setFixedHeight(head + row * shown + 2 * self.frameWidth() + 2)
