"""What each robot said to an emergency stop is counted once, and a later word says more."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.commands import CommandReport, CommandState
from robot_bridge.gateway.fleet.emergency_stop import MOST_NAMES, StopAnswers


def report(state, robot="r1", op="Abort", params=None):
    return CommandReport(
        "c-1", robot, op, {"emergency": True} if params is None else params, "Ada", state, []
    )


@pytest.fixture
def tally():
    tally = StopAnswers()
    tally.begin(["r2", "r1"])
    return tally


def counts(tally):
    return tuple(tally.counts().values())


def test_it_is_counted_under_the_names_of_the_report(tally):
    assert tally.counts() == {
        "robots": 2,
        "acknowledged": 0,
        "standing": 0,
        "waiting": ["r1", "r2"],
        "refused": [],
    }


def test_a_robot_comes_from_refusing_to_acknowledging_to_standing_and_never_back(tally):
    steps = [CommandState.FAILED, CommandState.ACKNOWLEDGED, CommandState.REACHED]
    assert [tally.note_step(report(state)) for state in steps] == [True, True, True]
    assert counts(tally) == (2, 1, 1, ["r2"], [])
    assert [tally.note_step(report(state)) for state in steps] == [False, False, False]
    assert not tally.answer("r1", refused=True)
    assert counts(tally) == (2, 1, 1, ["r2"], [])


def test_the_answer_to_the_direct_call_counts_like_that_to_the_command(tally):
    assert tally.answer("r1", refused=True)
    assert counts(tally) == (2, 0, 0, ["r2"], ["r1"])
    assert tally.answer("r1", refused=False)
    assert counts(tally) == (2, 1, 0, ["r2"], [])
    assert tally.note_step(report(CommandState.REACHED, "r2"))
    assert counts(tally) == (2, 2, 1, [], [])


@pytest.mark.parametrize(
    "other",
    [
        report(CommandState.ACKNOWLEDGED, params={}),
        report(CommandState.ACKNOWLEDGED, params={"emergency": False}),
        report(CommandState.ACKNOWLEDGED, op="SetPosEnd"),
        report(CommandState.ACKNOWLEDGED, op="SetPosEnd", params={"x": 1.0, "y": 2.0}),
        report(CommandState.QUEUED),
        report(CommandState.DELIVERED),
        report(CommandState.ABORTED),
        report(CommandState.EXPIRED),
        report(CommandState.SUPERSEDED),
    ],
)
def test_what_becomes_of_anything_else_says_nothing(tally, other):
    assert tally.note_step(other) is False
    assert counts(tally) == (2, 0, 0, ["r1", "r2"], [])


def test_a_robot_that_starts_while_it_is_in_force_is_waited_for(tally):
    tally.answer("r1", refused=False)
    tally.note_sent("r1")
    tally.note_sent("r3")
    assert counts(tally) == (3, 0, 0, ["r1", "r2", "r3"], [])


def test_a_robot_that_is_forgotten_is_waited_for_no_more(tally):
    assert tally.forget("r1") is True
    assert tally.forget("r1") is False
    assert tally.forget("nobody") is False
    assert counts(tally) == (1, 0, 0, ["r2"], [])


def test_a_second_stop_is_counted_from_nought(tally):
    tally.answer("r1", refused=False)
    tally.begin(["r1"])
    assert counts(tally) == (1, 0, 0, ["r1"], [])


def test_so_many_robots_are_named_and_all_are_counted():
    tally = StopAnswers()
    names = [f"r{k:03}" for k in range(MOST_NAMES + 1)]
    tally.begin(reversed(names))
    assert tally.counts()["waiting"] == names[:MOST_NAMES]
    assert tally.counts()["robots"] == MOST_NAMES + 1
