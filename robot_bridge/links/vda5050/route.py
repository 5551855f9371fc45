"""Routes as orders: nodes and edges, what of them is released (the base), and how the base goes on.

Everything here is in metres and radians of the vehicle's map.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from msgspec import UNSET
from shapely import LineString

from .outbound import Edge, Node, NodePosition, Order

Point = tuple[float, float]

NEAR = 0.01
"""metres within which two points of a route are one node."""


@dataclass(frozen=True)
class RouteLimits:
    """How routes become orders.

    ``base_length`` is how many metres are released ahead of the vehicle: it drives no farther when the
    adapter or the broker dies. Points within ``tolerance`` metres of the straight line between others are
    left out, nodes on the way are passed within ``passing_deviation`` metres, and the last one is reached
    within ``end_deviation`` (``heading_deviation`` radians). An order holds at most ``most_nodes``.
    """

    base_length: float = 30.0
    tolerance: float = 0.05
    start_deviation: float = 1.0
    passing_deviation: float = 0.5
    end_deviation: float = 0.1
    heading_deviation: float = 0.1
    most_nodes: int = 100
    max_speed: float | None = None


@dataclass(frozen=True)
class OrderPlan:
    """A whole route, of which the nodes up to ``base_end`` are released by update ``update_id``.

    That update begins at node ``stitch``, the last one of the base before it.
    """

    order_id: str
    map_id: str
    points: tuple[Point, ...]
    theta: float | None
    base_end: int
    update_id: int = 0
    stitch: int = 0

    @property
    def last(self) -> int:
        """The number of the last node."""
        return len(self.points) - 1

    @property
    def end(self) -> Point:
        """Where the route ends."""
        return self.points[-1]

    def node_id(self, number: int) -> str:
        """Return the name of a node: nodes of two orders are never the same."""
        return f"{self.order_id}-{number}"

    def order(self, limits: RouteLimits) -> Order:
        """Return the newest update as the order that is published: its base, and what follows as horizon."""
        stop = min(self.last, self.stitch + max(limits.most_nodes, 2) - 1)
        nodes = [self._node(number, limits) for number in range(self.stitch, stop + 1)]
        edges = [self._edge(number, limits) for number in range(self.stitch, stop)]
        return Order(order_id=self.order_id, order_update_id=self.update_id, nodes=nodes, edges=edges)

    def extended(self, passed: int, limits: RouteLimits) -> OrderPlan | None:
        """Return the plan with a longer base once half of it is driven; None while there is no need.

        ``passed`` is the last node that the vehicle was seen at.
        """
        if self.base_end >= self.last or self._length(passed, self.base_end) > limits.base_length / 2:
            return None
        end = _base_end(self.points, max(passed, 0), self.base_end, limits)
        return replace(self, stitch=self.base_end, base_end=end, update_id=self.update_id + 1)

    def left(self, passed: int) -> list[Point]:
        """Return the points behind node ``passed``; never none."""
        return list(self.points[min(passed, self.last - 1) + 1 :])

    def _node(self, number: int, limits: RouteLimits) -> Node:
        x, y = self.points[number]
        is_end = number == self.last
        heading = self.theta if is_end and self.theta is not None else None
        deviation = limits.end_deviation if is_end else limits.passing_deviation
        position = NodePosition(
            x=round(x, 4),
            y=round(y, 4),
            map_id=self.map_id,
            theta=UNSET if heading is None else round(math.remainder(heading, math.tau), 5),
            allowed_deviation_xy=limits.start_deviation if number == 0 else deviation,
            allowed_deviation_theta=UNSET if heading is None else limits.heading_deviation,
        )
        return Node(
            node_id=self.node_id(number),
            sequence_id=2 * number,
            released=number <= self.base_end,
            node_position=position,
        )

    def _edge(self, number: int, limits: RouteLimits) -> Edge:
        """Return the edge from a node to the next."""
        return Edge(
            edge_id=f"{self.node_id(number)}e",
            sequence_id=2 * number + 1,
            released=number < self.base_end,
            start_node_id=self.node_id(number),
            end_node_id=self.node_id(number + 1),
            max_speed=UNSET if limits.max_speed is None else limits.max_speed,
        )

    def _length(self, begin: int, end: int) -> float:
        return sum(math.dist(self.points[i], self.points[i + 1]) for i in range(max(begin, 0), end))


def begin_plan(
    order_id: str,
    map_id: str,
    position: Point,
    points: Sequence[Point],
    theta: float | None,
    limits: RouteLimits,
) -> OrderPlan:
    """Return the plan of a route from where the vehicle is along ``points``, with its first base released."""
    line = [position, *points]
    if len(points) > 1 and math.dist(position, points[0]) <= limits.passing_deviation:
        # It stands at the beginning of its path, and need not go back to it.
        line = [position, *points[1:]]
    corners = _split(_simplified(_distinct(line), limits.tolerance), limits.base_length)
    return OrderPlan(order_id, map_id, tuple(corners), theta, _base_end(corners, 0, 0, limits))


def _distinct(points: Sequence[Point]) -> list[Point]:
    """Return the points that are apart from the one before; two of them at least, the last one kept."""
    kept = [points[0]]
    for point in points[1:]:
        if math.dist(point, kept[-1]) > NEAR:
            kept.append(point)
    if len(kept) == 1:
        kept.append(points[-1])
    return kept


def _simplified(points: list[Point], tolerance: float) -> list[Point]:
    if len(points) < 3:
        return points
    line = LineString(points).simplify(tolerance, preserve_topology=False)
    return [(float(x), float(y)) for x, y in line.coords]


def _split(points: list[Point], longest: float) -> list[Point]:
    """Return the points with others between those that are more than ``longest`` metres apart."""
    split = [points[0]]
    for begin, end in itertools.pairwise(points):
        pieces = max(1, math.ceil(math.dist(begin, end) / longest - 1e-9))
        for piece in range(1, pieces):
            share = piece / pieces
            split.append((begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1])))
        split.append(end)
    return split


def _base_end(points: Sequence[Point], passed: int, base_end: int, limits: RouteLimits) -> int:
    """Return the last node within the base's length of node ``passed``, one behind ``base_end`` at least."""
    last = len(points) - 1
    end, length = passed, 0.0
    farthest = base_end + max(limits.most_nodes, 2) - 1
    while end < min(last, farthest):
        length += math.dist(points[end], points[end + 1])
        if length > limits.base_length + NEAR and end >= base_end + 1:
            break
        end += 1
    return end
