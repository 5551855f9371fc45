"""Commands as they were at a moment, and as marks on a time line."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import Abort, CommandReport, CommandState, CommandStep
from ...language import tr
from ..command_book import UNDER_WAY, asked_at, in_words, state_word
from ..time_slices import Steps

AT_ONCE = 100
"""Commands that are looked through in one step of a slice."""
STATES = tuple(CommandState)
_CODES = {state: code for code, state in enumerate(STATES)}
Numbers = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]


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
        """Return it in words."""
        text = tr(
            "{robot}: {command} · {state} by {by}",
            robot=self.command.robot,
            command=in_words(self.command),
            state=state_word(self.command.op, self.state),
            by=self.step.by,
        )
        return text + (f" ({self.step.reason})" if self.step.reason else "")


class Marks(Sequence[Mark]):
    """Marks from the oldest to the newest, (n,) columns: of thousands a :class:`Mark` is made of one.

    ``at`` is in seconds since 1970, ``commands`` and ``steps`` are the places of a mark's command among
    ``reports`` and of its step among that one's, ``states`` are indices into :data:`STATES`.
    """

    def __init__(
        self,
        reports: Sequence[CommandReport],
        at: Numbers,
        commands: Indices,
        steps: Indices,
        states: Indices,
    ):
        self.at = at
        self._reports, self._commands, self._steps, self._states = reports, commands, steps, states

    def __len__(self) -> int:
        return len(self.at)

    def __getitem__(self, place: Any) -> Any:
        report = self._reports[self._commands[place]]
        return Mark(report, report.steps[self._steps[place]])

    def of(self, state: CommandState) -> Numbers:
        """Return when commands came to ``state``, seconds since 1970."""
        return self.at[self._states == _CODES[state]]

    def between(self, since: float, until: float) -> Marks:
        """Return the marks from ``since`` to ``until``, both included."""
        return self._kept((self.at >= since) & (self.at <= until))

    def of_robots(self, names: Collection[str]) -> Marks:
        """Return the marks of the commands of these robots."""
        is_wanted = np.array([report.robot in names for report in self._reports], dtype=bool)
        return self._kept(is_wanted[self._commands])

    def _kept(self, rows: npt.NDArray[np.bool_]) -> Marks:
        columns = (self.at, self._commands, self._steps, self._states)
        return Marks(self._reports, *(column[rows] for column in columns))


def _no_marks() -> Marks:
    none = np.empty(0, dtype=np.intp)
    return Marks((), np.empty(0), none, none, none)


NO_MARKS = _no_marks()


class PastCommands:
    """What was known of commands when :func:`arranged` looked: a frame of the replay asks for all at once.

    ``reports`` are sorted by when they were asked for; (n,) ``begin`` and ``end`` are from when to when each
    was under way, seconds since 1970.
    """

    def __init__(
        self,
        reports: Sequence[CommandReport] = (),
        begin: Sequence[float] = (),
        end: Sequence[float] = (),
        marks: Marks = NO_MARKS,
    ):
        self._reports = reports
        self._begin, self._end = np.array(begin, dtype=np.float64), np.array(end, dtype=np.float64)
        self._marks = marks

    def under_way_at(self, moment: float) -> list[CommandReport]:
        """Return what robots were doing at ``moment``: of each the newest command sent and not ended then."""
        rows = np.flatnonzero((self._begin <= moment) & (moment < self._end)).tolist()
        return list({self._reports[row].robot: self._reports[row] for row in rows}.values())

    def marks(self, since: float, until: float, robots: Collection[str] = ()) -> Marks:
        """Return when commands of ``robots``, or all, were sent and ended from ``since`` to ``until``."""
        told = self._marks.between(since, until)
        return told.of_robots(set(robots)) if robots else told


def arranged(reports: Sequence[CommandReport]) -> Steps[PastCommands]:
    """Look through commands, in steps."""
    reports = sorted((one for one in reports if one.steps), key=asked_at)
    begin, end = [], []
    marks: list[tuple[float, int, int, int]] = []
    for number, report in enumerate(reports):
        if number % AT_ONCE == 0:
            yield number / len(reports)
        begin.append(report.steps[0].at)
        end.append(_ended_at(report))
        for place, step in enumerate(report.steps):
            if step.state not in UNDER_WAY or step.state is CommandState.QUEUED:
                marks.append((step.at, number, place, _CODES[step.state]))
    return PastCommands(reports, begin, end, _columns(reports, marks))


def _columns(reports: Sequence[CommandReport], marks: list[tuple[float, int, int, int]]) -> Marks:
    if not marks:
        return NO_MARKS
    table = np.array(marks, dtype=np.float64)
    at, commands, steps, states = table[np.argsort(table[:, 0], kind="stable")].T
    return Marks(reports, at, *(column.astype(np.intp) for column in (commands, steps, states)))


def _ended_at(report: CommandReport) -> float:
    """Return until when a robot had something to do by a command: an abort leaves it nothing."""
    if report.op == Abort.__name__:
        return -np.inf
    return next((step.at for step in report.steps if step.state not in UNDER_WAY), np.inf)
