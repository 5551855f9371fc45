"""Who holds a robot's name: a second robot that says Ready under the same account is noticed and refused."""

from __future__ import annotations

from typing import Protocol

from .robots import Robot


class Hold(Protocol):
    """A connection of a robot."""

    async def answers(self) -> bool:
        """Tell whether the robot at its other end is there; takes a second at most."""


class Holds:
    """The connections that robots hold, by name. Robots on SQL have none."""

    def __init__(self) -> None:
        self._holds: dict[str, Hold] = {}

    def take(self, robot: str, hold: Hold) -> None:
        """Note that ``robot`` is at the other end of ``hold``, and of no other."""
        self._holds[robot] = hold

    def free(self, robot: str, hold: Hold) -> None:
        """Note that ``robot`` is no longer at the other end of ``hold``."""
        if self._holds.get(robot) is hold:
            del self._holds[robot]

    async def answers(self, robot: str) -> bool:
        """Tell whether the robot holds a connection and is there."""
        hold = self._holds.get(robot)
        return hold is not None and await hold.answers()


async def refusal(robot: Robot, magic: int, silent: float, stale_after: float, holds: Holds) -> str | None:
    """Return why a Ready with ``magic`` is refused: it comes from another robot than the one of this name.

    ``silent`` is seconds since that one was heard. One that was restarted is let in: its old connection is
    closed or does not answer; on SQL it said Stopped, or is silent for ``stale_after`` seconds.
    """
    if robot.magic == magic or silent >= stale_after:
        return None
    there = not robot.ended_in_order if robot.link == "sql" else await holds.answers(robot.name)
    if not there:
        return None
    return (
        f"another robot runs as {robot.name!r} (magic {robot.magic}, heard {silent:.1f} s ago); give each "
        "robot an account of its own, or end the other one"
    )
