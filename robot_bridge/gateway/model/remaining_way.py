"""Remaining way: from where a robot is to the end of its task, in straight lines or along its path.

A road planner plugs in as a :class:`Planner`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.geometry import Polyline
from ...core.messages import SetPath, SetPosEnd, path_to_end

Floats = NDArray[np.float64]
Point = tuple[float, float]
"""x, y in metres, site frame."""

_SAME = 1e-6
"""metres below which two points are one."""
_LOOK_AHEAD = 5.0
"""metres of a drawn path ahead on which a robot may join it again, so that a loop is not cut short."""


class PlannedPath(NamedTuple):
    """A path from start to goal, at least two points; ``note`` says where it is not what one would expect.

    ``along_roads`` is false of a straight line.
    """

    points: Sequence[Point]
    note: str = ""
    along_roads: bool = False


class Planner(Protocol):
    """Finds a way. Paths begin at ``start`` and end at ``goal``."""

    @property
    def has_roads(self) -> bool:
        """Whether there are any roads that paths may lead along."""

    def path(self, start: Point, goal: Point) -> PlannedPath:
        """Return a path; raises RefusedError when there is none."""


class StraightPlanner:
    """Knows no roads: every path is one straight line."""

    has_roads = False

    def path(self, start: Point, goal: Point) -> PlannedPath:
        """Return ``start`` and ``goal``."""
        return PlannedPath([start, goal])


class RemainingPath(NamedTuple):
    """What is left of a task, and the planner's note about it."""

    message: SetPath
    note: str = ""


def remaining_path(task: SetPosEnd | SetPath, start: Point, driven: float, planner: Planner) -> RemainingPath:
    """Return the path from ``start`` to the end of ``task``.

    Of a path that was drawn it is what lies ahead of the first ``driven`` metres. Raises RefusedError when
    the planner finds no way.
    """
    if isinstance(task, SetPosEnd):
        planned = planner.path(start, (task.x, task.y))
        return RemainingPath(path_to_end(task, list(planned.points)), planned.note)
    left = remaining_line(Polyline(task.points), start, driven)
    return RemainingPath(path_to_end(task, [(x, y) for x, y in left.tolist()]))


def remaining_line(line: Polyline, start: Point, driven: float) -> Floats:
    """Return what lies ahead of the first ``driven`` metres of ``line``, from ``start`` on: (n, 2), n > 1."""
    here = _joins(line, start, driven)
    corners = line.beyond(here + _SAME)
    return _without_repetition(np.vstack([start, line.at(here), corners if len(corners) else line.end]))


def _joins(line: Polyline, start: Point, driven: float) -> float:
    """Return the station nearest to ``start`` of those just ahead of ``driven`` metres."""
    station, off = line.feet(*start)
    near = (station >= driven) & (station <= driven + _LOOK_AHEAD)
    joint = line.at(driven)
    stations = [min(driven, line.length), *station[near]]
    distances = [math.hypot(joint[0] - start[0], joint[1] - start[1]), *off[near]]
    return float(stations[int(np.argmin(distances))])


def _without_repetition(points: Floats) -> Floats:
    """Return ``points`` without those that stand on the one kept before; at least two are kept."""
    kept, checked = np.ones(len(points), dtype=bool), 0
    near = np.abs(np.diff(points, axis=0)) <= _SAME
    for number in np.flatnonzero(near[:, 0] & near[:, 1]).tolist():
        if number < checked:
            continue
        checked = number + 1
        while checked < len(points) and np.abs(points[checked] - points[number]).max() <= _SAME:
            kept[checked] = False
            checked += 1
    return points[kept] if kept.sum() > 1 else points[[0, -1]]
