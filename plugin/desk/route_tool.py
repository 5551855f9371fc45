"""The map tool that draws a route."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent
from qgis.PyQt.QtCore import QEvent, QObject, Qt
from qgis.PyQt.QtGui import QKeyEvent

from ..errors import PlacementError
from ..language import tr
from .commands.nudging import is_nudge, nudged
from .commands.route_drag import RouteDrag
from .commands.route_handles import RouteHandles, middle
from .desk import Desk
from .draft_tool import DraftTool
from .drafting import route_editing
from .drafts import LEAST_POINTS, ROUTE, Draft, Point

BACKWARD, FORWARD = ("<", ","), (">", ".")


class RouteTool(DraftTool):
    """Each click adds a point to the route of the robot that was selected at the first click.

    A vertex is dragged; a leg that is dragged gets a vertex there. The vertex in hand, under the mouse or
    chosen by ``<`` and ``>``, is deleted by Delete and moved by Ctrl and the arrow keys; Insert puts one
    before it; R turns the route round.

    A right click ends drawing: the next leg follows the mouse no more. Another click goes on from the end.
    """

    kind = ROUTE

    def __init__(self, desk: Desk):
        super().__init__(desk)
        self._handles = RouteHandles(desk)
        self._drag = RouteDrag(desk, self._handles)
        self._vertex: int | None = None
        self._points: tuple[Point, ...] = ()
        self._is_finished = False
        desk.drafts.changed.connect(self._changed)

    def deactivate(self) -> None:
        self._drag.give_up()
        self._let_go()
        self._is_finished = False
        super().deactivate()

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        super().canvasPressEvent(event)
        if event.button() == Qt.MouseButton.LeftButton and self.draft is not None:
            self._drag.press(self.draft, event.pos())

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        if self._drag.holds and self._pressed_at is not None:
            if self._drag.moves or self.is_drag(self._pressed_at, event.pos()):
                self._drag.move(event)
            return
        self._take_hold(event)
        super().canvasMoveEvent(event)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        moves, changed = self._drag.moves, self._drag.release()
        if not moves:
            super().canvasReleaseEvent(event)
            return
        self._pressed_at = None
        if changed is not None:
            self._try(lambda: self.put(changed))

    def hovered(self, event: QgsMapMouseEvent) -> None:
        if self.draft is None or self._is_finished:
            return
        if self._vertex is not None:
            self.desk.drafts.point_at(None)
            return
        try:
            self.desk.drafts.point_at(self.desk.placement().to_site(event.mapPoint()))
        except PlacementError:
            # A place the site frame cannot express has no preview; a click there says why.
            self.desk.drafts.point_at(None)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # The canvas keeps keys from its tools while a mouse button is down.
        if event.type() == QEvent.Type.KeyPress and self._drag.holds:
            if event.key() == Qt.Key.Key_Escape:
                self._drag.give_up()
                self._pressed_at = None
            return True
        return super().eventFilter(watched, event)

    def key(self, event: QKeyEvent) -> bool:
        draft, vertex = self.draft, self._vertex
        if draft is None or self._drag.holds:
            return super().key(event)
        if event.text() in (*BACKWARD, *FORWARD):
            self._step(draft, -1 if event.text() in BACKWARD else 1)
        elif event.key() == Qt.Key.Key_R:
            self._try(lambda: self.put(route_editing.turned_round(draft)))
        elif vertex is None:
            return super().key(event)
        elif event.key() == Qt.Key.Key_Delete:
            self._try(lambda: self._put_or_end(route_editing.deleted(draft, vertex)))
        elif event.key() == Qt.Key.Key_Insert:
            self._insert(draft, vertex)
        elif is_nudge(event):
            self._nudge(event, draft, vertex)
        else:
            return super().key(event)
        return True

    def finish(self) -> None:
        draft = self.draft
        if draft is None:
            return
        if len(draft.points) < LEAST_POINTS:
            self.desk.complained.emit(
                tr("A route needs at least two points, so its drawing goes on: click the next one.")
            )
            return
        self._is_finished = True
        self.desk.drafts.point_at(None)

    def clicked(self, point: Point) -> None:
        self._is_finished = False
        draft = self.draft
        if draft is None:
            draft = Draft(self.desk.selected, ROUTE, ())
        if self.is_for_selected(draft):
            self.put(draft.with_leg((point,)))

    def back(self) -> None:
        draft = self.draft
        if draft is not None:
            self._put_or_end(draft.without_last_leg())
        else:
            self.desk.drafts.put(None)

    def is_for_selected(self, draft: Draft) -> bool:
        """Tell whether the draft is for the robot that is selected; say so where it is for another."""
        if self.desk.selected in (None, draft.robot):
            return True
        self.desk.complained.emit(
            tr(
                "The route on the map is for {robot}, but {selected} is selected. Send it (Enter) or "
                "cancel it (Esc) first, or select {robot} again.",
                robot=draft.robot,
                selected=self.desk.selected,
            )
        )
        return False

    def _put_or_end(self, draft: Draft | None) -> None:
        if draft is None:
            self.desk.drafts.put(None)
        else:
            self.put(draft)

    def _take_hold(self, event: QgsMapMouseEvent) -> None:
        draft = self.draft
        if draft is not None:
            try:
                vertex = self._handles.vertex_at(draft, event.pos())
                if vertex != self._vertex:
                    self._hold(draft, vertex)
            except PlacementError:
                self._let_go()

    def _hold(self, draft: Draft, vertex: int | None) -> None:
        self._vertex, self._points = vertex, draft.points
        self._handles.mark(draft, vertex)

    def _changed(self) -> None:
        # Where only a check has come to its end, the vertex stays in hand.
        draft = self.draft
        if draft is None or draft.points is not self._points:
            self._let_go()
        if draft is None or len(draft.points) < LEAST_POINTS:
            self._is_finished = False

    def _let_go(self) -> None:
        self._vertex = None
        self._handles.mark(None, None)

    def _step(self, draft: Draft, by: int) -> None:
        found = route_editing.vertices(draft)
        if found:
            here = found.index(self._vertex) if self._vertex in found else (-1 if by > 0 else 0)
            self._try(lambda: self._hold(draft, found[(here + by) % len(found)]))

    def _insert(self, draft: Draft, vertex: int) -> None:
        if vertex == 0:
            self.desk.complained.emit(
                tr("This is the first vertex: another is put before one that comes later.")
            )
            return
        self._try(lambda: self.put(route_editing.inserted(draft, vertex, middle(draft, vertex))))
        self._hold_again(vertex)

    def _nudge(self, event: QKeyEvent, draft: Draft, vertex: int) -> None:
        def nudge() -> None:
            self.put(route_editing.moved(draft, vertex, nudged(event, self.desk, draft.points[vertex])))

        self._try(nudge)
        self._hold_again(vertex)

    def _hold_again(self, vertex: int) -> None:
        if self.draft is not None and vertex in route_editing.vertices(self.draft):
            self._hold(self.draft, vertex)
