"""Queues with the real programs: driven to their end whoever is killed, each task once."""

from __future__ import annotations

import random

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.wire import RefusedError

CONES = [(26.0 + 4 * n, 20.0 + (n % 2)) for n in range(4)]


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


class Operator:
    """An operator's connection that also keeps every cone that was put down."""

    def __init__(self, bridge):
        self.desk = bridge.desk()
        self.queues, self.placed = self.desk.queues, {}
        hear = self.desk._hear

        def listen(frame):
            hear(frame)
            if frame["method"] == "placement":
                self.placed[frame["params"]["task"]] = frame["params"]

        self.desk._hear = listen
        self.desk.ask("subscribe", {"rate": 20})
        self.queues.update({q["robot"]: q for q in self.ask("get_queue")["queues"]})

    def ask(self, method, **params):
        return self.desk.ask(method, params)

    def set(self, robot, tasks):
        self.queues[robot] = self.ask("set_queue", robot=robot, revision=0, tasks=tasks)

    def until(self, condition, seconds=60):
        return self.desk.until(condition, seconds)

    def left(self, robot):
        return [task["task"] for task in self.queues[robot]["tasks"]]


def cone(n, start=None, whose="cone", beside=0.0):
    """A task for the cone number ``n`` of a row, which lies so many metres ``beside`` the first."""
    x, y = CONES[n][0], CONES[n][1] + beside
    task = {"task": f"{whose}-task-{n}", "kind": "place", "x": x, "y": y, "cone": f"{whose}{n}"}
    task["layout"] = "row"
    return task if start is None else {**task, "path": [start, (x, y)]}


def driven_once(bridge, count):
    """Check that every task was sent once, reached, and measured once."""
    rows = bridge.sql("select state, attempts from queue_tasks")
    assert rows == [("done", 1)] * count
    assert bridge.sql("select count(*), count(distinct task) from placements") == [(count, count)]
    assert bridge.sql("select count(*) from commands where state <> 'reached'") == [(0,)]
    ((worst,),) = bridge.sql("select max(deviation) from placements")
    assert worst <= 0.20


def test_a_gateway_killed_at_any_moment_loses_no_task_and_has_none_driven_twice(bridge):
    operator = Operator(bridge)
    # One on each wire, 20 m from the other.
    for robot, beside in (("ws", 0.0), ("sql", 20.0)):
        begins = [(20.0, 20.0 + beside), *((x, y + beside) for x, y in CONES)]
        bridge.start_robot(robot, (*begins[0], 0.0), sql=robot == "sql")
        operator.desk.wait_for_robots(robot)
        operator.set(robot, [cone(n, begins[n] if n % 2 else None, robot, beside) for n in range(4)])
    dice = random.Random(5)
    # At each transaction in turn it dies in the crash plays, without processes of its own.
    for _ in range(3):
        operator.desk.listen(dice.uniform(0.1, 0.8))
        bridge.kill_gateway()
        bridge.start_gateway()
        operator = Operator(bridge)
    for robot in ("ws", "sql"):
        operator.until(lambda robot=robot: operator.left(robot) == [])
        assert operator.queues[robot]["state"] == "running"
    driven_once(bridge, 8)


def test_a_gateway_killed_between_two_tasks_sends_the_next_when_it_is_back(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 20.0, "y": 20.0, "theta": 0.0, "v": 0.0})
    operator = Operator(bridge)
    operator.set("r1", [cone(0), cone(1)])
    first = robot.wait_for("SetPosEnd")
    robot.say(first["id"])
    operator.until(lambda: operator.desk.commands and _state(operator) == "acknowledged")
    robot.tell("SendPos", {"x": CONES[0][0], "y": CONES[0][1], "theta": 0.0, "v": 0.0})
    operator.until(lambda: _state(operator) == "reached")
    bridge.kill_gateway()
    bridge.start_gateway()
    robot = bridge.robot("r1")
    robot.ask("Ready", {"magic": 1})
    robot.tell("SendPos", {"x": CONES[0][0], "y": CONES[0][1], "theta": 0.0, "v": 0.0})
    second = robot.wait_for("SetPosEnd")
    assert (second["params"]["x"], second["params"]["y"]) == CONES[1]
    assert bridge.sql("select count(*) from commands") == [(2,)]
    assert bridge.sql("select task from placements") == [("cone-task-0",)]


def _state(operator):
    return next(iter(operator.desk.commands.values()))["state"]


def test_others_take_over_what_a_killed_robot_has_left(start_bridge, giving_up_site):
    bridge = start_bridge(giving_up_site)
    killed = bridge.start_robot("r1", (20.0, 20.0, 0.0))
    bridge.start_robot("r2", (20.0, 30.0, 0.0))
    bridge.start_robot("r3", (20.0, 40.0, 0.0), sql=True)
    operator = Operator(bridge)
    operator.desk.wait_for_robots("r1", "r2", "r3")
    operator.set("r1", [cone(n) for n in range(4)])
    operator.until(lambda: len(operator.left("r1")) <= 3)
    killed.kill()
    killed.wait(5)
    operator.until(lambda: operator.queues["r1"]["robot_state"] in ("lost", "offline"))
    left = operator.left("r1")
    assert left[-1] == "cone-task-3"
    revision = operator.queues["r1"]["revision"]
    shares = [
        {"robot": robot, "revision": 0, "tasks": [{"task": task} for task in left[n::2]]}
        for n, robot in enumerate(("r2", "r3"))
    ]
    with pytest.raises(RefusedError, match="to be lost"):
        operator.ask("take_over", robot="r1", revision=revision, shares=shares[:1])
    operator.ask("take_over", robot="r1", revision=revision, shares=shares)
    operator.until(lambda: all(operator.queues.get(r, {}).get("tasks") == [] for r in ("r1", "r2", "r3")))
    assert {task for (task,) in bridge.sql("select task from placements")} == {
        f"cone-task-{n}" for n in range(4)
    }
    assert bridge.sql("select count(*) from queue_tasks where state = 'done'") == [(4,)]
    # Back again, it is told to stop, and drives to none of them.
    bridge.start_robot("r1", (22.0, 22.0, 0.0))
    operator.until(lambda: operator.queues["r1"]["robot_state"] == "fresh" or _stands(operator, "r1"))
    operator.desk.listen(1.0)
    assert abs(operator.desk.robots["r1"]["x"] - 22.0) < 0.2
    assert bridge.sql("select count(*) from placements") == [(4,)]


def _stands(operator, robot):
    return operator.desk.robots[robot]["state"] == "fresh"


def test_an_older_edit_is_refused_with_the_queue_as_it_is(bridge):
    bridge.robot("r1").plug_in(1)
    operator, other = Operator(bridge), Operator(bridge)
    operator.set("r1", [cone(0), cone(1)])
    with pytest.raises(RefusedError) as refused:
        other.ask("set_queue", robot="r1", revision=0, tasks=[cone(2)])
    assert refused.value.code == -32006
    assert [task["task"] for task in refused.value.data["tasks"]] == ["cone-task-0", "cone-task-1"]
    assert refused.value.data["revision"] == 1
    noted = "select who, subject, done from audit where action = 'set_queue' order by id"
    wait_until(lambda: bridge.sql(noted) == [("Ada", "r1", 1), ("Ada", "r1", 0)])
