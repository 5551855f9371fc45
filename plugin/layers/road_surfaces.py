"""Road surfaces of layers, cached, queried in any CRS."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeatureRequest,
    QgsFeedback,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QObject, QThread, pyqtSignal

from ...robot_bridge.core.roads.network import Surface
from ...robot_bridge.core.roads.surface_index import NOWHERE, SurfaceIndex
from ...robot_bridge.core.sites.frame import utm_zone_of
from ..ui.errors import FleetError, SiteCrsError
from ..ui.language import tr
from ..ui.scheduling import BackgroundReading
from .crs import check_site_crs
from .layer_source import LayerWatch, ObstacleSource, obstacle_sources
from .reading import thread_feedback
from .road_layers import read_surfaces
from .roles import ROAD_SURFACE, LayerExpressions, layers_with_role
from .site_transform import SiteGeoreference, transform_points_or_nan

# --- The road surfaces of layers, for queries in any CRS ---

WGS84 = "EPSG:4326"


@dataclass(frozen=True)
class SurfaceSources:
    """Sources of layers of surfaces, readable from any thread, and the CRS of their project."""

    sources: Sequence[ObstacleSource]
    project_crs: QgsCoordinateReferenceSystem
    transforms: QgsCoordinateTransformContext


@dataclass
class SurfaceMap:
    """Surfaces in ``crs``; ``warnings`` name layer and feature of everything not read unchanged."""

    index: SurfaceIndex
    crs: QgsCoordinateReferenceSystem
    transforms: QgsCoordinateTransformContext
    warnings: list[str] = field(default_factory=list)

    def way_from(self, crs: QgsCoordinateReferenceSystem) -> QgsCoordinateTransform:
        """Return the transform from ``crs`` to that of the surfaces; without a valid CRS the identity."""
        return QgsCoordinateTransform(crs, self.crs, self.transforms)

    def at(self, x: float, y: float, way: QgsCoordinateTransform) -> Surface | None:
        """Return the surface at (x, y), in the source CRS of ``way``; None where there is none."""
        if not way.isShortCircuited():
            try:
                point = way.transform(QgsPointXY(x, y))
            except QgsCsException:
                return None
            x, y = point.x(), point.y()
        return self.index.surface_at(x, y)

    def at_many(self, xy: np.ndarray, way: QgsCoordinateTransform) -> list[Surface | None]:
        """Return the surface at each of (n, 2) coordinates, None where there is none."""
        numbers = self.index.at_many(transform_points_or_nan(xy, way)).tolist()
        return [None if k == NOWHERE else self.index.surfaces[k] for k in numbers]


def surface_sources(
    layers: Sequence[QgsVectorLayer],
    project_crs: QgsCoordinateReferenceSystem,
    transforms: QgsCoordinateTransformContext,
    scope: QgsExpressionContext,
) -> SurfaceSources:
    """Return the sources of ``layers``, each with its own filter and label; in the thread of the layers.

    ``scope`` is available to their expressions besides the layer.

    :raises FleetError: naming a layer that holds no areas or cannot be opened.
    """
    sources = obstacle_sources(layers, LayerExpressions(), scope)
    return SurfaceSources(sources, project_crs, transforms)


def read_surface_map(sources: SurfaceSources, feedback: QgsFeedback) -> SurfaceMap | None:
    """Return the surfaces of ``sources``; None if cancelled.

    :raises FleetError: when a layer has no known place or an expression is not one.
    """
    crs = _crs_in_metres(sources)
    site = SiteGeoreference.in_crs(crs, sources.transforms)
    reading = read_surfaces(sources.sources, site, feedback)
    if not reading.complete or feedback.isCanceled():
        return None
    return SurfaceMap(SurfaceIndex(reading.items), crs, sources.transforms, reading.warnings)


def _crs_in_metres(sources: SurfaceSources) -> QgsCoordinateReferenceSystem:
    """Return the first CRS of layers and project that is a plane in metres, else the UTM zone of a layer.

    Edges are straight in it, and repairs and curves are in metres. The location of a layer is read from one
    of its areas: querying its server for the extent may block for ever, and must not be done in the window.
    """
    for crs in (*(source.crs for source in sources.sources), sources.project_crs):
        if crs.isValid() and _carries(crs):
            return crs
    for source in sources.sources:
        place = next(_places(source), None) if source.crs.isValid() else None
        if place is not None:
            way = QgsCoordinateTransform(source.crs, QgsCoordinateReferenceSystem(WGS84), sources.transforms)
            try:
                centre = way.transform(place)
            except QgsCsException:
                continue
            return QgsCoordinateReferenceSystem(utm_zone_of(centre.x(), centre.y()))
    return QgsCoordinateReferenceSystem()


def _places(source: ObstacleSource) -> Iterator[QgsPointXY]:
    """Yield the middle of each area of a layer."""
    for feature in source.features.getFeatures(QgsFeatureRequest().setNoAttributes()):
        if not feature.geometry().isEmpty():
            yield feature.geometry().boundingBox().center()


def _carries(crs: QgsCoordinateReferenceSystem) -> bool:
    try:
        check_site_crs(crs)
    except SiteCrsError:
        return False
    return True


# --- The road surfaces of layers, kept until one of the layers changes ---

Key = tuple[str, ...]
_WAIT_S = 0.5
"""Seconds that an expression in the window's thread waits for surfaces; enough for most sites."""


class SurfaceStore(QObject):
    """Cache of surfaces, by the ids of their layers. It lives in the main thread, usable from any thread.

    Another thread gets the cached ones, else reads for itself: a layer signals changes only in the main
    thread. If the main thread ``has_window`` it waits for no layer.
    """

    forgotten = pyqtSignal()
    """A cache entry was dropped: have it read again where it is still needed."""
    ended = pyqtSignal(object, str)
    """The layers of a key have been read and are cached, or the text is the error."""

    def __init__(self, project: QgsProject, parent: QObject | None = None, *, has_window: bool = True):
        super().__init__(parent)
        self._project = project
        self._has_window = has_window
        self._maps: dict[Key, SurfaceMap] = {}
        self._readings: dict[Key, BackgroundReading[SurfaceMap | None]] = {}
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self._forget)

    def layers(self) -> list[QgsVectorLayer]:
        """Return the layers of the project with the role road surface."""
        return layers_with_role(self._project, ROAD_SURFACE)

    def kept(self, layers: Sequence[QgsVectorLayer]) -> SurfaceMap | None:
        """Return the cached surfaces of ``layers``, None where they must be read."""
        return self._maps.get(key_of(layers))

    def read(self, layers: Sequence[QgsVectorLayer]) -> SurfaceMap:
        """Return the surfaces of ``layers``, for an expression.

        :raises FleetError: when a layer cannot be used, or not yet; names which and why.
        """
        found = self.kept(layers)
        if found is not None:
            return found
        if QThread.currentThread() is self.thread() and self._has_window:
            return self._read_soon(layers)
        found = read_surface_map(self._sources(layers), QgsFeedback())
        assert found is not None
        return found

    def begin(self, layers: Sequence[QgsVectorLayer]) -> None:
        """Have ``layers`` read in a thread, unless that is under way; :attr:`ended` follows.

        :raises FleetError: as :meth:`read`.
        """
        key = key_of(layers)
        if key in self._readings and self._readings[key].is_under_way:
            return
        self._watch.watch(layers)
        reader = _SurfaceReader(self._sources(layers))
        if key not in self._readings:
            self._readings[key] = BackgroundReading(self)
            self._readings[key].ended.connect(lambda: self._keep(key))
        self._readings[key].begin(reader)

    def remove(self) -> None:
        """Stop watching layers and forget everything."""
        self._watch.remove()
        self._stop()
        self._maps.clear()

    def _read_soon(self, layers: Sequence[QgsVectorLayer]) -> SurfaceMap:
        key = key_of(layers)
        self.begin(layers)
        self._readings[key].wait(_WAIT_S)
        if self._readings[key].is_under_way:
            raise FleetError(
                tr(
                    "the road surfaces are still being read ({layers}): try again soon",
                    layers=", ".join(layer.name() for layer in layers),
                )
            )
        return self._maps.get(key) or self._readings[key].result()

    def _sources(self, layers: Sequence[QgsVectorLayer]) -> SurfaceSources:
        project = self._project
        scope = QgsExpressionContext()
        scope.appendScope(QgsExpressionContextUtils.globalScope())
        scope.appendScope(QgsExpressionContextUtils.projectScope(project))
        return surface_sources(layers, project.crs(), project.transformContext(), scope)

    def _keep(self, key: Key) -> None:
        why = ""
        try:
            found = self._readings[key].result()
        except FleetError as error:
            why = str(error)
        else:
            if found is not None:
                self._maps[key] = found
        self.ended.emit(key, why)

    def _forget(self) -> None:
        # A layer that changed while it was read must be read again.
        self._stop()
        self._maps.clear()
        self.forgotten.emit()

    def _stop(self) -> None:
        for reading in self._readings.values():
            reading.stop()


class _SurfaceReader:
    """Reads surfaces in a thread."""

    def __init__(self, sources: SurfaceSources):
        self._sources = sources

    def read(self, go_on: Callable[[], bool]) -> SurfaceMap | None:
        return read_surface_map(self._sources, thread_feedback(go_on))


def key_of(layers: Sequence[QgsVectorLayer]) -> Key:
    """Return the cache key of ``layers``."""
    return tuple(layer.id() for layer in layers)
