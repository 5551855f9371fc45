"""Map tool that draws a route, with handles to drag its vertices and legs; preferences for road legs."""

from __future__ import annotations

from itertools import chain

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsMapCanvas, QgsMapMouseEvent, QgsVertexMarker
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QKeyEvent
from qgis.PyQt.QtWidgets import QCheckBox, QDoubleSpinBox, QLineEdit, QWidget

from ...control import pending_command
from ...control.fleet_controller import FleetController
from ...control.pending_command import LEAST_POINTS, ROUTE, PendingCommand, Point, vertices
from ...control.route_queries import RoutePreferences
from ...ui.dialogs import QuestionDialog
from ...ui.errors import FleetError, MapTransformError
from ...ui.language import tr
from .drawing_tools import DrawingTool, is_arrow_move, moved_by_arrow

REACH = 9.0
"""Distance in pixels by which the mouse may miss a vertex or a leg."""
MARK = QColor("#FFE14D")


class RouteHandles:
    """Finds vertices and legs near the mouse, and marks the active vertex."""

    def __init__(self, desk: FleetController):
        self._desk = desk
        self._marker: QgsVertexMarker | None = None
        # Cache of the last placement: which points, with which transform, and their coordinates.
        self._placed: tuple = (None, None, (), np.empty((0, 2)))

    def vertex_at(self, draft: PendingCommand, mouse: QPoint) -> int | None:
        """Return the vertex nearest to the mouse, None where none is near.

        :raises MapTransformError: when the route has no place on the map.
        """
        found = vertices(draft)
        if not found:
            return None
        away = np.hypot(*(self._pixels(draft, found) - (mouse.x(), mouse.y())).T)
        nearest = int(np.argmin(away))
        return found[nearest] if away[nearest] <= REACH else None

    def leg_at(self, draft: PendingCommand, mouse: QPoint) -> int | None:
        """Return the end of the straight leg under the mouse, None where there is none."""
        ends = [end for end in vertices(draft) if end > 0]
        if not ends:
            return None
        a, b = self._pixels(draft, [end - 1 for end in ends]), self._pixels(draft, ends)
        step, from_a = b - a, np.array([mouse.x(), mouse.y()]) - a
        square = np.maximum((step * step).sum(axis=1), 1e-9)
        share = np.clip((from_a * step).sum(axis=1) / square, 0.0, 1.0)
        away = np.hypot(*(from_a - share[:, None] * step).T)
        nearest = int(np.argmin(away))
        return ends[nearest] if away[nearest] <= REACH else None

    def mark(self, draft: PendingCommand | None, vertex: int | None) -> None:
        """Mark a vertex, None for none."""
        if self._marker is not None and not sip.isdeleted(self._marker):
            self._desk.canvas.scene().removeItem(self._marker)
        self._marker = None
        if draft is None or vertex is None:
            return
        ((x, y),) = self._desk.site_to_canvas.transform().to_map(np.array([draft.points[vertex]]))
        self._marker = QgsVertexMarker(self._desk.canvas)
        self._marker.setCenter(QgsPointXY(x, y))
        self._marker.setIconType(QgsVertexMarker.IconType.ICON_BOX)
        self._marker.setIconSize(14)
        self._marker.setPenWidth(3)
        self._marker.setColor(MARK)

    def _pixels(self, draft: PendingCommand, which: list[int]) -> np.ndarray:
        transform = self._desk.site_to_canvas.transform()
        if self._placed[:2] != (id(draft.points), transform):
            flat = np.fromiter(chain.from_iterable(draft.points), np.float64).reshape(-1, 2)
            self._placed = id(draft.points), transform, draft.points, transform.to_map(flat)
        return _on_screen(self._placed[3][which], self._desk.canvas)


def _on_screen(places: np.ndarray, canvas: QgsMapCanvas) -> np.ndarray:
    """Return (n, 2) map coordinates as pixels, all at once: a route may have thousands of points."""
    screen, centre = canvas.getCoordinateTransform(), canvas.center()
    unit = canvas.mapUnitsPerPixel() * 1000.0
    at = screen.transform(centre)
    right = screen.transform(QgsPointXY(centre.x() + unit, centre.y()))
    up = screen.transform(QgsPointXY(centre.x(), centre.y() + unit))
    axes = np.array([(right.x() - at.x(), right.y() - at.y()), (up.x() - at.x(), up.y() - at.y())]) / unit
    return (places - (centre.x(), centre.y())) @ axes + (at.x(), at.y())


def middle(draft: PendingCommand, vertex: int) -> tuple[float, float]:
    """Return the middle of the leg that ends in a vertex which is not the first point."""
    (ax, ay), (bx, by) = draft.points[vertex - 1 : vertex + 1]
    return (ax + bx) / 2, (ay + by) / 2


class RouteDrag:
    """The route is shown as it would become while dragging; only releasing the mouse changes it."""

    def __init__(self, desk: FleetController, handles: RouteHandles):
        self._desk = desk
        self._handles = handles
        self._from: PendingCommand | None = None
        self._vertex = 0
        self._puts_in = False
        self._shown: PendingCommand | None = None

    @property
    def holds(self) -> bool:
        """Return whether the mouse was pressed on something that can be dragged."""
        return self._from is not None

    @property
    def moves(self) -> bool:
        """Return whether something is being dragged."""
        return self._shown is not None

    def press(self, draft: PendingCommand, mouse: QPoint) -> None:
        """Begin to drag the vertex or leg under the mouse, if any."""
        try:
            vertex = self._handles.vertex_at(draft, mouse)
            self._puts_in = vertex is None
            if vertex is None:
                vertex = self._handles.leg_at(draft, mouse)
        except MapTransformError:
            return
        if vertex is not None:
            self._from, self._vertex = draft, vertex

    def move(self, event: QgsMapMouseEvent) -> None:
        """Show the route with the dragged vertex at the mouse, snapped."""
        assert self._from is not None
        change = pending_command.inserted if self._puts_in else pending_command.moved
        try:
            to = self._desk.site_to_canvas.transform().to_site(event.snapPoint())
            self._shown = change(self._from, self._vertex, to)
        except FleetError as error:
            self._desk.warning.emit(str(error))
            self.give_up()
            return
        self._desk.drafts.drag(self._shown)
        self._handles.mark(self._shown, self._vertex)

    def release(self) -> PendingCommand | None:
        """End the drag and return the new route, None when nothing was dragged; the old one is shown."""
        shown = self._shown
        self.give_up()
        return shown

    def drop(self) -> None:
        """End the drag of a route that is no longer on the map: nothing of it is restored."""
        self._from = self._shown = None

    def give_up(self) -> None:
        """Cancel the drag and show the former route."""
        before, moved = self._from, self._shown
        self._from = self._shown = None
        # Another draft may have replaced it meanwhile.
        if moved is not None and self._desk.drafts.draft is moved:
            self._desk.drafts.renew(before)


BACKWARD, FORWARD = ("<", ","), (">", ".")


class RouteTool(DrawingTool):
    """Each click adds a point to the route of the robot that was selected at the first click.

    A vertex can be dragged; a dragged leg gets a vertex there. The active vertex, under the mouse or
    chosen by ``<`` and ``>``, is deleted by Delete and moved by Ctrl and the arrow keys; Insert puts one
    before it; R reverses the route.

    A right click ends drawing: no next leg follows the mouse. Another click continues from the end.
    """

    kind = ROUTE

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._handles = RouteHandles(desk)
        self._drag = RouteDrag(desk, self._handles)
        self._vertex: int | None = None
        self._points: tuple[Point, ...] = ()
        self._is_finished = False
        desk.drafts.changed.connect(self._changed)

    def deactivate(self) -> None:
        self._drag.give_up()
        self._clear_active()
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
        self._update_active(event)
        super().canvasMoveEvent(event)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        moves, changed = self._drag.moves, self._drag.release()
        if not moves:
            super().canvasReleaseEvent(event)
            return
        self._pressed_at = None
        if changed is not None:
            self._try(lambda: self.set_command(changed))

    def hovered(self, event: QgsMapMouseEvent) -> None:
        if self.draft is None or self._is_finished:
            return
        if self._vertex is not None:
            self.desk.drafts.point_at(None)
            return
        try:
            self.desk.drafts.point_at(self.desk.site_to_canvas.transform().to_site(event.mapPoint()))
        except MapTransformError:
            # A place that the site frame cannot express has no preview; a click there shows why.
            self.desk.drafts.point_at(None)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # The canvas sends its tools no keys while a mouse button is down.
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
            self._try(lambda: self.set_command(pending_command.turned_round(draft)))
        elif vertex is None:
            return super().key(event)
        elif event.key() == Qt.Key.Key_Delete:
            self._try(lambda: self._put_or_end(pending_command.deleted(draft, vertex)))
        elif event.key() == Qt.Key.Key_Insert:
            self._insert(draft, vertex)
        elif is_arrow_move(event):
            self._nudge(event, draft, vertex)
        else:
            return super().key(event)
        return True

    def finish(self) -> None:
        draft = self.draft
        if draft is None:
            return
        if len(draft.points) < LEAST_POINTS:
            self.desk.warning.emit(
                tr("A route needs at least two points, so its drawing goes on: click the next one.")
            )
            return
        self._is_finished = True
        self.desk.drafts.point_at(None)

    def clicked(self, point: Point) -> None:
        self._is_finished = False
        draft = self.draft
        if draft is None:
            draft = PendingCommand(self.desk.selection.last, ROUTE, ())
        if self.is_for_selected(draft):
            self.set_command(draft.with_leg((point,)))

    def back(self) -> None:
        draft = self.draft
        if draft is not None:
            self._put_or_end(draft.without_last_leg())
        else:
            self.desk.drafts.set_command(None)

    def is_for_selected(self, draft: PendingCommand) -> bool:
        """Return whether the draft is for the selected robot; report where it is for another."""
        if self.desk.selection.last in (None, draft.robot):
            return True
        self.desk.warning.emit(
            tr(
                "The route on the map is for {robot}, but {selected} is selected. Send it (Enter) or "
                "cancel it (Esc) first, or select {robot} again.",
                robot=draft.robot,
                selected=self.desk.selection.last,
            )
        )
        return False

    def _put_or_end(self, draft: PendingCommand | None) -> None:
        if draft is None:
            self.desk.drafts.set_command(None)
        else:
            self.set_command(draft)

    def _update_active(self, event: QgsMapMouseEvent) -> None:
        draft = self.draft
        if draft is not None:
            try:
                vertex = self._handles.vertex_at(draft, event.pos())
                if vertex != self._vertex:
                    self._hold(draft, vertex)
            except MapTransformError:
                self._clear_active()

    def _hold(self, draft: PendingCommand, vertex: int | None) -> None:
        self._vertex, self._points = vertex, draft.points
        self._handles.mark(draft, vertex)

    def _changed(self) -> None:
        # If only a check has ended, the vertex stays active.
        draft = self.draft
        if draft is None and self._drag.holds:
            # It was sent, or its site is no longer served: its numbers are other places on another one.
            self._drag.drop()
            self._pressed_at = None
        if draft is None or draft.points is not self._points:
            self._clear_active()
        if draft is None or len(draft.points) < LEAST_POINTS:
            self._is_finished = False

    def _clear_active(self) -> None:
        self._vertex = None
        self._handles.mark(None, None)

    def _step(self, draft: PendingCommand, by: int) -> None:
        found = pending_command.vertices(draft)
        if found:
            here = found.index(self._vertex) if self._vertex in found else (-1 if by > 0 else 0)
            self._try(lambda: self._hold(draft, found[(here + by) % len(found)]))

    def _insert(self, draft: PendingCommand, vertex: int) -> None:
        if vertex == 0:
            self.desk.warning.emit(
                tr("This is the first vertex: another is put before one that comes later.")
            )
            return
        self._try(lambda: self.set_command(pending_command.inserted(draft, vertex, middle(draft, vertex))))
        self._hold_again(vertex)

    def _nudge(self, event: QKeyEvent, draft: PendingCommand, vertex: int) -> None:
        def nudge() -> None:
            self.set_command(
                pending_command.moved(draft, vertex, moved_by_arrow(event, self.desk, draft.points[vertex]))
            )

        self._try(nudge)
        self._hold_again(vertex)

    def _hold_again(self, vertex: int) -> None:
        if self.draft is not None and vertex in pending_command.vertices(self.draft):
            self._hold(self.draft, vertex)


# --- Preferences for legs along roads ---

ROUTE_CRITERIA = ((tr("the shortest"), False), (tr("the fastest"), True))
WIDEST_ROAD = 50.0


def surfaces_of(text: str) -> tuple[str, ...]:
    """Return the names of surfaces in ``text``, separated by commas, without duplicates."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))


class RoutePreferencesDialog(QuestionDialog):
    """Begins with the present ``preferences``; ``confirmed`` carries those for the future."""

    confirmed = pyqtSignal(object)

    def __init__(self, preferences: RoutePreferences, parent: QWidget):
        super().__init__(
            "fleet_way_wishes_dialog",
            tr("Ways on roads"),
            ("fleet_way_wishes_confirm", tr("Lead ways so")),
            is_safe=False,
            parent=parent,
        )
        self.add_text(tr("This holds for every leg that is led from now on, until QGIS is closed."))
        self._way = self.add_choice(tr("Way"), ROUTE_CRITERIA, "fleet_way_wishes_way")
        self._way.setCurrentIndex(self._way.findData(preferences.fastest))
        self._surfaces = QLineEdit(", ".join(preferences.surfaces))
        self._surfaces.setPlaceholderText(tr("all, or such as: asphalt, concrete"))
        self.add_field(tr("Surfaces"), self._surfaces, "fleet_way_wishes_surfaces")
        self._width = _metres(preferences.least_width)
        self.add_field(tr("Width"), self._width, "fleet_way_wishes_width")
        self._avoid = QCheckBox(tr("Keep off roads on which other robots are sent"))
        self._avoid.setChecked(preferences.avoid_reserved)
        self.add_field("", self._avoid, "fleet_way_wishes_avoid")
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(self.preferences()))

    def preferences(self) -> RoutePreferences:
        """Return the preferences in the fields."""
        return RoutePreferences(
            fastest=self._way.currentData(),
            surfaces=surfaces_of(self._surfaces.text()),
            least_width=self._width.value(),
            avoid_reserved=self._avoid.isChecked(),
        )


def _metres(value: float) -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setRange(0.0, WIDEST_ROAD)
    field.setSingleStep(0.5)
    field.setDecimals(1)
    field.setSuffix(" m")
    field.setSpecialValueText(tr("as wide as the robots are"))
    field.setValue(value)
    return field
