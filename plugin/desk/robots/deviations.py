"""How far a robot is from where it was told to be."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import CommandReport, SetPath
from ..command_book import CommandBook
from ..way_to_path import WayToPath

Floats = npt.NDArray[np.float64]


class Deviations:
    """Remembers of each robot whether it has come to its path: the way there is nobody's to prescribe."""

    def __init__(self, book: CommandBook):
        self._book = book
        self._ways: dict[str, tuple[str, WayToPath]] = {}
        """By robot, the command whose path it is to drive, and how it comes to that."""

    def of(self, robot: str, xy: tuple[float, float] | None) -> float | None:
        """Return metres beside the path that ``robot`` drives, else from the target that it reached last.

        ``xy`` is where it is, in the site frame. None where it has neither, or is on its way to a target or
        to the first point of its path: it cannot be beside what it was not given.
        """
        task = self._book.task_of(robot)
        if task is None:
            reached = self._book.reached_by(robot)
            return None if reached is None else reached.deviation
        points = _points(task) if task.op == SetPath.__name__ else np.empty((0, 2))
        if xy is None or len(points) == 0:
            return None
        off = beside(points, np.array(xy))
        command, way = self._ways.get(robot, ("", WayToPath()))
        if command != task.command:
            way = WayToPath()
            self._ways[robot] = task.command, way
        way.go_on(off, math.dist(points[0], xy))
        return off if way.is_over else None

    def forget(self, robots: Iterable[str]) -> None:
        """Remember nothing of ``robots``, which were removed."""
        for robot in robots:
            self._ways.pop(robot, None)


def beside(points: Floats, at: Floats) -> float:
    """Return how far (2,) ``at`` is from the line through (n, 2) ``points``, n > 0."""
    if len(points) == 1:
        return float(np.hypot(*(points[0] - at)))
    start, step = points[:-1], np.diff(points, axis=0)
    square = np.maximum((step**2).sum(axis=1), 1e-18)
    part = np.clip(((at - start) * step).sum(axis=1) / square, 0.0, 1.0)
    return float(np.hypot(*(start + step * part[:, None] - at).T).min())


def _points(task: CommandReport) -> Floats:
    try:
        points = np.array(task.params.get("points", []), dtype=np.float64)
    except (TypeError, ValueError):
        return np.empty((0, 2))
    return points[:, :2] if points.ndim == 2 and points.shape[1] >= 2 else np.empty((0, 2))
