"""Whether somebody else has the robot of a draft do something."""

from __future__ import annotations

from ....robot_bridge.messages import CommandReport
from ...language import tr
from ..command_book import in_words
from ..drafts import CONE, ROUTE, Draft, Findings

REPLACING = (CONE, ROUTE)
"""What a robot does in place of what it is at."""


def check_orders(draft: Draft, task: CommandReport | None, operator: str) -> Findings:
    """Warn where ``task``, what the draft's robot is at, was asked for by another than ``operator``.

    An empty ``operator`` is one whose name the gateway has not told.
    """
    if task is None or not operator or task.operator == operator or draft.kind not in REPLACING:
        return Findings()
    return Findings(
        warnings=(
            tr(
                "{robot} is at work for {operator} ({task}): sending this takes its place.",
                robot=draft.robot,
                operator=task.operator,
                task=in_words(task),
            ),
        )
    )
