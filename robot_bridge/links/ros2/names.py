"""Names of ROS 2 topics, services, actions and types as DDS carries them; no I/O.

A topic ``/r1/odom`` is ``rt/r1/odom``; a service ``/r1/stop`` is the two topics ``rq/r1/stopRequest`` and
``rr/r1/stopReply``; an action is three services and two topics below ``_action``. A type
``nav_msgs/msg/Odometry`` is ``nav_msgs::msg::dds_::Odometry_`` (design.ros2.org, topic and service names).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..ros.errors import RosNameError
from ..ros.names import check_topic, is_topic

_TYPE = re.compile(r"([A-Za-z][A-Za-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)")
_DDS_TYPE = re.compile(r"([A-Za-z][A-Za-z0-9_]*)::(msg|srv|action)::dds_::([A-Za-z][A-Za-z0-9_]*)_")

VENDORS = {(1, 1): "RTI Connext", (1, 15): "Fast DDS", (1, 16): "Cyclone DDS"}
"""By the first two bytes of a participant's id; others are not known to be used with ROS 2."""
CYCLONE = (1, 16)


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
    """Return the ROS topic of a DDS topic, None for what is none: services, parts of actions, other DDS."""
    ros = name[2:] if name.startswith("rt/") else ""
    return ros if is_topic(ros) else None


def type_to_dds(name: str) -> str:
    """Return the DDS name of a type such as ``nav_msgs/msg/Odometry``; raises RosNameError."""
    found = _TYPE.fullmatch(name)
    if found is None:
        raise RosNameError(f"{name[:80]!r} is no type; write it as 'nav_msgs/msg/Odometry'")
    return "{}::{}::dds_::{}_".format(*found.groups())


def type_from_dds(name: str) -> str | None:
    """Return the ROS name of a DDS type, None for what is none of ROS 2."""
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


def vendor_of(key: bytes) -> str:
    """Return which DDS a participant or endpoint with this id, 16 bytes, is of."""
    return VENDORS.get((key[0], key[1]), f"vendor {key[0]}.{key[1]}")
