"""What the operator is told before a plan is sent, and after."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ....robot_bridge.assignment.job import Robot
from ....robot_bridge.assignment.plan import Plan, RobotPlan
from ....robot_bridge.messages import QueueReport, QueueState, RobotState, TaskState
from ...language import first_of, tr, tr_count
from ..desk import Desk
from ..state_words import ROBOT_STATES
from .draft import Draft
from .plan_rows import summary

MOVED = 1.0
"""Metres that a robot may have moved since the plan was made."""

LISTED = 5
"""Robots, doubts, closed ways and meetings that the question names: it has to fit on a screen."""


def before_sending(desk: Desk, draft: Draft) -> str:
    """Return what sending will do, and what speaks against it."""
    driving = [one for one in draft.plan.robots if one.stops and not one.lost]
    lines = [summary(draft) + ".", ""]
    lines += first_of([f"{one.robot.id}: {_cones(one)}" for one in driving], LISTED)
    doubts = [doubt for one in driving for doubt in _doubts(desk, one.robot)]
    closed = [one.in_words() for one in draft.closed]
    meetings = [meeting.in_words() for meeting in draft.meetings]
    minded = [text for texts in (doubts, closed, meetings) for text in first_of(texts, LISTED)]
    if minded:
        lines += ["", tr("Mind:"), *(f"• {text}" for text in minded)]
    return "\n".join([*lines, "", tr("The robots set off at once.")])


def after_sending(desk: Desk, plan: Plan) -> list[str]:
    """Return which robots do not set off, since somebody holds them."""
    texts = []
    for one in plan.robots:
        report = desk.queues.get(one.robot.id)
        if one.stops and not one.lost and report is not None and report.state is QueueState.PAUSED:
            texts.append(
                tr(
                    "The queue of {robot} stays paused ({reason}): its cones wait until it is resumed.",
                    robot=report.robot,
                    reason=report.reason or "",
                )
            )
    return texts


def _cones(one: RobotPlan) -> str:
    return tr_count(sum(stop.is_target for stop in one.stops), "1 cone", "%n cones")


def _doubts(desk: Desk, robot: Robot) -> list[str]:
    queue = desk.queues.get(robot.id)
    return [*_doubts_of_place(desk, robot), *(_doubts_of_queue(queue) if queue is not None else ())]


def _doubts_of_place(desk: Desk, robot: Robot) -> Iterator[str]:
    """Yield whether the robot is elsewhere than where the plan begins, or away."""
    view = desk.picture.view(robot.id, desk.clock())
    if view is None or not view.has_pose:
        yield tr("it is not known where {id} is", id=robot.id)
        return
    away = math.hypot(view.report.x - robot.x, view.report.y - robot.y)
    if away > MOVED:
        yield tr("{id} is {away:.1f} m from where the plan begins: better plan anew", id=robot.id, away=away)
    if view.state not in (RobotState.FRESH, RobotState.STALE):
        yield tr(
            "{id} is {state}: it gets its queue when it is heard of again",
            id=robot.id,
            state=ROBOT_STATES[view.state],
        )


def _doubts_of_queue(queue: QueueReport) -> Iterator[str]:
    """Yield what becomes of the tasks that are in the robot's queue already."""
    waiting = sum(task.state is not TaskState.CURRENT for task in queue.tasks)
    if waiting:
        yield tr_count(
            waiting,
            "1 task that waits in the queue of {id} is replaced",
            "%n tasks that wait in the queue of {id} are replaced",
            id=queue.robot,
        )
    if waiting < len(queue.tasks):
        yield tr("{id} finishes first what it is doing", id=queue.robot)
    if queue.state is QueueState.PAUSED:
        yield tr(
            "the queue of {id} is paused ({reason}): it is resumed",
            id=queue.robot,
            reason=queue.reason or tr("no reason"),
        )
