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
) -> dict[str, list[QueueTask]]:
    """Return the tasks of each robot that is not lost, in their order; ``name`` is the plan's own.

    :raises MessageError: naming a task that no gateway would take.
    """
    return {
        one.robot.id: [_task(stop, name, facts, new_id()) for stop in one.stops]
        for one in plan.robots
        if not one.lost
    }


def sent_stops(one: RobotPlan, tasks: list[QueueTask]) -> list[SentStop]:
    """Return the stops of one robot together with the tasks that :func:`tasks_of` made of them."""
    return [
        SentStop(one.robot.id, number, stop, task.task)
        for number, (stop, task) in enumerate(zip(one.stops, tasks, strict=True))
    ]


def _task(stop: Stop, name: str, facts: Mapping[str, ConeFacts], task: str) -> QueueTask:
    path = [*stop.path[:-1], (stop.x, stop.y)]
    if not stop.is_target:
        label = f"{_LABELS[stop.kind]} {stop.id}"
        return QueueTask(task, stop.x, stop.y, path=path, label=label, plan=name)
    known = facts[stop.id]
    # A collected cone is approached as it was placed, a placed one in its own heading.
    theta = known.theta if stop.kind == COLLECT else stop.theta
    return QueueTask(
        task, stop.x, stop.y, theta, _KINDS[stop.kind], path, known.cone, stop.id, known.layout, name,
        known.placement,
    )  # fmt: skip
