"""An emergency stop with real processes: robots that drive stand, and nothing sets them in motion again."""

from __future__ import annotations

import contextlib
import json
import sqlite3
import time

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.wire import RefusedError


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


def watch(bridge, operator="Ada"):
    """Return an operator's connection that hears of everything."""
    desk = bridge.desk(operator)
    desk.ask("subscribe", {"rate": 20})
    return desk


def driving(bridge, desk):
    """Let one robot drive over WebSocket and one over SQL."""
    bridge.start_robot("ws", (20.0, 20.0, 0.0))
    bridge.start_robot("sql", (20.0, 40.0, 0.0), sql=True)
    desk.wait_for_robots("ws", "sql")
    for robot, y in (("ws", 20.0), ("sql", 40.0)):
        desk.send(f"target-{robot}", robot, "SetPosEnd", x=180.0, y=y)
    desk.until(lambda: desk.robots["ws"]["v"] > 2 and desk.robots["sql"]["v"] > 2)


def standing(desk):
    return all(abs(desk.robots[robot]["v"]) < 0.02 for robot in ("ws", "sql"))


def test_robots_stop_and_stay_where_they_are_over_a_restart_until_it_is_cleared(bridge):
    desk, other = watch(bridge), watch(bridge, "Bob")
    driving(bridge, desk)
    report = desk.ask("emergency_stop", {"command": "stop-0001", "reason": "child on the track"})
    assert (report["in_force"], report["stored"], report["robots"]) == (True, True, 2)
    other.until(lambda: other.emergency.get("acknowledged") == 2, 5)
    desk.until(lambda: standing(desk) and desk.emergency["standing"] == 2, 10)
    for robot in ("ws", "sql"):
        assert desk.wait_for_step(f"target-{robot}", "aborted")["steps"][-1]["by"] == "Ada"
        with pytest.raises(
            RefusedError, match=r"emergency stop is in force .* by Ada \(child on the track\)"
        ):
            desk.send(f"again-{robot}", robot, "SetPosEnd", x=180.0, y=30.0)
    places = {robot: desk.robots[robot]["x"] for robot in ("ws", "sql")}

    bridge.kill_gateway()
    bridge.start_gateway()

    desk = watch(bridge)
    assert (desk.emergency["in_force"], desk.emergency["by"]) == (True, "Ada")
    desk.wait_for_robots("ws", "sql")
    desk.until(lambda: all(desk.robots[robot]["pose_age"] < 0.3 for robot in places), 15)
    desk.until(lambda: desk.emergency["acknowledged"] == 2, 15)
    with pytest.raises(RefusedError, match="emergency stop is in force"):
        desk.ask("set_positions", {"positions": [{"robot": "ws", "x": 180.0, "y": 20.0}]})
    desk.listen(0.5)
    assert {robot: desk.robots[robot]["x"] for robot in places} == pytest.approx(places, abs=0.1)

    cleared = desk.ask("clear_emergency_stop", {"reason": "track is free", "stop": "stop-0001"})
    assert (cleared["in_force"], cleared["cleared_by"]) == (False, "Ada")
    for robot, y in (("ws", 20.0), ("sql", 40.0)):
        desk.send(f"onwards-{robot}", robot, "SetPosEnd", x=places[robot] + 3.0, y=y)
        desk.wait_for_step(f"onwards-{robot}", "reached")


def test_a_robot_that_connects_meanwhile_is_stopped_at_once_and_after_its_opack(bridge):
    desk = watch(bridge)
    desk.ask("emergency_stop", {"command": "stop-0001"})
    robot = bridge.robot("late")
    direct = robot.wait_for("Abort")
    assert (direct["id"], direct["params"]) == ("emergency-stop-0001", {"emergency": True})
    robot.ask("Ready", {"magic": 1})
    robot.until(lambda: len(robot.calls) >= 3)
    assert [call["method"] for call in robot.calls] == ["Start", "Abort", "SetMap"]
    stored = robot.wait_for("Abort")
    assert isinstance(stored["id"], int)
    desk.until(lambda: desk.emergency["waiting"] == ["late"])
    robot.say(direct["id"])
    desk.until(lambda: desk.emergency["acknowledged"] == 1)
    robot.say(stored["id"])
    robot.tell("SendPos", {"x": 1.0, "y": 1.0, "theta": 0.0, "v": 0.0})
    desk.until(lambda: desk.emergency["standing"] == 1)


def test_a_stop_reaches_robots_at_once_while_the_database_is_locked_and_is_stored_when_it_is_free(bridge):
    desk = watch(bridge)
    robot = bridge.robot("ws")
    robot.plug_in(1)
    desk.send("target-1", "ws", "SetPosEnd", x=9.0, y=9.0)
    target = robot.wait_for("SetPosEnd")
    robot.say(target["id"])
    desk.wait_for_step("target-1", "acknowledged")
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as hog:
        hog.execute("begin immediate")
        began = time.monotonic()
        desk.connection.send(
            json.dumps(
                {"jsonrpc": "2.0", "id": 99, "method": "emergency_stop", "params": {"command": "stop-0001"}}
            )
        )
        call = robot.wait_for("Abort", 10.0)
        robot.say(call["id"])
        answer = desk.answer(99, 20.0)
        assert time.monotonic() - began > 0.9
        assert (answer["in_force"], answer["stored"]) == (True, False)
        desk.until(lambda: desk.emergency["acknowledged"] == 1)
        hog.execute("rollback")
    desk.until(lambda: desk.emergency["stored"], 15)
    assert bridge.sql("select id from emergency_stops where cleared_at is null") == [("stop-0001",)]
    robot.say(robot.wait_for("Abort")["id"])
    assert desk.wait_for_step("target-1", "aborted")


def test_where_a_robot_is_waits_for_no_acknowledgement_and_is_judged_behind_it(bridge):
    """Who made a stop while the database does not answer wants to see whether the robots stand."""
    desk, robot = watch(bridge), bridge.robot("r1")
    robot.plug_in(1)
    desk.send("target-1", "r1", "SetPosEnd", x=9.0, y=9.0)
    target = robot.wait_for("SetPosEnd")
    desk.wait_for_step("target-1", "delivered")
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as hog:
        hog.execute("begin immediate")
        robot.say(target["id"])
        for x in (7.0, 8.0, 9.0):
            robot.tell("SendPos", {"x": x, "y": 9.0, "theta": 0.0, "v": 0.0})
            desk.until(lambda x=x: desk.robots.get("r1", {}).get("x") == x)
        assert desk.commands["target-1"]["state"] == "delivered"
        hog.execute("rollback")
    # It says no more where it is.
    states = [step["state"] for step in desk.wait_for_step("target-1", "reached")["steps"]]
    assert states[-2:] == ["acknowledged", "reached"]


def test_an_abort_overtakes_what_waits_for_a_robot_that_reads_sql(bridge):
    desk = watch(bridge)
    bridge.sql("insert into rr (robot, op, params) values ('slow', 'Ready', '{\"magic\": 1}')")
    wait_until(lambda: bridge.sql("select id from sa where op = 'SetMap'"))
    desk.ask("emergency_stop", {"command": "stop-0001"})
    rows = bridge.sql("select op, params from sa where robot = 'slow' order by urgent desc, id")
    assert [op for op, _ in rows] == ["Abort", "OpAck", "SetMap"]
    assert json.loads(rows[0][1]) == {"emergency": True}


def test_one_robot_is_aborted_by_the_command_that_it_carries_out(bridge):
    desk, robot = watch(bridge), bridge.robot("r1")
    robot.plug_in(1)
    desk.send("target-1", "r1", "SetPosEnd", x=9.0, y=9.0)
    robot.say(robot.wait_for("SetPosEnd")["id"])
    desk.wait_for_step("target-1", "acknowledged")
    desk.ask("abort", {"command": "abort-0001", "aborts": "target-1", "reason": "wrong cone"})
    robot.say(robot.wait_for("Abort")["id"])
    last = desk.wait_for_step("target-1", "aborted")["steps"][-1]
    assert (last["by"], last["reason"]) == ("Ada", "the robot acknowledged the Abort: wrong cone")
    with pytest.raises(RefusedError, match="command target-1 has ended or was never issued"):
        desk.ask("abort", {"command": "abort-0002", "aborts": "target-1"})


def test_the_latency_of_each_link_is_measured_and_told(bridge):
    desk = watch(bridge)
    bridge.start_robot("ws", (20.0, 20.0, 0.0))
    bridge.start_robot("sql", (20.0, 40.0, 0.0), sql=True)
    desk.wait_for_robots("ws", "sql")
    desk.send("target-sql", "sql", "SetPosEnd", x=21.0, y=40.0)
    for robot in ("ws", "sql"):
        desk.until(lambda robot=robot: desk.robots[robot].get("latency") is not None, 20)
        assert 0 < desk.robots[robot]["latency"] < 2


# --- what robots said, and what they do ---------------------------------------------------------------------


def where(robot, x, v=0.0):
    robot.tell("SendPos", {"x": x, "y": 1.0, "theta": 0.0, "v": v})


def stood(bridge, desk):
    """Return a robot that drove, was stopped, said so, and was seen to stand at x = 1."""
    robot = bridge.robot("r1")
    robot.plug_in(1)
    where(robot, 1.0, 2.0)
    desk.ask("emergency_stop", {"command": "stop-0001"})
    # Told over its connection, and by the command that is stored.
    for _ in range(2):
        robot.say(robot.wait_for("Abort")["id"])
    desk.until(lambda: desk.emergency["acknowledged"] == 1)
    where(robot, 1.0)
    desk.until(lambda: desk.emergency["standing"] == 1)
    assert (desk.emergency["moving"], desk.emergency["unheard"]) == ([], [])
    return robot


def test_a_robot_that_drives_on_after_it_stood_does_not_count_as_standing(bridge):
    desk = watch(bridge)
    robot = stood(bridge, desk)
    where(robot, 1.5, 2.0)
    desk.until(lambda: desk.emergency["moving"] == ["r1"])
    assert (desk.emergency["acknowledged"], desk.emergency["standing"]) == (1, 0)
    wait_until(lambda: "r1: moves although it was seen to stand after a stop" in bridge.output())
    where(robot, 2.0)
    desk.until(lambda: desk.emergency["moving"] == [] and desk.emergency["standing"] == 1)


def test_a_robot_that_says_no_speed_while_its_positions_change_moves(bridge):
    """Pushed, rolling down a slope, or wrong about itself."""
    desk = watch(bridge)
    robot = stood(bridge, desk)
    for centimetres in range(110, 160, 10):
        where(robot, centimetres / 100)
        desk.listen(0.05)
    desk.until(lambda: desk.emergency["moving"] == ["r1"])
    assert desk.emergency["standing"] == 0

    def rests():
        where(robot, 1.5)
        return desk.emergency["standing"] == 1

    desk.until(rests)
    assert desk.emergency["moving"] == []


def test_a_robot_that_stood_and_is_not_heard_any_more_is_not_said_to_stand(bridge):
    desk = watch(bridge)
    robot = stood(bridge, desk)
    robot.hang_up()
    desk.until(lambda: desk.emergency["unheard"] == ["r1"])
    assert (desk.emergency["acknowledged"], desk.emergency["standing"]) == (1, 0)


def test_after_a_restart_only_robots_that_are_heard_are_said_to_stand(bridge):
    desk = watch(bridge)
    stood(bridge, desk).hang_up()
    bridge.kill_gateway()
    bridge.start_gateway()
    desk = watch(bridge)
    desk.until(lambda: desk.emergency["in_force"])
    assert (desk.emergency["standing"], desk.emergency["unheard"]) == (0, ["r1"])


def test_operators_hear_of_a_stop_in_force_again_and_again(bridge):
    """Who hears nothing for some seconds is not to take what was said last for what is so now."""
    desk = watch(bridge)
    desk.ask("emergency_stop", {"command": "stop-0001"})
    desk.listen(0.2)
    for _ in range(2):
        desk.emergency = {}
        desk.until(lambda: desk.emergency.get("in_force"))
