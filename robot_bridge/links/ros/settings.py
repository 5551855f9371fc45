"""Settings of ROS robots, names of topics and services, and topic patterns that find robots."""

from __future__ import annotations

import re
from typing import Literal

import msgspec

from ..base.errors import LinkError
from ..base.settings import LinkSettings
from .effects import RosAction
from .errors import RosError, RosNameError

# --- Names of ROS 2 topics, services and actions, and patterns to find robots by topics; no I/O

LONGEST_NAME = 255
"""characters of a topic's name, as DDS has it."""
_TOPIC = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_ROBOT = "{robot}"
_ROBOT_IN_TOPIC = r"(?P<robot>[A-Za-z0-9][A-Za-z0-9_]{0,62})"


def is_topic(name: str) -> bool:
    """Return whether ROS 2 allows ``name`` as a full name of a topic, service or action."""
    return len(name) <= LONGEST_NAME and _TOPIC.fullmatch(name) is not None


def check_topic(name: str) -> str:
    """Return ``name`` if ROS 2 allows it as a full name of a topic, service or action; else RosNameError."""
    if not is_topic(name):
        raise RosNameError(
            f"{name[:80]!r} is no full name of a topic; write it as '/r1/odom': words of letters, digits and "
            "'_', none beginning with a digit, each after a '/'"
        )
    return name


class TopicPattern:
    """A topic pattern with ``{robot}`` for the robot's name, or one topic for all robots.

    :raises RosNameError: for a pattern that is an invalid topic for any robot's name.
    """

    def __init__(self, pattern: str) -> None:
        if pattern.count(_ROBOT) > 1 or "{" in pattern.replace(_ROBOT, ""):
            raise RosNameError(
                f"{pattern[:80]!r}: write '{_ROBOT}' once, where its name is, as in '/{_ROBOT}/odom'"
            )
        check_topic(pattern.replace(_ROBOT, "r1"))
        self.pattern = pattern
        self.is_shared = _ROBOT not in pattern
        self._regex = re.compile(re.escape(pattern).replace(re.escape(_ROBOT), _ROBOT_IN_TOPIC))

    def robot_of(self, topic: str) -> str | None:
        """Return the robot whose topic it is; None for another topic, and for one shared by all robots."""
        found = None if self.is_shared else self._regex.fullmatch(topic)
        return found["robot"] if found else None

    def topic_of(self, robot: str) -> str:
        """Return the topic of ``robot``; raises RosNameError if its name is invalid in a topic."""
        return check_topic(self.pattern.replace(_ROBOT, robot))


# --- Common settings of ROS robots: the robots, and the names of their topics ---

PathAction = Literal["FollowPath", "NavigateThroughPoses", "FollowWaypoints"]
DISTRIBUTIONS = ("foxy", "humble", "jazzy", "kilted", "lyrical")

LARGEST_IMAGE = 8_000_000
"""bytes: the upper limit of a site's own limit."""


class TopicSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Table ``topics``: names of topics, actions and services, each with ``{robot}`` or one for all.

    ``position`` may be Odometry, PoseStamped, PoseWithCovarianceStamped, NavSatFix or TFMessage: its type is
    detected. Omitted topics, and those that a robot lacks, are not used.
    """

    position: str = "/{robot}/odom"
    imu: str | None = "/{robot}/imu"
    tf: str | None = "/{robot}/tf"
    battery: str | None = "/{robot}/battery_state"
    diagnostics: str | None = "/{robot}/diagnostics"
    image: str | None = None
    navigate_to_pose: str | None = "/{robot}/navigate_to_pose"
    navigate_through_poses: str | None = "/{robot}/navigate_through_poses"
    follow_path: str | None = "/{robot}/follow_path"
    follow_waypoints: str | None = "/{robot}/follow_waypoints"
    goal_pose: str | None = "/{robot}/goal_pose"
    path: str | None = None
    initial_pose: str | None = "/{robot}/initialpose"
    cmd_vel: str | None = "/{robot}/cmd_vel"
    stop: str | None = None
    place_cone: str | None = None
    map: str | None = None
    get_map: str | None = None
    keepout_mask: str | None = None
    keepout_info: str | None = None
    speed_mask: str | None = None
    speed_info: str | None = None


class RobotSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Settings of the robots. Without ``robots``, all with a position topic or a server are controlled.

    A path goes to the first of ``path_actions`` that the robot offers. An image is an observation every
    ``image_every_s`` seconds at most. A target or a path waits ``hold_s`` seconds for an action server or a
    listener that is not found, as just after a reconnect, before it is refused.
    """

    distribution: str = "jazzy"
    robots: tuple[str, ...] = ()
    map_frame: str = "map"
    base_frame: str = "base_link"
    map_resolution_m: float = 0.1
    image_every_s: float = 60.0
    largest_image_bytes: int = 500_000
    path_actions: tuple[PathAction, ...] = ("FollowPath", "NavigateThroughPoses", "FollowWaypoints")
    hold_s: float = 10.0
    topics: TopicSettings = TopicSettings()

    @property
    def patterns(self) -> dict[str, TopicPattern]:
        """The topics in use, by the names of their settings."""
        named = {field: getattr(self.topics, field) for field in self.topics.__struct_fields__}
        return {field: TopicPattern(pattern) for field, pattern in named.items() if pattern is not None}

    @property
    def actions_for_paths(self) -> tuple[RosAction, ...]:
        """The actions that may drive a path; the first one present is used."""
        return tuple(map(RosAction, self.path_actions))

    @property
    def maps(self) -> bool:
        """Whether the robots are sent anything built from the site's map."""
        topics = self.topics
        return any((topics.map, topics.get_map, topics.keepout_mask, topics.speed_mask))

    def base_frame_of(self, robot: str) -> str:
        """Return the base frame of the robot."""
        return self.base_frame.replace("{robot}", robot)


def distribution_names() -> str:
    """Return the distributions with known types, for messages to people."""
    return ", ".join(DISTRIBUTIONS)


def check_robots(settings: RobotSettings, table: str, link: LinkSettings) -> None:
    """Raise LinkError, naming file and key of ``table``, for errors that the types do not exclude."""
    file = link.file
    link.frame.check_metres(f"{file}: frame")
    where = f"{file}: {table}"
    if settings.distribution not in DISTRIBUTIONS:
        raise LinkError(
            f"{where}.distribution = {settings.distribution!r}: give one of {distribution_names()}; for "
            "rolling the newest"
        )
    _check_numbers(settings, where)
    for field in settings.topics.__struct_fields__:
        pattern = getattr(settings.topics, field)
        try:
            if pattern is None:
                continue
            known = TopicPattern(pattern)
            for robot in settings.robots:
                known.topic_of(robot)
        except RosError as error:
            raise LinkError(f"{where}.topics.{field}: {error}") from None
        mask = field.replace("_info", "_mask")
        if getattr(settings.topics, mask) is None:
            raise LinkError(f"{where}.topics.{field} = {pattern!r}: name its mask, too, as topics.{mask}")
        if field == "position" and known.is_shared:
            raise LinkError(
                f"{where}.topics.position = {pattern!r}: write '{{robot}}' where each robot's name is"
            )


def _check_numbers(settings: RobotSettings, where: str) -> None:
    if not 0.01 <= settings.map_resolution_m <= 10.0:
        raise LinkError(
            f"{where}.map_resolution_m = {settings.map_resolution_m}: give metres from 0.01 to 10"
        )
    if not 1.0 <= settings.image_every_s <= 86_400.0:
        raise LinkError(f"{where}.image_every_s = {settings.image_every_s}: give seconds from 1 to 86400")
    if not 0.0 <= settings.hold_s <= 60.0:
        raise LinkError(f"{where}.hold_s = {settings.hold_s}: give seconds from 0 to 60")
    if not 1024 <= settings.largest_image_bytes <= LARGEST_IMAGE:
        raise LinkError(
            f"{where}.largest_image_bytes = {settings.largest_image_bytes}: give bytes from 1024 to "
            f"{LARGEST_IMAGE}"
        )
