"""Round things as chords, and the normals of ramps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import ShapingError

SAGITTA = 0.02
"""metres; how far a chord may be from its curve (design, section 6)."""


def arc(
    start: NDArray[Any], through: NDArray[Any], end: NDArray[Any], sagitta: float = SAGITTA
) -> NDArray[Any]:
    """Return points, (n, 2), on the circle's arc from ``start`` by way of ``through`` to ``end``.

    No chord is farther than ``sagitta`` metres from the arc. Three points on a line are that line; an ``end``
    that is ``start`` makes the full circle whose diameter goes to ``through``.
    """
    start, through, end = (np.asarray(p, dtype=np.float64) for p in (start, through, end))
    _check(np.concatenate([start, through, end]), sagitta)
    whole = bool((start == end).all())
    centre = (start + through) / 2 if whole else _centre(start, through, end)
    if centre is None:
        return np.array([start, end])
    radius = float(np.hypot(*(start - centre)))
    first, middle, last = (math.atan2(*(p - centre)[::-1]) for p in (start, through, end))
    turn = math.tau if whole else (last - first) % math.tau
    if not whole and (middle - first) % math.tau > turn:
        turn -= math.tau
    count = max(1, math.ceil(abs(turn) / _widest_angle(radius, sagitta)))
    angles = first + turn * np.arange(count + 1) / count
    points = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    points[0], points[-1] = start, end
    return points


def ramp_normal(points: NDArray[Any]) -> str:
    """Return the upward unit normal of a ramp's surface for the extra ``n``, such as ``0,-0.0995,0.995``.

    ``points`` is its outline, (n, 3) metres, not necessarily quite flat (Newell's method, Sutherland et al.
    1974). Raises ShapingError for points that span no surface, or an upright one.
    """
    points = np.asarray(points, dtype=np.float64)
    _check(points.ravel(), SAGITTA)
    around_ = np.roll(points, -1, axis=0)
    x, y, z = np.cross(points - points[0], around_ - points[0]).sum(axis=0)
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0 or abs(z) < 1e-3 * length:
        raise ShapingError(
            "a ramp whose points span no surface that one can drive on has no normal; correct it"
        )
    # Adding 0 makes 0 of -0.
    return ",".join(f"{round(v / math.copysign(length, z), 4) + 0.0:g}" for v in (x, y, z))


def _check(numbers: NDArray[Any], sagitta: float) -> None:
    if not np.isfinite(numbers).all() or not 0 < sagitta < math.inf:
        raise ShapingError("a curve needs finite coordinates and a sagitta above 0 m; correct them")


def _widest_angle(radius: float, sagitta: float) -> float:
    """Return the angle of the longest chord within ``sagitta`` of its arc, at most a third of a turn."""
    return min(2 * math.acos(max(1 - sagitta / radius, 0.5)), math.tau / 3)


def _centre(a: NDArray[Any], b: NDArray[Any], c: NDArray[Any]) -> NDArray[Any] | None:
    """Return the centre of the circle through three points, or nothing where they lie on a line."""
    (bx, by), (cx, cy) = b - a, c - a
    twice = 2 * (bx * cy - by * cx)
    if abs(twice) < 1e-9 * (bx * bx + by * by + cx * cx + cy * cy):
        return None
    b2, c2 = bx * bx + by * by, cx * cx + cy * cy
    centre: NDArray[Any] = a + np.array([cy * b2 - by * c2, bx * c2 - cx * b2]) / twice
    return centre
