"""The role escalation table, cell by cell: every role asks for everything, over a real WebSocket."""

from __future__ import annotations

import json
import re
import uuid
from pathlib import Path

import pytest

from robot_bridge.core.messages.base import DESK_REQUESTS
from robot_bridge.protocol.jsonrpc import FORBIDDEN
from tests.support.wire import RefusedError

VIEWER, OPERATOR, SUPERVISOR = "viewer", "operator", "supervisor"
ROLES = [VIEWER, OPERATOR, SUPERVISOR]

GUIDE = (Path(__file__).parents[4] / "docs" / "desk-protocol.md").read_text(encoding="utf-8")

LEAST = {
    method: role
    for role, methods in re.findall(r"^\| (viewer|operator|supervisor) \| (`.*`) \|$", GUIDE, re.MULTILINE)
    for method in re.findall(r"`(\w+)`", methods)
}
"""What the guide for integrators says: who changes what a request declares has to mean it."""

EXAMPLES = [json.loads(text) for text in re.findall(r"^```json desk-sends\n(.*?)^```", GUIDE, re.M | re.S)]


def params(method):
    """Return parameters that are understood; whether they are done does not matter here.

    They are those of the guide's example, but for those that would change what this test goes by.
    """
    target = {"robot": "nobody", "x": 1.0, "y": 1.0}
    queue = {"robot": "nobody", "revision": 0}
    known = {
        "set_queue": {**queue, "tasks": []},
        "add_tasks": {**queue, "tasks": []},
        "move_task": {**queue, "task": "some-task"},
        "remove_task": {**queue, "task": "some-task"},
        "make_current": {**queue, "task": "some-task"},
        "pause_queue": {"robot": "nobody"},
        "pause_robot": {"robot": "nobody"},
        "resume_queue": queue,
        "take_over": {**queue, "shares": []},
        "submit_plan": {"plan": "p", "document": {}, "cones": []},
        "pause_plan": {"plan": "p"},
        "clear_plan": {"plan": "p"},
        "resume_plan": {"plan": "p", "revision": 1},
        "replan": {"plan": "p", "revision": 1},
        "confirm_replan": {"plan": "p", "revision": 1},
        "discard_replan": {"plan": "p", "revision": 1},
        "hello": {"operator": "anyone"},
        "send": {"command": str(uuid.uuid4()), "robot": "nobody", "op": "Abort"},
        "send_map": {"robot": "nobody"},
        "set_positions": {"positions": [target]},
        "abort": {"command": str(uuid.uuid4()), "robot": "nobody"},
        "emergency_stop": {"command": str(uuid.uuid4())},
        "clear_emergency_stop": {"reason": "clear"},
        "get_image": {"observation": 1},
        "review_observation": {"observation": 1, "accept": False, "reason": "no"},
        "get_trajectory": {"robots": ["nobody"]},
        "get_surface": {"points": [[1.0, 1.0]]},
        "get_route": {**target, "robot": "nobody"},
        "close_road": {"closure": str(uuid.uuid4()), "x": -9999.0, "y": 1.0},
        "open_road": {"closure": str(uuid.uuid4())},
        "resolve_conflict": {"robot": "nobody", "other": "nobody-else"},
        "get_ways_out": {"robot": "nobody", "other": "nobody-else"},
        "end_session": {"session": "0000"},
        "add_operator": {"operator": " ", "role": "supervisor"},
        "rotate_token": {"operator": "nobody"},
        "revoke_token": {"operator": "nobody"},
        "set_role": {"operator": "nobody", "role": "supervisor"},
        "choose_site": {"site": "nowhere"},
        "remove_robots": {"robots": ["nobody"]},
        "set_playback": {"link": "nothing"},
    }
    example = next((one for one in EXAMPLES if one["method"] == method), {})
    return known.get(method, example.get("params", {}))


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def desks(bridge, accounts_of):
    accounts = accounts_of(bridge)
    return {role: bridge.desk(**accounts.operator(role.title(), role)) for role in ROLES}


def test_the_table_names_every_request():
    assert set(LEAST) == set(DESK_REQUESTS)


@pytest.mark.parametrize("role", ROLES)
@pytest.mark.parametrize("method", sorted(DESK_REQUESTS))
def test_each_role_may_do_what_the_table_says_and_nothing_else(desks, role, method):
    try:
        desks[role].ask(method, params(method))
        code, text = None, ""
    except RefusedError as error:
        code, text = error.code, str(error)
    if ROLES.index(role) >= ROLES.index(LEAST[method]):
        assert code in (None, -32000), text
    else:
        assert code == FORBIDDEN
        assert text.startswith(f"{method}: {role.title()} is {role}, and this takes {LEAST[method]}")


def test_what_is_forbidden_is_not_done(bridge, desks):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    stops = len(bridge.sql("select id from emergency_stops"))
    for method, asked in (
        ("send", {"command": "not-by-viewer", "robot": "r1", "op": "Abort"}),
        ("abort_all", {"command": "not-by-viewer"}),
        ("emergency_stop", {"command": "not-by-viewer"}),
    ):
        with pytest.raises(RefusedError):
            desks[VIEWER].ask(method, asked)
    assert bridge.sql("select id from commands where robot = 'r1' and operator = 'Viewer'") == []
    assert len(bridge.sql("select id from emergency_stops")) == stops


def test_a_name_given_in_hello_changes_neither_account_nor_role(bridge, desks):
    answer = desks[VIEWER].ask("hello", {"operator": "Supervisor"})
    assert (answer["operator"], answer["role"]) == ("Viewer", "viewer")
    with pytest.raises(RefusedError, match="Viewer is viewer"):
        desks[VIEWER].ask("get_audit")


def test_the_audit_log_tells_what_was_done_and_what_was_refused(bridge, desks):
    desks[OPERATOR].ask("abort_all", {"command": "told-in-audit"})
    for role, method, asked in (
        (VIEWER, "abort_all", {"command": "told-in-audit"}),
        (VIEWER, "get_audit", {}),
        (VIEWER, "send", {"command": "told-in-audit-2", "robot": "r1", "op": "Abort"}),
        (OPERATOR, "clear_emergency_stop", {}),
    ):
        with pytest.raises(RefusedError):
            desks[role].ask(method, asked)
    entries = desks[SUPERVISOR].ask("get_audit", {"limit": 10_000})["entries"]
    told = {(e["who"], e["action"], e["done"]) for e in entries}
    assert ("Viewer", "abort_all", False) in told
    assert ("Operator", "abort_all", True) in told
    assert ("Operator", "clear_emergency_stop", False) in told
    assert ("Supervisor", "login", True) in told
    assert not {e["action"] for e in entries} & {"get_positions", "get_commands", "subscribe", "hello"}
    assert ("Viewer", "get_audit", False) in told
    refused = next(e for e in entries if e["who"] == "Viewer" and e["action"] == "send")
    assert (refused["role"], refused["address"], refused["subject"]) == ("viewer", "127.0.0.1", "r1")
    assert "this takes operator" in refused["detail"]
