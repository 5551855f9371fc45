"""A memory layer with a feature for each row of what the desk knows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsLineString,
    QgsPalLayerSettings,
    QgsPoint,
    QgsProject,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtGui import QColor

from ...robot_bridge.messages import SiteReport
from ...robot_bridge.sites.frame import SiteFrame
from ..sites.fleet_group import fleet_group, leave_clean, remove_if_empty
from .live_layers import give_style, make_live
from .placement import frame_of
from .project_watch import ProjectWatch
from .time_slices import Steps, TimeSlices

Row = tuple[Sequence[tuple[float, float]], Sequence[Any]]
"""Points in the site frame, one for a point layer, and the values of the fields."""

AT_ONCE = 50
"""Features written in one step of a slice."""


class RowLayer:
    """A layer of one kind of geometry in the site's CRS; made when there is a row to show.

    It goes with its project, and comes anew in the next one: what it shows is the desk's, not the project's.
    It is written in slices, between which the window looks for events.
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
        self._has_changed = False
        """Whether it was written since it was painted."""
        self._shown: tuple[Sequence[Row], SiteReport | None] = ((), None)
        self._writing = TimeSlices()
        self._watch = ProjectWatch(project)
        self._watch.opened.connect(self._renew)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none, or the user took it out."""
        return self._project.mapLayer(self._id) if self._id is not None else None

    def show(self, rows: Sequence[Row], site: SiteReport | None) -> None:
        """Have a feature for each of ``rows`` soon; those that are there already are left as they are."""
        self._shown = rows, site
        self._renew()

    def finish(self) -> None:
        """Write at once all that is left to be: somebody is about to take the layer as it is."""
        self._writing.finish()

    def remove(self) -> None:
        """Take the layer out of the project for good, and show nothing in the next one."""
        self._watch.remove()
        self._writing.stop()
        self._shown = (), None
        self._take_out()

    def _renew(self) -> None:
        self._writing.begin_soon(self._renewed())

    def _renewed(self) -> Steps[None]:
        """Show what is to be shown; begin anew where the layer is taken out meanwhile."""
        for share in self._steps(*self._shown):
            yield share
            if self.layer is None:
                self._renew()
                return

    def _steps(self, rows: Sequence[Row], site: SiteReport | None) -> Iterator[float]:
        if self._watch.is_reading or site is None or (not rows and self.layer is None):
            return
        self._have_layer(site)
        yield 0.0
        new = self._left_of(rows)
        for first in range(0, len(new), AT_ONCE):
            yield first / len(new)
            self._write(new[first : first + AT_ONCE])
        if self._has_changed:
            self._has_changed = False
            self.layer.updateExtents()
            self.layer.triggerRepaint()

    def _have_layer(self, site: SiteReport) -> None:
        """Have a layer in the site's CRS, without what was written of a site that lay elsewhere."""
        if self.layer is not None and self.layer.crs() != QgsCoordinateReferenceSystem(site.crs):
            self._take_out()
        frame = frame_of(site)
        if self.layer is None:
            self._make(site.crs)
        elif frame != self._frame:
            self.layer.dataProvider().truncate()
        else:
            return
        self._frame, self._written = frame, {}

    def _take_out(self) -> None:
        if self.layer is not None:
            dirty = self._project.isDirty()
            self._project.removeMapLayer(self._id)
            remove_if_empty(self._project)
            leave_clean(self._project, dirty)
        self._id = None

    def _left_of(self, rows: Sequence[Row]) -> list[Row]:
        """Delete features whose rows are gone, and return the rows that have none yet."""
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
        self.layer.dataProvider().deleteFeatures(gone)
        self._written = after
        self._has_changed = self._has_changed or bool(gone or new)
        return new

    def _write(self, rows: Sequence[Row]) -> None:
        """Add a feature for each of ``rows``."""
        _, added = self.layer.dataProvider().addFeatures(_features(self.layer, rows, self._frame))
        for (points, values), feature in zip(rows, added, strict=True):
            self._written.setdefault(tuple(values), []).append((points, feature.id()))

    def _make(self, crs: str) -> None:
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
        leave_clean(self._project, dirty)


def _features(layer: QgsVectorLayer, rows: Sequence[Row], frame: SiteFrame) -> list[QgsFeature]:
    fields = layer.fields()
    # All at once: to take each row's few points to the map takes longer than all else.
    placed = frame.to_crs(np.concatenate([np.array(points) for points, _ in rows]))
    ends = np.cumsum([len(points) for points, _ in rows])[:-1]
    features = []
    for (_, values), line in zip(rows, np.split(placed, ends), strict=True):
        x, y = line.T.tolist()
        feature = QgsFeature(fields)
        feature.setGeometry(QgsGeometry(QgsPoint(x[0], y[0]) if len(x) == 1 else QgsLineString(x, y)))
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
