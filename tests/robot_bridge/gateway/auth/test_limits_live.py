"""What a gateway takes from each connection, tried on a real one with small limits."""

from __future__ import annotations

import contextlib
import json
import re
import socket
import time
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from robot_bridge.protocol.jsonrpc import TOO_MANY
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_sockets import frame, open_sockets, plain_socket
from tests.support.patience import BUSY, START
from tests.support.wire import RefusedError

LIMITS = """
[limits]
largest_message_bytes = 20000
robot_messages_per_s = 20
robot_burst = 20
desk_messages_per_s = 20
desk_burst = 20
robots = 6
desks = 8
desks_per_account = 2
pending_per_address = 5
handshake_s = 1.0
first_message_s = 1.5
silent_s = 2.5
stuck_s = 2.0
send_buffer_bytes = 16384
origins = ["https://fleet.example.org"]

[observations]
largest_image_bytes = 40000
"""


@pytest.fixture(scope="module")
def bridge(start_bridge, limited_site):
    return start_bridge(limited_site(LIMITS))


@pytest.fixture(scope="module")
def alone(bridge):
    """How many sockets the gateway has open that nobody is connected to."""
    return open_sockets(bridge)


@pytest.fixture(autouse=True)
def nobody_is_left(bridge, alone):
    yield
    bridge.hang_up()
    bridge._wires.clear()
    wait_until(lambda: open_sockets(bridge) <= alone)


def unless_refused(attempt):
    """Return what ``attempt()`` returns, None where it is refused: there is no room, or too much was said."""
    try:
        return attempt()
    except (RefusedError, InvalidStatus):
        return None


@pytest.mark.parametrize("path", ["/desk", "/robot"])
def test_too_many_messages_are_refused_and_then_the_connection_is_closed(bridge, path, close_code):
    with connect(f"{bridge.address}{path}") as wire:
        method = "get_positions" if path == "/desk" else "Alive"
        refused = []
        with pytest.raises(ConnectionClosed) as caught:
            # Without waiting for answers in between: a busy machine gives few of them a second.
            for id in range(200):
                wire.send(json.dumps({"jsonrpc": "2.0", "id": id, "method": method}))
            while True:
                answer = json.loads(wire.recv(START))
                if answer.get("error", {}).get("code") == TOO_MANY:
                    refused.append(answer["id"])
        assert min(refused) >= 20
        assert caught.value.rcvd.code == 1008
        assert "too many messages" in caught.value.rcvd.reason
    assert "robots" in bridge.desk().ask("get_positions")


@pytest.mark.parametrize("size", [100, 100_000])
def test_too_many_positions_are_refused_and_then_the_connection_is_closed(bridge, size):
    position = {"jsonrpc": "2.0", "method": "SendPos", "params": {"x": 1, "y": 2, "theta": 0, "v": 0}}
    ready = frame(json.dumps({"jsonrpc": "2.0", "id": 1, "method": "Ready", "params": {"magic": 1}}))
    with plain_socket(bridge, "/robot?robot=talkative") as raw:
        raw.settimeout(BUSY * 5)
        raw.sendall(ready)
        told = b""
        while b'"ok":true' not in told:
            told += raw.recv(4096)
        stream = frame(json.dumps(position)) * 100
        with contextlib.suppress(OSError):
            for begin in range(0, len(stream), size):
                raw.sendall(stream[begin : begin + size])
        with contextlib.suppress(OSError):
            while more := raw.recv(1 << 16):
                told += more
    assert b"too many messages a second" in told


def refusal_of_too_many(desk):
    """Ask for more than a desk may, without waiting for answers in between; return the last refusal."""
    refusals = []
    for _ in range(20):
        asked = {desk.begin("get_positions") for _ in range(30)}
        # What is refused is answered first.
        while asked:
            frame = desk.receive(START)
            asked.discard(frame.get("id"))
            if "error" in frame:
                refusals.append(RefusedError(frame["error"]))
        if refusals:
            return refusals[-1]
    raise AssertionError("600 messages were answered")


def test_whoever_waits_as_long_as_is_said_is_answered_again(bridge):
    desk = bridge.desk()
    refusal = refusal_of_too_many(desk)
    assert refusal.code == TOO_MANY
    seconds = re.search(r"wait (0\.\d\d) s and send fewer", str(refusal))[1]
    # Of a second refusal within that time more would be said: the hundredth that is rounded away.
    time.sleep(float(seconds) + 0.01)
    desk.ask("get_positions")


def test_an_emergency_stop_is_taken_from_whoever_has_talked_too_much(bridge):
    desk = bridge.desk()
    assert "too many messages" in str(refusal_of_too_many(desk))
    assert desk.ask("emergency_stop", {"command": "stop-in-a-flood"})["in_force"]
    cleared = wait_until(
        lambda: unless_refused(lambda: desk.ask("clear_emergency_stop", {"reason": "tried"}))
    )
    assert not cleared["in_force"]


@pytest.mark.parametrize(
    ("path", "fits", "too_large"), [("/desk", 19_000, 21_000), ("/robot", 100_000, 120_000)]
)
def test_a_message_has_a_largest_size_and_only_an_image_may_be_larger(bridge, path, fits, too_large):
    with connect(f"{bridge.address}{path}") as wire:
        wire.send(json.dumps({"jsonrpc": "2.0", "id": 1, "method": "x" * fits}))
        told = next(text for text in iter(lambda: wire.recv(START), "") if '"id":1' in text)
        assert "x" * 40 in told and ("but for SendImage" in told) == (path == "/robot")
        wire.send(json.dumps({"jsonrpc": "2.0", "id": 2, "method": "x" * too_large}))
        with pytest.raises(ConnectionClosed) as caught:
            wire.recv(START)
        assert caught.value.rcvd.code == 1009


@pytest.mark.parametrize(
    ("origins", "status"),
    [
        ([], None),
        (["https://fleet.example.org"], None),
        (["https://evil.example.org"], 403),
        (["null"], 403),
        (["https://fleet.example.org.evil.org"], 403),
        (["https://fleet.example.org", "https://evil.example.org"], 403),
    ],
)
@pytest.mark.parametrize("path", ["/desk", "/robot"])
def test_only_the_web_pages_that_the_site_names_may_connect(bridge, refused, path, origins, status):
    def attempt():
        headers = [("Origin", origin) for origin in origins]
        return connect(f"{bridge.address}{path}", additional_headers=headers)

    if status is None:
        attempt().close()
    else:
        found, text = refused(attempt)
        assert found == status
        assert "'origins' in [limits] of site.toml" in text


def test_robots_and_desks_have_places_of_their_own(bridge, refused):
    robots = [bridge.robot(f"r{n}") for n in range(6)]
    status, text = refused(lambda: bridge.robot("r7"))
    assert (status, text) == (503, "there is room for 6 robots, and it is taken; try later.\n")
    desks = [bridge.desk() for _ in range(8)]
    status, text = refused(bridge.desk)
    assert (status, text) == (503, "there is room for 8 desks, and it is taken; try later.\n")
    robots[0].connection.close()
    desks[0].connection.close()
    wait_until(lambda: unless_refused(lambda: bridge.robot("r7")))
    wait_until(lambda: unless_refused(bridge.desk))


def test_whoever_opens_a_connection_has_to_say_what_for(bridge):
    with socket.create_connection(("127.0.0.1", bridge.port), 5) as silent:
        silent.sendall(b"GET /desk HTTP/1.1\r\nHost: x\r\n")
        began = time.monotonic()
        silent.settimeout(30)
        assert silent.recv(100) == b""
        assert time.monotonic() - began > 0.5


def is_ended(peer: socket.socket) -> bool:
    """Tell whether the gateway has closed this connection, on which it says nothing."""
    peer.setblocking(False)
    try:
        return peer.recv(1) == b""
    except BlockingIOError:
        return False
    except ConnectionResetError:
        return True


def test_many_half_open_connections_from_one_address_take_no_place(bridge):
    waiting = [socket.create_connection(("127.0.0.1", bridge.port), 5) for _ in range(40)]
    wait_until(lambda: sum(map(is_ended, waiting)) >= 35)
    wait_until(lambda: all(map(is_ended, waiting)))
    assert bridge.desk().site
    for peer in waiting:
        peer.close()


@pytest.mark.parametrize("path", ["/desk", "/robot"])
def test_who_says_nothing_is_closed(bridge, path, close_code):
    with connect(f"{bridge.address}{path}") as wire:

        class Listening:
            connection = wire

        code, reason, took = close_code(Listening, 6)
    assert (code, reason) == (1008, "silent for too long")
    assert took > 1.0


def test_a_desk_that_listens_may_be_silent_and_a_robot_may_not(bridge, close_code):
    desk, robot = bridge.desk(), bridge.robot("r1")
    robot.plug_in(1)
    code, _, took = close_code(robot, 8)
    assert code == 1008
    assert took > 2.0
    desk.listen(1.0)
    assert desk.ask("get_positions")


def memory(bridge):
    status = Path(f"/proc/{bridge.gateway.pid}/status").read_text(encoding="ascii")
    return int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS"))) // 1024


def test_who_takes_nothing_of_what_it_is_sent_is_cut_off(bridge):
    raw = plain_socket(bridge, "/desk")
    ask = frame(json.dumps({"jsonrpc": "2.0", "id": 1, "method": "x" * 15_000}))
    began = time.monotonic()
    raw.sendall(ask * 15)
    until_line = "operator without a name from 127.0.0.1 takes nothing of what it is sent; cut off"
    while until_line not in bridge.output():
        assert time.monotonic() - began < BUSY * 8
        time.sleep(0.1)
    assert time.monotonic() - began > 1.5
    assert "robots" in bridge.desk().ask("get_positions")


def test_pings_that_nobody_reads_the_answers_of_cost_no_memory(bridge):
    raw = plain_socket(bridge, "/desk")
    before = memory(bridge)
    with pytest.raises(OSError):
        for _ in range(200_000):
            raw.sendall(frame("p" * 120, opcode=9))
    assert memory(bridge) - before < 10
    wait_until(lambda: "too many control frames" in bridge.output())


def test_a_message_in_endless_empty_pieces_ends(bridge):
    raw = plain_socket(bridge, "/desk")
    raw.sendall(b"\x01\x80\x00\x00\x00\x00")
    with pytest.raises(OSError):
        for _ in range(100_000):
            raw.sendall(b"\x00\x80\x00\x00\x00\x00" * 10)


def test_one_operator_has_so_many_desks_and_no_more(bridge, accounts_of, refused):
    ada = accounts_of(bridge).operator("Ada", "viewer")
    desks = [bridge.desk(**ada) for _ in range(2)]
    status, text = refused(lambda: bridge.desk(**ada))
    assert (status, text) == (503, "Ada has 2 desks open, and gets no more; close one.\n")
    desks[0].connection.close()
    wait_until(lambda: unless_refused(lambda: bridge.desk(**ada)))
