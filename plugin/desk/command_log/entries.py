"""Commands as rows of the log: in words, chosen by a filter, and as a table for a file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

from ....robot_bridge.messages import Abort, CommandReport, CommandState, CommandStep
from ...language import tr
from ..command_book import UNDER_WAY, in_words, place_of, state_word
from ..csv_files import iso_time
from ..state_words import COMMAND_STATES
from ..wall_clock import short_time

FAILED = (CommandState.ABORTED, CommandState.FAILED, CommandState.EXPIRED)
CSV_HEAD = (
    "command",
    "robot",
    "operation",
    "what",
    "asked_by",
    "step",
    "state",
    "time",
    "by",
    "reason",
    "deviation_m",
    "target_x",
    "target_y",
)


class Which(str, Enum):
    """Which commands are listed."""

    ALL = "all"
    OPEN = "open"
    FAILED = "failed"


@dataclass(frozen=True)
class Filter:
    """Commands of these ``robots`` (None: of all) that are as ``which`` says."""

    robots: frozenset[str] | None = None
    which: Which = Which.ALL

    def keeps(self, report: CommandReport) -> bool:
        """Tell whether a command is listed."""
        if self.robots is not None and report.robot not in self.robots:
            return False
        if self.which is Which.OPEN:
            return report.state in UNDER_WAY
        return self.which is Which.ALL or report.state in FAILED


def cells(report: CommandReport) -> tuple[str, str, str, str]:
    """Return a command's row: time, what, state, and how far off or why or by whom."""
    first = report.steps[0].at if report.steps else None
    return (
        short_time(first),
        f"{report.robot} · {in_words(report)}",
        state_word(report.op, report.state),
        _details(report),
    )


def step_cells(step: CommandStep, report: CommandReport) -> tuple[str, str, str, str]:
    """Return a step's row: time, by whom and why, state, and how far off."""
    off = _off(report) if step.state is CommandState.REACHED else ""
    because = f": {step.reason}" if step.reason else ""
    return short_time(step.at), tr("by {by}", by=step.by) + because, state_word(report.op, step.state), off


def summary(reports: Iterable[CommandReport]) -> str:
    """Return how many commands are open, as in ``3 open: 1 queued, 2 acknowledged``."""
    states = [report.state for report in reports if report.state in UNDER_WAY]
    if not states:
        return tr("None open")
    counts = [f"{states.count(state)} {COMMAND_STATES[state]}" for state in UNDER_WAY if state in states]
    return tr("{number} open: {counts}", number=len(states), counts=", ".join(counts))


def csv_rows(reports: Iterable[CommandReport]) -> Iterator[tuple[object, ...]]:
    """Return a row for every step of every command; places in metres of the site frame."""
    for report in reports:
        x, y = place_of(report) or (None, None)
        what = in_words(report)
        for number, step in enumerate(report.steps, 1):
            deviation = report.deviation if step.state is CommandState.REACHED else None
            yield (
                report.command,
                report.robot,
                report.op,
                what,
                report.operator,
                number,
                step.state.value,
                iso_time(step.at),
                step.by,
                step.reason,
                deviation,
                x,
                y,
            )


def _details(report: CommandReport) -> str:
    reason = report.steps[-1].reason if report.steps else None
    return _off(report) or reason or tr("by {by}", by=report.operator)


def _off(report: CommandReport) -> str:
    """Return how far from its target a robot stands; an abort has no target."""
    if report.deviation is None or report.op == Abort.__name__:
        return ""
    return tr("{metres:.2f} m off", metres=report.deviation)
