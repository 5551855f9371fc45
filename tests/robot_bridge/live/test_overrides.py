"""Overrides of what an operator's desk found, and the map sent when asked for, at a real gateway."""

from __future__ import annotations

import pytest
from bridge_wires import RefusedError
from either_wire import WIRES

from robot_bridge.jsonrpc import FORBIDDEN

WHY = "enters the keepout Loading bay; because: the bay is cleared"


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def desks(bridge, accounts_of):
    accounts = accounts_of(bridge)
    return {role: bridge.desk(**accounts.operator(role.title(), role)) for role in ("operator", "supervisor")}


@pytest.fixture
def robot(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    return robot


def target(command: str, **more) -> dict:
    return {"command": command, "robot": "r1", "op": "SetPosEnd", "params": {"x": 30.0, "y": 8.0}, **more}


def audited(desk, action: str) -> list[dict]:
    return [one for one in desk.ask("get_audit", {"limit": 100})["entries"] if one["action"] == action]


def test_an_override_takes_a_supervisor_and_stands_in_the_log_and_the_audit(desks, robot):
    refusal = "Operator is operator, and an override takes supervisor"
    with pytest.raises(RefusedError, match=refusal) as caught:
        desks["operator"].ask("send", target("override-one", override=WHY))
    assert caught.value.code == FORBIDDEN
    done = desks["supervisor"].ask("send", target("override-two", override=WHY, reason="for the test"))
    assert done["steps"][0]["reason"] == f"override: {WHY}; for the test"
    newest, refused = audited(desks["supervisor"], "send")[:2]
    assert (newest["who"], newest["done"]) == ("Supervisor", True)
    assert newest["detail"].startswith(f"{WHY}; ")
    assert (refused["who"], refused["done"]) == ("Operator", False)
    assert WHY in refused["detail"]


def test_a_long_command_does_not_push_its_override_out_of_the_audit(desks, robot):
    path = {"op": "SetPath", "params": {"points": [[20.0 + 0.001 * k, 8.0] for k in range(2000)]}}
    desks["supervisor"].ask("send", target("override-three", override=WHY) | path)
    assert audited(desks["supervisor"], "send")[0]["detail"].startswith(f"{WHY}; ")


def test_tasks_of_a_queue_take_an_override_likewise(desks, robot):
    asked = {"robot": "r1", "revision": 0, "tasks": [{"task": "task-override", "x": 30.0, "y": 8.0}]}
    with pytest.raises(RefusedError, match="add_tasks: Operator is operator, and an override takes"):
        desks["operator"].ask("add_tasks", {**asked, "override": WHY})
    assert desks["supervisor"].ask("add_tasks", {**asked, "override": WHY})["revision"] == 1


@pytest.mark.parametrize("text", ["", "  ", "two\nlines", "x" * 1001])
def test_an_override_says_something_in_one_line(desks, robot, text):
    with pytest.raises(RefusedError, match="override has"):
        desks["supervisor"].ask("send", target("override-four", override=text))


def test_a_site_may_leave_overrides_to_operators(start_bridge, limited_site, accounts_of):
    bridge = start_bridge(limited_site('[commands]\noverride_role = "operator"\n'))
    desk = bridge.desk(**accounts_of(bridge).operator("Operator", "operator"))
    robot = bridge.robot("r1")
    robot.plug_in(1)
    assert desk.ask("send", target("override-five", override=WHY))["state"] == "queued"


@pytest.mark.parametrize("wire", sorted(WIRES))
def test_a_robot_is_sent_the_map_when_an_operator_asks(desks, bridge, wire):
    robot = WIRES[wire](bridge, f"mapped-over-{wire}")
    robot.name = robot.ask("Ready", {"magic": 1})["robot"]
    first = robot.hear("SetMap")
    assert desks["operator"].ask("send_map", {"robot": robot.name}) == {}
    assert robot.hear("SetMap") == first
    assert audited(desks["supervisor"], "send_map")[0]["subject"] == robot.name
    robot.close()


def test_a_robot_that_is_not_there_is_sent_no_map(desks, bridge):
    with pytest.raises(RefusedError, match="robot 'nobody' is not known to this gateway"):
        desks["operator"].ask("send_map", {"robot": "nobody"})
    gone = WIRES["websocket"](bridge, "r7")
    gone.name = gone.ask("Ready", {"magic": 1})["robot"]
    gone.hear("SetMap")
    gone.ask("Stopped", {})
    gone.close()
    desks["operator"].ask("subscribe", {"rate": 50})
    desks["operator"].until(lambda: desks["operator"].robots.get("r7", {}).get("state") == "offline")
    with pytest.raises(RefusedError, match="robot 'r7' is offline; it is sent the map by itself"):
        desks["operator"].ask("send_map", {"robot": "r7"})
