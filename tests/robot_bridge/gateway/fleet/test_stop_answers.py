"""What each robot said to an emergency stop is counted once, and a later word says more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.core.messages.commands import CommandReport, CommandState
from robot_bridge.gateway.model.arrival import MOST_NAMES, STILL_FOR, StopAnswers
from robot_bridge.gateway.model.robot_columns import (
    ACCURACY,
    DOUBTED,
    FRESH,
    LOCATED,
    LOST,
    NUMBERS,
    STALE,
    RobotPlaces,
    V,
    X,
    Y,
)


def report(state, robot="r1", op="Abort", params=None):
    return CommandReport(
        "c-1", robot, op, {"emergency": True} if params is None else params, "Ada", state, []
    )


@pytest.fixture
def counters():
    counters = StopAnswers()
    counters.begin(["r2", "r1"])
    return counters


def counts(counters):
    return tuple(counters.counts().values())[:5]


def see(counters, now, robot="r1", x=0.0, v=0.0, state=FRESH, flags=LOCATED, accuracy=math.nan):
    """Have the tally take in where a robot is at ``now``."""
    table = np.full((NUMBERS, 1), math.nan)
    table[[X, Y, V, ACCURACY], 0] = x, 0.0, v, accuracy
    return counters.observe(RobotPlaces([robot], table, np.array([state]), np.array([flags])), now)


def seen(counters):
    counts = counters.counts()
    return counts["standing"], counts["moving"], counts["unheard"]


def test_it_is_counted_under_the_names_of_the_report(counters):
    assert counters.counts() == {
        "robots": 2,
        "acknowledged": 0,
        "standing": 0,
        "waiting": ["r1", "r2"],
        "refused": [],
        "moving": [],
        "moving_more": 0,
        "unheard": [],
        "unheard_more": 0,
    }


def test_a_robot_comes_from_refusing_to_acknowledging_to_standing_and_never_back(counters):
    see(counters, 0.0)
    steps = [CommandState.FAILED, CommandState.ACKNOWLEDGED, CommandState.REACHED]
    assert [counters.note_step(report(state)) for state in steps] == [True, True, True]
    assert counts(counters) == (2, 1, 1, ["r2"], [])
    assert [counters.note_step(report(state)) for state in steps] == [False, False, False]
    assert not counters.answer("r1", refused=True)
    assert counts(counters) == (2, 1, 1, ["r2"], [])


def test_the_answer_to_the_direct_call_counts_like_that_to_the_command(counters):
    assert counters.answer("r1", refused=True)
    assert counts(counters) == (2, 0, 0, ["r2"], ["r1"])
    assert counters.answer("r1", refused=False)
    assert counts(counters) == (2, 1, 0, ["r2"], [])
    see(counters, 0.0, "r2")
    assert counters.note_step(report(CommandState.REACHED, "r2"))
    assert counts(counters) == (2, 2, 1, [], [])


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
def test_what_becomes_of_anything_else_says_nothing(counters, other):
    assert counters.note_step(other) is False
    assert counts(counters) == (2, 0, 0, ["r1", "r2"], [])


def test_a_robot_that_starts_while_it_is_in_force_is_waited_for(counters):
    counters.answer("r1", refused=False)
    counters.note_sent("r1")
    counters.note_sent("r3")
    assert counts(counters) == (3, 0, 0, ["r1", "r2", "r3"], [])


def test_a_robot_that_is_forgotten_is_waited_for_no_more(counters):
    assert counters.forget("r1") is True
    assert counters.forget("r1") is False
    assert counters.forget("nobody") is False
    assert counts(counters) == (1, 0, 0, ["r2"], [])


def test_a_second_stop_is_counted_from_nought(counters):
    counters.answer("r1", refused=False)
    counters.begin(["r1"])
    assert counts(counters) == (1, 0, 0, ["r1"], [])


def test_so_many_robots_are_named_and_all_are_counted():
    counters = StopAnswers()
    names = [f"r{k:03}" for k in range(MOST_NAMES + 1)]
    counters.begin(reversed(names))
    assert counters.counts()["waiting"] == names[:MOST_NAMES]
    assert counters.counts()["robots"] == MOST_NAMES + 1
    for robot in names:
        see(counters, 0.0, robot, v=1.0)
    assert (counters.counts()["moving"], counters.counts()["moving_more"]) == (names[:MOST_NAMES], 1)


# --- what robots said, against where they are ---------------------------------------------------------------


@pytest.fixture
def standing(counters):
    counters.note_step(report(CommandState.REACHED))
    assert seen(counters) == (0, [], ["r1"])
    assert see(counters, 100.0)
    assert seen(counters) == (1, [], [])
    return counters


def test_a_robot_that_drives_does_not_stand_whatever_it_said(standing):
    assert see(standing, 101.0, x=0.1, v=-0.2)
    assert seen(standing) == (0, ["r1"], [])
    assert (standing.disobeying(), standing.disobeying()) == (["r1"], [])
    # Once it says that it has no speed it stands where it is then.
    assert see(standing, 102.0, x=5.0)
    assert seen(standing) == (1, [], [])


def test_a_robot_without_speed_that_comes_further_moves_until_it_has_rested(standing):
    for second in range(20):
        see(standing, 101.0 + second, x=0.1 * second)
        assert (second < 4) or seen(standing) == (0, ["r1"], []), second
    assert not see(standing, 120.0 + STILL_FOR - 2.0, x=1.9)
    assert see(standing, 120.0 + STILL_FOR, x=1.9)
    assert seen(standing) == (1, [], [])


@pytest.mark.parametrize(("accuracy", "x"), [(math.nan, 0.29), (0.2, 0.55)])
def test_positions_that_are_not_exact_are_no_movement(standing, accuracy, x):
    see(standing, 101.0, x=x, accuracy=accuracy)
    assert seen(standing) == (1, [], [])


def test_positions_of_no_accuracy_at_all_hide_no_movement(standing):
    see(standing, 101.0, x=1.5, accuracy=30.0)
    assert seen(standing) == (0, ["r1"], [])


@pytest.mark.parametrize(
    "how", [{"state": STALE}, {"state": LOST}, {"flags": 0}, {"flags": LOCATED | DOUBTED}]
)
def test_of_a_robot_that_is_not_heard_nobody_knows(standing, how):
    assert see(standing, 101.0, **how)
    assert seen(standing) == (0, [], ["r1"])
    assert see(standing, 102.0)
    assert seen(standing) == (1, [], [])


def test_a_robot_that_has_not_answered_and_drives_is_named(counters):
    see(counters, 100.0, "r2", v=1.0)
    assert seen(counters) == (0, ["r2"], [])
    assert counts(counters)[3] == ["r1", "r2"]
    assert not see(counters, 101.0, "nobody", v=1.0)
