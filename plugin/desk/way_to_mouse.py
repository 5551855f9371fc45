"""The way along the roads to where the mouse is, drawn on the canvas with its length, time and surfaces."""

from __future__ import annotations

import math

import numpy as np
from qgis.core import QgsPointXY, QgsWkbTypes
from qgis.gui import QgsMapMouseEvent, QgsRubberBand
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt
from qgis.PyQt.QtGui import QColor, QCursor
from qgis.PyQt.QtWidgets import QToolTip

from ...robot_bridge.messages import RouteReport
from ..errors import FleetError, NotSentError, PlacementError
from .desk import Desk
from .drafts import Point
from .route_preview import Question, in_words
from .way_wishes import SHORTEST, WayWishes

ALONG, STRAIGHT = QColor(21, 101, 192, 210), QColor(198, 40, 40, 210)
CASING = QColor(255, 255, 255, 90)
"""Beneath it: on the asphalt of a photograph the colour alone is lost."""
WIDTH = 2
"""Pixels: thinner, and paler, than any way that a robot drives or is about to be sent."""
BESIDE = QPoint(16, 16)
"""Pixels from the mouse to what is said of the way."""
MOVED_M = 0.5
"""Metres that a robot moves before the way from where it is now is asked for again."""


class WayToMouse(QObject):
    """What a map tool shows while the mouse moves. Without a robot, or a link, nothing is shown.

    It goes when the mouse leaves the map, when another robot is selected or none, when the draft is sent or
    given up, when robots are told to stop, and when the link is lost. While the mouse stands still it follows
    the robot that it begins at.
    """

    def __init__(self, desk: Desk):
        super().__init__(desk)
        self._desk = desk
        self._band: QgsRubberBand | None = None
        self._mouse: QPoint | None = None
        self._question: Question | None = None
        self._begins: Point | None = None
        """Where the way that is shown begins, of one from where a robot is."""
        desk.preview.shown.connect(self._show)
        desk.selection_changed.connect(self.hide)
        desk.pulled.connect(self._follow)

    def lead_to(
        self,
        event: QgsMapMouseEvent,
        robot: str | None,
        start: Point | None,
        wishes: WayWishes = SHORTEST,
    ) -> None:
        """Have the way shown from ``start``, or from where the robot is, to where the mouse is."""
        if self._mouse is None:
            self._desk.canvas.viewport().installEventFilter(self)
        self._mouse = QCursor.pos()
        if robot is None:
            return
        try:
            goal = self._desk.placement().to_site(event.mapPoint())
            self._question = Question(robot, start, goal, wishes=wishes)
            self._desk.preview.want(self._question)
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
            viewport = self._desk.canvas.viewport()
            if not sip.isdeleted(viewport):
                viewport.removeEventFilter(self)
        self._mouse = self._question = self._begins = None
        self._take_away()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Leave:
            self.hide()
        return False

    def _take_away(self) -> None:
        if self._band is not None and not sip.isdeleted(self._band):
            self._desk.canvas.scene().removeItem(self._band)
        self._band = None

    def _follow(self) -> None:
        """Ask again from where the robot is now, when it has moved since it was asked."""
        question = self._question
        if self._band is None or self._begins is None or question is None or question.start is not None:
            return
        view = self._desk.picture.view(question.robot, self._desk.clock())
        if view is None or not view.has_pose:
            return
        if math.dist((view.told["x"], view.told["y"]), self._begins) > MOVED_M:
            try:
                self._desk.preview.want(question)
            except NotSentError:
                self.clear()

    def _show(self) -> None:
        self._take_away()
        preview = self._desk.preview
        route = preview.route
        if self._mouse is None:
            return
        text = preview.why_not if route is None else in_words(route, preview.wishes, apart="\n")
        QToolTip.showText(self._mouse + BESIDE, text, self._desk.canvas)
        if route is not None:
            self._begins = route.points[0]
            self._draw(route)

    def _draw(self, route: RouteReport) -> None:
        try:
            points = self._desk.placement().to_map(np.array(route.points))
        except FleetError:
            return
        self._band = QgsRubberBand(self._desk.canvas, QgsWkbTypes.GeometryType.LineGeometry)
        self._band.setColor(STRAIGHT if route.note else ALONG)
        self._band.setSecondaryStrokeColor(CASING)
        self._band.setWidth(WIDTH)
        self._band.setLineStyle(Qt.PenStyle.DashLine)
        for number, (x, y) in enumerate(points.tolist(), 1):
            self._band.addPoint(QgsPointXY(x, y), number == len(points))
