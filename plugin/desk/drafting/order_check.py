"""Whether the robot of a draft is there, and whether somebody else has it do something."""

from __future__ import annotations

from ....robot_bridge.messages import CommandReport, RobotState
from ...language import tr
from ..command_book import in_words
from ..drafts import CONE, ROUTE, Draft, Findings
from ..last_heard import age_in_words
from ..picture import RobotView
from ..state_words import ROBOT_STATES

REPLACING = (CONE, ROUTE)
"""What a robot does in place of what it is at."""


GONE = (RobotState.LOST, RobotState.OFFLINE)


def check_heard(draft: Draft, robot: RobotView | None) -> Findings:
    """Warn where nothing is heard of the draft's ``robot``: what is sent waits, or is not carried out."""
    if robot is None or robot.state not in GONE:
        return Findings()
    return Findings(
        warnings=(
            tr(
                "{robot} is {state}, last heard {age} ago: it is told this when it is heard again, if that "
                "is soon enough.",
                robot=draft.robot,
                state=ROBOT_STATES[robot.state],
                age=age_in_words(robot.age),
            ),
        )
    )


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
