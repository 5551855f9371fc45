"""The road surfaces of layers, kept until one of the layers changes."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.core import (
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeedback,
    QgsProject,
    QgsTask,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QObject, QThread, pyqtSignal

from ..errors import FleetError
from ..language import tr
from .layer_watch import LayerWatch
from .roles import ROAD_SURFACE, layers_with_role
from .surface_map import SurfaceMap, SurfaceSources, read_surface_map, surface_sources

Key = tuple[str, ...]


class SurfaceStore(QObject):
    """Keeps what was read of layers, by their ids. It lives in the main thread, and any thread may ask it.

    Another thread gets what is kept, else reads for itself: a layer tells only the main thread of changes.
    """

    forgotten = pyqtSignal()
    """Something was thrown away: read it anew before it is told."""

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
        task = SurfaceTask(self._sources(layers))
        key, age = _key(layers), self._age

        def keep() -> None:
            # What changed while it was read has to be read once more.
            if task.surfaces is not None and age == self._age:
                self._maps[key] = task.surfaces

        task.taskCompleted.connect(keep)
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

    def _forget(self) -> None:
        self._age += 1
        self._maps.clear()
        self.forgotten.emit()


class SurfaceTask(QgsTask):
    """Reads surfaces in a worker: ``surfaces`` is there afterwards, or ``why`` not."""

    def __init__(self, sources: SurfaceSources):
        super().__init__(tr("Reading road surfaces"), QgsTask.Flag.CanCancel)
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
