"""How a robot comes from where it is onto its route, and from the route to its goal."""

from __future__ import annotations

import math

import numpy as np

from .centrelines import Floats
from .route import Route, stretch

Place = tuple[float, float]


def with_ends(route: Route, start: Place, goal: Place, turning_radius: float) -> tuple[Floats, Floats]:
    """Return the points from ``start`` to ``goal`` and the width of road along each piece.

    Who stands beside the middle of a road joins it aslant, not square: so far ahead that an arc of
    ``turning_radius`` metres has room.
    """
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route.points, axis=0).T))])
    half = (route.widths[0] / 2, route.widths[-1] / 2)
    ahead, behind = (
        min(max(off, math.sqrt(turning_radius * off)), route.metres / 3) if off <= wide else 0.0
        for off, wide in zip((route.off_start, route.off_goal), half, strict=True)
    )
    middle = stretch(route.points, ahead, route.metres - behind)
    points = np.concatenate([[start], middle, [goal]])
    along = ahead + np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(middle, axis=0).T))])
    piece = np.searchsorted(stations, (along[1:] + along[:-1]) / 2, side="right") - 1
    inner = route.widths[np.clip(piece, 0, len(route.widths) - 1)]
    widths = np.concatenate([route.widths[:1], inner, route.widths[-1:]])
    moves = np.hypot(*np.diff(points, axis=0).T) > math.ulp(1e6)
    moves[-1:] |= not moves.any()
    return np.concatenate([points[:1], points[1:][moves]]), widths[moves]
