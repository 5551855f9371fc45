"""A gateway that starts with a clock that stood still without power, and that the network sets right later.

libfaketime gives one process a clock of its own; everybody else goes by the computer's.
"""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from tests.support.bridge.bridge_programs import Bridge, wait_until
from tests.support.fleet import serve
from tests.support.processes import Processes

LIBRARY = next(iter(sorted(Path("/usr/lib").glob("*/faketime/libfaketime.so.1"))), None)
DAY = 86400.0
FIRST, SECOND = "stop-by-the-right-clock", "stop-by-the-wrong-clock"
AHEAD = (40.0, 8.0)
AFTER_IT = 6
"""Reports to the desk after the gateway has noticed that its clock was set."""


class ClockedBridge(Bridge):
    """A gateway whose clock can be behind; those of the robots and of this program are right."""

    def __init__(self, processes, site, database, folder):
        super().__init__(processes, site, database)
        self._file = folder / "clock"

    def start_gateway_behind(self, seconds):
        self.set_clock_behind(seconds)
        settings = {
            "LD_PRELOAD": str(LIBRARY),
            "FAKETIME_TIMESTAMP_FILE": str(self._file),
            "FAKETIME_CACHE_DURATION": "1",
            # Nobody sets the clock that only counts on.
            "FAKETIME_DONT_FAKE_MONOTONIC": "1",
        }
        where = self._processes, self.site, self.database
        served = serve(*where, port=self.port, name=self._unique("gateway"), env=settings)
        self.gateway, self.address, self.port = served.process, served.address, served.port

    def set_clock_behind(self, seconds):
        self._file.write_text(f"-{seconds:.0f}" if seconds else "+0")


@pytest.fixture
def bridge(tmp_path, sample_site, new_database):
    if LIBRARY is None:
        pytest.skip("libfaketime is not on this machine; run: make setup")
    with Processes(tmp_path / "logs") as processes:
        bridge = ClockedBridge(processes, sample_site, new_database("sqlite"), tmp_path)
        yield bridge
        bridge.end()


def say_place(robot, x, v=1.0):
    robot.tell("SendPos", {"x": x, "y": 8.0, "theta": 0.0, "v": v, "t": time.time()})


def queue_of(desk):
    (queue,) = desk.ask("get_queue", {"robot": "r1"})["queues"]
    return queue


def test_a_clock_of_1970_is_set_right_while_robots_drive_and_back_again(bridge):
    bridge.start_gateway()
    leave_work_behind(bridge)
    bridge.kill_gateway()

    bridge.start_gateway_behind(time.time())
    for text in ("says 1970-01-01", "the clock is behind now"):
        wait_until(lambda text=text: text in bridge.output())
    desk, robot = bridge.desk(), bridge.robot("r1")
    robot.plug_in(1)
    say_place(robot, 20.0)
    # Nobody knows for how long no gateway was there.
    wait_until(lambda: queue_of(desk)["state"] == "paused")
    desk.send("by-the-wrong-clock", "r1", "SetPosEnd", x=AHEAD[0], y=AHEAD[1])
    robot.obey_until("SetPosEnd")
    desk.ask("subscribe", {"rate": 20.0})
    desk.until(lambda: desk.robots.get("r1", {}).get("state") == "fresh")
    desk.snapshots.clear()
    drive_until_clock_is_set(bridge, desk, robot, 0)
    say_place(robot, AHEAD[0], v=0.0)
    report = desk.wait_for_step("by-the-wrong-clock", "reached")
    assert report["steps"][0]["at"] < DAY < report["steps"][-1]["at"]
    places = desk.ask("get_trajectory", {"robots": ["r1"], "since": time.time() - DAY})["places"]
    assert places
    drive_until_clock_is_set(bridge, desk, robot, time.time())
    seen = [row for snapshot in desk.snapshots for row in snapshot["robots"]]
    assert {row["state"] for row in seen} == {"fresh"}
    # Until the gateway has noticed, a tick or two of ages is told by a clock that has jumped.
    wrong = [row for row in seen if not (-1 < row["age"] < 3 and -1 < row["pose_age"] < 3)]
    assert len(wrong) < len(seen) / 2 and seen[-1] not in wrong
    desk.ask("emergency_stop", {"command": SECOND, "reason": "seen"})
    robot.obey_until("Abort")
    desk.until(lambda: desk.emergency["acknowledged"] == 1)
    bridge.kill_gateway()

    bridge.start_gateway()
    with bridge.desk() as desk:
        assert (desk.emergency["in_force"], desk.emergency["stop"]) == (True, SECOND)
        assert desk.emergency["at"] < DAY
        assert queue_of(desk)["state"] == "paused" and queue_of(desk)["tasks"]


def leave_work_behind(bridge):
    """Have the right clock know of a robot with a queue, and of an emergency stop that was cleared."""
    desk, robot = bridge.desk(), bridge.robot("r1")
    robot.plug_in(1)
    say_place(robot, 20.0)
    desk.ask("emergency_stop", {"command": FIRST, "reason": "seen"})
    # At once, and as the message that is stored.
    robot.obey_until("Abort")
    robot.obey_until("Abort")
    say_place(robot, 20.0, v=0.0)
    desk.until(lambda: desk.emergency["standing"] == 1)
    desk.ask("clear_emergency_stop", {"stop": FIRST, "reason": "seen"})
    tasks = [{"task": f"task-000{n}", "kind": "drive", "x": 30.0 + n, "y": 8.0} for n in (1, 2)]
    desk.ask("set_queue", {"robot": "r1", "revision": 0, "tasks": tasks})
    robot.until(lambda: [call for call in robot.calls if call["method"] in ("SetPath", "SetPosEnd")])
    wait_until(lambda: bridge.sql("select count(*) from trajectories") != [(0,)])


def drive_until_clock_is_set(bridge, desk, robot, behind):
    """Have the gateway's clock set, and the robot drive until some reports after the gateway has noticed."""
    noticed = bridge.output().count("the clock of this computer was set")
    bridge.set_clock_behind(behind)

    def has_noticed():
        say_place(robot, 20.0 + time.monotonic() % 1.0)
        robot.listen(0.05)
        desk.listen(0.05)
        return bridge.output().count("the clock of this computer was set") > noticed

    wait_until(has_noticed, what="the clock was not seen to be set")
    enough = len(desk.snapshots) + AFTER_IT

    def has_driven_on():
        say_place(robot, 20.0 + time.monotonic() % 1.0)
        robot.listen(0.05)
        desk.listen(0.05)
        return len(desk.snapshots) >= enough

    wait_until(has_driven_on, what="robots were not reported after the clock was set")
