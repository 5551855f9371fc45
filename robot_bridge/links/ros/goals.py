"""Goals of ROS 2 actions: ids, outcomes, and texts for these; no I/O.

Replies to ``send_goal`` and ``get_result`` name neither client nor goal, and every client of a service
receives them all. The status topic has each goal's id: it decides, and replies are details.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import IntEnum
from typing import Any

_MARK = b"FLSV"
"""Prefix of the ids of our goals."""
_FOR_CONE = 1 << 63
"""The bit in the number of a message, never as large, of a goal with a cone handled at its end."""
MOST_GOALS = 1000
"""goals read in one status message."""


class GoalStatus(IntEnum):
    """action_msgs/GoalStatus."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6


ACTIVE = frozenset({GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING})
ENDED = frozenset({GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED})

Statuses = Mapping[bytes, GoalStatus]
"""By the goal's id."""


def goal_id(message: int, salt: int = 0, *, cone: bool = False) -> bytes:
    """Return the id, 16 bytes, of the goal for a gateway's message.

    The same message gives the same goal: sent twice it is done once, and a restarted process knows the
    message of a goal on the robot, and whether a cone is placed or collected after it. ``salt``, below 2³²,
    gives another id.
    """
    return _MARK + salt.to_bytes(4, "big") + (message | (_FOR_CONE if cone else 0)).to_bytes(8, "big")


def message_of(goal: bytes) -> int | None:
    """Return the gateway's message of a goal, None for a foreign goal."""
    is_ours = goal.startswith(_MARK) and len(goal) == 16
    return int.from_bytes(goal[8:], "big") & ~_FOR_CONE if is_ours else None


def is_for_cone(goal: bytes) -> bool:
    """Return whether a cone is placed or collected at the end of a goal of ours."""
    return message_of(goal) is not None and bool(int.from_bytes(goal[8:], "big") & _FOR_CONE)


def statuses_of(message: Any) -> dict[bytes, GoalStatus]:
    """Return the goals of an action_msgs/GoalStatusArray with their newest status."""
    found = {}
    for one in message.status_list[-MOST_GOALS:]:
        code = int(one.status)
        known = GoalStatus(code) if code in GoalStatus._value2member_map_ else GoalStatus.UNKNOWN
        found[bytes(one.goal_info.goal_id.uuid)] = known
    return found


_NAV2_ERRORS = {
    101: "the controller is not known",
    102: "transform failed",
    103: "the path is invalid",
    104: "it waited too long",
    105: "it made no progress",
    106: "no valid command for its wheels",
    107: "the controller took too long",
    601: "the task at a waypoint failed",
    602: "no valid waypoints",
    603: "it missed a waypoint",
    9001: "its behaviour tree cannot be loaded",
    9002: "transform failed",
    9003: "a server took too long",
    9101: "its behaviour tree cannot be loaded",
    9102: "transform failed",
    9103: "a server took too long",
}
"""By Nav2's error codes: FollowPath, FollowWaypoints, NavigateToPose, NavigateThroughPoses."""
_MOST_NAMED = 10


def failure_of(status: GoalStatus, error_code: int | None, error_msg: str | None) -> str:
    """Return why a goal has ended without success, for operators."""
    how = {
        GoalStatus.ABORTED: "the robot gave up",
        GoalStatus.CANCELED: "it was canceled on the robot's side",
    }.get(status, "the robot ended it")
    details = error_msg or ("" if not error_code else _NAV2_ERRORS.get(error_code, ""))
    code = f" (error {error_code})" if error_code else ""
    return f"{how}{': ' if details else ''}{details}{code}"


def missed_of(result: Any) -> list[int]:
    """Return the numbers, from 0, of the waypoints missed according to a result of FollowWaypoints."""
    found = []
    for one in getattr(result, "missed_waypoints", ()):
        found.append(int(getattr(one, "index", getattr(one, "waypoint_index", one))))
    return found


def missed_text(missed: Sequence[int]) -> str:
    """Return the missed waypoints of a succeeded goal as text for operators, counted from 1."""
    named = ", ".join(str(number + 1) for number in missed[:_MOST_NAMED])
    more = f" and {len(missed) - _MOST_NAMED} more" if len(missed) > _MOST_NAMED else ""
    return f"the robot left out points of the path: {named}{more}"


def feedback_text(message: Any) -> str:
    """Return the feedback of one of Nav2's actions as a robot's status."""
    parts = []
    message = getattr(message, "tracking_feedback", message)
    waypoint = getattr(message, "current_waypoint", None)
    if waypoint is not None:
        parts.append(f"to point {waypoint + 1}")
    left = getattr(message, "distance_remaining", getattr(message, "distance_to_goal", None))
    if left is not None and 0.0 <= left < 1e6:
        parts.append(f"{left:.1f} m left")
    recoveries = getattr(message, "number_of_recoveries", 0)
    if recoveries:
        parts.append(f"{recoveries} recoveries")
    return "navigating" + (f": {', '.join(parts)}" if parts else "")
