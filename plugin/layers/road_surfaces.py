"""Road surfaces of layers, cached, queried in any CRS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
    QgsTask,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QObject, QThread, pyqtSignal

from ...robot_bridge.core.roads.network import Surface
from ...robot_bridge.core.roads.surface_index import NOWHERE, SurfaceIndex
from ...robot_bridge.core.sites.frame import utm_zone_of
from ..ui.errors import FleetError, SiteCrsError
from ..ui.language import tr
from ..ui.scheduling import SignallingTask
from .crs import check_site_crs
from .layer_source import LayerWatch, ObstacleSource, obstacle_sources
from .road_layers import read_surfaces
from .roles import ROAD_SURFACE, LayerExpressions, layers_with_role
from .site_transform import SiteGeoreference, transform_points_or_nan

# --- The road surfaces of layers, ready to be asked from any CRS ---

WGS84 = "EPSG:4326"


@dataclass(frozen=True)
class SurfaceSources:
    """Layers of surfaces as they are read, from any thread, and the CRS of their project."""

    sources: Sequence[ObstacleSource]
    project_crs: QgsCoordinateReferenceSystem
    transforms: QgsCoordinateTransformContext


@dataclass
class SurfaceMap:
    """Surfaces in ``crs``; ``warnings`` name layer and feature of what could not be read as it is."""

    index: SurfaceIndex
    crs: QgsCoordinateReferenceSystem
    transforms: QgsCoordinateTransformContext
    warnings: list[str] = field(default_factory=list)

    def way_from(self, crs: QgsCoordinateReferenceSystem) -> QgsCoordinateTransform:
        """Return the way from ``crs`` to that of the surfaces; without a valid CRS there is nothing to do."""
        return QgsCoordinateTransform(crs, self.crs, self.transforms)

    def at(self, x: float, y: float, way: QgsCoordinateTransform) -> Surface | None:
        """Return the surface at (x, y), which ``way`` leads from; None where there is none."""
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
    """Return what is read of ``layers``, each with its own filter and label; in the thread of the layers.

    ``scope`` is what their expressions see besides the layer.

    :raises FleetError: naming a layer that holds no areas or cannot be opened.
    """
    sources = obstacle_sources(layers, LayerExpressions(), scope)
    return SurfaceSources(sources, project_crs, transforms)


def read_surface_map(sources: SurfaceSources, feedback: QgsFeedback) -> SurfaceMap | None:
    """Return the surfaces of ``sources``; None after a cancel.

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

    Edges are straight in it, and repairs and curves are told in metres. Where a layer lies is read of one of
    its areas: to ask its server for the extent may take for ever, so it is no question for the window.
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


class SurfaceStore(QObject):
    """Keeps what was read of layers, by their ids. It lives in the main thread, and any thread may ask it.

    Another thread gets what is kept, else reads for itself: a layer tells only the main thread of changes.
    """

    forgotten = pyqtSignal()
    """Something was thrown away: read it again before it is told."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._maps: dict[Key, SurfaceMap] = {}
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self._forget)
        self._age = 0

    def layers(self) -> list[QgsVectorLayer]:
        """Return the layers of the project with the role road surface."""
        return layers_with_role(self._project, ROAD_SURFACE)

    def kept(self, layers: Sequence[QgsVectorLayer]) -> SurfaceMap | None:
        """Return what is kept of ``layers``, None where it has to be read."""
        return self._maps.get(_key(layers))

    def read(self, layers: Sequence[QgsVectorLayer]) -> SurfaceMap:
        """Return the surfaces of ``layers``, read here and now where they are not kept.

        :raises FleetError: when a layer cannot be used; names which and why.
        """
        found = self.kept(layers)
        if found is not None:
            return found
        in_main_thread = QThread.currentThread() is self.thread()
        if in_main_thread:
            self._watch.watch(layers)
        found = read_surface_map(self._sources(layers), QgsFeedback())
        assert found is not None
        if in_main_thread:
            self._maps[_key(layers)] = found
        return found

    def task(self, layers: Sequence[QgsVectorLayer]) -> SurfaceTask:
        """Return a task that reads ``layers`` beside the window and keeps what it read.

        :raises FleetError: as :meth:`read`.
        """
        self._watch.watch(layers)
        task = SurfaceTask(self._sources(layers), _key(layers), self._age)
        task.ended.connect(self._keep)
        return task

    def remove(self) -> None:
        """Watch no layer any longer and forget everything."""
        self._watch.remove()
        self._maps.clear()

    def _sources(self, layers: Sequence[QgsVectorLayer]) -> SurfaceSources:
        project = self._project
        scope = QgsExpressionContext()
        scope.appendScope(QgsExpressionContextUtils.globalScope())
        scope.appendScope(QgsExpressionContextUtils.projectScope(project))
        return surface_sources(layers, project.crs(), project.transformContext(), scope)

    def _keep(self, task: SurfaceTask, done: bool) -> None:
        # What changed while it was read has to be read once more.
        if done and task.surfaces is not None and task.age == self._age:
            self._maps[task.key] = task.surfaces

    def _forget(self) -> None:
        self._age += 1
        self._maps.clear()
        self.forgotten.emit()


class SurfaceTask(SignallingTask):
    """Reads surfaces in a worker: ``surfaces`` is there afterwards, or ``why`` not.

    ``key`` and ``age`` are the store's.
    """

    def __init__(self, sources: SurfaceSources, key: Key, age: int):
        super().__init__(tr("Reading road surfaces"), QgsTask.Flag.CanCancel)
        self.key, self.age = key, age
        self._sources = sources
        self._feedback = QgsFeedback()
        self.surfaces: SurfaceMap | None = None
        self.why = ""

    def run(self) -> bool:
        try:
            self.surfaces = read_surface_map(self._sources, self._feedback)
        except FleetError as error:
            self.why = str(error)
        return self.surfaces is not None

    def cancel(self) -> None:
        self._feedback.cancel()
        super().cancel()


def _key(layers: Sequence[QgsVectorLayer]) -> Key:
    return tuple(layer.id() for layer in layers)
