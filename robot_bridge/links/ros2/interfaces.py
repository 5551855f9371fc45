"""ROS 2 interfaces on DDS: names of topics and services, message types."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from ..ros.errors import FaultError, RosError, RosNameError
from ..ros.settings import DISTRIBUTIONS, check_topic, distribution_names, is_topic

# --- DDS names of ROS 2 topics, services, actions and types; no I/O ---
# A topic ``/r1/odom`` is ``rt/r1/odom``; a service ``/r1/stop`` is the two topics ``rq/r1/stopRequest`` and
# ``rr/r1/stopReply``; an action is three services and two topics below ``_action``. A type
# ``nav_msgs/msg/Odometry`` is ``nav_msgs::msg::dds_::Odometry_`` (design.ros2.org, topic and service
# names).

_TYPE = re.compile(r"([A-Za-z][A-Za-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)")
_DDS_TYPE = re.compile(r"([A-Za-z][A-Za-z0-9_]*)::(msg|srv|action)::dds_::([A-Za-z][A-Za-z0-9_]*)_")

CYCLONE = (1, 16)
"""The first two bytes of the id of a participant that is Cyclone DDS."""


@dataclass(frozen=True)
class ServiceNames:
    """The two DDS topics of a service, and their DDS types."""

    request: str
    request_type: str
    reply: str
    reply_type: str


@dataclass(frozen=True)
class ActionNames:
    """The DDS topics of an action: three services, two topics."""

    send_goal: ServiceNames
    cancel_goal: ServiceNames
    get_result: ServiceNames
    feedback: str
    feedback_type: str
    status: str
    status_type: str


def topic_to_dds(name: str) -> str:
    """Return the DDS topic of a ROS topic; raises RosNameError."""
    return f"rt{check_topic(name)}"


def topic_from_dds(name: str) -> str | None:
    """Return the ROS topic of a DDS topic, None for others: services, parts of actions, other DDS."""
    ros = name[2:] if name.startswith("rt/") else ""
    return ros if is_topic(ros) else None


def server_from_dds(name: str) -> str | None:
    """Return the ROS service or action whose requests a DDS topic carries, None for others."""
    if not (name.startswith("rq/") and name.endswith("Request")):
        return None
    return name[2 : -len("Request")].removesuffix("/_action/send_goal")


def type_to_dds(name: str) -> str:
    """Return the DDS name of a type such as ``nav_msgs/msg/Odometry``; raises RosNameError."""
    found = _TYPE.fullmatch(name)
    if found is None:
        raise RosNameError(f"{name[:80]!r} is no type; write it as 'nav_msgs/msg/Odometry'")
    return "{}::{}::dds_::{}_".format(*found.groups())


def type_from_dds(name: str) -> str | None:
    """Return the ROS name of a DDS type, None if it is not of ROS 2."""
    found = _DDS_TYPE.fullmatch(name)
    return "/".join(found.groups()) if found else None


def service_names(name: str, type_name: str) -> ServiceNames:
    """Return the DDS names of service ``name`` of a type such as ``std_srvs/srv/Trigger``."""
    check_topic(name)
    return ServiceNames(
        f"rq{name}Request",
        type_to_dds(f"{type_name}_Request"),
        f"rr{name}Reply",
        type_to_dds(f"{type_name}_Response"),
    )


def action_names(name: str, type_name: str) -> ActionNames:
    """Return the DDS names of action ``name`` of a type such as ``nav2_msgs/action/NavigateToPose``."""
    inner = f"{check_topic(name)}/_action"
    return ActionNames(
        service_names(f"{inner}/send_goal", f"{type_name}_SendGoal"),
        service_names(f"{inner}/cancel_goal", "action_msgs/srv/CancelGoal"),
        service_names(f"{inner}/get_result", f"{type_name}_GetResult"),
        f"rt{inner}/feedback",
        type_to_dds(f"{type_name}_FeedbackMessage"),
        f"rt{inner}/status",
        type_to_dds("action_msgs/msg/GoalStatusArray"),
    )


# --- The types of ROS 2 by distribution, and the codec of their messages, with size limits ---
# rosbags knows the messages of each distribution. The services and actions used by the adapter are defined
# here, as in nav2_msgs, action_msgs, std_srvs and nav_msgs.

LARGEST_MESSAGE = 16 << 20
"""bytes of a decoded message: an image is the largest."""
LONGEST_SEQUENCE = 16 << 20
"""elements of a sequence; a laser scan or an image has the most."""

_GOAL_ID = "unique_identifier_msgs/UUID goal_id"
_NAV2_MESSAGES = {
    "CostmapFilterInfo": (
        "std_msgs/Header header\nuint8 type\nstring filter_mask_topic\nfloat32 base\nfloat32 multiplier\n"
    ),
    "MissedWaypoint": "uint32 index\ngeometry_msgs/PoseStamped goal\nuint16 error_code\n",
    "WaypointStatus": (
        "uint8 waypoint_status\nuint32 waypoint_index\ngeometry_msgs/PoseStamped waypoint_pose\n"
        "uint16 error_code\nstring error_msg\n"
    ),
    "TrackingFeedback": (
        "std_msgs/Header header\nfloat32 position_tracking_error\nfloat32 heading_tracking_error\n"
        "uint32 current_path_index\ngeometry_msgs/PoseStamped robot_pose\nfloat32 distance_to_goal\n"
        "float32 speed\nfloat32 remaining_path_length\n"
    ),
}


class Interfaces:
    """Builds, encodes and decodes messages of one distribution.

    :raises RosError: for a distribution with unknown types, or if rosbags is not installed.
    """

    def __init__(self, distribution: str) -> None:
        if distribution not in DISTRIBUTIONS:
            raise RosError(
                f"distribution {distribution[:40]!r} is not known; give one of {distribution_names()}, for "
                "rolling the newest"
            )
        try:
            from rosbags.typesys import Stores, get_types_from_msg, get_typestore
        except ModuleNotFoundError as error:
            raise RosError(
                f"{error.name} is not installed; pip install 'fleet-supervisor-robot-bridge[ros2]'"
            ) from None
        self.distribution = distribution
        self._goal_hashes: dict[str, str] = {}
        self._others: dict[str, Interfaces] = {}
        self._store = get_typestore(Stores(f"ros2_{distribution}"))
        self._store.max_sequence_length = LONGEST_SEQUENCE
        for name, text in _definitions(distribution).items():
            self._store.register(get_types_from_msg(text, name))

    def knows(self, type_name: str) -> bool:
        """Return whether messages of a type can be decoded."""
        return _stored_name(type_name) in self._store.fielddefs

    def make(self, type_name: str, **fields: Any) -> Any:
        """Return a message; omitted fields are zero, empty, or built of such."""
        name = _stored_name(type_name)
        return self._store.types[name](**(self._zeros(name) | fields))

    def encode(self, type_name: str, message: Any) -> bytes:
        """Return the CDR of a message, little-endian, with its encapsulation."""
        return bytes(self._store.serialize_cdr(message, _stored_name(type_name), little_endian=True))

    def decode(self, type_name: str, data: bytes) -> Any:
        """Return the message in ``data``; raises FaultError if it is too large or invalid."""
        from rosbags.serde import SerdeError

        if len(data) > LARGEST_MESSAGE:
            raise FaultError(f"it has {len(data)} bytes, and {LARGEST_MESSAGE} are the most")
        try:
            return self._store.deserialize_cdr(data, _stored_name(type_name))
        except (SerdeError, IndexError, OverflowError, MemoryError) as error:
            raise FaultError(
                f"it is no {type_name} of {self.distribution}: {error}; set distribution to the robot's"
            ) from None

    def goal_hash(self, action: str) -> str:
        """Return the hash (REP 2016) of the goals of one of Nav2's actions, as sent by its server."""
        from rosbags.interfaces import Nodetype

        if action not in self._goal_hashes:
            defined = self._store.fielddefs
            goal, request = f"nav2_msgs/action/{action}_Goal", f"nav2_msgs/action/{action}_SendGoal_Request"
            # A request has this layout, but is described as an id and a goal of its own type.
            (goal_id, *fields) = defined[_stored_name(request)][1]
            defined[goal] = ([], fields)
            defined[request] = ([], [goal_id, ("goal", (Nodetype.NAME, goal))])
            self._goal_hashes[action] = self._store.hash_rihs01(request)
        return self._goal_hashes[action]

    def distributions_of(self, action: str, goal_hash: str) -> list[str]:
        """Return the distributions in which an action's goals have this hash."""
        if not self._others:
            # Some tenths of a second, once.
            self._others = {name: Interfaces(name) for name in DISTRIBUTIONS}
        return [name for name, types in self._others.items() if types.goal_hash(action) == goal_hash]

    def _zeros(self, name: str) -> dict[str, Any]:
        return {field: self._zero(name, field, desc) for field, desc in self._store.fielddefs[name][1]}

    def _zero(self, name: str, field: str, desc: Any) -> Any:
        import numpy as np
        from rosbags.interfaces import Nodetype

        kind, what = desc
        if kind == Nodetype.NAME:
            return self.make(what)
        if kind == Nodetype.BASE:
            return {"string": "", "bool": False}.get(what[0], 0)
        element, length = what
        if element[0] == Nodetype.BASE and element[1][0] != "string":
            count = length if kind == Nodetype.ARRAY else 0
            return np.zeros(count, dtype={"byte": "uint8", "char": "uint8"}.get(element[1][0], element[1][0]))
        return [] if kind == Nodetype.SEQUENCE else [self._zero(name, field, element) for _ in range(length)]


def _stored_name(type_name: str) -> str:
    """Return a type's name in rosbags, which has only messages."""
    return type_name.replace("/srv/", "/msg/").replace("/action/", "/msg/")


def _definitions(distribution: str) -> dict[str, str]:
    nothing = "uint8 structure_needs_at_least_one_member\n"
    definitions = {
        "action_msgs/msg/CancelGoal_Request": "action_msgs/GoalInfo goal_info\n",
        "action_msgs/msg/CancelGoal_Response": "int8 return_code\naction_msgs/GoalInfo[] goals_canceling\n",
        "std_srvs/msg/Trigger_Request": nothing,
        "std_srvs/msg/Trigger_Response": "bool success\nstring message\n",
        "nav_msgs/msg/GetMap_Request": nothing,
        "nav_msgs/msg/GetMap_Response": "nav_msgs/OccupancyGrid map\n",
        **{f"nav2_msgs/msg/{name}": text for name, text in _NAV2_MESSAGES.items()},
    }
    for action, (goal, result, feedback) in _actions(distribution).items():
        named = f"nav2_msgs/msg/{action}"
        definitions |= {
            f"{named}_SendGoal_Request": f"{_GOAL_ID}\n{goal}\n",
            f"{named}_SendGoal_Response": "bool accepted\nbuiltin_interfaces/Time stamp\n",
            f"{named}_GetResult_Request": f"{_GOAL_ID}\n",
            f"{named}_GetResult_Response": f"int8 status\n{result}\n",
            f"{named}_FeedbackMessage": f"{_GOAL_ID}\n{feedback}\n",
        }
    return definitions


def _actions(distribution: str) -> dict[str, tuple[str, str, str]]:
    """Return goal, result and feedback of Nav2's actions; their fields follow the id directly."""
    since = DISTRIBUTIONS.index(distribution)
    humble, jazzy, kilted, lyrical = (since >= DISTRIBUTIONS.index(one) for one in DISTRIBUTIONS[1:])
    empty = "std_msgs/Empty result\n"
    reason = "uint16 error_code\nstring error_msg\n" if jazzy else ""
    errors = "float32 position_tracking_error\nfloat32 heading_tracking_error\n" * lyrical
    waypoints = "WaypointStatus[] {}\n" if kilted else "MissedWaypoint[] {}\n" if jazzy else "int32[] {}\n"
    statuses = waypoints.format("waypoint_statuses") * kilted
    remaining = "builtin_interfaces/Duration estimated_time_remaining\n" * humble
    to_pose = (
        f"geometry_msgs/PoseStamped current_pose\nbuiltin_interfaces/Duration navigation_time\n{remaining}"
        f"int16 number_of_recoveries\nfloat32 distance_remaining\n{errors}"
    )
    checkers = "string controller_id\n" + "string goal_checker_id\n" * humble
    checkers += "string progress_checker_id\n" * jazzy + "string path_handler_id\n" * lyrical
    loops = "uint32 number_of_loops\nuint32 goal_index\n" * jazzy
    poses = "geometry_msgs/PoseStamped[] poses\n"
    return {
        "NavigateToPose": (
            "geometry_msgs/PoseStamped pose\nstring behavior_tree\n",
            reason or empty,
            to_pose,
        ),
        "NavigateThroughPoses": (
            ("nav_msgs/Goals poses\n" if kilted else poses) + "string behavior_tree\n",
            (reason or empty) + statuses,
            f"{to_pose}int16 number_of_poses_remaining\n{statuses}",
        ),
        "FollowPath": (
            f"nav_msgs/Path path\n{checkers}",
            empty + reason,
            "TrackingFeedback tracking_feedback" if lyrical else "float32 distance_to_goal\nfloat32 speed\n",
        ),
        "FollowWaypoints": (
            loops + poses,
            waypoints.format("missed_waypoints") + reason,
            "uint32 current_waypoint\n",
        ),
    }
