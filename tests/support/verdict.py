"""Whether the gateway's own record says what the demonstration claims."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tests.support.errors import StageError

LIFE = ["queued", "delivered", "acknowledged", "reached"]
CLICK_TOLERANCE = 0.25
"""How far, in metres, the place that the gateway got may lie from the place that was clicked: one pixel."""


@dataclass(frozen=True)
class Errand:
    """What a robot was asked to do by a click: where it ends (site frame, metres), and how it should end."""

    robot: str
    end: tuple[float, float]
    outcome: str


@dataclass(frozen=True)
class Outcome:
    """What became of an errand: seconds from ``queued`` to each later step, and metres from its end."""

    errand: Errand
    after: Mapping[str, float]
    off_target: float | None


Wire = Mapping[str, Any]
"""An object as it stood in the gateway's answer."""


def judge(errand: Errand, commands: Sequence[Wire], poses: Mapping[str, Wire], tolerance: float) -> Outcome:
    """Compare ``errand`` with the gateway's commands and with its position of each robot.

    :raises StageError: when it did not end as it should, a step is missing, or the robot stands elsewhere.
    """
    mine = [c for c in commands if c["robot"] == errand.robot and c["op"] != "Abort"]
    if len(mine) != 1:
        raise StageError(f"the gateway knows {len(mine)} commands for {errand.robot}; one was sent")
    command = mine[0]
    states = [step["state"] for step in command["steps"]]
    expected = LIFE if errand.outcome == "reached" else [*LIFE[:3], errand.outcome]
    if states != expected:
        went, right = " → ".join(states), " → ".join(expected)
        raise StageError(f"the command for {errand.robot} went {went}, not {right}")
    _check_click(errand, command)
    off_target = None
    if errand.outcome == "reached":
        pose = poses[errand.robot]
        off_target = math.dist((pose["x"], pose["y"]), _end_of(command))
        if off_target > tolerance:
            raise StageError(
                f"{errand.robot} stands {off_target:.2f} m from its target, not within {tolerance} m"
            )
    first = command["steps"][0]["at"]
    return Outcome(errand, {step["state"]: step["at"] - first for step in command["steps"][1:]}, off_target)


def _check_click(errand: Errand, command: Wire) -> None:
    sent_to = _end_of(command)
    if math.dist(sent_to, errand.end) > CLICK_TOLERANCE:
        raise StageError(f"{errand.robot} was sent to {sent_to}, but {errand.end} was clicked")


def _end_of(command: Wire) -> tuple[float, float]:
    params = command["params"]
    x, y = params["points"][-1] if command["op"] == "SetPath" else (params["x"], params["y"])
    return float(x), float(y)
