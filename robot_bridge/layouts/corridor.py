"""A corridor of cones of any length, straight in its own frame; along a line it follows the line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .cone import BLUE, YELLOW, Spot
from .layout import Layout, dimension
from .rows import lane, spaced


@dataclass(frozen=True)
class Corridor(Layout):
    """Pairs of cones, blue left and yellow right. The origin is the middle of the first pair.

    Colours, 3 m of width and 5 m from pair to pair are those of Formula Student's acceleration.
    """

    NAME: ClassVar[str] = "corridor"
    TITLE: ClassVar[str] = "Corridor"
    STANDARD: ClassVar[str] = "no standard: colours, width and spacing of Formula Student"

    length: float = dimension(50, "Length of the corridor", least=0.1)
    width: float = dimension(3, "Clear width of the corridor", least=0.1)
    spacing: float = dimension(5, "From pair to pair", least=0.5)

    def spots(self) -> list[Spot]:
        places = spaced(0.0, self.length, self.spacing)
        return lane(places, -self.width / 2, self.width, self.cone_base, "", (BLUE, YELLOW))
