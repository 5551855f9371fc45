"""The site's map as OccupancyGrid, and keepout and speed masks for Nav2's costmap filters."""

from __future__ import annotations

import asyncio
import hashlib
import math
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.errors import ExportGridError, MaskAreaError, RobotMapError
from ...core.messages.links import SiteAreas, SiteRoad
from ...core.robotmap.binary import decode
from ...core.robotmap.exporters.nav2 import MaskArea, RasterGrid, keepout_mask, speed_mask
from ..base.adapter import Link
from ..base.errors import CommandRefusedError
from .messages import FILTER_INFO, GRID, MOST_CELLS, Outgoing

# --- The site's map as OccupancyGrid, built once for all robots of a link ---

Encode = Callable[[str, Any], bytes]
"""Encodes a message of a type for publication."""

MOST_GRIDS_KEPT = 4
"""grids: those of large sites differ between robots, those of others do not."""


class Grids:
    """Builds grids of robot maps, one at a time in another thread: a map of 200 m takes a second."""

    def __init__(self, encode: Encode, outgoing: Outgoing, resolution: float) -> None:
        self._encode = encode
        self._outgoing = outgoing
        self._resolution = resolution
        self._making = asyncio.Lock()
        self._kept: OrderedDict[bytes, bytes] = OrderedDict()

    async def of(self, robot_map: bytes) -> bytes:
        """Return the message of a robot map, encoded; raises CommandRefusedError if that fails."""
        key = hashlib.sha256(robot_map).digest()
        async with self._making:
            if key not in self._kept:
                try:
                    self._kept[key] = await asyncio.to_thread(self._make, robot_map)
                except (RobotMapError, ExportGridError, ValueError) as error:
                    raise CommandRefusedError(f"the map cannot be made an OccupancyGrid: {error}") from None
                while len(self._kept) > MOST_GRIDS_KEPT:
                    self._kept.popitem(last=False)
            self._kept.move_to_end(key)
            return self._kept[key]

    def _make(self, robot_map: bytes) -> bytes:
        return self._encode(GRID, self._outgoing.grid(robot_map, self._resolution))


# --- Keepout and speed masks for Nav2's costmap filters, from the site's own keepouts and roads ---

MOST_MASKS_KEPT = 2
"""pairs of masks, of 16 MB each at most."""
_CORNERS = 16
"""corners of the polygon around the end of a road's leg."""

KEEPOUT, SPEED = 0, 2
"""CostmapFilterInfo: KeepoutFilter, and SpeedFilter with m/s."""


@dataclass(frozen=True)
class SiteMasks:
    """Two OccupancyGrids, encoded; a cell of ``speed`` times ``multiplier`` is m/s, and 0 is no limit."""

    keepout: bytes
    speed: bytes
    multiplier: float


class Masks:
    """Builds the masks on the grid of a robot's map, once for all robots with that map."""

    def __init__(self, encode: Encode, outgoing: Outgoing, resolution: float, link: Link) -> None:
        self._encode = encode
        self._outgoing = outgoing
        self._resolution = resolution
        self._link = link
        self._making = asyncio.Lock()
        self._kept: OrderedDict[bytes, SiteMasks] = OrderedDict()

    async def of(self, robot_map: bytes) -> SiteMasks:
        """Return the masks for a robot map; waits for the site's areas from the gateway.

        :raises CommandRefusedError: when they cannot be built.
        """
        key = hashlib.sha256(robot_map).digest()
        async with self._making:
            if key not in self._kept:
                try:
                    grid = await asyncio.to_thread(self._grid, robot_map)
                    areas = await self._link.areas(_box(grid))
                    self._kept[key] = await asyncio.to_thread(self._make, grid, areas)
                except (RobotMapError, ExportGridError, MaskAreaError, ValueError) as error:
                    raise CommandRefusedError(f"the masks cannot be made: {error}") from None
                while len(self._kept) > MOST_MASKS_KEPT:
                    self._kept.popitem(last=False)
            self._kept.move_to_end(key)
            return self._kept[key]

    def info(self, kind: int, topic: str, multiplier: float) -> bytes:
        """Return the CostmapFilterInfo, encoded, of the mask on ``topic``."""
        return self._encode(FILTER_INFO, self._outgoing.filter_info(kind, topic, multiplier))

    def _grid(self, robot_map: bytes) -> RasterGrid:
        return RasterGrid.covering(decode(robot_map).border, self._resolution, MOST_CELLS)

    def _make(self, grid: RasterGrid, areas: SiteAreas) -> SiteMasks:
        keepouts = keepout_mask(grid, [MaskArea([*map(_ring, a.rings)], a.name) for a in areas.keepouts])
        speeds = speed_mask(grid, road_areas(areas.roads))
        encoded = [
            self._encode(GRID, self._outgoing.cells(grid, cells)) for cells in (keepouts, speeds.cells)
        ]
        return SiteMasks(encoded[0], encoded[1], speeds.multiplier)


def road_areas(roads: Sequence[SiteRoad]) -> list[MaskArea]:
    """Return the areas of roads: a rectangle for each leg, and round ends and corners."""
    turn = np.linspace(0.0, math.tau, _CORNERS, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    areas = []
    for road in roads:
        points, half = _ring(road.points), road.width / 2
        legs = np.diff(points, axis=0)
        length = np.hypot(legs[:, 0], legs[:, 1])
        keep = length > 0
        side = half * np.column_stack([-legs[keep, 1], legs[keep, 0]]) / length[keep, None]
        starts, ends = points[:-1][keep], points[1:][keep]
        rings = [*np.stack([starts - side, ends - side, ends + side, starts + side], axis=1)]
        rings += [place + half * circle for place in points]
        areas += [MaskArea([ring], "a road", road.speed) for ring in rings]
    return areas


def _ring(points: Sequence[tuple[float, float]]) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.asarray(points, dtype=np.float64).reshape(-1, 2)


def _box(grid: RasterGrid) -> tuple[float, float, float, float]:
    width, height = grid.columns * grid.resolution, grid.rows * grid.resolution
    return grid.x_min, grid.y_min, grid.x_min + width, grid.y_min + height
