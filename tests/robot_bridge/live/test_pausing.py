"""Real robots are paused on their way, with the real programs: they stand, and go on from there, once."""

from __future__ import annotations

import math

import pytest

END = (66.0, 24.0)
UNHURRIED = ("--speed", "2.5")
"""On a busy machine, too, the robot is still on its way when it is told to stand."""


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


def watch(bridge):
    """Return an operator's connection that hears of everything."""
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.queues.update({queue["robot"]: queue for queue in desk.ask("get_queue")["queues"]})
    return desk


def pause_on_the_way(desk, robot):
    """Pause a robot once it drives; return where it stands when what it did waits in its queue."""
    desk.until(lambda: (desk.robots[robot]["v"] or 0) > 1.0, 15)
    report = desk.ask("pause_robot", {"robot": robot, "reason": "people on the road"})
    assert (report["state"], report["reason"]) == ("paused", "paused by Ada: people on the road")
    desk.queues.setdefault(robot, report)
    desk.until(lambda: [one["state"] for one in desk.queues[robot]["tasks"]] == ["waiting"], 15)
    desk.until(lambda: desk.robots[robot]["v"] == 0.0, 15)
    return where(desk, robot)


def where(desk, robot):
    return desk.robots[robot]["x"], desk.robots[robot]["y"]


def go_on(desk, *robots):
    for robot in robots:
        desk.ask("resume_queue", {"robot": robot, "revision": desk.queues[robot]["revision"]})
    desk.until(lambda: all(desk.queues[robot]["tasks"] == [] for robot in robots), 60)


def test_a_route_that_was_sent_directly_is_driven_to_its_end_once_also_if_the_gateway_is_killed(bridge):
    # One on each wire, 20 m from the other.
    ways = {"ws": 20.0, "sql": 40.0}
    ends = {robot: (END[0], END[1] + y - 20.0) for robot, y in ways.items()}
    for robot, y in ways.items():
        bridge.start_robot(robot, (20.0, y, 0.0), sql=robot == "sql", options=UNHURRIED)
    desk = watch(bridge)
    desk.wait_for_robots(*ways)
    for robot, y in ways.items():
        desk.send(f"command-{robot}", robot, "SetPath", points=[[20.0, y], [60.0, y], ends[robot]])
    stand = {robot: pause_on_the_way(desk, robot) for robot in ways}
    assert all(20.0 < x < 59.0 for x, _ in stand.values())
    bridge.kill_gateway()
    bridge.start_gateway()
    desk = watch(bridge)
    desk.wait_for_robots(*ways)
    for robot, place in stand.items():
        assert desk.queues[robot]["state"] == "paused"
        # Until it is back it is shown where the gateway stored it last, which may be metres behind.
        desk.until(lambda robot=robot, place=place: math.dist(place, where(desk, robot)) < 0.5)
    go_on(desk, *ways)
    for robot, end in ends.items():
        assert math.dist(end, where(desk, robot)) < 0.3
        steps = bridge.sql("select op, state from commands where robot = ? order by sa_id", robot)
        assert steps == [("SetPath", "aborted"), ("Abort", "reached"), ("SetPath", "reached")]
    assert bridge.sql("select state, attempts from queue_tasks") == [("done", 2)] * 2


def test_a_cone_that_was_sent_directly_is_put_down_once(bridge):
    bridge.start_robot("r1", (20.0, 20.0, 0.0), options=UNHURRIED)
    desk = watch(bridge)
    desk.wait_for_robots("r1")
    desk.send("command-cone", "r1", "SetPosEnd", x=60.0, y=20.0, cone=True)
    pause_on_the_way(desk, "r1")
    assert bridge.sql("select count(*) from placements") == [(0,)]
    go_on(desk, "r1")
    ((x, y),) = bridge.sql("select x, y from placements")
    assert math.dist((60.0, 20.0), (x, y)) < 0.3
