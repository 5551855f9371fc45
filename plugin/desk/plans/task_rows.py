"""A plan as tasks for the robots' queues."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ....robot_bridge.assignment.job import COLLECT, PLACE
from ....robot_bridge.assignment.plan import HOME, STORE, Plan, RobotPlan, Stop
from ....robot_bridge.messages import QueueTask, TaskKind
from .cone_source import ConeFacts

_KINDS = {PLACE: TaskKind.PLACE, COLLECT: TaskKind.COLLECT}
_LABELS = {STORE: "store", HOME: "end"}


@dataclass(frozen=True)
class SentStop:
    """A stop of the plan that was sent: who makes it, as which number of its day, by which task."""

    robot: str
    number: int
    stop: Stop
    task: str


def tasks_of(
    plan: Plan,
    name: str,
    facts: Mapping[str, ConeFacts],
    new_id: Callable[[], str] = lambda: str(uuid.uuid4()),
    under_way: Mapping[str, SentStop] | None = None,
) -> dict[str, list[QueueTask]]:
    """Return the tasks of each robot that is not lost, in their order; ``name`` is the plan's own.

    A cone comes after all cones of lower stages that other robots see to, also those that they are at
    (``under_way``, by the robot).

    :raises MessageError: naming a task that no gateway would take.
    """
    staying = [one for one in plan.robots if not one.lost]
    ids = {one.robot.id: [new_id() for _ in one.stops] for one in staying}
    stages = {target.id: target.stage for target in plan.targets}
    staged: dict[int, list[tuple[str, str]]] = {}
    for one in staying:
        sent = list(zip(one.stops, ids[one.robot.id], strict=True))
        now = (under_way or {}).get(one.robot.id)
        if now is not None:
            sent.append((now.stop, now.task))
        for stop, task in sent:
            if stop.is_target:
                staged.setdefault(stages[stop.id], []).append((one.robot.id, task))

    def after(robot: str, stop: Stop) -> list[str] | None:
        lower = [stage for stage in sorted(staged) if stop.is_target and stage < stages[stop.id]]
        return [task for stage in lower for by, task in staged[stage] if by != robot] or None

    return {
        one.robot.id: [
            _task(stop, name, facts, task, after(one.robot.id, stop))
            for stop, task in zip(one.stops, ids[one.robot.id], strict=True)
        ]
        for one in staying
    }


def sent_stops(one: RobotPlan, tasks: list[QueueTask]) -> list[SentStop]:
    """Return the stops of one robot together with the tasks that :func:`tasks_of` made of them."""
    return [
        SentStop(one.robot.id, number, stop, task.task)
        for number, (stop, task) in enumerate(zip(one.stops, tasks, strict=True))
    ]


def _task(
    stop: Stop, name: str, facts: Mapping[str, ConeFacts], task: str, after: list[str] | None
) -> QueueTask:
    path = [*stop.path[:-1], (stop.x, stop.y)]
    if not stop.is_target:
        label = f"{_LABELS[stop.kind]} {stop.id}"
        return QueueTask(task, stop.x, stop.y, path=path, label=label, plan=name)
    known = facts[stop.id]
    # A collected cone is approached as it was placed, a placed one in its own heading.
    theta = known.theta if stop.kind == COLLECT else stop.theta
    return QueueTask(
        task, stop.x, stop.y, theta, _KINDS[stop.kind], path, known.cone, stop.id, known.layout, name,
        known.placement, after,
    )  # fmt: skip
