"""Positions as operators are sent them: encoded once, never older than what was sent before."""

from __future__ import annotations

import json

import pytest

from robot_bridge.messages import SendPos
from robot_bridge.robots import Robots
from robot_bridge.snapshots import EVERYTHING, Snapshots, next_tick


class Counted(Snapshots):
    """Snapshots of two robots that count how often they are encoded."""

    def __init__(self):
        self.robots = Robots()
        self.encoded = 0
        for name in ("a", "b"):
            self.robots.ready(name, 1, "websocket", 0.0)
        super().__init__(self.robots, self._counted)

    def _counted(self, since):
        self.encoded += 1
        return self.robots.reports(0.0, since)

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
    frames = [snapshots.after(seen).frame for _ in range(100)]
    assert snapshots.encoded == before + 1
    assert all(frame is frames[0] for frame in frames)


def test_what_was_encoded_is_not_sent_when_robots_have_moved_on(snapshots):
    snapshots.move("a", 1.0)
    assert robots_in(snapshots.after(EVERYTHING).frame)["a"]["x"] == 1.0
    snapshots.move("a", 2.0)
    assert robots_in(snapshots.after(EVERYTHING).frame)["a"]["x"] == 2.0


def test_what_is_unknown_is_left_out(snapshots):
    robot = robots_in(snapshots.after(EVERYTHING).frame)["a"]
    assert "x" not in robot
    assert robot["state"] == "fresh"


@pytest.mark.parametrize("now", [0.0, 0.19, 12345.678])
def test_who_shares_a_rate_shares_the_moments(now):
    assert (now + next_tick(0.2, now)) / 0.2 == pytest.approx(round((now + next_tick(0.2, now)) / 0.2))
    assert 0 < next_tick(0.2, now) <= 0.2
