"""Programs that are killed: nothing is lost, nothing done twice, everybody comes back by himself."""

from __future__ import annotations

import itertools
import json
import math

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.older_state import OlderState, abort_there


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


def steps(command):
    return [step["state"] for step in command["steps"]]


def watch(bridge):
    """Return an operator's connection that hears of everything."""
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    return desk


def test_a_gateway_killed_while_robots_drive_goes_on_where_it_stopped(bridge):
    bridge.start_robot("ws", (20.0, 20.0, 0.0))
    bridge.start_robot("sql", (40.0, 40.0, 0.0), sql=True)
    idle, unheard = bridge.robot("idle"), bridge.robot("unheard")
    idle.plug_in(5)
    unheard.plug_in(6)
    desk = watch(bridge)
    desk.wait_for_robots("ws", "sql")
    for robot, x, y in (
        ("ws", 34.0, 20.0),
        ("sql", 54.0, 40.0),
        ("idle", 10.0, 10.0),
        ("unheard", 60.0, 10.0),
    ):
        desk.send(f"target-{robot}", robot, "SetPosEnd", x=x, y=y)
    for robot in ("ws", "sql"):
        desk.wait_for_step(f"target-{robot}", "acknowledged")
    first = idle.wait_for("SetPosEnd")
    desk.wait_for_step("target-idle", "delivered")
    unheard.say(unheard.wait_for("SetPosEnd")["id"])
    desk.wait_for_step("target-unheard", "acknowledged")
    unheard.hang_up()
    desk.until(lambda: desk.robots["ws"]["v"] > 1 and desk.robots["sql"]["v"] > 1)
    # Nobody asks for it again.
    assert desk.ask("abort", {"command": "abort-unheard", "robot": "unheard"})["state"] == "queued"

    bridge.kill_gateway()
    bridge.start_gateway()

    desk = watch(bridge)
    # What was reached before this desk was there is reported to it no more.
    desk.commands |= {c["command"]: c for c in desk.ask("get_commands")["commands"]}
    assert desk.commands["target-idle"]["state"] == "delivered"
    for robot in ("ws", "sql"):
        assert desk.wait_for_step(f"target-{robot}", "reached", 20)
        assert steps(desk.commands[f"target-{robot}"]) == ["queued", "delivered", "acknowledged", "reached"]
    idle = bridge.robot("idle")
    idle.ask("Ready", {"magic": 5})
    again = idle.wait_for("SetPosEnd")
    assert again == first  # the same message under the same id: a robot that did it does nothing
    idle.say(again["id"])
    desk.wait_for_step("target-idle", "acknowledged")
    unheard = bridge.robot("unheard")
    unheard.ask("Ready", {"magic": 6})
    unheard.say(unheard.wait_for("Abort")["id"])
    assert desk.wait_for_step("target-unheard", "aborted")["steps"][-1]["by"] == "Ada"
    assert bridge.sql("select robot, op from sa where op <> 'SetMap' and op <> 'OpAck'") == []


def test_a_robot_that_is_killed_and_started_again_is_sent_its_task_again(bridge):
    robot = bridge.start_robot("r1", (20.0, 20.0, 0.0))
    desk = watch(bridge)
    desk.wait_for_robots("r1")
    desk.send("target-1", "r1", "SetPosEnd", x=30.0, y=20.0)
    desk.wait_for_step("target-1", "acknowledged")
    desk.until(lambda: desk.robots["r1"]["v"] > 1)
    robot.kill()
    robot.wait(5)
    bridge.start_robot("r1", (27.0, 20.0, 0.0))
    command = desk.wait_for_step("target-1", "reached")
    assert steps(command) == ["queued", "delivered", *["acknowledged"] * 3, "reached"]
    reasons = [step.get("reason") for step in command["steps"]]
    assert reasons[3:5] == ["robot r1 started anew; sent once more", "acknowledged again"]
    assert math.hypot(desk.robots["r1"]["x"] - 30.0, desk.robots["r1"]["y"] - 20.0) <= 0.2


def start_on_each_wire(bridge, folder):
    """Start a robot on each wire that remembers in ``folder``; return the processes by name."""
    return {
        name: bridge.start_robot(
            name, (20.0, y, 0.0), sql=name == "sql", options=["--memory", folder / f"{name}.json"]
        )
        for name, y in (("ws", 20.0), ("sql", 40.0))
    }


def test_robots_that_remember_are_killed_and_go_on_with_their_tasks_by_themselves(bridge, tmp_path):
    robots = start_on_each_wire(bridge, tmp_path)
    desk = watch(bridge)
    desk.wait_for_robots(*robots)
    for name in robots:
        desk.send(f"target-{name}", name, "SetPosEnd", x=45.0, y=desk.robots[name]["y"])
    for name, robot in robots.items():
        desk.wait_for_step(f"target-{name}", "acknowledged")
        desk.until(lambda name=name: desk.robots[name]["x"] > 24)
        robot.kill()
        robot.wait(5)
    start_on_each_wire(bridge, tmp_path)
    for name in robots:
        command = desk.wait_for_step(f"target-{name}", "reached")
        assert steps(command) == ["queued", "delivered", "acknowledged", "reached"]


def test_cones_that_were_put_down_before_their_robots_were_killed_are_not_put_down_again(bridge, tmp_path):
    def remembered(name):
        return json.loads((tmp_path / f"{name}.json").read_text())

    robots = start_on_each_wire(bridge, tmp_path)
    desk = watch(bridge)
    desk.wait_for_robots(*robots)
    for name in robots:
        desk.send(f"target-{name}", name, "SetPosEnd", x=40.0, y=desk.robots[name]["y"], cone=True)
    for name in robots:
        desk.wait_for_step(f"target-{name}", "acknowledged")
        # It has asked for its path, and stands until it is known.
        wait_until(lambda name=name: not remembered(name)["awaits_path"], 30)
    # They come to their end, and nobody hears of it.
    bridge.kill_gateway()
    wait_until(lambda: all(remembered(name)["way"] == [] for name in robots), 30)
    for robot in robots.values():
        robot.kill()
        robot.wait(5)
    bridge.sql("delete from rr")
    bridge.start_gateway()
    desk = watch(bridge)
    start_on_each_wire(bridge, tmp_path)
    for name in robots:
        command = desk.wait_for_step(f"target-{name}", "reached")
        assert steps(command) == ["queued", "delivered", "acknowledged", "reached"]
    assert bridge.sql("select op from sa where op = 'SetPosEnd'") == []


def test_a_robot_that_is_killed_and_then_aborted_does_not_drive_on_when_it_comes_back(bridge):
    robot = bridge.start_robot("r1", (20.0, 20.0, 0.0), sql=True)
    desk = watch(bridge)
    desk.wait_for_robots("r1")
    desk.send("target-1", "r1", "SetPosEnd", x=90.0, y=20.0)
    desk.wait_for_step("target-1", "acknowledged")
    robot.kill()
    robot.wait(5)
    desk.send("abort-of-1", "r1", "Abort")
    bridge.start_robot("r1", (26.0, 20.0, 0.0), sql=True)
    desk.wait_for_step("abort-of-1", "reached")
    assert desk.commands["target-1"]["state"] == "aborted"
    desk.listen(0.5)
    assert abs(desk.robots["r1"]["x"] - 26.0) < 0.2


def test_a_robot_that_connects_anew_is_served_on_its_new_connection(bridge):
    first = bridge.robot("r1")
    first.plug_in(1)
    first.tell("SendPos", {"x": 1.0, "y": 1.0, "theta": 0.0, "v": 0.0})
    second = bridge.robot("r1")
    second.plug_in(1)
    second.tell("SendPos", {"x": 2.0, "y": 2.0, "theta": 0.0, "v": 0.0})
    wait_until(lambda: first.connection.close_code is not None or _drain(first))
    assert (first.connection.close_code, first.connection.close_reason) == (
        4001,
        "the robot has connected anew",
    )
    desk = watch(bridge)
    desk.send("target-1", "r1", "SetPosEnd", x=5.0, y=5.0)
    assert second.wait_for("SetPosEnd")["params"]["x"] == 5.0
    desk.until(lambda: desk.robots["r1"].get("x") == 2.0)
    assert desk.robots["r1"]["state"] == "fresh"


def _drain(wire):
    """Read what is there, so that a close can be seen."""
    from websockets.exceptions import ConnectionClosed

    try:
        wire.connection.recv(0.1)
    except (TimeoutError, ConnectionClosed):
        return False


def test_robots_wait_for_a_gateway_that_is_not_there_yet(bridge):
    bridge.kill_gateway()
    bridge.start_robot("ws", (20.0, 20.0, 0.0))
    bridge.start_robot("sql", (40.0, 40.0, 0.0), sql=True)
    wait_until(lambda: "trying again in" in bridge.output())
    wait_until(lambda: bridge.sql("select op from rr where robot = 'sql' and op = 'Ready'"))
    bridge.start_gateway()
    watch(bridge).wait_for_robots("ws", "sql")


def test_what_robots_wrote_while_the_gateway_was_away_is_dealt_with(bridge):
    bridge.kill_gateway()
    params = {"x": 3.0, "y": 4.0, "theta": 0.0, "v": 0.0}
    for op, values in (("Ready", {"magic": 3}), ("SendPos", params), ("Stopped", {})):
        bridge.sql("insert into rr (robot, op, params) values ('late', ?, ?)", op, json.dumps(values))
    bridge.start_gateway()
    desk = watch(bridge)
    desk.wait_for_robots("late")
    assert (desk.robots["late"]["x"], desk.robots["late"]["stopped"]) == (3.0, True)
    wait_until(lambda: bridge.sql("select count(*) from rr") == [(0,)])
    assert [op for (op,) in bridge.sql("select op from sa order by id")] == ["OpAck", "SetMap", "OpAck"]


OLDER = "It counts as another one from now on"


@pytest.fixture
def noting_bridge(start_bridge, sample_site, new_database, tmp_path, request):
    """A gateway with a state folder of its own, on a database of a kind."""
    bridge = start_bridge(sample_site, new_database.another(request.param), ["--state", tmp_path])
    yield bridge
    bridge.end()


def drive_on(bridge, desk, robot):
    """Send a robot on three times; return when the gateway has noted the last message."""
    for y in (20.0, 21.0, 22.0):
        desk.send(f"target-{y:g}", robot, "SetPosEnd", x=180.0, y=y)
        desk.wait_for_step(f"target-{y:g}", "acknowledged")
    newest = max(id for (id,) in bridge.sql("select sa_id from commands"))
    wait_until(lambda: (note_of(bridge) or {}).get("newest_message", 0) >= newest)


def note_of(bridge):
    """Return what the gateway has noted of its database, None before that."""
    folder = bridge.file.parent if bridge.database.startswith("sqlite") else bridge.options[1]
    ((id,),) = bridge.sql("select value from bridge where name = 'id'")
    notes = [json.loads(file.read_text()) for file in folder.glob("newest-message-*.json")]
    return next((note for note in notes if note["database"] == id), None)


# Whose program has the file of SQLite open itself finds that another one is there, and stores nothing in it.
@pytest.mark.parametrize(
    ("noting_bridge", "robot"),
    [("sqlite", "ws"), *itertools.product(("postgresql", "mariadb"), ("ws", "sql"))],
    indirect=["noting_bridge"],
)
def test_an_abort_stops_a_robot_though_the_database_was_put_back_to_an_older_state(
    noting_bridge, tmp_path, robot
):
    """The ids of that one's next messages are known to a robot that was there all along."""
    bridge = noting_bridge
    bridge.start_robot(robot, (20.0, 20.0, 0.0), sql=robot == "sql", options=["--speed", "0.5"])
    desk = watch(bridge)
    desk.wait_for_robots(robot)
    older = OlderState(bridge.database, tmp_path)
    drive_on(bridge, desk, robot)

    bridge.kill_gateway()
    older.put_back()
    bridge.start_gateway()

    wait_until(lambda: OLDER in bridge.output())
    abort_there(watch(bridge), robot)
    # It is the same database for the next gateway.
    bridge.kill_gateway()
    bridge.start_gateway()
    # All of its log is written when it has ended.
    bridge.end()
    assert bridge.output().count(OLDER) == 1
