"""Two real robots under one account, one that comes back, and one that finds another database."""

from __future__ import annotations

import signal
import time

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.processes import freeze
from tests.support.robots.robot_wires import WIRES

LINKS = pytest.mark.parametrize("sql", [False, True], ids=["websocket", "sql"])


@pytest.fixture
def bridge(start_bridge, impatient_site):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture
def desk(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    return desk


@LINKS
def test_a_second_robot_is_kept_out_until_the_first_is_gone(bridge, desk, sql):
    first = bridge.start_robot("twin", (20.0, 20.0, 0.0), sql=sql)
    desk.wait_for_robots("twin")
    # The second one would be seen far away.
    second = bridge.start_robot("twin", (150.0, 100.0, 0.0), sql=sql)
    wait_until(lambda: "another robot runs as 'twin'" in bridge.output(), 15)
    desk.send("to-the-first", "twin", "SetPosEnd", x=30.0, y=20.0)
    desk.wait_for_step("to-the-first", "reached")
    seen = [robot["x"] for snapshot in desk.snapshots for robot in snapshot["robots"] if "x" in robot]
    assert max(seen) < 31
    assert second.poll() is None

    first.kill()
    desk.until(lambda: desk.robots["twin"]["x"] > 149, 10)
    desk.send("to-the-second", "twin", "SetPosEnd", x=155.0, y=100.0)
    desk.wait_for_step("to-the-second", "reached")


@LINKS
def test_a_robot_that_was_killed_and_started_again_keeps_its_name_and_its_task(bridge, desk, sql):
    robot = bridge.start_robot("phoenix", (20.0, 20.0, 0.0), sql=sql)
    desk.wait_for_robots("phoenix")
    desk.send("long-way", "phoenix", "SetPosEnd", x=120.0, y=20.0)
    desk.wait_for_step("long-way", "acknowledged")
    robot.kill()
    robot.wait(5)
    bridge.start_robot("phoenix", (110.0, 20.0, 0.0), sql=sql)
    # On SQL it has to wait until the killed one counts as stale, 0.8 s on this site.
    desk.until(lambda: desk.robots["phoenix"]["x"] > 105, 10)
    desk.wait_for_step("long-way", "reached")
    assert set(desk.robots) == {"phoenix"}


def test_a_robot_that_hangs_gives_way_after_a_second(bridge, desk):
    robot = bridge.start_robot("frozen", (20.0, 20.0, 0.0), options=["--rate", "50"])
    desk.wait_for_robots("frozen")
    freeze(robot.pid)
    try:
        began = time.monotonic()
        newcomer = WIRES["websocket"](bridge, "frozen")
        assert newcomer.ask("Ready", {"magic": 7})["robot"] == "frozen"
        assert time.monotonic() - began < 18
    finally:
        robot.send_signal(signal.SIGCONT)
    # The one that hung finds that it was replaced, and ends.
    assert robot.wait(BUSY * 10) != 0
    assert "give each its own --name" in bridge.output()


def test_robots_forget_the_ids_of_another_database(bridge, desk):
    bridge.start_robot("walker", (20.0, 20.0, 0.0))
    desk.wait_for_robots("walker")
    for number, x in enumerate((25.0, 30.0)):
        desk.send(f"target-{number}", "walker", "SetPosEnd", x=x, y=20.0)
        desk.wait_for_step(f"target-{number}", "reached")
    used = max(id for (id,) in bridge.sql("select sa_id from commands"))
    bridge.kill_gateway()
    for file in bridge.file.parent.glob(f"{bridge.file.name}*"):
        file.unlink()
    bridge.start_gateway()
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots("walker")
    desk.send("target-anew", "walker", "SetPosEnd", x=35.0, y=20.0)
    desk.wait_for_step("target-anew", "reached")
    assert bridge.sql("select sa_id from commands") <= [(used,)], "the id was not one that the robot had seen"
