"""From a layout's own frame to the site: at a pose, or along a line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .cone import Cone
from .errors import LineError

Floats = NDArray[np.float64]


def placed(cones: Sequence[Cone], x: float, y: float, theta: float) -> list[Cone]:
    """Return ``cones`` with their frame's origin at (x, y), in metres, and its x axis turned to ``theta``."""
    cos, sin = math.cos(theta), math.sin(theta)
    return [
        replace(
            cone,
            x=x + cone.x * cos - cone.y * sin,
            y=y + cone.x * sin + cone.y * cos,
            theta=math.remainder(cone.theta + theta, 2 * math.pi),
        )
        for cone in cones
    ]


def along(cones: Sequence[Cone], line: Floats, start: float = 0.0) -> list[Cone]:
    """Return ``cones`` bent along ``line``, (n, 2) metres: x becomes metres along it, y metres to its left.

    The layout's origin comes ``start`` metres after the line's beginning. Thetas follow the line.

    :raises LineError: when the line has no length or is too short; it says how much is missing.
    """
    points = _cleaned(line)
    steps = np.diff(points, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    at = np.concatenate([[0.0], np.cumsum(lengths)])
    places = np.array([cone.x for cone in cones]) + start
    _check_length(places, float(at[-1]))
    edge = np.clip(np.searchsorted(at, places, side="right") - 1, 0, len(steps) - 1)
    unit = steps[edge] / lengths[edge, None]
    # A cone at a corner stands on the bisector, or rows would cross or gape there.
    normal = _normals(steps / lengths[:, None], edge, places, at)
    middle = points[edge] + unit * (places - at[edge])[:, None]
    aside = np.array([cone.y for cone in cones])[:, None]
    xy = middle + normal * aside
    theta = np.arctan2(-normal[:, 0], normal[:, 1])
    return [
        replace(cone, x=float(x), y=float(y), theta=math.remainder(cone.theta + float(turn), 2 * math.pi))
        for cone, (x, y), turn in zip(cones, xy, theta, strict=True)
    ]


def _cleaned(line: Floats) -> Floats:
    """Return ``line`` without points that repeat."""
    points = np.asarray(line, dtype=np.float64)
    if points.ndim != 2 or points.shape[1:] != (2,) or not np.isfinite(points).all():
        raise LineError("The line is none: give two points (x, y) or more, in metres.")
    kept: Floats = points[np.concatenate([[True], (np.diff(points, axis=0) != 0).any(axis=1)])]
    if len(kept) < 2:
        raise LineError("The line has no length: give two points (x, y) or more that differ.")
    return kept


def _check_length(places: Floats, length: float) -> None:
    if len(places) and places.min() < -1e-6:
        raise LineError(
            f"The layout begins {-places.min():.2f} m before the line: start at least so much further on."
        )
    if len(places) and places.max() > length + 1e-6:
        raise LineError(
            f"The line is {length:.2f} m long and the layout reaches to {places.max():.2f} m: take a longer "
            "line, begin earlier, or make the layout shorter."
        )


def _normals(units: Floats, edge: NDArray[np.int64], places: Floats, at: Floats) -> Floats:
    """Return the unit normals to the left, (n, 2), at ``places``; at a corner that of the bisector."""
    corner = np.isclose(places, at[edge], rtol=0, atol=1e-9) & (edge > 0)
    along = units[edge] + np.where(corner[:, None], units[edge - 1], 0.0)
    size = np.hypot(along[:, 0], along[:, 1])[:, None]
    along = np.where(size > 1e-9, along / np.maximum(size, 1e-9), units[edge])
    return np.stack([-along[:, 1], along[:, 0]], axis=1)
