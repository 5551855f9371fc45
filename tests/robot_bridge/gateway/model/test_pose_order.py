"""Late poses move nothing back, on whatever link; a clock that was set back freezes nothing for ever."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.gateway.model.position_checks import (
    CLOCK_SET_BACK_AFTER,
    LONGEST_DELAY,
    PoseOrder,
    StampAge,
)


@pytest.fixture
def order() -> PoseOrder:
    order = PoseOrder()
    assert order.admit(50.0, 52.0, "websocket", 1000.0)
    return order


@pytest.mark.parametrize(
    ("fix_t", "t", "counts"),
    [
        (51.0, 53.0, True),
        (51.0, 40.0, True),  # the fix decides; the robot's own clock was set back
        (49.0, 53.0, False),  # sent later, seen earlier
        (50.0, 53.0, True),
        (50.0, 51.0, False),
        (50.0, 52.0, True),  # the same once more
        (None, 53.0, True),
        (None, 51.0, False),
        (51.0, None, True),
        (49.0, None, False),
        (None, None, True),
    ],
)
def test_the_fix_decides_and_then_the_robots_clock(order, fix_t, t, counts):
    assert order.admit(fix_t, t, "websocket", 1000.1) is counts


def test_what_has_no_stamp_counts_as_it_comes_and_hides_no_stamp():
    order = PoseOrder()
    assert order.admit(None, None, "sql", 1.0)
    assert order.admit(None, 10.0, "sql", 2.0)
    assert order.admit(None, None, "sql", 3.0)
    assert not order.admit(None, 9.0, "sql", 4.0)


def feed(order, stamps, start=1000.0, every=0.1, link="websocket"):
    """Hand in device times one after the other; return the times at which one counted."""
    moments = [(start + k * every, t) for k, t in enumerate(stamps, 1)]
    return [now - start for now, t in moments if order.admit(None, t, link, now)]


def clock(begin, seconds, every=0.1):
    return [begin + k * every for k in range(round(seconds / every))]


@pytest.mark.parametrize("back", [0.2, 5.0, 3600.0, 1e9])
def test_a_clock_that_was_set_back_freezes_the_robot_for_three_seconds_at_most(back):
    order = PoseOrder()
    order.admit(None, 1e6, "websocket", 1000.0)
    counted = feed(order, clock(1e6 - back, 20.0))
    assert counted[0] == pytest.approx(min(back, CLOCK_SET_BACK_AFTER), abs=0.25)
    assert len(counted) >= 165


def test_what_was_kept_back_and_comes_in_one_go_moves_nothing():
    order = PoseOrder()
    order.admit(None, 1000.0, "websocket", 1000.0)
    assert feed(order, clock(400.0, 600.0, every=0.2), every=0.005) == []  # ten minutes in fifteen seconds


def test_late_poses_between_newer_ones_never_count():
    order = PoseOrder()
    for k in range(1000):
        now = 1000.0 + k * 0.1
        assert order.admit(None, now, "websocket", now)
        assert not order.admit(None, now - 20.0, "websocket", now + 0.05)


def test_a_slow_link_moves_nothing_back_where_a_fast_one_has_been():
    order = PoseOrder()
    order.admit(None, 1000.0, "websocket", 1000.0)
    counted = feed(order, clock(980.0, 40.0), link="sql")  # twenty seconds late
    assert counted[0] == pytest.approx(20.0, abs=0.2)


def test_a_clock_set_back_with_a_change_of_link_freezes_for_the_longest_delay_of_a_link():
    order = PoseOrder()
    order.admit(None, 1e6, "websocket", 1000.0)
    counted = feed(order, clock(5.0, 60.0), link="sql")
    assert counted[0] == pytest.approx(LONGEST_DELAY, abs=0.3)


def test_a_clock_that_stands_still_freezes_no_robot():
    order = PoseOrder()
    order.admit(None, 1000.0, "websocket", 1000.0)
    assert feed(order, [3.0] * 500)[0] == pytest.approx(LONGEST_DELAY, abs=0.3)


def test_a_gateway_clock_that_was_set_back_delays_that_no_longer():
    order = PoseOrder()
    order.admit(None, 1000.0, "websocket", 1000.0)
    feed(order, clock(100.0, 2.0))
    counted = feed(order, clock(102.0, 20.0), start=50.0)
    assert counted[0] == pytest.approx(CLOCK_SET_BACK_AFTER, abs=0.25)


def test_a_robot_that_started_anew_counts_from_nought_but_its_fixes_do_not(order):
    order.restarted()
    assert not order.admit(49.0, 1.0, "websocket", 1001.0)
    assert order.admit(None, 1.0, "websocket", 1001.1)


@given(st.lists(st.tuples(st.floats(0, 100), st.sampled_from(["sql", "websocket"])), max_size=60))
def test_within_a_few_seconds_the_stamps_that_count_only_grow(poses):
    order, counted = PoseOrder(), []
    for k, (t, link) in enumerate(poses):
        if order.admit(None, t, link, 1000.0 + k * 0.04):
            counted.append(t)
    assert counted == sorted(counted)


NOW = 1_790_000_000.0


def delays(stamps, every=1.0, order=None):
    """Hand in fixes, each of a time ago; return how old each is taken to be."""
    order, found = order or PoseOrder(), []
    for k, ago in enumerate(stamps):
        now = NOW + k * every
        assert order.admit(now - ago, None, "websocket", now)
        found.append(round(order.delay, 1))
    return found


@pytest.mark.parametrize("wrong", [0.0, 7200.0, -7200.0, 1e8])
def test_a_position_is_as_old_as_it_is_later_than_the_timeliest_whatever_the_clock_says(wrong):
    assert delays([wrong + ago for ago in (0.5, 0.2, 0.2, 1.2, 2.2, 3.2, 0.2)]) == [0, 0, 0, 1, 2, 3, 0]


def test_a_fix_that_is_repeated_grows_old():
    assert delays([float(k) for k in range(6)]) == [0, 1, 2, 3, 4, 5]


def test_a_time_since_power_on_or_a_simulated_one_says_no_age():
    order = PoseOrder()
    for k in range(20):
        assert order.admit(None, 100.0 + k / 2, "websocket", NOW + k)
        assert order.delay == 0.0


def test_a_fix_without_its_time_is_not_judged_by_that_of_another():
    order = PoseOrder()
    assert order.admit(NOW - 3600.0, NOW, "websocket", NOW)
    assert order.admit(None, NOW + 1.0, "websocket", NOW + 1.0)
    assert order.delay == 0.0


def test_a_clock_that_loses_a_little_or_is_set_back_makes_no_position_old():
    stamps, a_day = StampAge(), 86_400
    assert max(stamps.measure(NOW + k * (1 - 2e-4), NOW + k) for k in range(0, a_day, 10)) < 0.1
    order = PoseOrder()
    for k in range(100):
        order.admit(None, NOW + k * 0.1 - (40.0 if k > 20 else 0.0), "websocket", NOW + k * 0.1)
    assert order.delay < 0.1


def test_a_gateway_clock_that_was_set_makes_no_position_old():
    order = PoseOrder()
    assert order.admit(NOW, None, "websocket", NOW)
    order.clock_was_set()
    assert delays([-3600.0, -3600.0], order=order) == [0, 0]
