"""What an operator asks for in one breath: a stop goes first, long questions aside, the rest in turn."""

from __future__ import annotations

import contextlib
import itertools
import json
import re
import signal
import sqlite3
import time

import pytest

from tests.support.operators import Desk
from tests.support.processes import freeze

NUMBERS = itertools.count(1)
SLOW = 24
POINTS = [[x, y] for x in range(100) for y in range(80)]
"""8 000 places to look up: some ten milliseconds."""
POINTS_TEXT = json.dumps(POINTS, separators=(",", ":"))


def new(what):
    return f"{what}-{next(NUMBERS):04}"


class Hasty(Desk):
    """An operator's connection that does not wait for answers before it asks again; it keeps them all."""

    def __init__(self, url):
        self.answers = {}
        super().__init__(url, "Ada")
        self.ask("subscribe", {"rate": 20})

    def say(self, id, method, **params):
        self._send({"jsonrpc": "2.0", "id": id, "method": method, "params": params})

    def say_until(self, deadline, id, method, **params):
        self._send({"jsonrpc": "2.0", "id": id, "method": method, "params": params, "deadline": deadline})

    def ask_of_points(self, id):
        frame = f'{{"jsonrpc":"2.0","id":{id},"method":"get_surface","params":{{"points":{POINTS_TEXT}}}}}'
        self.connection.send(frame)

    def order(self, *ids, seconds=30.0):
        """Wait for the answers of ``ids``; return these in the order in which they came."""
        self.until(lambda: all(id in self.answers for id in ids), seconds)
        return [id for id in self.answers if id in ids]

    def refusal(self, id):
        return self.answers[id]["error"]["message"]

    def _send(self, frame):
        self.connection.send(json.dumps(frame, separators=(",", ":")))

    def _hear(self, frame):
        if "method" in frame:
            super()._hear(frame)
        else:
            self.answers[frame["id"]] = frame


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


@pytest.fixture
def desk(bridge):
    desk = Hasty(f"{bridge.address}/desk")
    yield desk
    if desk.ask("hello", {"operator": "Ada"})["emergency"]["in_force"]:
        desk.ask("clear_emergency_stop", {"reason": "the test is over"})
    desk.connection.close()


def plugged_in(bridge, desk):
    robot = bridge.robot(name := new("robot"))
    robot.name = name
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 20.0, "y": 20.0, "theta": 0.0, "v": 1.0})
    desk.wait_for_robots(name)
    return robot


@pytest.fixture
def robot(bridge, desk):
    """A robot that drives to its target."""
    robot = plugged_in(bridge, desk)
    target = new("target")
    desk.send(target, robot.name, "SetPosEnd", x=180.0, y=20.0)
    robot.say(robot.wait_for("SetPosEnd")["id"])
    desk.wait_for_step(target, "acknowledged")
    robot.task = target
    yield robot
    robot.connection.close()


@pytest.mark.parametrize(
    ("method", "names"),
    [
        ("emergency_stop", ()),
        ("abort", ("robot",)),
        ("abort_all", ()),
        ("send", ("robot", "op", "params")),
    ],
)
def test_whatever_stops_robots_is_begun_before_the_slow_questions_that_came_first(desk, robot, method, names):
    told = {"robot": robot.name, "op": "Abort", "params": {}}
    params = {name: told[name] for name in names}
    # In turn it would always be the last; a busy disk may take longer for one order than all questions take.
    assert any(_overtakes(desk, robot, method, params) for _ in range(3))


def _overtakes(desk, robot, method, params):
    """Ask slow questions and then this; tell whether it was answered before the last of them."""
    desk.answers.clear()
    for id in range(SLOW):
        desk.ask_of_points(1000 + id)
    desk.say(1, method, command=new("stop"), **params)
    robot.say(robot.wait_for("Abort")["id"])
    order = desk.order(1, *range(1000, 1000 + SLOW))
    assert [id for id in order if id != 1] == list(range(1000, 1000 + SLOW))
    assert "error" not in desk.answers[1000 + SLOW - 1]
    return order[-1] != 1


def test_a_stop_is_first_when_an_order_before_it_waits_for_the_database(bridge, desk, robot):
    begun, late = new("target"), new("target")
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as hog:
        hog.execute("begin immediate")
        target = {"robot": robot.name, "op": "SetPosEnd", "params": {"x": 30.0, "y": 20.0}}
        desk.say(1, "send", command=begun, **target)
        desk.say(2, "send", command=late, **target)
        desk.say(3, "resume_queue", robot=robot.name, revision=0)
        desk.say(4, "clear_emergency_stop", reason="all clear")
        desk.say(5, "emergency_stop", command=new("stop"))
        assert robot.wait_for("Abort", 1.0)["params"] == {"emergency": True}
        assert desk.order(2, 3, 4, 5) == [2, 3, 4, 5]
        hog.execute("rollback")
    for id in (2, 3, 4):
        assert "emergency_stop came after it and before it was begun" in desk.refusal(id)
    assert desk.answers[5]["result"]["in_force"]
    desk.until(lambda: desk.emergency["stored"], 15)
    desk.order(1)
    if "error" in desk.answers[1]:
        # All in one breath: it may not have been begun, or only when the stop was in force.
        assert re.search("an emergency stop is in force|emergency_stop came after it", desk.refusal(1))
    else:
        desk.wait_for_step(begun, "aborted")
    assert late not in desk.commands
    # By its answer what was sent before has come.
    robot.ask("Alive")
    assert [call["method"] for call in robot.calls if call["method"] == "SetPosEnd"] == []


def test_an_abort_overtakes_only_what_concerns_its_robot(bridge, desk, robot):
    other, kept = plugged_in(bridge, desk), new("target")
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as hog:
        hog.execute("begin immediate")
        desk.say(1, "set_positions", positions=[{"robot": other.name, "x": 30.0, "y": 20.0}])
        target = {"op": "SetPosEnd", "params": {"x": 30.0, "y": 20.0}}
        desk.say(2, "send", command=new("target"), robot=robot.name, **target)
        desk.say(3, "send", command=kept, robot=other.name, **target)
        desk.say(4, "abort", command=new("abort"), robot=robot.name)
        assert desk.order(2) == [2]
        hog.execute("rollback")
    assert "abort came after it" in desk.refusal(2)
    desk.order(1, 3, 4)
    assert desk.answers[3]["result"]["command"] == kept
    robot.say(robot.wait_for("Abort")["id"])
    # Of one that was not seen for some seconds the task ends with its next position.
    robot.tell("SendPos", {"x": 20.0, "y": 20.0, "theta": 0.0, "v": 0.0})
    assert desk.wait_for_step(robot.task, "aborted")
    other.connection.close()


def test_of_previews_of_one_way_that_wait_only_the_newest_is_found(desk):
    desk.say(1, "get_surface", points=POINTS)
    for id in range(2, 12):
        desk.say(id, "get_route", start=[41.0, 44.0], x=100.0 - id, y=45.0)
    desk.say(12, "get_route", start=[60.0, 8.0], x=100.0, y=8.0)
    desk.order(*range(1, 13))
    assert desk.answers[11]["result"]["points"][-1] == [89.0, 45.0]
    assert desk.answers[12]["result"]["points"][-1] == [100.0, 8.0]
    assert "it was asked again before this was begun" in desk.refusal(5)


def test_too_many_questions_at_once_are_refused_and_the_others_answered(desk):
    for id in range(150):
        desk.say(1000 + id, "get_surface", points=POINTS[:2000])
    order = desk.order(*range(1000, 1150), seconds=60)
    refused = [id for id in order if "error" in desk.answers[id]]
    assert 0 < len(refused) <= 150 - 64
    assert desk.answers[refused[0]]["error"]["code"] == -32005
    assert "wait for answers, then ask again" in desk.answers[refused[0]]["error"]["message"]


# --- requests with a deadline -------------------------------------------------------------------------------

TARGET = {"op": "SetPosEnd", "params": {"x": 30.0, "y": 20.0}}


def test_what_lay_in_a_buffer_beyond_its_deadline_is_not_done_unless_it_stops_robots(bridge, desk, robot):
    other, late = plugged_in(bridge, desk), new("target")
    deadline = desk.ask("hello", {"operator": "Ada"})["now"] + 0.5
    freeze(bridge.gateway.pid)
    try:
        desk.say_until(deadline, 1, "send", command=late, robot=other.name, **TARGET)
        desk.say_until(deadline, 2, "abort", command=new("abort"), robot=robot.name)
        desk.say_until(deadline, 3, "pause_queue", robot=other.name)
        # Until the deadline is over, with all of it in the buffer.
        time.sleep(1.0)
    finally:
        bridge.gateway.send_signal(signal.SIGCONT)
    robot.say(robot.wait_for("Abort")["id"])
    # Of one that was not seen for some seconds the task ends with its next position.
    robot.tell("SendPos", {"x": 20.0, "y": 20.0, "theta": 0.0, "v": 0.0})
    assert desk.wait_for_step(robot.task, "aborted")
    desk.order(1, 2, 3)
    assert "after its deadline, so that it was not done: a robot shall not drive off" in desk.refusal(1)
    assert desk.answers[1]["error"]["data"]["now"] > deadline
    assert "error" not in desk.answers[2] and "error" not in desk.answers[3]
    assert late not in desk.commands
    other.ask("Alive")
    assert [call["method"] for call in other.calls if call["method"] == "SetPosEnd"] == []
    other.connection.close()


def test_what_has_its_turn_after_its_deadline_is_not_done(bridge, desk, robot):
    deadline = desk.ask("hello", {"operator": "Ada"})["now"] + 0.5
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as hog:
        hog.execute("begin immediate")
        desk.say(1, "send", command=new("target"), robot=robot.name, **TARGET)
        desk.say_until(deadline, 2, "send", command=new("target"), robot=robot.name, **TARGET)
        # Until the deadline is over, with the first one begun.
        time.sleep(1.0)
        hog.execute("rollback")
    desk.order(1, 2)
    assert "error" not in desk.answers[1]
    assert "after its deadline" in desk.refusal(2)


def test_what_comes_in_time_is_done(desk, robot):
    now = desk.ask("hello", {"operator": "Ada"})["now"]
    desk.say_until(now + 600.0, 1, "send", command=new("target"), robot=robot.name, **TARGET)
    desk.order(1)
    assert desk.answers[1]["result"]["state"] == "queued"


@pytest.mark.parametrize("deadline", ["soon", True, [], {}])
def test_a_deadline_that_is_no_number_is_refused_and_keeps_no_stop(desk, robot, deadline):
    desk.say_until(deadline, 1, "send", command=new("target"), robot=robot.name, **TARGET)
    desk.order(1)
    assert "deadline is no finite number; give seconds" in desk.refusal(1)
    desk.say_until(deadline, 2, "abort", command=new("abort"), robot=robot.name)
    robot.say(robot.wait_for("Abort")["id"])
    desk.order(2)
    assert "error" not in desk.answers[2]
