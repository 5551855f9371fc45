"""Real robots as processes of their own: told by an operator, they drive, arrive, go round and stop."""

from __future__ import annotations

import math

import pytest

from tests.support.bridge.bridge_programs import wait_until

LOOP = [[60.0, 20.0], [66.0, 20.0], [66.0, 24.0], [60.0, 24.0], [60.0, 20.0]]
TARGETS = {"over-websocket": (24.0, 23.0), "over-sql": (44.0, 17.0)}
FULL_LIFE = ["queued", "delivered", "acknowledged", "reached"]


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def desk(bridge):
    """An operator who has sent two robots to targets, one round a loop, and stopped one that drove."""
    bridge.start_robot("over-websocket", (20.0, 20.0, 0.0))
    bridge.start_robot("over-sql", (40.0, 20.0, 0.0), sql=True)
    bridge.start_robot("round", (60.0, 20.0, 0.0))
    bridge.start_robot("stopped", (80.0, 20.0, 0.0))
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots(*TARGETS, "round", "stopped")
    for robot, (x, y) in TARGETS.items():
        desk.send(f"target-{robot}", robot, "SetPosEnd", x=x, y=y)
    desk.send("path-round", "round", "SetPath", points=LOOP)
    desk.send("target-stopped", "stopped", "SetPosEnd", x=180.0, y=20.0)
    desk.until(lambda: (desk.robots["stopped"]["v"] or 0) > 1.0, 15)
    desk.send("abort-stopped", "stopped", "Abort")
    return desk


def steps(command):
    return [step["state"] for step in command["steps"]]


@pytest.mark.parametrize("robot", TARGETS)
def test_a_robot_goes_to_its_target_step_by_step_and_stands_within_20_cm_of_it(desk, robot):
    command = desk.wait_for_step(f"target-{robot}", "reached")
    assert steps(command) == FULL_LIFE
    assert [step["by"] for step in command["steps"]] == ["Ada", "gateway", robot, "gateway"]
    times = [step["at"] for step in command["steps"]]
    assert times == sorted(times)
    assert command["deviation"] <= 0.20
    x, y = TARGETS[robot]
    desk.listen(0.5)
    report = desk.robots[robot]
    assert math.hypot(report["x"] - x, report["y"] - y) <= 0.20
    desk.until(lambda: desk.robots[robot]["v"] == 0.0)
    assert report["link"] == robot.removeprefix("over-")
    assert "command" not in report


def test_abort_stops_a_driving_robot_and_it_stays(desk):
    assert steps(desk.wait_for_step("abort-stopped", "reached")) == FULL_LIFE
    target = desk.wait_for_step("target-stopped", "aborted")
    assert steps(target) == ["queued", "delivered", "acknowledged", "aborted"]
    assert target["steps"][-1]["by"] == "Ada"
    desk.until(lambda: desk.robots["stopped"]["v"] == 0.0)
    stood = desk.robots["stopped"]["x"]
    assert 80.0 < stood < 120.0
    desk.snapshots.clear()

    def seen():
        return [r for s in desk.snapshots for r in s["robots"] if r["robot"] == "stopped"]

    desk.until(lambda: len(seen()) > 5)
    assert all(r["v"] == 0.0 and abs(r["x"] - stood) < 0.1 for r in seen())


def test_a_path_that_ends_where_it_began_is_driven_all_round(desk):
    command = desk.wait_for_step("path-round", "reached")
    assert steps(command) == FULL_LIFE
    seconds = command["steps"][-1]["at"] - command["steps"][2]["at"]
    assert seconds > 20.0 / 5.0  # 20 m at 5 m/s: nobody is there sooner
    seen = [(r["x"], r["y"]) for s in desk.snapshots for r in s["robots"] if r["robot"] == "round"]
    assert math.hypot(seen[-1][0] - 60.0, seen[-1][1] - 20.0) <= 0.20


def test_the_way_of_each_robot_is_stored(desk, bridge):
    desk.wait_for_step("path-round", "reached")

    def stored():
        return bridge.sql("select received_at, x, y from trajectories where robot = 'round' order by id")

    def has(x, y):
        return any(math.hypot(px - x, py - y) < 1.0 for _, px, py in stored())

    for x, y in LOOP:
        wait_until(lambda x=x, y=y: has(x, y))
    times = [at for at, _, _ in stored()]
    assert times == sorted(times)
