"""A memory layer with a feature for each row of what the desk knows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsPalLayerSettings,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtGui import QColor

from ...robot_bridge.messages import SiteReport
from ...robot_bridge.sites.frame import SiteFrame
from ..sites.fleet_group import fleet_group, remove_if_empty
from .live.project_watch import ProjectWatch
from .live_layers import give_style, make_live

Row = tuple[Sequence[tuple[float, float]], Sequence[Any]]
"""Points in the site frame, one for a point layer, and the values of the fields."""


class RowLayer:
    """A layer of one kind of geometry in the site's CRS; made when there is a row to show.

    It goes with its project, and comes anew in the next one: what it shows is the desk's, not the project's.
    """

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
        self._frame: SiteFrame | None = None
        self._written: dict[tuple[Any, ...], list[tuple[Sequence[tuple[float, float]], int]]] = {}
        """The points and the id of each feature, by its values."""
        self._shown: tuple[Sequence[Row], SiteReport | None] = ((), None)
        self._watch = ProjectWatch(project)
        self._watch.opened.connect(self._show_again)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none, or the user took it out."""
        return self._project.mapLayer(self._id) if self._id is not None else None

    def show(self, rows: Sequence[Row], site: SiteReport | None) -> None:
        """Have a feature for each of ``rows``; those that are there already are left as they are."""
        self._shown = rows, site
        layer = self.layer
        if self._watch.is_reading or site is None or (not rows and layer is None):
            return
        frame = SiteFrame(site.crs, site.origin, site.rotation)
        if layer is not None and layer.crs() != QgsCoordinateReferenceSystem(site.crs):
            self._take_out()
            layer = None
        if layer is None:
            layer, self._frame, self._written = self._make(site.crs), frame, {}
        if frame != self._frame:
            layer.dataProvider().truncate()
            self._frame, self._written = frame, {}
        if self._write(layer, rows, frame):
            layer.updateExtents()
            layer.triggerRepaint()

    def remove(self) -> None:
        """Take the layer out of the project, and show nothing in the next one."""
        self._shown = (), None
        self._take_out()

    def _show_again(self) -> None:
        self.show(*self._shown)

    def _take_out(self) -> None:
        if self.layer is not None:
            dirty = self._project.isDirty()
            self._project.removeMapLayer(self._id)
            self._project.setDirty(dirty)
            remove_if_empty(self._project)
        self._id = None

    def _write(self, layer: QgsVectorLayer, rows: Sequence[Row], frame: SiteFrame) -> bool:
        """Delete the features whose rows are gone, add those of new rows, and tell whether there were any."""
        before, after = self._written, {}
        new: list[Row] = []
        for points, values in rows:
            same = before.get(tuple(values), [])
            at = next((k for k, (known, _) in enumerate(same) if known == points), None)
            if at is None:
                new.append((points, values))
            else:
                after.setdefault(tuple(values), []).append(same.pop(at))
        gone = [number for features in before.values() for _, number in features]
        provider = layer.dataProvider()
        provider.deleteFeatures(gone)
        _, added = provider.addFeatures(_features(layer, new, frame))
        for (points, values), feature in zip(new, added, strict=True):
            after.setdefault(tuple(values), []).append((points, feature.id()))
        self._written = after
        return bool(gone or new)

    def _make(self, crs: str) -> QgsVectorLayer:
        dirty = self._project.isDirty()
        fields = "&".join(f"field={field}" for field in self._fields.split(","))
        layer = QgsVectorLayer(f"{self._kind}?{fields}", self._name, "memory")
        layer.setCrs(QgsCoordinateReferenceSystem(crs))
        make_live(layer, self._mark)
        if not give_style(self._project, layer):
            self._style(layer)
        self._project.addMapLayer(layer, False)
        fleet_group(self._project).addLayer(layer)
        self._id = layer.id()
        self._project.setDirty(dirty)
        return layer


def _features(layer: QgsVectorLayer, rows: Sequence[Row], frame: SiteFrame) -> list[QgsFeature]:
    if not rows:
        return []
    fields = layer.fields()
    # All at once: to take each row's few points to the map takes longer than all else.
    placed = iter(frame.to_crs(np.concatenate([np.array(points) for points, _ in rows])).tolist())
    features = []
    for points, values in rows:
        line = [QgsPointXY(*next(placed)) for _ in points]
        is_point = len(line) == 1
        feature = QgsFeature(fields)
        feature.setGeometry(
            QgsGeometry.fromPointXY(line[0]) if is_point else QgsGeometry.fromPolylineXY(line)
        )
        feature.setAttributes(list(values))
        features.append(feature)
    return features


def label(
    layer: QgsVectorLayer,
    expression: str,
    placement: QgsPalLayerSettings.LabelPlacement,
    millimetres: float,
) -> None:
    """Label the features with an expression, so far from them, readable on any ground."""
    settings = QgsPalLayerSettings()
    settings.fieldName, settings.isExpression = expression, True
    settings.placement, settings.dist = placement, millimetres
    letters = settings.format()
    letters.setSize(9)
    letters.setColor(QColor("#101418"))
    ground = letters.buffer()
    ground.setEnabled(True)
    ground.setColor(QColor("#FFFFFF"))
    ground.setOpacity(1.0)
    ground.setSize(1.0)
    letters.setBuffer(ground)
    settings.setFormat(letters)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
    layer.setLabelsEnabled(True)
