"""Whether robots are on the road, by the project's layers of road surfaces."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QObject

from ....robot_bridge.roads.surfaces.index import NOWHERE
from ...errors import FleetError
from ...language import tr
from ...sites.many_points import moved
from ...sites.surface_map import SurfaceMap
from ...sites.surface_store import SurfaceStore, SurfaceTask
from ..placement import Placement
from .rules import Bools, Floats

AROUND = np.array([(np.cos(turn), np.sin(turn)) for turn in np.arange(8) * np.pi / 4])
"""Directions in which the margin is looked for."""


class RoadGround(QObject):
    """Asks ``store``; surfaces that are not read yet are read beside the window."""

    def __init__(self, store: SurfaceStore, parent: QObject | None = None):
        super().__init__(parent)
        self._store = store
        self._task: SurfaceTask | None = None
        self._failed_once = False
        self.why_not = ""
        """Why nobody can tell who is on the road; empty where that is known."""
        store.forgotten.connect(self._forgotten)

    def judge(self, xy: Floats, placement: Placement, margin: float) -> tuple[Bools, Bools] | None:
        """Return of (n, 2) metres in the site frame which are off the road by ``margin``, and which on it.

        None where no surfaces are known (see :attr:`why_not`). A robot without a place is neither.
        """
        surfaces = self._surfaces()
        if surfaces is None:
            return None
        there = np.isfinite(xy).all(axis=1)
        on = np.zeros(len(xy), dtype=bool)
        on[there] = _on_a_surface(xy[there], placement, surfaces)
        off = np.zeros(len(xy), dtype=bool)
        beside = np.flatnonzero(there & ~on)
        rim = (xy[beside, None, :] + AROUND * margin).reshape(-1, 2)
        off[beside] = ~_on_a_surface(rim, placement, surfaces).reshape(-1, len(AROUND)).any(axis=1)
        return off, on

    def remove(self) -> None:
        """Let go of what is being read."""
        self._store.forgotten.disconnect(self._forgotten)
        self._drop()

    def _surfaces(self) -> SurfaceMap | None:
        layers = self._store.layers()
        if not layers:
            self.why_not = tr("no layer of the project has the role road surface")
            return None
        found = self._store.kept(layers)
        if found is not None and not found.index.surfaces:
            # Every robot would be off the road.
            names = ", ".join(layer.name() for layer in layers)
            self.why_not = tr("layers of road surfaces hold no areas ({names})", names=names)
            return None
        if found is not None:
            self.why_not = ""
        elif self._task is None and not self._failed_once:
            self.why_not = tr("the road surfaces are being read")
            try:
                self._task = self._store.task(layers)
            except FleetError as error:
                self._give_up(str(error))
                return None
            self._task.taskCompleted.connect(self._read)
            self._task.taskTerminated.connect(self._failed)
            QgsApplication.taskManager().addTask(self._task)
        return found

    def _read(self) -> None:
        self._task = None

    def _failed(self) -> None:
        why, self._task = (self._task.why if self._task else ""), None
        self._give_up(why or tr("reading was cancelled"))

    def _give_up(self, why: str) -> None:
        # Not tried again before a layer changes.
        self._failed_once = True
        self.why_not = tr("layers of road surfaces cannot be read: {why}", why=why)

    def _forgotten(self) -> None:
        self._failed_once = False
        self.why_not = ""

    def _drop(self) -> None:
        if self._task is not None:
            self._task.taskCompleted.disconnect(self._read)
            self._task.taskTerminated.disconnect(self._failed)
            self._task.cancel()
            self._task = None


def _on_a_surface(xy: Floats, placement: Placement, surfaces: SurfaceMap) -> Bools:
    if len(xy) == 0:
        return np.zeros(0, dtype=bool)
    way = surfaces.way_from(placement.site_crs)
    return surfaces.index.at_many(moved(placement.frame.to_crs(xy), way)) != NOWHERE
