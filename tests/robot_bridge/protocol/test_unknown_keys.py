"""What a message has no parameter for is refused by name; what stops a robot is done all the same."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.messages.base import DESK_REQUESTS, MessageError
from robot_bridge.core.messages.robots import REQUESTS
from robot_bridge.protocol.asyncapi import documents
from robot_bridge.protocol.codec import decode_answer, decode_desk_request, decode_position, decode_request

VALID = {
    "Ready": {"magic": 1},
    "SendPos": {"x": 1, "y": 2, "theta": 0, "v": 0},
    "SendGPS": {"lat": 46.9, "lon": 16.8},
    "GetMap": {"x": 1, "y": 2, "area": 9},
    "GetSurface": {"points": [[1, 2]]},
    "SetObject": {"x": 1, "y": 2, "object": "a"},
    "SendImage": {"image": "", "x": 1, "y": 2, "object": "a"},
}
TASK = {"task": "task-0001", "x": 1, "y": 2}
STOPS = {
    "emergency_stop": {"command": "command-1"},
    "abort": {"command": "command-1", "robot": "r1"},
    "abort_all": {},
    "pause_robot": {"robot": "r1"},
    "pause_queue": {"robot": "r1"},
    "pause_plan": {"plan": "p"},
}


@pytest.mark.parametrize("op", REQUESTS)
def test_a_robots_key_that_is_not_known_is_refused_by_name(op):
    params = VALID.get(op, {})
    decode_request(op, params)
    with pytest.raises(MessageError, match=rf"{op}: crs2 is no parameter here; known are: "):
        decode_request(op, {**params, "crs2": "EPSG:4326"})


@pytest.mark.parametrize(
    ("method", "params", "path"),
    [
        ("set_positions", {"positions": [{"robot": "r1", "x": 1, "y": 2, "z": 0}]}, r"positions\[0\].z"),
        (
            "add_tasks",
            {"robot": "r1", "revision": 0, "tasks": [TASK, {**TASK, "task": "task-0002", "X": 1}]},
            r"tasks\[1\].X",
        ),
        (
            "take_over",
            {
                "robot": "r1",
                "revision": 0,
                "shares": [{"robot": "r2", "revision": 0, "tasks": [{"task": "task-0001", "crs": "a"}]}],
            },
            r"shares\[0\].tasks\[0\].crs",
        ),
        ("subscribe", {"rates": 5}, "rates"),
        ("get_positions", {"crs": "EPSG:4326"}, "crs"),
        ("hello", {"operator": "Ada", "a\nb": 1}, r"'a\\nb'"),
    ],
)
def test_an_operators_key_that_is_not_known_is_refused_by_its_place(method, params, path):
    with pytest.raises(MessageError, match=rf"{method}: {path} is no parameter here"):
        decode_desk_request(method, params)


@pytest.mark.parametrize("method", STOPS)
def test_a_stop_is_not_refused_for_a_key_too_many(method, caplog):
    request = decode_desk_request(method, {**STOPS[method], "zone": "north"})
    assert request == decode_desk_request(method, STOPS[method])
    assert "zone is no parameter of it" in caplog.text


def test_nor_is_an_abort_that_is_sent_as_a_command():
    abort = {"command": "command-1", "robot": "r1", "op": "Abort"}
    assert decode_desk_request("send", {**abort, "zone": "north"}).op == "Abort"
    with pytest.raises(MessageError, match="send: crs is no parameter here"):
        decode_desk_request("send", {**abort, "op": "SetPosEnd", "crs": "EPSG:4326"})


def test_a_position_that_comes_in_quickly_is_no_exception():
    frame = {"jsonrpc": "2.0", "method": "SendPos", "params": VALID["SendPos"]}
    assert decode_position(json.dumps(frame)) is not None
    frame["params"] = {**VALID["SendPos"], "crs": "EPSG:4326"}
    assert decode_position(json.dumps(frame)) is None


def test_a_robot_passes_over_what_a_newer_gateway_says_besides():
    assert decode_answer("SetPosEnd", {"x": 1, "y": 2, "hurry": True}).x == 1


@pytest.mark.parametrize("kind", ["robot", "desk"])
def test_the_schemas_say_so_too(kind):
    for name in REQUESTS if kind == "robot" else DESK_REQUESTS:
        schema = json.loads(documents()[f"{kind}/{name}.json"])
        assert schema.get("additionalProperties", True) is (name in STOPS), name


@pytest.mark.parametrize(
    "params",
    [None, [], 5, {}, {"command": 7}, {"command": "stop-2"}, {"command": ["a"]}, {"command": "a\nb-stop-1"}],
)
def test_an_emergency_stop_is_refused_for_nothing_that_is_said_with_it(params, caplog):
    stop = decode_desk_request("emergency_stop", params)
    assert 8 <= len(stop.command) <= 64 and stop.line is None
    assert "emergency_stop: what cannot be understood of it is passed over" in caplog.text
    # Sent again it is the same stop, where it can be known for the same.
    if isinstance(params, dict) and "command" in params:
        assert decode_desk_request("emergency_stop", params) == stop


@pytest.mark.parametrize(("reason", "line"), [(["x"], None), (5, None), (None, None), ("a\nb", "a b")])
def test_the_reason_of_a_stop_is_put_right_or_left_out(reason, line):
    stop = decode_desk_request("emergency_stop", {"command": "stop-0001", "reason": reason})
    assert (stop.command, stop.line) == ("stop-0001", line)


@pytest.mark.parametrize(
    ("method", "params"),
    [
        ("abort", {"robot": "r1"}),
        ("send", {"robot": "r1", "op": "Abort"}),
        ("abort_all", {}),
        ("pause_robot", {"robot": "r1"}),
        ("pause_queue", {"robot": "r1"}),
        ("pause_plan", {"plan": "gates"}),
    ],
)
@pytest.mark.parametrize(
    ("reason", "line"),
    [("a\nb", "a b"), ("x" * 501, "x" * 500), (5, None), (" \t", None), ("lunch", "lunch")],
)
def test_what_stops_a_robot_is_refused_neither_for_its_reason_nor_for_its_id(method, params, reason, line):
    for id in ("a", "", 7, None, "command-1"):
        asked = decode_desk_request(method, {**params, "reason": reason, "command": id})
        assert asked.reason == line
        if (known := getattr(asked, "command", None)) is not None:
            assert known == id if id == "command-1" else 8 <= len(known) <= 64
    assert getattr(decode_desk_request(method, params), "reason", None) is None


def test_another_command_is_refused_for_its_reason_and_for_its_id():
    for wrong in ({"command": "a"}, {"command": "command-1", "reason": "a\nb"}):
        with pytest.raises(MessageError, match="give"):
            decode_desk_request(
                "send", {"robot": "r1", "op": "SetPosEnd", "params": {"x": 1, "y": 2}, **wrong}
            )
