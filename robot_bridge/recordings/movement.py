"""Headings and speeds from movement, for recordings that do not tell them; no I/O."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
import numpy.typing as npt

Column = npt.NDArray[np.float64]

MEASURED, COURSE, LAST, UNKNOWN = range(4)
ORIGINS: tuple[Literal["course", "last", "unknown"] | None, ...] = (None, "course", "last", "unknown")
"""What ``theta_from`` of a position says, by these numbers."""
LEAST_MOVE = 0.5
"""metres below which a move tells no course."""
STANDS_AFTER = 2.0
"""seconds without such a move after which a robot counts as standing."""
EARTH = 6_371_008.8
"""metres, the mean radius."""


def filled(
    t: Column, x: Column, y: Column, theta: Column, v: Column, *, is_earth: bool
) -> tuple[Column, npt.NDArray[np.int8], Column]:
    """Return headings, where each is from, and speeds, with nothing left that is not known.

    A heading that was not recorded is the course over ground, while the robot stands the last one; before
    either is known it is 0. A speed that was not recorded is that over ground.
    """
    origins = np.zeros(len(t), dtype=np.int8)
    if not (np.isnan(theta).any() or np.isnan(v).any()):
        return theta, origins, v
    theta, v = theta.copy(), v.copy()
    east, north = _metres(x, y) if is_earth else (x, y)
    last_x, last_y, last_t = float(east[0]), float(north[0]), float(t[0])
    known, speed, course = math.nan, 0.0, math.nan
    for n, (at, px, py) in enumerate(zip(t.tolist(), east.tolist(), north.tolist(), strict=True)):
        move = math.hypot(px - last_x, py - last_y)
        if move > LEAST_MOVE:
            speed, course = move / (at - last_t), math.atan2(py - last_y, px - last_x)
            last_x, last_y, last_t = px, py, at
        elif at - last_t > STANDS_AFTER:
            speed = 0.0
        if not math.isnan(theta[n]):
            known = theta[n]
        elif speed > 0 and not math.isnan(course):
            theta[n] = known = course
            origins[n] = COURSE
        elif not math.isnan(known):
            theta[n], origins[n] = known, LAST
        else:
            theta[n], origins[n] = 0.0, UNKNOWN
        if math.isnan(v[n]):
            v[n] = speed
    return theta, origins, v


def _metres(lon: Column, lat: Column) -> tuple[Column, Column]:
    """Return metres east and north of the first place; near enough for moves of some metres."""
    scale = EARTH * math.pi / 180.0
    return (lon - lon[0]) * scale * np.cos(np.radians(lat)), (lat - lat[0]) * scale
