"""What becomes of a queue whose robot is ordered about beside it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from robot_bridge.core.messages.robots import Abort, SetPosEnd, SetPosIni
from robot_bridge.gateway.commands.active_command import CommandOrder
from robot_bridge.gateway.commands.persistence import _held

TARGET = SetPosEnd(1.0, 2.0)
STEP = SimpleNamespace(at=5.0)
COMMAND = SimpleNamespace(report=SimpleNamespace(steps=[STEP]))


def held(message, **order):
    draft = SimpleNamespace(order=CommandOrder("command-a", "r1", message, "Ada", **order), command=COMMAND)
    return _held(draft)


@pytest.mark.parametrize(
    ("message", "reason", "said"),
    [
        (TARGET, None, "Ada ordered SetPosEnd beside the queue"),
        (Abort(), None, "aborted by Ada"),
        (Abort(), "smoke", "aborted by Ada: smoke"),
        (Abort(emergency=True), None, "emergency stop by Ada"),
    ],
)
def test_a_queue_is_paused_with_what_was_ordered_beside_it(message, reason, said):
    hold = held(message, reason=reason)
    assert (hold.robot, hold.reason, hold.by, hold.at) == ("r1", said, "Ada", 5.0)


def test_neither_a_task_of_the_queue_nor_where_a_track_begins_pauses_it():
    assert held(SetPosIni(1.0, 2.0)) is None
    assert held(TARGET, task="task-0001") is None
