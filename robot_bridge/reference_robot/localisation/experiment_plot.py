"""A drive on its map in the paper's style (paper 1, Fig. 7): odometry alone in red, the filter in blue."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any
from xml.sax.saxutils import escape  # nosec B406 # writes XML, reads none

import numpy as np
from numpy.typing import NDArray

from ...core.robotmap.model import RobotMap
from .experiment import Record
from .world import Walls, walls_of

MARGIN = 8.0
"""metres around the drawing."""
SCALE = 12.0
"""pixels per metre of a small drive; a large one is scaled to fit."""
LARGEST = 1200.0
"""pixels of the longer side."""
_HEAD = 56.0

_LINES = (
    ("truth", "#222222", 3.0, "what is true"),
    ("odometry", "#d62728", 1.6, "odometry alone"),
    ("belief", "#1f5fd6", 1.6, "particle filter"),
)


def svg_of(robot_map: RobotMap, record: Record, title: str, laser_height: float) -> str:
    """Return an SVG of one drive; obstacles that the laser at ``laser_height`` sees are drawn dark."""
    # Odometry may lead anywhere: the extent of the truth with an equal margin is shown.
    places = np.concatenate([record.truth[:, :2], record.belief[~record.lost][:, :2]])
    low, high = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    scale = min(SCALE, LARGEST / float((high - low).max()))
    width, height = (high - low) * scale
    walls = walls_of(robot_map)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height + _HEAD:.0f}" '
        f'viewBox="0 {-_HEAD:.0f} {width:.0f} {height + _HEAD:.0f}" font-family="sans-serif">',
        f'<rect y="{-_HEAD:.0f}" width="100%" height="100%" fill="white"/>',
        f'<svg width="{width:.0f}" height="{height:.0f}">',
        _walls(walls, walls.height <= laser_height, "#cccccc", low, high, scale),
        _walls(walls, walls.height > laser_height, "#555555", low, high, scale),
    ]
    for name, colour, thick, _ in _LINES:
        poses = getattr(record, name)
        parts += _drive(_pixels(poses[:, :2], low, high, scale), record, colour, thick)
    parts += ["</svg>", _legend(title), "</svg>"]
    return "\n".join(parts) + "\n"


def _pixels(points: NDArray[Any], low: NDArray[Any], high: NDArray[Any], scale: float) -> NDArray[Any]:
    pixels: NDArray[Any] = (points - (low[0], high[1])) * (scale, -scale)
    return pixels


def _walls(
    walls: Walls, some: NDArray[Any], colour: str, low: NDArray[Any], high: NDArray[Any], scale: float
) -> str:
    near = some & (np.maximum(walls.a, walls.b) >= low).all(axis=1)
    near &= (np.minimum(walls.a, walls.b) <= high).all(axis=1)
    ends = np.hstack([_pixels(end[near], low, high, scale) for end in (walls.a, walls.b)])
    way = "".join(f"M{ax:.1f} {ay:.1f}L{bx:.1f} {by:.1f}" for ax, ay, bx, by in ends)
    return f'<path d="{way}" stroke="{colour}" stroke-width="1" fill="none"/>'


def _drive(pixels: NDArray[Any], record: Record, colour: str, thick: float) -> Sequence[str]:
    """Return the line of a drive, in two where the robot was carried."""
    cuts = [0, *([] if record.carried is None else [record.carried]), len(pixels)]
    pieces = [pixels[begin:end] for begin, end in pairwise(cuts)]
    return [
        f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in piece)}" fill="none" '
        f'stroke="{colour}" stroke-width="{thick}" stroke-linejoin="round"/>'
        for piece in pieces
    ]


def _legend(title: str) -> str:
    # On white: not every program cuts the map off at its frame.
    parts = [
        f'<rect y="{-_HEAD:.0f}" width="100%" height="{_HEAD:.0f}" fill="white"/>',
        f'<text x="8" y="-36" font-size="16" fill="#222222">{escape(title)}</text>',
    ]
    x = 8.0
    for _, colour, thick, words in _LINES:
        parts.append(
            f'<line x1="{x}" x2="{x + 24}" y1="-14" y2="-14" stroke="{colour}" stroke-width="{thick + 1}"/>'
            f'<text x="{x + 30}" y="-9" font-size="13" fill="#222222">{words}</text>'
        )
        x += 48 + 7.5 * len(words)
    return "\n".join(parts)
