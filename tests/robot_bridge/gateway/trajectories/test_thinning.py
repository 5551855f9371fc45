"""Which positions are stored: where a robot moved, turned or came to stand, and a sign of life."""

import gc
import math
import sys
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.sites.settings_tables import TrajectorySettings
from robot_bridge.gateway.storage.repositories.trajectories import Fix, pack
from robot_bridge.gateway.trajectories import recording
from robot_bridge.gateway.trajectories.recording import PositionThinning, TrajectoryRecorder

SETTINGS = TrajectorySettings(
    min_distance_m=0.5, min_turn_deg=10.0, min_interval_s=0.2, max_interval_s=5.0, largest_backlog=1000
)


def fix(at, x=0.0, theta=0.0, v=1.0, robot="r1"):
    return Fix(robot, at, SendPos(x, 0.0, theta, v))


def kept(*fixes):
    thinning = PositionThinning()
    return [one.received_at for one in fixes if thinning.keeps(one, SETTINGS)]


def test_the_first_position_is_stored():
    assert kept(fix(100.0)) == [100.0]


def test_a_robot_that_moves_is_stored_by_the_distance_it_came():
    assert kept(*(fix(n, x=0.2 * n) for n in range(8))) == [0, 3, 6]


def test_a_robot_that_turns_on_the_spot_is_stored_by_the_turn():
    turns = [math.radians(angle) for angle in (178, 182, 187, 189)]
    assert kept(*(fix(n, theta=math.remainder(t, math.tau), v=0.3) for n, t in enumerate(turns))) == [0, 3]


def test_a_robot_that_stands_is_stored_as_a_sign_of_life_only():
    assert kept(*(fix(n, x=0.01 * (n % 2), v=0.0) for n in range(12))) == [0, 5, 10]


def test_a_fast_robot_is_stored_no_more_often_than_set():
    assert kept(*(fix(n * 0.125, x=10.0 * n) for n in range(9))) == [0, 0.25, 0.5, 0.75, 1.0]


def test_where_a_robot_comes_to_stand_is_stored_however_near():
    assert kept(fix(0), fix(1, x=0.1), fix(2, x=0.2, v=0.0), fix(3, x=0.2, v=0.0)) == [0, 2]


def test_robots_are_kept_apart():
    assert kept(fix(0), fix(0.1, robot="r2"), fix(0.2, x=0.1), fix(0.3, x=0.1, robot="r2")) == [0, 0.1]


def test_a_clock_that_was_set_back_does_not_end_the_recording():
    assert kept(fix(1000.0), fix(10.0), fix(11.0, x=1.0)) == [1000.0, 10.0, 11.0]


def test_the_last_place_of_a_robot_that_falls_silent_is_stored_once():
    thinning = PositionThinning()
    assert thinning.keeps(fix(0), SETTINGS) and not thinning.keeps(fix(1, x=0.3), SETTINGS)
    assert thinning.silent(0.5) == []
    assert [one.received_at for one in thinning.silent(2)] == [1]
    assert thinning.silent() == []


@given(st.lists(st.tuples(st.floats(0.01, 3), st.floats(-2, 2), st.floats(-1, 1), st.booleans()), min_size=1))
def test_no_position_is_farther_from_a_stored_one_than_set_unless_it_is_too_soon(steps):
    thinning, at, x, theta, last = PositionThinning(), 0.0, 0.0, 0.0, None
    for seconds, metres, turn, moving in steps:
        at, x, theta = at + seconds, x + metres, theta + turn
        one = fix(at, x=x, theta=theta, v=1.0 if moving else 0.0)
        if thinning.keeps(one, SETTINGS):
            last = one
        elapsed = at - last.received_at
        assert elapsed < SETTINGS.max_interval_s
        if elapsed >= SETTINGS.min_interval_s:
            assert abs(x - last.pose.x) < SETTINGS.min_distance_m
            turned = math.remainder(theta - last.pose.theta, math.tau)
            assert abs(turned) < math.radians(SETTINGS.min_turn_deg)


# --- on the way to the database -----------------------------------------------------------------------------


@pytest.fixture
def recorder():
    return TrajectoryRecorder(SimpleNamespace(settings=SimpleNamespace(trajectories=SETTINGS)))


def test_what_could_not_be_stored_waits_in_its_order(recorder):
    for n in range(3):
        recorder.observe([fix(n, x=n)])
    taken = recorder.next_batch(3.0)
    recorder.observe([fix(3, x=3.0)])
    assert recorder.waiting == 1
    recorder.requeue(taken)
    assert recorder.next_batch(4.0) == [pack(fix(n, x=n)) for n in range(4)]


def test_what_waits_is_bounded_and_the_newest_stay(recorder, caplog):
    for n in range(1000):
        recorder.observe([fix(n, x=n)])
    for n in range(1000, 1200):
        taken = recorder.next_batch(n)
        recorder.observe([fix(n, x=n)])
        recorder.requeue(taken)
    assert (recorder.waiting, recorder.given_up) == (1000, 200)
    assert recorder.next_batch(1200.0)[0] == pack(fix(200, x=200))
    assert [record.levelname for record in caplog.records] == ["ERROR"]
    assert "trajectories.largest_backlog of site.toml" in caplog.text


def test_what_waits_is_bounded_where_the_database_is_slow_and_nothing_fails(recorder, caplog):
    """Nothing is given back by then: it is being written, for however long."""
    for n in range(1200):
        recorder.observe([fix(n, x=n)])
    assert (recorder.waiting, recorder.given_up) == (1000, 200)
    assert recorder.next_batch(1200.0)[0] == pack(fix(200, x=200))
    assert "takes them more slowly than they come" in caplog.text


def test_what_is_given_up_later_is_told_again(recorder, caplog):
    for begin in (0, 2000):
        for n in range(begin, begin + 1100):
            recorder.observe([fix(n, x=n)])
        while recorder.next_batch(begin + 1100.0):
            continue
    assert recorder.given_up == 200
    assert [record.levelname for record in caplog.records] == ["ERROR", "ERROR"]


def test_what_waits_is_nothing_that_pythons_search_for_garbage_has_to_look_at(recorder):
    recorder.observe([fix(0)])
    gc.collect()
    assert not any(map(gc.is_tracked, recorder.next_batch(1.0)))


def test_a_position_that_waits_takes_less_than_200_bytes():
    """Of 200 000 that may wait, the gateway has 40 MB at most."""
    robot, stored = pack(fix(0))
    assert sys.getsizeof((robot, stored)) + sys.getsizeof(stored) < 200


def test_a_batch_is_limited(recorder, monkeypatch):
    monkeypatch.setattr(recording, "BATCH", 2)
    for n in range(3):
        recorder.observe([fix(n, x=n)])
    assert [len(recorder.next_batch(3.0)) for _ in range(3)] == [2, 1, 0]


def test_at_the_end_the_actual_place_is_stored(recorder):
    recorder.observe([fix(0)])
    recorder.observe([fix(1, x=0.3)])
    assert len(recorder.next_batch(1.0)) == 1
    recorder.finish()
    assert recorder.next_batch(1.0) == [pack(fix(1, x=0.3))]


def test_the_last_place_of_a_silent_robot_is_stored_after_the_longest_interval(recorder):
    recorder.observe([fix(100)])
    recorder.observe([fix(101, x=0.3)])
    assert recorder.next_batch(101.5) == [pack(fix(100))]
    assert recorder.next_batch(105.9) == []
    assert recorder.next_batch(107.0) == [pack(fix(101, x=0.3))]
