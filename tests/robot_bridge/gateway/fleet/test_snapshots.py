"""Positions as operators are sent them: encoded once, never older than what was sent before."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.positions import PositionForm
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.fleet.operator_updates import EVERYTHING, MOST_RATES, Snapshots, Tick
from robot_bridge.gateway.model.robots import Robots


class Counted(Snapshots):
    """Snapshots of two robots that count how often they are encoded."""

    def __init__(self):
        self.robots = Robots()
        self.encoded = 0
        for name in ("a", "b"):
            self.robots.ready(name, 1, "websocket", 0.0)
        super().__init__(self.robots, ManualClock(wall=0.0))

    def _encoded(self, revision, form):
        self.encoded += 1
        return super()._encoded(revision, form)

    def move(self, name, x):
        self.robots.observe(name, SendPos(x=x, y=0, theta=0, v=0), "websocket", 0.0)


@pytest.fixture
def snapshots():
    return Counted()


def robots_in(frame):
    message = json.loads(frame)
    assert (message["jsonrpc"], message["method"]) == ("2.0", "positions")
    return {robot["robot"]: robot for robot in message["params"]["robots"]}


def test_the_first_snapshot_holds_every_robot(snapshots):
    assert set(robots_in(snapshots.after(EVERYTHING).frame)) == {"a", "b"}


def test_the_next_one_holds_what_changed(snapshots):
    seen = snapshots.after(EVERYTHING).revision
    snapshots.move("b", 7.0)
    frame, seen = snapshots.after(seen)
    assert {name: robot["x"] for name, robot in robots_in(frame).items()} == {"b": 7.0}
    assert snapshots.after(seen) == (None, seen)


def test_a_hundred_operators_cost_one_encoding(snapshots):
    seen = snapshots.after(EVERYTHING).revision
    snapshots.move("a", 1.0)
    before = snapshots.encoded
    frames = []
    for number in range(100):
        frames.append(snapshots.after(seen, Tick(0.2, 1)).frame)
        # Robots go on moving while one operator after the other is told.
        snapshots.move("b", float(number))
    assert snapshots.encoded == before + 1
    assert all(frame is frames[0] for frame in frames)


def test_what_came_while_operators_were_told_comes_with_the_next_tick(snapshots):
    seen = snapshots.after(EVERYTHING, Tick(0.2, 1)).revision
    snapshots.move("a", 5.0)
    assert snapshots.after(EVERYTHING, Tick(0.2, 1)).revision == seen
    assert robots_in(snapshots.after(seen, Tick(0.2, 2)).frame)["a"]["x"] == 5.0


def test_who_missed_a_tick_is_sent_everything_and_then_what_the_others_are(snapshots):
    seen = snapshots.after(EVERYTHING, Tick(0.2, 1)).revision
    snapshots.move("a", 1.0)
    late, others = snapshots.after(EVERYTHING, Tick(0.2, 2)), snapshots.after(seen, Tick(0.2, 2))
    assert (set(robots_in(late.frame)), set(robots_in(others.frame))) == ({"a", "b"}, {"a"})
    assert late.revision == others.revision


def test_operators_at_other_rates_have_moments_of_their_own(snapshots):
    seen = snapshots.after(EVERYTHING, Tick(0.2, 1)).revision
    snapshots.move("a", 1.0)
    assert robots_in(snapshots.after(seen, Tick(0.02, 1)).frame)["a"]["x"] == 1.0


def test_without_a_tick_it_is_what_is_known_now(snapshots):
    snapshots.move("a", 1.0)
    assert robots_in(snapshots.after(EVERYTHING).frame)["a"]["x"] == 1.0
    snapshots.move("a", 2.0)
    assert robots_in(snapshots.after(EVERYTHING).frame)["a"]["x"] == 2.0


def test_each_form_is_encoded_once_a_tick_and_tells_of_the_same_robots(snapshots):
    seen = snapshots.after(EVERYTHING).revision
    snapshots.move("a", 1.0)
    before = snapshots.encoded
    made = [snapshots.after(seen, Tick(0.2, 1), form) for form in [*PositionForm] * 3]
    assert snapshots.encoded == before + len(PositionForm)
    assert len({frame.frame for frame in made}) == len(PositionForm)
    assert {frame.revision for frame in made} == {snapshots.robots.revision}
    assert robots_in(made[0].frame)["a"]["x"] == 1.0
    assert b'"robots":["a"]' in made[1].frame


def test_where_nothing_changed_there_is_no_frame_in_any_form(snapshots):
    seen = snapshots.after(EVERYTHING).revision
    assert {snapshots.after(seen, form=form).frame for form in PositionForm} == {None}


def test_any_number_of_rates_takes_no_more_room(snapshots):
    for rate in range(1, 10 * MOST_RATES):
        snapshots.after(EVERYTHING, Tick(1 / rate, 1))
    assert len(snapshots._made) == MOST_RATES


def test_what_is_unknown_is_left_out(snapshots):
    robot = robots_in(snapshots.after(EVERYTHING).frame)["a"]
    assert "x" not in robot
    assert robot["state"] == "fresh"


@pytest.mark.parametrize("now", [0.0, 0.19, 12345.678])
def test_the_next_tick_is_a_whole_interval_on_and_still_to_come(now):
    tick = Tick.last(0.2, now).following(now)
    assert now + tick.wait(now) == pytest.approx(tick.number * 0.2)
    assert 0 < tick.wait(now) <= 0.2 + 1e-9


def test_a_timer_that_goes_off_early_is_followed_by_the_next_tick():
    tick = Tick.last(0.2, 10.05).following(10.05)
    assert tick.following(10.1999).number == tick.number + 1


def test_who_took_too_long_is_told_at_the_first_tick_still_to_come():
    assert Tick(0.2, 50).following(11.05) == Tick(0.2, 56)
