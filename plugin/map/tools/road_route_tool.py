"""Map tool that draws a route along roads, and the preview of the route to the mouse."""

from __future__ import annotations

import math

import numpy as np
from qgis.core import QgsPointXY, QgsWkbTypes
from qgis.gui import QgsMapMouseEvent, QgsRubberBand
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt
from qgis.PyQt.QtGui import QColor, QCursor
from qgis.PyQt.QtWidgets import QToolTip

from ....robot_bridge.core.messages.roads import RouteReport
from ...control.fleet_controller import FleetController
from ...control.pending_command import ROUTE, PendingCommand, Point
from ...control.roads import SHORTEST, RoutePreferences
from ...control.route_queries import RouteQuestion, route_in_words
from ...ui.errors import FleetError, MapTransformError, NotSentError
from ...ui.language import tr
from .route_tool import RouteTool

ALONG, STRAIGHT = QColor(21, 101, 192, 210), QColor(198, 40, 40, 210)
CASING = QColor(255, 255, 255, 90)
"""Beneath it: on the asphalt of a photograph the colour alone is lost."""
WIDTH = 2
"""Pixels: thinner, and paler, than any way that a robot drives or is about to be sent."""
BESIDE = QPoint(16, 16)
"""Pixels from the mouse to what is said of the way."""
MOVED_M = 0.5
"""Metres that a robot moves before the way from where it is now is asked for again."""


class RoutePreview(QObject):
    """What a map tool shows while the mouse moves. Without a robot, or a link, nothing is shown.

    It goes when the mouse leaves the map, when another robot is selected or none, when the draft is sent or
    given up, when robots are told to stop, and when the link is lost. While the mouse stands still it follows
    the robot that it begins at.
    """

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._desk = desk
        self._band: QgsRubberBand | None = None
        self._mouse: QPoint | None = None
        self._question: RouteQuestion | None = None
        self._begins: Point | None = None
        """Where the way that is shown begins, of one from where a robot is."""
        desk.preview.shown.connect(self._show)
        desk.selection.changed.connect(self.hide)
        desk.state.updated.connect(self._follow)

    def lead_to(
        self,
        event: QgsMapMouseEvent,
        robot: str | None,
        start: Point | None,
        wishes: RoutePreferences = SHORTEST,
    ) -> None:
        """Have the way shown from ``start``, or from where the robot is, to where the mouse is."""
        if self._mouse is None:
            self._desk.canvas.viewport().installEventFilter(self)
        self._mouse = QCursor.pos()
        if robot is None:
            return
        try:
            goal = self._desk.site_to_canvas.transform().to_site(event.mapPoint())
            self._question = RouteQuestion(robot, start, goal, wishes=wishes)
            self._desk.preview.want(self._question)
        except (NotSentError, MapTransformError):
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
        view = self._desk.state.robots.view(question.robot, self._desk.clock.steady())
        if view is None or not view.has_pose:
            return
        if math.dist((view.values["x"], view.values["y"]), self._begins) > MOVED_M:
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
        text = preview.why_not if route is None else route_in_words(route, preview.wishes, apart="\n")
        QToolTip.showText(self._mouse + BESIDE, text, self._desk.canvas)
        if route is not None:
            self._begins = route.points[0]
            self._draw(route)

    def _draw(self, route: RouteReport) -> None:
        try:
            points = self._desk.site_to_canvas.transform().to_map(np.array(route.points))
        except FleetError:
            return
        self._band = QgsRubberBand(self._desk.canvas, QgsWkbTypes.GeometryType.LineGeometry)
        self._band.setColor(STRAIGHT if route.note else ALONG)
        self._band.setSecondaryStrokeColor(CASING)
        self._band.setWidth(WIDTH)
        self._band.setLineStyle(Qt.PenStyle.DashLine)
        for number, (x, y) in enumerate(points.tolist(), 1):
            self._band.addPoint(QgsPointXY(x, y), number == len(points))


class RoadRouteTool(RouteTool):
    """The way along the roads follows the mouse; a click takes it, and the next leg goes on from there.

    The first leg begins where the robot is. Legs of this tool and of the one that draws can be mixed. Who
    clicks faster than the gateway answers gets the legs one after the other.
    """

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._way = RoutePreview(desk)
        self.wishes = SHORTEST
        """What is wanted of the legs that are led from now on."""
        self._clicks: list[Point] = []
        """Where ways are still to lead; the first of them is asked for."""
        desk.preview.answered.connect(self._take)
        desk.preview.refused.connect(self._refused)

    def lead_so(self, wishes: RoutePreferences) -> None:
        """Lead legs by ``wishes`` from now on; what is shown to the mouse is asked for again."""
        self.wishes = wishes
        self._way.clear()

    def deactivate(self) -> None:
        self._clicks.clear()
        self._way.clear()
        super().deactivate()

    def hovered(self, event: QgsMapMouseEvent) -> None:
        if self._is_finished:
            return
        robot, start = self._from()
        self._way.lead_to(event, robot, start, self.wishes)

    def finish(self) -> None:
        if self._clicks:
            # The ways to what was clicked are still to come, and belong to the route.
            self._is_finished = True
        else:
            super().finish()
        if self._is_finished:
            self._way.hide()

    def clicked(self, point: Point) -> None:
        self._is_finished = False
        draft = self.draft
        if draft is not None and not self.is_for_selected(draft):
            return
        if not self.desk.preview.awaits_click:
            # What was clicked before was given up, or its answer is lost.
            self._clicks.clear()
        self._clicks.append(point)
        if len(self._clicks) == 1:
            self._lead_on()

    def back(self) -> None:
        if not self._clicks:
            super().back()
            return
        self._clicks.pop()
        if not self._clicks:
            self._way.clear()

    def _changed(self) -> None:
        super()._changed()
        if self._clicks and self.desk.drafts.draft is None:
            self._leave_out()

    def _refused(self) -> None:
        self._clicks.clear()
        if self.draft is None:
            self._is_finished = False

    def _lead_on(self) -> None:
        robot, start = self._from()
        question = RouteQuestion(robot, start, self._clicks[0], taken=True, wishes=self.wishes)
        try:
            self.desk.preview.want(question)
        except NotSentError:
            self._clicks.clear()
            raise

    def _leave_out(self) -> None:
        """Say that the way to the last click comes too late: the draft was sent, or is another."""
        self._clicks.clear()
        self._way.clear()
        self.desk.complained.emit(
            tr("The way to where you clicked last was not known yet, so it is not in the route.")
        )

    def _from(self) -> tuple[str | None, Point | None]:
        """Return whose the next leg is, and where it begins; None for where the robot is."""
        draft = self.draft
        if draft is None:
            return self.desk.selection.last, None
        return draft.robot, draft.points[-1]

    def _take(self, question: RouteQuestion, route: RouteReport) -> None:
        if not self._clicks:
            return
        if (question.robot, question.start) != self._from():
            self._leave_out()
            return
        self._try(lambda: self._add(question, route))

    def _add(self, question: RouteQuestion, route: RouteReport) -> None:
        following, self._clicks = self._clicks[1:], []
        draft = self.draft or PendingCommand(question.robot, ROUTE, ())
        points = route.points if question.start is None else route.points[1:]
        self.set_command(draft.with_leg(tuple(points), route_in_words(route, question.wishes)))
        self._clicks = following
        if following:
            self._lead_on()
        if route.note:
            self.desk.complained.emit(tr("This leg does not follow the roads: {note}", note=route.note))
