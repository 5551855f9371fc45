"""Positions on a real connection, in pieces and mixed with all else: nothing is lost or overtakes."""

from __future__ import annotations

import itertools
import json
import time

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_sockets import frame, plain_socket
from tests.support.patience import BUSY

PING, CONTINUED = 9, 0
NAMES = (f"stream-{number}" for number in itertools.count())


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture
def desk(bridge):
    return bridge.desk()


@pytest.fixture
def robot():
    return next(NAMES)


def call(method, id=None, **params):
    value = {"jsonrpc": "2.0", "method": method, "params": params}
    return frame(json.dumps(value if id is None else {**value, "id": id}))


def pose(number, **changes):
    values = {"x": float(number), "y": 2.0, "theta": 0.5, "v": 1.0, "t": float(number)}
    return call("SendPos", **{**values, **changes})


def send(bridge, robot, stream, size):
    """Send a stream in pieces of ``size`` bytes; return the socket, which must stay open."""
    raw = plain_socket(bridge, f"/robot?robot={robot}")
    for begin in range(0, len(stream), size):
        raw.sendall(stream[begin : begin + size])
    return raw


def known(desk, robot):
    return next((r for r in desk.ask("get_positions")["robots"] if r["robot"] == robot), {})


@pytest.mark.parametrize("size", [1, 3, 50, 137, 100_000])
def test_however_the_bytes_come_the_newest_position_wins(bridge, desk, robot, size):
    stream = call("Ready", 1, magic=7) + b"".join(pose(number) for number in range(1, 40))
    with send(bridge, robot, stream, size):
        wait_until(lambda: known(desk, robot).get("x") == 39.0)


@pytest.mark.parametrize("size", [11, 100_000])
@pytest.mark.parametrize(("moves_last", "stopped"), [(True, False), (False, True)])
def test_a_position_does_not_overtake_what_came_before_it(bridge, desk, robot, size, moves_last, stopped):
    halt = call("Stopped", 2)
    stream = call("Ready", 1, magic=7) + pose(1) + (halt + pose(2) if moves_last else pose(2) + halt)
    with send(bridge, robot, stream, size):
        wait_until(lambda: known(desk, robot).get("x") == 2.0 and known(desk, robot)["stopped"] is stopped)


@pytest.mark.parametrize("size", [1, 100_000])
def test_a_wrong_position_is_told_and_the_right_ones_around_it_count(bridge, desk, robot, size):
    stream = call("Ready", 1, magic=7) + pose(1) + pose(2, x="far") + pose(3)
    with send(bridge, robot, stream, size) as raw:
        wait_until(lambda: known(desk, robot).get("x") == 3.0)
        raw.settimeout(BUSY * 5)
        told = b""
        while b"Expected `float`" not in told:
            told += raw.recv(1 << 16)


@pytest.mark.parametrize("size", [1, 100_000])
def test_a_position_in_fragments_with_pings_between_them_counts_in_its_turn(bridge, desk, robot, size):
    whole = json.dumps(
        {"jsonrpc": "2.0", "method": "SendPos", "params": {"x": 5, "y": 0, "theta": 0, "v": 1, "t": 5}}
    )
    first, last = frame(whole[:40]), frame(whole[40:], CONTINUED)
    fragments = bytes([first[0] & 0x7F]) + first[1:] + frame("here?", PING) + last
    stream = call("Ready", 1, magic=7) + pose(1) + fragments + pose(9) + frame("still?", PING)
    with send(bridge, robot, stream, size):
        wait_until(lambda: known(desk, robot).get("x") == 9.0)


def test_a_robot_whose_fix_stands_still_is_marked_and_its_position_grows_old(bridge, desk, robot):
    fix = time.time()
    with send(bridge, robot, call("Ready", 1, magic=7) + pose(1, t=fix, fix_t=fix), 100_000) as raw:

        def is_marked():
            raw.sendall(pose(1, t=time.time(), fix_t=fix))
            return "old when it came" in (known(desk, robot).get("doubt") or "")

        wait_until(is_marked)
        seen = known(desk, robot)
        assert seen["state"] == "fresh" and seen["pose_age"] >= 3.0 > seen["age"]
        raw.sendall(pose(2, t=time.time(), fix_t=time.time()))
        wait_until(lambda: known(desk, robot).get("x") == 2.0)
        assert known(desk, robot).get("status") is None and "doubt" not in known(desk, robot)


def test_a_robot_that_drives_and_says_only_that_it_is_alive_is_marked(bridge, desk, robot):
    with send(bridge, robot, call("Ready", 1, magic=7) + pose(1, t=None), 100_000) as raw:

        def is_marked():
            raw.sendall(call("Alive"))
            return "the robot may be elsewhere" in (known(desk, robot).get("doubt") or "").lower()

        wait_until(is_marked)
        assert known(desk, robot)["state"] == "fresh"


def test_nothing_counts_from_a_robot_that_is_not_ready(bridge, desk, robot):
    with send(bridge, robot, pose(1) + pose(2), 100_000) as raw:
        raw.settimeout(BUSY * 5)
        told = b""
        while told.count(b"has not said Ready") < 2:
            told += raw.recv(1 << 16)
    assert known(desk, robot) == {}
