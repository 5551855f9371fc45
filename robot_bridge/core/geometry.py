"""Headings and angles, polylines with stations along them, and pairs of nearby places."""

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


# --- Polylines with stations: shared by driving a path and by judging it ---

Track = Sequence[tuple[float, float]]
"""One point is a place, several form a path; metres in the site frame."""


class Polyline:
    """A line through n ≥ 1 points, (x, y) in metres; a station is metres along it from its beginning."""

    def __init__(self, points: Sequence[tuple[float, float]]) -> None:
        self._points = np.asarray(points, dtype=np.float64)
        self._start, self._step = self._points[:-1], np.diff(self._points, axis=0)
        # Two equal points in a row make a step of length 0, by which one cannot divide.
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
        """Return the turn in radians at each of the n points, 0 at the ends.

        It is the angle between the direction from ``reach`` metres before the point and the one to as far
        behind it.
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


# --- Pairs of nearby places among thousands ---

Ints = npt.NDArray[np.int64]
_ROW = np.int64(2**32)
"""Difference between the number of a cell and of the one above it; the cell beside it has the next number."""
_LARGEST = 2**30
"""Largest distance from the origin in cells; no place is reported further away."""


def close_pairs(xy: Floats, reach: float) -> tuple[Ints, Ints, Floats]:
    """Return all pairs i < j of (n, 2) finite places at most ``reach`` apart, and how far apart they are."""
    nothing = np.empty(0, np.int64)
    if len(xy) < 2 or reach <= 0:
        return nothing, nothing, np.empty(0)
    number = _cells(xy, reach)
    order = np.argsort(number, kind="stable")
    ranked = number[order]
    # Adjacent cells have adjacent numbers. Half of a cell's neighbours are enough: the other half finds the
    # same pairs from the other side.
    beside = np.arange(1, len(order) + 1), np.searchsorted(ranked, ranked + 1, side="right")
    above = (
        np.searchsorted(ranked, ranked + _ROW - 1, side="left"),
        np.searchsorted(ranked, ranked + _ROW + 1, side="right"),
    )
    found = [_pairs(begin, end) for begin, end in (beside, above)]
    one = order[np.concatenate([pair[0] for pair in found])]
    other = order[np.concatenate([pair[1] for pair in found])]
    apart = np.hypot(*(xy[one] - xy[other]).T)
    near = apart <= reach
    one, other, apart = one[near], other[near], apart[near]
    return np.minimum(one, other), np.maximum(one, other), apart


def pairs_between(ones: Floats, others: Floats, reach: float) -> tuple[Ints, Ints, Floats]:
    """Return the rows of (n, 2) ``ones`` and (m, 2) ``others`` at most ``reach`` apart, and how far apart."""
    cells = _cells(others, reach)
    order = np.argsort(cells, kind="stable")
    ranked = cells[order]
    cells = _cells(ones, reach)
    found = [
        _pairs(np.searchsorted(ranked, row - 1, side="left"), np.searchsorted(ranked, row + 1, side="right"))
        for row in (cells - _ROW, cells, cells + _ROW)
    ]
    one = np.concatenate([pair[0] for pair in found])
    other = order[np.concatenate([pair[1] for pair in found])]
    apart = np.hypot(*(ones[one] - others[other]).T)
    near = apart <= reach
    return one[near], other[near], apart[near]


def _cells(xy: Floats, reach: float) -> Ints:
    """Return the number of the cell that each place is in; adjacent cells have adjacent numbers."""
    cell: Ints = np.clip(np.floor(xy / reach), -_LARGEST, _LARGEST).astype(np.int64)
    number: Ints = cell[:, 1] * _ROW + cell[:, 0]
    return number


def _pairs(begin: Ints, end: Ints) -> tuple[Ints, Ints]:
    """Return k and every number from begin[k] to before end[k], for each k."""
    count = end - begin
    one = np.repeat(np.arange(len(begin)), count)
    first = np.repeat(begin - (np.cumsum(count) - count), count)
    return one, first + np.arange(len(one))
