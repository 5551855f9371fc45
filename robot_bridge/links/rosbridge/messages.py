"""ROS messages as encoded by rosbridge, each with the fields read here; NaN is sent as null.

ROS has no null, so a null number was NaN or infinite. Arrays of bytes are base64.
"""

from __future__ import annotations

import base64
import binascii
import math
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta

from ..ros import messages

NOTHING = math.nan
Number = float | None
Text = Annotated[str, Meta(max_length=4096)]
Covariance6 = Annotated[list[Number], Meta(min_length=36, max_length=36)]
Covariance3 = Annotated[list[Number], Meta(min_length=9, max_length=9)]
MOST_STATUSES = 10_000
MOST_TRANSFORMS = 10_000
MOST_NAMES = 200_000


class _Message(msgspec.Struct):
    """A message whose numbers are floats and whose texts can be stored."""

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            value = getattr(self, name)
            if value is None:
                setattr(self, name, NOTHING)
            elif isinstance(value, str) and "\0" in value:
                setattr(self, name, value.replace("\0", "\N{REPLACEMENT CHARACTER}"))
            elif isinstance(value, list) and None in value:
                setattr(self, name, [NOTHING if one is None else one for one in value])


class Time(msgspec.Struct):
    """Seconds and nanoseconds since 1970."""

    sec: int = 0
    nanosec: int = 0


class HeaderMessage(_Message):
    """Time and frame."""

    stamp: Time = msgspec.field(default_factory=Time)
    frame_id: Text = ""


class Vector(_Message):
    """A point or a vector."""

    x: Number
    y: Number
    z: Number = 0.0


class Quaternion(_Message):
    """A rotation."""

    x: Number
    y: Number
    z: Number
    w: Number


class Pose(msgspec.Struct):
    """A place and a rotation."""

    position: Vector
    orientation: Quaternion


class PoseWithCovariance(_Message):
    """A pose with its covariance."""

    pose: Pose
    covariance: Covariance6


class Twist(msgspec.Struct):
    """A speed."""

    linear: Vector


class TwistWithCovariance(msgspec.Struct):
    """A speed; its covariance is not read."""

    twist: Twist


class Odometry(msgspec.Struct):
    """nav_msgs/Odometry."""

    header: HeaderMessage
    pose: PoseWithCovariance
    twist: TwistWithCovariance


class PoseStamped(msgspec.Struct):
    """geometry_msgs/PoseStamped."""

    header: HeaderMessage
    pose: Pose


class PoseWithCovarianceStamped(msgspec.Struct):
    """geometry_msgs/PoseWithCovarianceStamped."""

    header: HeaderMessage
    pose: PoseWithCovariance


class NavSatStatus(msgspec.Struct):
    """Whether a receiver has a fix."""

    status: int


class NavSatFix(_Message):
    """sensor_msgs/NavSatFix."""

    header: HeaderMessage
    status: NavSatStatus
    latitude: Number
    longitude: Number
    altitude: Number
    position_covariance: Covariance3
    position_covariance_type: int


class Imu(_Message):
    """sensor_msgs/Imu."""

    orientation: Quaternion
    orientation_covariance: Covariance3


class BatteryState(_Message):
    """sensor_msgs/BatteryState."""

    percentage: Number


class DiagnosticStatus(_Message):
    """diagnostic_msgs/DiagnosticStatus; its level is a byte, which some servers write as base64."""

    level: Any
    name: Text
    message: Text = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.level = _bytes_of(self.level)[0] if not isinstance(self.level, int) else self.level


class DiagnosticArray(msgspec.Struct):
    """diagnostic_msgs/DiagnosticArray."""

    status: Annotated[list[DiagnosticStatus], Meta(max_length=MOST_STATUSES)]


class TransformMessage(msgspec.Struct):
    """The pose of a frame in its parent."""

    translation: Vector
    rotation: Quaternion


class TransformStamped(_Message):
    """geometry_msgs/TransformStamped."""

    header: HeaderMessage
    child_frame_id: Text
    transform: TransformMessage


class TFMessage(msgspec.Struct):
    """tf2_msgs/TFMessage."""

    transforms: Annotated[list[TransformStamped], Meta(max_length=MOST_TRANSFORMS)]


class GoalId(msgspec.Struct):
    """unique_identifier_msgs/UUID as 16 bytes."""

    uuid: Any

    def __post_init__(self) -> None:
        self.uuid = _bytes_of(self.uuid)
        if len(self.uuid) != 16:
            raise ValueError(f"uuid has {len(self.uuid)} bytes, and 16 are right")


class GoalInfo(msgspec.Struct):
    """action_msgs/GoalInfo."""

    goal_id: GoalId


class GoalStatusMessage(msgspec.Struct):
    """action_msgs/GoalStatus."""

    goal_info: GoalInfo
    status: int


class GoalStatusArray(msgspec.Struct):
    """action_msgs/GoalStatusArray."""

    status_list: Annotated[list[GoalStatusMessage], Meta(max_length=MOST_STATUSES)]


class CancelReply(msgspec.Struct):
    """action_msgs/CancelGoal's response."""

    return_code: int


class TriggerReply(_Message):
    """std_srvs/Trigger's response."""

    success: bool
    message: Text = ""


class NavigationResult(_Message):
    """The result of one of Nav2's actions; empty from older versions."""

    error_code: int = 0
    error_msg: Text = ""
    missed_waypoints: Annotated[list[Any], Meta(max_length=MOST_STATUSES)] = msgspec.field(
        default_factory=list
    )
    """Their numbers; newer ones write a nav2_msgs/WaypointStatus, or a MissedWaypoint, of each."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.missed_waypoints = [_waypoint_number(one) for one in self.missed_waypoints]


class NavigationFeedback(msgspec.Struct):
    """The feedback of one of Nav2's actions; None for fields that an action lacks."""

    distance_remaining: Number = None
    distance_to_goal: Number = None
    number_of_recoveries: int = 0
    current_waypoint: int | None = None

    def __post_init__(self) -> None:
        if self.distance_remaining is None:
            self.distance_remaining = self.distance_to_goal


class ImageMessage(msgspec.Struct):
    """sensor_msgs/Image."""

    header: HeaderMessage
    height: int
    width: int
    encoding: Text
    step: int
    data: bytes

    def __post_init__(self) -> None:
        self.data = np.frombuffer(self.data, dtype=np.uint8)  # type: ignore[assignment]


class CompressedImage(msgspec.Struct):
    """sensor_msgs/CompressedImage."""

    header: HeaderMessage
    format: Text
    data: bytes


Names = Annotated[list[Annotated[str, Meta(max_length=1000)]], Meta(max_length=MOST_NAMES)]


class TopicsReply(msgspec.Struct):
    """rosapi's topics."""

    topics: Names
    types: Names


class ServicesReply(msgspec.Struct):
    """rosapi's services."""

    services: Names


class ActionServersReply(msgspec.Struct):
    """rosapi's action_servers."""

    action_servers: Names


class SubscribersReply(msgspec.Struct):
    """rosapi's subscribers of a topic: names of nodes."""

    subscribers: Names


class PublishersReply(msgspec.Struct):
    """rosapi's publishers of a topic: names of nodes."""

    publishers: Names


READABLE: dict[str, type[msgspec.Struct]] = {
    messages.ODOMETRY: Odometry,
    messages.POSE: PoseStamped,
    messages.POSE_WITH_COVARIANCE: PoseWithCovarianceStamped,
    messages.FIX: NavSatFix,
    messages.TF: TFMessage,
    messages.IMU: Imu,
    messages.BATTERY: BatteryState,
    messages.DIAGNOSTICS: DiagnosticArray,
    messages.GOAL_STATUSES: GoalStatusArray,
    messages.IMAGE: ImageMessage,
    messages.COMPRESSED_IMAGE: CompressedImage,
}
"""The class that decodes each message type."""


def _bytes_of(value: Any) -> bytes:
    """Return an array of bytes from base64, bytes or numbers; raises ValueError."""
    if isinstance(value, str) and len(value) <= 64:
        try:
            return base64.b64decode(value, validate=True) or b"\0"
        except binascii.Error as error:
            raise ValueError(f"{value[:40]!r} is no base64: {error}") from None
    if isinstance(value, (bytes, list)) and 0 < len(value) <= 64:
        return bytes(value)
    raise ValueError(f"{str(value)[:40]!r} are no bytes")


def _waypoint_number(missed: Any) -> int:
    """Return the number of a missed waypoint; raises ValueError."""
    number = missed.get("waypoint_index", missed.get("index")) if isinstance(missed, dict) else missed
    if not isinstance(number, int):
        raise ValueError(f"{str(missed)[:40]!r} is no waypoint")
    return number
