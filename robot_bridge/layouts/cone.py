"""One cone of a layout."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

ORANGE, BIG_ORANGE, BLUE, YELLOW = "orange", "big_orange", "blue", "yellow"
COLOURS = (ORANGE, BIG_ORANGE, BLUE, YELLOW)
"""The cones of Formula Student: blue on the left of the track, yellow on its right, orange where one goes in
and out, big orange at lines where time is taken."""


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
    """A spot with a name and a place in the order of placing, from 1."""

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
