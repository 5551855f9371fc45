"""Headings, degrees clockwise from north, and theta, radians counter-clockwise from the x axis (east)."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def theta_of(heading: float) -> float:
    """Return the theta of a heading."""
    return math.radians(90.0 - heading)


def heading_of(theta: float) -> float:
    """Return the heading of a theta, 0 up to 360."""
    return (90.0 - math.degrees(theta)) % 360.0


def headings_of(theta: Floats) -> Floats:
    """Return the headings of many thetas, NaN where theta is."""
    headings: Floats = np.mod(90.0 - np.degrees(theta), 360.0)
    return headings
