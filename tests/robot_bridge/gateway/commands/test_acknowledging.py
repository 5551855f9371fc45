"""What a robot's answer to one command does to all of them, and what it forgets when it starts again."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.commands import ABORT_VALID_S
from robot_bridge.core.messages.robots import OpAck
from robot_bridge.gateway.commands.active_command import acknowledge_command, restart_commands
from robot_bridge.gateway.model.arrival import TargetArrival
from tests.robot_bridge.gateway.commands.command_makers import (
    ABORT,
    ACKNOWLEDGED,
    DELIVERED,
    EMERGENCY,
    PATH,
    TARGET,
    command,
    last,
    pose,
)

TOLERANCE = 0.2
OK = OpAck(id=1)


def steps(made, ack=OK, mine=(), unseen=False):
    found = acknowledge_command(made, ack, list(mine), 200.0, TOLERANCE, unseen=unseen)
    return [(step.report.command, *last(step)) for step in found]


def test_a_refusal_fails_the_command_with_the_robot_s_reason():
    for made in (command(1), command(1, TARGET, DELIVERED, ACKNOWLEDGED)):
        refusal = OpAck(id=1, ok=False, reason="no brakes")
        assert steps(made, refusal, [made]) == [("c-1", "failed", 200.0, "r1", "no brakes")]


def test_what_a_robot_answers_to_has_reached_it():
    assert steps(command(1)) == [
        ("c-1", "delivered", 200.0, "gateway", None),
        ("c-1", "acknowledged", 200.0, "r1", None),
    ]
    assert steps(command(1, TARGET, DELIVERED)) == [("c-1", "acknowledged", 200.0, "r1", None)]


def test_what_was_taken_on_is_judged_from_then_on():
    (taken,) = acknowledge_command(command(1, TARGET, DELIVERED), OK, [], 200.0, TOLERANCE, unseen=False)
    assert taken.arrival == TargetArrival(TARGET, TOLERANCE)


def test_an_acknowledgement_said_twice_is_noted_once_and_judged_only_where_it_was_sent_twice():
    taken = command(1, TARGET, DELIVERED, ACKNOWLEDGED)
    assert steps(taken.judged(TOLERANCE)) == []
    assert steps(taken) == [("c-1", "acknowledged", 200.0, "r1", "acknowledged again")]
    (again,) = acknowledge_command(taken, OK, [], 200.0, TOLERANCE, unseen=False)
    assert again.arrival == TargetArrival(TARGET, TOLERANCE)


def test_an_abort_that_is_taken_on_ends_what_came_before_it():
    mine = [command(1, TARGET, ACKNOWLEDGED).judged(TOLERANCE), command(2, PATH, DELIVERED), command(9)]
    abort = command(5, ABORT, DELIVERED, reason="smoke")
    ends = [
        ("c-1", "aborted", 200.0, "Ada", "the robot acknowledged the Abort: smoke"),
        ("c-2", "aborted", 200.0, "Ada", "the robot acknowledged the Abort: smoke"),
    ]
    taken = ("c-5", "acknowledged", 200.0, "r1", None)
    assert steps(abort, OpAck(id=5), [*mine, abort]) == [taken, *ends]
    # Nobody saw it lately: what it had taken on may have been done before the Abort came.
    assert steps(abort, OpAck(id=5), [*mine, abort], unseen=True) == [taken, ends[1]]


# --- a robot that starts again ------------------------------------------------------------------------------

REASON = "the robot said Ready again"
AFTER = 300.0


def seen(robot):
    assert robot == "r1"
    return pose(3.0, 4.0)


def anew(mine, now=200.0):
    return restart_commands(mine, REASON, now, AFTER, seen)


def test_a_robot_that_has_nothing_open_is_sent_nothing():
    assert anew([]) == ([], [])


def test_what_was_never_fetched_is_written_behind_the_map_but_for_an_abort_before_it():
    mine = [command(1, EMERGENCY), command(2, ABORT), command(3, PATH), command(4, ABORT)]
    again, ended = anew(mine)
    assert [one.report.command for one in again] == ["c-4"]
    assert [one.report.command for one in ended] == ["c-3"]
    again, ended = anew([command(1, ABORT), command(2, TARGET)])
    assert ([one.report.command for one in again], ended) == (["c-2"], [])
    assert anew([command(1, EMERGENCY), command(2, ABORT)]) == ([], [])


def test_what_it_had_and_what_waits_behind_that_is_sent_once_more_and_not_judged():
    mine = [
        command(1),
        command(2, PATH, DELIVERED, ACKNOWLEDGED, out_of_sight=True).judged(TOLERANCE),
        command(3, out_of_sight=True),
    ]
    again, ended = anew(mine)
    assert ended == []
    assert [(one.report.command, *last(one)) for one in again] == [
        ("c-1", "queued", 200.0, "gateway", "sent after what is sent to the robot again"),
        ("c-2", "acknowledged", 200.0, "gateway", REASON),
        ("c-3", "queued", 200.0, "gateway", "sent after what is sent to the robot again"),
    ]
    for one in again:
        assert (one.written_at, one.handed, one.out_of_sight, one.arrival) == (
            200.0,
            pose(3.0, 4.0),
            False,
            None,
        )


def test_an_abort_ended_what_came_before_it_and_is_sent_once_more():
    task, abort = command(1, TARGET, ACKNOWLEDGED), command(2, ABORT, DELIVERED, reason="smoke")
    again, ended = anew([task, abort])
    assert [one.report.command for one in again] == ["c-2"]
    assert [(one.report.command, *last(one)) for one in ended] == [
        ("c-1", "aborted", 200.0, "Ada", "the robot started anew: smoke")
    ]


def test_what_is_too_old_is_given_up_unless_the_robot_had_taken_it_on():
    mine = [
        command(1, TARGET, DELIVERED, ACKNOWLEDGED),
        command(2, PATH, DELIVERED),
        command(3),
        command(4, EMERGENCY, DELIVERED),
    ]
    again, ended = anew(mine[:1] + mine[1:3], now=100.0 + AFTER)
    assert [one.report.command for one in again] == ["c-1"]
    assert [(one.report.command, *last(one)) for one in ended] == [
        (id, "expired", 400.0, "gateway", "the robot restarted when the command had expired")
        for id in ("c-3", "c-2")
    ]
    again, _ = anew(mine[1:2] + mine[3:], now=100.0 + AFTER)
    assert [one.report.command for one in again] == ["c-4"]


def test_of_two_ends_of_one_command_the_first_counts():
    task, abort = command(1, TARGET, DELIVERED), command(2, ABORT, DELIVERED)
    _, ended = anew([task, abort], now=100.0 + ABORT_VALID_S)
    assert {one.report.command: last(one)[0] for one in ended} == {"c-1": "aborted", "c-2": "expired"}


@pytest.mark.parametrize(("message", "written"), [(TARGET, ["c-1", "c-2"]), (EMERGENCY, ["c-2"])])
def test_an_abort_that_waits_before_all_else_stays_where_it_is(message, written):
    again, ended = anew([command(1, message), command(2, PATH, DELIVERED)])
    assert ([one.report.command for one in again], ended) == (written, [])
