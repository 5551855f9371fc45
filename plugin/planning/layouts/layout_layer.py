"""Layer of cone layouts, the GeoPackage that keeps it, and checks of a layout against the ground."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsFeatureRequest,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsVectorFileWriter,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
)
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.core.layouts.layout import Cone, ConeFinding, NamedGeometry, find_misplaced_cones
from ...control.messages import MessageBar
from ...layers.crs import check_site_crs
from ...layers.layer_source import LayerWatch, ObstacleSource, obstacle_sources
from ...layers.reading import IN_MEMORY, OneAtATime, thread_feedback
from ...layers.road_layers import read_areas
from ...layers.roles import OBSTACLE_ROLES, ROAD_SURFACE, LayerExpressions, layers_with_role, setup_of
from ...layers.site_transform import LayerToSiteTransform, SiteGeoreference
from ...processing.common.algorithm import RESOURCES
from ...processing.common.cone_layers import CONE_FIELDS, cone_values, point_rows, read_obstacles
from ...ui.errors import FleetError, MapTransformError
from ...ui.language import tr
from ...ui.scheduling import BackgroundReading, Steps

# --- The layer of the operator's cone layouts, and the checks of a layout ---

MARK = "fleet/cones"
"""The custom property that marks the layer."""

OBSTACLE_DISTANCE_M = CONE_DISTANCE_M = 0.5


class StandingCone(NamedTuple):
    """A cone in the layer; ``number`` is its feature's id, (x, y) is in the CRS of the layer."""

    number: int
    id: str
    x: float
    y: float


class StandingReader:
    """Reads the cones of a layer, in any thread."""

    def __init__(self, layer: QgsVectorLayer):
        self._name = layer.name()
        self._features = QgsVectorLayerFeatureSource(layer)

    def read(self, go_on: Callable[[], bool]) -> list[StandingCone]:
        """Return the cones; raises LayerReadingError naming a feature that is not one point."""
        features = takewhile(lambda _: go_on(), self._features.getFeatures(QgsFeatureRequest()))
        rows = point_rows(self._name, features, LayerToSiteTransform(None, None), ("id",))
        return [StandingCone(row.feature, row.name, row.x, row.y) for row in rows]


class LayoutLayer:
    """Finds or creates the layer of cones in a project."""

    def __init__(self, project: QgsProject):
        self._project = project
        self._readings = OneAtATime()

    def layer(self) -> QgsVectorLayer | None:
        """Return the layer of cones, None before there is one."""
        marked = (one for one in self._project.mapLayers().values() if one.customProperty(MARK))
        return next((one for one in marked if one.isValid()), None)

    def crs(self, canvas: QgsCoordinateReferenceSystem) -> QgsCoordinateReferenceSystem:
        """Return the CRS of the cones: their layer's, else the canvas's.

        :raises SiteCrsError: when the canvas's CRS has no true metres.
        :raises MapTransformError: when there is none.
        """
        layer = self.layer()
        if layer is not None:
            return layer.crs()
        if not canvas.isValid():
            raise MapTransformError(
                tr("The project has no CRS: choose one in metres, at the bottom right in QGIS.")
            )
        check_site_crs(canvas)
        return canvas

    def prefix(self, name: str, standing: Sequence[StandingCone]) -> str:
        """Return the id prefix of another layout ``name``: no ``standing`` cone has it."""
        ids = {cone.id.rpartition("-")[0] for cone in standing}
        taken = (f"{name}-{number}" for number in range(2, len(ids) + 3))
        return name if name not in ids else next(prefix for prefix in taken if prefix not in ids)

    def add(self, cones: Sequence[Cone], name: str, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        """Add ``cones``, which are in ``crs``, to the layer; create it where there is none.

        :raises MapTransformError: when the layer lacks a field, or cannot be written.
        """
        layer = self.layer() or self._made(crs)
        if missing := [field for field in CONE_FIELDS if layer.fields().indexOf(field) < 0]:
            raise MapTransformError(
                tr(
                    "The layer {layer} takes no cones without the fields {fields}: add them, or remove the "
                    "layer.",
                    layer=layer.name(),
                    fields=", ".join(missing),
                )
            )
        features = []
        for cone in cones:
            feature = QgsFeature(layer.fields())
            feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(cone.x, cone.y)))
            values = dict(zip(CONE_FIELDS, cone_values(cone, name), strict=True))
            for field, value in values.items():
                feature.setAttribute(field, value)
            features.append(feature)
        added, _ = layer.dataProvider().addFeatures(features)
        if not added:
            raise MapTransformError(
                tr(
                    "The layer {layer} takes no cones: make it writable, or remove it.",
                    layer=layer.name(),
                )
            )
        layer.updateExtents()
        layer.triggerRepaint()
        return layer

    def remove_cones(self, layer_id: str, ids: Collection[str]) -> Steps[bool]:
        """Remove the cones ``ids`` from the layer ``layer_id``; false where it has none of them any more.

        :raises LayerReadingError: as :meth:`standing`.
        """
        standing = yield from self.standing()
        layer = self.layer()
        if layer is None or layer.id() != layer_id:
            return False
        found = [cone.number for cone in standing if cone.id in ids]
        if not found or not layer.dataProvider().deleteFeatures(found):
            return False
        layer.updateExtents()
        layer.triggerRepaint()
        return True

    def standing(self) -> Steps[list[StandingCone]]:
        """Return the cones in the layer, in its CRS.

        :raises LayerReadingError: when the layer does not answer, and at a feature that is not one point.
        :raises MapTransformError: when it has been replaced meanwhile.
        """
        layer = self.layer()
        if layer is None:
            return []
        number, name, reader = layer.id(), layer.name(), StandingReader(layer)
        found = yield from self._readings.read(name, reader)
        layer = self.layer()
        if layer is None or layer.id() != number:
            raise MapTransformError(tr("The layer of cones is another one now: place the layout again."))
        return found

    def _made(self, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        fields = "".join(f"&field={name}:{kind}" for name, kind in CONE_FIELDS.items())
        layer = QgsVectorLayer(f"Point?crs={crs.authid() or crs.toWkt()}{fields}", tr("Cones"), "memory")
        layer.loadNamedStyle(str(RESOURCES / "styles" / "cones.qml"))
        layer.setCustomProperty(MARK, "1")
        self._project.addMapLayer(layer)
        return layer


# --- The GeoPackage beside the project that stores the operator's cones when the project is saved ---

TABLE = "cones"


class LayoutFile(QObject):
    """Moves the layer of cones from memory into a file when its project is saved.

    A layer that is in a file already, here or elsewhere, is left alone. :meth:`remove` undoes the
    constructor.
    """

    def __init__(self, project: QgsProject, notices: MessageBar, parent: QObject | None = None):
        super().__init__(parent)
        self._project, self._notices = project, notices
        self._store = LayoutLayer(project)
        # Emitted before the layers are written, with the source that they have then.
        project.writeProject.connect(self._keep_cones)

    def remove(self) -> None:
        """Stop acting on the saving of projects."""
        self._project.writeProject.disconnect(self._keep_cones)

    def _keep_cones(self, *_document: object) -> None:
        layer = self._store.layer()
        if layer is None or layer.providerType() != IN_MEMORY:
            return
        path = _free_path(self._project)
        problem = tr("the project is not a file") if path is None else self._move(layer, path)
        if problem:
            self._notices.warning(
                tr(
                    "The cones of the layer {layer} are not saved with the project: {problem}. Export the "
                    "layer to a file before you close QGIS.",
                    layer=layer.name(),
                    problem=problem,
                )
            )

    def _move(self, layer: QgsVectorLayer, path: Path) -> str:
        """Write ``layer`` to ``path`` and switch it to that file; return an error text, empty on success."""
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.driverName, options.layerName = "GPKG", TABLE
        # The version of the format that GDAL 3.6 and older read.
        options.datasourceOptions = ["VERSION=1.3"]
        context = self._project.transformContext()
        error, words, *_ = QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(path), context, options)
        if error != QgsVectorFileWriter.WriterError.NoError:
            return tr("{path} cannot be written ({words})", path=path, words=words)
        source = f"{path}|layername={TABLE}"
        # Before the layer in use drops the cones in memory.
        if not QgsVectorLayer(source, TABLE, "ogr").isValid():
            return tr("{path} cannot be read again", path=path)
        layer.setDataSource(source, layer.name(), "ogr", False)
        return ""


def _free_path(project: QgsProject) -> Path | None:
    """Return an unused file name beside the project; None for a project that is no file."""
    if project.projectStorage() is not None or not project.absoluteFilePath():
        return None
    file = Path(project.absoluteFilePath())
    names = [f"{file.stem}_cones{number}.gpkg" for number in ("", *(f"_{k}" for k in range(2, 1000)))]
    return next((path for name in names if not (path := file.with_name(name)).exists()), None)


# --- Errors of a cone layout while it is still under the cursor, found without blocking the window ---

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class LayoutGround:
    """Surfaces that cones stand on, None where no layer has any, and obstacles; metres in one CRS."""

    surfaces: tuple[NamedGeometry, ...] | None
    obstacles: tuple[NamedGeometry, ...]

    def bad_cones(self, cones: Sequence[Cone], standing: Floats) -> Floats:
        """Return the positions of ``cones`` that should not stand there, (n, 2); ``standing`` is (m, 2)."""
        xy = np.array([(cone.x, cone.y) for cone in cones], dtype=np.float64).reshape(-1, 2)
        if not len(xy):
            return xy
        low, high = xy.min(axis=0) - OBSTACLE_DISTANCE_M, xy.max(axis=0) + OBSTACLE_DISTANCE_M
        surfaces = None if self.surfaces is None else _meeting(self.surfaces, self._surface_boxes, low, high)
        obstacles = _meeting(self.obstacles, self._obstacle_boxes, low, high)
        wrong = {
            one.cone
            for one in find_misplaced_cones(cones, surfaces, obstacles, OBSTACLE_DISTANCE_M, CONE_DISTANCE_M)
        }
        near = standing[((standing >= low) & (standing <= high)).all(axis=1)]
        apart = np.hypot(*(xy[:, None, :] - near[None, :, :]).transpose(2, 0, 1))
        bad = np.array([cone.id in wrong for cone in cones]) | (apart < CONE_DISTANCE_M - 1e-9).any(axis=1)
        return xy[bad]

    def findings(self, cones: Sequence[Cone], standing: Sequence[StandingCone]) -> list[ConeFinding]:
        """Return the findings on ``cones`` here, among those that stand already."""
        xy = np.array([(cone.x, cone.y) for cone in cones], dtype=np.float64).reshape(-1, 2)
        low, high = xy.min(axis=0) - OBSTACLE_DISTANCE_M, xy.max(axis=0) + OBSTACLE_DISTANCE_M
        surfaces = None if self.surfaces is None else _meeting(self.surfaces, self._surface_boxes, low, high)
        near = [
            Cone(cone.id, 0, cone.x, cone.y, 0.0, "", "")
            for cone in standing
            if low[0] <= cone.x <= high[0] and low[1] <= cone.y <= high[1]
        ]
        obstacles = _meeting(self.obstacles, self._obstacle_boxes, low, high)
        found = find_misplaced_cones(
            [*near, *cones], surfaces, obstacles, OBSTACLE_DISTANCE_M, CONE_DISTANCE_M
        )
        new = {cone.id for cone in cones}
        return [finding for finding in found if finding.cone in new]

    @cached_property
    def _surface_boxes(self) -> Floats:
        return _boxes(self.surfaces or ())

    @cached_property
    def _obstacle_boxes(self) -> Floats:
        return _boxes(self.obstacles)


def _boxes(shapes: Sequence[NamedGeometry]) -> Floats:
    """Return x_min, y_min, x_max, y_max of each of ``shapes``, (n, 4)."""
    boxes = [(*shape.rings[0].min(axis=0), *shape.rings[0].max(axis=0)) for shape in shapes]
    return np.array(boxes, dtype=np.float64).reshape(-1, 4)


def _meeting(
    shapes: Sequence[NamedGeometry], boxes: Floats, low: Floats, high: Floats
) -> list[NamedGeometry]:
    """Return the shapes whose box meets the one from ``low`` to ``high``."""
    meets = ((boxes[:, :2] <= high) & (boxes[:, 2:] >= low)).all(axis=1)
    return [shapes[k] for k in np.flatnonzero(meets).tolist()]


class LayoutGroundReader(QObject):
    """Reads the project's surfaces and obstacles in the background, and again when a layer has changed."""

    ready = pyqtSignal()
    """The ground requested last has been read, or cannot be."""
    forgotten = pyqtSignal()
    """A layer has changed."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self._changed)
        self._ground: LayoutGround | None = None
        self.why = ""
        """Why there is no ground; empty where there is one, or while it is being read."""
        self.unusable = False
        """Whether the cause is the layer itself, and not its content."""
        self._of: tuple[object, ...] = ()
        """The parameters of the ground, or of the reading under way."""
        self._reading: BackgroundReading[LayoutGround | None] = BackgroundReading(self)
        self._reading.ended.connect(self._have_read)

    def ground(self, crs: QgsCoordinateReferenceSystem) -> LayoutGround | None:
        """Return the ground in ``crs``; None while it is being read, or cannot be."""
        roads = layers_with_role(self._project, ROAD_SURFACE)
        obstacles = layers_with_role(self._project, *OBSTACLE_ROLES)
        key = (crs.toWkt(), *((layer.id(), setup_of(layer)) for layer in (*roads, *obstacles)))
        if key != self._of:
            self._begin(key, roads, obstacles, crs)
        return self._ground

    def forget(self) -> None:
        """Have the ground read again at the next request."""
        self._of, self._ground, self.why, self.unusable = (), None, "", False
        self._reading.stop()

    def remove(self) -> None:
        """Stop watching layers."""
        self._watch.changed.disconnect(self._changed)
        self._watch.remove()
        self.forget()

    def _changed(self) -> None:
        self.forget()
        self.forgotten.emit()

    def _begin(
        self, key: tuple[object, ...], roads: list, obstacles: list, crs: QgsCoordinateReferenceSystem
    ) -> None:
        self.forget()
        self._of = key
        self._watch.watch([*roads, *obstacles])
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(None))
        try:
            sources = [obstacle_sources(layers, LayerExpressions(), context) for layers in (roads, obstacles)]
        except FleetError as error:
            self.why, self.unusable = str(error), True
            return
        site = SiteGeoreference.in_crs(crs, self._project.transformContext())
        self._reading.begin(_GroundReader(*sources, site))

    def _have_read(self) -> None:
        try:
            self._ground = self._reading.result()
        except FleetError as error:
            self.why = str(error)
        self.ready.emit()


class _GroundReader:
    """Reads ``roads`` and ``obstacles`` in the CRS of ``site``, in a thread."""

    def __init__(
        self, roads: Sequence[ObstacleSource], obstacles: Sequence[ObstacleSource], site: SiteGeoreference
    ):
        self._roads, self._obstacles, self._site = list(roads), list(obstacles), site

    def read(self, go_on: Callable[[], bool]) -> LayoutGround | None:
        feedback = thread_feedback(go_on)
        areas = read_areas(self._roads, self._site, ROAD_SURFACE, feedback).items
        obstacles = read_obstacles(self._obstacles, self._site, feedback)
        if feedback.isCanceled():
            return None
        surfaces = tuple(NamedGeometry(area.rings, area.label) for area in areas) if self._roads else None
        return LayoutGround(surfaces, tuple(obstacles))
