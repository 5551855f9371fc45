"""Whatever comes in, the gateway answers the next question, and never with a traceback."""

from __future__ import annotations

import json
import time

import pytest
from bridge_wires import RefusedError
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed

from robot_bridge.messages import DESK_REQUESTS, REQUESTS

numbers = st.integers() | st.floats(allow_nan=False) | st.sampled_from([10**30, -1, 2**63, 1e308])
scalars = st.none() | st.booleans() | numbers | st.text(max_size=20)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=8,
)
NAMES = ["magic", "x", "y", "theta", "v", "t", "battery", "status", "area", "id", "ok", "reason", "rate"]
NAMES += ["operator", "protocol", "positions", "command", "robot", "op", "params", "limit", "points", "cone"]
params = st.none() | values | st.dictionaries(st.sampled_from(NAMES), scalars | values, max_size=6)
replies = st.fixed_dictionaries(
    {"jsonrpc": st.just("2.0"), "id": scalars}, optional={"result": values, "error": values}
)


def calls(methods):
    method = st.sampled_from(sorted(methods)) | st.text(max_size=8)
    optional = {"params": params, "id": scalars}
    return st.fixed_dictionaries({"jsonrpc": st.just("2.0"), "method": method}, optional=optional)


def frames(methods):
    """Frames from nearly right to nonsense."""
    text = (calls(methods) | calls(methods) | replies | values).map(json.dumps)
    return text | st.text(max_size=60) | st.binary(max_size=60)


quick = settings(
    max_examples=80, deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=False
)


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def robot(bridge):
    robot = bridge.robot("fuzzed")
    robot.plug_in(1)
    return robot


@pytest.fixture(scope="module")
def desk(bridge):
    return bridge.desk()


def still_answers(wire, frame, method, params):
    """Send a frame, then ask something right; all that comes before its answer must be clean text."""
    wire.connection.send(frame)
    wire.connection.send(json.dumps({"jsonrpc": "2.0", "id": "after", "method": method, "params": params}))
    until = time.monotonic() + 10
    while True:
        text = wire.connection.recv(until - time.monotonic())
        assert "Traceback" not in text
        assert 'File "' not in text
        answer = json.loads(text)
        if answer.get("id") == "after" and answer.get("result") is not None:
            return


@quick
@given(frame=frames(REQUESTS))
def test_a_robot_may_send_anything(robot, frame):
    still_answers(robot, frame, "SendPos", {"x": 1, "y": 2, "theta": 0, "v": 0})


@quick
@given(frame=frames(DESK_REQUESTS))
def test_an_operator_may_send_anything(desk, frame):
    still_answers(desk, frame, "get_commands", {"limit": 1})


@settings(quick, max_examples=40)
@given(
    name=st.text(max_size=10) | st.binary(max_size=8) | st.integers(),
    op=st.sampled_from(sorted(REQUESTS)) | st.text(max_size=8) | st.binary(max_size=8),
    params=params.map(json.dumps) | st.text(max_size=30) | st.binary(max_size=30) | st.none(),
)
def test_anybody_may_write_anything_into_rr(bridge, name, op, params):
    if isinstance(name, int):
        name %= 2**63
    try:
        bridge.sql("insert into rr (robot, op, params) values (?, ?, ?)", name, op, params)
    except UnicodeEncodeError:
        return
    until = time.monotonic() + 10
    while bridge.sql("select id from rr"):
        assert time.monotonic() < until
        time.sleep(0.01)


def test_the_same_gateway_is_still_there(bridge, desk):
    assert bridge.gateway.poll() is None
    assert all("Traceback" not in params for (params,) in bridge.sql("select params from sa"))
    with pytest.raises(RefusedError, match="robot 'nobody' is not known"):
        desk.ask("send", {"command": "after-all", "robot": "nobody", "op": "Abort"})


@pytest.mark.parametrize("path", ["/robot", "/desk"])
def test_a_frame_that_is_too_large_ends_its_connection_and_no_other(bridge, path):
    from websockets.sync.client import connect

    with connect(f"{bridge.address}{path}", compression=None) as wire:
        with pytest.raises(ConnectionClosed) as caught:
            wire.send('{"jsonrpc": "2.0", "method": "' + "x" * (1 << 20) + '"}')
            while True:
                wire.recv(5)
        assert caught.value.rcvd.code == 1009
    assert "robots" in bridge.desk().ask("get_positions")
