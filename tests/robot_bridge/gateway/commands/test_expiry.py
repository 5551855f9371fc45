"""A command that nobody fetched is given up in time, and when it cannot be known how old it is."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.robots import Abort, SetPosEnd
from robot_bridge.gateway.commands.active_command import CommandOrder, create_command

ISSUED = 1_790_000_000.0
AFTER = 300.0


def command(message=None, expires_in=None):
    return create_command(
        CommandOrder("command-1", "r1", message or SetPosEnd(1.0, 2.0), "Ada", None, expires_in), ISSUED
    )


@pytest.mark.parametrize(("expires_in", "span"), [(None, AFTER), (10.0, 10.0), (7200.0, 7200.0)])
def test_a_command_is_given_up_when_its_time_is_over(expires_in, span):
    given = command(expires_in=expires_in)
    assert not given.expired(ISSUED, AFTER)
    assert not given.expired(ISSUED + span - 0.1, AFTER)
    assert given.expired(ISSUED + span, AFTER)


@pytest.mark.parametrize(("expires_in", "span"), [(None, AFTER), (10.0, 10.0), (7200.0, 7200.0)])
def test_a_command_from_before_the_clock_was_set_back_is_not_kept_until_it_has_caught_up(expires_in, span):
    given = command(expires_in=expires_in)
    assert not given.expired(ISSUED - span + 0.1, AFTER)
    assert given.expired(ISSUED - span, AFTER)
    assert given.expired(ISSUED - 86400.0, AFTER)


def test_an_emergency_stop_waits_whatever_the_clock_says():
    stop = command(Abort(emergency=True))
    assert not stop.expired(ISSUED + 1e9, AFTER)
    assert not stop.expired(ISSUED - 1e9, AFTER)


@pytest.mark.parametrize(
    ("after", "expires_in", "span"), [(AFTER, None, 86400.0), (1e6, None, 1e6), (AFTER, 10.0, 10.0)]
)
def test_an_abort_waits_for_a_day_for_a_robot_that_may_be_on_its_way(after, expires_in, span):
    abort = command(Abort(), expires_in)
    assert not abort.expired(ISSUED + span - 0.1, after)
    assert abort.expired(ISSUED + span, after)
