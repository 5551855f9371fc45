"""A vertex or a leg of a route that is dragged by the mouse; nothing of it is sent."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent
from qgis.PyQt.QtCore import QPoint

from ...errors import FleetError, PlacementError
from ..desk import Desk
from ..drafting import route_editing
from ..drafts import Draft
from .route_handles import RouteHandles


class RouteDrag:
    """What is dragged is shown as it would become; only letting go changes the route."""

    def __init__(self, desk: Desk, handles: RouteHandles):
        self._desk = desk
        self._handles = handles
        self._from: Draft | None = None
        self._vertex = 0
        self._puts_in = False
        self._shown: Draft | None = None

    @property
    def holds(self) -> bool:
        """Tell whether the mouse went down on something that can be dragged."""
        return self._from is not None

    @property
    def moves(self) -> bool:
        """Tell whether it is dragged."""
        return self._shown is not None

    def press(self, draft: Draft, mouse: QPoint) -> None:
        """Take hold of what is under the mouse, if anything is."""
        try:
            vertex = self._handles.vertex_at(draft, mouse)
            self._puts_in = vertex is None
            if vertex is None:
                vertex = self._handles.leg_at(draft, mouse)
        except PlacementError:
            return
        if vertex is not None:
            self._from, self._vertex = draft, vertex

    def move(self, event: QgsMapMouseEvent) -> None:
        """Show the route with what is held where the mouse is, snapped."""
        assert self._from is not None
        change = route_editing.inserted if self._puts_in else route_editing.moved
        try:
            to = self._desk.placement().to_site(event.snapPoint())
            self._shown = change(self._from, self._vertex, to)
        except FleetError as error:
            self._desk.complained.emit(str(error))
            self.give_up()
            return
        self._desk.drafts.drag(self._shown)
        self._handles.mark(self._shown, self._vertex)

    def release(self) -> Draft | None:
        """Let go and return the route as it becomes, None when nothing was dragged; shown is the old one."""
        shown = self._shown
        self.give_up()
        return shown

    def give_up(self) -> None:
        """Let go and show the route as it was."""
        before, moved = self._from, self._shown
        self._from = self._shown = None
        # Another draft may have taken its place meanwhile.
        if moved is not None and self._desk.drafts.draft is moved:
            self._desk.drafts.renew(before)
