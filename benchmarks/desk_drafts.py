"""Checks of large drafts against layers full of obstacles, and what they leave of the window's time.

Called by :mod:`.desk` in a process of its own.
"""

from __future__ import annotations

import gc
import importlib
import time
from typing import Any

import numpy as np
from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProject, QgsVectorLayer

from benchmarks.clock import spread
from benchmarks.desk_canvas import CRS, Stage, open_desk
from benchmarks.trial import size

LAYERS = {"obstacle": (5000, 1.0), "keepout": (500, 2.0), "road_surface": (300, 20.0)}
"""By role how many discs there are, and their radius in metres."""
RUNS = size(5, 2)
"""How often each is checked, each time another draft of its kind."""
PLUGIN = "fleet_supervisor.plugin"


def drafts(data: str, number: int) -> None:
    """Print of drafts of ``number`` points what checking takes, the longest slice of it, and how long the
    searches for garbage took, in ms."""
    stage = Stage(data, 100)
    desk, _, _ = open_desk(stage)
    random = np.random.default_rng(1)
    for role, (count, radius) in LAYERS.items():
        _scatter(stage, role, count, radius, random)
    kinds = importlib.import_module(f"{PLUGIN}.control.pending_command")
    x, y, width, height = stage.area
    middle = np.array([x + width / 2, y + height / 2])
    slices = _Slices()
    checked: dict[str, list[list[float]]] = {}

    def check(name: str, draft: Any) -> None:
        checked.setdefault(name, []).append(slices.of(stage, desk, draft))

    for _ in range(RUNS):
        targets = _points(random.uniform((x, y), (x + width, y + height), (number, 2)))
        way = _points(middle + random.uniform(-1.0, 1.0, (number, 2)).cumsum(axis=0))
        check(f"{number} targets", kinds.PendingCommand("robot-1", kinds.TARGETS, targets))
        check(
            f"a route of {number} points",
            kinds.PendingCommand("robot-1", kinds.ROUTE, way, legs=(1,) * number),
        )
        changed = kinds.moved(desk.drafts.draft, number // 2, (way[0][0], way[0][1]))
        check("one of these points moved", changed)
        check("a cone", kinds.PendingCommand("robot-1", kinds.CONE, targets[:1]))
    rows = {
        name: {
            "ms": spread(map(sum, runs)),
            "slices": max(map(len, runs)),
            "longest": spread(map(max, runs)),
        }
        for name, runs in checked.items()
    }
    stage.end({"rows": rows, "garbage": spread(slices.garbage)})


class _Slices:
    """Takes the time of each slice by the thread's own clock."""

    def __init__(self) -> None:
        self._kind = importlib.import_module(f"{PLUGIN}.ui.scheduling").CooperativeTask
        self._slice = self._kind._slice
        self._taken: list[float] = []
        self.garbage: list[float] = []
        """Milliseconds of the searches for garbage."""
        self._kind._slice = lambda slices: self._timed(slices)

    def of(self, stage: Stage, desk: Any, draft: Any) -> list[float]:
        """Return the milliseconds of each slice in which a draft is checked.

        A search for garbage would be counted to whatever it happens to come in.
        """
        began = time.thread_time()
        gc.collect()
        self.garbage.append((time.thread_time() - began) * 1e3)
        self._taken.clear()
        desk.target_ways.set_command(draft)
        stage.wait(lambda: not desk.checks.is_under_way)
        return list(self._taken)

    def _timed(self, slices: Any) -> Any:
        began = time.thread_time()
        try:
            return self._slice(slices)
        finally:
            self._taken.append((time.thread_time() - began) * 1e3)


def _scatter(stage: Stage, role: str, count: int, radius: float, random: np.random.Generator) -> None:
    layer = QgsVectorLayer(f"Polygon?crs={CRS}&field=name:string", role, "memory")
    x, y, width, height = stage.area
    features = []
    for dx, dy in random.uniform((x, y), (x + width, y + height), (count, 2)).tolist():
        middle = QgsPointXY(stage.origin[0] + dx, stage.origin[1] + dy)
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(middle).buffer(radius, 8))
        features.append(feature)
    layer.dataProvider().addFeatures(features)
    layer.setCustomProperty("fleet/role", role)
    QgsProject.instance().addMapLayer(layer, False)


def _points(xy: np.ndarray) -> tuple[tuple[float, float], ...]:
    return tuple((x, y) for x, y in xy.tolist())
