"""Where robots come too near to one another if all goes by the plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from .plan import ConePlan, RobotPlan

Floats = npt.NDArray[np.float64]

STEP_S = 0.5
_RUN = 64
"""Points of a way that are in one box."""
_SAMPLED = 0.05
"""Metres by which a way that is led round something may seem nearer, looked at every step."""


@dataclass(frozen=True)
class NearMeeting:
    """``robot`` and ``other`` are ``metres`` apart at (x, y), site frame, ``at_s`` after the plan's begin."""

    robot: str
    other: str
    at_s: float
    metres: float
    x: float
    y: float


def meetings(
    plan: ConePlan,
    least: float,
    standing: Mapping[str, tuple[float, float]] | None = None,
    off_standing: float = 0.0,
) -> list[NearMeeting]:
    """Return for each two robots when they come nearer than ``least`` metres first, soonest first.

    ``standing`` are the places of robots that do not drive by the plan, a lost one among them: who drives
    comes nearer than ``off_standing`` metres to one of them where that stands at his cone.
    """
    driving = [one for one in plan.robots if not one.lost]
    if not driving:
        return []
    begin = min(one.robot.ready_s for one in driving)
    times = np.arange(begin, max(one.end_s for one in driving) + STEP_S, STEP_S)
    places = {one.robot.id: robot_positions(one, times) for one in driving}
    found = [
        *(
            meeting
            for (robot, here), (other, there) in combinations(places.items(), 2)
            for meeting in _first(robot, other, here, there, times, least)
        ),
        *_with_standing(places, standing or {}, times, off_standing - _SAMPLED),
    ]
    return sorted(found, key=lambda one: one.at_s)


def robot_positions(one: RobotPlan, times: Floats) -> Floats:
    """Return where the robot is at ``times``, (n,) seconds from the plan's begin, as (n, 2) metres."""
    clock, places = [one.robot.ready_s], [np.array([[one.robot.x, one.robot.y]])]
    knots = [np.array([one.robot.ready_s])]
    for stop in one.stops:
        path = np.array(stop.path)
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        length = max(along[-1], 1e-9)
        knots += [clock[-1] + (stop.arrival_s - clock[-1]) * along / length, np.array([stop.end_s])]
        places += [path, path[-1:]]
        clock.append(stop.end_s)
    at, where = np.concatenate(knots), np.concatenate(places)
    return np.column_stack([np.interp(times, at, where[:, axis]) for axis in (0, 1)])


def _with_standing(
    driving: Mapping[str, Floats], standing: Mapping[str, tuple[float, float]], times: Floats, least: float
) -> Iterator[NearMeeting]:
    names, places = list(standing), np.array(list(standing.values()), dtype=float).reshape(-1, 2)
    for robot, here in driving.items():
        for k in _beside(here, places, least):
            yield from _first(robot, names[k], here, places[k : k + 1], times, least)


def _beside(way: Floats, places: Floats, reach: float) -> list[int]:
    """Return which of (m, 2) ``places`` may be within ``reach`` of the (n, 2) points of a way.

    Most of a thousand robots stand far from it; to measure from every point to each would take seconds.
    """
    begins = np.arange(0, len(way), _RUN)
    low, high = (reduce.reduceat(way, begins, axis=0) for reduce in (np.minimum, np.maximum))
    is_in = (places[:, None] >= low - reach) & (places[:, None] <= high + reach)
    return [int(which) for which in np.flatnonzero(is_in.all(axis=2).any(axis=1))]


def _first(
    robot: str, other: str, here: Floats, there: Floats, times: Floats, least: float
) -> Iterator[NearMeeting]:
    """Yield the first meeting of two, if there is one; ``there`` is (n, 2) as ``here``, or one place."""
    apart = np.hypot(*(here - there).T)
    near = np.flatnonzero(apart < least)
    if len(near) == 0:
        return
    # The nearest point of the first time that they meet says more than the moment it begins.
    breaks = np.flatnonzero(np.diff(near) > 1)
    run = near[: breaks[0] + 1] if len(breaks) else near
    k = int(run[apart[run].argmin()])
    x, y = ((here + there) / 2)[k]
    yield NearMeeting(robot, other, float(times[k]), float(apart[k]), float(x), float(y))
