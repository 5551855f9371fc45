"""Commands of robot r1, each step at a time of its own."""

from __future__ import annotations

import dataclasses

from robot_bridge.core.messages.commands import CommandState
from robot_bridge.core.messages.robots import Abort, SendPos, SetPath, SetPosEnd
from robot_bridge.gateway.commands.active_command import ActiveCommand, CommandOrder, create_command

TARGET = SetPosEnd(10.0, 5.0)
PATH = SetPath([(0.0, 0.0), (10.0, 0.0)])
ABORT = Abort()
EMERGENCY = Abort(emergency=True)
QUEUED, DELIVERED, ACKNOWLEDGED = (
    CommandState.QUEUED,
    CommandState.DELIVERED,
    CommandState.ACKNOWLEDGED,
)


def command(sa_id, message=TARGET, *states, reason=None, **fields) -> ActiveCommand:
    """Return command ``c-<sa_id>`` by Ada, issued at 100 s, with steps a second apart."""
    made = create_command(CommandOrder(f"c-{sa_id}", "r1", message, "Ada", reason), 100.0)
    made = dataclasses.replace(made, sa_id=sa_id, **fields)
    for number, state in enumerate(states, 1):
        made = made.step(state, 100.0 + number, "r1")
    return made


def pose(x=0.0, y=0.0, theta=0.0, v=0.0) -> SendPos:
    """Return a position of the robot."""
    return SendPos(x, y, theta, v)


def last(step) -> tuple:
    """Return state, time, name and reason of the newest step of a command."""
    step = step.report.steps[-1]
    return step.state.value, step.at, step.by, step.reason
