"""What is wrong with a cone layout while it is still under the cursor, without the window waiting for it."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsProcessingFeedback,
    QgsProject,
    QgsTask,
)
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.layouts.checks import Shape, find
from ...robot_bridge.layouts.cone import Cone
from ..errors import FleetError
from ..language import tr
from ..processing.cone_ground import read_obstacles
from ..sites.ground_reading import read_areas
from ..sites.layer_watch import LayerWatch
from ..sites.obstacle_source import ObstacleSource, obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.roles import OBSTACLE_ROLES, ROAD_SURFACE, LayerExpressions, layers_with_role, setup_of
from .cone_store import CONE_DISTANCE_M, OBSTACLE_DISTANCE_M

GIVE_UP_S = 5.0
"""Seconds that the end of a reading is waited for when the plugin is unloaded."""

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ConeGround:
    """Surfaces that cones stand on, None where no layer has any, and obstacles; metres in one CRS."""

    surfaces: tuple[Shape, ...] | None
    obstacles: tuple[Shape, ...]

    def bad_cones(self, cones: Sequence[Cone], standing: Floats) -> Floats:
        """Return where those of ``cones`` are that should not stand there, (n, 2); ``standing`` is (m, 2)."""
        xy = np.array([(cone.x, cone.y) for cone in cones], dtype=np.float64).reshape(-1, 2)
        if not len(xy):
            return xy
        low, high = xy.min(axis=0) - OBSTACLE_DISTANCE_M, xy.max(axis=0) + OBSTACLE_DISTANCE_M
        surfaces = None if self.surfaces is None else _meeting(self.surfaces, self._surface_boxes, low, high)
        obstacles = _meeting(self.obstacles, self._obstacle_boxes, low, high)
        wrong = {one.cone for one in find(cones, surfaces, obstacles, OBSTACLE_DISTANCE_M, CONE_DISTANCE_M)}
        near = standing[((standing >= low) & (standing <= high)).all(axis=1)]
        apart = np.hypot(*(xy[:, None, :] - near[None, :, :]).transpose(2, 0, 1))
        bad = np.array([cone.id in wrong for cone in cones]) | (apart < CONE_DISTANCE_M - 1e-9).any(axis=1)
        return xy[bad]

    @cached_property
    def _surface_boxes(self) -> Floats:
        return _boxes(self.surfaces or ())

    @cached_property
    def _obstacle_boxes(self) -> Floats:
        return _boxes(self.obstacles)


def _boxes(shapes: Sequence[Shape]) -> Floats:
    """Return x_min, y_min, x_max, y_max of each of ``shapes``, (n, 4)."""
    boxes = [(*shape.rings[0].min(axis=0), *shape.rings[0].max(axis=0)) for shape in shapes]
    return np.array(boxes, dtype=np.float64).reshape(-1, 4)


def _meeting(shapes: Sequence[Shape], boxes: Floats, low: Floats, high: Floats) -> list[Shape]:
    """Return the shapes whose box meets the one from ``low`` to ``high``."""
    meets = ((boxes[:, :2] <= high) & (boxes[:, 2:] >= low)).all(axis=1)
    return [shapes[k] for k in np.flatnonzero(meets).tolist()]


class ConeGroundReader(QObject):
    """Reads the project's surfaces and obstacles beside the GUI thread, and again when a layer changed."""

    ready = pyqtSignal()
    """What was asked for last has been read."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self.forget)
        self._ground: ConeGround | None = None
        self._of: tuple[object, ...] = ()
        """What the ground, or the reading that is under way, is of."""
        self._task: ConeGroundTask | None = None

    def ground(self, crs: QgsCoordinateReferenceSystem) -> ConeGround | None:
        """Return the ground in ``crs``; None while it is being read, or cannot be."""
        roads = layers_with_role(self._project, ROAD_SURFACE)
        obstacles = layers_with_role(self._project, *OBSTACLE_ROLES)
        wanted = (crs.toWkt(), *((layer.id(), setup_of(layer)) for layer in (*roads, *obstacles)))
        if wanted != self._of:
            self._begin(wanted, roads, obstacles, crs)
        return self._ground

    def forget(self) -> None:
        """Have the ground read again when it is asked for next."""
        self._of, self._ground = (), None
        self._cancel()

    def remove(self) -> None:
        """Watch no layer any longer, and wait until no thread reads one."""
        task = self._task
        self._watch.changed.disconnect(self.forget)
        self._watch.remove()
        self.forget()
        if task is not None and task.began.is_set():
            task.left.wait(GIVE_UP_S)

    def _begin(
        self, wanted: tuple[object, ...], roads: list, obstacles: list, crs: QgsCoordinateReferenceSystem
    ) -> None:
        self.forget()
        self._of = wanted
        self._watch.watch([*roads, *obstacles])
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(None))
        try:
            sources = [obstacle_sources(layers, LayerExpressions(), context) for layers in (roads, obstacles)]
        except FleetError:
            # A click says what is wrong with the layer.
            return
        site = SitePlacing.in_crs(crs, self._project.transformContext())
        self._task = ConeGroundTask(*sources, site)
        self._task.taskCompleted.connect(self._completed)
        QgsApplication.taskManager().addTask(self._task)

    def _cancel(self) -> None:
        task, self._task = self._task, None
        if task is not None:
            task.taskCompleted.disconnect(self._completed)
            task.cancel()

    def _completed(self) -> None:
        task, self._task = self._task, None
        if task is not None:
            self._ground = task.ground
            self.ready.emit()


class ConeGroundTask(QgsTask):
    """Reads ``roads`` and ``obstacles`` in the CRS of ``site``; what cannot be read leaves no ground."""

    def __init__(
        self, roads: Sequence[ObstacleSource], obstacles: Sequence[ObstacleSource], site: SitePlacing
    ):
        super().__init__(tr("Reading what cones must keep clear of"), QgsTask.Flag.CanCancel)
        self._roads, self._obstacles, self._site = list(roads), list(obstacles), site
        self._feedback = QgsProcessingFeedback(False)
        self.ground: ConeGround | None = None
        self.began, self.left = threading.Event(), threading.Event()
        """Set once the worker has come into :meth:`run`, and left it."""

    def run(self) -> bool:
        self.began.set()
        try:
            areas = read_areas(self._roads, self._site, ROAD_SURFACE, self._feedback).items
            obstacles = read_obstacles(self._obstacles, self._site, self._feedback)
        except FleetError:
            return True
        finally:
            self.left.set()
        if self._feedback.isCanceled():
            return False
        surfaces = tuple(Shape(area.rings, area.label) for area in areas) if self._roads else None
        self.ground = ConeGround(surfaces, tuple(obstacles))
        return True

    def cancel(self) -> None:
        self._feedback.cancel()
        super().cancel()
