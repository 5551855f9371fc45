"""What obstacles enclose: rings as they are, and rings that the map's border cut, closed along the border."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import CUT, Border, Obstacle, RobotMap, ShapeType
from .lines import Points, is_ring, lines_of, treads_of

_WHOLE = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE)
_CUT = (ShapeType.OPEN_POLYGON, ShapeType.OPEN_CURVE)
_ON_BORDER = 0.006
"""metres; cuts are written in centimetres."""


@dataclass(frozen=True)
class Solid:
    """One ring, (n, 2) metres in the site frame: counter-clockwise round an obstacle, clockwise a courtyard.

    ``obstacle`` is one that it belongs to. ``cut`` tells that parts of it are the border's and no walls.
    """

    ring: Points
    obstacle: Obstacle
    cut: bool = False


def solids_of(robot_map: RobotMap) -> tuple[list[Solid], list[str]]:
    """Return the rings of a map, and a warning for each obstacle that should be one and is not.

    A ring that the border cut is written as open chains, as a wall is, and marked by the extra ``cut``;
    chains of one source belong together. A map without extras cannot say it, for which there is a warning
    where it matters. Ramps are driven on and enclose nothing.
    """
    solids, warnings = [], []
    for obstacle in robot_map.obstacles:
        if obstacle.shape_type is ShapeType.STAIRS:
            solids += [Solid(ring, obstacle) for ring in treads_of(obstacle)]
        if obstacle.shape_type not in _WHOLE:
            continue
        lines = lines_of(obstacle)
        if lines and all(is_ring(line) for line in lines):
            solids += [Solid(line, obstacle) for line in lines]
        else:
            warnings.append(
                f"obstacle {obstacle.id} is a closed {_name(obstacle)} and its segments do not close: only "
                "they are drawn; export the map once more"
            )
    if not any(obstacle.ext for obstacle in robot_map.obstacles):
        warnings += _unmarked(robot_map, {first_label(solid.obstacle) for solid in solids})
    for group in _cut_groups(robot_map).values():
        rings = _closed_along(robot_map.border, group)
        solids += rings
        if not rings:
            warnings.append(_unclosed(group))
    return solids, warnings


def edges_of(rings: Sequence[Points]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the segments a→b, (n, 2) each, of all rings."""
    if not rings:
        return np.empty((0, 2)), np.empty((0, 2))
    return np.concatenate([ring[:-1] for ring in rings]), np.concatenate([ring[1:] for ring in rings])


def first_label(obstacle: Obstacle) -> str:
    """Return the first word of an obstacle's semantics, which says what kind of thing it is."""
    return obstacle.semantics.partition(",")[0]


Chain = tuple[Points, Obstacle]


def _cut_groups(robot_map: RobotMap) -> dict[tuple[str, str], list[Chain]]:
    """Return the chains that are parts of cut rings, by label and source."""
    groups: dict[tuple[str, str], list[Chain]] = defaultdict(list)
    for obstacle in robot_map.obstacles:
        if obstacle.shape_type in _CUT and obstacle.ext.get(CUT) == "1":
            key = (first_label(obstacle), obstacle.ext.get("src", ""))
            groups[key] += [(line, obstacle) for line in lines_of(obstacle)]
    return groups


def _unmarked(robot_map: RobotMap, labels: set[str]) -> list[str]:
    """Return a warning when chains look as if they were parts of cut rings with one of ``labels``."""
    alike = [
        obstacle.id
        for obstacle in robot_map.obstacles
        if obstacle.shape_type in _CUT
        and first_label(obstacle) in labels
        and all(_on_border(robot_map.border, line[[0, -1]]).all() for line in lines_of(obstacle))
    ]
    if not alike:
        return []
    return [
        f"{len(alike)} obstacles, {alike[0]} the first, may be parts of rings that the border cut; a map "
        "without extras does not say so and their inside is written as free; export the map with extras"
    ]


def _closed_along(border: Border, chains: list[Chain]) -> list[Solid]:
    """Return the rings that chains form with the border between them; none when they do not fit together.

    From the end of each chain the border is followed counter-clockwise to the next beginning (Weiler and
    Atherton's clipping, 1977): an outline has its inside on the left.
    """
    if not all(_on_border(border, line[[0, -1]]).all() for line, _ in chains):
        return []
    round_trip = 2 * (border.x_max - border.x_min) + 2 * (border.y_max - border.y_min)
    starts = np.array([_along(border, line[0]) for line, _ in chains])
    ends = np.array([_along(border, line[-1]) for line, _ in chains])
    following = [int(np.argmin((starts - end) % round_trip)) for end in ends]
    if sorted(following) != list(range(len(chains))):
        return []
    solids, left = [], set(range(len(chains)))
    while left:
        first = current = min(left)
        points: list[Points] = []
        while current in left:
            left.remove(current)
            points += [chains[current][0], _corners(border, ends[current], starts[following[current]])]
            current = following[current]
        ring = np.concatenate([*points, chains[first][0][:1]])
        solids.append(Solid(ring, chains[first][1], cut=True))
    return solids


def _on_border(border: Border, points: Points) -> NDArray[Any]:
    low, high = np.array([border.x_min, border.y_min]), np.array([border.x_max, border.y_max])
    near: NDArray[Any] = (np.minimum(np.abs(points - low), np.abs(points - high)) < _ON_BORDER).any(axis=1)
    return near


def _along(border: Border, point: Points) -> float:
    """Return how far a point on the border is from its lower left corner, counter-clockwise, metres."""
    x, y = float(point[0]), float(point[1])
    width, height = border.x_max - border.x_min, border.y_max - border.y_min
    sides = (
        (abs(y - border.y_min), x - border.x_min),
        (abs(x - border.x_max), width + y - border.y_min),
        (abs(y - border.y_max), width + height + border.x_max - x),
        (abs(x - border.x_min), 2 * width + height + border.y_max - y),
    )
    # In millimetres, so that two ends in one place are in one place.
    return round(min(sides)[1], 3) % (2 * width + 2 * height)


def _corners(border: Border, start: float, end: float) -> Points:
    """Return the border's corners, (k, 2), between two places on it, counter-clockwise."""
    return np.array(list(_corners_after(border, start, end)), dtype=float).reshape(-1, 2)


def _corners_after(border: Border, start: float, end: float) -> Iterator[tuple[float, float]]:
    width, height = border.x_max - border.x_min, border.y_max - border.y_min
    round_trip = 2 * width + 2 * height
    way = (end - start) % round_trip
    places = (
        (width, (border.x_max, border.y_min)),
        (width + height, (border.x_max, border.y_max)),
        (2 * width + height, (border.x_min, border.y_max)),
        (round_trip, (border.x_min, border.y_min)),
    )
    for distance, corner in sorted(((place - start) % round_trip, corner) for place, corner in places):
        if 0 < distance < way:
            yield corner


def _name(obstacle: Obstacle) -> str:
    return "polygon" if obstacle.shape_type is ShapeType.CLOSED_POLYGON else "curve"


def _unclosed(group: list[Chain]) -> str:
    obstacle = group[0][1]
    source = obstacle.ext.get("src")
    name = f"obstacle {obstacle.id}" + (f" ({source})" if source else "")
    return f"{name} is cut by the border and its parts do not fit together: its inside is written as free"
