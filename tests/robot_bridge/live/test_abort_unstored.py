"""An Abort goes out though the database takes nothing, or has a table locked; whoever asked is told."""

from __future__ import annotations

import contextlib
import sqlite3
import time
from pathlib import Path

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.database_client import LOCKS, DatabaseClient, tables_locked
from tests.support.robots.robot_wires import SqlRobot
from tests.support.wire import RefusedError

MOTIONS = ("SetPath", "SetPosEnd")


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


@contextlib.contextmanager
def locked(bridge):
    """Hold the lock of the database's writer, as a backup or a tool may that hangs."""
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as connection:
        connection.execute("begin immediate")
        yield
        connection.execute("rollback")


@pytest.mark.parametrize("asked", ["abort", "send", "abort_all"])
def test_an_abort_that_cannot_be_stored_is_sent_and_refused_visibly(bridge, asked):
    robot, other, desk = bridge.robot("r1"), bridge.robot("r2"), bridge.desk()
    robot.plug_in(1)
    other.plug_in(2)
    desk.send("target-it-1", "r1", "SetPosEnd", x=50.0, y=40.0)
    robot.say(robot.wait_for("SetPosEnd")["id"])
    desk.wait_for_step("target-it-1", "acknowledged")
    params = {
        "abort": {"command": "abort-it-1", "robot": "r1"},
        "send": {"command": "abort-it-1", "robot": "r1", "op": "Abort"},
        "abort_all": {"command": "abort-it-1"},
    }[asked]
    with locked(bridge):
        with pytest.raises(RefusedError, match="The Abort is not stored; it was sent to r1") as refused:
            desk.ask(asked, params, 30.0)
        heard = robot.wait_for("Abort")
    assert heard["id"].startswith("abort-") and heard["params"] == {"emergency": False}
    if asked == "abort_all":
        assert other.wait_for("Abort")["params"] == {"emergency": False}
        assert "r2" in str(refused.value)
    robot.say(heard["id"])
    robot.say(robot.wait_for("Abort", 30.0)["id"])
    assert desk.wait_for_step("target-it-1", "aborted")


def test_an_abort_that_could_not_be_stored_outlives_the_gateway(bridge):
    """The gateway is killed before the database takes anything again: the next one stores the Abort first."""
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    desk.send("target-it-1", "r1", "SetPosEnd", x=50.0, y=40.0)
    robot.wait_for("SetPosEnd")
    desk.wait_for_step("target-it-1", "delivered")
    with locked(bridge):
        with pytest.raises(RefusedError, match="The Abort is not stored; it was sent to r1"):
            desk.ask("abort", {"command": "abort-it-1", "robot": "r1"}, 30.0)
        robot.wait_for("Abort")
        bridge.kill_gateway()
    bridge.start_gateway()
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    abort = robot.wait_for("Abort", 30.0)
    assert [call for call in robot.calls if call["method"] in MOTIONS] == []
    robot.say(abort["id"])
    assert desk.wait_for_step("target-it-1", "aborted")
    assert desk.wait_for_step("abort-it-1", "acknowledged")["operator"] == "Ada"
    robot.calls.clear()
    robot.plug_in(1)
    # What waits for the robot comes in order: nothing was before this.
    desk.send("target-it-2", "r1", "SetPosEnd", x=30.0, y=40.0)
    assert robot.wait_for("SetPosEnd")["params"]["x"] == 30.0
    wait_until(lambda: not Path(f"{bridge.file}.aborts").exists())


def stand(robot):
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0, "t": time.time()})


def test_a_robot_stands_whose_pause_cannot_be_stored_and_its_queue_waits_afterwards(bridge):
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    stand(robot)
    tasks = [{"task": f"task-000{n}", "kind": "drive", "x": 30.0 + n, "y": 8.0} for n in (1, 2)]
    desk.ask("set_queue", {"robot": "r1", "revision": 0, "tasks": tasks})
    (driven,) = robot.until(lambda: [call for call in robot.calls if call["method"] in MOTIONS])
    robot.say(driven["id"])
    robot.calls.clear()
    desk.until(lambda: "acknowledged" in {command["state"] for command in desk.commands.values()})
    with locked(bridge):
        text = "The pause is not stored; an Abort was sent to r1 all the same; it is stored and sent as"
        with pytest.raises(RefusedError, match=text):
            desk.ask("pause_robot", {"robot": "r1"}, 30.0)
        assert robot.wait_for("Abort")["id"].startswith("abort-")
    abort = robot.wait_for("Abort", 30.0)
    stand(robot)
    robot.say(abort["id"])
    queue = wait_until(
        lambda: next((q for q in desk.ask("get_queue")["queues"] if q["state"] == "paused"), None)
    )
    assert [task["task"] for task in queue["tasks"]] == ["task-0001", "task-0002"]
    # By its answer what was sent before has come.
    robot.ask("Alive")
    assert [call for call in robot.calls if call["method"] in MOTIONS] == []


@pytest.fixture(params=sorted(LOCKS))
def served(start_bridge, sample_site, new_database, request):
    bridge = start_bridge(sample_site, new_database(request.param))
    yield bridge
    bridge.end()


@pytest.fixture
def reader(served):
    """A robot on SQL that drives to a target."""
    robot = SqlRobot(served.database, "s1")
    robot.ask("Ready", {"magic": 1})
    robot.hear("SetMap")
    desk = served.desk()
    desk.send("target-it-1", "s1", "SetPosEnd", x=50.0, y=40.0)
    robot.hear("SetPosEnd")
    desk.wait_for_step("target-it-1", "acknowledged")
    yield robot
    robot.close()


def test_a_stop_comes_to_robots_on_sql_while_tables_are_locked_that_they_do_not_read(served, reader):
    desk = served.desk()
    with tables_locked(served.database, "commands", "emergency_stops"):
        state = desk.ask("emergency_stop", {"command": "stop-0001", "reason": "smoke"}, 30.0)
        assert (state["in_force"], state["stored"]) == (True, False)
        assert reader.hear("Abort") == {"emergency": True}
    desk.until(lambda: desk.emergency["stored"], 60.0)
    assert reader.hear("Abort") == {"emergency": True}
    desk.wait_for_step("target-it-1", "aborted")


@pytest.mark.parametrize("whom", [{"robot": "s1"}, {"aborts": "target-it-1"}])
def test_an_abort_comes_to_a_robot_on_sql_while_no_command_can_be_stored(served, reader, whom):
    desk = served.desk()
    params = {"command": "abort-it-1", **whom}
    text = r"somebody else has it locked.*The Abort is not stored; it was sent to s1 all the same; it is "
    with tables_locked(served.database, "commands"):
        with pytest.raises(RefusedError, match=text):
            desk.ask("abort", params, 30.0)
        assert reader.hear("Abort") == {"emergency": False}
    assert reader.hear("Abort") == {"emergency": False}
    desk.wait_for_step("target-it-1", "aborted")


def test_what_one_session_has_locked_keeps_nobody_from_what_is_not_locked(served, reader):
    """Robots come in and are shown, and desks are answered, whatever waits for the table beside them."""
    driven, desk = served.robot("r1"), served.desk()
    driven.plug_in(1)
    desk.send("target-it-2", "r1", "SetPosEnd", x=50.0, y=40.0)
    target = driven.wait_for("SetPosEnd")
    desk.wait_for_step("target-it-2", "delivered")
    with tables_locked(served.database, "commands"):
        driven.say(target["id"])
        asked = [desk.begin("get_commands", {"limit": 5}) for _ in range(3)]
        new = served.robot("r2")
        assert new.ask("Ready", {"magic": 2}, seconds=30.0)["ok"]
        assert new.wait_for("SetMap")
        for one in asked:
            with pytest.raises(RefusedError, match="somebody else has it locked"):
                desk.answer(one, 30.0)
    # It is asked again for what could not be stored.
    driven.say(driven.wait_for("SetPosEnd", 30.0)["id"])
    desk.wait_for_step("target-it-2", "acknowledged")
    assert len(desk.ask("get_commands", {"limit": 5})["commands"]) == 2


def test_a_robot_on_its_way_that_connects_again_hears_an_abort_while_robots_are_locked(served, reader):
    """New robots are let in, too, and those on SQL answered, while positions wait; all is stored later."""
    driven, desk = served.robot("r1"), served.desk()
    driven.plug_in(1)
    desk.send("target-it-2", "r1", "SetPosEnd", x=50.0, y=40.0)
    driven.say(driven.wait_for("SetPosEnd")["id"])
    desk.wait_for_step("target-it-2", "acknowledged")
    with tables_locked(served.database, "robots", "trajectories"):
        stand(driven)
        again, new = served.robot("r1"), served.robot("r3")
        assert again.ask("Ready", {"magic": 1}, seconds=30.0)["ok"]
        assert desk.ask("abort", {"command": "abort-it-2", "robot": "r1"}, 30.0)["state"] == "queued"
        again.say(again.wait_for("Abort")["id"])
        stand(again)
        assert new.ask("Ready", {"magic": 3}, seconds=30.0)["ok"]
        assert new.wait_for("SetMap")
        stand(new)
        reader.tell("SendPos", {"x": 40.0, "y": 8.0, "theta": 0.0, "v": 0.0, "t": time.time()})
        reader.ask("GetMap", {"x": 60.0, "y": 60.0, "area": 2500.0})
        desk.wait_for_step("target-it-2", "aborted")
    with contextlib.closing(DatabaseClient(served.database)) as client:
        wait_until(lambda: client.sql("select name from robots where name = 'r3'"), 20)
        for name in ("r1", "r3", "s1"):
            wait_until(lambda name=name: client.sql(f"select 1 from trajectories where robot = '{name}'"), 20)


def test_a_robot_that_restarts_hears_an_abort_while_robots_are_locked(served):
    """It is let in as soon as its new run can be stored."""
    desk = served.desk()
    with served.robot("r1") as before:
        before.plug_in(1)
        desk.send("target-it-1", "r1", "SetPosEnd", x=50.0, y=40.0)
        before.say(before.wait_for("SetPosEnd")["id"])
        desk.wait_for_step("target-it-1", "acknowledged")
    with tables_locked(served.database, "robots"):
        robot = served.robot("r1")
        with pytest.raises(RefusedError, match="locked"):
            robot.ask("Ready", {"magic": 2}, seconds=30.0)
        desk.ask("abort", {"command": "abort-it-1", "robot": "r1"}, 30.0)
        assert robot.wait_for("Abort")["id"] == "abort-abort-it-1"
        robot.calls.clear()
        with tables_locked(served.database, "commands"):
            with pytest.raises(RefusedError, match="The Abort is not stored; it was sent to r1"):
                desk.ask("abort", {"command": "abort-it-2", "robot": "r1"}, 30.0)
            assert robot.wait_for("Abort")["id"] == "abort-abort-it-2"
    robot.calls.clear()
    robot.plug_in(2)
    desk.wait_for_step("target-it-1", "aborted")
    # By its answer what was sent before has come.
    robot.ask("Alive")
    assert [call for call in robot.calls if call["method"] in MOTIONS] == []
