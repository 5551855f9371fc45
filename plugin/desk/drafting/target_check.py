"""Whether a target is clear of those of other robots."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from ....robot_bridge.messages import CommandReport, QueueReport, SetPath, SetPosEnd, TaskState
from ...language import tr
from ..drafts import START, TARGETS, Draft, Findings, Point

CLEAR_M = 1.0
"""Metres between the targets of two robots."""


def check_targets(
    draft: Draft, under_way: Iterable[CommandReport], queues: Iterable[QueueReport]
) -> Findings:
    """Find the targets of other robots, now or in their queues, that a draft ends too near to."""
    if draft.kind == START:
        return Findings()
    ends = draft.points if draft.kind == TARGETS else draft.points[-1:]
    taken = [*_now(under_way), *_later(queues)]
    found = []
    for x, y in ends:
        for robot, what, (other_x, other_y) in taken:
            away = math.hypot(x - other_x, y - other_y)
            if robot != draft.robot and away < CLEAR_M:
                found.append(
                    tr(
                        "({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, "
                        "{other_y:.2f}: keep {clear_m:g} m between targets.",
                        x=x,
                        y=y,
                        away=away,
                        what=what,
                        robot=robot,
                        other_x=other_x,
                        other_y=other_y,
                        clear_m=CLEAR_M,
                    )
                )
    return Findings(overridable=tuple(dict.fromkeys(found)))


def _now(under_way: Iterable[CommandReport]) -> Iterator[tuple[str, str, Point]]:
    for report in under_way:
        if report.op == SetPosEnd.__name__:
            yield report.robot, tr("the target"), (report.params["x"], report.params["y"])
        elif report.op == SetPath.__name__:
            x, y = report.params["points"][-1]
            yield report.robot, tr("the end of the route"), (x, y)


def _later(queues: Iterable[QueueReport]) -> Iterator[tuple[str, str, Point]]:
    for queue in queues:
        for task in queue.tasks:
            if task.state is TaskState.CURRENT:
                # It is under way, as a command.
                continue
            yield queue.robot, tr("a task"), (task.x, task.y)
