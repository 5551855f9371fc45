"""How large what a robot says may be: refused where it is wrong, cut where its robot would be lost for it."""

from __future__ import annotations

import json
import math

import pytest

from robot_bridge.core.messages.base import LARGEST_MESSAGE, LONGEST_STATUS, MessageError
from robot_bridge.core.messages.robots import SendGPS
from robot_bridge.gateway.model.position_checks import GroundTracks
from robot_bridge.protocol import jsonrpc
from robot_bridge.protocol.asyncapi import documents
from robot_bridge.protocol.codec import check_size, decode_position, decode_request

POSE = {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 1.0}
FIX = {"lat": 46.88, "lon": 16.84}


@pytest.mark.parametrize(
    ("op", "params", "name"),
    [
        ("SendPos", {**POSE, "x": 1e308}, "x"),
        ("SendPos", {**POSE, "y": -2e8}, "y"),
        ("SendPos", {**POSE, "theta": 1e300}, "theta"),
        ("SendPos", {**POSE, "v": 1e300}, "v"),
        ("SendPos", {**POSE, "v": -100.5}, "v"),
        ("SendPos", {**POSE, "t": 1e300}, "t"),
        ("SendPos", {**POSE, "altitude": 1e9}, "altitude"),
        ("SendPos", {**POSE, "battery": 1.5}, "battery"),
        ("SendPos", {**POSE, "accuracy": -1}, "accuracy"),
        ("SendGPS", {**FIX, "v": 1e300}, "v"),
        ("SendGPS", {**FIX, "altitude": -1e300}, "altitude"),
        ("SendGPS", {**FIX, "fix_t": 1e300}, "fix_t"),
        ("GetMap", {"x": 1e300, "y": 0, "area": 1}, "x"),
        ("GetMap", {"x": 0, "y": 0, "area": 1e300}, "area"),
        ("SetObject", {"x": 1e300, "y": 0, "object": "a"}, "x"),
        ("SendImage", {"image": "", "x": 0, "y": 1e300, "object": "a"}, "y"),
    ],
)
def test_a_number_that_cannot_be_is_refused_and_the_schema_says_so(op, params, name):
    with pytest.raises(MessageError, match=rf"{name} is .*; give a number from "):
        decode_request(op, params)
    assert "minimum" in json.dumps(json.loads(documents()[f"robot/{op}.json"])["properties"][name])
    frame = {"jsonrpc": "2.0", "method": op, "params": params}
    assert decode_position(json.dumps(frame)) is None


@pytest.mark.parametrize(
    ("said", "kept"), [(3.1, 3.1), (7.0, 7.0 - math.tau), (-100.0, -100.0 + 16 * math.tau)]
)
def test_theta_is_kept_as_the_same_direction(said, kept):
    assert decode_request("SendPos", {**POSE, "theta": said}).theta == pytest.approx(kept)
    assert -math.pi <= kept <= math.pi


@pytest.mark.parametrize(("op", "params"), [("SendPos", POSE), ("SendGPS", FIX)])
def test_a_long_status_is_cut_and_its_robot_is_not_lost(op, params):
    status = decode_request(op, {**params, "status": "battery\x1b[2J low\n" + "!" * 1_000_000}).status
    assert status.startswith("battery [2J low !!!")
    assert status.endswith("!…")
    assert len(status) == LONGEST_STATUS


def test_a_status_of_just_that_length_is_kept():
    assert decode_request("SendPos", {**POSE, "status": "é" * LONGEST_STATUS}).status == "é" * LONGEST_STATUS


def test_a_gps_that_jumps_tells_no_speed_that_cannot_be():
    tracks = GroundTracks()
    tracks.pose("r1", SendGPS(46.88, 16.84), (0.0, 0.0), 0.0, None, 1.0)
    assert tracks.pose("r1", SendGPS(46.88, 16.84), (90.0, 0.0), 0.0, None, 1.1).v == 100.0


def frame_of(method, size):
    return json.dumps({"params": {"status": "x" * size}, "method": method, "id": 7, "jsonrpc": "2.0"})


def test_only_an_image_may_be_as_large_as_an_image():
    check_size(frame_of("SendImage", 1_000_000), LARGEST_MESSAGE)
    check_size(frame_of("SendPos", 1000), LARGEST_MESSAGE)
    with pytest.raises(
        jsonrpc.FrameError, match="SendPos has 1000074 bytes; at most 65536 are taken"
    ) as caught:
        check_size(frame_of("SendPos", 1_000_000), LARGEST_MESSAGE)
    assert caught.value.id == 7
    for nonsense in ("[" * 100_000, '{"method": ' + "[" * 100_000, "x" * 100_000):
        with pytest.raises(jsonrpc.FrameError, match="the frame has "):
            check_size(nonsense, LARGEST_MESSAGE)
