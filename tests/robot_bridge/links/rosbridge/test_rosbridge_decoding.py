"""What comes from a rosbridge server: decoded within bounds, and told with its topic where it is not."""

from __future__ import annotations

import json
import math

import cbor2
import pytest

from robot_bridge.links.ros.errors import FaultError
from robot_bridge.links.rosbridge.decoding import LARGEST_DECODED, ServiceResponse, convert, decode_frame
from robot_bridge.links.rosbridge.messages import (
    BatteryState,
    DiagnosticArray,
    GoalId,
    GoalStatusArray,
    NavigationFeedback,
    NavigationResult,
    NavSatFix,
    Odometry,
    TFMessage,
    TopicsReply,
)

POSE = {"position": {"x": 1.5, "y": 2, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
SPEED = {"linear": {"x": 0.5, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}
ODOMETRY = {
    "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"},
    "child_frame_id": "base_link",
    "pose": {"pose": POSE, "covariance": [0.25] * 36},
    "twist": {"twist": SPEED, "covariance": [0.0] * 36},
}
TRANSFORM = {
    "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"},
    "child_frame_id": "base_link",
    "transform": {"translation": POSE["position"], "rotation": POSE["orientation"]},
}
STATUS = {"goal_info": {"goal_id": {"uuid": "AAECAwQFBgcICQoLDA0ODw=="}}, "status": 2}


def published(message, topic="/r1/odom"):
    return {"op": "publish", "topic": topic, "msg": message}


@pytest.mark.parametrize("encode", [json.dumps, cbor2.dumps])
def test_a_message_is_the_same_as_json_and_as_cbor(encode):
    came = decode_frame(encode(published(ODOMETRY)))
    read = convert(came.msg, Odometry, came.topic)
    assert (came.topic, read.header.frame_id) == ("/r1/odom", "map")
    assert (read.pose.pose.position.x, read.pose.pose.position.y) == (1.5, 2)
    assert read.pose.covariance[7] == 0.25 and read.twist.twist.linear.x == 0.5


def test_a_typed_array_of_cbor_is_its_numbers():
    packed = cbor2.CBORTag(86, b"\x00\x00\x00\x00\x00\x00\xd0?" * 36)
    message = ODOMETRY | {"pose": {"pose": POSE, "covariance": packed}}
    came = decode_frame(cbor2.dumps(published(message)))
    assert convert(came.msg, Odometry, "x").pose.covariance == [0.25] * 36


def test_null_is_nan():
    fix = {
        "header": {},
        "status": {"status": 0},
        "latitude": None,
        "longitude": 1.0,
        "altitude": None,
        "position_covariance": [None] * 9,
        "position_covariance_type": 2,
    }
    read = convert(fix, NavSatFix, "x")
    assert math.isnan(read.latitude) and math.isnan(read.altitude) and math.isnan(read.position_covariance[4])
    assert math.isnan(convert({"percentage": None}, BatteryState, "x").percentage)


@pytest.mark.parametrize("uuid", ["AAECAwQFBgcICQoLDA0ODw==", list(range(16)), bytes(range(16))])
def test_an_array_of_bytes_may_be_base64_numbers_or_bytes(uuid):
    assert convert({"uuid": uuid}, GoalId, "x").uuid == bytes(range(16))


@pytest.mark.parametrize("level", [2, "Ag==", b"\x02"])
def test_the_level_of_a_diagnosis_is_a_byte_however_it_is_written(level):
    (read,) = convert({"status": [{"level": level, "name": "laser\0"}]}, DiagnosticArray, "x").status
    assert (read.level, read.name) == (2, "laser\N{REPLACEMENT CHARACTER}")


def test_feedback_says_what_is_left_by_either_name():
    assert convert({"distance_to_goal": 3.5, "speed": 1.0}, NavigationFeedback, "x").distance_remaining == 3.5


def test_a_service_that_failed_says_a_text():
    came = decode_frame('{"op":"service_response","id":"call:1","values":"no such service","result":false}')
    assert came == ServiceResponse("call:1", "no such service", False)


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        (
            '{"op":"publish","topic":"/r1/odom","msg":' + "[" * 500 + "}",
            "/r1/odom cannot be used: it is nested",
        ),
        ('{"op":"publish","topic":"/r1/odom","msg":{"x":NaN}}', "/r1/odom cannot be used"),
        ('{"op":"publish","topic":"/r1/odom","msg":7}', "Expected `object`, got `int`"),
        ('{"op":"launch"}', "Invalid value 'launch'"),
        ('{"op":"publish","topic":"/r1/scan","msg":[' + "0," * 300_000 + "0]}", "more than 200000 values"),
        ('{"op":"publish","topic":"/r1/scan","msg":"' + " " * LARGEST_DECODED + '"}', "/r1/scan has 41943"),
        (b"\x81" * 40 + b"\0", "nesting depth (32)"),
        (b"\x9b\xff\xff\xff\xff\xff\xff\xff\xff", "premature end"),
        (b"\x9f\x00\xff", "indefinite"),
        (b"\xa2\x61a\x00\x61a\x01", "uplicate"),
        (b"\xa1\x80\x00", "no CBOR"),
        (cbor2.dumps(published({"x": cbor2.CBORTag(35, "(a+)+$")})), "tag that is no array of numbers"),
        (cbor2.dumps(published({"x": 2**70})), "tag that is no array of numbers"),
        (b"\xd8\x1c\x81\xd8\x1d\x00", "tag that is no array of numbers"),
        (cbor2.dumps(published({"x": cbor2.CBORTag(86, b"123")})), "multiple of element size"),
        (cbor2.dumps(published({"x": cbor2.CBORTag(4000, b"")})), "tag 4000 is no array of numbers"),
        (b"\xff", "no CBOR"),
        (b"", "no CBOR"),
    ],
)
def test_what_cannot_be_used_is_named(frame, words):
    with pytest.raises(FaultError) as caught:
        decode_frame(frame)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("message", "wanted", "words"),
    [
        (ODOMETRY | {"pose": {"pose": POSE, "covariance": [0.0]}}, Odometry, "length >= 36"),
        (ODOMETRY | {"pose": None}, Odometry, "Expected `object`, got `null`"),
        (ODOMETRY | {"header": {"frame_id": "m" * 5000}}, Odometry, "length <= 4096"),
        ({"uuid": "AA=="}, GoalId, "uuid has 1 bytes, and 16 are right"),
        ({"uuid": "no base64"}, GoalId, "no base64"),
        ({"uuid": [300] * 16}, GoalId, "range(0, 256)"),
        ({"uuid": {}}, GoalId, "are no bytes"),
        ({"status": [{"level": "", "name": "x"}] * 10_001}, DiagnosticArray, "length <= 10000"),
        ({"transforms": [TRANSFORM] * 10_001}, TFMessage, "length <= 10000"),
        ({"status_list": [STATUS] * 10_001}, GoalStatusArray, "length <= 10000"),
        ({"missed_waypoints": [0] * 10_001}, NavigationResult, "length <= 10000"),
        ({"topics": ["/a"] * 200_001, "types": []}, TopicsReply, "length <= 200000"),
        ({"topics": ["/" + "a" * 1000], "types": []}, TopicsReply, "length <= 1000"),
        ({"percentage": "full"}, BatteryState, "got `str`"),
    ],
)
def test_a_message_of_another_form_is_named(message, wanted, words):
    with pytest.raises(FaultError) as caught:
        convert(message, wanted, "/r1/odom")
    assert words in str(caught.value) and "/r1/odom" in str(caught.value)
