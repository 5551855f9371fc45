"""The integrator's guide says what a real gateway does: each of its examples is run."""

from __future__ import annotations

import json
import re
import sqlite3
import urllib.error
import urllib.request
from pathlib import Path

import jsonschema
import pytest
from websockets.frames import CloseCode

from robot_bridge.core.messages.administration import Gateways
from robot_bridge.core.messages.base import DESK_REQUESTS
from robot_bridge.core.messages.robots import ANSWERS, PAYLOADS, REQUESTS
from robot_bridge.gateway.api.robot_session import REPLACED
from robot_bridge.gateway.auth.authorisation import REVOKED
from robot_bridge.protocol import jsonrpc
from robot_bridge.protocol.asyncapi import documents
from robot_bridge.protocol.codec import decode_answer, decode_desk_request, decode_request
from robot_bridge.protocol.schemas import NOTIFICATIONS
from tests.support.bridge.bridge_accounts import bearing
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.command_line import run_command
from tests.support.wire import RefusedError

ROOT = Path(__file__).resolve().parents[2]
GUIDE = "\n".join(
    (ROOT / "docs" / page).read_text(encoding="utf-8")
    for page in ("integrator.md", "robots-sql.md", "desk-protocol.md")
)
BLOCKS = re.findall(r"^```(\w+) ([\w -]+)\n(.*?)^```$", GUIDE, re.DOTALL | re.MULTILINE)
OF_THE_GATEWAY = {"gateways", "geofence", "links", "nearness", "site", "stopping", "suspensions"}
"""What operators are told of robots in keepouts or near people, of a new site, and when the gateway ends."""
UUID = re.compile(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}")


def blocks(kind):
    """Return the blocks whose info string begins with ``kind``, as (the rest of it, JSON value)."""
    found = [(info.split()[1:], text) for _, info, text in BLOCKS if info.split()[0] == kind]
    return [(rest[0] if rest else "", json.loads(text)) for rest, text in found]


def unnamed(value):
    """Return a JSON value with one id in place of every UUID."""
    return json.loads(UUID.sub("an id", json.dumps(value)))


def accepts(path, value) -> bool:
    """Tell whether the served schema at ``path`` accepts a JSON value."""
    return jsonschema.Draft202012Validator(json.loads(documents()[path])).is_valid(value)


def shape(value):
    """Return a JSON value with its names and types and without what it says."""
    if isinstance(value, dict):
        return {name: shape(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [shape(inner) for inner in value[:1]]
    return (
        "number" if isinstance(value, (int, float)) and not isinstance(value, bool) else type(value).__name__
    )


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


# --- the examples are messages ----------------------------------------------------------------------------


@pytest.mark.parametrize(("op", "params"), blocks("robot-params"))
def test_what_a_robot_says_is_understood(op, params):
    decode_request(op, params)
    assert accepts(f"robot/{op}.json", params)


@pytest.mark.parametrize(("op", "params"), blocks("robot-params-with-payload"))
def test_what_a_robot_says_with_a_payload_is_understood(op, params):
    decode_request(op, params, b"image")
    assert accepts(f"robot/{op}.json", params)


@pytest.mark.parametrize(("op", "params"), blocks("gateway-params"))
def test_what_the_gateway_says_is_what_it_can_say(op, params):
    decode_answer(op, params)
    assert accepts(f"gateway/{op}.json", params)


@pytest.mark.parametrize("frame", [frame for _, frame in blocks("robot-hears")])
def test_what_a_robot_hears_is_a_frame_that_the_reference_robot_understands(frame):
    message = jsonrpc.decode(json.dumps(frame))
    if isinstance(message, jsonrpc.Call):
        if message.method != Gateways.method:
            decode_answer(message.method, message.params)
        assert accepts(f"gateway/{message.method}.json", message.params or {})
    elif message.error is None:
        assert accepts("gateway/OpAck.json", message.result)


@pytest.mark.parametrize("frame", [frame for _, frame in blocks("robot-sends") if "method" in frame])
def test_what_a_robot_sends_is_as_its_schema_says_unless_it_is_shown_as_wrong(frame):
    refused = {t["id"] for _, t in blocks("robot-hears") if "error" in t}
    is_right = frame.get("id") not in refused
    assert accepts(f"robot/{frame['method']}.json", frame.get("params", {})) is is_right


@pytest.mark.parametrize("frame", [frame for _, frame in blocks("desk-sends")])
def test_what_a_desk_sends_is_understood(frame):
    message = jsonrpc.decode(json.dumps(frame))
    decode_desk_request(message.method, message.params)
    assert accepts(f"desk/{message.method}.json", message.params or {})


@pytest.mark.parametrize("frame", [frame for _, frame in blocks("desk-hears") if "error" not in frame])
def test_what_a_desk_hears_is_as_its_schema_says(frame):
    if "method" in frame:
        assert accepts(f"news/{frame['method']}.json", frame["params"])
        return
    (asked,) = (sent["method"] for _, sent in blocks("desk-sends") if sent["id"] == frame["id"])
    assert accepts(f"result/{asked}.json", frame["result"])


def test_every_operation_and_method_has_an_example_on_each_wire():
    said = {op for op, _ in blocks("robot-params") + blocks("robot-params-with-payload")}
    assert said == set(REQUESTS)
    assert {op for op, _ in blocks("robot-params-with-payload")} == set(REQUESTS) & set(PAYLOADS)
    assert {op for op, _ in blocks("gateway-params")} == set(ANSWERS) - {"SetMap"}
    said = {frame.get("method") for _, frame in blocks("robot-sends")} - {None}
    assert said == set(REQUESTS) - {"OpAck"}
    heard = {frame.get("method") for _, frame in blocks("robot-hears")} - {None}
    assert heard == {*ANSWERS, Gateways.method} - {"OpAck"}
    assert {frame["method"] for _, frame in blocks("desk-sends")} == set(DESK_REQUESTS)
    told = {frame.get("method") for _, frame in blocks("desk-hears")} - {None}
    assert told == set(NOTIFICATIONS)


def test_every_error_code_is_explained():
    codes = {value for name, value in vars(jsonrpc).items() if name.isupper() and isinstance(value, int)}
    assert codes == {int(code) for code in re.findall(r"^\| (-32\d{3}) \|", GUIDE, re.MULTILINE)}


def test_every_code_with_which_a_robot_is_closed_is_explained():
    told = {int(code) for code in re.findall(r"^\| closed with (\d+)", GUIDE, re.MULTILINE)}
    used = {
        CloseCode.SERVICE_RESTART,
        CloseCode.POLICY_VIOLATION,
        CloseCode.MESSAGE_TOO_BIG,
        REPLACED,
        REVOKED,
    }
    assert told == used


def test_the_columns_are_those_of_the_tables(bridge):
    named = re.findall(
        r"^\| (\w+) \| ", GUIDE.split("# Robots over SQL")[1].split("Robots insert")[0], re.MULTILINE
    )
    for table, described in (("rr", named[1:-1]), ("sa", named[1:])):
        columns = [name for _, name, *_ in bridge.sql(f"pragma table_info({table})")]
        assert described == columns


# --- the examples are what happens ------------------------------------------------------------------------


def test_the_sql_story_goes_as_it_is_told(bridge):
    desk, rows = bridge.desk(), []
    story = sqlite3.connect(bridge.file, timeout=5, isolation_level=None)
    for language, info, text in BLOCKS:
        if info == "result":
            told = text.strip().splitlines()
            assert unnamed(["|".join(map(str, row)) for row in rows]) == unnamed(told)
        if language != "sql":
            continue
        if info.endswith("after-send"):
            desk.send("target-r1", "r1", "SetPosEnd", x=20.1, y=8.0, cone=False)
        for statement in filter(None, map(str.strip, text.split(";"))):
            rows = story.execute(statement).fetchall()
            if not story.in_transaction:
                wait_until(lambda: bridge.sql("select count(*) from rr") == [(0,)], what=statement)
    story.close()
    command = desk.wait_for_step("target-r1", "reached")
    assert [s["state"] for s in command["steps"]] == ["queued", "delivered", "acknowledged", "reached"]


def test_the_websocket_story_goes_as_it_is_told(bridge):
    told = [frame for kind, frame in blocks("robot-hears") if kind == ""]
    answers = [frame for kind, frame in blocks("robot-hears") if kind == "answer"]
    robot, desk = bridge.robot("r1"), bridge.desk()
    for _, frame in blocks("robot-sends"):
        if "method" in frame:
            robot.connection.send(json.dumps(frame))
        if "method" in frame and "id" in frame:
            (wanted,) = [t for t in told if t.get("id") == frame["id"] and "method" not in t]
            assert unnamed(answer_frame(robot, frame["id"], wanted)) == unnamed(
                {k: wanted[k] for k in ("result", "error") if k in wanted}
            )
        if frame.get("method") == "SendGPS":
            give_a_track(robot, desk)
    for frame in answers:
        assert robot.wait_for(frame["method"])["params"] == frame["params"]
    commands = {frame["method"]: frame.get("params", {}) for frame in told if "method" in frame}
    for op in ("SetPosEnd", "SetPath", "SetPosIni", "Abort"):
        desk.send(f"command-{op}", "r1", op, **commands[op])
        heard = robot.wait_for(op)
        assert heard.get("params", {}) == commands[op]
        robot.say(heard["id"], error="battery empty")
        assert desk.wait_for_step(f"command-{op}", "failed")["steps"][-1]["reason"] == "battery empty"
    for op in ("Start", "SetMap"):
        assert shape(robot.wait_for(op).get("params", {})) == shape(commands[op])


def test_a_robot_that_answers_an_abort_as_it_is_told_is_seen_to_stand(bridge):
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(4711)
    desk.send("abort-of-r1", "r1", "Abort")
    abort = robot.wait_for("Abort")
    for frame in [frame for kind, frame in blocks("robot-sends") if kind == "aborted"]:
        robot.connection.send(json.dumps(frame | ({"id": abort["id"]} if "result" in frame else {})))
    desk.wait_for_step("abort-of-r1", "reached")


def test_an_emergency_stop_comes_as_it_is_told(bridge):
    ((_, wanted),) = [b for b in blocks("robot-hears") if b[0] == "at-once"]
    robot, desk = bridge.robot("r1"), bridge.desk()
    desk.ask("emergency_stop", {"command": wanted["id"].removeprefix("emergency-")})
    assert robot.wait_for("Abort") == wanted


def give_a_track(robot, desk):
    """Send the robot what it asks for later: where its track begins and ends."""
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    desk.send("track-begin", "r1", "SetPosIni", x=20.0, y=8.0, theta=0.0)
    desk.send("track-end", "r1", "SetPosEnd", x=24.0, y=8.0, theta=1.57, cone=False)
    for op in ("SetPosIni", "SetPosEnd"):
        robot.say(robot.wait_for(op)["id"])
    for command in ("track-begin", "track-end"):
        desk.until(lambda command=command: desk.commands[command]["state"] in ("acknowledged", "reached"))


def answer_frame(wire, id, wanted):
    """Return how call ``id`` was answered, as it stands in the frame; of an error what ``wanted`` tells."""
    try:
        return {"result": wire.answer(id)}
    except RefusedError as error:
        told = {"code": error.code, "message": str(error), "data": error.data}
        return {"error": {name: told[name] for name in wanted.get("error", told)}}


def without_own_facts(answer):
    """Every database has an id of its own, and every computer its time."""
    own = ("database", "now")
    result = {name: value for name, value in answer.get("result", {}).items() if name not in own}
    return {**answer, "result": result}


def test_the_desks_story_goes_as_it_is_told(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1, asks_path=True)
    robot.ask("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    desk = bridge.desk()
    heard = []
    desk._hear = heard.append
    tell_what_is_seen(robot)
    told = [frame for _, frame in blocks("desk-hears")]
    wait_until(lambda: bridge.sql("select id from trajectories"))
    for _, frame in blocks("desk-sends"):
        if frame["method"] in BEFORE:
            BEFORE[frame["method"]](bridge, robot)
        desk.connection.send(json.dumps(frame))
        (wanted,) = [t for t in told if t.get("id") == frame["id"]]
        answered = answer_frame(desk, frame["id"], wanted)
        if frame["method"] == "subscribe":
            desk.until(lambda: heard)
        if frame["method"] == "set_queue":
            put_a_cone_down(bridge, robot, desk, heard)
        if frame["method"] == "get_conflicts":
            desk.until(lambda: any(h["method"] == "conflicts" for h in heard))
        if frame["method"] == "make_current":
            wait_for_target(robot, x=30.0, y=20.0, theta=0.0, cone=False)
        if frame["method"] == "add_operator" and wanted["result"]["operator"] == "Ada":
            # From now on the gateway lets in nobody without a token.
            desk = bridge.desk(**bearing(answered["result"]["token"]))
        if "error" in wanted or frame["method"] == "hello":
            assert without_own_facts(answered) == without_own_facts({k: wanted[k] for k in answered})
        assert shape(answered) == shape({k: wanted[k] for k in answered})
    for method in sorted(set(NOTIFICATIONS) - OF_THE_GATEWAY):
        (wanted,) = [t for t in told if t.get("method") == method]
        assert shape(next(h for h in heard if h["method"] == method)) == shape(wanted)


def test_positions_in_columns_are_read_as_it_is_told(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.ask("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    desk = bridge.desk()
    ((_, asked),), ((_, wanted),) = blocks("desk-asks-columns"), blocks("head-of-columns")
    assert accepts("desk/subscribe.json", asked["params"])
    assert accepts("head/positions.json", wanted["params"])
    desk.connection.send(json.dumps({**asked, "id": "columns"}))
    frame = ""
    while not isinstance(frame, bytes):
        frame = desk.connection.recv(10.0)
    head = json.loads(frame[4 : 4 + int.from_bytes(frame[:4], "little")])
    assert shape(head) == shape(wanted)
    assert [head["params"][name] for name in ("robots", "columns", "words")] == [
        wanted["params"][name] for name in ("robots", "columns", "words")
    ]
    ((code,),) = [[text] for language, info, text in BLOCKS if (language, info) == ("python", "read-columns")]
    program = {}
    exec(code, program)
    assert program["state_of"]("r1", frame)[:3] == (20.0, 8.0, "fresh")


def test_a_view_is_asked_for_and_told_as_it_is_told(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.ask("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    desk = bridge.desk()
    ((_, asked),), ((_, wanted),) = blocks("desk-asks-view"), blocks("desk-hears-view")
    ((_, density),) = blocks("density")
    assert accepts("desk/subscribe.json", asked["params"])
    assert accepts("news/positions.json", wanted["params"])
    desk.ask("subscribe", asked["params"])
    desk.until(lambda: desk.snapshots)
    assert shape(desk.snapshots[0]) == shape(wanted["params"])
    assert desk.snapshots[0]["view"] == wanted["params"]["view"]
    ((_, once),) = blocks("desk-asks-view-once")
    assert accepts("desk/get_positions.json", once["params"])
    assert shape(desk.ask("get_positions", once["params"])) == shape(wanted["params"])
    view = {**asked["params"]["view"], "most": 1}
    other = bridge.robot("r9")
    other.plug_in(9)
    other.ask("SendPos", {"x": 21.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    desk.ask("subscribe", {**asked["params"], "view": view})
    desk.until(lambda: desk.snapshots[-1].get("view", {}).get("density"))
    told = desk.snapshots[-1]["view"]["density"]
    assert shape(told) == shape(density)
    assert [told[name] for name in ("cell", "columns", "rows")] == [1.0, 61, 41]
    assert all(told[name] == density[name] for name in ("cell", "x", "y", "columns", "rows", "cells"))


def take_the_last_abort(bridge, robot):
    """Let the robot give up what it was sent before: what it had fetched by the Abort would keep it busy."""
    ((newest,),) = bridge.sql("select max(sa_id) from commands where op = 'Abort'")
    robot.until(lambda: any(call.get("id") == newest for call in robot.calls))
    robot.say(newest)
    open_targets = "select id from commands where op = 'SetPosEnd' and state in ('queued', 'delivered')"
    wait_until(lambda: bridge.sql(open_targets) == [])


def let_one_go(bridge, robot):
    """Let a robot connect and close its link in good order, so that it is offline; ``robot`` is there."""
    gone = bridge.robot("r9")
    gone.plug_in(9)
    gone.connection.close()
    desk = bridge.desk()

    def states():
        return {one["robot"]: one["state"] for one in desk.ask("get_positions")["robots"]}

    wait_until(lambda: states()["r9"] == "offline")
    robot.tell("Alive")
    wait_until(lambda: states()["r1"] == "fresh")


BEFORE = {"set_queue": take_the_last_abort, "remove_robots": let_one_go}
"""What happens in the desk's story before a request is made."""


def put_a_cone_down(bridge, robot, desk, heard):
    """Do the first task of the queue's example, bring a second robot; the next task is then on its way."""
    # On a busy machine the story has taken so long by now that the robot counts as lost, and is sent nothing.
    robot.tell("Alive")
    robot.say(wait_for_target(robot, x=45.0, y=20.0, cone=True)["id"])
    robot.tell("SendPos", {"x": 45.03, "y": 20.04, "theta": 0.0, "v": 0.0})
    other = bridge.robot("r2")
    other.plug_in(2)
    other.ask("SendPos", {"x": 20.0, "y": 12.0, "theta": 0.0, "v": 0.0})
    desk.until(lambda: any(h["method"] == "placement" for h in heard))
    robot.wait_for("SetPath")


def wait_for_target(robot, **target):
    """Return the call that sends the robot to this target; what came before it is passed over."""
    while (call := robot.wait_for("SetPosEnd"))["params"] != target:
        pass
    return call


def tell_what_is_seen(robot):
    """Tell of the cone of the examples, with its image."""
    robot.ask("SetObject", {"x": 31.5, "y": 9.25, "object": "cone-7", "label": "traffic cone"})
    image = {"x": 24.0, "y": 8.0, "object": "cone-7", "image": "/9j/4AAQSkZJRg=="}
    robot.ask("SendImage", image)


def test_the_schemas_are_served_as_they_are_written(bridge, tmp_path):
    assert run_command("schemas", tmp_path).returncode == 0
    base = bridge.address.replace("ws://", "http://")
    with urllib.request.urlopen(f"{base}/schemas/", timeout=60) as index:
        assert index.headers["Content-Type"] == "application/json"
        paths = json.load(index)["documents"]
    assert len(paths) > 40
    for path in [*paths, "index.json"]:
        with urllib.request.urlopen(f"{base}/schemas/{path}", timeout=60) as served:
            assert served.read() == (tmp_path / path).read_bytes()
    with pytest.raises(urllib.error.HTTPError, match="404"):
        urllib.request.urlopen(f"{base}/schemas/robot/Fly.json", timeout=60)


def test_the_reference_robots_command_lines_have_options_that_exist():
    from robot_bridge.cli.robot import robot

    for line in re.findall(r"^    robot-bridge robot (.*)$", GUIDE, re.MULTILINE):
        for option in re.findall(r"--([\w-]+)", line):
            assert option.replace("-", "_") in robot.__annotations__
