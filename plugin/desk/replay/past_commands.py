"""Commands as they were at a moment, and as marks on a time line."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ....robot_bridge.messages import Abort, CommandReport, CommandState, CommandStep
from ...language import tr
from ..command_book import UNDER_WAY, in_words
from ..state_words import COMMAND_STATES


@dataclass(frozen=True)
class Mark:
    """One step of a command on the time line."""

    command: CommandReport
    step: CommandStep

    @property
    def at(self) -> float:
        """When it was, in seconds since 1970."""
        return self.step.at

    @property
    def state(self) -> CommandState:
        """What the command came to."""
        return self.step.state

    @property
    def text(self) -> str:
        """Return it in words. Not kept: of thousands one is looked at."""
        text = tr(
            "{robot}: {command} · {state} by {by}",
            robot=self.command.robot,
            command=in_words(self.command),
            state=COMMAND_STATES[self.state],
            by=self.step.by,
        )
        return text + (f" ({self.step.reason})" if self.step.reason else "")


def under_way_at(reports: Iterable[CommandReport], moment: float) -> list[CommandReport]:
    """Return what robots were doing at ``moment``: of each the newest command sent and not ended then."""
    found: dict[str, CommandReport] = {}
    for report in sorted((one for one in reports if one.steps), key=lambda one: one.steps[0].at):
        so_far = [step.state for step in report.steps if step.at <= moment]
        if not so_far or report.op == Abort.__name__:
            continue
        if so_far[-1] in UNDER_WAY:
            found[report.robot] = report
        elif found.get(report.robot) is report:
            del found[report.robot]
    return list(found.values())


def marks(
    reports: Iterable[CommandReport], since: float, until: float, robots: Iterable[str] = ()
) -> list[Mark]:
    """Return when commands were sent and how they ended from ``since`` to ``until``: of ``robots`` or all."""
    wanted = set(robots)
    found = []
    for report in reports:
        if wanted and report.robot not in wanted:
            continue
        for step in report.steps:
            told = step.state not in UNDER_WAY or step.state is CommandState.QUEUED
            if told and since <= step.at <= until:
                found.append(Mark(report, step))
    return sorted(found, key=lambda mark: mark.at)
