"""Closed roads and conflicts as ordinary vector layers: identify, attribute table, labels, printing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsFeature,
    QgsGeometry,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsPointXY,
    QgsProject,
    QgsSingleSymbolRenderer,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtCore import QObject

from ...robot_bridge.messages import ClosureReport, ConflictReport, SiteReport
from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from .desk import Desk
from .live_layers import MARK, give_style
from .road_board import time_of_day

GROUP = "Fleet"
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
        self._closures = LiveLayer(
            project, "closed_roads", tr("Closed roads"), "LineString", CLOSED_FIELDS, _style_closures
        )
        self._conflicts = LiveLayer(
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


class LiveLayer:
    """A memory layer of one kind in the site's CRS, written anew whenever its content changes."""

    def __init__(
        self,
        project: QgsProject,
        mark: str,
        name: str,
        kind: str,
        fields: str,
        style: Callable[[QgsVectorLayer], None],
    ):
        self._project, self._mark = project, mark
        self._name, self._kind, self._fields, self._style = name, kind, fields, style
        self._id: str | None = None

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none, or the user took it out."""
        return self._project.mapLayer(self._id) if self._id is not None else None

    def show(
        self, rows: Sequence[tuple[Sequence[tuple[float, float]], list[Any]]], site: SiteReport | None
    ) -> None:
        """Write ``rows`` of points in the site frame and values; nothing is made for none."""
        layer = self.layer
        if site is None or (not rows and layer is None):
            return
        crs = QgsCoordinateReferenceSystem(site.crs)
        if layer is not None and layer.crs() != crs:
            self.remove()
            layer = None
        if layer is None:
            layer = self._make(crs)
        frame = SiteFrame(site.crs, site.origin, site.rotation)
        features = []
        for points, values in rows:
            feature = QgsFeature(layer.fields())
            placed = [QgsPointXY(x, y) for x, y in frame.to_crs(np.array(points)).tolist()]
            if len(placed) == 1:
                feature.setGeometry(QgsGeometry.fromPointXY(placed[0]))
            else:
                feature.setGeometry(QgsGeometry.fromPolylineXY(placed))
            feature.setAttributes(values)
            features.append(feature)
        provider = layer.dataProvider()
        provider.truncate()
        provider.addFeatures(features)
        layer.updateExtents()
        layer.triggerRepaint()

    def remove(self) -> None:
        """Take the layer out of the project."""
        if self.layer is not None:
            dirty = self._project.isDirty()
            self._project.removeMapLayer(self._id)
            self._project.setDirty(dirty)
            self._remove_empty_group()
        self._id = None

    def _make(self, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        dirty = self._project.isDirty()
        fields = "&".join(f"field={field}" for field in self._fields.split(","))
        layer = QgsVectorLayer(f"{self._kind}?{fields}", self._name, "memory")
        layer.setCrs(crs)
        layer.setCustomProperty(MARK, self._mark)
        layer.setCustomProperty("skipMemoryLayersCheck", 1)
        if not give_style(self._project, layer):
            self._style(layer)
        self._project.addMapLayer(layer, False)
        root = self._project.layerTreeRoot()
        (root.findGroup(GROUP) or root.insertGroup(0, GROUP)).addLayer(layer)
        self._id = layer.id()
        self._project.setDirty(dirty)
        return layer

    def _remove_empty_group(self) -> None:
        root = self._project.layerTreeRoot()
        group = root.findGroup(GROUP)
        if group is not None and not group.children():
            root.removeChildNode(group)


def _closure_values(closure: ClosureReport) -> list[Any]:
    until = time_of_day(closure.until)
    reason = closure.reason or ""
    return [closure.closure, reason, closure.closed_by, time_of_day(closure.closed_at), until, closure.edges]


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
    _label(layer, words, QgsPalLayerSettings.Placement.Line)


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
    _label(layer, words, QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint)


def _label(layer: QgsVectorLayer, expression: str, placement: QgsPalLayerSettings.LabelPlacement) -> None:
    settings = QgsPalLayerSettings()
    settings.fieldName, settings.isExpression = expression, True
    settings.placement, settings.dist = placement, 1.5
    style = settings.format()
    style.setSize(9)
    buffer = style.buffer()
    buffer.setEnabled(True)
    buffer.setSize(0.8)
    style.setBuffer(buffer)
    settings.setFormat(style)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
    layer.setLabelsEnabled(True)
