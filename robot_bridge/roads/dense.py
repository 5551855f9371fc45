"""Dense paths: the points a robot drives along a route, with its corners rounded."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .centrelines import Floats
from .errors import RoadInputError

_STRAIGHT = math.radians(0.5)
"""Bends below this are none."""
_STEP = math.radians(10.0)
"""The greatest turn between two points of an arc."""
_LEAST_RADIUS = 0.05
"""Metres below which an arc is a corner, and its many points no help."""
_WOBBLE = 0.05
"""Metres by which digitised points may be off the line through their neighbours without being bends."""


@dataclass(frozen=True)
class Driving:
    """How a path is to be driven: metres between points at most, the robot's turning radius and width."""

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

    ``tight`` holds the corners, (k, 2), where the road's width or its shape allows no arc of the turning
    radius, ``least_radius`` the radius of the tightest arc (0 for a corner, infinity for a straight line).
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
        return DensePath(_filled([line], driving.spacing), np.empty((0, 2)), math.inf, 0.0)
    corners = [_Corner.at(line, width - 2 * wobble, k, driving) for k in range(1, len(line) - 1)]
    parts = [line[:1], *(corner.arc() for corner in corners), line[-1:]]
    bends = [corner for corner in corners if corner.turn > _STRAIGHT]
    tight = [corner.point for corner in bends if corner.radius < driving.turning_radius * (1 - 1e-6)]
    return DensePath(
        _filled(parts, driving.spacing),
        np.array(tight).reshape(-1, 2),
        min((corner.radius for corner in bends), default=math.inf),
        max((corner.offset for corner in bends), default=0.0),
    )


@dataclass(frozen=True)
class _Corner:
    """A bend of ``turn`` radians at ``point``, from direction ``u`` to ``v``, with an arc of ``radius``."""

    point: Floats
    u: Floats
    v: Floats
    turn: float
    radius: float

    @classmethod
    def at(cls, line: Floats, width: Floats, k: int, driving: Driving) -> _Corner:
        before, after = line[k] - line[k - 1], line[k + 1] - line[k]
        metres = math.hypot(*before), math.hypot(*after)
        u, v = before / metres[0], after / metres[1]
        turn = abs(math.atan2(u[0] * v[1] - u[1] * v[0], float(u @ v)))
        if turn <= _STRAIGHT or turn > math.pi - _STRAIGHT:
            return cls(line[k], u, v, turn, 0.0)
        room = max((min(width[k - 1], width[k]) - driving.robot_width) / 2, 0.0)
        # Neighbouring corners share the stretch between them; the ends of the path share with nobody.
        share = (1.0 if k == 1 else 0.5, 1.0 if k == len(line) - 2 else 0.5)
        tangent = min(metres[0] * share[0], metres[1] * share[1])
        by_length = tangent / math.tan(turn / 2)
        by_width = room / (1 / math.cos(turn / 2) - 1)
        radius = min(driving.turning_radius, by_length, by_width)
        return cls(line[k], u, v, turn, radius if radius >= _LEAST_RADIUS else 0.0)

    @property
    def offset(self) -> float:
        """How far the arc is off the corner."""
        if self.radius == 0.0:
            return 0.0
        return self.radius * (1 / math.cos(self.turn / 2) - 1)

    def arc(self) -> Floats:
        """Return the points of the arc, (n, 2); the corner itself where there is none."""
        if self.radius == 0.0:
            return self.point[None, :]
        tangent = self.radius * math.tan(self.turn / 2)
        begin = self.point - tangent * self.u
        left = self.u[0] * self.v[1] - self.u[1] * self.v[0] > 0
        normal = np.array([-self.u[1], self.u[0]]) * (1 if left else -1)
        angles = np.linspace(0.0, self.turn, max(math.ceil(self.turn / _STEP), 1) + 1)[:, None]
        arc: Floats = begin + self.radius * (np.sin(angles) * self.u + (1 - np.cos(angles)) * normal)
        return arc


def _filled(parts: list[Floats], spacing: float) -> Floats:
    """Return the line through ``parts`` with points at most ``spacing`` metres apart; none repeats."""
    line = np.concatenate(parts)
    metres = np.hypot(*np.diff(line, axis=0).T)
    line = line[np.concatenate([[True], metres > 1e-6])]
    if len(line) < 2:
        return np.repeat(line, 2, axis=0)
    pieces = []
    for a, b in pairwise(line):
        count = max(math.ceil(math.hypot(*(b - a)) / spacing - 1e-9), 1)
        pieces.append(a + (b - a) * (np.arange(count) / count)[:, None])
    return np.concatenate([*pieces, line[-1:]])


def _without_wobble(points: Floats, widths: Floats, driving: Driving) -> tuple[Floats, Floats, float]:
    """Return the line without points that are no bends (Douglas and Peucker, 1973), and its widths.

    A piece is as wide as the narrowest of what it stands for. The third is by how much points were off.
    """
    room = float(max((widths.min() - driving.robot_width) / 2, 0.0)) if len(widths) else 0.0
    slack = min(_WOBBLE, room / 2)
    keep = np.zeros(len(points), bool)
    keep[[0, -1]] = True
    wobble = 0.0
    open_pieces = [(0, len(points) - 1)]
    while open_pieces:
        begin, end = open_pieces.pop()
        if end - begin < 2:
            continue
        away = _away(points[begin + 1 : end], points[begin], points[end])
        k = int(np.argmax(away))
        if away[k] > slack:
            keep[begin + 1 + k] = True
            open_pieces += [(begin, begin + 1 + k), (begin + 1 + k, end)]
        else:
            wobble = max(wobble, float(away[k]))
    kept = np.flatnonzero(keep)
    moves = np.hypot(*np.diff(points[kept], axis=0).T) > 1e-9
    kept = kept[np.concatenate([[True], moves])]
    narrow = [widths[a:b].min() for a, b in pairwise(kept)]
    return points[kept], np.array(narrow), wobble


def _away(points: Floats, a: Floats, b: Floats) -> Floats:
    step = b - a
    square = max(float(step @ step), 1e-18)
    share = np.clip((points - a) @ step / square, 0.0, 1.0)
    away: Floats = np.hypot(*(a + share[:, None] * step - points).T)
    return away
