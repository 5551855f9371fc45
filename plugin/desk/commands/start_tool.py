"""The map tool that tells a robot where it stands."""

from __future__ import annotations

import math

from qgis.core import QgsPointXY
from qgis.gui import QgsMapMouseEvent
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QKeyEvent

from ...errors import FleetError
from ...language import tr
from ..draft_tool import DraftTool
from ..drafts import START, Draft, Point
from .nudging import is_nudge, nudged


class StartTool(DraftTool):
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
        if draft is None or not is_nudge(event):
            return super().key(event)
        self._try(lambda: self._put(nudged(event, self.desk, draft.points[0]), draft.theta))
        return True

    def _drawn(self, start: QgsPointXY, end: QgsPointXY) -> None:
        self._check_robot()
        placement = self.desk.placement()
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
        self.put(Draft(self.desk.selected or other.robot, START, (place,), theta=theta))
