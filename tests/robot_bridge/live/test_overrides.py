"""Overrides of what an operator's desk found, and the map sent when asked for, at a real gateway."""

from __future__ import annotations

import pytest

from robot_bridge.protocol.jsonrpc import FORBIDDEN
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_wires import RefusedError
from tests.support.bridge.either_wire import WIRES

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


def audited(desk, action: str, about: str, count: int = 1) -> list[dict]:
    """Return the ``count`` entries of ``action`` whose detail holds ``about``, newest first."""

    def found() -> list[dict]:
        entries = desk.ask("get_audit", {"limit": 100})["entries"]
        return [one for one in entries if one["action"] == action and about in one["detail"]]

    # The log is written after the answer.
    wait_until(lambda: len(found()) >= count, 15, f"{count} entries of {action} about {about}")
    return found()


def test_an_override_takes_a_supervisor_and_stands_in_the_log_and_the_audit(desks, robot):
    refusal = "Operator is operator, and an override takes supervisor"
    with pytest.raises(RefusedError, match=refusal) as caught:
        desks["operator"].ask("send", target("override-one", override=WHY))
    assert caught.value.code == FORBIDDEN
    done = desks["supervisor"].ask("send", target("override-two", override=WHY, reason="for the test"))
    assert done["steps"][0]["reason"] == f"override: {WHY}; for the test"
    (newest,) = audited(desks["supervisor"], "send", "override-two")
    (refused,) = audited(desks["supervisor"], "send", "override-one")
    assert (newest["who"], newest["done"]) == ("Supervisor", True)
    assert newest["detail"].startswith(f"{WHY}; ")
    assert (refused["who"], refused["done"]) == ("Operator", False)
    assert WHY in refused["detail"]


def test_a_long_command_does_not_push_its_override_out_of_the_audit(desks, robot):
    path = {"op": "SetPath", "params": {"points": [[20.0 + 0.001 * k, 8.0] for k in range(2000)]}}
    desks["supervisor"].ask("send", target("override-three", override=WHY) | path)
    assert audited(desks["supervisor"], "send", "override-three")[0]["detail"].startswith(f"{WHY}; ")


def test_tasks_of_a_queue_take_an_override_likewise(desks, robot):
    asked = {"robot": "r1", "revision": 0, "tasks": [{"task": "task-override", "x": 30.0, "y": 8.0}]}
    with pytest.raises(RefusedError, match="add_tasks: Operator is operator, and an override takes"):
        desks["operator"].ask("add_tasks", {**asked, "override": WHY})
    assert desks["supervisor"].ask("add_tasks", {**asked, "override": WHY})["revision"] == 1


INTO = {"x": 66.0, "y": 32.0}
"""A place in the sample site's water basin."""
BASIN = r"\(66\.00, 32\.00\) lies in the keepout 'Water basin'"


def test_a_target_in_a_keepout_is_refused_until_one_who_may_overrides_it(desks, robot):
    with pytest.raises(RefusedError, match=BASIN):
        desks["operator"].ask("send", target("keepout-one", params=INTO))
    with pytest.raises(RefusedError, match="an override takes supervisor"):
        desks["operator"].ask("send", target("keepout-one", params=INTO, override=WHY))
    sent = desks["supervisor"].ask("send", target("keepout-one", params=INTO, override=WHY))
    assert sent["state"] == "queued"
    done, forbidden, refused = audited(desks["supervisor"], "send", "keepout-one", 3)
    assert [one["done"] for one in (done, forbidden, refused)] == [True, False, False]
    assert "lies in the keepout 'Water basin'" in refused["detail"]


@pytest.mark.parametrize("method", ["set_queue", "add_tasks", "take_over"])
def test_so_is_a_task_of_a_queue(bridge, desks, method):
    name, other = f"{method}-1", f"{method}-2"
    robots = [bridge.robot(name), bridge.robot(other)]
    for robot in robots:
        robot.plug_in(1)
    task = {"task": f"task-{method}", **INTO}
    asked = {"robot": name, "revision": 0, "tasks": [task]}
    if method == "take_over":
        # A queue whose robot waits, with a task that is handed over with a path through the basin.
        desks["operator"].ask("pause_queue", {"robot": name})
        task = {**task, "x": 66.0, "y": 40.0}
        desks["operator"].ask("add_tasks", {**asked, "revision": 1, "tasks": [task]})
        through = {"task": task["task"], "path": [[66.0, 20.0], [66.0, 40.0]]}
        asked = {
            "robot": name,
            "revision": 2,
            "shares": [{"robot": other, "revision": 0, "tasks": [through]}],
        }
    with pytest.raises(RefusedError, match="the keepout 'Water basin'") as refused:
        desks["operator"].ask(method, asked)
    assert refused.value.code == -32007
    assert str(refused.value).startswith("; ".join(refused.value.data["found"]))
    with pytest.raises(RefusedError, match=f"{method}: Operator is operator, and an override takes"):
        desks["operator"].ask(method, {**asked, "override": WHY})
    desks["supervisor"].ask(method, {**asked, "override": WHY})


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
    assert audited(desks["supervisor"], "send_map", robot.name)[0]["subject"] == robot.name
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
