"""What a site has besides obstacles, as plain arrays in the site frame."""

from __future__ import annotations

from dataclasses import dataclass

from ..roads.centrelines import DEFAULT_SPEED
from .frame import Points


@dataclass(frozen=True)
class Centreline:
    """The middle of one road: ``points`` is (n, 2), metres in the site frame, as it was digitised.

    ``direction`` is 1 for one way along the line, -1 against it, and 0 for both; ``level`` is 0 on the
    ground, above it on bridges.
    """

    points: Points
    width_m: float
    surface: str
    direction: int = 0
    speed_ms: float = DEFAULT_SPEED
    closed: bool = False
    level: int = 0


@dataclass(frozen=True)
class Area:
    """One polygon, such as a keepout, whose label is its name.

    ``rings`` holds the outer ring and then its holes, each (n, 2), metres in the site frame, closed.
    """

    rings: tuple[Points, ...]
    label: str
