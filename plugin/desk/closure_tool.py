"""The map tool that closes roads and opens them again."""

from __future__ import annotations

import math

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtWidgets import QWidget

from ...robot_bridge.messages import ClosureReport
from ...robot_bridge.roads.points import foot_on
from ..errors import FleetError
from ..language import tr
from .closure_dialog import ClosureDialog
from .desk import Desk
from .drafts import Point
from .road_board import time_of_day
from .safe_question import safe_question

REACH = 12.0
"""Pixels by which a click may miss a road."""
LEAST_REACH = 3.0
"""Metres by which it may miss one in any case: a road is wider than its middle."""


class ClosureTool(QgsMapTool):
    """A click on a road asks why and for how long it is closed; a click on a closed one asks to open it."""

    def __init__(self, desk: Desk, window: QWidget):
        super().__init__(desk.canvas)
        self._desk = desk
        self._window = window
        self.setCursor(Qt.CursorShape.CrossCursor)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        try:
            place, reach = self._place(event)
        except FleetError as error:
            self._desk.complained.emit(str(error))
            return
        closed = self._closed_at(place, reach)
        if closed is None:
            self._ask_to_close(place, reach)
        else:
            self._ask_to_open(closed)

    def _place(self, event: QgsMapMouseEvent) -> tuple[Point, float]:
        """Return the place of a click in the site frame, and the metres by which it may miss a road."""
        placement = self._desk.placement()
        place = placement.to_site(event.mapPoint())
        beside = self.toMapCoordinates(event.pos() + QPoint(round(REACH), 0))
        return place, max(math.dist(place, placement.to_site(QgsPointXY(beside))), LEAST_REACH)

    def _closed_at(self, place: Point, reach: float) -> ClosureReport | None:
        found, least = None, reach
        for closure in self._desk.roads.closures:
            line = np.array(closure.line)
            off = float(foot_on(line[:-1], line[1:], np.array(place))[1].min())
            if off <= least:
                found, least = closure, off
        return found

    def _ask_to_close(self, place: Point, reach: float) -> None:
        dialog = ClosureDialog(self._window)
        dialog.confirmed.connect(lambda why, seconds: self._desk.close_road(place, reach, why, seconds))
        dialog.open()

    def _ask_to_open(self, closure: ClosureReport) -> None:
        because = f": {closure.reason}" if closure.reason else ""
        text = tr(
            "{by} closed this road at {time}{because}",
            by=closure.closed_by,
            time=time_of_day(closure.closed_at),
            because=because,
        )
        opening = "fleet_open_road_confirm", tr("Open road")
        box = safe_question(
            self._window, "fleet_open_road", text, opening, tr("Cancel"),
            lambda: self._desk.open_road(closure.closure),
        )  # fmt: skip
        box.setWindowTitle(tr("Open road"))
        box.setInformativeText(tr("Open it again for every robot?"))
        box.open()
