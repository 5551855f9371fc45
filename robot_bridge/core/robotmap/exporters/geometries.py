"""Geometries of a robot map: lines, closed solids, features with attributes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..model import CUT, Border, Obstacle, RobotMap, ShapeType

# --- The segments of an obstacle joined to lines ---

Points = NDArray[Any]


def lines_of(obstacle: Obstacle) -> list[Points]:
    """Return (n, 2) points of each line; segments are one line while one begins where the last ended.

    Of stairs each riser is a line.
    """
    if not len(obstacle.a):
        return []
    parted = (obstacle.b[:-1] != obstacle.a[1:]).any(axis=1)
    if obstacle.shape_type is ShapeType.STAIRS:
        parted[:] = True
    pieces = np.split(np.arange(len(obstacle.a)), np.flatnonzero(parted) + 1)
    return [np.concatenate([obstacle.a[piece], obstacle.b[piece[-1:]]]) for piece in pieces]


def is_ring(line: Points) -> bool:
    """Return whether a line ends where it began and may enclose something."""
    return len(line) > 3 and bool((line[0] == line[-1]).all())


def signed_area(ring: Points) -> float:
    """Return the area of a ring in square units, positive when it runs counter-clockwise."""
    x, y = (ring - ring[0]).T
    return float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2)


def flanks_of(obstacle: Obstacle) -> tuple[Points, Points]:
    """Return the flanks of a flight of stairs as segments a→b, (2 n - 2, 2) each, from riser to riser."""
    return (
        np.concatenate([obstacle.a[:-1], obstacle.b[:-1]]),
        np.concatenate([obstacle.a[1:], obstacle.b[1:]]),
    )


def treads_of(obstacle: Obstacle) -> list[Points]:
    """Return the ring, (5, 2) and counter-clockwise, of each tread between two risers of a flight."""
    a, b = obstacle.a, obstacle.b
    rings = [np.array([a[k], b[k], b[k + 1], a[k + 1], a[k]]) for k in range(len(a) - 1)]
    return [ring if signed_area(ring) >= 0 else ring[::-1] for ring in rings]


# --- Areas of obstacles: rings, and rings cut by the map's border, closed along it

_WHOLE = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE)
_CUT = (ShapeType.OPEN_POLYGON, ShapeType.OPEN_CURVE)
_ON_BORDER = 0.006
"""metres; cuts are written in centimetres."""


@dataclass(frozen=True)
class Solid:
    """One ring, (n, 2) metres in the site frame: counter-clockwise round an obstacle, clockwise a courtyard.

    ``obstacle`` is one that it belongs to. ``cut`` says that parts of it are the border, not walls.
    """

    ring: Points
    obstacle: Obstacle
    cut: bool = False


def solids_of(robot_map: RobotMap) -> tuple[list[Solid], list[str]]:
    """Return the rings of a map, and a warning for each obstacle that should be a ring and is not.

    A ring that the border cut is written as open chains, as a wall is, and marked by the extra ``cut``;
    chains of one source belong together. A map without extras lacks this mark; then there is a warning if it
    matters. An obstacle all around the map has only its courtyards on it: the border replaces its outer ring.
    Ramps are driven on and enclose nothing.
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
    return [*_around(robot_map.border, solids), *solids], warnings


def edges_of(rings: Sequence[Points]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the segments a→b, (n, 2) each, of all rings."""
    if not rings:
        return np.empty((0, 2)), np.empty((0, 2))
    return np.concatenate([ring[:-1] for ring in rings]), np.concatenate([ring[1:] for ring in rings])


def first_label(obstacle: Obstacle) -> str:
    """Return the first word of an obstacle's semantics, its kind."""
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
    """Return a warning when chains look like parts of cut rings with one of ``labels``."""
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
    """Return the rings formed by chains and the border between them; none when they do not fit together.

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


def _around(border: Border, solids: Sequence[Solid]) -> list[Solid]:
    """Return the border as a ring for each source that has courtyards but no ring around them."""
    hosts: dict[tuple[str, str], list[Points]] = defaultdict(list)
    for solid in solids:
        if signed_area(solid.ring) > 0:
            hosts[_identity(solid.obstacle)].append(solid.ring)
    found = {}
    for solid in solids:
        key = _identity(solid.obstacle)
        # Rings in maps of other programs have no source, and may have either direction.
        if (
            key[1]
            and signed_area(solid.ring) < 0
            and not any(_holds(ring, solid.ring) for ring in hosts[key])
        ):
            x_min, y_min, x_max, y_max = border
            corners = [(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)]
            found[key] = Solid(np.array(corners, dtype=float), solid.obstacle, cut=True)
    return list(found.values())


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
    # In millimetres, so that two coincident ends compare equal.
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


# --- A robot map as geometries with attributes, for GIS formats ---

GeometryKind = Literal["Polygon", "MultiLineString", "LineString"]

_RINGS = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)


@dataclass(frozen=True, eq=False)
class MapShape:
    """One geometry, metres in the site frame, and its attributes.

    ``parts`` are the rings of a polygon, the outer one first, or lines; each is (n, 2).
    """

    kind: GeometryKind
    parts: tuple[Points, ...]
    attributes: dict[str, Any]


def obstacle_shapes(robot_map: RobotMap) -> list[MapShape]:
    """Return a shape for each obstacle: a polygon where its segments close, else lines.

    A courtyard becomes a hole of the obstacle round it that has the same source; without one it remains a
    polygon of its own, marked ``courtyard``. Attributes: ``id``, ``shape_type`` and its name ``shape``,
    ``semantics``, ``height_m`` of the highest segment, ``outdoor`` (of all segments), ``segments``,
    ``courtyards`` (ids of those that are holes), ``courtyard``, ``source`` and ``ext``.
    """
    outer, courtyards, lines = _sorted_out(robot_map.obstacles)
    holes: dict[int, list[tuple[Points, Obstacle]]] = {}
    alone = []
    for ring, obstacle in courtyards:
        host = _host_of(ring, obstacle, outer)
        if host is None:
            alone.append((ring, obstacle))
        else:
            holes.setdefault(host, []).append((ring, obstacle))
    shapes = []
    for k, (ring, obstacle) in enumerate(outer):
        inner = holes.get(k, [])
        attributes = _attributes(obstacle, courtyards=[hole.id for _, hole in inner])
        shapes.append(MapShape("Polygon", (ring, *(hole for hole, _ in inner)), attributes))
    shapes += [MapShape("Polygon", (ring,), _attributes(o, courtyard=True)) for ring, o in alone]
    shapes += [MapShape("MultiLineString", tuple(parts), _attributes(o)) for parts, o in lines]
    return shapes


def segment_shapes(robot_map: RobotMap) -> list[MapShape]:
    """Return a line a→b for each segment, free space on its right.

    Attributes: ``obstacle`` (id), ``number`` from 1 within it, ``shape_type``, ``height_m``, ``outdoor``,
    ``semantics``, ``obstacle_semantics``, ``source`` and ``ext``.
    """
    return [
        MapShape(
            "LineString",
            (np.array([obstacle.a[k], obstacle.b[k]]),),
            {
                "obstacle": obstacle.id,
                "number": k + 1,
                "shape_type": int(obstacle.shape_type),
                "height_m": float(obstacle.height[k]),
                "outdoor": bool(obstacle.outdoor[k]),
                "semantics": obstacle.segment_semantics[k],
                "obstacle_semantics": obstacle.semantics,
                "source": obstacle.ext.get("src", ""),
                "ext": dict(obstacle.segment_ext[k]) if obstacle.segment_ext else {},
            },
        )
        for obstacle in robot_map.obstacles
        for k in range(len(obstacle.a))
    ]


Ring = tuple[Points, Obstacle]


def _sorted_out(
    obstacles: Iterable[Obstacle],
) -> tuple[list[Ring], list[Ring], list[tuple[list[Points], Obstacle]]]:
    """Return outer rings, courtyards, and the lines of all unclosed obstacles."""
    outer: list[Ring] = []
    courtyards: list[Ring] = []
    lines: list[tuple[list[Points], Obstacle]] = []
    for obstacle in obstacles:
        parts = lines_of(obstacle)
        if obstacle.shape_type not in _RINGS or not all(is_ring(part) for part in parts):
            lines += [(parts, obstacle)] if parts else []
            continue
        for part in parts:
            (outer if signed_area(part) > 0 else courtyards).append((part, obstacle))
    return outer, courtyards, lines


def _host_of(ring: Points, courtyard: Obstacle, outer: Sequence[Ring]) -> int | None:
    """Return the smallest outer ring of the same source that holds a courtyard."""
    identity = _identity(courtyard)
    around = [
        (signed_area(other), k)
        for k, (other, obstacle) in enumerate(outer)
        if _identity(obstacle) == identity and _holds(other, ring)
    ]
    return min(around)[1] if around else None


def _identity(obstacle: Obstacle) -> tuple[str, str]:
    return obstacle.semantics, obstacle.ext.get("src", "")


def _holds(outer: Points, ring: Points) -> bool:
    """Return whether the middle of the ring's first side is in ``outer``: its corners may touch."""
    if (ring.min(axis=0) < outer.min(axis=0)).any() or (ring.max(axis=0) > outer.max(axis=0)).any():
        return False
    x, y = (ring[0] + ring[1]) / 2
    a, b = outer[:-1], outer[1:]
    across = (a[:, 1] > y) != (b[:, 1] > y)
    a, b = a[across], b[across]
    at = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return int((at > x).sum()) % 2 == 1


def _attributes(
    obstacle: Obstacle, courtyards: Sequence[int] = (), courtyard: bool = False
) -> dict[str, Any]:
    return {
        "id": obstacle.id,
        "shape_type": int(obstacle.shape_type),
        "shape": obstacle.shape_type.name.lower().replace("_", " "),
        "semantics": obstacle.semantics,
        "height_m": float(obstacle.height.max()),
        "outdoor": bool(obstacle.outdoor.all()),
        "segments": len(obstacle.a),
        "courtyards": list(courtyards),
        "courtyard": courtyard,
        "source": obstacle.ext.get("src", ""),
        "ext": dict(obstacle.ext),
    }
