"""How far a robot is from where it was told to be."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import CommandReport, SetPath
from ..command_book import CommandBook

Floats = npt.NDArray[np.float64]


def deviation(book: CommandBook, robot: str, xy: tuple[float, float] | None) -> float | None:
    """Return metres beside the path that ``robot`` is to drive, else from the target that it reached last.

    ``xy`` is where it is, in the site frame. None where it has neither, or is on its way to a target without
    a path: it cannot be beside what it was not given.
    """
    task = book.task_of(robot)
    if task is not None:
        if task.op != SetPath.__name__ or xy is None:
            return None
        return beside(_points(task), np.array(xy))
    reached = book.reached_by(robot)
    return None if reached is None else reached.deviation


def beside(points: Floats, at: Floats) -> float | None:
    """Return how far (2,) ``at`` is from the line through (n, 2) ``points``, None for no line."""
    if len(points) == 0:
        return None
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
