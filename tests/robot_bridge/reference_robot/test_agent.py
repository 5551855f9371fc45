"""What the reference robot says and does when messages come, come twice, or cannot be read."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from robot_bridge.core.messages.roads import GetSurface, SetSurface
from robot_bridge.core.messages.robots import (
    Abort,
    Alive,
    GetMap,
    GetPath,
    OpAck,
    Ready,
    SendImage,
    SendPos,
    SetMap,
    SetObject,
    SetPath,
    SetPosEnd,
    SetPosIni,
    Start,
    Stopped,
)
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import Window
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.reference_robot.agent import MOST_DONE, Agent, AgentSettings
from robot_bridge.reference_robot.body import BodyLimits, ScriptedObject

DT = 0.05
PNG = b"\x89PNG\r\n\x1a\n" + b"pixels"


class Robot:
    """An agent and what it said."""

    def __init__(self, **settings):
        self.sent = []
        limits = BodyLimits(speed=3.0)
        values = {"magic": 42, "pose": (0.0, 0.0, 0.0), "limits": limits, "rate": 5.0, **settings}
        self.agent = Agent(AgentSettings(**values), SimpleNamespace(say=self.sent.append))
        self.agent.receive(OpAck(magic=42, robot="r1", database="first"), None)

    def live(self, seconds):
        for _ in range(round(seconds / DT)):
            self.agent.step(DT)

    def sent_of(self, kind):
        return [message for message in self.sent if isinstance(message, kind)]

    @property
    def distance(self):
        return math.hypot(*self.agent.pose[:2])


@pytest.fixture
def robot() -> Robot:
    return Robot()


def test_start_makes_it_say_ready_with_its_magic_number(robot):
    assert robot.agent.receive(Start("first"), 3) == OpAck(id=3)
    assert robot.agent.receive(Start("first"), None) is None
    assert robot.sent == [Ready(42, path_cones=True), Ready(42, path_cones=True)]


def test_an_acknowledgement_is_not_acknowledged(robot):
    assert robot.agent.receive(OpAck(id=1), 2) is None


def test_it_drives_to_a_target_then_says_where_it_is_and_that_it_stopped(robot):
    assert robot.agent.receive(SetPosEnd(3.0, 1.0), 1) == OpAck(id=1)
    robot.live(15)
    assert math.hypot(robot.agent.pose[0] - 3, robot.agent.pose[1] - 1) < 0.06
    assert len(robot.sent_of(Stopped)) == 1
    assert isinstance(robot.sent[robot.sent.index(Stopped()) - 1], SendPos)


def test_a_repeated_message_is_acknowledged_twice_and_done_once(robot):
    assert robot.agent.receive(SetPosEnd(3.0, 0.0), 1) == OpAck(id=1)
    robot.live(10)
    assert robot.agent.receive(Abort(), 2) == OpAck(id=2)
    place = robot.agent.pose
    assert robot.agent.receive(SetPosEnd(3.0, 0.0), 1) == OpAck(id=1)
    robot.agent.receive(SetPosEnd(0.0, 0.0), 3)
    robot.live(0.5)
    assert robot.agent.receive(Abort(), 2) == OpAck(id=2)
    robot.live(10)
    assert robot.distance < 0.1 < math.hypot(*place[:2])


def test_after_a_repeated_message_it_says_once_more_where_it_stands_and_that_it_has_nothing_to_do(robot):
    robot.agent.receive(SetPosEnd(3.0, 0.0), 1)
    robot.live(10)
    robot.sent.clear()
    assert robot.agent.receive(SetPosEnd(3.0, 0.0), 1) == OpAck(id=1)
    robot.live(1)
    assert len(robot.sent_of(Stopped)) == 1
    assert isinstance(robot.sent[robot.sent.index(Stopped()) - 1], SendPos)


def test_while_it_drives_a_repeated_message_makes_it_say_nothing_more(robot):
    robot.agent.receive(SetPosEnd(30.0, 0.0), 1)
    robot.live(2)
    robot.agent.receive(SetPosEnd(30.0, 0.0), 1)
    robot.live(2)
    assert robot.sent_of(Stopped) == []


def test_abort_stops_it_and_it_stays(robot):
    robot.agent.receive(SetPath([(0.0, 0.0), (50.0, 0.0)]), 1)
    robot.live(3)
    assert robot.sent_of(SendPos)[-1].v > 1.0
    robot.agent.receive(Abort(), 2)
    robot.live(3)
    stood = robot.agent.pose
    assert robot.sent_of(SendPos)[-1].v == 0.0
    assert robot.sent_of(Stopped)
    robot.live(3)
    assert robot.agent.pose == stood


def test_before_it_acknowledges_an_abort_it_says_where_it_is(robot):
    robot.agent.receive(SetPosEnd(1.0, 0.0), 1)
    robot.live(10)
    robot.sent.clear()
    acknowledged = robot.agent.receive(Abort(), 2)
    (position,) = robot.sent
    assert (position.x, position.v) == (pytest.approx(1.0, abs=0.1), 0.0)
    assert acknowledged == OpAck(id=2)


def test_a_robot_that_was_not_let_in_says_nothing_of_itself_to_an_abort():
    said = []
    agent = Agent(
        AgentSettings(magic=42, pose=(0.0, 0.0, 0.0), limits=BodyLimits()), SimpleNamespace(say=said.append)
    )
    assert agent.receive(Abort(), 2) == OpAck(id=2)
    assert said == []


def test_a_map_is_taken_and_a_broken_one_refused_with_the_reason(robot):
    assert robot.agent.map is None
    good = encode(build_map(Outlines.from_rows([]), Window(15.0, 15.0, 30.0, 30.0)))
    assert robot.agent.receive(SetMap(good), 1) == OpAck(id=1)
    assert robot.agent.map.border.area == 900
    refusal = robot.agent.receive(SetMap(good[:-5]), 2)
    assert refusal.id == 2
    assert refusal.ok is False
    assert refusal.reason.startswith("the map cannot be read: ")
    assert robot.agent.map.border.area == 900


def test_it_says_its_position_at_its_rate_with_noise_by_seed():
    first, same, other = Robot(seed=1), Robot(seed=1), Robot(seed=2)
    for robot in (first, same, other):
        robot.live(4)
    assert 19 <= len(first.sent_of(SendPos)) <= 21
    assert first.sent == same.sent
    assert first.sent != other.sent
    spread = np.std([(p.x, p.y) for p in first.sent_of(SendPos)])
    assert 0.003 < spread < 0.03
    exact = Robot(noise=0.0)
    exact.live(1)
    assert {(p.x, p.y) for p in exact.sent_of(SendPos)} == {(0.0, 0.0)}


def test_it_says_stopped_when_it_leaves(robot):
    robot.agent.receive(SetPosEnd(3.0, 0.0), 1)
    robot.agent.stop()
    robot.agent.alive()
    assert robot.sent == [Stopped(), Alive()]


# --- the handshake ----------------------------------------------------------------------------------------


def test_it_says_nothing_before_its_ready_was_taken():
    said = []
    settings = AgentSettings(magic=42, pose=(0.0, 0.0, 0.0), limits=BodyLimits())
    agent = Agent(settings, SimpleNamespace(say=said.append))
    agent.greet()
    agent.alive()
    for _ in range(20):
        agent.step(DT)
    agent.stop()
    assert said == [Ready(42, path_cones=True)]


def test_it_says_ready_again_while_another_robot_uses_its_name(robot):
    robot.sent.clear()
    robot.agent.receive(OpAck(id=1, ok=False, magic=42, reason="in use"), None)
    robot.live(2.5)
    assert robot.sent == [Ready(42, path_cones=True)]
    robot.agent.receive(OpAck(id=2, ok=False, magic=42, reason="in use"), None)
    robot.live(1.5)
    assert robot.sent == [Ready(42, path_cones=True), Ready(42, path_cones=True)]
    robot.agent.receive(OpAck(id=3, magic=42), None)
    robot.live(1)
    assert robot.sent_of(SendPos)


def test_what_is_for_another_robot_of_its_account_it_leaves_alone(robot):
    assert not robot.agent.concerns(OpAck(id=1, ok=False, magic=43))
    assert robot.agent.concerns(OpAck(id=1, magic=42))
    assert robot.agent.concerns(OpAck(id=1))
    assert robot.agent.concerns(SetPosEnd(1.0, 1.0))
    robot.agent.receive(OpAck(ok=False, magic=42), None)
    assert robot.agent.concerns(Start())
    assert not robot.agent.concerns(SetPosEnd(1.0, 1.0))
    robot.agent.receive(OpAck(magic=43), None)
    assert not robot.agent.concerns(SetPosEnd(1.0, 1.0)), "it took another robot's Ready for its own"


@pytest.mark.parametrize("news", [Start("second"), OpAck(magic=42, database="second")])
def test_in_another_database_the_same_id_is_another_message(robot, news):
    robot.agent.receive(SetPosEnd(3.0, 0.0), 1)
    robot.live(8)
    robot.agent.receive(news, None)
    robot.agent.receive(OpAck(magic=42, database="second"), None)
    robot.agent.receive(SetPosEnd(0.0, 0.0), 1)
    robot.live(10)
    assert robot.distance < 0.1


@pytest.mark.parametrize("news", [Start("second"), OpAck(magic=42, database="second")])
def test_in_another_database_it_stops_for_nobody_there_knows_of_its_task(robot, news):
    robot.agent.receive(SetPosEnd(60.0, 0.0), 1)
    robot.live(2)
    robot.agent.receive(news, None)
    robot.agent.receive(OpAck(magic=42, database="second"), None)
    robot.live(5)
    stood_at = robot.distance
    robot.live(2)
    assert robot.distance == stood_at < 10 and len(robot.sent_of(Stopped)) == 1


def test_after_its_program_stood_still_it_drives_on_when_the_gateway_has_let_it_in_again(robot):
    robot.agent.receive(SetPosEnd(20.0, 0.0), 1)
    robot.live(2)
    robot.agent.wait_for_gateway()
    robot.live(5)
    stood_at = robot.distance
    robot.live(2)
    assert robot.distance == stood_at < 10 and robot.sent_of(Stopped) == []
    robot.agent.receive(OpAck(magic=42, database="first"), None)
    robot.live(12)
    assert robot.distance == pytest.approx(20.0, abs=0.1) and len(robot.sent_of(Stopped)) == 1


def test_in_the_same_database_a_new_start_makes_nothing_be_done_twice(robot):
    robot.agent.receive(SetPosEnd(3.0, 0.0), 1)
    robot.live(8)
    robot.agent.receive(Start("first"), None)
    robot.agent.receive(SetPosEnd(0.0, 0.0), 1)
    robot.live(8)
    assert robot.distance > 2.9


def test_of_all_that_was_done_only_the_newest_is_remembered(robot):
    """A robot that runs for months must not hold every id that it ever heard."""
    for id in range(1, MOST_DONE + 100):
        robot.agent.receive(Abort(), id)
    assert len(robot.agent._done) == MOST_DONE
    robot.agent.receive(SetPosEnd(3.0, 0.0), id)
    robot.live(1)
    assert robot.distance == 0.0, "the newest is known to be done"


# --- beginnings, paths, and what it sees ------------------------------------------------------------------


def test_told_where_it_stands_it_takes_itself_to_be_there(robot):
    assert robot.agent.receive(SetPosIni(5.0, 6.0, 1.0), 1) == OpAck(id=1)
    assert robot.agent.pose == (5.0, 6.0, 1.0)
    robot.agent.receive(SetPosIni(7.0, 8.0), 2)
    assert robot.agent.pose == (7.0, 8.0, 1.0)


def test_while_it_drives_it_will_not_be_told_where_it_is(robot):
    robot.agent.receive(SetPosEnd(30.0, 0.0), 1)
    robot.live(2)
    refusal = robot.agent.receive(SetPosIni(5.0, 6.0), 2)
    assert (refusal.ok, refusal.reason) == (False, "it drives, and knows where; abort its task first")
    assert robot.agent.pose[1] == pytest.approx(0.0)


def test_it_asks_for_a_path_and_drives_what_it_is_answered():
    robot = Robot(asks_path=True)
    robot.agent.receive(SetPosEnd(3.0, 3.0, 0.0), 1)
    assert robot.sent_of(GetPath) == [GetPath()]
    robot.agent.receive(SetPath([(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)], 0.0), 2)
    passed = []
    for _ in range(400):
        robot.agent.step(DT)
        passed.append(math.hypot(robot.agent.pose[0] - 3, robot.agent.pose[1]))
    assert min(passed) < 0.8, "it did not come by the corner"
    assert robot.agent.pose == pytest.approx((3.0, 3.0, 0.0), abs=0.06)


def test_it_declares_in_ready_that_it_asks_for_its_path():
    robot = Robot(asks_path=True)
    robot.agent.greet()
    assert robot.sent[-1] == Ready(42, asks_path=True, path_cones=True)


def test_it_stands_until_it_is_told_its_path_says_why_not_and_asks_again():
    robot = Robot(asks_path=True)
    robot.agent.receive(SetPosEnd(30.0, 0.0), 1)
    robot.live(2)
    assert robot.agent.pose[:2] == pytest.approx((0.0, 0.0), abs=0.01)
    robot.agent.receive(OpAck(id=9, ok=False, reason="GetPath: no way leads there"), None)
    robot.live(2)
    assert len(robot.sent_of(GetPath)) == 2
    assert robot.sent_of(SendPos)[-1].status == "stands without a path: GetPath: no way leads there"
    assert not robot.sent_of(Stopped)
    robot.agent.receive(SetPath([(0.0, 0.0), (3.0, 0.0)]), 2)
    robot.live(6)
    assert robot.agent.pose[:2] == pytest.approx((3.0, 0.0), abs=0.06)
    assert (robot.sent_of(SendPos)[-1].status, len(robot.sent_of(GetPath))) == (None, 2)


def test_a_robot_that_drives_stops_for_a_target_to_which_it_has_no_path_yet():
    robot = Robot(asks_path=True)
    robot.agent.receive(SetPath([(0.0, 0.0), (30.0, 0.0)]), 1)
    robot.live(3)
    robot.agent.receive(SetPosEnd(0.0, 30.0), 2)
    robot.live(3)
    assert robot.sent_of(SendPos)[-1].v == 0.0
    place = robot.agent.pose
    assert robot.live(1) is None
    assert robot.agent.pose == place
    robot.agent.receive(Abort(), 3)
    asked = len(robot.sent_of(GetPath))
    robot.live(4)
    assert len(robot.sent_of(GetPath)) == asked > 0


def test_it_says_where_it_is_before_it_asks_for_a_path_and_asks_again_after_each_ready():
    robot = Robot(asks_path=True)
    robot.agent.receive(SetPosEnd(30.0, 0.0), 1)
    for _ in range(2):
        assert [type(message) for message in robot.sent] == [SendPos, GetPath]
        robot.sent.clear()
        robot.agent.receive(OpAck(magic=42, robot="r1", database="first"), None)
    robot.agent.receive(SetPath([(0.0, 0.0), (30.0, 0.0)]), 2)
    robot.sent.clear()
    robot.agent.receive(OpAck(magic=42, robot="r1", database="first"), None)
    assert robot.sent == []


def test_it_asks_what_ground_it_is_on_and_is_to_go_to_and_says_so():
    robot = Robot(asks_surface=True)
    robot.agent.receive(SetPosEnd(3.0, 3.0), 1)
    robot.agent.receive(SetPath([(0.0, 0.0), (5.0, 0.0)]), 2)
    asked = [GetSurface([(0.0, 0.0), (3.0, 3.0)]), GetSurface([(0.0, 0.0), (5.0, 0.0)])]
    assert robot.sent_of(GetSurface) == asked
    assert robot.agent.receive(SetSurface(["asphalt", None]), 3) == OpAck(id=3)
    robot.live(0.5)
    assert robot.sent_of(SendPos)[-1].status == "asphalt to no road"


def test_it_tells_of_a_thing_once_when_it_comes_near():
    robot = Robot(things=(ScriptedObject(20.0, 0.0, "cone-7"), ScriptedObject(0.0, 90.0, "far")), image=PNG)
    robot.live(1)
    assert not robot.sent_of(SetObject)
    robot.agent.receive(SetPosEnd(20.0, 0.0), 1)
    robot.live(15)
    assert robot.sent_of(SetObject) == [SetObject(20.0, 0.0, "cone-7", source="1")]
    (image,) = robot.sent_of(SendImage)
    assert (image.image, image.object, image.source) == (PNG, "cone-7", "2")
    assert 9.0 < image.x < 12.0


def test_when_time_passes_late_and_at_once_it_drives_as_it_would_have_step_by_step():
    poses = []
    for dt in (DT, 10 * DT):
        robot = Robot()
        robot.agent.receive(SetPath([(8.0, 0.0), (8.0, 8.0)]), 7)
        for _ in range(round(6.0 / dt)):
            robot.agent.step(dt)
        poses.append(robot.agent.pose)
    assert poses[1] == pytest.approx(poses[0], abs=0.01)


def test_it_asks_for_the_next_map_before_it_leaves_one_that_is_a_part(robot):
    def map_around(x, y, meta):
        return SetMap(encode(build_map(Outlines.from_rows([]), Window(x, y, 40.0, 40.0), meta)))

    part = {"part_of": "-500,-500,500,500"}
    robot.agent.receive(map_around(0.0, 0.0, part), 1)
    robot.agent.receive(SetPosEnd(60.0, 0.0), 2)
    robot.live(2)
    assert not robot.sent_of(GetMap)
    robot.live(4)
    (asked,) = robot.sent_of(GetMap)
    assert 10.0 < asked.x < 11.0 and asked.area == 1600.0
    robot.agent.receive(map_around(asked.x + 10, asked.y, part), 3)
    robot.live(2)
    assert len(robot.sent_of(GetMap)) == 1
    robot.agent.receive(map_around(15.0, 0.0, {}), 4)
    robot.live(20)
    assert len(robot.sent_of(GetMap)) == 1
