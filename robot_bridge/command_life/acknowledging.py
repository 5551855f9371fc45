"""What comes of a robot's commands when it answers to one, or starts anew and may have forgotten; no I/O."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import NamedTuple

from ..messages import CommandState, OpAck, SendPos
from .open_command import GATEWAY, OpenCommand, ended_by
from .states import may_become

ABORTED = "the robot acknowledged the Abort"


class StartedAnew(NamedTuple):
    """The commands of a robot whose messages are written ``again``, and those that have ``ended`` instead."""

    again: list[OpenCommand]
    ended: list[OpenCommand]


def answered(
    command: OpenCommand, ack: OpAck, mine: list[OpenCommand], now: float, tolerance: float, *, unseen: bool
) -> list[OpenCommand]:
    """Return what an OpAck of ``command`` changes in those of the robot, ``mine``, in the order of the steps.

    ``tolerance`` is metres within which a target counts as reached; ``unseen`` whether the robot may have
    come further since it was seen last.
    """
    robot = command.report.robot
    if not ack.ok:
        return [command.step(CommandState.FAILED, now, robot, ack.reason)]
    if may_become(command.report.state, CommandState.ACKNOWLEDGED):
        steps = []
        if command.report.state is CommandState.QUEUED:
            # What a robot answers to has reached it, even if that was not seen yet.
            command = command.step(CommandState.DELIVERED, now, GATEWAY)
            steps.append(command)
        steps.append(command.step(CommandState.ACKNOWLEDGED, now, robot).judged(tolerance))
        # One that nobody saw lately may have come to the end of what it had taken on before the Abort
        # reached it: that ends with its next position.
        ending = [one for one in mine if not (unseen and one.arrival)]
        return [*steps, *ended_by(command, ending, now, ABORTED)]
    if command.arrival is None:
        return [command.noted(now, robot, "acknowledged again").judged(tolerance)]
    return []


def started_anew(
    mine: list[OpenCommand],
    reason: str,
    now: float,
    expire_after: float,
    seen: Callable[[str], SendPos | None],
) -> StartedAnew:
    """Return what becomes of the commands of a robot that starts anew.

    What was never fetched is written again too, behind the map; but for an Abort that nothing waits before,
    which needs none. What is older than ``expire_after`` seconds is not sent again. ``seen`` tells where a
    robot was seen last.
    """
    ended = [end for command in mine for end in ended_by(command, mine, now, "the robot started anew")]
    ended += [
        command.step(CommandState.EXPIRED, now, GATEWAY, "the robot started anew, and it was too old then")
        for command in mine
        if command.is_on_its_way and command.expired(now, expire_after)
    ]
    # Of two ends of one command the first counts.
    ends = {command.report.command: command for command in reversed(ended)}
    moved = [c.sa_id for c in mine if c.report.state is not CommandState.QUEUED or not c.is_abort]
    first = min(moved, default=0)
    left = [c for c in mine if moved and c.report.command not in ends and c.sa_id >= first]
    return StartedAnew([_anew(command, reason, now, seen) for command in left], list(ends.values()))


def _anew(
    command: OpenCommand, reason: str, now: float, seen: Callable[[str], SendPos | None]
) -> OpenCommand:
    """Return a command to be sent once more; one that was never fetched keeps its place behind."""
    if command.report.state is CommandState.QUEUED:
        reason = "behind what the robot is told once more"
    noted, handed = command.noted(now, GATEWAY, reason), seen(command.report.robot)
    return dataclasses.replace(noted, written_at=now, handed=handed, out_of_sight=False)
