"""What an operator is told, and how fast: what changed only, states by silence, slow readers at no cost."""

from __future__ import annotations

import json
import os
import socket
import time
from pathlib import Path

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.wire import RefusedError

POSE = {"x": 1.0, "y": 2.0, "theta": 0.5, "v": 0.0}


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site):
    return start_bridge(impatient_site)


def states(desk, robot, since=0):
    """Return the states that a robot went through, as the operator was told."""
    told = [r["state"] for s in desk.snapshots[since:] for r in s["robots"] if r["robot"] == robot]
    return [state for k, state in enumerate(told) if k == 0 or told[k - 1] != state]


def test_hello_is_answered_with_the_site(bridge):
    desk = bridge.desk()
    assert desk.site == {
        "id": "sample",
        "name": "Sample proving ground and campus",
        "version": 1,
        "crs": "EPSG:32633",
        "origin": [640420.0, 5193480.0],
        "rotation": 0.0,
        "bounds": [0.0, 0.0, 200.0, 160.0],
        "reached_tolerance": 0.2,
        "stale_after": 0.8,
        "lost_after": 1.6,
        "roads": True,
    }


@pytest.mark.parametrize(
    ("params", "text"),
    [
        ({"operator": "Ada", "protocol": 99}, "protocol 99 is not spoken here, 1 is"),
        ({"operator": "  "}, "operator is empty; give the operator's name"),
        ({}, "hello: Object missing required field `operator`"),
    ],
)
def test_a_wrong_hello_is_refused(bridge, params, text):
    with pytest.raises(RefusedError, match=text):
        bridge.desk().ask("hello", params)


def test_an_operator_is_told_everything_at_first_and_then_what_changed(bridge):
    a, b = bridge.robot("a"), bridge.robot("b")
    for robot in (a, b):
        robot.plug_in(1)
        robot.ask("SendPos", POSE)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    desk.until(lambda: desk.snapshots)
    assert {"a", "b"} <= {r["robot"] for r in desk.snapshots[0]["robots"]}
    seen = len(desk.snapshots)
    a.ask("SendPos", {**POSE, "x": 7.0})
    desk.until(lambda: desk.robots["a"]["x"] == 7.0)
    changed = [r["robot"] for s in desk.snapshots[seen:] for r in s["robots"]]
    assert "a" in changed
    desk.wait_for_robots("a")
    for robot in (a, b):
        robot.tell("Stopped")
    desk.until(lambda: desk.robots["a"]["state"] == desk.robots["b"]["state"] == "offline")
    # What robots had said before comes yet on a slow machine.
    wait_until(lambda: is_told_nothing(desk), 15)


def is_told_nothing(desk) -> bool:
    """Tell whether half a second passes without news of robots."""
    seen = len(desk.snapshots)
    desk.listen(0.5)
    return desk.snapshots[seen:] == []


def test_positions_come_no_oftener_than_asked(bridge):
    robot, desk = bridge.robot("often"), bridge.desk()
    robot.plug_in(1)
    desk.ask("subscribe", {"rate": 4})
    for k in range(50):
        robot.tell("SendPos", {**POSE, "x": float(k)})
        desk.listen(0.02)
    desk.until(lambda: desk.robots["often"]["x"] == 49.0, 1.0)
    took = desk.snapshots[-1]["t"] - desk.snapshots[0]["t"]
    assert 3 <= len(desk.snapshots) <= 4 * took + 3


def test_get_positions_tells_of_every_robot(bridge):
    robot = bridge.robot("here")
    robot.plug_in(1)
    robot.ask("SendPos", {**POSE, "battery": 0.5, "status": "ok", "t": 12.5})
    answer = bridge.desk().ask("get_positions")
    (here,) = [r for r in answer["robots"] if r["robot"] == "here"]
    assert abs(answer["t"] - time.time()) < 5
    assert here.pop("age") < 1
    assert here.pop("pose_age") < 1
    assert here == {
        "robot": "here",
        "state": "fresh",
        "link": "websocket",
        "stopped": False,
        "x": 1.0,
        "y": 2.0,
        "theta": 0.5,
        "v": 0.0,
        "device_time": 12.5,
        "battery": 0.5,
        "status": "ok",
    }


def test_a_robot_that_falls_silent_turns_stale_then_lost_and_comes_back_fresh(bridge):
    robot, desk = bridge.robot("silent"), bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    robot.plug_in(1)
    robot.ask("SendPos", POSE)
    desk.until(lambda: desk.robots.get("silent", {}).get("state") == "lost", 5)
    robot.tell("Alive")
    desk.until(lambda: desk.robots["silent"]["state"] == "fresh", 5)
    assert states(desk, "silent") == ["fresh", "stale", "lost", "fresh"]


def test_a_view_brings_who_is_in_it_and_another_one_what_it_changes(bridge):
    for name, x in (("left", 100.0), ("middle", 110.0), ("right", 120.0)):
        robot = bridge.robot(name)
        robot.plug_in(1)
        robot.ask("SendPos", {**POSE, "x": x, "y": 150.0})
    desk = bridge.desk()
    assert desk.hello["robots"] >= 3
    view = {"bounds": [99.0, 149.0, 111.0, 151.0]}
    desk.ask("subscribe", {"rate": 50, "view": view})
    seen = InView(desk)
    desk.until(lambda: seen.names() & {"left", "middle", "right"} == {"left", "middle"})
    desk.ask("subscribe", {"rate": 50, "view": {**view, "bounds": [109.0, 149.0, 121.0, 151.0]}})
    desk.until(lambda: seen.names() & {"left", "middle", "right"} == {"middle", "right"})
    assert [s.get("everything", False) for s in desk.snapshots].count(True) == 1
    untracked = [name for s in desk.snapshots for name in s.get("untracked", [])]
    assert "left" in untracked
    assert desk.snapshots[0]["view"]["robots"] >= 3
    desk.ask("subscribe", {"rate": 50, "view": {**view, "most": 1, "bounds": [99.0, 149.0, 121.0, 151.0]}})
    desk.until(lambda: (desk.snapshots[-1].get("view") or {}).get("density"))
    density = desk.snapshots[-1]["view"]["density"]
    assert sum(sum(density[group]) for group in ("fresh", "silent", "offline")) >= 3
    desk.ask("subscribe", {"rate": 50})
    desk.until(lambda: desk.snapshots[-1].get("everything") and "view" not in desk.snapshots[-1])


class InView:
    """Which robots a desk was told of one by one."""

    def __init__(self, desk):
        self.desk = desk

    def names(self):
        """Return their names."""
        names = set()
        for told in self.desk.snapshots:
            names = set() if told.get("everything") else names
            names |= {robot["robot"] for robot in told["robots"]}
            names -= {*told.get("untracked", []), *told.get("removed", [])}
        return names


def test_robots_are_found_by_name(bridge):
    bridge.robot("seek-1").plug_in(1)
    bridge.robot("seek-2").plug_in(1)
    found = bridge.desk().ask("find_robots", {"text": "SEEK", "limit": 1})
    assert ([robot["robot"] for robot in found["robots"]], found["count"]) == (["seek-1"], 2)


@pytest.mark.parametrize("how", ["stopped", "closed", "stands, cut off", "cut off"])
def test_a_robot_that_ends_in_order_goes_offline_and_one_that_is_cut_off_is_lost(bridge, how):
    name = how.replace(" ", "-").replace(",", "")
    robot, desk = bridge.robot(name), bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    robot.plug_in(1)
    robot.ask("SendPos", {**POSE, "v": 1.0})
    if how == "stopped":
        robot.ask("Stopped")
    elif how == "closed":
        robot.connection.close()
    else:
        if how == "stands, cut off":
            # As after an abort, or while it waits for its next task.
            robot.ask("Stopped")
            robot.ask("Alive")
        robot.connection.socket.shutdown(socket.SHUT_RDWR)
    end = "lost" if how.endswith("cut off") else "offline"
    desk.until(lambda: desk.robots.get(name, {}).get("state") in ("offline", "lost"), 5)
    assert desk.robots[name]["state"] == end


def test_a_robot_on_sql_that_said_stopped_goes_offline(bridge):
    for op, params in (("Ready", {"magic": 1}), ("SendPos", POSE), ("Stopped", {})):
        bridge.sql("insert into rr (robot, op, params) values ('over-sql', ?, ?)", op, json.dumps(params))
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.until(lambda: desk.robots.get("over-sql", {}).get("state") == "offline", 5)


# --- what is refused --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("method", "params", "code", "text"),
    [
        ("fly", {}, -32601, "unknown method 'fly'; known are hello, subscribe"),
        ("subscribe", {"rate": 0}, -32602, "subscribe: rate is 0"),
        ("subscribe", {"view": {"bounds": [5, 0, 5, 9]}}, -32602, r"subscribe: bounds is \[5"),
        ("subscribe", {"rate": "fast"}, -32602, r"subscribe: .*\$\.rate"),
        ("get_commands", {"limit": -1}, -32602, "get_commands: limit is -1"),
        (
            "send",
            {"command": "id", "robot": "x", "op": "SetPosEnd"},
            -32602,
            "command is 'id'; give an id of 8",
        ),
        ("send", {"command": "a-command", "robot": "nobody", "op": "Abort"}, -32000, "robot 'nobody' is not"),
        ("send", {"command": "a-command", "robot": "a b", "op": "Abort"}, -32602, "robot name 'a b' cannot"),
        ("set_positions", {"positions": [{"robot": "nobody", "x": 1, "y": 2}]}, -32000, "is not known"),
        ("set_positions", {"positions": [{"robot": "a"}]}, -32602, r"\$\.positions\[0\]"),
    ],
)
def test_a_wrong_request_is_refused_with_its_code(bridge, method, params, code, text):
    desk = bridge.desk()
    with pytest.raises(RefusedError, match=text) as caught:
        desk.ask(method, params)
    assert caught.value.code == code
    assert "robots" in desk.ask("get_positions")


def test_a_target_off_the_site_is_refused_with_where_the_site_is(bridge):
    bridge.robot("target").plug_in(1)
    desk = bridge.desk()
    with pytest.raises(
        RefusedError, match=r"\(300.00, 1.00\) lies outside .* to \(200.00, 160.00\)"
    ) as caught:
        desk.send("off-the-site", "target", "SetPosEnd", x=300.0, y=1.0)
    assert caught.value.code == -32000
    assert desk.ask("get_commands", {"robot": "target"})["commands"] == []


# --- many operators ---------------------------------------------------------------------------------------


def test_every_operator_is_told_of_every_step_and_who_asked(bridge):
    robot = bridge.robot("watched")
    robot.plug_in(1)
    ada, bob = bridge.desk("Ada"), bridge.desk("Bob")
    (report,) = ada.ask("set_positions", {"positions": [{"robot": "watched", "x": 9.0, "y": 8.0}]})[
        "commands"
    ]
    id = report["command"]
    robot.say(robot.wait_for("SetPosEnd")["id"])
    told = bob.wait_for_step(id, "acknowledged")
    assert (told["operator"], told["params"]) == ("Ada", {"x": 9.0, "y": 8.0, "cone": False})
    bob.ask("abort_all")
    ended = robot.wait_for("Abort")
    robot.say(ended["id"])
    assert ada.wait_for_step(id, "aborted")["steps"][-1]["by"] == "Bob"


def test_an_operator_who_never_reads_costs_no_memory_and_delays_nobody(bridge):
    robots = [bridge.robot(f"talker-{k}") for k in range(4)]
    for robot in robots:
        robot.plug_in(1)
    links = [_never_reading(bridge.port) for _ in range(4)]
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    before, late = _resident(bridge.gateway.pid), []
    text = "x" * 50_000
    until = time.monotonic() + 4
    while time.monotonic() < until:
        for robot in robots:
            robot.tell("SendPos", {**POSE, "t": time.monotonic(), "status": text})
        desk.listen(0.03)
        times = [r["device_time"] for r in desk.snapshots[-1]["robots"] if "device_time" in r]
        late += [time.monotonic() - t for t in times]
        del desk.snapshots[:-1]
    grown = _resident(bridge.gateway.pid) - before
    for link in links:
        link.close()
    # 4 robots of 50 kB, some 25 times a second, to 4 of them: 80 MB that nobody read.
    assert len(late) > 100
    assert sorted(late)[len(late) // 2] < 0.2 * BUSY
    assert grown < 25e6, f"{grown / 1e6:.1f} MB"


def _never_reading(port):
    """Subscribe on a bare socket with a small buffer and read nothing."""
    link = socket.socket()
    link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    link.connect(("127.0.0.1", port))
    key = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
    upgrade = f"Host: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n{key}\r\n"
    link.sendall(f"GET /desk HTTP/1.1\r\n{upgrade}".encode())
    wait_until(lambda: link.recv(1, socket.MSG_PEEK))
    frame = b'{"jsonrpc":"2.0","method":"subscribe","id":1,"params":{"rate":50}}'
    mask = os.urandom(4)
    masked = bytes(byte ^ mask[k % 4] for k, byte in enumerate(frame))
    link.sendall(bytes([0x81, 0x80 | len(frame)]) + mask + masked)
    return link


def _resident(pid):
    """Return the bytes of memory that a process holds."""
    pages = int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")
