"""The site's map as OccupancyGrid, made once for all robots of a link."""

from __future__ import annotations

import asyncio
import hashlib
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from ...robotmap.errors import RobotMapError
from ...robotmap.exporters.errors import GridError
from ..base.errors import CommandRefusedError
from .geometry import Outgoing
from .types import GRID

Encode = Callable[[str, Any], bytes]
"""Makes of a message of a type what is published."""

MOST_KEPT = 4
"""grids: those of large sites differ from robot to robot, those of others do not."""


class Grids:
    """Makes grids of robot maps, one at a time and beside the loop: a map of 200 m takes a second."""

    def __init__(self, encode: Encode, outgoing: Outgoing, resolution: float) -> None:
        self._encode = encode
        self._outgoing = outgoing
        self._resolution = resolution
        self._making = asyncio.Lock()
        self._kept: OrderedDict[bytes, bytes] = OrderedDict()

    async def of(self, robot_map: bytes) -> bytes:
        """Return the message of a robot map, encoded; raises CommandRefusedError where it cannot be made."""
        key = hashlib.sha256(robot_map).digest()
        async with self._making:
            if key not in self._kept:
                try:
                    self._kept[key] = await asyncio.to_thread(self._make, robot_map)
                except (RobotMapError, GridError, ValueError) as error:
                    raise CommandRefusedError(f"the map cannot be made an OccupancyGrid: {error}") from None
                while len(self._kept) > MOST_KEPT:
                    self._kept.popitem(last=False)
            self._kept.move_to_end(key)
            return self._kept[key]

    def _make(self, robot_map: bytes) -> bytes:
        return self._encode(GRID, self._outgoing.grid(robot_map, self._resolution))
