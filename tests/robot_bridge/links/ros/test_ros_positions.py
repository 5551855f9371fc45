"""What ROS messages say of where robots are and how they do."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("rosbags", reason="rosbags is not installed; run make setup")

from robot_bridge.links.ros import sensing
from robot_bridge.links.ros.errors import FaultError
from robot_bridge.links.ros.goals import MOST_GOALS, GoalStatus, missed_text, statuses_of
from robot_bridge.links.ros.sensing import DEEPEST, MOST_FRAMES, FramePose, Transforms
from robot_bridge.links.ros2.interfaces import Interfaces

TYPES = Interfaces("jazzy")


def turned(theta):
    return TYPES.make("geometry_msgs/msg/Quaternion", z=math.sin(theta / 2), w=math.cos(theta / 2))


def odometry(x=3.0, y=4.0, theta=0.5, v=1.0, frame="map"):
    told = TYPES.make("nav_msgs/msg/Odometry")
    told.header.frame_id, told.header.stamp.sec = frame, 100
    told.pose.pose.position.x, told.pose.pose.position.y = x, y
    told.pose.pose.orientation = turned(theta)
    told.twist.twist.linear.x = v
    told.pose.covariance[0], told.pose.covariance[7] = 0.04, 0.01
    return told


def test_odometry_is_a_pose_with_speed_and_accuracy():
    pose = sensing.odometry(odometry(v=-1.5), "/r1/odom")
    assert (pose.frame, pose.x, pose.y, pose.t, pose.v) == ("map", 3.0, 4.0, 100.0, -1.5)
    assert pose.theta == pytest.approx(0.5) and pose.accuracy == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"x": math.nan}, r"/r1/odom \(nav_msgs/Odometry\): position.x is nan"),
        ({"y": math.inf}, "position.y is inf"),
        ({"x": 1e300}, "position.x is 1e\\+300"),
        ({"v": math.nan}, "twist.linear.x is nan"),
    ],
)
def test_a_pose_that_is_none_names_topic_field_and_value(change, words):
    with pytest.raises(FaultError, match=words):
        sensing.odometry(odometry(**change), "/r1/odom")


def test_an_orientation_that_is_no_rotation_is_named():
    told = odometry()
    told.pose.pose.orientation = TYPES.make("geometry_msgs/msg/Quaternion")
    with pytest.raises(FaultError, match="is no rotation"):
        sensing.odometry(told, "/r1/odom")


def gps(status=0):
    told = TYPES.make("sensor_msgs/msg/NavSatFix", latitude=46.88, longitude=16.84, altitude=math.nan)
    told.status.status, told.position_covariance_type = status, 2
    told.position_covariance[0] = told.position_covariance[4] = 0.25
    return told


def test_a_fix_comes_with_the_heading_of_the_imu():
    imu = TYPES.make("sensor_msgs/msg/Imu", orientation=turned(math.pi))
    heading = sensing.imu_heading(imu, "/r1/imu")
    said = sensing.gps_fix(gps(), "/r1/fix", heading)
    assert said.heading == pytest.approx(270.0)
    assert (said.lat, said.lon, said.accuracy, said.altitude) == (46.88, 16.84, 0.5, None)


def test_an_imu_without_orientation_tells_no_heading():
    imu = TYPES.make("sensor_msgs/msg/Imu")
    imu.orientation_covariance[0] = -1.0
    assert sensing.imu_heading(imu, "/r1/imu") is None


def test_a_receiver_without_a_fix_is_named():
    with pytest.raises(FaultError, match="the receiver has no fix"):
        sensing.gps_fix(gps(status=-1), "/r1/fix", None)


@pytest.mark.parametrize(("said", "share"), [(0.75, 0.75), (75.0, 0.75), (math.nan, None), (-1.0, None)])
def test_a_battery_is_from_0_to_1(said, share):
    assert sensing.battery_share(TYPES.make("sensor_msgs/msg/BatteryState", percentage=said)) == share


def test_the_worst_diagnosis_is_the_status():
    def state(level, name, message):
        return TYPES.make("diagnostic_msgs/msg/DiagnosticStatus", level=level, name=name, message=message)

    told = TYPES.make("diagnostic_msgs/msg/DiagnosticArray")
    told.status = [state(0, "lidar", "fine"), state(2, "motor", "hot"), state(1, "wifi", "weak")]
    assert sensing.diagnosis(told) == "error: motor: hot"
    told.status = told.status[:1]
    assert sensing.diagnosis(told) is None


def test_another_clock_is_said():
    assert sensing.clock_remark(1000.0, 1003.0) is None
    assert sensing.clock_remark(None, 1003.0) is None
    assert "86400 s behind" in sensing.clock_remark(1.79e9, 1.79e9 + 86400)
    assert "simulated time" in sensing.clock_remark(12.5, 1.79e9)


def transform(parent, child, x=0.0, y=0.0, theta=0.0):
    one = TYPES.make("geometry_msgs/msg/TransformStamped", child_frame_id=child)
    one.header.frame_id = parent
    one.transform.translation.x, one.transform.translation.y = x, y
    one.transform.rotation = turned(theta)
    return TYPES.make("tf2_msgs/msg/TFMessage", transforms=[one])


def test_a_pose_in_odom_is_taken_to_the_map():
    tree = Transforms()
    tree.update(transform("map", "odom", 10.0, 0.0, math.pi / 2), "/tf")
    pose = tree.pose_in("map", sensing.odometry(odometry(frame="odom"), "/r1/odom"))
    assert (pose.x, pose.y, pose.theta) == pytest.approx((6.0, 3.0, 0.5 + math.pi / 2))


def test_the_robot_may_say_where_it_is_by_tf_alone():
    tree = Transforms()
    tree.update(transform("odom", "base_link", 1.0), "/tf")
    assert tree.pose_of("base_link", "map") is None
    tree.update(transform("map", "odom", 10.0), "/tf")
    assert tree.pose_of("base_link", "map").x == pytest.approx(11.0)


def test_a_frame_that_nobody_explains_is_named():
    with pytest.raises(
        FaultError, match="frame 'odom' is not connected with 'map': nothing is known of 'odom'"
    ):
        Transforms().pose_in("map", sensing.odometry(odometry(frame="odom"), "/r1/odom"))


def test_transforms_in_a_circle_are_named():
    tree = Transforms()
    tree.update(transform("a", "b"), "/tf")
    tree.update(transform("b", "a"), "/tf")
    with pytest.raises(FaultError, match="run in a circle"):
        tree.pose_in("map", sensing.odometry(odometry(frame="a"), "/r1/odom"))


def test_a_transform_that_is_no_place_changes_nothing():
    tree = Transforms()
    with pytest.raises(FaultError, match="is no place"):
        tree.update(transform("map", "odom", np.nan), "/tf")
    assert tree.pose_of("odom", "map") is None


def chain(length):
    """A message in which each frame is 1 m before the one that it is in: f0 is in map."""
    told = TYPES.make("tf2_msgs/msg/TFMessage")
    for number in range(length):
        one = TYPES.make("geometry_msgs/msg/TransformStamped")
        one.header.frame_id = f"f{number - 1}" if number else "map"
        one.child_frame_id = f"f{number}"
        one.transform.translation.x, one.transform.rotation = 1.0, turned(0.0)
        told.transforms.append(one)
    return told


def test_frames_without_end_are_not_remembered():
    transforms = Transforms()
    with pytest.raises(FaultError, match=f"more than {MOST_FRAMES} frames"):
        transforms.update(chain(MOST_FRAMES + 1), "/r1/tf")
    assert len(transforms._of) == MOST_FRAMES
    # Those that are known go on.
    assert transforms.update(chain(1), "/r1/tf")


def test_a_chain_of_frames_is_followed_so_far_and_no_further():
    transforms = Transforms()
    transforms.update(chain(DEEPEST), "/r1/tf")
    assert transforms.pose_in("map", FramePose(f"f{DEEPEST - 2}", 0.0, 0.0, 0.0, None)).x == DEEPEST - 1
    with pytest.raises(FaultError, match="is not connected with 'map'"):
        transforms.pose_in("map", FramePose(f"f{DEEPEST - 1}", 0.0, 0.0, 0.0, None))


def test_of_many_goals_the_newest_are_looked_at():
    one = TYPES.make("action_msgs/msg/GoalStatus", status=2)
    told = TYPES.make("action_msgs/msg/GoalStatusArray", status_list=[])
    for number in range(MOST_GOALS + 1):
        uuid = np.frombuffer(number.to_bytes(16, "big"), dtype=np.uint8)
        id = TYPES.make("unique_identifier_msgs/msg/UUID", uuid=uuid)
        info = TYPES.make("action_msgs/msg/GoalInfo", goal_id=id)
        told.status_list.append(TYPES.make("action_msgs/msg/GoalStatus", goal_info=info, status=one.status))
    read = statuses_of(told)
    assert len(read) == MOST_GOALS and bytes(16) not in read
    assert read[MOST_GOALS.to_bytes(16, "big")] is GoalStatus.EXECUTING


def test_of_many_missed_points_the_first_are_named():
    assert (
        missed_text(range(12))
        == "the robot left out points of the path: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 2 more"
    )
