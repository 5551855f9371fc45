"""The way along the roads to where the mouse is, drawn on the canvas with its length, time and surfaces."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsPointXY, QgsWkbTypes
from qgis.gui import QgsMapMouseEvent, QgsRubberBand
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtGui import QColor, QCursor
from qgis.PyQt.QtWidgets import QToolTip

from ...robot_bridge.messages import RouteReport
from ..errors import FleetError, NotSentError, PlacementError
from .desk import Desk
from .drafts import Point
from .route_preview import Question, in_words
from .way_wishes import SHORTEST, WayWishes

ALONG, STRAIGHT = QColor("#1e88e5"), QColor("#c62828")
BESIDE = QPoint(16, 16)
"""Pixels from the mouse to what is said of the way."""


class WayToMouse:
    """What a map tool shows while the mouse moves. Without a robot, or a link, nothing is shown."""

    def __init__(self, desk: Desk):
        self._desk = desk
        self._band: QgsRubberBand | None = None
        self._mouse: QPoint | None = None
        desk.preview.shown.connect(self._show)
        desk.selection_changed.connect(self.hide)

    def lead_to(
        self,
        event: QgsMapMouseEvent,
        robot: str | None,
        start: Point | None,
        wishes: WayWishes = SHORTEST,
    ) -> None:
        """Have the way shown from ``start``, or from where the robot is, to where the mouse is."""
        self._mouse = QCursor.pos()
        if robot is None:
            return
        try:
            goal = self._desk.placement().to_site(event.mapPoint())
            self._desk.preview.want(Question(robot, start, goal, wishes=wishes))
        except (NotSentError, PlacementError):
            # A click says what is wrong; moving the mouse is no request to be told so.
            self.clear()

    def clear(self) -> None:
        """Show nothing and ask nothing, until the mouse moves again."""
        self.hide()
        self._desk.preview.forget()

    @property
    def line(self) -> list[QgsPointXY]:
        """What is drawn now, in the canvas's CRS."""
        if self._band is None:
            return []
        return [QgsPointXY(self._band.getPoint(0, k)) for k in range(self._band.numberOfVertices())]

    def hide(self) -> None:
        """Show nothing until the mouse moves again; what was asked is still answered."""
        if self._mouse is not None:
            QToolTip.hideText()
        self._mouse = None
        self._take_away()

    def _take_away(self) -> None:
        if self._band is not None and not sip.isdeleted(self._band):
            self._desk.canvas.scene().removeItem(self._band)
        self._band = None

    def _show(self) -> None:
        self._take_away()
        preview = self._desk.preview
        route = preview.route
        if self._mouse is None:
            return
        text = preview.why_not if route is None else in_words(route, preview.wishes, apart="\n")
        QToolTip.showText(self._mouse + BESIDE, text, self._desk.canvas)
        if route is not None:
            self._draw(route)

    def _draw(self, route: RouteReport) -> None:
        try:
            points = self._desk.placement().to_map(np.array(route.points))
        except FleetError:
            return
        self._band = QgsRubberBand(self._desk.canvas, QgsWkbTypes.GeometryType.LineGeometry)
        self._band.setColor(STRAIGHT if route.note else ALONG)
        self._band.setSecondaryStrokeColor(QColor(255, 255, 255, 200))
        self._band.setWidth(3)
        self._band.setLineStyle(Qt.PenStyle.DashLine)
        for number, (x, y) in enumerate(points.tolist(), 1):
            self._band.addPoint(QgsPointXY(x, y), number == len(points))
