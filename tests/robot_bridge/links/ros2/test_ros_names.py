"""Names of ROS 2 in DDS, and patterns that find robots."""

from __future__ import annotations

import pytest

from robot_bridge.links.ros.errors import RosNameError
from robot_bridge.links.ros.settings import TopicPattern
from robot_bridge.links.ros2.interfaces import (
    action_names,
    server_from_dds,
    service_names,
    topic_from_dds,
    topic_to_dds,
    type_from_dds,
    type_to_dds,
)


def test_topics_and_types_go_there_and_back():
    assert topic_to_dds("/r1/odom") == "rt/r1/odom"
    assert topic_from_dds("rt/r1/odom") == "/r1/odom"
    assert type_to_dds("nav_msgs/msg/Odometry") == "nav_msgs::msg::dds_::Odometry_"
    assert type_from_dds("nav_msgs::msg::dds_::Odometry_") == "nav_msgs/msg/Odometry"


@pytest.mark.parametrize("name", ["rq/r1/stopRequest", "ros_discovery_info", "rt/", "rt/r1//odom", "rt/ü"])
def test_what_is_no_topic_of_ros_is_passed_over(name):
    assert topic_from_dds(name) is None


@pytest.mark.parametrize("name", ["odom", "/r1/2nd", "/r1/", "/" + "a" * 300, "/r1/ä", "/r1/{x}"])
def test_a_name_that_ros_does_not_allow_is_refused(name):
    with pytest.raises(RosNameError, match="write it as '/r1/odom'"):
        topic_to_dds(name)


def test_services_and_actions_have_the_topics_that_rmw_gives_them():
    stop = service_names("/r1/stop", "std_srvs/srv/Trigger")
    assert (stop.request, stop.reply) == ("rq/r1/stopRequest", "rr/r1/stopReply")
    assert stop.reply_type == "std_srvs::srv::dds_::Trigger_Response_"
    action = action_names("/r1/navigate_to_pose", "nav2_msgs/action/NavigateToPose")
    assert action.send_goal.request == "rq/r1/navigate_to_pose/_action/send_goalRequest"
    assert action.send_goal.request_type == "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_"
    assert action.status == "rt/r1/navigate_to_pose/_action/status"


def test_a_pattern_finds_robots_and_names_their_topics():
    pattern = TopicPattern("/{robot}/odom")
    assert pattern.robot_of("/r1/odom") == "r1"
    assert pattern.robot_of("/r1/base/odom") is None
    assert pattern.robot_of("/_hidden/odom") is None
    assert pattern.topic_of("r1") == "/r1/odom"
    shared = TopicPattern("/map")
    assert shared.is_shared and shared.robot_of("/map") is None and shared.topic_of("r1") == "/map"


@pytest.mark.parametrize("pattern", ["/{robot}/{robot}", "/{name}/odom", "{robot}/odom"])
def test_a_pattern_that_can_be_no_topic_is_refused(pattern):
    with pytest.raises(RosNameError):
        TopicPattern(pattern)


def test_a_robot_whose_name_cannot_stand_in_a_topic_is_refused():
    with pytest.raises(RosNameError, match="'/agv-1/odom'"):
        TopicPattern("/{robot}/odom").topic_of("agv-1")


@pytest.mark.parametrize(
    ("topic", "server"),
    [
        ("rq/r1/stopRequest", "/r1/stop"),
        ("rq/r1/navigate_to_pose/_action/send_goalRequest", "/r1/navigate_to_pose"),
        ("rq/r1/navigate_to_pose/_action/get_resultRequest", "/r1/navigate_to_pose/_action/get_result"),
        ("rr/r1/stopReply", None),
        ("rt/r1/odom", None),
    ],
)
def test_a_server_is_known_by_the_topic_of_its_requests(topic, server):
    assert server_from_dds(topic) == server
