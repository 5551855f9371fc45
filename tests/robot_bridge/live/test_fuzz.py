"""Whatever comes in, the gateway answers the next question of whoever asks, and never with a traceback.

500 cases here; ``make bench PARTS=attack`` tries 10 000.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest
from bridge_programs import wait_until
from bridge_wires import RefusedError, Wire
from hypothesis import HealthCheck, given, settings
from stage.fuzzing import Conversation, desk_frames, handshakes, knock, robot_frames, rr_rows
from stage.patience import BUSY
from websockets.exceptions import ConnectionClosed, InvalidStatus

GENEROUS = """
[limits]
robot_messages_per_s = 100000
robot_burst = 100000
desk_messages_per_s = 100000
desk_burst = 100000
failed_logins_per_minute = 100000
"""


def cases(count):
    checks = [HealthCheck.too_slow]
    return settings(max_examples=count, deadline=None, suppress_health_check=checks, print_blob=False)


@pytest.fixture(scope="module")
def bridge(start_bridge, limited_site):
    return start_bridge(limited_site(GENEROUS))


@pytest.fixture(scope="module")
def robots(bridge):
    """Two robots, so that one may be told what the other asked."""
    made = []
    for name in ("fuzzed-1", "fuzzed-2"):
        robot = bridge.robot(name)
        robot.plug_in(1)
        pose = {"x": 1, "y": 2, "theta": 0, "v": 0}
        made.append(Conversation(robot.connection, name, "SendPos", pose))
    return made


@pytest.fixture(scope="module")
def desks(bridge):
    wires = [bridge.desk() for _ in range(2)]
    return [
        Conversation(wire.connection, f"desk-{n}", "get_commands", {"limit": 1})
        for n, wire in enumerate(wires)
    ]


@pytest.fixture(scope="module")
def guarded(start_bridge, limited_site, accounts_of):
    """A gateway whose desk and robots have tokens that nobody here knows."""
    bridge = start_bridge(limited_site(GENEROUS))
    accounts = accounts_of(bridge)
    accounts.operator("Ada", "supervisor")
    accounts.robot("r1")
    wait_until(lambda: is_shut(bridge.desk))
    wait_until(lambda: is_shut(lambda: bridge.robot("r1")))
    return bridge


def is_shut(connect: Callable[[], Wire]) -> bool:
    """Tell whether nobody gets in without a token."""
    try:
        connect().connection.close()
    except InvalidStatus as error:
        return error.response.status_code == 401
    return False


@cases(150)
@given(frame=robot_frames)
def test_a_robot_may_send_anything(robots, frame):
    for robot in robots:
        robot.say(frame)


@cases(150)
@given(frame=desk_frames)
def test_an_operator_may_send_anything(desks, frame):
    for desk in desks:
        desk.say(frame)


@cases(100)
@given(request=handshakes)
def test_anybody_may_knock_with_anything_and_gets_in_without_a_token_never(guarded, request):
    answer = knock("127.0.0.1", guarded.port, request)
    assert not answer.startswith(b"HTTP/1.1 101"), answer
    assert not answer.startswith(b"HTTP/1.1 500"), answer


@cases(100)
@given(row=rr_rows)
def test_anybody_may_write_anything_into_rr(bridge, row):
    try:
        bridge.sql("insert into rr (robot, op, params, payload) values (?, ?, ?, ?)", *row)
    except UnicodeEncodeError:
        return
    until = time.monotonic() + 10 * BUSY
    while bridge.sql("select id from rr"):
        assert time.monotonic() < until
        time.sleep(0.01)


def test_the_same_gateways_are_still_there(bridge, guarded, desks):
    assert bridge.gateway.poll() is None
    assert guarded.gateway.poll() is None
    assert all("Traceback" not in (params or "") for (params,) in bridge.sql("select params from sa"))
    with pytest.raises(RefusedError, match="robot 'nobody' is not known"):
        bridge.desk().ask("send", {"command": "after-all", "robot": "nobody", "op": "Abort"})


@pytest.mark.parametrize(("path", "size"), [("/robot", 6 << 20), ("/desk", 1 << 20)])
def test_a_frame_that_is_too_large_ends_its_connection_and_no_other(bridge, path, size):
    from websockets.sync.client import connect

    with connect(f"{bridge.address}{path}", compression=None) as wire:
        with pytest.raises(ConnectionClosed) as caught:
            wire.send('{"jsonrpc": "2.0", "method": "' + "x" * size + '"}')
            while True:
                wire.recv(5)
        assert caught.value.rcvd.code == 1009
    assert "robots" in bridge.desk().ask("get_positions")
