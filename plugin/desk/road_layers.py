"""Closed roads and conflicts as ordinary vector layers: identify, attribute table, labels, printing."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsExpression,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsSingleSymbolRenderer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QObject

from ...robot_bridge.messages import ClosureReport, ConflictReport
from ..language import tr
from .desk import Desk
from .row_layer import RowLayer, label
from .wall_clock import date_and_time, time_of_day

LABEL_MM = 1.5
CLOSED_FIELDS = "closure:string,reason:string,closed_by:string,closed_at:string,until:string,edges:integer"
CONFLICT_FIELDS = (
    "robot:string,other:string,kind:string,begins:string,nearest_at:string,ends:string,metres:double"
)


class RoadLayers(QObject):
    """A layer of each, made when there is something to show and taken out with the plugin."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        project = desk.project
        self._closures = RowLayer(
            project, "closed_roads", tr("Closed roads"), "LineString", CLOSED_FIELDS, _style_closures
        )
        self._conflicts = RowLayer(
            project, "conflicts", tr("Conflicts"), "Point", CONFLICT_FIELDS, _style_conflicts
        )
        desk.roads.closures_changed.connect(self._show_closures)
        desk.roads.conflicts_changed.connect(self._show_conflicts)
        desk.site_changed.connect(self._show)

    def remove(self) -> None:
        """Take both out of the project."""
        self._closures.remove()
        self._conflicts.remove()

    def _show(self) -> None:
        self._show_closures()
        self._show_conflicts()

    def _show_closures(self) -> None:
        rows = [(closure.line, _closure_values(closure)) for closure in self._desk.roads.closures]
        self._closures.show(rows, self._desk.site)

    def _show_conflicts(self) -> None:
        conflicts = self._desk.roads.conflicts.conflicts
        rows = [([(one.x, one.y)], _conflict_values(one)) for one in conflicts]
        self._conflicts.show(rows, self._desk.site)


def _closure_values(closure: ClosureReport) -> list[Any]:
    reason, since, until = closure.reason or "", date_and_time(closure.closed_at), time_of_day(closure.until)
    return [closure.closure, reason, closure.closed_by, since, until, closure.edges]


def _conflict_values(one: ConflictReport) -> list[Any]:
    times = [time_of_day(at) for at in (one.begins, one.nearest_at, one.ends)]
    return [one.robot, one.other, one.kind, *times, one.metres]


def _style_closures(layer: QgsVectorLayer) -> None:
    line = {"line_color": "198,40,40,255", "line_width": "1.6", "line_style": "solid", "capstyle": "round"}
    symbol = QgsLineSymbol.createSimple(line)
    symbol.appendSymbolLayer(
        QgsLineSymbol.createSimple(
            {"line_color": "255,255,255,255", "line_width": "0.6", "line_style": "dash"}
        ).takeSymbolLayer(0)
    )
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    closed = QgsExpression.quotedString(tr("closed"))
    until = QgsExpression.quotedString(tr("until"))
    words = (
        f"{closed} || if(reason != '', ': ' || reason, '')"
        f" || if(until != '', ', ' || {until} || ' ' || until, '')"
    )
    label(layer, words, QgsPalLayerSettings.Placement.Line, LABEL_MM)


def _style_conflicts(layer: QgsVectorLayer) -> None:
    mark = {
        "name": "triangle",
        "color": "255,193,7,255",
        "outline_color": "33,33,33,255",
        "outline_width": "0.5",
        "size": "6",
    }
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(mark)))
    words = "robot || ' × ' || other || ' ' || nearest_at"
    label(layer, words, QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint, LABEL_MM)
