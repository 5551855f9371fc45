"""Lanelet2 export: lanes as pairs of borders, turns at junctions, OSM file."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import RoadExportError
from .network import BACKWARD, BOTH, FORWARD, Floats, Network

# --- Lanes of roads as pairs of borders, and the turns that join them at junctions ---
# Lanes follow one another if they share the points at their ends. Roads that meet at an angle cannot: so each
# ends short of its junction, and turns lead from every incoming to every outgoing lane. Readers derive the
# direction of a border from geometry, so borders must not cross: lanes are narrower where a junction is
# nearer than they are wide, where roads meet at a sharp angle, and in tight corners.

_LARGEST_SHARE = 0.4
"""The share of a road that one junction may take."""

_LARGEST_MITRE = 2.0
"""Limit of a border's distance from its centreline in corners, relative to straight stretches."""

_ROOM = 0.8
"""The share of the room up to where borders would meet that they use."""

_STRAIGHT_BACK = -math.cos(math.radians(5.0))
"""The cosine of the angle from which a turn leads back, as onto a road drawn twice."""

_LEAST_M = 0.01
"""Half of a lane's width if there is no room at all."""


@dataclass(frozen=True)
class LaneBorder:
    """A line through ``points``, numbers of points of :class:`Lanes`; ``kind`` is its type."""

    points: tuple[int, ...]
    kind: str


@dataclass(frozen=True)
class Lane:
    """A lane, driven from its first points to its last; ``left`` and ``right`` are numbers of borders.

    Borders that two lanes share may run against the lane. ``name`` is that of the edge, empty for turns.
    """

    left: int
    right: int
    speed: float
    name: str


@dataclass(frozen=True)
class _End:
    """One end of a lane: the ends of both borders, their distances from the centreline, and the speed.

    ``heading`` is the unit vector in which the lane is driven there.
    """

    left: int
    right: int
    offsets: tuple[float, float]
    heading: Floats
    speed: float
    edge: int


@dataclass
class Lanes:
    """Points in metres, borders through them, and lanes between borders."""

    points: list[tuple[float, float]] = field(default_factory=list)
    borders: list[LaneBorder] = field(default_factory=list)
    lanes: list[Lane] = field(default_factory=list)

    def add_points(self, xy: Floats) -> tuple[int, ...]:
        """Add (n, 2) points and return their numbers."""
        first = len(self.points)
        self.points += map(tuple, xy.tolist())
        return tuple(range(first, len(self.points)))

    def add_border(self, points: tuple[int, ...], kind: str) -> int:
        """Add a border and return its number."""
        self.borders.append(LaneBorder(points, kind))
        return len(self.borders) - 1


def lanes_of(network: Network, keep_left: bool = False) -> Lanes:
    """Return the lanes of ``network``: one per direction, each half of the road if it has both."""
    made = Lanes()
    setbacks = _setbacks(network)
    lines = [_shortened(network.edges.line(k), *setbacks[k]) for k in range(len(network))]
    outwards = _outwards(network, lines, setbacks)
    rooms = _rooms(network, outwards, setbacks)
    coming: dict[int, list[_End]] = defaultdict(list)
    going: dict[int, list[_End]] = defaultdict(list)
    for k, line in enumerate(lines):
        half = network.edges.width[k] / 2.0
        borders, at_ends = _borders(line, half, outwards[k], rooms[k])
        tail, head = int(network.tail[k]), int(network.head[k])
        for direction, first, last in _road(made, network, k, borders, (outwards[k], at_ends), keep_left):
            origin, goal = (tail, head) if direction == FORWARD else (head, tail)
            going[origin].append(first)
            coming[goal].append(last)
    for node, ends in coming.items():
        for end in ends:
            for start in going[node]:
                if start.edge != end.edge and end.heading @ start.heading > _STRAIGHT_BACK:
                    _turn(made, network.nodes[node], end, start)
    return made


def _setbacks(network: Network) -> Floats:
    """Return by how many metres each edge ends short of its tail and of its head, (n, 2)."""
    widest = np.zeros(len(network.nodes))
    for ends in (network.tail, network.head):
        np.maximum.at(widest, ends, network.edges.width)
    ends = np.stack([network.tail, network.head], axis=1)
    ideal = np.where(network.degrees[ends] > 1, widest[ends], 0.0)
    setbacks: Floats = np.minimum(ideal, _LARGEST_SHARE * network.lengths[:, None])
    return setbacks


def _outwards(network: Network, lines: list[Floats], setbacks: Floats) -> Floats:
    """Return unit vectors from the tail and the head of each edge to where its lanes end, (n, 2, 2)."""
    nodes = network.nodes[np.stack([network.tail, network.head], axis=1)]
    tips = np.array([(line[0], line[-1]) for line in lines])
    inner = np.array([(line[1], line[-2]) for line in lines])
    way = np.where(setbacks[:, :, None] > 0.0, tips - nodes, inner - tips)
    outwards: Floats = way / np.maximum(np.hypot(way[..., 0], way[..., 1]), 1e-12)[..., None]
    return outwards


def _rooms(network: Network, outwards: Floats, setbacks: Floats) -> Floats:
    """Return how far borders may be from the centreline at the tail and the head of each edge, (n, 2).

    That is less than half of the way to the next road at the same distance from the node.
    """
    rooms = np.where(setbacks > 0.0, setbacks / 2.0, np.inf)
    at: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for k, ends in enumerate(zip(network.tail.tolist(), network.head.tolist(), strict=True)):
        for side, node in enumerate(ends):
            at[node].append((k, side))
    for ends_here in at.values():
        if len(ends_here) < 2:
            continue
        edge, side = np.array(ends_here).T
        cosines = outwards[edge, side] @ outwards[edge, side].T
        np.fill_diagonal(cosines, -1.0)
        sharpest = np.arccos(np.clip(cosines.max(axis=1), -1.0, 1.0))
        room = _ROOM * setbacks[edge, side] * np.tan(np.minimum(sharpest, 3.0) / 2.0)
        rooms[edge, side] = np.maximum(np.minimum(rooms[edge, side], room), _LEAST_M)
    return rooms


def _borders(line: Floats, half: float, outwards: Floats, rooms: Floats) -> tuple[dict[str, Floats], Floats]:
    """Return the lines left, right and in the middle of a road, as seen along ``line``.

    Also returned: the distances of left and right from the middle at both ends, at most ``rooms``.
    """
    steps = np.diff(line, axis=0)
    lengths = np.hypot(*steps.T)
    normals = np.stack([-steps[:, 1], steps[:, 0]], axis=1) / lengths[:, None]
    first, last = _left_of(outwards[0]), _left_of(-outwards[1])
    before, after = np.concatenate([[first], normals]), np.concatenate([normals, [last]])
    turns = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))
    # Turns continue from the roads' nodes, not from where the line begins.
    before[-1], after[0] = last, first
    between = before + after
    size = np.hypot(*between.T)
    # If a line turns back upon itself, its normals cancel one another.
    between = np.where(size[:, None] > 1e-9, between / np.maximum(size, 1e-9)[:, None], before)
    mitre = np.minimum(2.0 / np.maximum(size, 1e-9), _LARGEST_MITRE)
    left, right = (np.minimum(half, _inside(sign * turns, lengths)) for sign in (1.0, -1.0))
    at_ends = np.minimum(np.minimum(left, right)[[0, -1]], rooms)
    left[[0, -1]] = right[[0, -1]] = at_ends
    sides = {
        "left": line + between * (left * mitre)[:, None],
        "right": line - between * (right * mitre)[:, None],
        "middle": line,
    }
    return sides, at_ends


def _inside(turns: Floats, lengths: Floats) -> Floats:
    """Return how far a border may be from each point of a line that turns by ``turns`` to its side."""
    shorter = np.minimum(np.concatenate([[np.inf], lengths]), np.concatenate([lengths, [np.inf]]))
    room = _ROOM / 2.0 * shorter / np.maximum(np.tan(np.maximum(turns, 0.0) / 2.0), 1e-9)
    around = np.concatenate([[np.inf], room, [np.inf]])
    # A border that enters far from a corner would cross the one that leaves it.
    least: Floats = np.maximum(np.minimum(np.minimum(around[:-2], around[2:]), room), _LEAST_M)
    return least


def _left_of(vector: Floats) -> Floats:
    return np.array([-vector[1], vector[0]])


def _road(
    made: Lanes,
    network: Network,
    k: int,
    borders: dict[str, Floats],
    tips: tuple[Floats, Floats],
    keep_left: bool,
) -> Iterator[tuple[int, _End, _End]]:
    """Add the lanes of edge ``k``; yield the direction, the first and the last end of each.

    ``tips`` are the vectors from the nodes outwards, and how far borders are from the centreline there.
    """
    edges = network.edges
    outwards, at_ends = tips
    one_way = edges.direction[k] != BOTH
    sides = {name: made.add_points(xy) for name, xy in borders.items() if name != "middle" or not one_way}
    numbers = {
        name: made.add_border(points, "line_thin" if name == "middle" else "road_border")
        for name, points in sides.items()
    }
    for direction in (FORWARD, BACKWARD):
        if edges.direction[k] == -direction:
            continue
        left, right = _sides_of(direction, one_way, keep_left)
        name = f"e{k}" if direction == FORWARD else f"e{k}r"
        speed = float(edges.speed[k])
        made.lanes.append(Lane(numbers[left], numbers[right], speed, name))
        ends = []
        for at, heading in ((0, outwards[0]), (-1, -outwards[1]))[::direction]:
            offsets = tuple(0.0 if side == "middle" else float(at_ends[at]) for side in (left, right))
            points = sides[left][at], sides[right][at]
            ends.append(_End(*points, (offsets[0], offsets[1]), heading * direction, speed, k))
        yield direction, ends[0], ends[1]


def _sides_of(direction: int, one_way: bool, keep_left: bool) -> tuple[str, str]:
    """Return which borders, as seen along the centreline, are left and right of a lane."""
    outer = ("left", "right") if direction == FORWARD else ("right", "left")
    if one_way:
        return outer
    return (outer[0], "middle") if keep_left else ("middle", outer[1])


def _turn(made: Lanes, node: Floats, end: _End, start: _End) -> None:
    """Add the turn from where a lane ends to where another begins, by way of the node."""
    along = end.heading + start.heading
    across = _left_of(along / np.hypot(*along))
    left, right = (min(pair) for pair in zip(end.offsets, start.offsets, strict=True))
    middles = made.add_points(np.stack([node + left * across, node - right * across]))
    made.lanes.append(
        Lane(
            made.add_border((end.left, middles[0], start.left), "virtual"),
            made.add_border((end.right, middles[1], start.right), "virtual"),
            min(end.speed, start.speed),
            "",
        )
    )


def _shortened(line: Floats, at_start: float, at_end: float) -> Floats:
    """Return ``line`` without so many metres at its start and at its end."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    first, last = at_start, along[-1] - at_end
    stations = np.concatenate([[first], along[(along > first) & (along < last)], [last]])
    return np.stack([np.interp(stations, along, column) for column in line.T], axis=1)


def misread_places(lanes: Lanes) -> list[tuple[float, float]]:
    """Return the places of lanes whose borders cross, (x, y) in metres.

    Lanelet2 derives the direction of a border from the side of the other's middle point; it reads these in
    the wrong direction.
    """
    xy = np.array(lanes.points, dtype=np.float64)
    places = []
    for lane in lanes.lanes:
        # If a road is driven against its centreline, both borders run against the lane.
        order = -1 if lane.name.endswith("r") else 1
        left, right = (xy[list(lanes.borders[number].points)][::order] for number in (lane.left, lane.right))
        if _side(left, _middle(right)) >= 0.0 or _side(right, _middle(left)) <= 0.0:
            x, y = left[0].tolist()
            places.append((x, y))
    return places


def _middle(line: Floats) -> Floats:
    middle: Floats = line[len(line) // 2] if len(line) > 2 else line.mean(axis=0)
    return middle


def _side(line: Floats, point: Floats) -> float:
    """Return a number above 0 where ``point`` is left of the nearest part of ``line``, else below 0."""
    steps, offsets = np.diff(line, axis=0), point - line[:-1]
    squares = np.maximum((steps**2).sum(axis=1), 1e-18)
    share = np.clip((steps * offsets).sum(axis=1) / squares, 0.0, 1.0)
    away = np.hypot(*(offsets - share[:, None] * steps).T)
    across = (steps[:, 0] * offsets[:, 1] - steps[:, 1] * offsets[:, 0]) / np.sqrt(squares)
    # Beyond a corner two parts are equally near: the one with the larger offset decides.
    across[away > away.min() + 1e-9] = 0.0
    return float(across[np.argmax(np.abs(across))])


# --- A Lanelet2 map, in OSM format: a lanelet for each direction of a road and for each turn ---

ToLonLat = Callable[[Floats], NDArray[Any]]
"""From (n, 2) metres in the site frame to (n, 2) longitudes and latitudes, WGS 84 degrees."""

_BORDERS = {
    "road_border": '<tag k="type" v="road_border"/>',
    "line_thin": '<tag k="type" v="line_thin"/><tag k="subtype" v="solid"/>',
    "virtual": '<tag k="type" v="virtual"/>',
}
_LANE = (
    '<tag k="type" v="lanelet"/><tag k="subtype" v="road"/><tag k="location" v="urban"/>'
    '<tag k="one_way" v="yes"/><tag k="participant:vehicle" v="yes"/>'
)


def lanelet2_document(lanes: Lanes, to_lonlat: ToLonLat) -> bytes:
    """Return the map of ``lanes``, whose coordinates are metres in the site frame.

    Nodes also have these as ``local_x`` and ``local_y``. Lanelets of roads name their edge as ``road``.

    :raises RoadExportError: when a position is none on the earth.
    """
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<osm version="0.6" generator="Fleet Supervisor">',
        *_nodes(lanes, to_lonlat),
        *_ways(lanes),
        *_relations(lanes),
        "</osm>\n",
    ]
    return "\n".join(lines).encode()


def _nodes(lanes: Lanes, to_lonlat: ToLonLat) -> Iterator[str]:
    xy = np.array(lanes.points, dtype=np.float64)
    lonlat = np.asarray(to_lonlat(xy), dtype=np.float64)
    if not np.isfinite(lonlat).all() or (np.abs(lonlat) > (180.0, 90.0)).any():
        raise RoadExportError(
            "Lanelet2: a position of the roads is none on the earth: check the CRS, the origin and the "
            "rotation of the site frame."
        )
    for number, ((x, y), (lon, lat)) in enumerate(zip(xy.tolist(), lonlat.tolist(), strict=True), 1):
        yield (
            f'<node id="{number}" lat="{lat:.11f}" lon="{lon:.11f}">'
            f'<tag k="local_x" v="{x:.4f}"/><tag k="local_y" v="{y:.4f}"/></node>'
        )


def _ways(lanes: Lanes) -> Iterator[str]:
    for number, border in enumerate(lanes.borders, _first_way(lanes)):
        points = "".join(f'<nd ref="{point + 1}"/>' for point in border.points)
        yield f'<way id="{number}">{points}{_BORDERS[border.kind]}</way>'


def _relations(lanes: Lanes) -> Iterator[str]:
    """Yield a speed limit for each speed, and the lanelets that refer to them."""
    first = _first_way(lanes) + len(lanes.borders)
    speeds = sorted({lane.speed for lane in lanes.lanes})
    limits = dict(zip(speeds, range(first, first + len(speeds)), strict=True))
    for speed, number in limits.items():
        yield (
            f'<relation id="{number}"><tag k="type" v="regulatory_element"/>'
            f'<tag k="subtype" v="speed_limit"/><tag k="sign_type" v="{speed * 3.6:.6g} km/h"/></relation>'
        )
    for number, lane in enumerate(lanes.lanes, first + len(speeds)):
        yield _lanelet(number, lane, _first_way(lanes), limits[lane.speed])


def _lanelet(number: int, lane: Lane, first_way: int, limit: int) -> str:
    name = f'<tag k="road" v="{lane.name}"/>' if lane.name else ""
    return (
        f'<relation id="{number}"><member type="way" role="left" ref="{first_way + lane.left}"/>'
        f'<member type="way" role="right" ref="{first_way + lane.right}"/>'
        f'<member type="relation" role="regulatory_element" ref="{limit}"/>{_LANE}{name}</relation>'
    )


def _first_way(lanes: Lanes) -> int:
    return len(lanes.points) + 1
