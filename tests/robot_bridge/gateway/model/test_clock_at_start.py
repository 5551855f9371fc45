"""A clock that is wrong before the gateway starts shows against what is stored."""

from __future__ import annotations

import pytest

from robot_bridge.core.clock import check_clock_at_start

NOW = 1_790_000_000.0
DAY = 86400.0


@pytest.mark.parametrize("newest", [None, NOW, NOW - 6 * DAY, NOW + 4.0])
def test_a_clock_that_goes_on_from_what_is_stored_is_not_doubted(newest):
    assert check_clock_at_start(NOW, newest) is None


@pytest.mark.parametrize("behind", [6.0, 3600.0, 400 * DAY])
def test_a_clock_before_what_is_stored_is_told_with_both_times_and_what_to_do(behind):
    doubt = check_clock_at_start(NOW, NOW + behind)
    assert not doubt.may_be_ahead
    assert (
        "the clock of this computer says 2026-09-21 14:13:20 UTC, and what was stored last is from "
        in doubt.text
    )
    assert "the clock is behind now, or was ahead then" in doubt.text
    assert "timedatectl set-ntp true" in doubt.text


def test_a_clock_that_never_was_set_is_told_in_an_empty_database_too():
    assert (
        "says 1970-01-01 00:01:00 UTC, which is before this version was made"
        in check_clock_at_start(60.0, None).text
    )


def test_a_clock_long_after_what_is_stored_may_be_ahead():
    doubt = check_clock_at_start(NOW, NOW - 8 * DAY)
    assert doubt.may_be_ahead
    assert "what was stored last is from 2026-09-13 14:13:20 UTC. For a day nothing is deleted" in doubt.text
