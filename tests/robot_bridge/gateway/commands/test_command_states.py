"""The life of a command, state by state, against the design's drawing."""

from __future__ import annotations

import itertools

import pytest

from robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from robot_bridge.gateway.commands.active_command import CommandLifeError, advance, may_become, note

ENDS = {"reached", "aborted", "failed", "expired", "superseded"}
MAY_BECOME = {
    "queued": {"delivered", "acknowledged"} | ENDS,
    "delivered": {"acknowledged"} | ENDS,
    "acknowledged": ENDS,
    **{end: set() for end in ENDS},
}
PAIRS = list(itertools.product(CommandState, CommandState))


def command(state: CommandState) -> CommandReport:
    return CommandReport(
        "c-1", "r1", "Abort", {}, "Ada", state, [CommandStep(CommandState.QUEUED, 1.0, "Ada")]
    )


def test_the_table_knows_every_state():
    assert set(MAY_BECOME) == {state.value for state in CommandState}


@pytest.mark.parametrize(("now", "then"), PAIRS)
def test_a_command_takes_the_steps_of_the_table_and_no_other(now, then):
    allowed = then.value in MAY_BECOME[now.value]
    assert may_become(now, then) is allowed
    if allowed:
        moved = advance(command(now), then, 2.0, "gateway", "because", 0.1)
        assert moved.state is then
        assert moved.steps[-1] == CommandStep(then, 2.0, "gateway", "because")
        assert len(moved.steps) == 2
        assert moved.deviation == 0.1
    else:
        with pytest.raises(CommandLifeError, match=f"c-1 is {now.value} and cannot become {then.value}"):
            advance(command(now), then, 2.0, "gateway")


@pytest.mark.parametrize("state", CommandState)
def test_a_command_is_open_as_long_as_a_step_may_come(state):
    assert state.is_open is bool(MAY_BECOME[state.value])


def test_a_note_adds_a_line_and_changes_no_state():
    noted = note(command(CommandState.ACKNOWLEDGED), 3.0, "gateway", "sent once more")
    assert noted.state is CommandState.ACKNOWLEDGED
    assert noted.steps[-1] == CommandStep(CommandState.ACKNOWLEDGED, 3.0, "gateway", "sent once more")


def test_a_deviation_known_stays_known():
    reached = advance(command(CommandState.ACKNOWLEDGED), CommandState.REACHED, 2.0, "gateway", None, 0.07)
    assert note(reached, 3.0, "gateway", "x").deviation == 0.07


def test_where_a_robot_stood_and_how_far_off_stay_known_until_they_are_told_otherwise():
    stood = (1.0, 2.0, 3.0)
    taken = advance(command(CommandState.QUEUED), CommandState.DELIVERED, 2.0, "gateway", None, 0.07, stood)
    later = advance(taken, CommandState.ACKNOWLEDGED, 3.0, "r1")
    assert (later.deviation, later.stood) == (0.07, stood)
    reached = advance(later, CommandState.REACHED, 4.0, "gateway", None, 0.09, (4.0, 5.0, 6.0))
    assert (reached.deviation, reached.stood) == (0.09, (4.0, 5.0, 6.0))
