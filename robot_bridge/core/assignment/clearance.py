"""Clearance of a plan: ways round standing obstacles, and places where robots come too near."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from .job import Travel
from .plan import ConePlan, RobotPlan

# --- Ways that keep clear of standing obstacles ---

Floats = npt.NDArray[np.float64]
_ROUND = 8
"""Points of a whole circle round an obstacle."""
_MOST_DETOURS = 50
"""Obstacles that one way is led round at most."""


class ClearTravel:
    """The ways of ``inner`` led round ``obstacles``, (n, 2), site frame, by ``clearances``, (n,) metres.

    ``places`` (m, 2) are those that ``inner`` numbers. Distances stay those of ``inner``: a detour round a
    cone is within the uncertainty of distances.
    """

    def __init__(self, inner: Travel, places: Floats, obstacles: Floats, clearances: Floats) -> None:
        self._inner, self._places, self._clearances = inner, places, clearances
        self._obstacles = obstacles
        self.name, self.metres = inner.name, inner.metres

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place."""
        points = self._inner.path(start, goal)
        return detour(points, self._obstacles, self._clearances)


def detour(points: Floats, obstacles: Floats, clearances: Floats) -> Floats:
    """Return the way ``points``, (n, 2), led round all ``obstacles``, (m, 2), by ``clearances``, (m,) metres.

    Obstacles at the ends of the way are ignored: the robot stands there, or will. If others leave no room,
    the way is returned with the detours found so far.
    """
    if len(points) < 2 or len(obstacles) == 0:
        return points
    ends = points[[0, -1]]
    away = np.hypot(*(obstacles[:, None, :] - ends[None, :, :]).transpose(2, 0, 1)).min(axis=1)
    in_the_way = (away > clearances) & (clearances > 0)
    standing, room = obstacles[in_the_way], clearances[in_the_way]
    for _ in range(_MOST_DETOURS):
        found = _first_met(points, standing, room)
        if found is None:
            return points
        points = _round_one(points, standing, found, room)
    return points


def obstacle_distances(points: Floats, obstacles: Floats) -> Floats:
    """Return how near the way ``points`` comes to each obstacle, (m,) metres."""
    start, step = points[:-1], np.diff(points, axis=0)
    length = np.maximum((step**2).sum(axis=1), 1e-18)
    part = ((obstacles[:, None, :] - start[None]) * step[None]).sum(axis=2) / length
    nearest = start[None] + np.clip(part, 0.0, 1.0)[:, :, None] * step[None]
    away: Floats = np.hypot(*(nearest - obstacles[:, None, :]).transpose(2, 0, 1)).min(axis=1)
    return away


def _first_met(points: Floats, standing: Floats, room: Floats) -> int | None:
    if len(standing) == 0:
        return None
    near = np.flatnonzero(obstacle_distances(points, standing) < room - 1e-6)
    if len(near) == 0:
        return None
    stations = [_entry(points, standing[k], room[k])[0] for k in near]
    return int(near[int(np.argmin(stations))])


def _round_one(points: Floats, standing: Floats, which: int, room: Floats) -> Floats:
    """Return the way led round one obstacle, on a side that is clear of the others, else the shorter."""
    centre = standing[which]
    # Chords of the circle's arc stay outside of it when the arc is a little wider.
    radius = room[which] / math.cos(math.pi / _ROUND) * 1.02
    first, entry = _entry(points, centre, radius)
    last, leave = _leave(points, centre, radius)
    begin, end = (math.atan2(*(at - centre)[::-1]) for at in (entry, leave))
    others, their_room = np.delete(standing, which, axis=0), np.delete(room, which)
    ways = []
    for turn in (1.0, -1.0):
        span = (turn * (end - begin)) % math.tau
        count = max(math.ceil(span / (math.tau / _ROUND)), 1)
        angles = begin + turn * span * np.arange(count + 1) / count
        arc = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        blocked = len(others) > 0 and bool((obstacle_distances(arc, others) < their_room - 1e-6).any())
        ways.append((blocked, span, arc))
    arc = min(ways, key=lambda way: way[:2])[2]
    return np.concatenate([points[: first + 1], arc, points[last + 1 :]])


def _entry(points: Floats, centre: Floats, radius: float) -> tuple[int, Floats]:
    """Return the leg on which the way comes within ``radius`` first, and where."""
    for k in range(len(points) - 1):
        shares = _crossings(points[k], points[k + 1], centre, radius)
        if shares is not None:
            share = max(shares[0], 0.0)
            return k, points[k] + share * (points[k + 1] - points[k])
    return len(points) - 2, points[-1]


def _leave(points: Floats, centre: Floats, radius: float) -> tuple[int, Floats]:
    first, entry = _entry(points[::-1], centre, radius)
    return len(points) - 2 - first, entry


def _crossings(a: Floats, b: Floats, centre: Floats, radius: float) -> tuple[float, float] | None:
    """Return the shares of the leg from ``a`` to ``b`` at which it enters and leaves the circle."""
    d, f = b - a, a - centre
    square = float(d @ d)
    if square < 1e-18:
        return None
    half = float(f @ d) / square
    rest = half**2 - (float(f @ f) - radius**2) / square
    if rest < 0:
        return None
    root = math.sqrt(rest)
    enters, leaves = -half - root, -half + root
    return (enters, leaves) if leaves >= 0.0 and enters <= 1.0 else None


class NearOrByRoad:
    """The ways of ``straight`` up to ``nearby`` metres, those of ``roads`` farther off."""

    def __init__(self, straight: Travel, roads: Travel, nearby: float, name: str) -> None:
        self._straight, self._roads = straight, roads
        self._near = straight.metres <= nearby
        self.metres: Floats = np.where(self._near, straight.metres, roads.metres)
        self.name = name

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place."""
        return (self._straight if self._near[start][goal] else self._roads).path(start, goal)


# --- Places where robots come too near to one another by the plan ---

STEP_S = 0.5
_RUN = 64
"""Points of a way per bounding box."""
_SAMPLED = 0.05
"""Metres by which a detour may seem nearer, as ways are sampled step by step."""


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
    """Return, for each pair of robots, when they first come nearer than ``least`` metres; soonest first.

    ``standing`` are the places of robots that do not drive by the plan, such as a lost one: driving robots
    come nearer than ``off_standing`` metres to it only where it stands at one of their cones.
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

    Most of a thousand robots stand far from it; measuring from every point to each would take seconds.
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
    # The nearest point of the first meeting is more informative than its beginning.
    breaks = np.flatnonzero(np.diff(near) > 1)
    run = near[: breaks[0] + 1] if len(breaks) else near
    k = int(run[apart[run].argmin()])
    x, y = ((here + there) / 2)[k]
    yield NearMeeting(robot, other, float(times[k]), float(apart[k]), float(x), float(y))
