"""The map tool that sets a cone target."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QKeyEvent

from ..language import tr
from .commands.nudging import is_nudge, nudged
from .desk import Desk
from .draft_tool import DraftTool
from .drafts import CONE, Draft, Point
from .way_to_mouse import WayToMouse


class ConeTool(DraftTool):
    """A click puts the cone for the selected robot, another click moves it, as do Ctrl and the arrow keys.

    With Shift held down the robot is sent straight there, and not along the roads.
    """

    kind = CONE

    def __init__(self, desk: Desk):
        super().__init__(desk)
        self._way = WayToMouse(desk)
        self._is_direct = False

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        self._is_direct = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        try:
            super().canvasReleaseEvent(event)
        finally:
            self._is_direct = False

    def hovered(self, event: QgsMapMouseEvent) -> None:
        self._way.lead_to(event, self.desk.selected, None)

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
        self.put(Draft(self.desk.selected or other.robot, CONE, (point,), is_direct=self._is_direct))

    def key(self, event: QKeyEvent) -> bool:
        draft = self.draft
        if draft is None or not is_nudge(event):
            return super().key(event)
        is_direct = draft.is_direct
        self._try(
            lambda: self.put(
                Draft(
                    draft.robot,
                    CONE,
                    (nudged(event, self.desk, draft.points[0]),),
                    is_direct=is_direct,
                )
            )
        )
        return True
