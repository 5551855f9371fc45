"""States of robots, commands, tasks and queues in words for the operator."""

from __future__ import annotations

from collections.abc import Iterable

from ...robot_bridge.core.messages.commands import CommandState
from ...robot_bridge.core.messages.queues import QueueReport, QueueState, TaskKind, TaskReport, TaskState
from ...robot_bridge.core.messages.safety import RobotState
from ..ui.language import time_of_day, tr, tr_count
from .robot_states import STATES, UNSURE, RobotStates, RobotView

ROBOT_STATES = {
    RobotState.FRESH: tr("fresh"),
    RobotState.STALE: tr("stale"),
    RobotState.LOST: tr("lost"),
    RobotState.OFFLINE: tr("offline"),
}
COMMAND_STATES = {
    CommandState.QUEUED: tr("queued"),
    CommandState.DELIVERED: tr("delivered"),
    CommandState.ACKNOWLEDGED: tr("acknowledged"),
    CommandState.REACHED: tr("reached"),
    CommandState.ABORTED: tr("aborted"),
    CommandState.FAILED: tr("failed"),
    CommandState.EXPIRED: tr("expired"),
    CommandState.SUPERSEDED: tr("superseded"),
}
TASK_STATES = {
    TaskState.WAITING: tr("waiting"),
    TaskState.CURRENT: tr("now"),
    TaskState.FAILED: tr("failed"),
    TaskState.DONE: tr("done"),
    TaskState.SKIPPED: tr("skipped"),
    TaskState.REMOVED: tr("removed"),
}
MEETINGS = {
    "head-on": tr("head-on"),
    "crossing": tr("crossing"),
    "following": tr("following"),
    "standing": tr("standing"),
}
"""How two robots will be in each other's way, by the kind of a ConflictReport."""


def part_in_words(robots: RobotStates) -> str:
    """Return how many of all robots the desk receives; empty where it receives every one."""
    if robots.fleet is None:
        return ""
    return tr(
        "This desk is told of {known} of {all} robots: those in view, selected, or with an alarm.",
        known=len(robots),
        all=robots.count,
    )


def longest_word(words: Iterable[str]) -> str:
    """Return the word that needs the widest column."""
    return max(words, key=len)


def display_state_in_words(look: int) -> str:
    """Return the word for a display state: the robot's state, or that it may be elsewhere."""
    return tr("unsure") if look == UNSURE else ROBOT_STATES[STATES[look]]


def robot_state_in_words(view: RobotView) -> str:
    """Return the state of a robot, and whether it may not be where it is shown."""
    state = ROBOT_STATES[view.state]
    return tr("{state}, may be elsewhere", state=state) if view.is_doubted else state


TASK_KINDS = {
    TaskKind.DRIVE: tr("drive"),
    TaskKind.PLACE: tr("place cone"),
    TaskKind.COLLECT: tr("collect cone"),
}


def task_in_words(task: TaskReport) -> str:
    """Return action and place of a task, as in ``place cone K7 at 12.30, 40.00``."""
    name = f" {task.label or task.cone}" if task.label or task.cone else ""
    way = tr(", a path of {path_points} points", path_points=task.path_points) if task.path_points else ""
    return tr(
        "{kind}{name} at {x:.2f}, {y:.2f}{way}",
        kind=TASK_KINDS[task.kind],
        name=name,
        x=task.x,
        y=task.y,
        way=way,
    )


def task_state_in_words(task: TaskReport) -> str:
    """Return the progress of a task, and the reason where there is one."""
    text = TASK_STATES[task.state]
    return f"{text}: {task.reason}" if task.reason else text


def queue_in_words(queue: QueueReport) -> str:
    """Return whether a queue continues, and who paused it when and why."""
    count = tr_count(len(queue.tasks), "1 task", "%n tasks")
    if queue.state is QueueState.PAUSED:
        when = f", {time_of_day(queue.at)}" if queue.at is not None else ""
        # The gateway's reasons name who did it; where they do not, the name stands alone.
        why = queue.reason or (tr("by {by}", by=queue.by) if queue.by else "")
        text = tr(
            "{robot}: {count}, PAUSED{when}{why}",
            robot=queue.robot,
            count=count,
            when=when,
            why=f": {why}" if why else "",
        )
    else:
        text = f"{queue.robot}: {count}, {tr('running') if queue.tasks else tr('nothing to do')}"
    if queue.robot_state in (RobotState.LOST, RobotState.OFFLINE):
        text += tr(
            ". The robot is {state}: it is sent nothing until it is heard again",
            state=ROBOT_STATES[queue.robot_state],
        )
    return text


def last_ended_in_words(queue: QueueReport) -> str:
    """Return the task that ended last; empty where none did."""
    if not queue.ended:
        return ""
    task = queue.ended[0]
    off = "" if task.deviation is None else tr(", {deviation:.2f} m off", deviation=task.deviation)
    why = f": {task.reason}" if task.reason else ""
    return tr(
        "Last: {task} {state} {time}{off}{why}",
        task=task_in_words(task),
        state=TASK_STATES[task.state],
        time=time_of_day(task.ended_at),
        off=off,
        why=why,
    )
