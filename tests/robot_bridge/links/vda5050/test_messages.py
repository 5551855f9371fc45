"""What is published is valid by VDA 5050's schemas; what vehicles publish is bounded and named."""

from __future__ import annotations

import json
from importlib import resources

import jsonschema
import pytest
from fleet_supervisor.robot_bridge.core.messages.robots import SendPos, SetPath, SetPosEnd, SetPosIni
from fleet_supervisor.robot_bridge.links.vda5050.messages import (
    Connection,
    Factsheet,
    MessageWriter,
    Order,
    State,
    Topics,
    Vda5050Error,
    VehicleId,
    VehicleMessageError,
    decode_message,
)
from fleet_supervisor.robot_bridge.links.vda5050.tasks import (
    Memory,
    Remembered,
    RememberedTask,
    RouteLimits,
    begin_plan,
)

from tests.robot_bridge.links.vda5050.bench import Bench, fault, of_3_0, state

HEAD = {
    "headerId": 1,
    "timestamp": "2026-11-23T12:00:00.00Z",
    "version": "2.1.0",
    "manufacturer": "Acme",
    "serialNumber": "1",
}


def schema_of(name):
    pytest.importorskip("vda5050", reason="the schemas come with vda5050-sdk; make setup installs it")
    folder = resources.files("vda5050.validation") / "schemas"
    return json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


def published():
    """Everything that is ever published, of one bench."""
    bench = Bench()
    bench.connect()
    bench.tell(SetPosIni(110.0, 50.0, 0.5), 6)
    bench.show(actionStates=[{"actionId": bench.action_id("initPosition"), "actionStatus": "FINISHED"}])
    seen = list(bench.published)
    bench.tell(SetPosEnd(120.0, 50.0, 7.0), 7)
    bench.tell(SetPath([(100.0, 50.0), (200.0, 50.0), (200.0, 150.0)]), 8)
    bench.wait(3)
    bench.halt(emergency=True)
    bench.show(
        paused=True,
        actionStates=[{"actionId": bench.action_id("cancelOrder"), "actionStatus": "FAILED"}],
    )
    bench.tell(SetPath([(100.0, 50.0), (200.0, 50.0), (200.0, 150.0)], theta=-2.0), 9)
    bench.show(paused=False)
    bench.accept(bench.orders[-1], passed=1)
    return seen + bench.published


@pytest.mark.parametrize("version", ["2.0.0", "2.1.0"])
def test_all_that_is_published_is_valid(version):
    writer = MessageWriter(VehicleId("Acme", "1"))
    kinds = set()
    for message in published():
        name = "order" if isinstance(message, Order) else "instantActions"
        body = json.loads(writer.encode(message, version, 1_790_000_000.5))
        checker = jsonschema.Draft202012Validator.FORMAT_CHECKER
        jsonschema.validate(body, schema_of(name), format_checker=checker)
        kinds |= {a["actionType"] for a in body.get("actions", [])} | {name}
        assert body["timestamp"] == "2026-09-21T14:13:20.500Z" and body["version"] == version

    needed = {"order", "initPosition", "cancelOrder", "startPause", "stopPause", "stateRequest"}
    assert kinds >= needed


def test_what_is_published_to_vehicles_of_3_0_has_the_fields_of_3_0():
    writer, kinds = MessageWriter(VehicleId("Acme", "1")), set()
    edges, positions = [], []
    for message in published():
        body = json.loads(writer.encode(message, "3.0.0", 1_790_000_000.5))
        assert body["version"] == "3.0.0" and "instantActions" not in body
        kinds |= {action["actionType"] for action in body.get("actions", [])}
        assert {action["blockingType"] for action in body.get("actions", [])} <= {"NONE"}
        edges += body.get("edges", [])
        positions += [node["nodePosition"] for node in body.get("nodes", [])]
    assert kinds >= {"initializePosition", "cancelOrder", "startPause"} and "initPosition" not in kinds
    assert {key for edge in edges for key in edge} == {"edgeId", "sequenceId", "released", "actions"}
    deviations = [position["allowedDeviationXY"] for position in positions]
    assert {"a": 0.1, "b": 0.1, "theta": 0.0} in deviations
    assert all(0 <= position.get("allowedDeviationTheta", 0) <= 3.15 for position in positions)

    plan = begin_plan("a", "hall", (0, 0), [(1, 1)], None, RouteLimits(max_speed=1.5))
    order = json.loads(writer.encode(plan.order(RouteLimits(max_speed=1.5)), "3.0.0", 0))
    assert [edge["maximumSpeed"] for edge in order["edges"]] == [1.5]


def test_what_a_vehicle_of_3_0_publishes_is_read_where_the_settings_say_so():
    body = {**HEAD, **of_3_0("state", state()), "version": "3.0.0"}
    action = {"actionId": "i", "actionType": "initializePosition", "actionStatus": "RETRIABLE"}
    body["instantActionStates"] = [{**action, "actionResult": "slipped"}]
    read = decode_message("state", json.dumps(body).encode(), "3")
    assert (read.agv_position.position_initialized, read.battery_state.battery_charge) == (True, 80.0)
    assert read.safety_state.e_stop == "NONE" and read.action_states == []
    shown = read.action("i")
    assert (shown.action_type, shown.result_description, shown.has_ended) == (
        "initPosition",
        "slipped",
        False,
    )
    sheet = {
        "protocolLimits": {"maximumArrayLengths": {"order.nodes": 3}},
        "protocolFeatures": {"mobileRobotActions": [{"actionType": "initializePosition"}]},
    }
    sheet = decode_message("factsheet", json.dumps({**HEAD, **sheet, "version": "3.0.0"}).encode(), "3")
    assert sheet.most_nodes == 3 and sheet.supports("initPosition") and not sheet.supports("startPause")
    gone = {**HEAD, "version": "3.0.0", "connectionState": "CONNECTION_BROKEN"}
    assert decode_message("connection", json.dumps(gone).encode(), "3").connection_state == "CONNECTIONBROKEN"
    with pytest.raises(VehicleMessageError, match=r"version '2.1.0' is not spoken here; versions 3.x are"):
        decode_message("connection", json.dumps({**HEAD, "connectionState": "ONLINE"}).encode(), "3")
    assert (Topics("vda5050", "v3").major, Topics().major) == ("3", "2")


def test_header_numbers_rise_for_each_topic():
    writer = MessageWriter(VehicleId("Acme", "1"))
    plan = begin_plan("a", "hall", (0, 0), [(1, 1)], None, RouteLimits())
    order = plan.order(RouteLimits())
    assert [json.loads(writer.encode(order, "2.1.0", 0))["headerId"] for _ in range(3)] == [0, 1, 2]


def test_what_a_vehicle_publishes_is_read():
    message = decode_message("state", json.dumps({**HEAD, **state(), "unknown": [1]}).encode())
    assert isinstance(message, State) and message.agv_position.map_id == "hall"
    assert message.sent_at == 1795435200.0
    last_will = decode_message(
        "connection", json.dumps({**HEAD, "connectionState": "CONNECTIONBROKEN"}).encode()
    )
    assert isinstance(last_will, Connection)


def test_a_factsheet_limits_orders_and_names_actions():
    sheet = {
        "protocolLimits": {"maxArrayLens": {"order.nodes": 3}},
        "protocolFeatures": {"agvActions": [{"actionType": "cancelOrder"}]},
    }
    read = decode_message("factsheet", json.dumps({**HEAD, **sheet}).encode())
    assert isinstance(read, Factsheet)
    assert read.most_nodes == 3 and not read.supports("startPause")
    assert decode_message("factsheet", json.dumps(HEAD).encode()).supports("startPause")

    bench = Bench(route=RouteLimits(base_length=10.0))
    bench.connect()
    bench.hear("factsheet", sheet)
    bench.tell(SetPath([(100.0, 50.0), (200.0, 50.0)]), 7)
    assert len(bench.orders[-1].nodes) == 3
    bench.halt(emergency=True)
    assert bench.actions == ["cancelOrder"]


def nested(depth):
    return "[" * depth + "]" * depth


NODE = {"nodeId": "n", "sequenceId": 2, "released": True}
HOSTILE = [
    (b"", "state"),
    (b"\xff\xfe", "UTF-8"),
    (b"null", "Expected `object`"),
    (b"[1]", "Expected `object`"),
    (json.dumps(HEAD).encode(), "missing required field"),
    (json.dumps({**HEAD, **state(), "headerId": -1}).encode(), "headerId"),
    (json.dumps({**HEAD, **state(), "headerId": 10**30}).encode(), "headerId"),
    (json.dumps({**HEAD, **state(), "version": "3.0.0"}).encode(), "version '3.0.0' is not spoken"),
    (json.dumps({**HEAD, **state(), "orderId": "x" * 600}).encode(), "orderId"),
    (json.dumps({**HEAD, **state(), "errors": [fault("x")] * 1001}).encode(), "errors"),
    (json.dumps({**HEAD, **state(), "errors": [fault("x" * 5000)]}).encode(), "errorDescription"),
    (json.dumps({**HEAD, **state(), "nodeStates": [NODE] * 10_001}).encode(), "nodeStates"),
    (json.dumps({**HEAD, **state()}).replace('"x": 0.0', '"x": NaN').encode(), "state"),
    (json.dumps({**HEAD, **state()}).replace('"x": 0.0', '"x": 1e999').encode(), "state"),
    (json.dumps({**HEAD, **state()}).replace('"x": 0.0', '"x": 1e12').encode(), "agvPosition.x"),
    (json.dumps({**HEAD, "orderId": "?"}).replace('"?"', nested(40)).encode(), "nested deeper"),
    (json.dumps({**HEAD, "orderId": "x" * (2 << 20)}).encode(), "are the most"),
]


@pytest.mark.parametrize(("payload", "words"), HOSTILE)
def test_what_is_no_state_is_named(payload, words):
    with pytest.raises(VehicleMessageError, match="state: ") as caught:
        decode_message("state", payload)
    assert words in str(caught.value)


def test_a_place_beyond_all_bounds_ends_nothing():
    bench = Bench()
    bench.connect()
    bench.state["agvPosition"]["x"] = 9e8
    bench.clear()
    bench.show()
    assert bench.saying(SendPos) == []
    assert "its position has no place on the site: x is" in bench.controller.alarm(bench.now)
    bench.state["agvPosition"]["x"] = 1.0
    bench.show()
    assert bench.sent[-1].x == 101.0


@pytest.mark.parametrize(
    "topic",
    ["uagv/v2/Acme", "uagv/v2/Acme/1/state/x", "other/v2/Acme/1/state", "uagv/v2//1/state", "uagv/v2/$S/1/x"],
)
def test_topics_of_others_are_nobodys(topic):
    assert Topics().parse(topic) is None


def test_topics_name_the_vehicle():
    topics = Topics("hall 7", "v2")
    vehicle, topic = topics.parse("hall 7/v2/Acme/agv 1/state")
    assert (str(vehicle), topic) == ("Acme/agv 1", "state")
    assert topics.outbound(vehicle, "order") == "hall 7/v2/Acme/agv 1/order"
    with pytest.raises(Vda5050Error, match="interface is 'a/b'"):
        Topics("a/b")


def test_what_is_kept_comes_back(tmp_path):
    memory = Memory(tmp_path / "state")
    assert memory.recall("Acme/1") is None
    plan = begin_plan("7-x", "hall", (0.0, 0.0), [(100.0, 0.0), (100.0, 5.0)], 1.0, RouteLimits())
    task = RememberedTask(command=7, op="SetPath", params="{}", plan=plan, passed=1, accepted=True)
    kept = Remembered(task=task, paused=True, revoked=["6-x"])
    memory.keep("Acme/1", kept)
    assert Memory(tmp_path / "state").recall("Acme/1") == kept
    assert memory.recall("Acme/2") is None


def test_a_memory_that_is_none_is_named(tmp_path):
    memory = Memory(tmp_path)
    memory.keep("Acme/1", Remembered())
    (file,) = tmp_path.iterdir()
    file.write_text('{"task": 3}')
    with pytest.raises(Vda5050Error, match=f"memory {file} is none of a vehicle"):
        memory.recall("Acme/1")
