"""Masks for Nav2's costmap filters: where robots must not drive, and how fast they may."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import AreaError
from .grid import Grid
from .lines import Points, signed_area
from .occupancy import FREE, OCCUPIED
from .raster import enclosed_cells, touched_cells
from .solids import edges_of

NO_LIMIT = 0
"""What SpeedFilter takes for no limit; it refuses unknown cells."""

_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True)
class MaskArea:
    """One polygon: the outer ring, then its holes, each (n, 2) metres in the site frame, in any direction.

    ``speed`` in m/s is for speed masks. ``name`` is for messages.
    """

    rings: Sequence[Points]
    name: str
    speed: float = math.nan


@dataclass(frozen=True, eq=False)
class SpeedMask:
    """``cells`` is (rows, columns) int8 from 0, no limit, to 100; the limit is cell x ``multiplier`` m/s."""

    grid: Grid
    cells: NDArray[Any]
    multiplier: float


def keepout_mask(grid: Grid, areas: Sequence[MaskArea]) -> NDArray[Any]:
    """Return (rows, columns) int8, OCCUPIED in each cell that an area touches and FREE elsewhere.

    KeepoutFilter leaves free cells as the costmap has them. Raises AreaError.
    """
    cells = np.full((grid.rows, grid.columns), FREE, dtype=np.int8)
    cells[_covered(grid, areas)] = OCCUPIED
    return cells


def speed_mask(grid: Grid, areas: Sequence[MaskArea]) -> SpeedMask:
    """Return the mask of speed limits, in steps that are never above the limit that was asked.

    Where areas overlap the lower speed holds; a cell on an edge belongs to both sides. Raises AreaError for a
    speed that is not above 0 and for one that is too low beside the highest to be told from 0.
    """
    for area in areas:
        if not math.isfinite(area.speed) or area.speed <= 0:
            raise AreaError(
                f"{area.name}: its speed is {area.speed:g} m/s; give one above 0, or make it a keepout area"
            )
    fastest = max((area.speed for area in areas), default=1.0)
    multiplier = _step_for(fastest)
    cells = np.full((grid.rows, grid.columns), NO_LIMIT, dtype=np.int8)
    for speed in sorted({area.speed for area in areas}, reverse=True):
        alike = [area for area in areas if area.speed == speed]
        value = math.floor(speed / multiplier + 1e-9)
        if value < 1:
            raise AreaError(
                f"{alike[0].name}: {speed:g} m/s cannot be told from 0 in a mask that also holds {fastest:g} "
                f"m/s; give at least {multiplier:g} m/s, or make it a keepout area"
            )
        cells[_covered(grid, alike)] = value
    return SpeedMask(grid, cells, multiplier)


def filter_parameters(kind: int, mask: str, multiplier: float = 1.0) -> bytes:
    """Return the parameters of Nav2's costmap_filter_info_server that belong to a mask, as YAML.

    ``kind`` is 0 for keepout and 2 for speeds in m/s; ``mask`` names the topics.
    """
    return (
        f"{mask}_filter_info_server:\n"
        "  ros__parameters:\n"
        f"    type: {kind}\n"
        f"    filter_info_topic: {mask}_filter_info\n"
        f"    mask_topic: {mask}_filter_mask\n"
        "    base: 0.0\n"
        f"    multiplier: {multiplier}\n"
    ).encode()


def _covered(grid: Grid, areas: Sequence[MaskArea]) -> NDArray[Any]:
    """Tell which cells an area touches, also with less than their centre."""
    rings = [ring for area in areas for ring in _oriented(area)]
    edges = edges_of(rings)
    covered: NDArray[Any] = enclosed_cells(grid, *edges) | touched_cells(grid, *edges)
    return covered


def _oriented(area: MaskArea) -> list[Points]:
    """Return the rings closed, the outer one counter-clockwise and holes clockwise."""
    oriented = []
    for number, points in enumerate(area.rings):
        ring = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        if len(ring) < 3 or not np.isfinite(ring).all():
            raise AreaError(
                f"{area.name}: ring {number + 1} is no polygon of finite points; correct or remove it"
            )
        if (ring[0] != ring[-1]).any():
            ring = np.concatenate([ring, ring[:1]])
        solid = signed_area(ring) >= 0
        oriented.append(ring if solid == (number == 0) else ring[::-1])
    return oriented


def _step_for(fastest: float) -> float:
    """Return the smallest step, m/s, of which a hundred reach the highest speed."""
    for step in _STEPS:
        if fastest <= 100 * step * (1 + 1e-9):
            return step
    raise AreaError(
        f"a speed limit of {fastest:g} m/s is above {100 * _STEPS[-1]:g} m/s: give metres a second"
    )
