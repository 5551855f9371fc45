"""Types by distribution, and the codec of their messages."""

from __future__ import annotations

import struct

import numpy as np
import pytest

pytest.importorskip("rosbags", reason="rosbags is not installed; run make setup")

from robot_bridge.links.ros.errors import FaultError, RosError
from robot_bridge.links.ros.goals import feedback_text, missed_of
from robot_bridge.links.ros.settings import DISTRIBUTIONS
from robot_bridge.links.ros2 import interfaces
from robot_bridge.links.ros2.interfaces import LARGEST_MESSAGE, Interfaces

GOAL = "nav2_msgs/action/NavigateToPose_SendGoal_Request"


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_every_distribution_has_what_the_adapter_speaks(distribution):
    types = Interfaces(distribution)
    for action in ("NavigateToPose", "NavigateThroughPoses", "FollowPath", "FollowWaypoints"):
        for part in (
            "SendGoal_Request",
            "SendGoal_Response",
            "GetResult_Request",
            "GetResult_Response",
            "FeedbackMessage",
        ):
            name = f"nav2_msgs/action/{action}_{part}"
            assert types.decode(name, types.encode(name, types.make(name))) is not None


@pytest.mark.parametrize(
    ("distribution", "message", "only"),
    [
        ("humble", "FollowWaypoints_SendGoal_Request", ["poses"]),
        ("jazzy", "FollowWaypoints_SendGoal_Request", ["number_of_loops", "goal_index", "poses"]),
        ("humble", "NavigateToPose_GetResult_Response", ["result"]),
        ("jazzy", "NavigateToPose_GetResult_Response", ["error_code", "error_msg"]),
        ("jazzy", "FollowPath_GetResult_Response", ["result", "error_code", "error_msg"]),
        ("foxy", "FollowPath_SendGoal_Request", ["path", "controller_id"]),
        (
            "lyrical",
            "FollowPath_SendGoal_Request",
            ["path", "controller_id", "goal_checker_id", "progress_checker_id", "path_handler_id"],
        ),
        ("kilted", "FollowPath_FeedbackMessage", ["distance_to_goal", "speed"]),
        ("lyrical", "FollowPath_FeedbackMessage", ["tracking_feedback"]),
    ],
)
def test_actions_have_the_fields_of_their_distribution(distribution, message, only):
    types = Interfaces(distribution)
    made = types.make(f"nav2_msgs/action/{message}")
    fields = [name for name in made.__dataclass_fields__ if name not in ("goal_id", "status", "__msgtype__")]
    assert fields == only


@pytest.mark.parametrize(("distribution", "element"), [("humble", None), ("jazzy", "index")])
def test_missed_waypoints_are_read_in_each_distribution(distribution, element):
    types = Interfaces(distribution)
    name = "nav2_msgs/action/FollowWaypoints_GetResult_Response"
    missed = np.array([2, 5], dtype=np.int32)
    if element is not None:
        missed = [types.make("nav2_msgs/msg/MissedWaypoint", index=number) for number in (2, 5)]
    result = types.decode(name, types.encode(name, types.make(name, missed_waypoints=missed)))
    assert missed_of(result) == [2, 5]


def test_a_sequence_beyond_the_limit_is_refused(monkeypatch):
    monkeypatch.setattr(interfaces, "LONGEST_SEQUENCE", 10)
    types, name = Interfaces("kilted"), "sensor_msgs/msg/LaserScan"
    scans = [
        types.encode(name, types.make(name, ranges=np.zeros(count, dtype=np.float32))) for count in (10, 11)
    ]
    assert len(types.decode(name, scans[0]).ranges) == 10
    with pytest.raises(FaultError, match="LaserScan"):
        types.decode(name, scans[1])


def test_the_feedback_of_the_newest_distribution_says_how_far_it_is():
    types = Interfaces("lyrical")
    tracking = types.make("nav2_msgs/msg/TrackingFeedback", distance_to_goal=4.0)
    made = types.make("nav2_msgs/action/FollowPath_FeedbackMessage", tracking_feedback=tracking)
    assert feedback_text(made) == "navigating: 4.0 m left"


@pytest.mark.parametrize(
    ("action", "of", "distributions"),
    [
        ("FollowPath", "kilted", ["jazzy", "kilted"]),
        ("FollowPath", "lyrical", ["lyrical"]),
        ("FollowWaypoints", "humble", ["foxy", "humble"]),
        ("NavigateThroughPoses", "kilted", ["kilted", "lyrical"]),
        ("NavigateToPose", "jazzy", list(DISTRIBUTIONS)),
    ],
)
def test_goals_are_known_by_the_hash_of_their_type(jazzy, action, of, distributions):
    assert jazzy.distributions_of(action, Interfaces(of).goal_hash(action)) == distributions


def test_a_distribution_that_nobody_knows_is_named():
    with pytest.raises(RosError, match=r"distribution 'melodic' is not known; give one of foxy, humble"):
        Interfaces("melodic")


@pytest.fixture(scope="module")
def jazzy():
    return Interfaces("jazzy")


def test_a_message_of_another_type_is_refused(jazzy):
    odometry = jazzy.encode("nav_msgs/msg/Odometry", jazzy.make("nav_msgs/msg/Odometry"))
    with pytest.raises(FaultError, match="it is no sensor_msgs/msg/BatteryState of jazzy"):
        jazzy.decode("sensor_msgs/msg/BatteryState", odometry)


@pytest.mark.parametrize("data", [b"", b"\0\1\0", b"\0\1\0\0", b"\xff" * 64, b"\0\1\0\0" + b"\xff" * 64])
def test_bytes_that_are_no_message_are_refused(jazzy, data):
    with pytest.raises(FaultError):
        jazzy.decode("nav_msgs/msg/Odometry", data)


def test_a_sequence_that_claims_more_than_there_is_takes_no_memory(jazzy):
    claims = b"\0\1\0\0" + struct.pack("<I", 2**32 - 1) + bytes(64)
    with pytest.raises(FaultError):
        jazzy.decode("tf2_msgs/msg/TFMessage", claims)


def test_a_message_that_is_too_large_is_not_decoded(jazzy):
    with pytest.raises(FaultError, match="are the most"):
        jazzy.decode("nav_msgs/msg/Odometry", bytes(LARGEST_MESSAGE + 1))


def test_padding_behind_a_message_is_taken(jazzy):
    text = jazzy.make("std_msgs/msg/String", data="ab")
    data = jazzy.encode("std_msgs/msg/String", text) + bytes(1)
    assert jazzy.decode("std_msgs/msg/String", data).data == "ab"
