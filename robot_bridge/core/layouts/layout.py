"""Cone layouts: cones, rows, dimensions, placement on a site, and checks whether cones may stand there."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from enum import Enum, auto
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import ConeCountError, DimensionError, LayoutLineError
from ..messages.plans import MOST_CONES

# --- One cone of a layout ---

ORANGE, BIG_ORANGE, BLUE, YELLOW = "orange", "big_orange", "blue", "yellow"
COLOURS = (ORANGE, BIG_ORANGE, BLUE, YELLOW)
"""The cones of Formula Student: blue on the left of the track, yellow on its right, orange at entry and exit,
big orange at timing lines."""


@dataclass(frozen=True)
class Spot:
    """Where a cone stands: x forward and y left in metres, the direction of travel there in
    radians counter-clockwise from x."""

    x: float
    y: float
    theta: float
    colour: str
    role: str


@dataclass(frozen=True)
class Cone:
    """A spot with a name and a number in the order of placing, from 1."""

    id: str
    order: int
    x: float
    y: float
    theta: float
    colour: str
    role: str


def numbered(spots: Iterable[Spot], prefix: str) -> list[Cone]:
    """Return ``spots`` as cones ``prefix-1``, ``prefix-2``, ... in their order."""
    return [
        Cone(f"{prefix}-{order}", order, spot.x, spot.y, spot.theta, spot.colour, spot.role)
        for order, spot in enumerate(spots, 1)
    ]


# --- Rows of cones on both sides of a lane ---


def lane(
    along: list[float],
    right: float,
    width: float,
    base: float,
    role: str,
    colours: tuple[str, str] = (ORANGE, ORANGE),
) -> list[Spot]:
    """Return a cone left and one right at each x of ``along``, outside a lane and touching its limits.

    ``right`` is the y of the right limit; ``colours`` are those of left and right.
    """
    left_colour, right_colour = colours
    return [
        spot
        for x in along
        for spot in (
            Spot(x, right + width + base / 2, 0.0, left_colour, f"{role} left".strip()),
            Spot(x, right - base / 2, 0.0, right_colour, f"{role} right".strip()),
        )
    ]


def spaced(start: float, length: float, spacing: float) -> list[float]:
    """Return x from ``start`` to ``start + length``, evenly, as near to ``spacing`` apart as that allows."""
    return [float(x) for x in np.linspace(start, start + length, max(1, round(length / spacing)) + 1)]


def pairs(length: float, spacing: float) -> float:
    """Return how many cones a :func:`lane` along :func:`spaced` places has, without making them."""
    return 2 * (length / spacing + 1)


def across(x: float, right: float, width: float, count: int, role: str) -> list[Spot]:
    """Return ``count`` orange cones between the limits of a lane, which they close at ``x``."""
    steps = np.arange(1, count + 1) / (count + 1)
    return [Spot(x, float(right + width * step), 0.0, ORANGE, role) for step in steps]


def mirrored(spots: list[Spot]) -> list[Spot]:
    """Return ``spots`` with left and right exchanged, roles too."""
    other = {"left": "right", "right": "left"}
    return [
        Spot(s.x, -s.y, -s.theta, s.colour, " ".join(other.get(word, word) for word in s.role.split()))
        for s in spots
    ]


# --- Base of layouts: a name, the standard it follows, adjustable dimensions, and cones

BASE_M = 0.285
"""Across the base of the cone of 505 mm of Formula Student; ISO 3888-2 asks for 500 mm of height or more."""


class DimensionFault(Enum):
    """Faults of a value of a dimension."""

    NO_NUMBER = auto()
    NOT_CHOSEN = auto()
    TOO_SMALL = auto()
    NOT_WHOLE = auto()


@dataclass(frozen=True)
class Dimension:
    """One number of a layout: what it is, in which unit, and its value in the standard.

    Values are ``least`` or more, without a fraction if ``whole``, and one of ``choices`` if there are any:
    these map to their meanings.
    """

    name: str
    text: str
    unit: str
    standard: float
    least: float
    whole: bool
    choices: Mapping[float, str]

    @property
    def choices_text(self) -> str:
        """Return the choices, the least one first."""
        return ", ".join(f"{choice:g}" for choice in sorted(self.choices))

    @property
    def whole_text(self) -> str:
        """Return the description, with the meaning of each choice."""
        meanings = ", ".join(f"{choice:g} {name}" for choice, name in self.choices.items())
        return f"{self.text}: {meanings}" if meanings else self.text

    def fault(self, value: float) -> DimensionFault | None:
        """Return the fault of ``value``, None if it is valid."""
        if not math.isfinite(value):
            return DimensionFault.NO_NUMBER
        if self.choices and value not in self.choices:
            return DimensionFault.NOT_CHOSEN
        if value < self.least:
            return DimensionFault.TOO_SMALL
        return DimensionFault.NOT_WHOLE if self.whole and value != int(value) else None

    def problem(self, value: float) -> str:
        """Return what to give instead of ``value``, an empty text if it is valid."""
        fault = self.fault(value)
        if fault is None:
            return ""
        return {
            DimensionFault.NO_NUMBER: "give a number",
            DimensionFault.NOT_CHOSEN: f"give one of {self.choices_text}",
            DimensionFault.TOO_SMALL: f"give {self.least:g} or more",
            DimensionFault.NOT_WHOLE: "give a whole number",
        }[fault]


def dimension(standard: float, text: str, unit: str = "m", least: float = 0.0, **limits: Any) -> Any:
    """Return the field of a dimension; ``limits`` are ``whole`` and ``choices`` of :class:`Dimension`."""
    return field(default=standard, metadata={"text": text, "unit": unit, "least": least, **limits})


@dataclass(frozen=True)
class Layout(ABC):
    """A layout with its dimensions, in a frame of its own: x along the travel, y to the left, in metres.

    :raises DimensionError: when a dimension has an invalid value; ConeCountError, naming it, when it makes
        more than ``MOST_CONES`` cones, as many as a plan may have.
    """

    NAME: ClassVar[str] = ""
    TITLE: ClassVar[str] = ""
    STANDARD: ClassVar[str] = ""

    cone_base: float = dimension(
        BASE_M, "Across the base of a cone; the cones touch the track's limits", least=0
    )

    def __post_init__(self) -> None:
        for one in self.dimensions():
            problem = one.problem(getattr(self, one.name))
            if problem:
                value = getattr(self, one.name)
                raise DimensionError(f"{self.NAME}: {one.name} is {value:g}: {problem}.")
        counts = self.cone_counts()
        total = sum(counts.values())
        if total > MOST_CONES:
            most = max(counts, key=lambda name: counts[name])
            raise ConeCountError(
                f"{self.NAME}: {most} is {getattr(self, most):g}: that makes {total:.0f} cones, "
                f"and a plan has {MOST_CONES} at most: give less, or a greater spacing if there is one.",
                most,
            )

    @classmethod
    def dimensions(cls) -> list[Dimension]:
        """Return every dimension of the layout."""
        unlimited: dict[str, Any] = {"least": 0.0, "whole": False, "choices": {}}
        return [
            Dimension(name=one.name, **{"standard": one.default, **unlimited, **one.metadata})
            for one in fields(cls)
        ]

    @classmethod
    def of(cls, values: Mapping[str, float]) -> Layout:
        """Return the layout with ``values`` in place of the standard's.

        :raises DimensionError: naming the layout's dimensions, when a name is none of them.
        """
        known = [one.name for one in cls.dimensions()]
        for name in values:
            if name not in known:
                raise DimensionError(f"{cls.NAME} has no dimension {name!r}: give {', '.join(known)}.")
        return cls(**values)

    @abstractmethod
    def cone_counts(self) -> dict[str, float]:
        """Return how many cones, to about ten, each dimension makes, without making them."""

    @abstractmethod
    def spots(self) -> list[Spot]:
        """Return where the cones stand, in the order of placing."""

    def cones(self, prefix: str = "") -> list[Cone]:
        """Return the cones, named after ``prefix`` or the layout."""
        return numbered(self.spots(), prefix or self.NAME)


# --- From a layout's own frame to the site: at a pose, or along a line ---

Floats = NDArray[np.float64]


def cones_at_pose(cones: Sequence[Cone], x: float, y: float, theta: float) -> list[Cone]:
    """Return ``cones`` with their frame's origin at (x, y), in metres, and its x axis turned to ``theta``."""
    cos, sin = math.cos(theta), math.sin(theta)
    return [
        replace(
            cone,
            x=x + cone.x * cos - cone.y * sin,
            y=y + cone.x * sin + cone.y * cos,
            theta=math.remainder(cone.theta + theta, 2 * math.pi),
        )
        for cone in cones
    ]


def cones_along_line(cones: Sequence[Cone], line: Floats, start: float = 0.0) -> list[Cone]:
    """Return ``cones`` bent along ``line``, (n, 2) metres: x becomes metres along it, y metres to its left.

    The layout's origin comes ``start`` metres after the line's beginning. Thetas follow the line.

    :raises LayoutLineError: when the line has no length or is too short; it says how much is missing.
    """
    points = _cleaned(line)
    steps = np.diff(points, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    at = np.concatenate([[0.0], np.cumsum(lengths)])
    places = np.array([cone.x for cone in cones]) + start
    _check_length(places, float(at[-1]))
    edge = np.clip(np.searchsorted(at, places, side="right") - 1, 0, len(steps) - 1)
    unit = steps[edge] / lengths[edge, None]
    # A cone at a corner stands on the bisector, or rows would cross or gape there.
    normal = _normals(steps / lengths[:, None], edge, places, at)
    middle = points[edge] + unit * (places - at[edge])[:, None]
    aside = np.array([cone.y for cone in cones])[:, None]
    xy = middle + normal * aside
    theta = np.arctan2(-normal[:, 0], normal[:, 1])
    return [
        replace(cone, x=float(x), y=float(y), theta=math.remainder(cone.theta + float(turn), 2 * math.pi))
        for cone, (x, y), turn in zip(cones, xy, theta, strict=True)
    ]


def _cleaned(line: Floats) -> Floats:
    """Return ``line`` without points that repeat."""
    points = np.asarray(line, dtype=np.float64)
    if points.ndim != 2 or points.shape[1:] != (2,) or not np.isfinite(points).all():
        raise LayoutLineError("The line is none: give two points (x, y) or more, in metres.")
    kept: Floats = points[np.concatenate([[True], (np.diff(points, axis=0) != 0).any(axis=1)])]
    if len(kept) < 2:
        raise LayoutLineError("The line has no length: give two points (x, y) or more that differ.")
    return kept


def _check_length(places: Floats, length: float) -> None:
    if len(places) and places.min() < -1e-6:
        raise LayoutLineError(
            f"The layout begins {-places.min():.2f} m before the line: start at least so much further on."
        )
    if len(places) and places.max() > length + 1e-6:
        raise LayoutLineError(
            f"The line is {length:.2f} m long and the layout reaches to {places.max():.2f} m: take a longer "
            "line, begin earlier, or make the layout shorter."
        )


def _normals(units: Floats, edge: NDArray[np.int64], places: Floats, at: Floats) -> Floats:
    """Return the unit normals to the left, (n, 2), at ``places``; at a corner that of the bisector."""
    corner = np.isclose(places, at[edge], rtol=0, atol=1e-9) & (edge > 0)
    along = units[edge] + np.where(corner[:, None], units[edge - 1], 0.0)
    size = np.hypot(along[:, 0], along[:, 1])[:, None]
    along = np.where(size > 1e-9, along / np.maximum(size, 1e-9), units[edge])
    return np.stack([-along[:, 1], along[:, 0]], axis=1)


# --- Checks of cone positions: on an allowed surface, clear of obstacles and of one another


class ConeFindingKind(Enum):
    """The subject of a finding."""

    SURFACE = "surface"
    OBSTACLE = "obstacle"
    CONES = "cones"


@dataclass(frozen=True)
class ConeFinding:
    """A misplaced cone, with the reason."""

    kind: ConeFindingKind
    cone: str
    x: float
    y: float
    text: str


@dataclass(frozen=True)
class NamedGeometry:
    """An area or a line with a name: rings, (n, 2) metres and closed, of which the first is the outer one, or
    one line, (n, 2), with ``area`` false; a point is a line of one point."""

    rings: tuple[Floats, ...]
    name: str
    area: bool = True


def find_misplaced_cones(
    cones: Sequence[Cone],
    surfaces: Sequence[NamedGeometry] | None,
    obstacles: Sequence[NamedGeometry],
    obstacle_distance: float,
    cone_distance: float,
) -> list[ConeFinding]:
    """Return findings in the order of the cones.

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


def off_surface(cones: Sequence[Cone], surfaces: Sequence[NamedGeometry]) -> list[ConeFinding]:
    """Return a finding for each cone that is in none of ``surfaces``."""
    points = _points(cones)
    on = np.zeros(len(cones), bool)
    for surface in surfaces:
        on |= _inside(points, surface.rings)
    text = "is on no surface that is allowed: move the layout, or allow the surface"
    return [
        _finding(ConeFindingKind.SURFACE, cone, text)
        for cone, good in zip(cones, on, strict=True)
        if not good
    ]


def near_obstacles(
    cones: Sequence[Cone], obstacles: Sequence[NamedGeometry], distance: float
) -> list[ConeFinding]:
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
            findings.append(_finding(ConeFindingKind.OBSTACLE, cones[near[k]], text))
    return findings


def near_cones(cones: Sequence[Cone], distance: float) -> list[ConeFinding]:
    """Return a finding for each cone that is nearer than ``distance`` to one placed before it."""
    points = _points(cones)
    findings = []
    for k in range(1, len(cones)):
        away = np.hypot(*(points[:k] - points[k]).T)
        other = int(np.argmin(away))
        if away[other] < distance - 1e-9:
            text = f"is {away[other]:.2f} m from {cones[other].id}: keep {distance:g} m between cones"
            findings.append(_finding(ConeFindingKind.CONES, cones[k], text))
    return findings


def _near_box(points: Floats, line: Floats, distance: float) -> NDArray[np.int64]:
    """Return which of ``points`` are in the box around ``line`` or nearer to it than ``distance``.

    So only the cones near a long shoreline are compared with each of its points.
    """
    low, high = line.min(axis=0) - distance, line.max(axis=0) + distance
    return np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))


def _points(cones: Sequence[Cone]) -> Floats:
    return np.array([(cone.x, cone.y) for cone in cones], dtype=np.float64).reshape(-1, 2)


def _finding(kind: ConeFindingKind, cone: Cone, text: str) -> ConeFinding:
    return ConeFinding(kind, cone.id, cone.x, cone.y, f"Cone {cone.id} {text}.")


def _inside(points: Floats, rings: Sequence[Floats]) -> NDArray[np.bool_]:
    """Return which ``points`` are inside, not in holes: an odd number of edges lies to their right."""
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
