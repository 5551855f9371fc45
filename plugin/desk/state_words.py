"""States in the operator's language; in layers, expressions and files they stay as the protocol has them."""

from __future__ import annotations

from ...robot_bridge.messages import CommandState, RobotState, TaskState
from ..language import tr

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
"""How two robots come into each other's way, by the kind of a ConflictReport."""


def longest(words: dict) -> str:
    """Return the word that needs the widest column."""
    return max(words.values(), key=len)
