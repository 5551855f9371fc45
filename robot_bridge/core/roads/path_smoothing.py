"""Dense paths: the points a robot drives along a route, with its corners rounded."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import RoadInputError
from .network import Floats, ranges

_STRAIGHT = math.radians(0.5)
"""Smaller bends are ignored."""
_STEP = math.radians(10.0)
"""The greatest turn between two points of an arc."""
_LEAST_RADIUS = 0.05
"""Metres below which an arc is treated as a corner, without arc points."""
_WOBBLE = 0.05
"""Metres by which digitised points may be off the line through their neighbours without counting as bends."""


@dataclass(frozen=True)
class Driving:
    """The limits of a path: metres between points at most, the robot's turning radius and width."""

    spacing: float = 0.5
    turning_radius: float = 1.0
    robot_width: float = 0.5

    def __post_init__(self) -> None:
        for name, least in (("spacing", 0.01), ("turning_radius", 0.0), ("robot_width", 0.0)):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= least):
                raise RoadInputError(f"{name} is {value:g}: give metres of {least:g} or more.")


@dataclass(frozen=True)
class DensePath:
    """``points`` is (n, 2), metres in the site frame.

    ``tight`` holds the corners, (k, 2), where the road's width or shape allows no arc of the turning radius,
    ``least_radius`` the radius of the tightest arc (0 for a corner, infinity for a straight line).
    ``greatest_offset`` is how far at most an arc is off the centreline.
    """

    points: Floats
    tight: Floats
    least_radius: float
    greatest_offset: float


def dense_path(points: Floats, widths: Floats, driving: Driving) -> DensePath:
    """Return the path along ``points``, (n, 2), on a road that is ``widths``, (n - 1,), wide.

    An arc leaves the centreline only as far as robot and road are wide, so that the robot stays on the road.
    """
    line, width, wobble = _without_wobble(points, widths, driving)
    if len(line) < 3:
        return DensePath(_filled(line, driving.spacing), np.empty((0, 2)), math.inf, 0.0)
    corners = _corners(line, width - 2 * wobble, driving)
    bends = corners.turn > _STRAIGHT
    tight = bends & (corners.radius < driving.turning_radius * (1 - 1e-6))
    return DensePath(
        _filled(np.concatenate([line[:1], corners.arcs(), line[-1:]]), driving.spacing),
        corners.point[tight],
        float(corners.radius[bends].min(initial=math.inf)),
        float(corners.offset[bends].max(initial=0.0)),
    )


@dataclass(frozen=True)
class _Corners:
    """Bends of ``turn`` radians, (n,), at ``point``, from direction ``u`` to ``v``, all (n, 2).

    Each has an arc of ``radius``, (n,), or none where that is 0.
    """

    point: Floats
    u: Floats
    v: Floats
    turn: Floats
    radius: Floats

    @property
    def offset(self) -> Floats:
        """How far the arcs are off the corners, (n,)."""
        offset = np.zeros(len(self.turn))
        arc = self.radius > 0.0
        offset[arc] = self.radius[arc] * (1 / np.cos(self.turn[arc] / 2) - 1)
        return offset

    def arcs(self) -> Floats:
        """Return the points of all arcs, (m, 2), one after the other; for missing arcs the corners."""
        arc = self.radius > 0.0
        steps = np.where(arc, np.maximum(np.ceil(self.turn / _STEP), 1.0), 0.0).astype(np.int64)
        at = np.repeat(np.arange(len(steps)), steps + 1)
        step = ranges(np.zeros(len(steps), np.int64), steps + 1)
        angle = (step * (self.turn / np.maximum(steps, 1))[at])[:, None]
        tangent = np.zeros(len(steps))
        tangent[arc] = self.radius[arc] * np.tan(self.turn[arc] / 2)
        begin = self.point - tangent[:, None] * self.u
        left = np.where(_cross(self.u, self.v) > 0, 1.0, -1.0)
        normal = np.column_stack([-self.u[:, 1], self.u[:, 0]]) * left[:, None]
        along, aside = np.sin(angle) * self.u[at], (1 - np.cos(angle)) * normal[at]
        arcs: Floats = begin[at] + self.radius[at, None] * (along + aside)
        return arcs


def _corners(line: Floats, width: Floats, driving: Driving) -> _Corners:
    """Return the corners of ``line``, (n, 2), on a road ``width``, (n - 1,), wide."""
    legs = np.diff(line, axis=0)
    metres = np.hypot(*legs.T)
    unit = legs / metres[:, None]
    u, v = unit[:-1], unit[1:]
    turn = np.abs(np.arctan2(_cross(u, v), (u * v).sum(axis=1)))
    bend = (turn > _STRAIGHT) & (turn <= math.pi - _STRAIGHT)
    half = np.where(bend, turn, 1.0) / 2
    room = np.maximum((np.minimum(width[:-1], width[1:]) - driving.robot_width) / 2, 0.0)
    # Neighbouring corners share the stretch between them; the ends of the path share none.
    share = np.full(len(metres), 0.5)
    share[[0, -1]] = 1.0
    tangent = np.minimum((metres * share)[:-1], (metres * share)[1:])
    by_length, by_width = tangent / np.tan(half), room / (1 / np.cos(half) - 1)
    radius = np.minimum(np.minimum(by_length, by_width), driving.turning_radius)
    radius[~bend | (radius < _LEAST_RADIUS)] = 0.0
    return _Corners(line[1:-1], u, v, turn, radius)


def _cross(u: Floats, v: Floats) -> Floats:
    cross: Floats = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return cross


def _filled(line: Floats, spacing: float) -> Floats:
    """Return ``line``, (n, 2), with points at most ``spacing`` metres apart; none repeats."""
    metres = np.hypot(*np.diff(line, axis=0).T)
    line = line[np.concatenate([[True], metres > 1e-6])]
    if len(line) < 2:
        return np.repeat(line, 2, axis=0)
    steps = np.diff(line, axis=0)
    count = np.maximum(np.ceil(np.hypot(*steps.T) / spacing - 1e-9), 1.0).astype(np.int64)
    leg = np.repeat(np.arange(len(steps)), count)
    share = ranges(np.zeros(len(steps), np.int64), count) / count[leg]
    return np.concatenate([line[leg] + steps[leg] * share[:, None], line[-1:]])


def _without_wobble(points: Floats, widths: Floats, driving: Driving) -> tuple[Floats, Floats, float]:
    """Return the line without points that are no bends, and its widths.

    A piece is as wide as the narrowest that it replaces. The third value is the largest offset of dropped
    points.
    """
    room = float(max((widths.min() - driving.robot_width) / 2, 0.0)) if len(widths) else 0.0
    keep, wobble = _bends(points, min(_WOBBLE, room / 2))
    kept = np.flatnonzero(keep)
    moves = np.hypot(*np.diff(points[kept], axis=0).T) > 1e-9
    kept = kept[np.concatenate([[True], moves])]
    if len(kept) < 2:
        return points[kept], np.empty(0), wobble
    return points[kept], np.minimum.reduceat(widths[: kept[-1]], kept[:-1]), wobble


def _bends(points: Floats, slack: float) -> tuple[NDArray[np.bool_], float]:
    """Return which points are kept, (n,), by Douglas and Peucker (1973), and the largest offset.

    All pieces of one depth are processed together.
    """
    keep = np.zeros(len(points), bool)
    keep[[0, -1]] = True
    wobble = 0.0
    begin, end = np.array([0]), np.array([len(points) - 1])
    while True:
        some = end - begin >= 2
        begin, end = begin[some], end[some]
        if not len(begin):
            return keep, wobble
        count = end - begin - 1
        piece, inner = np.repeat(np.arange(len(begin)), count), ranges(begin + 1, count)
        away = _away(points[inner], points[begin][piece], points[end][piece])
        most = np.maximum.reduceat(away, np.cumsum(count) - count)
        farthest = np.flatnonzero(away == most[piece])
        first = farthest[np.unique(piece[farthest], return_index=True)[1]]
        bent = most > slack
        wobble = max(wobble, float(most[~bent].max(initial=0.0)))
        middle = inner[first][bent]
        keep[middle] = True
        begin, end = np.concatenate([begin[bent], middle]), np.concatenate([middle, end[bent]])


def _away(points: Floats, a: Floats, b: Floats) -> Floats:
    """Return how far ``points`` are from the segments ``a`` to ``b``, all (n, 2)."""
    step = b - a
    square = np.maximum((step * step).sum(axis=1), 1e-18)
    share = np.clip(((points - a) * step).sum(axis=1) / square, 0.0, 1.0)
    away: Floats = np.hypot(*(a + share[:, None] * step - points).T)
    return away
