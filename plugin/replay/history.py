"""History: stored positions and commands of a span of time, as read by the replay."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from qgis.core import QgsApplication, QgsTask
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep, GetCommands
from ...robot_bridge.core.messages.records import GetTrajectory
from ...robot_bridge.core.messages.robots import Abort
from ...robot_bridge.core.messages.safety import RobotState
from ..control.request_tracker import RequestTracker
from ..gateway_client.command_cache import CommandCache, command_in_words, requested_at, state_word
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.robot_states import STATES as HISTORY_STATES
from ..gateway_client.robot_states import RobotArrays
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask, SignallingTask, Steps

AT_ONCE = 100
"""Commands processed in one step of a slice."""
STATES = tuple(CommandState)
_CODES = {state: code for code, state in enumerate(STATES)}
Numbers = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]


@dataclass(frozen=True)
class TimelineMark:
    """One step of a command on the time line."""

    command: CommandReport
    step: CommandStep

    @property
    def at(self) -> float:
        """Its time, in seconds since 1970."""
        return self.step.at

    @property
    def state(self) -> CommandState:
        """The new state of the command."""
        return self.step.state

    @property
    def text(self) -> str:
        """Return the step in words."""
        text = tr(
            "{robot}: {command} · {state} by {by}",
            robot=self.command.robot,
            command=command_in_words(self.command),
            state=state_word(self.command.op, self.state),
            by=self.step.by,
        )
        return text + (f" ({self.step.reason})" if self.step.reason else "")


class TimelineMarks(Sequence[TimelineMark]):
    """Marks in order of time, (n,) columns: a :class:`TimelineMark` is created on access, there are many.

    ``at`` is in seconds since 1970, ``commands`` and ``steps`` are the indices of a mark's command in
    ``reports`` and of its step in that one's, ``states`` are indices into :data:`STATES`.
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
        return TimelineMark(report, report.steps[self._steps[place]])

    def of(self, state: CommandState) -> Numbers:
        """Return the times when commands reached ``state``, seconds since 1970."""
        return self.at[self._states == _CODES[state]]

    def between(self, since: float, until: float) -> TimelineMarks:
        """Return the marks from ``since`` to ``until``, both included."""
        return self._kept((self.at >= since) & (self.at <= until))

    def of_robots(self, names: Collection[str]) -> TimelineMarks:
        """Return the marks of the commands of these robots."""
        is_selected = np.array([report.robot in names for report in self._reports], dtype=bool)
        return self._kept(is_selected[self._commands])

    def _kept(self, rows: npt.NDArray[np.bool_]) -> TimelineMarks:
        columns = (self.at, self._commands, self._steps, self._states)
        return TimelineMarks(self._reports, *(column[rows] for column in columns))


def _no_marks() -> TimelineMarks:
    none = np.empty(0, dtype=np.intp)
    return TimelineMarks((), np.empty(0), none, none, none)


NO_MARKS = _no_marks()


class PastCommands:
    """The commands known when :func:`sort_commands` ran: each frame of the replay queries all.

    ``reports`` are sorted by time of request; (n,) ``begin`` and ``end`` are the times between which
    each was under way, seconds since 1970.
    """

    def __init__(
        self,
        reports: Sequence[CommandReport] = (),
        begin: Sequence[float] = (),
        end: Sequence[float] = (),
        marks: TimelineMarks = NO_MARKS,
    ):
        self._reports = reports
        self._begin, self._end = np.array(begin, dtype=np.float64), np.array(end, dtype=np.float64)
        self._marks = marks

    def under_way_at(self, moment: float) -> list[CommandReport]:
        """Return the commands under way at ``moment``: of each robot the newest one sent and not ended."""
        rows = np.flatnonzero((self._begin <= moment) & (moment < self._end)).tolist()
        return list({self._reports[row].robot: self._reports[row] for row in rows}.values())

    def marks(self, since: float, until: float, robots: Collection[str] = ()) -> TimelineMarks:
        """Return when commands of ``robots``, or all, were sent and ended from ``since`` to ``until``."""
        marks = self._marks.between(since, until)
        return marks.of_robots(set(robots)) if robots else marks


def sort_commands(reports: Sequence[CommandReport]) -> Steps[PastCommands]:
    """Process commands, in steps."""
    reports = sorted((one for one in reports if one.steps), key=requested_at)
    begin, end = [], []
    marks: list[tuple[float, int, int, int]] = []
    for number, report in enumerate(reports):
        if number % AT_ONCE == 0:
            yield number / len(reports)
        begin.append(report.steps[0].at)
        end.append(_ended_at(report))
        for place, step in enumerate(report.steps):
            if not step.state.is_open or step.state is CommandState.QUEUED:
                marks.append((step.at, number, place, _CODES[step.state]))
    return PastCommands(reports, begin, end, _columns(reports, marks))


def _columns(reports: Sequence[CommandReport], marks: list[tuple[float, int, int, int]]) -> TimelineMarks:
    if not marks:
        return NO_MARKS
    table = np.array(marks, dtype=np.float64)
    at, commands, steps, states = table[np.argsort(table[:, 0], kind="stable")].T
    return TimelineMarks(reports, at, *(column.astype(np.intp) for column in (commands, steps, states)))


def _ended_at(report: CommandReport) -> float:
    """Return the time at which a command ended; an abort is never under way."""
    if report.op == Abort.__name__:
        return -np.inf
    return next((step.at for step in report.steps if not step.state.is_open), np.inf)


class CommandSorter(QObject):
    """Processes the command cache in the background, and again when it has changed meanwhile."""

    done = pyqtSignal(object)
    """:attr:`commands` has been replaced: the former ones."""

    def __init__(self, cache: CommandCache, parent: QObject | None = None):
        super().__init__(parent)
        self._cache = cache
        self._slices = CooperativeTask(self)
        self._is_outdated = False
        self.commands = PastCommands()

    @property
    def is_busy(self) -> bool:
        """Whether the present commands are still being processed."""
        return self._slices.is_busy

    def renew(self) -> None:
        """Start updating :attr:`commands` from the cache."""
        # Otherwise changes that come faster than one pass takes would never be seen.
        self._is_outdated = self._slices.is_busy
        if not self._is_outdated:
            self._slices.begin_soon(sort_commands(list(self._cache)), self._apply)

    def forget(self) -> None:
        """Drop all commands."""
        self._slices.stop()
        self.commands = PastCommands()

    def _apply(self, commands: PastCommands) -> None:
        before, self.commands = self.commands, commands
        if self._is_outdated:
            self.renew()
        self.done.emit(before)


SILENT_AFTER = 15.0
"""Seconds between stored positions after which a robot counts as silent: while it is heard, a gateway
stores one at least every ten, unless its site.toml says otherwise."""
_FRESH, _LOST = HISTORY_STATES.index(RobotState.FRESH), HISTORY_STATES.index(RobotState.LOST)


class History:
    """Positions of robots, added page by page, oldest first; each robot has one row in the results."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self._rows: dict[str, int] = {}
        self._pages: list[Numbers] = []
        self._count = 0
        self._sorted: Numbers | None = None
        self._first = np.empty(0, dtype=np.intp)
        self._extents = np.empty((0, 2, 2))

    def __len__(self) -> int:
        return self._count

    @property
    def table(self) -> Numbers:
        """All positions, robot by robot, oldest first: rows of robot's row, time, x, y, theta, v."""
        self._arrange()
        return self._sorted

    @property
    def is_arranged(self) -> bool:
        """Whether :attr:`table` is available at once: sorting a large one would block the window."""
        return self._sorted is not None

    @property
    def extents(self) -> Numbers:
        """Of each robot the least and the greatest x and y of its positions, (n, 2, 2) metres in the order of
        :attr:`names`."""
        self._arrange()
        return self._extents

    def add(self, places: Sequence[Sequence]) -> None:
        """Add places as sent by the gateway: robot, time, x, y, theta, v, and more.

        :raises ValueError: when one of them is invalid.
        """
        if not places:
            return
        try:
            numbers = np.array([place[1:6] for place in places], dtype=np.float64)
            robots = [str(place[0]) for place in places]
        except (TypeError, IndexError) as error:
            raise ValueError(f"a stored position is not one: {error}") from error
        if numbers.shape != (len(places), 5) or not np.isfinite(numbers).all():
            raise ValueError("a stored position has no finite time or place")
        for robot in robots:
            if robot not in self._rows:
                self._rows[robot] = len(self.names)
                self.names.append(robot)
        row = np.array([self._rows[robot] for robot in robots], dtype=np.float64)
        self._pages.append(np.column_stack([row, numbers]))
        self._count += len(places)
        self._sorted = None

    def row(self, robot: str) -> int | None:
        """Return a robot's row, None for one without a position."""
        return self._rows.get(robot)

    def at(self, moment: float) -> RobotArrays:
        """Return every robot as it was at ``moment``, seconds since 1970.

        Between two positions close in time a robot was on the straight line; before its first one it
        has no place; after a longer silence it stays at its last one, lost, with its age.
        """
        table, count = self.table, len(self.names)
        last = self._last_before(moment)
        known = last >= self._first[:count]
        here = np.where(known, last, 0)
        following = np.minimum(here + 1, max(len(table) - 1, 0))
        if count == 0:
            return _arrays(self.names, np.empty((0, 4)), np.empty(0), np.empty(0, dtype=bool))
        now, then = table[here], table[following]
        span = then[:, 1] - now[:, 1]
        joined = (then[:, 0] == now[:, 0]) & (span > 0) & (span <= SILENT_AFTER)
        age = moment - now[:, 1]
        part = np.where(joined, age / np.where(joined, span, 1.0), 0.0)
        turn = np.remainder(then[:, 4] - now[:, 4] + np.pi, 2 * np.pi) - np.pi
        step = np.column_stack([then[:, 2:4] - now[:, 2:4], turn, then[:, 5] - now[:, 5]])
        pose = now[:, 2:6] + step * part[:, None]
        pose[~known] = np.nan
        silent = known & ~joined & (age > SILENT_AFTER)
        # A silent robot does not drive on.
        pose[silent, 3] = 0.0
        return _arrays(self.names, pose, np.where(joined | ~known, 0.0, age), silent | ~known)

    def _arrange(self) -> None:
        if self._sorted is not None:
            return
        whole = np.concatenate(self._pages) if self._pages else np.empty((0, 6))
        # They came oldest first: a stable sort by robots alone takes a tenth of the time, with 16 bits.
        kind = np.uint16 if len(self.names) <= 1 << 16 else np.uint32
        whole = whole[np.argsort(whole[:, 0].astype(kind), kind="stable")]
        self._first = np.searchsorted(whole[:, 0], np.arange(len(self.names) + 1))
        self._extents = _extents(whole, self._first[:-1])
        # Further pages are newer than these of the same robot, so that nothing is stored twice.
        self._pages = [whole]
        self._sorted = whole

    def _last_before(self, moment: float) -> npt.NDArray[np.intp]:
        """Return for each robot the row of its last position up to ``moment``, before its first if none.

        All robots are searched at once: one after the other would take several milliseconds for a thousand.
        """
        times = self.table[:, 1]
        begin, end = self._first[:-1].copy(), self._first[1:].copy()
        while (begin < end).any():
            # Where a search is over, its middle is its end, which may be that of the table.
            middle = np.minimum((begin + end) // 2, len(times) - 1)
            later = (begin >= end) | (times[middle] > moment)
            begin, end = np.where(later, begin, middle + 1), np.where(later, middle, end)
        return begin - 1


def _extents(table: Numbers, first: npt.NDArray[np.intp]) -> Numbers:
    """Return the least and the greatest x and y of each robot, whose rows begin at ``first``, (n, 2, 2)."""
    # Column by column: numpy is slow where it goes along rows of two.
    columns = table[:, 2], table[:, 3]
    ends = [[end.reduceat(column, first) for column in columns] for end in (np.minimum, np.maximum)]
    return np.array(ends).transpose(2, 0, 1)


def _arrays(names: list[str], pose: Numbers, age: Numbers, silent: npt.NDArray[np.bool_]) -> RobotArrays:
    return RobotArrays(
        names=list(names),
        xy=pose[:, :2],
        theta=pose[:, 2],
        v=pose[:, 3],
        accuracy=np.full(len(names), np.nan),
        state=np.where(silent, _LOST, _FRESH).astype(np.intp),
        age=age,
        doubted=np.zeros(len(names), dtype=np.bool_),
    )


PAGE = 1000
"""Positions added at once: a few milliseconds of the window's time."""
MOST = 1_000_000
"""Positions that are kept; with more the rest is left out and that is reported."""
COMMANDS = 1000
"""The newest commands, which the time line shows besides those already known to the desk."""


class HistoryDownload(QObject):
    """Downloads one span after the other; the live link continues beside it."""

    progressed = pyqtSignal()
    ended = pyqtSignal(str)
    """Everything has arrived (an empty text), or not everything, and why."""

    def __init__(self, requests: RequestTracker, parent: QObject | None = None):
        super().__init__(parent)
        self._requests = requests
        self._key = ""
        self._query: GetTrajectory | None = None
        self._task: SortHistoryTask | None = None
        self._text = ""
        """The message when the task has ended well."""
        self.history = History()
        self.reached = 0.0
        """The time of the newest position received."""
        requests.answered.connect(self._answered)

    @property
    def is_busy(self) -> bool:
        """Whether a page is being fetched or sorted."""
        return bool(self._key) or self._task is not None

    def begin(self, since: float, until: float, robots: list[str]) -> None:
        """Fetch positions of ``robots`` (all if empty) from ``since`` to ``until``; forget the former ones.

        :raises NotSentError: when they cannot be requested; the former ones stay.
        """
        query = GetTrajectory(robots=robots, since=since, until=until, limit=PAGE)
        self._requests.inquire(GetCommands(limit=COMMANDS))
        self._key = self._requests.inquire(query)
        self._query = query
        self._drop_task()
        self.history, self.reached = History(), since

    def stop(self) -> None:
        """Stop fetching; the positions received stay."""
        if self._key:
            self._end(tr("Stopped: the rest of the time was not fetched."))

    def forget(self) -> None:
        """Forget everything: it belongs to another site."""
        self._drop_task()
        self._key, self._query, self.history = "", None, History()

    def _answered(self, answer: RequestResult) -> None:
        if not self._key or answer.order.key != self._key:
            return
        if answer.error is not None:
            self._end(tr("The rest of the time was not fetched: {error}", error=answer.error))
            return
        result = answer.result or {}
        places = result.get("places") or []
        try:
            self.history.add(places)
        except ValueError as error:
            self._end(tr("The gateway's answer cannot be used: {error}.", error=error))
            return
        if places:
            self.reached = float(places[-1][1])
        following = result.get("next")
        if not following:
            self._end("")
        elif len(self.history) >= MOST:
            self._end(
                tr(
                    "Only the first {count} positions were fetched. Choose less time, or fewer robots.",
                    count=len(self.history),
                )
            )
        else:
            self._fetch_page(str(following))

    def _fetch_page(self, after: str) -> None:
        query = self._query
        try:
            request = GetTrajectory(query.robots, query.since, query.until, after=after, limit=PAGE)
            self._key = self._requests.inquire(request)
        except FleetError as error:
            self._end(tr("The rest of the time was not fetched: {error}", error=error))
            return
        self.progressed.emit()

    def _end(self, text: str) -> None:
        self._key = ""
        self._drop_task()
        self._text = text
        self._task = SortHistoryTask(self.history)
        self._task.ended.connect(self._arranged)
        QgsApplication.taskManager().addTask(self._task)

    def _arranged(self, task: SortHistoryTask, done: bool) -> None:
        if task is self._task:
            self._task = None
            self.ended.emit(self._text if done else tr("What came could not be put in order."))

    def _drop_task(self) -> None:
        task, self._task = self._task, None
        if task is not None:
            task.cancel()


class SortHistoryTask(SignallingTask):
    """Sorts a history in the background; nobody else accesses it meanwhile."""

    def __init__(self, history: History):
        super().__init__(tr("Putting positions in order"), QgsTask.Flag.CanCancel)
        self._history = history

    def run(self) -> bool:
        return len(self._history.table) == len(self._history)
