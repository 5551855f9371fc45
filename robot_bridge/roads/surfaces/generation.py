"""Surfaces made of centrelines by their widths, dissolved by class, kept clear of one another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...missing_packages import installation
from ..centrelines import Centrelines
from ..errors import CancelledError, RoadsError
from .joins import wedges
from .strips import strips_of
from .surface import GENERATED, Surface

PRECEDENCE = ("slippery", "asphalt", "parking pavement")
"""Which class keeps the ground where several are: what is slippery must never be taken for grip."""

SMALLEST_M2, SMALLEST_HOLE_M2 = 0.01, 1.0
"""Pieces and holes below these are what is left between two outlines that are almost one."""

_AT_ONCE = 2000
"""Strips that are joined together; a cancel is seen between them."""

Progress = Callable[[float], bool]
"""Told how much is done, 0 to 1; says whether to go on."""


def generate(
    roads: Centrelines,
    drawn: Sequence[Surface] = (),
    precedence: Sequence[str] = PRECEDENCE,
    progress: Progress = lambda share: True,
) -> list[Surface]:
    """Return the surfaces of ``roads``, a piece of ground in one of them only, and in none of ``drawn``.

    Roads are strips of their widths, ended square, with mitred corners, within a road and where roads end in
    one point. Strips of one class become one surface. Where classes meet, the one that comes first in
    ``precedence`` keeps the ground; of those that are not in it the one with less ground, after all that are.

    :raises CancelledError: when ``progress`` says so.
    :raises RoadsError: where shapely is not installed.
    """
    shapely = _shapely()
    names = sorted(set(roads.surface.tolist()))
    steps = _Steps(len(roads) + 2 * len(names) + 1, progress)
    corners, of_corner = wedges(roads, [_place(name, precedence) for name in roads.surface.tolist()])
    wholes: dict[str, Any] = {}
    for name in names:
        own = np.flatnonzero(roads.surface == name)
        strips = np.concatenate([strips_of(roads, own), corners[np.isin(of_corner, own)]])
        wholes[name] = _without_slits(_joined(strips, steps, len(own)))
    taken = shapely.union_all([polygon_of(one.rings) for one in drawn]) if drawn else shapely.Polygon()
    steps.done(1)
    made: list[Surface] = []
    for name in _order(wholes, precedence):
        free = shapely.difference(wholes[name], taken)
        steps.done(1)
        made += [Surface(rings_of(part), name, origin=GENERATED) for part in _polygons(free)]
        taken = shapely.union(taken, wholes[name])
        steps.done(1)
    return made


def polygon_of(rings: Sequence[Any]) -> Any:
    """Return the valid shapely geometry of ``rings``, the outer one first."""
    shapely = _shapely()
    outer, *holes = rings
    return shapely.make_valid(shapely.Polygon(outer, holes))


def rings_of(polygon: Any) -> tuple[Any, ...]:
    """Return the rings of a shapely polygon, the outer one first, (n, 2) each."""
    shapely = _shapely()
    # Not by coords: inside QGIS, whose GEOS is another, shapely 2.2 fails at that now and then.
    return tuple(shapely.get_coordinates(ring) for ring in shapely.get_rings(polygon))


class _Steps:
    def __init__(self, total: int, progress: Progress) -> None:
        self._total, self._progress, self._count = total, progress, 0

    def done(self, count: int) -> None:
        self._count += count
        if not self._progress(self._count / self._total):
            raise CancelledError("Making road surfaces was cancelled; nothing was written.")


def _joined(strips: Any, steps: _Steps, roads: int) -> Any:
    """Return the union of ``strips``, neighbours first; counts ``roads`` steps."""
    shapely = _shapely()
    strips = strips[~shapely.is_empty(strips)]
    strips = strips[np.argsort(shapely.get_x(shapely.centroid(strips)))]
    parts = []
    for begin in range(0, len(strips), _AT_ONCE):
        parts.append(shapely.union_all(strips[begin : begin + _AT_ONCE]))
        steps.done(0)
    whole = shapely.union_all(parts)
    steps.done(roads)
    return whole


def _without_slits(whole: Any) -> Any:
    shapely = _shapely()
    rings = shapely.get_rings(whole)
    slits = shapely.polygons(rings[shapely.area(shapely.polygons(rings)) < SMALLEST_HOLE_M2])
    return shapely.union_all([whole, *slits]) if len(slits) else whole


def _place(name: str, precedence: Sequence[str]) -> int:
    known = [_plain(one) for one in precedence]
    return known.index(_plain(name)) if _plain(name) in known else len(known)


def _plain(name: str) -> str:
    """Return the name of a class as it is compared: ``Parking_pavement`` is ``parking pavement``."""
    return " ".join(name.replace("_", " ").split()).lower()


def _order(wholes: dict[str, Any], precedence: Sequence[str]) -> list[str]:
    # Ground of which nothing is known says less than any class.
    return sorted(
        wholes, key=lambda name: (name == "", _place(name, precedence), _shapely().area(wholes[name]), name)
    )


def _polygons(geometry: Any) -> list[Any]:
    shapely = _shapely()
    parts = shapely.get_parts(geometry)
    polygons = parts[(shapely.get_type_id(parts) == 3) & (shapely.area(parts) >= SMALLEST_M2)]
    return list(polygons)


def _shapely() -> Any:
    try:
        import shapely
    except ImportError as error:
        raise RoadsError(
            "The Python package shapely 2 is missing, which makes surfaces of centrelines: install it "
            f"{installation('shapely')}."
        ) from error
    return shapely
