"""What a real link and a real gateway say to each other is as the published schemas say."""

from __future__ import annotations

import json
from types import SimpleNamespace

import jsonschema
import pytest

from robot_bridge.core.messages.robots import GetMap, SendGPS, SendPos, SetObject
from robot_bridge.core.position_frame import split_frame
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.protocol.asyncapi import CALLS, ROBOT_CALLS, asyncapi, documents
from tests.support.bridge.adapter_on_the_line import LinkOnTheLine
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.link_relay import TO_GATEWAY, TO_LINK, LinkRelay

POSE = SendPos(20.0, 8.0, 0.0, 0.0, battery=0.5, status="waits")


@pytest.fixture(scope="module")
def frames(start_bridge, impatient_site, tmp_path_factory):
    """All frames of a link whose robots did what robots do, those of a stop and a refusal among them."""
    bridge = start_bridge(impatient_site)
    relay = LinkRelay(bridge.address)
    link = LinkOnTheLine(SimpleNamespace(address=relay.address), tmp_path_factory.mktemp("link"))
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    try:
        _live(link, desk, relay)
    finally:
        link.end()
        relay.end()
        bridge.end()
    return relay.frames


def _live(link, desk, relay):
    """Say and be told something of every kind that a link knows."""
    link.do("add", "agv-1", ("targets", "paths", "start", "map"))
    link.do("position", "agv-1", POSE)
    link.do("add", "phone-1")
    link.do("position", "phone-1", SendGPS(46.8889, 16.8390, heading=90.0))
    desk.wait_for_robots("agv-1")
    assert link.do("areas", (0.0, 0.0, 200.0, 160.0)).roads
    link.do("alive", "agv-1")
    link.do("report", ok=False, text="the broker is away", counts={"frames": 3.0})
    assert link.do("ask", "agv-1", SetObject(30.0, 9.0, "cone-1", source="1")).ok
    link.do("ask", "agv-1", GetMap(20.0, 8.0, 20.0))
    wait_until(lambda: _commands(link, "SetMap"))
    for id, op, params in (
        ("link-start", "SetPosIni", {"x": 20.0, "y": 8.0}),
        ("link-target", "SetPosEnd", {"x": 40.0, "y": 8.0}),
        ("link-path", "SetPath", {"points": [[20.0, 8.0], [40.0, 8.0]]}),
        ("link-abort", "Abort", {}),
    ):
        desk.send(id, "agv-1", op, **params)
        desk.wait_for_step(id, "acknowledged")
    link.do("stopped", "agv-1")

    async def refuse(command):
        raise CommandRefusedError("the bumper is pressed")

    link.adapter.during = refuse
    desk.send("link-refused", "agv-1", "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step("link-refused", "failed")
    desk.ask("emergency_stop", {"command": "link-stop-all"})
    wait_until(lambda: ("agv-1", True) in link.adapter.stops)
    desk.ask("clear_emergency_stop", {})
    link.do("position", "agv-1", POSE)
    with pytest.raises(CommandRefusedError):
        link.do("ask", "agv-1", SetObject(1e6, 9.0, "cone-1", source="1"))
    wait_until(lambda: any('"error"' in frame for way, frame in relay.frames if way == TO_LINK))


def _commands(link, op):
    return [one for one in link.adapter.commands if type(one.message).__name__ == op]


def _document(path):
    return jsonschema.Draft202012Validator(json.loads(documents()[path]))


def _path_of(direction, frame):
    """Return where the schema of a call's params is."""
    method, params = frame["method"], frame.get("params", {})
    if direction == TO_GATEWAY:
        return f"link/{method}.json"
    whole = method == "Abort" and "robot" not in params
    return f"link-gateway/{'AbortOfAll' if whole else method}.json"


def test_every_call_is_as_its_schema_says(frames):
    seen = set()
    for direction, frame in frames:
        call = json.loads(frame) if isinstance(frame, str) else {}
        if "method" in call:
            path = _path_of(direction, call)
            _document(path).validate(call.get("params", {}))
            seen.add(path)
    assert seen >= {
        *(f"link/{name}.json" for name in ("hello", "status", "get_areas", "Ready", "SendGPS", "Alive")),
        *(f"link/{name}.json" for name in ("SetObject", "GetMap", "Stopped")),
        *(f"link-gateway/{name}.json" for name in ("Start", "SetMap", "SetPosIni", "SetPosEnd", "SetPath")),
        *(f"link-gateway/{name}.json" for name in ("Abort", "AbortOfAll")),
    }


def test_every_table_of_positions_has_the_head_of_its_schema(frames):
    tables = [frame for _, frame in frames if isinstance(frame, bytes)]
    assert tables
    for frame in tables:
        _document("head/link-positions.json").validate(split_frame(frame).params)


def test_every_frame_is_a_message_of_its_direction_in_the_asyncapi_document(frames):
    document = asyncapi()
    for direction, frame in frames:
        if isinstance(frame, str):
            action = "receive" if direction == TO_GATEWAY else "send"
            matching = [name for name, one in _messages(document, action) if one.is_valid(json.loads(frame))]
            assert matching, frame


def _messages(document, action):
    """Yield the messages that may go that way, as calls or as replies to the other side's calls."""
    channel, parts = document["channels"]["link"]["messages"], {"components": document["components"]}
    names = set()
    for name, one in document["operations"].items():
        if name.startswith("link."):
            replies = one.get("reply", {}).get("messages", [])
            names |= {
                r["$ref"].rpartition("/")[2]
                for r in (one["messages"] if one["action"] == action else replies)
            }
    for name in names:
        yield name, jsonschema.Draft202012Validator({**channel[name]["payload"], **parts})


@pytest.mark.parametrize("method", ["hello", "get_areas"])
def test_the_answer_to_a_link_is_as_its_schema_says(frames, method):
    texts = [(way, json.loads(frame)) for way, frame in frames if isinstance(frame, str)]
    asked = next(call for _, call in texts if call.get("method") == method)
    answers = (reply for way, reply in texts if way == TO_LINK and reply.get("id") == asked["id"])
    answer = next(reply["result"] for reply in answers if "result" in reply)
    _document(f"link-gateway/{method}Result.json").validate(answer)
    assert answer["site" if method == "hello" else "keepouts"]


def test_a_robot_is_named_and_nothing_else_is_added():
    for op in ROBOT_CALLS:
        schema = json.loads(documents()[f"link/{op}.json"])
        assert "robot" in schema["required"]
        assert not schema["additionalProperties"]
    for method in CALLS:
        assert not json.loads(documents()[f"link/{method}.json"])["additionalProperties"]
    pose = {"x": 1.0, "y": 2.0, "theta": 0.0, "v": 0.0}
    assert _document("link/SendPos.json").is_valid({"robot": "agv-1", **pose})
    assert not _document("link/SendPos.json").is_valid(pose)
    assert not _document("link/SendPos.json").is_valid({"robot": "../agv", **pose})
    fix = {"robot": "phone-1", "lat": 46.9, "lon": 16.8}
    assert _document("link/positions.json").is_valid({"positions": [{"robot": "agv-1", **pose}, fix]})
    assert not _document("link/positions.json").is_valid({"positions": [{"robot": "agv-1", "x": 1.0}]})
