"""A robot that is started anew goes on as the run before it, and does nothing once more."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import BridgeError
from robot_bridge.core.messages.robots import (
    Abort,
    GetPath,
    OpAck,
    Ready,
    SendPos,
    SetPath,
    SetPosEnd,
    Stopped,
)
from robot_bridge.reference_robot.agent import Agent, AgentSettings, RememberedRun, RobotMemory
from robot_bridge.reference_robot.body import BodyLimits

LAP = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]


class Runs:
    """One robot's runs, one after the other: what each said, and where it was."""

    def __init__(self, memory):
        self.memory = memory
        self.magic = 40
        self.asks_path = False

    def start(self, database="first"):
        self.magic += 1
        self.sent = []
        limits = BodyLimits(speed=3.0)
        settings = AgentSettings(
            self.magic, (0.0, 0.0, 0.0), limits, noise=0.0, asks_path=self.asks_path, memory=self.memory
        )
        self.agent = Agent(settings, SimpleNamespace(say=self.sent.append))
        self.agent.greet()
        (ready,) = self.sent
        self.agent.receive(OpAck(magic=ready.magic, robot="r1", database=database), None)
        return self

    def live(self, seconds):
        for _ in range(round(seconds / 0.05)):
            self.agent.step(0.05)
        return self.agent.pose


@pytest.fixture
def runs(tmp_path) -> Runs:
    return Runs(RobotMemory(tmp_path / "r1.json"))


def test_without_a_file_each_run_is_another():
    runs = Runs(None)
    assert [runs.start().sent[0] for _ in range(2)] == [
        Ready(41, path_cones=True),
        Ready(42, path_cones=True),
    ]


def test_every_run_with_one_file_is_the_same_to_the_gateway(runs):
    assert [runs.start().sent[0] for _ in range(2)] == [Ready(41, path_cones=True)] * 2


def test_a_target_under_way_is_driven_to_its_end_and_what_was_done_is_not_done_again(runs):
    runs.start().agent.receive(SetPosEnd(9.0, 0.0, 1.0), 7)
    before = runs.live(3)
    assert 1.0 < before[0] < 8.0
    runs.start()
    assert math.dist(runs.agent.pose[:2], before[:2]) < 3.5
    assert runs.agent.receive(SetPosEnd(9.0, 0.0, 1.0), 7) == OpAck(id=7)
    assert runs.live(12) == pytest.approx((9.0, 0.0, 1.0), abs=0.1)
    assert isinstance(runs.sent[-1], SendPos)
    assert runs.sent.count(Stopped()) == 1


def test_one_that_was_not_told_its_path_yet_asks_for_it_and_does_not_drive_straight(runs):
    runs.asks_path = True
    runs.start().agent.receive(SetPosEnd(9.0, 0.0, 1.0), 7)
    runs.start()
    assert GetPath() in runs.sent
    assert runs.live(3)[:2] == pytest.approx((0.0, 0.0), abs=0.01)
    runs.agent.receive(SetPath([(0.0, 0.0), (0.0, 2.0)], 1.0), 8)
    assert runs.live(8) == pytest.approx((0.0, 2.0, 1.0), abs=0.1)


def test_one_that_had_come_to_its_end_stays_there_and_says_so(runs):
    runs.start().agent.receive(SetPosEnd(2.0, 0.0), 7)
    place = runs.live(8)
    runs.start()
    assert runs.live(2) == pytest.approx(place, abs=0.05)
    assert Stopped() in runs.sent


def test_of_a_lap_only_what_is_left_is_driven(runs):
    runs.start().agent.receive(SetPath(LAP), 7)
    while runs.live(0.5)[1] < 8.0:
        pass
    runs.start()
    farthest = max(runs.live(0.1)[0] for _ in range(150))
    assert farthest == pytest.approx(10.0, abs=0.3)
    assert runs.agent.pose[:2] == pytest.approx((0.0, 0.0), abs=0.1)
    assert runs.agent._body.driven < 30.0


def test_what_was_aborted_is_not_gone_on_with(runs):
    runs.start().agent.receive(SetPosEnd(9.0, 0.0), 7)
    runs.live(2)
    runs.agent.receive(Abort(), 8)
    place = runs.live(2)
    runs.start()
    assert runs.live(3) == pytest.approx(place, abs=0.2)


def test_in_another_database_the_same_id_is_another_message(runs):
    runs.start().agent.receive(SetPosEnd(2.0, 0.0), 7)
    runs.live(8)
    runs.start("second").agent.receive(SetPosEnd(4.0, 0.0), 7)
    assert runs.live(8)[0] == pytest.approx(4.0, abs=0.1)


def test_a_task_is_on_the_disk_before_it_is_acknowledged(runs):
    kept = []
    runs.start()
    runs.memory.keep = kept.append
    runs.agent.receive(SetPosEnd(9.0, 0.0), 7)
    assert (kept[-1].done, kept[-1].way) == ([7], [(9.0, 0.0)])


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"pose": [1, 2], "way": []}', '{"pose": [1, 2, 3], "way": [1]}']
)
def test_a_file_that_is_no_memory_is_refused_with_what_to_do(tmp_path, text):
    file = tmp_path / "r1.json"
    file.write_text(text)
    with pytest.raises(BridgeError, match=r"r1\.json is none of a robot .*; name another file, or delete it"):
        RobotMemory(file).recall()


def test_a_file_that_cannot_be_written_is_refused_and_what_was_in_it_stays(tmp_path, monkeypatch):
    memory = RobotMemory(tmp_path / "r1.json")
    memory.keep(RememberedRun(magic=1))
    monkeypatch.setattr("os.fsync", full_disk)
    with pytest.raises(
        BridgeError, match=r"r1\.json cannot be written: No space left on device; check its folder"
    ):
        memory.keep(RememberedRun(magic=2))
    assert json.loads((tmp_path / "r1.json").read_text())["magic"] == 1


def full_disk(_file):
    raise OSError(28, "No space left on device")
