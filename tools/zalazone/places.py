"""Where what happens on the proving ground, and how people of three reference systems write one place."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robot_bridge.core.sites.frame import SiteFrame, projections
from tests.support.errors import StageError

Place = tuple[float, float]
CONE: Place = (98.0, 262.0)
"""On the large round platform; this and all below in metres of the site frame."""
AWAY: Place = (84.0, 272.0)
"""Where the first robot starts, and waits between two cones."""
START: Place = (121.0, 205.0)
GOAL: Place = (266.0, 165.0)
"""Of the second robot: the one end of the handling course and the other."""
GRASS: Place = (205.0, 150.0)
ROAD_CLASS = "asphalt"
LARGEST_SPREAD_M = 0.02


@dataclass(frozen=True)
class Spelling:
    """One place as it is typed in a reference system, and the same as numbers, x (longitude) first."""

    crs: str
    called: str
    text: str
    x: float
    y: float


def spellings(frame: SiteFrame, place: Place) -> list[Spelling]:
    """Return ``place`` in WGS 84, UTM 33N and EOV, rounded as people write it: to a centimetre or less."""
    return [
        _spelled(frame, place, "EPSG:4326", "WGS 84", 8),
        _spelled(frame, place, "EPSG:32633", "UTM 33N", 2),
        _spelled(frame, place, "EPSG:23700", "EOV", 2),
    ]


def _spelled(frame: SiteFrame, place: Place, crs: str, called: str, digits: int) -> Spelling:
    ((east, north),) = frame.to_crs(np.array([place]))
    transformer = projections().Transformer.from_crs(frame.crs, crs, always_xy=True)
    x, y = (round(float(number), digits) for number in transformer.transform(east, north))
    first, second = (y, x) if crs == "EPSG:4326" else (x, y)
    if not np.isfinite([x, y]).all():
        raise StageError(f"{place} cannot be expressed in {crs}")
    return Spelling(crs, called, f"{first:.{digits}f}, {second:.{digits}f}", x, y)


def same_ground(
    sent: Sequence[Place], placed: Sequence[Place], point: Place, count: int = 3
) -> tuple[float, float, float]:
    """Return how far the targets are apart, the cones, and the cones from ``point`` at most; all metres.

    :raises StageError: when there are not ``count`` cones, or it is not one place.
    """
    if len(placed) != count:
        raise StageError(f"the robot itself says that it has placed {len(placed)} cones there, not {count}")
    apart, stood = (max(math.dist(a, b) for a in places for b in places) for places in (sent, placed))
    off = max(math.dist(place, point) for place in placed)
    if max(apart, stood, off) > LARGEST_SPREAD_M:
        raise StageError(
            f"the targets are {apart:.3f} m apart, the cones {stood:.3f} m, and up to {off:.3f} m from where "
            f"they should be; {LARGEST_SPREAD_M} m is the most"
        )
    return apart, stood, off
