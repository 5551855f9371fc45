"""Names of ROS 2 topics, services and actions, and patterns that find robots by their topics; no I/O."""

from __future__ import annotations

import re

from .errors import RosNameError

LONGEST_NAME = 255
"""characters of a topic's name, as DDS has it."""
_TOPIC = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_ROBOT = "{robot}"
_ROBOT_IN_TOPIC = r"(?P<robot>[A-Za-z0-9][A-Za-z0-9_]{0,62})"


def is_topic(name: str) -> bool:
    """Tell whether ROS 2 allows ``name`` as a full name of a topic, service or action."""
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
    """A topic with ``{robot}`` where each robot has its own name, or one topic for all of them.

    :raises RosNameError: for a pattern that is no topic whatever the robot is called.
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
        """Return the robot whose topic it is; None for another topic, and for one that all robots share."""
        found = None if self.is_shared else self._regex.fullmatch(topic)
        return found["robot"] if found else None

    def topic_of(self, robot: str) -> str:
        """Return the topic of ``robot``; raises RosNameError where its name cannot stand in a topic."""
        return check_topic(self.pattern.replace(_ROBOT, robot))
