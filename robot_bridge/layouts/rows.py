"""Rows of cones on both sides of a lane."""

from __future__ import annotations

import numpy as np

from .cone import ORANGE, Spot


def lane(
    along: list[float],
    right: float,
    width: float,
    base: float,
    role: str,
    colours: tuple[str, str] = (ORANGE, ORANGE),
) -> list[Spot]:
    """Return a cone left and one right at each x of ``along``, outside a lane and touching its limits.

    ``right`` is the y of the right limit; ``colours`` are those of left and right.
    """
    left_colour, right_colour = colours
    return [
        spot
        for x in along
        for spot in (
            Spot(x, right + width + base / 2, 0.0, left_colour, f"{role} left".strip()),
            Spot(x, right - base / 2, 0.0, right_colour, f"{role} right".strip()),
        )
    ]


def spaced(start: float, length: float, spacing: float) -> list[float]:
    """Return x from ``start`` to ``start + length``, evenly, as near to ``spacing`` apart as that allows."""
    return [float(x) for x in np.linspace(start, start + length, max(1, round(length / spacing)) + 1)]


def across(x: float, right: float, width: float, count: int, role: str) -> list[Spot]:
    """Return ``count`` orange cones between the limits of a lane, which they close at ``x``."""
    steps = np.arange(1, count + 1) / (count + 1)
    return [Spot(x, float(right + width * step), 0.0, ORANGE, role) for step in steps]


def mirrored(spots: list[Spot]) -> list[Spot]:
    """Return ``spots`` with left and right exchanged, roles too."""
    other = {"left": "right", "right": "left"}
    return [
        Spot(s.x, -s.y, -s.theta, s.colour, " ".join(other.get(word, word) for word in s.role.split()))
        for s in spots
    ]
