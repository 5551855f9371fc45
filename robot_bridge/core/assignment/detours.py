"""Ways that keep clear of what stands in the open, straight nearby and along the roads farther off."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .job import Travel

Floats = npt.NDArray[np.float64]
_ROUND = 8
"""Points of a whole circle round an obstacle."""
_MOST_DETOURS = 50
"""Obstacles that one way is led round; a way with more in it is no way."""


class ClearTravel:
    """The ways of ``inner``, led round ``obstacles``, (n, 2) in the site frame, each by its metres of
    ``clearances``, (n,).

    ``places`` (m, 2) are those that ``inner`` numbers. Distances stay those of ``inner``: a detour round a
    cone is shorter than what a distance is known by.
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

    Obstacles that the way begins or ends at are passed over: the robot stands there, or is to. Where others
    leave no room the way is returned as far as it could be led.
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
