"""Effects for one robot, decided without I/O and carried out by :mod:`.robot`."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ...core.messages.robots import SetPath, SetPosEnd


class RosAction(str, Enum):
    """Nav2's actions that drive a robot."""

    TO_POSE = "NavigateToPose"
    THROUGH_POSES = "NavigateThroughPoses"
    FOLLOW_PATH = "FollowPath"
    WAYPOINTS = "FollowWaypoints"


PATH_ACTIONS = (RosAction.FOLLOW_PATH, RosAction.THROUGH_POSES, RosAction.WAYPOINTS)
"""Actions that drive a path, the one that follows it best first."""


@dataclass(frozen=True)
class Abilities:
    """Servers and subscribers present on the robot's side, found by discovery."""

    actions: frozenset[RosAction] = frozenset()
    foreign: frozenset[RosAction] = frozenset()
    """Actions of another distribution: goals sent to them could not be read; theirs can be canceled."""
    goal_topic: bool = False
    path_topic: bool = False
    velocity: bool = False
    stop_service: bool = False
    cone_service: bool = False

    @property
    def driving(self) -> frozenset[RosAction]:
        """The actions that goals may be sent to."""
        return self.actions - self.foreign

    @property
    def is_stoppable(self) -> bool:
        """Whether there is anything that a stop can be sent to."""
        return bool(self.actions) or self.velocity or self.stop_service or self.goal_topic


@dataclass(frozen=True)
class Answered:
    """The robot accepted the gateway's ``message``; with a ``refusal`` it did not, or gave it up since."""

    message: int
    refusal: str | None = None


@dataclass(frozen=True)
class StopEnded:
    """The robot's side has confirmed the stop; with a ``refusal`` it has not in time."""

    refusal: str | None = None


@dataclass(frozen=True)
class Idle:
    """The robot is idle."""


@dataclass(frozen=True)
class Remark:
    """Log a line."""

    text: str


@dataclass(frozen=True)
class SendGoal:
    """Send the goal for a ``message`` to an action server, and ask for its result."""

    action: RosAction
    goal_id: bytes
    task: SetPosEnd | SetPath
    message: int


@dataclass(frozen=True)
class CancelGoals:
    """Ask an action server to cancel one goal; without ``goal_id`` all, from any client."""

    action: RosAction
    goal_id: bytes | None = None


@dataclass(frozen=True)
class PublishTask:
    """Publish a target or path on its topic, for robots without actions."""

    task: SetPosEnd | SetPath


@dataclass(frozen=True)
class PublishHere:
    """Publish the robot's own place as its target: robots that drive to targets on a topic stay there."""


@dataclass(frozen=True)
class ZeroTwist:
    """Publish speed 0."""


@dataclass(frozen=True)
class CallStop:
    """Call the robot's stop service."""


@dataclass(frozen=True)
class CallCone:
    """Call the service that places a cone, or picks one up."""


Effect = (
    Answered
    | StopEnded
    | Idle
    | Remark
    | SendGoal
    | CancelGoals
    | PublishTask
    | PublishHere
    | ZeroTwist
    | CallStop
    | CallCone
)
