"""The zone that a partial map covers (paper 1, section III.B: H x W around the robot)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .errors import WindowError
from .model import Border

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
        """Its rectangle, in whole centimetres, as a map says it."""
        return Border(
            round(self.x - self.width / 2, 2),
            round(self.y - self.height / 2, 2),
            round(self.x + self.width / 2, 2),
            round(self.y + self.height / 2, 2),
        )
