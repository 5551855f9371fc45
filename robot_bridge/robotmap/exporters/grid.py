"""The cells of a grid: where they are, and how many there may be."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..model import Border
from .errors import GridError

LARGEST_GRID = 64_000_000
"""cells that a grid may have unless told otherwise: 400 m x 400 m at 5 cm, about 64 MB for a robot."""

_WHOLE = 1e-6
"""cells; a border this much wider than a whole number of cells has no further cell."""


@dataclass(frozen=True)
class Grid:
    """Square cells of ``resolution`` metres; (x_min, y_min) is the lower left corner of cell (0, 0).

    Row 0 is the lowest, as in a ROS OccupancyGrid; images, whose first row is the highest, are turned round
    where they are written.
    """

    x_min: float
    y_min: float
    resolution: float
    columns: int
    rows: int

    @classmethod
    def covering(cls, border: Border, resolution: float, limit: int = LARGEST_GRID) -> Grid:
        """Return the grid that covers ``border``, its origin in the border's lower left corner.

        Raises GridError when the resolution is no length or there would be more than ``limit`` cells.
        """
        if not math.isfinite(resolution) or resolution <= 0:
            raise GridError(
                f"resolution: {resolution} m is no side of a cell; give one above 0, such as 0.05"
            )
        width, height = border.x_max - border.x_min, border.y_max - border.y_min
        columns = max(1, math.ceil(width / resolution - _WHOLE))
        rows = max(1, math.ceil(height / resolution - _WHOLE))
        if columns * rows > limit:
            coarse = _rounded_up(math.sqrt(width * height / limit))
            raise GridError(
                f"resolution: {width:g} m x {height:g} m at {resolution:g} m are {columns} x {rows} = "
                f"{columns * rows / 1e6:.1f} million cells, the limit is {limit / 1e6:g} million; choose "
                f"{coarse:g} m or coarser, or a smaller window"
            )
        return cls(border.x_min, border.y_min, resolution, columns, rows)


def _rounded_up(length: float) -> float:
    """Return ``length`` in metres, rounded up to two digits."""
    step = 10.0 ** (math.floor(math.log10(length)) - 1)
    return round(math.ceil(length / step + 1e-9) * step, 12)
