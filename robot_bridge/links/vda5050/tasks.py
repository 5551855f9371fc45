"""Tasks of a vehicle: routes as nodes and edges, orders, progress, stored state."""

from __future__ import annotations

import hashlib
import itertools
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

import msgspec
from msgspec import UNSET, Struct, field
from shapely import LineString

from ...core.files import write_state
from ...core.json_decoder import DecodingError, JsonBounds, decode_json
from ...core.messages.base import to_json
from ...core.messages.robots import SetPath, SetPosEnd
from ...protocol.codec import decode_answer, parse_params
from .messages import Edge, Node, NodePosition, Order, State, Vda5050Error, VehicleFault

# --- Routes as orders: nodes and edges, the released part (the base), and its extension ---
# Everything here is in metres and radians of the vehicle's map.

Point = tuple[float, float]

NEAR = 0.01
"""metres within which two points of a route are one node."""


@dataclass(frozen=True)
class RouteLimits:
    """How routes become orders.

    ``base_length`` is how many metres are released ahead of the vehicle: it drives no farther if the adapter
    or the broker dies. Points within ``tolerance`` metres of the straight line between others are left out,
    nodes on the way are passed within ``passing_deviation`` metres, and the last one is reached within
    ``end_deviation`` (``heading_deviation`` radians). An order holds at most ``most_nodes``.
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
    """A whole route, with the nodes up to ``base_end`` released by update ``update_id``.

    That update begins at node ``stitch``, the last one of the previous base.
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
        """Return the newest update as the order to publish: its base, and the rest as horizon."""
        stop = min(self.last, self.stitch + max(limits.most_nodes, 2) - 1)
        nodes = [self._node(number, limits) for number in range(self.stitch, stop + 1)]
        edges = [self._edge(number, limits) for number in range(self.stitch, stop)]
        return Order(order_id=self.order_id, order_update_id=self.update_id, nodes=nodes, edges=edges)

    def extended(self, passed: int, limits: RouteLimits) -> OrderPlan | None:
        """Return the plan with a longer base once half of it is driven; None if not needed yet.

        ``passed`` is the last node passed by the vehicle.
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
    """Return the plan of a route from the vehicle along ``points``, with its first base released."""
    line = [position, *points]
    if len(points) > 1 and math.dist(position, points[0]) <= limits.passing_deviation:
        # It stands near the beginning of its path, and need not go back to it.
        line = [position, *points[1:]]
    corners = _split(_simplified(_distinct(line), limits.tolerance), limits.base_length)
    return OrderPlan(order_id, map_id, tuple(corners), theta, _base_end(corners, 0, 0, limits))


def _distinct(points: Sequence[Point]) -> list[Point]:
    """Return the points distinct from the previous one; at least two, always with the last one."""
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
    """Return the points with others inserted between those more than ``longest`` metres apart."""
    split = [points[0]]
    for begin, end in itertools.pairwise(points):
        pieces = max(1, math.ceil(math.dist(begin, end) / longest - 1e-9))
        for piece in range(1, pieces):
            share = piece / pieces
            split.append((begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1])))
        split.append(end)
    return split


def _base_end(points: Sequence[Point], passed: int, base_end: int, limits: RouteLimits) -> int:
    """Return the last node within the base's length of node ``passed``, at least one behind ``base_end``."""
    last = len(points) - 1
    end, length = passed, 0.0
    farthest = base_end + max(limits.most_nodes, 2) - 1
    while end < min(last, farthest):
        length += math.dist(points[end], points[end + 1])
        if length > limits.base_length + NEAR and end >= base_end + 1:
            break
        end += 1
    return end


# --- State of each vehicle on the adapter's disk, so that a restarted adapter continues ---

_BOUNDS = JsonBounds(depth=8, length=8 << 20, values=200_000)


class RememberedTask(Struct, frozen=True, kw_only=True):
    """The present task: its command, its route, and the part known to be driven.

    ``accepted`` is true once the vehicle has shown the order.
    """

    command: int
    op: str
    params: str
    plan: OrderPlan | None = None
    passed: int = 0
    accepted: bool = False
    acknowledged: bool = False
    resumed: int = 0


class Remembered(Struct, frozen=True, kw_only=True):
    """The stored state of a vehicle; ``ended`` are the newest accepted commands that are over.

    ``paused`` is true while a startPause of ours must be lifted before the next order; ``revoked`` are
    orders that the vehicle must not carry out. ``basis`` are the settings on which the task depends.
    """

    task: RememberedTask | None = None
    paused: bool = False
    revoked: list[str] = field(default_factory=list)
    ended: list[int] = field(default_factory=list)
    basis: str = ""

    def without_task(self) -> Remembered:
        """Return the state that is still valid after changed settings: its order must not be driven."""
        plan = None if self.task is None else self.task.plan
        revoked = self.revoked if plan is None else [*self.revoked, plan.order_id]
        return msgspec.structs.replace(self, task=None, revoked=revoked, ended=[])


class Memory:
    """A folder with a file for each vehicle, which outlives the process; each is written atomically.

    A power failure may bring an older one back: nothing waits for the disk, so that no stop does.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def recall(self, vehicle: str) -> Remembered | None:
        """Return the stored state of a vehicle, or None; raises Vda5050Error."""
        file = self._file(vehicle)
        try:
            return msgspec.convert(decode_json(file.read_bytes(), _BOUNDS), Remembered, strict=True)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise Vda5050Error(f"memory {file} cannot be read: {error.strerror or error}") from None
        except (DecodingError, msgspec.ValidationError) as error:
            raise Vda5050Error(
                f"memory {file} is none of a vehicle ({error}); delete it if the vehicle may be sent once "
                "more what it has done"
            ) from None

    def keep(self, vehicle: str, remembered: Remembered) -> None:
        """Replace the stored state of a vehicle; raises Vda5050Error."""
        file = self._file(vehicle)
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_state(file, msgspec.json.encode(remembered), synced=False)
        except OSError as error:
            raise Vda5050Error(
                f"memory {file} cannot be written: {error.strerror or error}; check its folder and free space"
            ) from error

    def _file(self, vehicle: str) -> Path:
        # A serial number may contain characters invalid in file names, and two may differ only in case.
        return self._folder / f"{hashlib.sha256(vehicle.encode()).hexdigest()[:24]}.json"


# --- A vehicle's task: a target or path as an order, and its progress by the vehicle's state

_ORDER_FAULTS = (
    *("order", "validation", "noroute"),
    *(
        "unsupportedparameter",
        "invalidorder",
        "outdatedorder",
        "otherorder",
        "startnode",
        "insufficientmemory",
    ),
)
"""Prefixes of the error types for refused orders in VDA 5050, in lower case; the second row is of 3.0."""
_UNREACHABLE = "nodeunreachable"
"""Error type of 3.0 for an order that a vehicle has and will not drive to its end."""
_LOST_BY_HAND = "{}, and its order went with that: send it again when the vehicle may drive"


class Progress(Enum):
    """Progress of a task by a state."""

    UNSEEN = "the vehicle has not shown the order"
    UNDER_WAY = "the vehicle has the order"
    REACHED = "the order is done to its last node"
    REFUSED = "the vehicle does not take the order on, or an update of it"
    ENDED = "the order ended before its last node"
    FORGOTTEN = "the vehicle had the order and has it no more"
    FOREIGN = "the vehicle carries out the order of somebody else"


@dataclass
class VehicleTask:
    """One motion command from its message to its end.

    ``path`` is in the site frame, ``plan`` in the vehicle's map; ``passed`` is the last node that it passed.
    """

    command_id: int
    message: SetPosEnd | SetPath
    received_at: float
    plan: OrderPlan | None = None
    path: Sequence[Point] = ()
    sent_at: float | None = None
    first_sent_at: float | None = None
    accepted: bool = False
    acknowledged: bool = False
    passed: int = 0
    resumed: int = 0
    is_confirmed: bool = True
    """false while it is unknown whether a task from before the adapter's start must still be driven."""
    _taken_over: str | None = None
    """Why the vehicle was not driven by its order in the last state that showed the order."""
    _known_faults: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        target = self.message
        if not self.path:
            self.path = target.points if isinstance(target, SetPath) else [(target.x, target.y)]

    @property
    def is_on_its_way(self) -> bool:
        """Whether its order was sent and not shown yet."""
        return self.plan is not None and self.first_sent_at is not None and not self.accepted

    def confirm(self, now: float) -> None:
        """Record that the gateway still waits for it."""
        if not self.is_confirmed:
            self.is_confirmed, self.received_at = True, now

    def begin(self, plan: OrderPlan) -> None:
        """Use ``plan`` from now on; it was not sent yet."""
        self.plan, self.accepted, self.passed = plan, False, 0
        self.sent_at = self.first_sent_at = None

    def forget_plan(self, now: float) -> None:
        """Have the way planned again, from the vehicle's position then."""
        self.plan, self.accepted = None, False
        self.resumed += 1
        self.received_at = now

    def sent(self, state: State | None, limits: RouteLimits, now: float) -> Order:
        """Return the newest update to publish, and record the time."""
        assert self.plan is not None
        if self.first_sent_at is None:
            self.first_sent_at = now
            self._known_faults = frozenset(fault.summary for fault in state.errors) if state else frozenset()
        self.sent_at = now
        return self.plan.order(limits)

    def extend(self, plan: OrderPlan) -> None:
        """Continue with the next update."""
        self.plan, self.sent_at = plan, None

    def is_shown(self, state: State) -> bool:
        """Return whether a state shows the newest update of the order."""
        plan = self.plan
        if plan is None:
            return False
        return state.order_id == plan.order_id and state.order_update_id >= plan.update_id

    def evaluate(self, state: State) -> tuple[Progress, str]:
        """Return the progress of the task by a state, with the vehicle's reason for a failure."""
        plan = self.plan
        if self.resumed and not self.accepted and (why := state.taken_over_by) is not None:
            return Progress.ENDED, _LOST_BY_HAND.format(why)
        if plan is None:
            return Progress.UNSEEN, ""
        if state.order_id != plan.order_id:
            return self._judge_unshown(state, plan)
        self.accepted, self._taken_over = True, state.taken_over_by
        if (fault := self._update_fault(state, plan) or _unreachable(state)) is not None:
            return Progress.REFUSED, fault.summary
        self.passed = _passed(state)
        if state.has_active_order or not self.is_shown(state):
            return Progress.UNDER_WAY, ""
        if self.passed >= plan.last:
            ended = all(action.has_ended for action in state.action_states)
            return (Progress.REACHED if ended else Progress.UNDER_WAY), ""
        if self.passed >= plan.base_end and self._taken_over is None:
            return Progress.UNDER_WAY, ""
        return Progress.ENDED, _reasons(state, f"the vehicle ended its order at node {self.passed}")

    def remembered(self) -> RememberedTask:
        """Return the state to store."""
        return RememberedTask(
            command=self.command_id,
            op=type(self.message).__name__,
            params=json.dumps(to_json(self.message)),
            plan=self.plan,
            passed=self.passed,
            accepted=self.accepted,
            acknowledged=self.acknowledged,
            resumed=self.resumed,
        )

    def _judge_unshown(self, state: State, plan: OrderPlan) -> tuple[Progress, str]:
        if self.accepted:
            if state.has_active_order:
                return (
                    Progress.FOREIGN,
                    f"another fleet control gave it order {state.order_id[:60]!r}",
                )
            # One that was taken over by hand must not drive off by itself when it is handed back.
            if (why := state.taken_over_by or self._taken_over) is not None:
                return Progress.ENDED, _LOST_BY_HAND.format(why)
            return Progress.FORGOTTEN, ""
        if self.first_sent_at is not None and (fault := self._refusal(state, plan)) is not None:
            return Progress.REFUSED, fault.summary
        return Progress.UNSEEN, ""

    def _refusal(self, state: State, plan: OrderPlan) -> VehicleFault | None:
        for fault in state.errors:
            if fault.refers("orderId", plan.order_id):
                return fault
        for fault in state.errors:
            # Some vehicles do not name the order that they refuse.
            unnamed = not any(one.reference_key == "orderId" for one in fault.error_references)
            kind = _kind(fault).startswith(_ORDER_FAULTS)
            if unnamed and kind and fault.summary not in self._known_faults:
                return fault
        return None

    def _update_fault(self, state: State, plan: OrderPlan) -> VehicleFault | None:
        if state.order_update_id >= plan.update_id or self.first_sent_at is None:
            return None
        number = str(plan.update_id)
        named = (f for f in state.errors if f.refers("orderId", plan.order_id))
        return next((fault for fault in named if fault.refers("orderUpdateId", number)), None)


def _kind(fault: VehicleFault) -> str:
    return fault.error_type.lower().replace("_", "")


def _unreachable(state: State) -> VehicleFault | None:
    """Return the error by which a vehicle reports a remaining node as unreachable."""
    nodes = {node.node_id for node in state.node_states}
    faults = (fault for fault in state.errors if _kind(fault) == _UNREACHABLE)
    return next((f for f in faults if any(f.refers("nodeId", node) for node in nodes)), None)


def recalled(kept: RememberedTask, now: float) -> VehicleTask:
    """Return the stored task; raises Vda5050Error if unreadable."""
    try:
        message = decode_answer(kept.op, parse_params(kept.op, kept.params))
    except ValueError as error:
        raise Vda5050Error(f"the task that was kept cannot be read ({error}); delete the memory") from None
    if not isinstance(message, SetPosEnd | SetPath):
        raise Vda5050Error(f"the task that was kept is a {kept.op}; delete the memory")
    task = VehicleTask(kept.command, message, now, accepted=kept.accepted, acknowledged=kept.acknowledged)
    task.plan, task.passed, task.resumed = kept.plan, kept.passed, kept.resumed
    task.is_confirmed = kept.acknowledged
    return task


def _passed(state: State) -> int:
    """Return the last passed node; a new order may still show the number of the previous one."""
    if state.node_states:
        return max(0, min(node.sequence_id for node in state.node_states) // 2 - 1)
    return state.last_node_sequence_id // 2


def _reasons(state: State, text: str) -> str:
    faults = [fault.summary for fault in state.errors]
    return f"{text}: {'; '.join(faults)}" if faults else text
