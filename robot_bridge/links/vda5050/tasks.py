"""A target or path that a vehicle is to drive, as an order, and what the vehicle's state says of it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from ...messages import SetPath, SetPosEnd, to_json
from ...wire import decode_answer, parse_params
from .errors import Vda5050Error
from .inbound import State, VehicleFault
from .memory import RememberedTask
from .outbound import Order
from .route import OrderPlan, Point, RouteLimits

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
"""How the error types begin by which VDA 5050 has orders refused, in lower case; the second row is of 3.0."""
_UNREACHABLE = "nodeunreachable"
"""How 3.0 says that a vehicle has an order, and will not drive it to its end."""


class Progress(Enum):
    """What a state says of a task."""

    UNSEEN = "the vehicle has not shown the order"
    UNDER_WAY = "the vehicle has the order"
    REACHED = "the order is done to its last node"
    REFUSED = "the vehicle does not take the order on, or an update of it"
    ENDED = "the order ended before its last node"
    FORGOTTEN = "the vehicle had the order and has it no more"
    FOREIGN = "the vehicle carries out the order of somebody else"


@dataclass
class Task:
    """One motion command from its message to its end.

    ``path`` is in the site frame, ``plan`` in the vehicle's map; ``passed`` is the last node it was seen at.
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
    """false while nobody knows whether a task from before the adapter was started is still to be driven."""
    _known_faults: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        target = self.message
        if not self.path:
            self.path = target.points if isinstance(target, SetPath) else [(target.x, target.y)]

    def confirm(self, now: float) -> None:
        """Note that the gateway still has it waiting."""
        if not self.is_confirmed:
            self.is_confirmed, self.received_at = True, now

    def begin(self, plan: OrderPlan) -> None:
        """Drive by ``plan`` from now on; it was not sent yet."""
        self.plan, self.accepted, self.passed = plan, False, 0
        self.sent_at = self.first_sent_at = None

    def forget_plan(self, now: float) -> None:
        """Have the way planned anew, from where the vehicle is then."""
        self.plan, self.accepted = None, False
        self.resumed += 1
        self.received_at = now

    def sent(self, state: State | None, limits: RouteLimits, now: float) -> Order:
        """Return the newest update to be published, and note when that is."""
        assert self.plan is not None
        if self.first_sent_at is None:
            self.first_sent_at = now
            self._known_faults = frozenset(fault.summary for fault in state.errors) if state else frozenset()
        self.sent_at = now
        return self.plan.order(limits)

    def extend(self, plan: OrderPlan) -> None:
        """Go on with the next update."""
        self.plan, self.sent_at = plan, None

    def is_shown(self, state: State) -> bool:
        """Tell whether a state shows the newest update of the order."""
        plan = self.plan
        if plan is None:
            return False
        return state.order_id == plan.order_id and state.order_update_id >= plan.update_id

    def judge(self, state: State) -> tuple[Progress, str]:
        """Return what a state says of the task, with the vehicle's reason where it is none of its ends."""
        plan = self.plan
        if plan is None:
            return Progress.UNSEEN, ""
        if state.order_id != plan.order_id:
            return self._judge_unshown(state, plan)
        self.accepted = True
        if (fault := self._update_fault(state, plan) or _unreachable(state)) is not None:
            return Progress.REFUSED, fault.summary
        self.passed = _passed(state)
        if state.has_active_order or not self.is_shown(state):
            return Progress.UNDER_WAY, ""
        if self.passed >= plan.last:
            ended = all(action.has_ended for action in state.action_states)
            return (Progress.REACHED if ended else Progress.UNDER_WAY), ""
        if self.passed >= plan.base_end:
            return Progress.UNDER_WAY, ""
        return Progress.ENDED, _reasons(state, f"the vehicle ended its order at node {self.passed}")

    def remembered(self) -> RememberedTask:
        """Return what is kept of it."""
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
            return Progress.FORGOTTEN, ""
        if self.first_sent_at is not None and (fault := self._refusal(state, plan)) is not None:
            return Progress.REFUSED, fault.summary
        return Progress.UNSEEN, ""

    def _refusal(self, state: State, plan: OrderPlan) -> VehicleFault | None:
        for fault in state.errors:
            if fault.refers("orderId", plan.order_id):
                return fault
        for fault in state.errors:
            # Some vehicles do not say which order they refuse.
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
    """Return the error by which a vehicle says that it will not come to a node that is left."""
    nodes = {node.node_id for node in state.node_states}
    faults = (fault for fault in state.errors if _kind(fault) == _UNREACHABLE)
    return next((f for f in faults if any(f.refers("nodeId", node) for node in nodes)), None)


def recalled(kept: RememberedTask, now: float) -> Task:
    """Return the task that was kept; raises Vda5050Error where it cannot be read."""
    try:
        message = decode_answer(kept.op, parse_params(kept.op, kept.params))
    except ValueError as error:
        raise Vda5050Error(f"the task that was kept cannot be read ({error}); delete the memory") from None
    if not isinstance(message, SetPosEnd | SetPath):
        raise Vda5050Error(f"the task that was kept is a {kept.op}; delete the memory")
    task = Task(kept.command, message, now, accepted=kept.accepted, acknowledged=kept.acknowledged)
    task.plan, task.passed, task.resumed = kept.plan, kept.passed, kept.resumed
    task.is_confirmed = kept.acknowledged
    return task


def _passed(state: State) -> int:
    """Return the last node that was passed; a new order may still show the number of the one before it."""
    if state.node_states:
        return max(0, min(node.sequence_id for node in state.node_states) // 2 - 1)
    return state.last_node_sequence_id // 2


def _reasons(state: State, text: str) -> str:
    faults = [fault.summary for fault in state.errors]
    return f"{text}: {'; '.join(faults)}" if faults else text
