"""Display of cone plans: the table of robots with their stops, and the layers on the map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsProperty,
    QgsSimpleLineSymbolLayer,
    QgsSimpleMarkerSymbolLayer,
    QgsSingleSymbolRenderer,
    QgsSymbolLayer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QPoint, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QDropEvent, QIcon, QKeyEvent, QPixmap
from qgis.PyQt.QtWidgets import QAbstractItemView, QMenu, QTreeWidget, QTreeWidgetItem, QWidget

from ...robot_bridge.core.assignment.plan import ConePlan
from ...robot_bridge.core.assignment.plan_changes import trips_of
from ...robot_bridge.core.messages.queues import TaskState
from ...robot_bridge.core.messages.records import PlacementReport
from ...robot_bridge.core.sites.frame import SiteFrame
from ..control.fleet_controller import FleetController
from ..layers.live_layers import Row, RowLayer, label
from ..layers.site_transform import frame_of
from ..ui.glyphs import WRONG, for_letters
from ..ui.language import tr, tr_count
from ..ui.tables import fit_headers
from .as_placed import PLACED, utc_in_words
from .plan_texts import NOT_DONE, PlanStopRow, colour_of, time_text

# --- The plan as a table of robots with their stops, which can be dragged, moved by keys and removed ---

HEADS = (tr("Robot, stop"), tr("Arrives"), tr("State"), tr("Off [m]"))
_NAME = Qt.ItemDataRole.UserRole
_KINDS = {"place": "", "collect": tr("collect "), "store": tr("store "), "home": tr("end at ")}


class PlanTree(QTreeWidget):
    """Shows a draft or the driven plan. Changes are requested, and shown once they are made."""

    move_requested = pyqtSignal(str, str, int, int)
    """A target moves to another robot, trip and place."""
    remove_requested = pyqtSignal(str)
    place_requested = pyqtSignal(float, float)
    """A stop was double-clicked: its position in the site frame."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_plan_tree")
        self.setHeaderLabels(HEADS)
        self.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._offer)
        self.itemDoubleClicked.connect(self._go_there)
        self.setToolTip(
            tr("Drag a cone to another place or robot; Alt+Up and Alt+Down move it, Del takes it out")
        )
        for column, width in enumerate((142, 66, 84, 44)):
            self.setColumnWidth(column, width)
        fit_headers(self)
        self.setIndentation(12)
        self._plan: ConePlan | None = None
        self._editable = False

    def show_plan(
        self,
        plan: ConePlan | None,
        rows: Mapping[str, Sequence[PlanStopRow]],
        began_at: float | None = None,
        *,
        editable: bool,
    ) -> None:
        """Show a plan by the rows of each robot; it was begun at ``began_at``, if it is driven."""
        self._editable = editable
        if plan is None:
            self._plan = None
            self.clear()
            return
        if plan is not self._plan:
            # The gateway reports a plan again with each of its revisions.
            is_same, self._plan = plan == self._plan, plan
            if not is_same:
                self._build(plan, rows)
        for k, one in enumerate(plan.robots):
            top = self.topLevelItem(k)
            top.setText(1, time_text(one.end_s, began_at) if one.stops or one.done else "")
            top.setText(2, _robot_in_words(rows[one.robot.id], one.lost))
            for child, row in enumerate(rows[one.robot.id]):
                _fill(top.child(child), row)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        target = self._target()
        moves = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}
        if target and event.key() == Qt.Key.Key_Delete:
            self.remove_requested.emit(target)
        elif target and event.key() in moves and event.modifiers() & Qt.KeyboardModifier.AltModifier:
            self._move_by(target, moves[event.key()])
        else:
            super().keyPressEvent(event)

    def dropEvent(self, event: QDropEvent) -> None:
        """Request the move of the dragged cone to where it is dropped; nothing is moved here."""
        onto = self.itemAt(_place(event))
        below = self.dropIndicatorPosition() != QAbstractItemView.DropIndicatorPosition.AboveItem
        target = self._target()
        event.setDropAction(Qt.DropAction.IgnoreAction)
        event.accept()
        if target and onto is not None:
            self._want(target, onto, after=below)

    def append_to_route(self, robot: str) -> None:
        """Request that the selected cone become the last one of ``robot``."""
        target = self._target()
        if target and self._plan is not None:
            self._emit(target, position_at_end(self._plan, target, robot))

    def _want(self, target: str, onto: QTreeWidgetItem, *, after: bool) -> None:
        name = onto.data(0, _NAME)
        if onto.parent() is None:
            self._emit(target, position_at_end(self._plan, target, name))
        elif name:
            self._emit(target, position_beside(self._plan, target, name, after=after))

    def _move_by(self, target: str, step: int) -> None:
        item = self.currentItem()
        other = item.parent().child(item.parent().indexOfChild(item) + step)
        while other is not None and not other.data(0, _NAME):
            other = item.parent().child(item.parent().indexOfChild(other) + step)
        if other is not None:
            self._want(target, other, after=step > 0)

    def _emit(self, target: str, place: tuple[str, int, int] | None) -> None:
        if place is not None:
            self.move_requested.emit(target, *place)

    def _target(self) -> str:
        """Return the selected cone if it can be moved, else an empty text."""
        item = self.currentItem()
        if not self._editable or item is None or item.parent() is None:
            return ""
        return item.data(0, _NAME) or ""

    def _offer(self, at: QPoint) -> None:
        target = self._target()
        if not target or self._plan is None:
            return
        menu = QMenu(self)
        for one in self._plan.robots:
            if not one.lost:
                name = one.robot.id
                menu.addAction(tr("Give to {name}", name=name), lambda name=name: self.append_to_route(name))
        menu.addAction(tr("Take out"), lambda: self.remove_requested.emit(target))
        menu.exec(self.viewport().mapToGlobal(at))

    def _go_there(self, item: QTreeWidgetItem) -> None:
        place = item.data(0, _NAME + 1)
        if place is not None:
            self.place_requested.emit(*place)

    def _build(self, plan: ConePlan, rows: Mapping[str, Sequence[PlanStopRow]]) -> None:
        chosen = self._target()
        self.clear()
        for one in plan.robots:
            top = QTreeWidgetItem([one.robot.id])
            top.setData(0, _NAME, one.robot.id)
            top.setIcon(0, _swatch(colour_of(plan, one.robot.id)))
            top.setFlags(top.flags() & ~Qt.ItemFlag.ItemIsDragEnabled)
            self.addTopLevelItem(top)
            for row in rows[one.robot.id]:
                child = QTreeWidgetItem()
                child.setData(0, _NAME, row.stop.id if row.stop.is_target else "")
                child.setData(0, _NAME + 1, (row.stop.x, row.stop.y))
                if not row.stop.is_target:
                    child.setFlags(child.flags() & ~Qt.ItemFlag.ItemIsDragEnabled)
                top.addChild(child)
                if chosen and row.stop.id == chosen:
                    self.setCurrentItem(child)
            top.setExpanded(True)


def position_beside(plan: ConePlan, target: str, onto: str, *, after: bool) -> tuple[str, int, int] | None:
    """Return robot, trip and place of ``target`` when it is dropped before or ``after`` cone ``onto``.

    Trip and place are as in :func:`.plan_changes.move_target`. None when ``onto`` is no robot's.
    """
    names = [one.robot.id for one in plan.robots if not one.lost]
    for robot, day in zip(names, trips_of(plan), strict=True):
        for trip, cones in enumerate(day):
            left = [cone for cone in cones if cone != target]
            if onto in left:
                return robot, trip, left.index(onto) + after
    return None


def position_at_end(plan: ConePlan, target: str, robot: str) -> tuple[str, int, int] | None:
    """Return robot, trip and place of ``target`` when it is given to ``robot`` as its last cone."""
    names = [one.robot.id for one in plan.robots if not one.lost]
    if robot not in names:
        return None
    day = trips_of(plan)[names.index(robot)]
    trip = max((k for k, cones in enumerate(day) if any(cone != target for cone in cones)), default=0)
    room = plan.robot(robot)
    kept = len([cone for cone in day[trip] if cone != target])
    full = room is not None and kept >= (room.robot.aboard if trip == 0 else room.robot.capacity)
    if full and plan.stores:
        return robot, len(day), 0
    return robot, trip, kept


def _fill(item: QTreeWidgetItem, row: PlanStopRow) -> None:
    off = "" if row.deviation is None else f"{row.deviation:.2f}"
    name = f"{row.number}  {_KINDS[row.stop.kind]}{row.stop.id}"
    for column, text in enumerate((name, row.arrives, row.in_words(), off)):
        if item.text(column) != text:
            item.setText(column, text)
    if row.state in NOT_DONE:
        item.setForeground(2, for_letters(WRONG))


def _robot_in_words(rows: Sequence[PlanStopRow], lost: bool) -> str:
    cones = [row for row in rows if row.stop.is_target]
    done = sum(row.state is TaskState.DONE for row in cones)
    text = (
        tr_count(len(cones), "{done} of 1 cone", "{done} of %n cones", done=done)
        if done
        else tr_count(len(cones), "1 cone", "%n cones")
    )
    return tr("LOST, {text}", text=text) if lost else text


def _place(event: QDropEvent) -> QPoint:
    """Return the position of ``event`` in the view; Qt 6 has no pos(), and Qt 5 no position()."""
    if hasattr(event, "position"):
        return event.position().toPoint()
    return event.pos()  # type: ignore[attr-defined]


def _swatch(colour: str) -> QIcon:
    pixmap = QPixmap(12, 12)
    pixmap.fill(QColor(colour))
    return QIcon(pixmap)


# --- The plan and the placed cones on the map, as layers of the group Fleet ---

STOP_FIELDS = (
    "robot:string,number:integer,trip:integer,kind:string,id:string,arrives:string,state:string,why:string,"
    "colour:string"
)
WAY_FIELDS = "robot:string,number:integer,to_stop:string,metres:double,arrives:string,colour:string"
PLACED_FIELDS = (
    "cone:string,layout:string,robot:string,placed_at:string,deviation:double,planned_x:double,"
    "planned_y:double,x:double,y:double,theta:double,collected:boolean,planned_easting:double,"
    "planned_northing:double,easting:double,northing:double"
)
"""As in the files of ``robot-bridge placements export``, so that the as-placed report accepts it."""


class PlanLayers:
    """The layers, created when there is something to show, and removed with the plugin."""

    def __init__(self, desk: FleetController):
        self._desk = desk
        project = desk.project
        self.ways = RowLayer(
            project, "cone_plan_ways", tr("Cone plan, ways"), "LineString", WAY_FIELDS, _style_ways
        )
        self.stops = RowLayer(
            project, "cone_plan_stops", tr("Cone plan, stops"), "Point", STOP_FIELDS, _style_stops
        )
        self.placed = RowLayer(project, PLACED, tr("Cones as placed"), "Point", PLACED_FIELDS, _style_placed)

    def show(self, plan: ConePlan | None, rows: Mapping[str, Sequence[PlanStopRow]]) -> None:
        """Show a plan by the rows of each robot; None shows nothing."""
        stops, ways = [], []
        for robot, theirs in (rows if plan is not None else {}).items():
            colour = colour_of(plan, robot)
            for row in theirs:
                stop = row.stop
                stops.append(([(stop.x, stop.y)], _stop_values(row, colour)))
                if row.state is not TaskState.DONE:
                    values = [robot, row.number, stop.id, round(stop.metres, 2), row.arrives, colour]
                    ways.append((stop.path, values))
        self.ways.show(ways, self._desk.state.site)
        self.stops.show(stops, self._desk.state.site)

    def show_placed(self, placements: list[PlacementReport]) -> None:
        """Show the positions of placed cones."""
        site = self._desk.state.site
        if site is not None:
            frame = frame_of(site)
            self.placed.show(_placed_rows(placements, frame), site)

    def remove(self) -> None:
        """Remove all of them from the project."""
        for layer in (self.ways, self.stops, self.placed):
            layer.remove()


def _stop_values(row: PlanStopRow, colour: str) -> list[Any]:
    """Return the values of ``STOP_FIELDS``; the state by its protocol name in every language."""
    stop, state = row.stop, "" if row.state is None else row.state.value
    return [row.robot, row.number, row.trip, stop.kind, stop.id, row.arrives, state, row.why, colour]


def _placed_rows(placements: Sequence[PlacementReport], frame: SiteFrame) -> list[Row]:
    """Return positions of placed cones and the values of ``PLACED_FIELDS``, times in UTC."""
    if not placements:
        return []
    places = [(one.planned_x, one.planned_y, one.x, one.y) for one in placements]
    # Rounded to remove the noise, below a millimetre, of the transform from the site frame.
    in_crs = np.round(frame.to_crs(np.reshape(places, (-1, 2))), 3).reshape(-1, 4).tolist()
    rows: list[Row] = []
    for one, crs_metres in zip(placements, in_crs, strict=True):
        values = [
            one.cone or one.label, one.layout, one.robot, utc_in_words(one.placed_at),
            round(one.deviation, 4), one.planned_x, one.planned_y, one.x, one.y, one.theta,
            one.collected_at is not None, *crs_metres,
        ]  # fmt: skip
        rows.append(([(one.x, one.y)], values))
    return rows


def _style_ways(layer: QgsVectorLayer) -> None:
    symbol = QgsLineSymbol.createSimple({"line_width": "0.7", "capstyle": "round"})
    line = symbol.symbolLayer(0)
    assert isinstance(line, QgsSimpleLineSymbolLayer)
    line.setDataDefinedProperty(QgsSymbolLayer.Property.PropertyStrokeColor, QgsProperty.fromField("colour"))
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))


def _style_stops(layer: QgsVectorLayer) -> None:
    outline = {"outline_color": "255,255,255,255", "outline_width": "0.4", "size": "3.4"}
    symbol = QgsMarkerSymbol.createSimple({"name": "circle", **outline})
    mark = symbol.symbolLayer(0)
    assert isinstance(mark, QgsSimpleMarkerSymbolLayer)
    mark.setDataDefinedProperty(QgsSymbolLayer.Property.PropertyFillColor, QgsProperty.fromField("colour"))
    shape = "if(kind = 'store', 'square', if(state = 'done', 'triangle', 'circle'))"
    mark.setDataDefinedProperty(QgsSymbolLayer.Property.PropertyName, QgsProperty.fromExpression(shape))
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    around = QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint
    label(layer, "number || if(state = 'done', ' ✓', '\n' || arrives)", around, 1.0)


def _style_placed(layer: QgsVectorLayer) -> None:
    mark = {"name": "cross", "color": "0,121,92,255", "outline_color": "0,121,92,255", "size": "2.6"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(mark)))
