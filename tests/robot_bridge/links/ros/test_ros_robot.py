"""When a ROS robot is announced, and what goes wrong with it while it is stopped."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest

from robot_bridge.core.messages.robots import SendPos
from robot_bridge.links.base.linked_robots import LinkedRobot
from robot_bridge.links.ros.adapter import FAULT_LASTS, RobotNotes, RosAdapter
from robot_bridge.links.ros.effects import Abilities, RosAction
from robot_bridge.links.ros.robot import ABLE_WITHIN, RosRobot
from robot_bridge.links.ros.settings import RobotSettings, TopicSettings

HERE = SendPos(1.0, 2.0, 0.0, 1.0)
NAV2 = frozenset({RosAction.TO_POSE})
SETTINGS = RobotSettings(topics=TopicSettings(stop="/{robot}/stop"))


class Link:
    """Keeps what is reported."""

    def __init__(self):
        self.can, self.positions, self.said = {}, [], {}

    def add(self, robot, abilities, *, path_cones=False):
        self.can[robot] = list(abilities)

    def position(self, robot, position):
        self.positions.append(position)

    def stopped(self, robot):
        pass

    def report(self, **said):
        self.said = said


class Side:
    """The robots' side, both halves of it: what it is sent, and what it does is for the test to say."""

    server = feedback = None

    def __init__(self, abilities, position=None):
        self.abilities, self.position = abilities, position
        self.sent, self.answer, self.broken = [], None, set()

    def connect(self, network):
        self._fail("connect")

    def hears(self, setting):
        return False

    def poll(self, *acting):
        self._fail("poll" if acting else "hear")
        if not acting:
            return self.position
        if self.answer is not None:
            acting[0].stop_answered(True, "")
            acting[0].cancel_answered(RosAction.TO_POSE, 0)
        return []

    def publish_zero(self):
        self.sent.append("zero")
        self._fail("zero")

    def call(self, setting):
        self.sent.append(setting)

    def cancel(self, request):
        self.sent.append("cancel")

    def forget_feedback(self):
        pass

    def _fail(self, what):
        if what in self.broken:
            raise KeyError(what)


class Adapter(RosAdapter[None]):
    """An adapter whose loop is the test's."""

    async def run(self, link):
        raise NotImplementedError


class Rig:
    """One robot of an adapter; time stands until a test lets it pass."""

    def __init__(self, tmp_path, abilities, position=None, settings=SETTINGS):
        self.link, self.side, self.now = Link(), Side(abilities, position), 1000.0
        self.adapter = Adapter(settings, RobotNotes(tmp_path / "notes"))
        sensing = SimpleNamespace(faults={}, diagnosis=None, pose=None, fix=None)

        def make(name):
            return RosRobot(name, settings, self.link, sensing, self.side, self.side, None, None)

        self.make = make

    def meet(self, topics=("/r1/odom",), servers=()):
        self.adapter._find(list(topics), set(servers), None, self.make, self.now)

    def pass_time(self, seconds):
        for _ in range(round(seconds * 10)):
            self.now += 0.1
            self.adapter._step(self.now)
            self.adapter._report(self.link)

    async def begin_stop(self, monkeypatch):
        """Begin a stop at the rig's time."""
        monkeypatch.setattr("time.monotonic", lambda: self.now)
        stopping = asyncio.create_task(self.adapter.stop("r1", emergency=True))
        await asyncio.sleep(0)
        return stopping


@pytest.mark.parametrize(
    "abilities",
    [
        Abilities(velocity=True),
        Abilities(stop_service=True),
        Abilities(NAV2, foreign=NAV2),
    ],
    ids=["cmd_vel", "stop service", "action of another distribution"],
)
async def test_a_robot_that_can_be_stopped_alone_is_not_only_seen(tmp_path, abilities, monkeypatch):
    rig = Rig(tmp_path, abilities, HERE)
    rig.meet()
    rig.pass_time(ABLE_WITHIN + 1)
    assert rig.link.can == {"r1": ["stop"]}
    assert not LinkedRobot("r1", tuple(rig.link.can["r1"])).is_only_seen
    stopping = await rig.begin_stop(monkeypatch)
    assert rig.side.sent != []
    stopping.cancel()

    rig.side.abilities = Abilities(NAV2, velocity=True)
    rig.pass_time(ABLE_WITHIN + 2)
    assert set(rig.link.can["r1"]) == {"stop", "targets"}


def test_a_robot_of_which_nothing_can_be_stopped_is_only_seen(tmp_path):
    rig = Rig(tmp_path, Abilities(), HERE)
    rig.meet()
    rig.pass_time(ABLE_WITHIN + 1)
    assert rig.link.can == {"r1": []}


@pytest.mark.parametrize("found_by", [("/r1/odom", ""), ("", "/r1/navigate_to_pose"), ("", "/r1/stop")])
async def test_a_robot_that_says_no_position_is_announced_by_its_servers_and_stopped(
    tmp_path, monkeypatch, found_by
):
    rig = Rig(tmp_path, Abilities(NAV2, velocity=True, stop_service=True))
    rig.meet(*([name] for name in found_by))
    rig.pass_time(ABLE_WITHIN + 1)
    assert rig.link.can == {"r1": ["targets"]} and rig.link.positions == []
    stopping = await rig.begin_stop(monkeypatch)
    assert {"zero", "cancel", "stop"} <= set(rig.side.sent)
    rig.side.answer = True
    rig.pass_time(1)
    await stopping


def test_a_topic_that_nobody_publishes_on_and_nobody_serves_is_no_robot(tmp_path):
    rig = Rig(tmp_path, Abilities())
    rig.meet(servers=["/r1/other", "/a/b/navigate_to_pose"])
    rig.pass_time(ABLE_WITHIN + 1)
    assert rig.link.can == {}


@pytest.mark.parametrize("broken", ["hear", "zero"])
async def test_what_nobody_foresaw_keeps_a_robot_from_no_stop(tmp_path, monkeypatch, broken):
    rig = Rig(tmp_path, Abilities(NAV2, velocity=True, stop_service=True), HERE)
    rig.meet()
    rig.side.broken = {broken} & {"hear"}
    rig.pass_time(ABLE_WITHIN + 1)
    assert rig.link.can == {"r1": ["targets"]}

    rig.side.broken = {broken}
    stopping = await rig.begin_stop(monkeypatch)
    assert {"zero", "cancel", "stop"} <= set(rig.side.sent)
    rig.side.sent.clear()
    rig.pass_time(1)
    assert rig.side.sent.count("zero") >= 5 and {"cancel", "stop"} <= set(rig.side.sent)
    assert "r1: the link failed; its log says more" in rig.link.said["text"]
    rig.side.answer = True
    rig.pass_time(1)
    if broken == "hear":
        await stopping
    else:
        # Something of it was not sent, and its Abort has failed for the desk.
        with pytest.raises(KeyError):
            await stopping


async def test_a_stop_is_repeated_while_the_servers_say_what_nobody_foresaw(tmp_path, monkeypatch):
    rig = Rig(tmp_path, Abilities(NAV2, velocity=True, stop_service=True), HERE)
    rig.meet()
    rig.pass_time(ABLE_WITHIN + 1)
    rig.side.broken = {"poll"}
    stopping = await rig.begin_stop(monkeypatch)
    rig.side.sent.clear()
    rig.pass_time(1)
    assert rig.side.sent.count("zero") >= 5 and {"cancel", "stop"} <= set(rig.side.sent)
    stopping.cancel()


def test_the_alarm_about_what_nobody_foresaw_ends_with_it(tmp_path):
    rig = Rig(tmp_path, Abilities(NAV2), HERE)
    rig.side.broken = {"hear"}
    rig.meet()
    rig.pass_time(1)
    assert not rig.link.said["ok"]
    rig.side.broken = set()
    # What fails now and then is no alarm that comes and goes with each step.
    rig.pass_time(FAULT_LASTS - 1)
    assert not rig.link.said["ok"]
    rig.pass_time(1)
    assert rig.link.said["ok"]


def test_the_alarm_about_a_robot_that_could_not_be_connected_ends_when_it_is(tmp_path):
    rig = Rig(tmp_path, Abilities(NAV2), HERE)
    rig.side.broken = {"connect"}
    rig.meet()
    rig.side.broken = set()
    rig.pass_time(FAULT_LASTS + 1)
    assert not rig.link.said["ok"]
    rig.meet()
    rig.pass_time(0.1)
    assert rig.link.said["ok"]
