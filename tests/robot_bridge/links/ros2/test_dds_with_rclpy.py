"""Bytes over DDS to and from real rclpy nodes, which are on another DDS: Fast DDS."""

from __future__ import annotations

import resource
import time
from pathlib import Path

import numpy as np
import pytest

from robot_bridge.links.ros import sensing
from robot_bridge.links.ros.errors import FaultError, RosError
from robot_bridge.links.ros.goals import GoalStatus, goal_id, statuses_of
from robot_bridge.links.ros.messages import GET_MAP
from robot_bridge.links.ros2.dds import DdsSettings, Participant, Quality, quality_for
from robot_bridge.links.ros2.interfaces import (
    Interfaces,
    action_names,
    service_names,
    topic_to_dds,
    type_to_dds,
)
from robot_bridge.links.ros2.services import ServiceClient, ServiceServer

NAVIGATE = "nav2_msgs/action/NavigateToPose"
PATIENCE = 40.0


@pytest.fixture(scope="module")
def types(nodes):
    return Interfaces(nodes.distribution)


@pytest.fixture(scope="module")
def here(nodes):
    nodes.start("r1", "--speed", "20")
    return Participant(DdsSettings(nodes.domain, "localhost"))


def until(here, found):
    """Return the first of ``found()`` that is something, while others are discovered."""
    give_up = time.monotonic() + PATIENCE
    while time.monotonic() < give_up:
        here.discover()
        if result := found():
            return result
        time.sleep(0.01)
    raise AssertionError("it did not come")


def never(error):
    raise error


def offered(here, topic):
    return [one for one in here.endpoints if one.topic == topic]


def test_a_topic_is_found_with_its_type_and_what_it_offers(here):
    (odometry,) = until(here, lambda: offered(here, "rt/r1/odom"))
    assert odometry.type_name == "nav_msgs::msg::dds_::Odometry_"
    assert not odometry.wants and not odometry.reliable and not odometry.latched
    assert quality_for([odometry]) == Quality(reliable=False, latched=False)


@pytest.mark.parametrize("action", ["NavigateToPose", "FollowPath"])
def test_goals_have_the_hash_that_their_server_tells(here, types, action):
    topic = {"NavigateToPose": "navigate_to_pose", "FollowPath": "follow_path"}[action]
    names = action_names(f"/r1/{topic}", f"nav2_msgs/action/{action}")
    (server,) = until(here, lambda: offered(here, names.send_goal.request))
    assert server.type_hash == types.goal_hash(action)


def test_odometry_is_read_as_best_effort(here, types):
    odometry = until(here, lambda: offered(here, "rt/r1/odom"))
    reader = here.reader("rt/r1/odom", odometry[0].type_name, quality_for(odometry))
    message = types.decode("nav_msgs/msg/Odometry", until(here, reader.read_samples)[-1])
    pose = sensing.odometry(message, "/r1/odom")
    assert (pose.frame, pose.x, pose.y) == ("map", 20.0, 8.0)


def test_another_type_under_a_topics_name_is_not_heard(here):
    reader = here.reader("rt/r1/odom", type_to_dds("sensor_msgs/msg/BatteryState"), Quality(reliable=False))
    assert reader.read_samples() == [] and reader.matched == 0


def test_who_joins_late_is_told_what_is_latched(here, types, nodes):
    writer = here.writer(
        "rt/r2/map", type_to_dds("nav_msgs/msg/OccupancyGrid"), Quality(latched=True, depth=1)
    )
    grid = types.make("nav_msgs/msg/OccupancyGrid", data=np.zeros(6, dtype=np.int8))
    grid.info.width, grid.info.height, grid.header.frame_id = 3, 2, "map"
    assert writer.write(types.encode("nav_msgs/msg/OccupancyGrid", grid))
    nodes.start("r2")
    (told,) = until(here, lambda: [one for one in nodes.events("r2") if one["event"] == "map"])
    assert (told["columns"], told["rows"], told["frame"]) == (3, 2, "map")
    nodes.end("r2")


def test_who_leaves_is_forgotten(here, nodes):
    nodes.start("r3", short_lease=True)
    until(here, lambda: offered(here, "rt/r3/odom"))
    nodes.end("r3")
    until(here, lambda: not offered(here, "rt/r3/odom"))


class Client:
    """A client of one service."""

    def __init__(self, here, names):
        self.out = here.writer(names.request, names.request_type, Quality())
        self.back = here.reader(names.reply, names.reply_type, Quality())
        until(here, lambda: self.out.matched and self.back.matched)


def test_a_goal_is_accepted_driven_and_canceled(here, types, nodes):
    names = action_names("/r1/navigate_to_pose", NAVIGATE)
    status = here.reader(names.status, names.status_type, Quality(latched=True))
    send, cancel = Client(here, names.send_goal), Client(here, names.cancel_goal)

    def goal(number, x):
        id = types.make(
            "unique_identifier_msgs/msg/UUID", uuid=np.frombuffer(goal_id(number), dtype=np.uint8)
        )
        asked = types.make(f"{NAVIGATE}_SendGoal_Request", goal_id=id)
        asked.pose.header.frame_id, asked.pose.pose.position.x = "map", x
        asked.pose.pose.orientation.w = 1.0
        send.out.write(types.encode(f"{NAVIGATE}_SendGoal_Request", asked))

    def reached(number, wanted):
        for data in status.read_samples():
            known = statuses_of(types.decode("action_msgs/msg/GoalStatusArray", data))
            if known.get(goal_id(number)) is wanted:
                return True
        return False

    goal(7, 24.0)
    reply = until(here, send.back.read_samples)[0]
    assert types.decode(f"{NAVIGATE}_SendGoal_Response", reply).accepted
    until(here, lambda: reached(7, GoalStatus.SUCCEEDED))
    goal(8, 50_000.0)
    until(here, lambda: reached(8, GoalStatus.EXECUTING))
    everything = types.make("action_msgs/srv/CancelGoal_Request")
    cancel.out.write(types.encode("action_msgs/srv/CancelGoal_Request", everything))
    answer = types.decode("action_msgs/srv/CancelGoal_Response", until(here, cancel.back.read_samples)[0])
    assert answer.return_code == 0
    until(here, lambda: reached(8, GoalStatus.CANCELED))


def test_a_result_of_another_distribution_is_named(types):
    newer = types.encode(f"{NAVIGATE}_GetResult_Response", types.make(f"{NAVIGATE}_GetResult_Response"))
    with pytest.raises(FaultError, match="set distribution to the robot's"):
        Interfaces("humble").decode(f"{NAVIGATE}_GetResult_Response", newer)


@pytest.fixture
def grid(types):
    """A map of 3 × 2 cells."""
    grid = types.make("nav_msgs/msg/OccupancyGrid", data=np.arange(6, dtype=np.int8))
    grid.info.width, grid.info.height = 3, 2
    return types.encode("nav_msgs/msg/OccupancyGrid", grid)


def test_a_map_is_served_to_nodes_on_cyclone_dds(here, types, grid):
    names = service_names("/cyclone/get_map", GET_MAP)
    server = ServiceServer(here, names)
    server.set_reply(grid)
    client = ServiceClient(here, types, names, GET_MAP, framed=True)
    until(here, lambda: client.is_matched)
    client.call(types.make(f"{GET_MAP}_Request"))
    (reply,) = until(here, lambda: server.answer() or client.replies(never))
    assert (reply.map.info.width, list(reply.map.data)) == (3, [0, 1, 2, 3, 4, 5])


def test_a_node_on_fast_dds_is_not_answered_and_gets_its_map_from_the_guides_node(
    here, grid, nodes, guide, tmp_path
):
    server = ServiceServer(here, service_names("/r4/get_map", GET_MAP))
    server.set_reply(grid)
    nodes.start("r4", "--asks-map")
    # It can be seen that there is nobody to answer.
    until(here, server.answer)

    def answered():
        return [one for one in nodes.events("r4") if one["event"] == "map answered"]

    assert answered() == []
    script = tmp_path / "serve_map.py"
    script.write_text(guide("serve_map", "python"), encoding="utf-8")
    nodes.start_script("maps", script, "r3", "r4")
    writer = here.writer(
        "rt/r4/map", type_to_dds("nav_msgs/msg/OccupancyGrid"), Quality(latched=True, depth=1)
    )
    assert writer.write(grid)
    told = until(here, answered)
    assert (told[0]["columns"], told[0]["cells"]) == (3, [0, 1, 2, 3, 4, 5])
    nodes.end("maps")
    nodes.end("r4")


def test_speed_0_is_heard(here, types, nodes):
    topic = topic_to_dds("/r1/cmd_vel")
    writer = here.writer(topic, type_to_dds("geometry_msgs/msg/Twist"), Quality())
    until(here, lambda: writer.matched)
    writer.write(types.encode("geometry_msgs/msg/Twist", types.make("geometry_msgs/msg/Twist")))
    until(here, lambda: [one for one in nodes.events("r1") if one["event"] == "zero twist"])


def test_hundreds_of_topics_of_one_type_take_little_memory(here):
    def resident():
        return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

    limits, before = resource.getrlimit(resource.RLIMIT_AS), resident()
    resource.setrlimit(resource.RLIMIT_AS, (int(8e9), limits[1]))
    try:
        kept = [here.writer(f"rt/n{n}/x", type_to_dds("std_msgs/msg/Empty"), Quality()) for n in range(400)]
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)
    assert len(kept) == 400 and resident() - before < 50e6


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"domain": 300}, "give ROS_DOMAIN_ID, from 0 to 232"),
        ({"range": "everywhere"}, "localhost, subnet, off"),
    ],
)
def test_settings_that_are_none_are_named(settings, words):
    with pytest.raises(RosError, match=words):
        DdsSettings(**settings)


def test_an_interface_that_is_not_there_is_named():
    pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; run make setup")
    with pytest.raises(RosError, match="are the interfaces there"):
        Participant(DdsSettings(231, "subnet", interfaces=("nowhere9",)))
