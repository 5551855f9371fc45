"""What supervisors ask of robots that are gone."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from .checks import MessageError, check_robot_name
from .stopping import check_reason

MOST_REMOVED = 10_000
"""Robots of one request."""


@dataclass(frozen=True)
class RemoveRobots:
    """Remove ``robots`` that are lost or offline, with their queues and open commands.

    Their history stays. One that comes back is told to abort, and is a new robot.
    """

    method: ClassVar[str] = "remove_robots"
    robots: list[str]
    reason: str | None = None

    def __post_init__(self) -> None:
        if not 1 <= len(self.robots) <= MOST_REMOVED:
            raise MessageError(f"robots names {len(self.robots)}; give 1 to {MOST_REMOVED}")
        for robot in self.robots:
            check_robot_name(robot)
        check_reason(self.reason)


@dataclass(frozen=True)
class KeptRobot:
    """A robot that was not removed, and why."""

    robot: str
    reason: str


@dataclass(frozen=True)
class RobotsRemoved:
    """The robots that were removed, by name, and those that were not."""

    removed: list[str]
    kept: list[KeptRobot] = field(default_factory=list)
