"""The plan and the placed cones on the map, as layers of the group Fleet."""

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

from ....robot_bridge.messages import PlacementReport, TaskState
from ....robot_bridge.sites.frame import SiteFrame
from ...language import tr
from ..desk import Desk
from ..placement import frame_of
from ..row_layer import Row, RowLayer, label
from .as_placed import utc_in_words
from .as_placed_pdf import PLACED
from .draft import Draft
from .plan_rows import StopRow, colour_of

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
"""As in what ``robot-bridge placements export`` writes, so that the as-placed report takes it."""


class PlanLayers:
    """Made when there is something to show, and taken out with the plugin."""

    def __init__(self, desk: Desk):
        self._desk = desk
        project = desk.project
        self.ways = RowLayer(
            project, "cone_plan_ways", tr("Cone plan, ways"), "LineString", WAY_FIELDS, _style_ways
        )
        self.stops = RowLayer(
            project, "cone_plan_stops", tr("Cone plan, stops"), "Point", STOP_FIELDS, _style_stops
        )
        self.placed = RowLayer(project, PLACED, tr("Cones as placed"), "Point", PLACED_FIELDS, _style_placed)

    def show(self, draft: Draft | None, rows: Mapping[str, Sequence[StopRow]]) -> None:
        """Show a plan by the rows of each robot; nothing for none."""
        stops, ways = [], []
        for robot, theirs in (rows if draft is not None else {}).items():
            colour = colour_of(draft.plan, robot)
            for row in theirs:
                stop = row.stop
                stops.append(([(stop.x, stop.y)], _stop_values(row, colour)))
                if row.state is not TaskState.DONE:
                    values = [robot, row.number, stop.id, round(stop.metres, 2), row.arrives, colour]
                    ways.append((stop.path, values))
        self.ways.show(ways, self._desk.site)
        self.stops.show(stops, self._desk.site)

    def show_placed(self, placements: list[PlacementReport]) -> None:
        """Show where cones were put down."""
        site = self._desk.site
        if site is not None:
            frame = frame_of(site)
            self.placed.show(_placed_rows(placements, frame), site)

    def remove(self) -> None:
        """Take all of them out of the project."""
        for layer in (self.ways, self.stops, self.placed):
            layer.remove()


def _stop_values(row: StopRow, colour: str) -> list[Any]:
    """Return the values of ``STOP_FIELDS``; the state as the protocol has it, whatever QGIS speaks."""
    stop, state = row.stop, "" if row.state is None else row.state.value
    return [row.robot, row.number, row.trip, stop.kind, stop.id, row.arrives, state, row.why, colour]


def _placed_rows(placements: Sequence[PlacementReport], frame: SiteFrame) -> list[Row]:
    """Return where cones were put down and the values of ``PLACED_FIELDS``, times in UTC."""
    if not placements:
        return []
    places = [(one.planned_x, one.planned_y, one.x, one.y) for one in placements]
    # Without the noise, below a millimetre, of the way from the site's frame.
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
