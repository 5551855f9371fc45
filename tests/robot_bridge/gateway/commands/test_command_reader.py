"""What the open commands tell of a robot: what it does, what it was told to give up, what waits for it."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.commands import CommandState
from robot_bridge.core.messages.robots import SetPosIni
from robot_bridge.gateway.commands.validation import ActiveCommands, CommandReader
from tests.robot_bridge.gateway.commands.command_makers import (
    ABORT,
    ACKNOWLEDGED,
    DELIVERED,
    EMERGENCY,
    PATH,
    TARGET,
    command,
)

BEGIN = SetPosIni(1.0, 2.0)


def reader(*commands):
    found = ActiveCommands()
    for one in commands:
        found.add(one)
    return CommandReader(found)


def test_of_nothing_nothing_is_told():
    empty = reader()
    assert (empty.busy_with("r1"), empty.task("r1"), empty.line("r1"), empty.carried_out("r1")) == (None,) * 4
    assert (empty.is_open("c-1"), empty.robot_of("c-1"), empty.undelivered(), empty.robots()) == (
        False,
        None,
        {},
        set(),
    )
    assert not empty.awaits_abort("r1") and not empty.awaits_stop("r1") and empty.count() == {}
    assert not empty.is_carrying_out("r1", "c-1") and not empty.is_being_aborted("r1", "c-1")


def test_the_newest_that_drives_is_what_the_robot_does():
    driving, newer = command(1, TARGET, DELIVERED, ACKNOWLEDGED), command(2, PATH)
    found = reader(driving, newer, command(3, BEGIN), command(4, ABORT))
    assert found.busy_with("r1") == "c-2"
    assert found.task("r1") == (PATH, 0.0)
    assert found.robot_of("c-1") == "r1" and found.is_open("c-1")
    assert found.robots() == {"r1"}
    assert found.count() == {CommandState.QUEUED: 3, CommandState.ACKNOWLEDGED: 1}
    assert found.undelivered() == {2: "r1", 3: "r1", 4: "r1"}
    assert reader(command(3, BEGIN)).task("r1") is None
    assert found.busy_with("r2") is None


def test_of_a_path_that_was_taken_on_it_is_told_how_far_the_robot_is():
    taken = command(1, PATH, DELIVERED, ACKNOWLEDGED).judged(0.2)
    taken.arrival.driven = 3.5
    found = reader(taken, command(2, BEGIN))
    assert found.task("r1") == (PATH, 3.5)
    assert found.line("r1") is taken.line
    assert reader(taken, command(2, PATH)).line("r1") is None


@pytest.mark.parametrize(
    ("others", "carries_out", "is_being_aborted"),
    [
        ([], True, False),
        ([command(2, ABORT)], False, True),
        ([command(2, ABORT, DELIVERED, ACKNOWLEDGED)], False, True),
        ([command(2, EMERGENCY)], False, False),
        ([command(2, ABORT), command(3, EMERGENCY)], False, False),
        ([command(0, ABORT)], True, False),
        ([command(2, PATH)], False, False),
        ([command(2, BEGIN)], True, False),
    ],
)
def test_a_task_is_carried_out_until_somebody_asked_for_its_end(others, carries_out, is_being_aborted):
    task = command(1, TARGET, DELIVERED, ACKNOWLEDGED)
    found = reader(task, *others)
    assert found.is_carrying_out("r1", "c-1") is carries_out
    assert found.is_being_aborted("r1", "c-1") is is_being_aborted
    assert (found.carried_out("r1") is task) is carries_out


def test_a_command_that_is_not_open_is_neither_carried_out_nor_aborted():
    found = reader(command(1), command(2, ABORT))
    assert not found.is_carrying_out("r1", "c-9") and not found.is_being_aborted("r1", "c-9")
    assert not found.is_carrying_out("r2", "c-1")
    assert found.carried_out("r1") is None


@pytest.mark.parametrize(
    ("message", "states", "abort", "stop"),
    [
        (ABORT, (), True, False),
        (ABORT, (DELIVERED,), True, False),
        (ABORT, (DELIVERED, ACKNOWLEDGED), False, False),
        (EMERGENCY, (), False, True),
        (EMERGENCY, (DELIVERED,), False, True),
        (EMERGENCY, (DELIVERED, ACKNOWLEDGED), False, False),
        (TARGET, (), False, False),
    ],
)
def test_an_abort_is_awaited_until_the_robot_took_it_on_and_each_kind_for_itself(
    message, states, abort, stop
):
    found = reader(command(1, message, *states))
    assert (found.awaits_abort("r1"), found.awaits_stop("r1")) == (abort, stop)
    assert found.awaits_any_abort("r1") is (abort or stop)
    assert not found.awaits_abort("r2") and not found.awaits_stop("r2") and not found.awaits_any_abort("r2")
