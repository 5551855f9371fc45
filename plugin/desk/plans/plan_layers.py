"""The plan and the placed cones on the map, as layers of the group Fleet."""

from __future__ import annotations

from typing import Any

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
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtGui import QColor

from ....robot_bridge.messages import PlacementReport
from ...language import tr
from ..desk import Desk
from ..road_board import time_of_day
from ..road_layers import LiveLayer
from .draft_plan import Draft
from .plan_rows import colour_of, rows_of
from .progress import Progress

STOP_FIELDS = (
    "robot:string,number:integer,trip:integer,kind:string,id:string,arrives:string,state:string,colour:string"
)
WAY_FIELDS = "robot:string,number:integer,to_stop:string,metres:double,arrives:string,colour:string"
PLACED_FIELDS = (
    "cone:string,layout:string,robot:string,placed_at:string,deviation:double,planned_x:double,"
    "planned_y:double,x:double,y:double,theta:double,collected:boolean"
)


class PlanLayers:
    """Made when there is something to show, and taken out with the plugin."""

    def __init__(self, desk: Desk):
        self._desk = desk
        project = desk.project
        self.ways = LiveLayer(
            project, "cone_plan_ways", tr("Cone plan, ways"), "LineString", WAY_FIELDS, _style_ways
        )
        self.stops = LiveLayer(
            project, "cone_plan_stops", tr("Cone plan, stops"), "Point", STOP_FIELDS, _style_stops
        )
        self.placed = LiveLayer(
            project, "cones_as_placed", tr("Cones as placed"), "Point", PLACED_FIELDS, _style_placed
        )
        self._shown: tuple[Any, ...] = ()

    def show(self, draft: Draft | None, progress: Progress | None) -> None:
        """Show a plan; nothing for none."""
        stops, ways = [], []
        for robot, rows in (rows_of(draft, progress) if draft is not None else {}).items():
            colour = colour_of(draft.plan, robot)
            for row in rows:
                stop = row.stop
                values = [robot, row.number, row.trip, stop.kind, stop.id, row.arrives, row.state, colour]
                stops.append(([(stop.x, stop.y)], values))
                if row.state != "done":
                    values = [robot, row.number, stop.id, round(stop.metres, 2), row.arrives, colour]
                    ways.append((list(stop.path), values))
        shown = (tuple(tuple(values) for _, values in stops), id(draft))
        if shown != self._shown:
            self._shown = shown
            self.ways.show(ways, self._desk.site)
            self.stops.show(stops, self._desk.site)

    def show_placed(self, placements: list[PlacementReport]) -> None:
        """Show where cones were put down."""
        self.placed.show([([(one.x, one.y)], _placed_values(one)) for one in placements], self._desk.site)

    def remove(self) -> None:
        """Take all of them out of the project."""
        for layer in (self.ways, self.stops, self.placed):
            layer.remove()
        self._shown = ()


def _placed_values(one: PlacementReport) -> list[Any]:
    return [
        one.cone, one.layout, one.robot, time_of_day(one.placed_at), round(one.deviation, 4), one.planned_x,
        one.planned_y, one.x, one.y, one.theta, one.collected_at is not None,
    ]  # fmt: skip


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
    _label(layer, "number || if(state = 'done', ' ✓', '\n' || arrives)")


def _style_placed(layer: QgsVectorLayer) -> None:
    mark = {"name": "cross", "color": "0,121,92,255", "outline_color": "0,121,92,255", "size": "2.6"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(mark)))


def _label(layer: QgsVectorLayer, expression: str) -> None:
    settings = QgsPalLayerSettings()
    settings.fieldName, settings.isExpression = expression, True
    settings.placement = QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint
    settings.dist = 1.0
    style = settings.format()
    style.setSize(9)
    style.setColor(QColor("#101418"))
    buffer = style.buffer()
    buffer.setEnabled(True)
    buffer.setColor(QColor("#FFFFFF"))
    buffer.setOpacity(1.0)
    buffer.setSize(1.0)
    style.setBuffer(buffer)
    settings.setFormat(style)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
    layer.setLabelsEnabled(True)
