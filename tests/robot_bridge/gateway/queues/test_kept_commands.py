"""What a command beside the queue becomes when it is kept: the same drive, to the same place."""

from __future__ import annotations

import dataclasses

import pytest

from robot_bridge.core.messages.queues import QueueState, TaskKind, TaskState
from robot_bridge.core.messages.robots import SetPath, SetPosEnd
from robot_bridge.gateway.commands.active_command import CommandOrder, create_command
from robot_bridge.gateway.model.task_queue import Queue
from robot_bridge.gateway.queues.task_life import (
    commands_of_task,
    pause_with_task,
    task_of_command,
    task_of_rest,
)

BENEATH, AHEAD = (0.0, 0.0), (0.4, 0.1)
LINE = [(10.0, 0.0), (20.0, 0.0)]


def ordered(message):
    return create_command(CommandOrder("command-x", "r1", message, "Ada"), 1000.0)


@pytest.mark.parametrize("offset", [BENEATH, AHEAD], ids=["cone beneath", "cone ahead"])
@pytest.mark.parametrize(
    "message",
    [
        SetPosEnd(20.0, 5.0),
        SetPosEnd(20.0, 5.0, 1.0),
        SetPosEnd(20.0, 5.0, 1.0, cone=True),
        SetPosEnd(20.0, 5.0, 1.0, collect=True),
        SetPath(LINE),
        SetPath(LINE, 1.0),
    ],
)
def test_the_kept_task_is_driven_by_the_message_that_it_was_made_of(message, offset):
    kept = task_of_command(ordered(message), offset, (10.0, 0.0))
    (again,) = commands_of_task(kept.task, offset)
    if isinstance(message, SetPosEnd):
        assert (again.x, again.y) == pytest.approx((message.x, message.y))
        again = dataclasses.replace(again, x=message.x, y=message.y)
    assert again == message
    assert (kept.command, kept.state, kept.attempts, kept.added_by, kept.added_at) == (
        "command-x",
        TaskState.CURRENT,
        1,
        "Ada",
        1000.0,
    )


def test_a_cone_without_a_heading_is_kept_also_where_nobody_can_say_where_it_stands():
    kept = task_of_command(ordered(SetPosEnd(20.0, 5.0, cone=True)), AHEAD, None)
    assert (kept.task.kind, kept.task.x, kept.task.y) == (TaskKind.PLACE, 20.0, 5.0)


@pytest.mark.parametrize(
    ("here", "points"),
    [(None, LINE), ((8.5, 0.0), LINE), ((15.0, 1.0), LINE), ((5.0, 3.0), [(5.0, 3.0), *LINE])],
    ids=["unknown", "at it", "along it already", "on its way"],
)
def test_a_path_begins_where_the_robot_is_on_its_way_to_it(here, points):
    assert task_of_command(ordered(SetPath(LINE)), BENEATH, here).task.path == points


def test_a_path_that_was_begun_is_not_begun_anew():
    begun = ordered(SetPath(LINE)).judged(0.2)
    begun.arrival.driven = 6.0
    assert task_of_command(begun, BENEATH, (16.0, 3.0)).task.path == LINE


def test_what_is_driven_and_what_comes_after_waiting_are_two_tasks():
    first = task_of_command(ordered(SetPath(LINE)), BENEATH, None)
    rest = task_of_rest(SetPath([LINE[-1], (30.0, 0.0)]), BENEATH, "command-x", "Bob", 5.0)
    assert first.id != rest.id
    assert (rest.state, rest.command, rest.added_by) == (TaskState.WAITING, None, "Bob")


def test_a_queue_that_is_paused_already_says_who_halted_its_robot():
    kept = task_of_command(ordered(SetPath(LINE)), BENEATH, None)
    before = Queue("r1", 3, QueueState.PAUSED, reason="other", by="Ada", at=1.0)
    after = pause_with_task(before, [kept], "paused by Eve", "Eve", 2.0)
    assert (after.revision, after.reason, after.by, after.at) == (4, "paused by Eve", "Eve", 2.0)
    assert after.current is kept
