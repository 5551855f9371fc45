"""Fresh, stale, lost, offline: the boundaries, and who goes offline instead of lost."""

from __future__ import annotations

import pytest

from robot_bridge.gateway.model.robots import liveness


@pytest.mark.parametrize(
    ("age", "state"),
    [(-1, "fresh"), (0, "fresh"), (2.999, "fresh"), (3.0, "stale"), (9.999, "stale"), (10.0, "lost")],
)
def test_a_robot_that_falls_silent_turns_stale_then_lost(age, state):
    assert liveness(age, ended_in_order=False).value == state


@pytest.mark.parametrize(("age", "state"), [(2.999, "fresh"), (3.0, "offline"), (10.0, "offline")])
def test_a_robot_that_ended_in_order_is_offline_and_never_lost(age, state):
    assert liveness(age, ended_in_order=True).value == state


def test_the_limits_are_the_sites():
    limits = {"stale_after": 0.5, "lost_after": 1.0, "ended_in_order": False}
    states = [liveness(age, **limits).value for age in (0.4, 0.5, 0.9, 1.0)]
    assert states == ["fresh", "stale", "stale", "lost"]
