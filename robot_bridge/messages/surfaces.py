"""Which road surface is at a place: what robots and operators ask, and what they are answered with.

The paper's tables have no such operation: GetSurface and SetSurface are this project's own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from .checks import MessageError, Texts, check_crs, check_finite, check_texts

MOST_OF_A_ROBOT = 1000
MOST_OF_A_DESK = 10_000
"""Places in one question."""
LONGEST_SOURCE = 128
"""characters."""


@dataclass(frozen=True)
class GetSurface:
    """The robot asks which road surface is at each of ``points``; an operation beside the paper's tables.

    They are metres in the site frame, or in the CRS ``crs``, such as ``EPSG:4326``, x (longitude, easting)
    before y whatever the CRS. ``source`` is a number or name of the robot's own; SetSurface has it, too.
    """

    points: list[tuple[float, float]]
    crs: str | None = None
    source: str | None = None
    magic: int | None = None
    acknowledged: ClassVar[bool] = True
    texts: ClassVar[Texts] = {"source": LONGEST_SOURCE}

    def __post_init__(self) -> None:
        _check(self.points, self.crs, MOST_OF_A_ROBOT)
        check_texts(self)


@dataclass(frozen=True)
class SetSurface:
    """The answer to GetSurface: the class of the surface at each point in turn, such as ``asphalt``.

    None where there is no road surface, empty where its class is not known. ``source`` is the question's.
    """

    surfaces: list[str | None]
    source: str | None = None


@dataclass(frozen=True)
class GetSurfaces:
    """Ask which road surface is at each of ``points``, metres in the site frame, or in the CRS ``crs``.

    In a CRS such as ``EPSG:4326`` x (longitude, easting) comes before y whatever the CRS.
    """

    method: ClassVar[str] = "get_surface"
    points: list[tuple[float, float]]
    crs: str | None = None

    def __post_init__(self) -> None:
        _check(self.points, self.crs, MOST_OF_A_DESK)


@dataclass(frozen=True)
class SurfaceAt:
    """The road surface at a place: its class, its name if it has one, and where it comes from."""

    surface: str
    origin: Literal["drawn", "generated"]
    name: str | None = None


@dataclass(frozen=True)
class Surfaces:
    """The surface at each point in turn, None where there is none."""

    surfaces: list[SurfaceAt | None]


def _check(points: Sequence[tuple[float, float]], crs: str | None, most: int) -> None:
    if not 1 <= len(points) <= most:
        raise MessageError(f"points holds {len(points)} points; give 1 to {most}, more in further questions")
    for number, (x, y) in enumerate(points):
        check_finite(**{f"points[{number}].x": x, f"points[{number}].y": y})
    check_crs(crs)
