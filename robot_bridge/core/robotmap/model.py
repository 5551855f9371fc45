"""The robot map: border, oriented obstacle segments, and the window of a partial map."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from typing import Any, NamedTuple, overload

from numpy.typing import NDArray

from ..errors import WindowError

# --- The robot map: a border and oriented obstacle segments (paper 1, section II) ---

CUT = "cut"
"""The extra, of value ``1``, of a part of a ring that the border cut; its inside is on the left."""

PART_OF = "part_of"
"""The leading line of a map that does not cover all of its site: x_min, y_min, x_max, y_max of the site."""


class ShapeType(IntEnum):
    """How an obstacle is represented: the integer ST of the paper, in the order of its text."""

    CLOSED_POLYGON = 1
    OPEN_POLYGON = 2
    CLOSED_CURVE = 3
    OPEN_CURVE = 4
    STAIRS = 5
    RAMP = 6


class Border(NamedTuple):
    """The rectangle that a map covers, metres in the site frame."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @property
    def left_upper(self) -> tuple[float, float]:
        """The corner that the format names first."""
        return self.x_min, self.y_max

    @property
    def right_lower(self) -> tuple[float, float]:
        """The corner that the format names second."""
        return self.x_max, self.y_min

    def contains(self, other: Border) -> bool:
        """Return whether no part of ``other`` is outside."""
        lower = self.x_min <= other.x_min and self.y_min <= other.y_min
        return lower and self.x_max >= other.x_max and self.y_max >= other.y_max

    def holds(self, x: float, y: float) -> bool:
        """Return whether (x, y) is not outside."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max

    @property
    def area(self) -> float:
        """Square metres."""
        return (self.x_max - self.x_min) * (self.y_max - self.y_min)


class EncodedMap(NamedTuple):
    """A map in the binary format, its border, and whether that is the whole site."""

    content: bytes
    border: Border
    is_whole: bool


@dataclass(frozen=True, eq=False)
class Obstacle:
    """One obstacle with n oriented segments from ``a`` to ``b``; free space lies to the right of a→b.

    ``text`` is its text in the source file, so that it is written back byte for byte; a
    changed copy, made by ``dataclasses.replace``, has none.
    """

    id: int
    shape_type: ShapeType
    semantics: str
    a: NDArray[Any]
    """(n, 2) float64, metres in the site frame."""
    b: NDArray[Any]
    """(n, 2) float64, metres in the site frame."""
    height: NDArray[Any]
    """(n,) float64, metres."""
    outdoor: NDArray[Any]
    """(n,) bool."""
    segment_semantics: tuple[str, ...]
    ext: dict[str, str] = field(default_factory=dict)
    segment_ext: tuple[dict[str, str], ...] = ()
    """n mappings, or empty if no segment has any."""
    text: str | None = field(default=None, init=False, repr=False)


@dataclass(frozen=True, eq=False)
class BuiltObstacles(Sequence[Obstacle]):
    """K obstacles with n segments in columns; each :class:`Obstacle` is created on access.

    A map that is written right after being built needs none of them, and creating them takes half of its
    time.
    """

    ids: Sequence[int]
    shape_types: Sequence[ShapeType]
    semantics: Sequence[str]
    ext: Sequence[dict[str, str]]
    offsets: Sequence[int]
    """K + 1 rows: obstacle k has rows ``offsets[k]`` to ``offsets[k + 1]``."""
    a: NDArray[Any]
    """(n, 2) float64, metres in the site frame."""
    b: NDArray[Any]
    """(n, 2) float64, metres in the site frame."""
    height: NDArray[Any]
    """(n,) float64, metres."""
    outdoor: NDArray[Any]
    """(n,) bool."""

    def __len__(self) -> int:
        return len(self.ids)

    def __iter__(self) -> Iterator[Obstacle]:
        return iter(self._made)

    @overload
    def __getitem__(self, k: int) -> Obstacle: ...
    @overload
    def __getitem__(self, k: slice) -> Sequence[Obstacle]: ...
    def __getitem__(self, k: int | slice) -> Obstacle | Sequence[Obstacle]:
        return self._made[k]

    @cached_property
    def _made(self) -> tuple[Obstacle, ...]:
        bounds = zip(self.offsets, self.offsets[1:], strict=False)
        heads = zip(self.ids, self.shape_types, self.semantics, self.ext, bounds, strict=True)
        return tuple(
            Obstacle(
                id=id,
                shape_type=shape_type,
                semantics=semantics,
                a=self.a[begin:end],
                b=self.b[begin:end],
                height=self.height[begin:end],
                outdoor=self.outdoor[begin:end],
                segment_semantics=("",) * (end - begin),
                ext=ext,
            )
            for id, shape_type, semantics, ext, (begin, end) in heads
        )


@dataclass(frozen=True, eq=False)
class RobotMap:
    """A map of ``border`` with its obstacles.

    ``meta`` are its leading lines (version, crs, origin, rotation, id). ``warnings`` report oddities in its
    source. ``head`` and ``tail`` are the texts before the first obstacle and after the last one in the source
    file.
    """

    border: Border
    obstacles: Sequence[Obstacle]
    meta: dict[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    head: str | None = field(default=None, init=False, repr=False)
    tail: str = field(default="", init=False, repr=False)

    @property
    def segment_count(self) -> int:
        """Total number of segments."""
        if isinstance(self.obstacles, BuiltObstacles):
            return len(self.obstacles.a)
        return sum(len(obstacle.a) for obstacle in self.obstacles)


# --- The zone that a partial map covers (paper 1, section III.B: H x W around the robot) ---

SMALLEST_SIDE = 0.02
"""metres; a map is in centimetres, and anything smaller has no inside at that precision."""


@dataclass(frozen=True)
class Window:
    """A rectangle centred on (x, y): ``width`` along x and ``height`` along y, metres in the site frame."""

    x: float
    y: float
    width: float
    height: float

    def __post_init__(self) -> None:
        for name in ("x", "y", "width", "height"):
            if not math.isfinite(getattr(self, name)):
                raise WindowError(f"window: {name} is {getattr(self, name)}; give a finite number of metres")
        for name in ("width", "height"):
            if getattr(self, name) < SMALLEST_SIDE:
                raise WindowError(
                    f"window: {name} is {getattr(self, name):g} m, so it encloses nothing; "
                    f"give at least {SMALLEST_SIDE} m, such as 100"
                )

    @classmethod
    def square(cls, x: float, y: float, area: float) -> Window:
        """Return the square of ``area`` m² centred on (x, y)."""
        if not math.isfinite(area) or area <= 0:
            raise WindowError(f"window: the area is {area} m², so it encloses nothing; give more than 0")
        side = math.sqrt(area)
        return cls(x, y, side, side)

    @classmethod
    def from_bounds(cls, x_min: float, y_min: float, x_max: float, y_max: float) -> Window:
        """Return the window between two corners."""
        return cls((x_min + x_max) / 2, (y_min + y_max) / 2, x_max - x_min, y_max - y_min)

    @property
    def border(self) -> Border:
        """Its rectangle, in whole centimetres, as written in a map."""
        return Border(
            round(self.x - self.width / 2, 2),
            round(self.y - self.height / 2, 2),
            round(self.x + self.width / 2, 2),
            round(self.y + self.height / 2, 2),
        )
