"""Headings and angles, and polylines measured along themselves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray

# --- Headings, degrees clockwise from north, and theta, radians counter-clockwise from the x axis (east)

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


# --- A line through points, measured along itself: what both who drives a path and who judges it need ---

Track = Sequence[tuple[float, float]]
"""One point is a place, several are a path; metres in the site frame."""


class Polyline:
    """A line through n ≥ 1 points, (x, y) in metres; a station is metres along it from its beginning."""

    def __init__(self, points: Sequence[tuple[float, float]]) -> None:
        self._points = np.asarray(points, dtype=np.float64)
        self._start, self._step = self._points[:-1], np.diff(self._points, axis=0)
        # Two equal points in a row make a step of no length, which cannot be divided by.
        self._length = np.maximum(np.hypot(*self._step.T), 1e-9)
        self._stations = np.concatenate([[0.0], np.cumsum(np.hypot(*self._step.T))])

    @property
    def length(self) -> float:
        """Metres from the first point to the last, along the line."""
        return float(self._stations[-1])

    @property
    def stations(self) -> list[float]:
        """The station of each of the n points."""
        return [float(station) for station in self._stations]

    @property
    def end(self) -> tuple[float, float]:
        """The last point."""
        return float(self._points[-1, 0]), float(self._points[-1, 1])

    def feet(self, x: float, y: float) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return, of the nearest point to (x, y) on each of the n - 1 steps, the station and the distance."""
        to_x, to_y = x - self._start[:, 0], y - self._start[:, 1]
        along = (to_x * self._step[:, 0] + to_y * self._step[:, 1]) / self._length**2
        along = np.minimum(np.maximum(along, 0.0), 1.0)
        foot = self._start + along[:, None] * self._step
        off = np.hypot(foot[:, 0] - x, foot[:, 1] - y)
        return self._stations[:-1] + along * self._length, off

    def beyond(self, station: float) -> NDArray[np.float64]:
        """Return the points that come after ``station``, (m, 2)."""
        return self._points[np.searchsorted(self._stations, station, side="right") :]

    def turns(self, reach: float) -> NDArray[np.float64]:
        """Return by how many radians the line turns at each of its n points, 0 at its ends.

        It is the angle between the ways from ``reach`` metres before the point, and to as far behind it.
        """
        before, after = (np.column_stack(self._along(self._stations + step)) for step in (-reach, reach))
        came, goes = self._points - before, after - self._points
        turned = np.arctan2(*goes.T[::-1]) - np.arctan2(*came.T[::-1])
        still = (np.hypot(*came.T) < 1e-9) | (np.hypot(*goes.T) < 1e-9)
        return np.where(still, 0.0, np.abs(np.remainder(turned + np.pi, 2 * np.pi) - np.pi))

    def at(self, station: float) -> tuple[float, float]:
        """Return the point at ``station``; before the beginning the first, beyond the end the last."""
        x, y = self._along(station)
        return float(x), float(y)

    def _along(self, stations: float | NDArray[np.float64]) -> tuple[Any, Any]:
        """Return x and y at one or many stations."""
        x, y = (np.interp(stations, self._stations, column) for column in self._points.T)
        return x, y
