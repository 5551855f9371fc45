"""Whether cones may stand where they are: on an allowed surface, clear of obstacles and of one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .cone import Cone

Floats = NDArray[np.float64]


class Kind(Enum):
    """What a finding is about."""

    SURFACE = "surface"
    OBSTACLE = "obstacle"
    CONES = "cones"


@dataclass(frozen=True)
class Finding:
    """One cone that may not stand where it is, with the reason."""

    kind: Kind
    cone: str
    x: float
    y: float
    text: str


@dataclass(frozen=True)
class Shape:
    """An area or a line with a name: rings, (n, 2) metres and closed, of which the first is the outer one, or
    one line, (n, 2), with ``area`` false; a point is a line of one point."""

    rings: tuple[Floats, ...]
    name: str
    area: bool = True


def find(
    cones: Sequence[Cone],
    surfaces: Sequence[Shape] | None,
    obstacles: Sequence[Shape],
    obstacle_distance: float,
    cone_distance: float,
) -> list[Finding]:
    """Return what is wrong, in the order of the cones.

    A cone must be in one of ``surfaces``, unless that is None; ``obstacle_distance`` metres or more from
    every obstacle, and ``cone_distance`` from every other cone, measured from the middle of the cone.
    """
    findings = [
        *(off_surface(cones, surfaces) if surfaces is not None else []),
        *near_obstacles(cones, obstacles, obstacle_distance),
        *near_cones(cones, cone_distance),
    ]
    order = {cone.id: number for number, cone in enumerate(cones)}
    return sorted(findings, key=lambda finding: order[finding.cone])


def off_surface(cones: Sequence[Cone], surfaces: Sequence[Shape]) -> list[Finding]:
    """Return a finding for each cone that is in none of ``surfaces``."""
    points = _points(cones)
    on = np.zeros(len(cones), bool)
    for surface in surfaces:
        on |= _inside(points, surface.rings)
    text = "is on no surface that is allowed: move the layout, or allow the surface"
    return [_finding(Kind.SURFACE, cone, text) for cone, good in zip(cones, on, strict=True) if not good]


def near_obstacles(cones: Sequence[Cone], obstacles: Sequence[Shape], distance: float) -> list[Finding]:
    """Return a finding for each cone and each obstacle that it is in or nearer to than ``distance``."""
    points = _points(cones)
    findings = []
    for obstacle in obstacles:
        near = _near_box(points, obstacle.rings[0], distance)
        if not len(near):
            continue
        some = points[near]
        away = np.min([_away(some, ring) for ring in obstacle.rings], axis=0)
        inside = _inside(some, obstacle.rings) if obstacle.area else np.zeros(len(some), bool)
        for k in np.flatnonzero(inside | (away < distance - 1e-9)).tolist():
            how = "is inside" if inside[k] else f"is {away[k]:.2f} m from"
            text = f"{how} {obstacle.name}: keep {distance:g} m from obstacles"
            findings.append(_finding(Kind.OBSTACLE, cones[near[k]], text))
    return findings


def near_cones(cones: Sequence[Cone], distance: float) -> list[Finding]:
    """Return a finding for each cone that is nearer than ``distance`` to one placed before it."""
    points = _points(cones)
    findings = []
    for k in range(1, len(cones)):
        away = np.hypot(*(points[:k] - points[k]).T)
        other = int(np.argmin(away))
        if away[other] < distance - 1e-9:
            text = f"is {away[other]:.2f} m from {cones[other].id}: keep {distance:g} m between cones"
            findings.append(_finding(Kind.CONES, cones[k], text))
    return findings


def _near_box(points: Floats, line: Floats, distance: float) -> NDArray[np.int64]:
    """Return which of ``points`` are in the box around ``line`` or nearer to it than ``distance``.

    Of a long shore only the cones beside it are then held against each of its points.
    """
    low, high = line.min(axis=0) - distance, line.max(axis=0) + distance
    return np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))


def _points(cones: Sequence[Cone]) -> Floats:
    return np.array([(cone.x, cone.y) for cone in cones], dtype=np.float64).reshape(-1, 2)


def _finding(kind: Kind, cone: Cone, text: str) -> Finding:
    return Finding(kind, cone.id, cone.x, cone.y, f"Cone {cone.id} {text}.")


def _inside(points: Floats, rings: Sequence[Floats]) -> NDArray[np.bool_]:
    """Return which ``points`` an odd number of edges lie to the right of: those inside, holes left out."""
    odd = np.zeros(len(points), bool)
    x, y = points[:, :1], points[:, 1:]
    for ring in rings:
        a, b = ring[:-1], ring[1:]
        spans = (a[:, 1] > y) != (b[:, 1] > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        odd ^= (spans & (x < crossing)).sum(axis=1) % 2 == 1
    return odd


def _away(points: Floats, line: Floats) -> Floats:
    """Return the metres from each of ``points`` to ``line``."""
    if len(line) == 1:
        alone: Floats = np.hypot(*(points - line[0]).T)
        return alone
    a, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum((step * step).sum(axis=1), 1e-18)
    from_a = points[:, None, :] - a
    share = np.clip((from_a * step).sum(axis=2) / square, 0.0, 1.0)
    rest = from_a - share[:, :, None] * step
    nearest: Floats = np.hypot(rest[:, :, 0], rest[:, :, 1]).min(axis=1)
    return nearest
