"""Map tools that draw: base class, and those of one point, a cone target and a start position."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsWkbTypes
from qgis.gui import QgsMapMouseEvent, QgsMapTool, QgsRubberBand, QgsSnapIndicator
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt
from qgis.PyQt.QtGui import QColor, QCursor, QKeyEvent, QKeySequence
from qgis.PyQt.QtWidgets import QApplication, QToolTip

from ....robot_bridge.core.messages.roads import RouteReport
from ...control.coordinates import read_site_place
from ...control.fleet_controller import FleetController
from ...control.messages import SELECTION, Level
from ...control.pending_command import CONE, START, PendingCommand, Point
from ...control.route_queries import SHORTEST, RoutePreferences, RouteQuestion, route_in_words
from ...layers.site_transform import SiteToMapTransform
from ...ui.errors import FleetError, MapTransformError, NotSentError
from ...ui.language import tr

FINE_M, COARSE_M = 0.1, 1.0
"""Metres per key press, with Ctrl, and with Ctrl and Shift."""
_ASIDE = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1), Qt.Key.Key_Down: (0, 1)}
_PIXELS = 50


def is_arrow_move(event: QKeyEvent) -> bool:
    """Return whether the event is Ctrl with an arrow key."""
    return event.key() in _ASIDE and bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)


def moved_by_arrow(event: QKeyEvent, desk: FleetController, point: Point) -> Point:
    """Return ``point`` of the site frame moved by Ctrl and an arrow key.

    Left is left on the screen, however map and site frame are rotated.

    :raises MapTransformError: when the point has no place on the map.
    """
    aside = _ASIDE[event.key()]
    coarse = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
    transform, screen = desk.site_to_canvas.transform(), desk.canvas.getCoordinateTransform()
    ((x, y),) = transform.to_map(np.array([point]))
    pixel = screen.transform(QgsPointXY(x, y))
    beside = transform.to_site(
        screen.toMapCoordinatesF(pixel.x() + aside[0] * _PIXELS, pixel.y() + aside[1] * _PIXELS)
    )
    dx, dy = beside[0] - point[0], beside[1] - point[1]
    step = (COARSE_M if coarse else FINE_M) / math.hypot(dx, dy)
    return point[0] + dx * step, point[1] + dy * step


SEND_KEYS = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
UNDO, REDO = QKeySequence.StandardKey.Undo, QKeySequence.StandardKey.Redo
PASTE = QKeySequence.StandardKey.Paste
PASTED_IN = "EPSG:4326"


class DrawingTool(QgsMapTool):
    """Base of tools that make a draft. Only Enter sends it: no click, no double click, no leaving.

    Clicks snap as set in QGIS's snapping settings.
    """

    kind = ""

    def __init__(self, desk: FleetController):
        super().__init__(desk.canvas)
        self.desk = desk
        self._pressed_at: QPoint | None = None
        self._snapped: QgsSnapIndicator | None = None
        self.setCursor(Qt.CursorShape.CrossCursor)

    def activate(self) -> None:
        super().activate()
        # Only while the tool is active: its marker must not outlive the canvas.
        self._snapped = QgsSnapIndicator(self.canvas())
        self.canvas().installEventFilter(self)
        self.canvas().setFocus()
        if self.desk.selection.last is None:
            text = tr("Select a robot first, in the table or on the map.")
            self.desk.messages.post(text, Level.WARNING, SELECTION)

    def deactivate(self) -> None:
        self._pressed_at = None
        self._snapped = None
        self.canvas().removeEventFilter(self)
        if self.draft is not None:
            self.desk.drafts.point_at(None)
        super().deactivate()

    @property
    def on_map(self) -> PendingCommand | None:
        """The draft if it can be changed; one being sent stays as it is until it has been checked."""
        return None if self.desk.checks.has_order else self.desk.drafts.draft

    @property
    def draft(self) -> PendingCommand | None:
        """The draft if it is one of this tool's."""
        draft = self.on_map
        return draft if draft is not None and draft.kind == self.kind else None

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        self._pressed_at = event.pos()

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        event.snapPoint()
        if self._snapped is not None:
            self._snapped.setMatch(event.mapPointMatch())
        self.hovered(event)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        # The second click of a double click comes without a press and so is no click of its own.
        pressed, self._pressed_at = self._pressed_at, None
        if pressed is None:
            return
        if self.is_drag(pressed, event.pos()):
            return
        if event.button() == Qt.MouseButton.RightButton:
            self.finish()
        elif event.button() == Qt.MouseButton.LeftButton:
            at = event.snapPoint()
            self._try(lambda: self._place(lambda: self.desk.site_to_canvas.transform().to_site(at)))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in SEND_KEYS:
            if not event.isAutoRepeat():
                self.desk.sending.send()
            event.accept()
        elif event.key() == Qt.Key.Key_Escape:
            self.desk.drafts.set_command(None)
            event.ignore()
        elif self.key(event):
            # An ignored event means to QGIS that the tool used it; else it deletes the selected features.
            event.ignore()
        else:
            super().keyPressEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # QGIS's own Undo and Paste are about layers; over the map a drawing tool takes precedence.
        if event.type() == QEvent.Type.ShortcutOverride and _is_ours(event):
            event.accept()
        return False

    def hovered(self, event: QgsMapMouseEvent) -> None:
        """Handle a move of the mouse; the event's map point is snapped."""

    def key(self, event: QKeyEvent) -> bool:
        """Handle a key; false for one without a meaning here."""
        if event.matches(UNDO):
            self._undo(self.desk.drafts.undo(), tr("There is nothing to take back."))
        elif event.matches(REDO):
            self._undo(self.desk.drafts.redo(), tr("There is nothing to do again."))
        elif event.matches(PASTE):
            self.paste()
        elif event.key() in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
            self.back()
        else:
            return False
        return True

    def clicked(self, point: Point) -> None:
        """Handle a click at a point of the site frame."""
        raise NotImplementedError

    def finish(self) -> None:
        """Handle a right click, which with QGIS's own tools ends drawing: the draft stays.

        A draft of one point is complete with its click, so there is nothing to end.
        """

    def back(self) -> None:
        """Undo the last click."""
        self.desk.drafts.set_command(None)

    def paste(self) -> None:
        """Use the clipboard's ``lat, lon`` in WGS 84 like a click there."""
        self._try(lambda: self._place(self._pasted))

    def add_point(self, point: Point) -> None:
        """Use a point of the site frame, of any origin, like a click there."""
        self._try(lambda: self._place(lambda: point))

    def set_command(self, draft: PendingCommand) -> None:
        """Check a draft and set it as the current one.

        :raises FleetError: when it cannot be checked.
        """
        self.desk.target_ways.set_command(draft)

    @staticmethod
    def is_drag(pressed: QPoint, now: QPoint) -> bool:
        """Return whether the mouse moved further than in a click."""
        return (now - pressed).manhattanLength() > QApplication.startDragDistance()

    def _place(self, where: Callable[[], Point]) -> None:
        """Handle a click at the point that ``where`` returns, if a robot is selected."""
        self._check_robot()
        self.clicked(where())

    def _pasted(self) -> Point:
        self.desk.site_to_canvas.transform()
        wgs84 = QgsCoordinateReferenceSystem(PASTED_IN)
        context = self.desk.project.transformContext()
        return read_site_place(QApplication.clipboard().text(), wgs84, self.desk.state.site, context)

    def _try(self, change: Callable[[], object]) -> None:
        try:
            change()
        except FleetError as error:
            self.desk.warning.emit(str(error))

    def _check_robot(self) -> None:
        if self.desk.selection.last is None and self.draft is None:
            raise FleetError(
                tr(
                    "No robot is selected, so there is nobody to send there. Select one in the table or on "
                    "the map."
                )
            )

    def _undo(self, done: bool, otherwise: str) -> None:
        if not done:
            self.desk.hint.emit(otherwise)


def _is_ours(event: QKeyEvent) -> bool:
    return any(event.matches(key) for key in (UNDO, REDO, PASTE))


# --- Preview of the route along the roads to the mouse ---

ALONG, STRAIGHT = QColor(21, 101, 192, 210), QColor(198, 40, 40, 210)
CASING = QColor(255, 255, 255, 90)
"""Beneath it: on the asphalt of an aerial image the colour alone is hard to see."""
WIDTH = 2
"""Pixels: thinner, and paler, than any path that a robot drives or is about to be sent."""
BESIDE = QPoint(16, 16)
"""Offset in pixels of the route's text from the mouse."""
MOVED_M = 0.5
"""Metres that a robot moves before its route is requested again."""


class RoutePreview(QObject):
    """The preview of a map tool while the mouse moves. Without a robot, or a link, nothing is shown.

    It vanishes when the mouse leaves the map, when another robot is selected or none, when the draft is sent
    or given up, when robots must stop, and when the link is lost. While the mouse stands still it follows
    the robot that it begins at.
    """

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._desk = desk
        self._band: QgsRubberBand | None = None
        self._mouse: QPoint | None = None
        self._question: RouteQuestion | None = None
        self._begins: Point | None = None
        """The beginning of the route shown, if it begins at a robot."""
        desk.preview.shown.connect(self._show)
        desk.selection.changed.connect(self.hide)
        desk.state.updated.connect(self._follow)

    def lead_to(
        self,
        event: QgsMapMouseEvent,
        robot: str | None,
        start: Point | None,
        preferences: RoutePreferences = SHORTEST,
    ) -> None:
        """Show the route from ``start``, or from the robot, to the mouse."""
        if self._mouse is None:
            self._desk.canvas.viewport().installEventFilter(self)
        self._mouse = QCursor.pos()
        if robot is None:
            return
        try:
            goal = self._desk.site_to_canvas.transform().to_site(event.mapPoint())
            self._question = RouteQuestion(robot, start, goal, preferences=preferences)
            self._desk.preview.want(self._question)
        except (NotSentError, MapTransformError):
            # A click shows the error; a moving mouse should not.
            self.clear()

    def clear(self) -> None:
        """Show nothing and query nothing, until the mouse moves again."""
        self.hide()
        self._desk.preview.forget()

    @property
    def line(self) -> list[QgsPointXY]:
        """The line drawn now, in the canvas's CRS."""
        if self._band is None:
            return []
        return [QgsPointXY(self._band.getPoint(0, k)) for k in range(self._band.numberOfVertices())]

    def hide(self) -> None:
        """Show nothing until the mouse moves again; a pending query is still answered."""
        if self._mouse is not None:
            QToolTip.hideText()
            viewport = self._desk.canvas.viewport()
            if not sip.isdeleted(viewport):
                viewport.removeEventFilter(self)
        self._mouse = self._question = self._begins = None
        self._remove_band()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Leave:
            self.hide()
        return False

    def _remove_band(self) -> None:
        if self._band is not None and not sip.isdeleted(self._band):
            self._desk.canvas.scene().removeItem(self._band)
        self._band = None

    def _follow(self) -> None:
        """Query again from the robot's present position, when it has moved since the last query."""
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
        self._remove_band()
        preview = self._desk.preview
        route = preview.route
        if self._mouse is None:
            return
        text = preview.why_not if route is None else route_in_words(route, preview.preferences, apart="\n")
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


# --- Tools of one point ---


class ConeTool(DrawingTool):
    """A click sets the cone target of the selected robot, another click, or Ctrl and an arrow key, moves it.

    With Shift held down the robot is sent straight there, and not along the roads.
    """

    kind = CONE

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._way = RoutePreview(desk)
        self._is_direct = False

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        self._is_direct = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        try:
            super().canvasReleaseEvent(event)
        finally:
            self._is_direct = False

    def hovered(self, event: QgsMapMouseEvent) -> None:
        self._way.lead_to(event, self.desk.selection.last, None)

    def deactivate(self) -> None:
        self._way.clear()
        super().deactivate()

    def clicked(self, point: Point) -> None:
        other = self.on_map
        if other is not None and other.kind != CONE:
            self.desk.warning.emit(
                tr(
                    "{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.",
                    in_words=other.in_words(),
                )
            )
            return
        self.set_command(
            PendingCommand(self.desk.selection.last or other.robot, CONE, (point,), is_direct=self._is_direct)
        )

    def key(self, event: QKeyEvent) -> bool:
        draft = self.draft
        if draft is None or not is_arrow_move(event):
            return super().key(event)
        is_direct = draft.is_direct
        self._try(
            lambda: self.set_command(
                PendingCommand(
                    draft.robot,
                    CONE,
                    (moved_by_arrow(event, self.desk, draft.points[0]),),
                    is_direct=is_direct,
                )
            )
        )
        return True


class StartTool(DrawingTool):
    """A click sets the start position of the selected robot; a drag also sets its heading."""

    kind = START

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._begun: tuple[SiteToMapTransform, Point] | None = None
        """Where the mouse was pressed: the map may move, when it follows robots, before the release."""

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        super().canvasPressEvent(event)
        self._begun = None
        with suppress(MapTransformError):
            transform = self.desk.site_to_canvas.transform()
            self._begun = transform, transform.to_site(self.toMapCoordinates(event.pos()))

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        pressed = self._pressed_at
        if (
            pressed is None
            or event.button() != Qt.MouseButton.LeftButton
            or not self.is_drag(pressed, event.pos())
        ):
            super().canvasReleaseEvent(event)
            return
        self._pressed_at = None
        self._try(lambda: self._drawn(pressed, event.mapPoint()))

    def clicked(self, point: Point) -> None:
        self._set_start(point, None)

    def key(self, event: QKeyEvent) -> bool:
        draft = self.draft
        if draft is None or not is_arrow_move(event):
            return super().key(event)
        self._try(lambda: self._set_start(moved_by_arrow(event, self.desk, draft.points[0]), draft.theta))
        return True

    def _drawn(self, pressed: QPoint, end: QgsPointXY) -> None:
        self._check_robot()
        transform = self.desk.site_to_canvas.transform()
        # Without a transform, this reports why.
        begun = self._begun or (transform, transform.to_site(self.toMapCoordinates(pressed)))
        if begun[0] is not transform:
            raise FleetError(
                tr("The site or the map's CRS has changed meanwhile. Draw the start position again.")
            )
        place, ahead = begun[1], transform.to_site(end)
        self._set_start(place, math.atan2(ahead[1] - place[1], ahead[0] - place[0]))

    def _set_start(self, place: Point, theta: float | None) -> None:
        other = self.on_map
        if other is not None and other.kind != START:
            raise FleetError(
                tr(
                    "{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.",
                    in_words=other.in_words(),
                )
            )
        self.set_command(
            PendingCommand(self.desk.selection.last or other.robot, START, (place,), theta=theta)
        )
