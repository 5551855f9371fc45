"""Positions are decoded in one step, with the same result as any other message."""

from __future__ import annotations

import json

import pytest

from robot_bridge.protocol import jsonrpc
from robot_bridge.protocol.codec import decode_position, decode_request

POSE = {"x": 1.5, "y": -2, "theta": 0.5, "v": 1.0, "t": 1795249076.5, "battery": 0.5, "status": "docking"}


def frame(**changes):
    return json.dumps({"jsonrpc": "2.0", "method": "SendPos", "params": POSE, **changes})


@pytest.mark.parametrize("params", [POSE, {"x": 0, "y": 0, "theta": 0, "v": 0}])
def test_a_position_is_what_the_long_way_makes_of_it(params):
    call = jsonrpc.decode(frame(params=params))
    assert decode_position(frame(params=params)) == decode_request(call.method, call.params)


@pytest.mark.parametrize(
    "text",
    [
        frame(id=1),
        frame(method="Alive"),
        frame(jsonrpc="1.0"),
        frame(params={**POSE, "x": "1"}),
        frame(params={**POSE, "battery": 2}),
        frame(params={**POSE, "colour": "red"}),
        frame(params={**POSE, "x": 1e400}),
        frame(params={"x": 1}),
        frame(params=None),
        "[]",
        "{",
        b"\xff",
        "[" * 100_000,
    ],
)
def test_what_is_no_position_or_a_wrong_one_is_left_to_the_long_way(text):
    assert decode_position(text) is None
