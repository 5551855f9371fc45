"""What a site has besides obstacles, as plain arrays in the site frame."""

from __future__ import annotations

from dataclasses import dataclass

from .frame import Points


@dataclass(frozen=True)
class Centreline:
    """The middle of one road: ``points`` is (n, 2), metres in the site frame, as it was digitised."""

    points: Points
    width_m: float
    surface: str


@dataclass(frozen=True)
class Area:
    """One polygon: a road surface, whose label is its class, or a keepout, whose label is its name.

    ``rings`` holds the outer ring and then its holes, each (n, 2), metres in the site frame, closed.
    """

    rings: tuple[Points, ...]
    label: str
