"""Map tools for one point: cone target, start position."""

from __future__ import annotations

import math

from qgis.core import QgsPointXY
from qgis.gui import QgsMapMouseEvent
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QKeyEvent

from ...control.fleet_controller import FleetController
from ...control.pending_command import CONE, START, PendingCommand, Point
from ...ui.errors import FleetError
from ...ui.language import tr
from .drawing_tool import DrawingTool, is_arrow_move, moved_by_arrow
from .road_route_tool import RoutePreview


class ConeTool(DrawingTool):
    """A click puts the cone for the selected robot, another click moves it, as do Ctrl and the arrow keys.

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
            self.desk.complained.emit(
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
    """A click puts the start position of the selected robot; a drag gives it the heading that it leads in."""

    kind = START

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
        self._try(lambda: self._drawn(self.toMapCoordinates(pressed), event.mapPoint()))

    def clicked(self, point: Point) -> None:
        self._put(point, None)

    def key(self, event: QKeyEvent) -> bool:
        draft = self.draft
        if draft is None or not is_arrow_move(event):
            return super().key(event)
        self._try(lambda: self._put(moved_by_arrow(event, self.desk, draft.points[0]), draft.theta))
        return True

    def _drawn(self, start: QgsPointXY, end: QgsPointXY) -> None:
        self._check_robot()
        placement = self.desk.site_to_canvas.transform()
        place, ahead = placement.to_site(start), placement.to_site(end)
        self._put(place, math.atan2(ahead[1] - place[1], ahead[0] - place[0]))

    def _put(self, place: Point, theta: float | None) -> None:
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
