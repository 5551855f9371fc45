"""How a robot connects, by WebSocket and by plain SQL: plug and play, maps, targets, and what is refused."""

from __future__ import annotations

import contextlib
import socket
import time

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from robot_bridge.core.robotmap.binary import decode
from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.robots.robot_wires import RobotWire, SqlRobot, map_bytes
from tests.support.wire import RefusedError

SITE_BORDER = (0.0, 0.0, 200.0, 160.0)
POSE = {"x": 1.0, "y": 2.0, "theta": 0.5, "v": 0.0}


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


# --- WebSocket --------------------------------------------------------------------------------------------


def test_plug_and_play_over_websocket(bridge):
    robot = bridge.robot("ws1")
    robot.wait_for("Start")
    ack = robot.ask("Ready", {"magic": 4711})
    (database,) = bridge.sql("select value from bridge where name = 'id'")
    assert ack == {"id": 1, "ok": True, "magic": 4711, "robot": "ws1", "database": database[0]}
    call = robot.wait_for("SetMap")
    assert decode(map_bytes(call)).border == SITE_BORDER
    robot.say(call["id"])
    wait_until(lambda: bridge.sql("select id from sa where robot = 'ws1'") == [])


def test_a_robot_without_a_name_is_given_one(bridge):
    first, second = bridge.robot(), bridge.robot()
    names = [first.ask("Ready", {"magic": 1})["robot"], second.ask("Ready", {"magic": 2})["robot"]]
    assert names == ["robot-1", "robot-2"]


def test_get_map_over_websocket_is_answered_with_a_square_map(bridge):
    robot = bridge.robot("ws2")
    robot.plug_in(1)
    assert robot.ask("GetMap", {"x": 60.0, "y": 90.0, "area": 2500.0})["ok"] is True
    cut = decode(map_bytes(robot.wait_for("SetMap")))
    assert cut.border == (35.0, 65.0, 85.0, 115.0)
    assert cut.segment_count > 0


def test_who_has_not_said_ready_is_told_to(bridge):
    robot = bridge.robot("ws3")
    with pytest.raises(RefusedError, match=r"robot 'ws3' has not said Ready .*; send Ready first") as caught:
        robot.ask("SendPos", POSE)
    assert caught.value.code == -32001


@pytest.mark.parametrize(
    ("op", "params", "code", "text"),
    [
        ("SendPos", {"x": 1, "y": 2, "theta": 0}, -32602, "SendPos: Object missing required field `v`"),
        ("SendPos", {**POSE, "x": "here"}, -32602, r"SendPos: .*\$\.x"),
        ("SendPos", [1, 2, 3, 4], -32602, "SendPos: params is list"),
        ("GetMap", {"x": 1, "y": 2, "area": -1}, -32602, "GetMap: area is -1"),
        (
            "GetMap",
            {"x": 1, "y": 2, "area": 1e-6},
            -32000,
            "GetMap: window: width is 0.001 m, so",
        ),
        ("Ready", {"magic": 10**30}, -32602, "Ready: magic is 1000"),
        ("Fly", {}, -32601, "unknown operation 'Fly'; known are Ready, Stopped"),
        ("SendGPS", {"lat": 95, "lon": 15}, -32602, "SendGPS: lat is 95.0; give a number from -90 to 90"),
        ("SetObject", {"x": 1, "y": 2, "object": ""}, -32602, "SetObject: object is ''; give 1 to 128"),
        ("SetObject", {"x": 1, "y": 900, "object": "a"}, -32000, r"\(1.00, 900.00\) lies outside site"),
        (
            "SendImage",
            {"x": 1, "y": 2, "object": "a"},
            -32602,
            "SendImage came without its payload; its image",
        ),
        ("SendImage", {"x": 1, "y": 2, "object": "a", "image": "!"}, -32602, "image is not base64 text"),
        ("GetPath", {}, -32000, "GetPath: robot 'ws4' has no task"),
        ("GetPosIni", {}, -32000, "GetPosIni: robot 'ws4' was given no SetPosIni or SetPath yet"),
        ("GetPosEnd", {}, -32000, "GetPosEnd: robot 'ws4' was given no SetPosEnd or SetPath yet"),
    ],
)
def test_a_wrong_request_is_refused_and_the_robot_stays_connected(bridge, op, params, code, text):
    robot = bridge.robot("ws4")
    robot.plug_in(1)
    with pytest.raises(RefusedError, match=text) as caught:
        robot.ask(op, params)
    assert caught.value.code == code
    assert robot.ask("SendPos", POSE)["ok"] is True


def test_a_robot_that_refuses_a_command_fails_it_with_its_reason(bridge):
    robot, desk = bridge.robot("ws5"), bridge.desk()
    robot.plug_in(1)
    desk.send("target-ws5", "ws5", "SetPosEnd", x=1.0, y=2.0, theta=0.5)
    call = robot.wait_for("SetPosEnd")
    assert call["params"] == {"x": 1.0, "y": 2.0, "theta": 0.5, "cone": False}
    robot.say(call["id"], error="battery empty")
    command = desk.wait_for_step("target-ws5", "failed")
    assert command["steps"][-1]["reason"] == "battery empty"


def test_a_robot_that_reconnects_need_not_wait_for_its_dead_connection(bridge):
    with _mute_connection(bridge, "/robot?robot=ws6"):
        began = time.monotonic()
        bridge.robot("ws6").plug_in(1)
        assert time.monotonic() - began < 18


@contextlib.contextmanager
def _mute_connection(bridge, path):
    """Open a WebSocket that never reads what it is sent and never closes, as a robot out of reach."""
    with socket.create_connection(("127.0.0.1", bridge.port)) as link:
        key = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        upgrade = f"Host: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n{key}\r\n"
        link.sendall(f"GET {path} HTTP/1.1\r\n{upgrade}".encode())
        assert b"101" in link.recv(12)
        yield link


# --- plain SQL --------------------------------------------------------------------------------------------


@pytest.fixture
def sql_robot(bridge):
    robots = []

    def make(name):
        robots.append(SqlRobot(bridge.database, name))
        return robots[-1]

    yield make
    for robot in robots:
        robot.close()


def test_plug_and_play_over_plain_sql(bridge, sql_robot):
    robot, desk = sql_robot("sql1"), bridge.desk()
    ready = robot.say("Ready", magic=4711)
    _, ack, _ = robot.read("OpAck")
    (database,) = bridge.sql("select value from bridge where name = 'id'")
    assert ack == {"id": ready, "ok": True, "magic": 4711, "robot": "sql1", "database": database[0]}
    map_id, _, payload = robot.read("SetMap")
    assert decode(payload).border == SITE_BORDER
    robot.say("OpAck", id=map_id)
    robot.say("SendPos", **POSE)
    desk.ask("subscribe", {"rate": 20})
    desk.until(lambda: desk.robots.get("sql1", {}).get("x") == 1.0)

    desk.send("target-sql1", "sql1", "SetPosEnd", x=5.0, y=2.0)
    id, params, _ = robot.read("SetPosEnd")
    assert params == {"x": 5.0, "y": 2.0, "cone": False}
    desk.wait_for_step("target-sql1", "delivered")
    robot.say("OpAck", id=id)
    desk.wait_for_step("target-sql1", "acknowledged")
    robot.say("SendPos", x=4.9, y=2.0, theta=0.0, v=0.0)
    command = desk.wait_for_step("target-sql1", "reached")
    assert command["deviation"] == pytest.approx(0.1)
    robot.say("Stopped")
    robot.read("OpAck")
    desk.until(lambda: desk.robots["sql1"]["stopped"])
    assert bridge.sql("select count(*) from sa where robot = 'sql1'") == [(0,)]


def test_get_map_over_plain_sql_is_answered_with_a_square_map(sql_robot):
    robot = sql_robot("sql2")
    robot.say("Ready", magic=1)
    robot.read("SetMap")
    asked = robot.say("GetMap", x=60.0, y=90.0, area=2500.0)
    wait_until(lambda: robot.read("OpAck")[1]["id"] == asked)
    assert decode(robot.read("SetMap")[2]).border == (35.0, 65.0, 85.0, 115.0)


def test_junk_in_rr_is_answered_and_removed(bridge, sql_robot):
    """Under a name that no robot may have nobody would read an answer."""
    bridge.sql("insert into rr (robot, op) values ('no robot', 'Alive')")
    robot = sql_robot("sql3")
    robot.say("Ready", magic=1)
    robot.read("OpAck")
    for name, op, params, reason in (
        ("sql3", "SendPos", "{", "SendPos: params is not JSON"),
        ("sql3", "Fly", None, "unknown operation 'Fly'"),
    ):
        bridge.sql("insert into rr (robot, op, params) values (?, ?, ?)", name, op, params)
        _, ack, _ = SqlRobot(bridge.database, name).read("OpAck")
        assert ack["ok"] is False
        assert reason in ack["reason"]
    wait_until(lambda: bridge.sql("select id from rr where robot in ('sql3', 'no robot')") == [])
    assert bridge.sql("select id from sa where robot = 'no robot'") == []


# --- who is not let in ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "status", "text"),
    [
        ("/", 404, "/ is not served here; robots connect to /robot, operators to /desk"),
        ("/robots", 404, "/robots is not served here"),
        ("/robot?robot=r%201", 400, "robot name 'r 1' cannot be used"),
    ],
)
def test_a_wrong_address_is_answered_with_text(bridge, path, status, text):
    with pytest.raises(InvalidStatus) as caught:
        connect(f"{bridge.address}{path}")
    assert caught.value.response.status_code == status
    assert text in caught.value.response.body.decode()


@pytest.mark.parametrize("path", ["/robot", "/desk"])
def test_a_web_page_is_not_let_in(bridge, path):
    with pytest.raises(InvalidStatus) as caught:
        connect(f"{bridge.address}{path}", origin="http://localhost:8000")
    assert caught.value.response.status_code == 403


def test_a_connection_that_speaks_no_websocket_harms_nobody(bridge):
    with socket.create_connection(("127.0.0.1", bridge.port)) as link:
        link.sendall(b"\x00\xff nonsense\r\n\r\n")
        link.settimeout(BUSY * 5)
        assert b"Traceback" not in link.recv(4096)
    assert RobotWire(f"{bridge.address}/robot").ask("Ready", {"magic": 1})["ok"] is True
