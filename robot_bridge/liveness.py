"""How far the knowledge of a robot can be trusted, from the age of its last message."""

from __future__ import annotations

from .messages import RobotState


def liveness(
    age: float, *, ended_in_order: bool, stale_after: float = 3.0, lost_after: float = 10.0
) -> RobotState:
    """Return the state of a robot whose last message is ``age`` seconds old.

    ``ended_in_order`` is true when the robot said Stopped last, or closed its link in good order: silence
    is expected of it then, so it goes offline where another would be lost.
    """
    if age < stale_after:
        return RobotState.FRESH
    if ended_in_order:
        return RobotState.OFFLINE
    return RobotState.STALE if age < lost_after else RobotState.LOST
