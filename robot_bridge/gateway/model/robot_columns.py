"""Robots in columns, to evaluate thousands at once and to apply reports of other gateways at once.

No I/O. The row of a robot of this gateway repeats its :class:`.Robot`. The row of one of another gateway is
the original: :class:`.Robots` makes a :class:`.Robot` of it when one is read.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from ...core.clock import ClockStep
from ...core.messages.base import COORDINATE, SPEED
from ...core.messages.base import THETA as THETA_RANGE
from ...core.messages.robots import SendPos
from ...core.messages.safety import PathDeclaration, RobotState
from .position_checks import STANDING_SPEED

ENDED, LOCATED, ONLY_SEEN, DOUBTED, HEARD_SINCE = 1, 2, 4, 8, 16
"""Flags of a robot: it said Stopped or ended in good order, has reported its position since its Ready, is
only seen, its last reported position is not believed, and it has sent a message since Stopped. Whether its
position is believed is reported with its details."""
REPORTED_FLAGS = ENDED | LOCATED | ONLY_SEEN | HEARD_SINCE
X, Y, THETA, V, POSE_AT, RECEIVED_AT, BATTERY, ACCURACY = range(8)
"""Rows of the table of numbers: x, y (m, site frame), theta (rad), v (m/s), two times by this computer's
clock, battery (0 to 1), and accuracy (m), which other gateways do not report."""
NUMBERS = 8
REPORTED_NUMBERS = 6
"""count of numbers of a robot in a message, the first of those; ages in seconds in place of times."""
_OF_A_POSE = ("x", "y", "theta", "v", "battery", "status")
"""Known fields of the pose of a robot of another gateway."""
STATES = tuple(RobotState)
"""States by their codes."""
_CODES = {state: code for code, state in enumerate(STATES)}
FRESH, STALE, LOST, OFFLINE = (
    _CODES[state] for state in (RobotState.FRESH, RobotState.STALE, RobotState.LOST, RobotState.OFFLINE)
)
_LARGEST = np.array([[COORDINATE[1]], [COORDINATE[1]], [THETA_RANGE[1]], [SPEED[1]]])
_SPARE = 256

Numbers = npt.NDArray[np.float64]
Flags = npt.NDArray[np.uint8]
Rows = npt.NDArray[np.intp]
Counts = npt.NDArray[np.int64]


def liveness(
    age: float, *, ended_in_order: bool, stale_after: float = 3.0, lost_after: float = 10.0
) -> RobotState:
    """Return the state of a robot with a last message ``age`` seconds old.

    ``ended_in_order`` is true when the robot said Stopped and nothing since, or closed its link in good
    order: silence is expected then, so it goes offline where another would be lost.
    """
    if age < stale_after:
        return RobotState.FRESH
    if ended_in_order:
        return RobotState.OFFLINE
    return RobotState.STALE if age < lost_after else RobotState.LOST


def state_codes(
    ages: Numbers, ended_in_order: npt.NDArray[np.bool_], stale_after: float, lost_after: float
) -> Flags:
    """Return the codes of the states of many robots, as :func:`liveness`."""
    silent = np.where(ended_in_order, OFFLINE, np.where(ages < lost_after, STALE, LOST))
    return np.where(ages < stale_after, FRESH, silent).astype(np.uint8)


class ReportedElsewhere(NamedTuple):
    """Report of another gateway on n of its robots.

    ``ids`` (n,) are their numbers in run ``run`` of that gateway; ``names`` are the names of the first of
    them, the others were named before. ``table`` is (n, :data:`REPORTED_NUMBERS`), NaN where there is
    nothing; ``wall`` the time by this computer's clock since which its ages count, and ``flags`` (n,).
    """

    gateway: str
    run: int
    ids: npt.NDArray[np.uint32]
    names: Sequence[str]
    table: npt.NDArray[np.float32]
    flags: Flags
    wall: float

    def only(self, rows: Sequence[int]) -> ReportedElsewhere:
        """Return the part of the report on some of the named robots."""
        names, ids = [self.names[row] for row in rows], self.ids[rows]
        return self._replace(ids=ids, names=names, table=self.table[rows], flags=self.flags[rows])


class DescribedElsewhere(NamedTuple):
    """Details of a robot, reported by another gateway on change, as in a :class:`.Robot` and its pose."""

    battery: float | None
    status: str | None
    doubt: str | None
    latency: float | None
    paths: PathDeclaration | None
    abilities: str | None
    magic: int | None = None


class RobotPlaces(NamedTuple):
    """Positions of n robots: ``table`` is (:data:`NUMBERS`, n), NaN where unknown; the rest (n,)."""

    names: list[str]
    table: Numbers
    states: Flags
    flags: Flags

    def are_placed(self) -> npt.NDArray[np.bool_]:
        """Return for each whether its present position is known: see :attr:`.Robot.is_placed`."""
        placed: npt.NDArray[np.bool_] = (self.flags & (LOCATED | DOUBTED)) == LOCATED
        placed &= self.states == FRESH
        return placed

    def join(self, other: RobotPlaces) -> RobotPlaces:
        """Return these robots followed by the others."""
        return RobotPlaces(
            self.names + other.names,
            np.concatenate([self.table, other.table], axis=1),
            np.concatenate([self.states, other.states]),
            np.concatenate([self.flags, other.flags]),
        )


class ReportedRows(NamedTuple):
    """What other gateways reported last of n robots, ``places`` (n,) among some names.

    ``table`` is (:data:`NUMBERS`, n), the rest (n,): codes of states, the revision of the last change, and
    the one of the last change beyond position and state.
    """

    places: Rows
    table: Numbers
    states: Flags
    revisions: Counts
    described: Counts


class RobotRecord(Protocol):
    """A robot as it is written into a row: see :class:`.Robot`."""

    name: str
    gateway: str | None
    received_at: float
    ended_in_order: bool
    heard_since: bool
    pose: SendPos | None
    pose_at: float | None
    located: bool
    state: RobotState
    doubt: str | None
    abilities: str | None
    revision: int


class Numbering:
    """Rows of robots by the numbers that a run of another gateway gives them."""

    def __init__(self, run: int) -> None:
        self.run = run
        self._rows = np.empty(0, dtype=np.intp)
        self._lives = np.empty(0, dtype=np.int64)
        """-1 for a number that was not named."""

    def name(self, ids: Rows, rows: Rows, lives: Counts) -> None:
        """Record the rows of robots, below 0 where they have none, and in ``lives`` which use of each row it
        is; for those without a row, the number of rows given out so far."""
        self._grow(ids)
        self._rows[ids], self._lives[ids] = rows, lives

    def rows(self, ids: Rows, lives: Counts, given: int) -> tuple[Rows, bool]:
        """Return the rows of robots, below 0 where they have none, and whether each number was named.

        ``lives`` counts by row how often it has been used, ``given`` how many were given out in all.
        """
        try:
            rows, then = self._rows[ids], self._lives[ids]
        except IndexError:
            self._grow(ids)
            rows, then = self._rows[ids], self._lives[ids]
        # A row may have another robot by now; a robot without a row may have got one.
        stale = then != np.where(rows >= 0, lives[rows] if len(lives) else -1, given)
        rows[stale] = -1
        return rows, not stale.any()

    def _grow(self, ids: Rows) -> None:
        """Make room for numbers that are not named yet."""
        missing = int(ids.max(initial=-1)) + 1 - len(self._rows)
        if missing > 0:
            self._rows = np.concatenate([self._rows, np.full(missing + _SPARE, -1, np.intp)])
            self._lives = np.concatenate([self._lives, np.full(missing + _SPARE, -1)])


class Observed(NamedTuple):
    """Outcome of :meth:`RobotColumns.observe`: the newest revision, the named robots without a row, and
    whether all others were named before."""

    revision: int
    missing: list[int]
    all_named: bool


class RobotRows(NamedTuple):
    """Rows of those of some robots that have one, and their ``places`` among all of these; both (n,).

    They hold while the :attr:`~RobotColumns.layout` is the same.
    """

    rows: Rows
    places: Rows
    layout: int


class RobotColumns:
    """Robots by row; the row of a removed robot is used again."""

    def __init__(self) -> None:
        self._rows: dict[str, int] = {}
        self._names: list[str] = []
        self._free: list[int] = []
        self._gateways: dict[str, int] = {}
        self._numberings: dict[str, Numbering] = {}
        self._numbers = np.empty((NUMBERS, 0))
        self._cells: list[Any] = []
        """views of the position columns and of the revisions: faster than arrays to write a single value."""
        self._flags = np.empty(0, dtype=np.uint8)
        self._states = np.empty(0, dtype=np.uint8)
        self._owners = np.empty(0, dtype=np.int32)
        self._revisions = np.empty(0, dtype=np.int64)
        """-1 for a free row."""
        self._described = np.empty(0, dtype=np.int64)
        """the revision of the last change beyond position and state."""
        self._lives = np.empty(0, dtype=np.int64)
        """how often each row has been free."""
        self._given = 0
        """number of rows given to robots so far."""
        self._all: tuple[int, Rows, list[str]] = -1, np.empty(0, np.intp), []
        """the layout, and the rows and names of all robots in it."""
        self.layout = 0
        """number of times that a robot was given a row, or lost it."""

    def __contains__(self, name: str) -> bool:
        return name in self._rows

    def __len__(self) -> int:
        return len(self._rows)

    def names(self) -> list[str]:
        """Return the names of all robots."""
        return list(self._rows)

    # --- One robot ---

    def write(self, robot: RobotRecord) -> None:
        """Write all known data of a robot into its row."""
        row = self._rows.get(robot.name)
        if row is None:
            row = self._new_row(robot.name)
        pose, pose_at = robot.pose, robot.pose_at
        place = (math.nan,) * 4 if pose is None else (pose.x, pose.y, pose.theta, pose.v)
        self._numbers[:BATTERY, row] = *place, math.nan if pose_at is None else pose_at, robot.received_at
        battery, accuracy = (None, None) if pose is None else (pose.battery, pose.accuracy)
        self._numbers[BATTERY:, row] = _number(battery), _number(accuracy)
        self._flags[row] = (
            ENDED * robot.ended_in_order
            | LOCATED * robot.located
            | ONLY_SEEN * (robot.abilities == "")
            | DOUBTED * (robot.doubt is not None)
            | HEARD_SINCE * robot.heard_since
        )
        self._states[row] = _CODES[robot.state]
        self._owners[row] = self._owner(robot.gateway or "")
        self._revisions[row] = self._described[row] = robot.revision

    def move(self, name: str, pose: SendPos, pose_at: float, at: float, revision: int) -> None:
        """Write the pose of a robot with a row at time ``pose_at``, received at ``at``; nothing else."""
        row = self._rows[name]
        x, y, theta, v, pose_times, received_at, revisions = self._cells
        x[row], y[row], theta[row], v[row] = pose.x, pose.y, pose.theta, pose.v
        pose_times[row], received_at[row] = pose_at, at
        revisions[row] = revision

    def remove(self, name: str) -> None:
        """Remove the row of a robot."""
        row = self._rows.pop(name, None)
        if row is not None:
            self._revisions[row] = -1
            self._lives[row] += 1
            self._free.append(row)
            self.layout += 1

    def describe(self, name: str, battery: float | None, flags: int, revision: int) -> None:
        """Write the rarely changing data of a robot with a row; ``flags`` are whether it is only seen, and
        its position not believed."""
        row = self._rows[name]
        self._numbers[BATTERY, row] = math.nan if battery is None else battery
        self._flags[row] = int(self._flags[row]) & (ENDED | LOCATED | HEARD_SINCE) | flags
        self._revisions[row] = self._described[row] = revision

    def find(self, names: Sequence[str]) -> RobotRows:
        """Return the rows of the robots of ``names`` that have one."""
        rows = np.array([self._rows.get(name, -1) for name in names], dtype=np.intp)
        places = np.flatnonzero(rows >= 0)
        return RobotRows(rows[places], places, self.layout)

    def reported(self, robots: RobotRows) -> ReportedRows:
        """Return what is in the rows of ``robots``."""
        rows = robots.rows
        return ReportedRows(
            robots.places,
            self._numbers[:, rows],
            self._states[rows],
            self._revisions[rows],
            self._described[rows],
        )

    def changed_places(self, robots: RobotRows, since: int) -> Rows:
        """Return the ``places`` of those that changed after revision ``since``."""
        return robots.places[self._revisions[robots.rows] > since]

    def has_changed(self, robot: RobotRecord) -> bool:
        """Return whether a robot with a row differs from it."""
        return bool(self._revisions[self._rows[robot.name]] != robot.revision)

    # --- Many ---

    def observe(self, report: ReportedElsewhere, revision: int) -> Observed:
        """Apply the report of a gateway to the robots that are known as its own; each gets a revision after
        ``revision``."""
        rows, all_named = self._rows_of(report)
        # Column by column throughout: row by row takes four times as long.
        columns = report.table.T.astype(np.float64, order="C")
        received = np.isfinite(columns[RECEIVED_AT])
        named = len(report.names)
        missing = np.flatnonzero((rows[:named] < 0) & received[:named]).tolist()
        counts = (rows >= 0) & received
        counts[counts] = self._owners[rows[counts]] == self._owner(report.gateway)
        placed = counts & np.isfinite(columns[POSE_AT])
        placed &= (np.abs(columns[: len(_LARGEST)]) <= _LARGEST).all(axis=0)
        turned = placed & (np.abs(columns[THETA]) > math.pi)
        if turned.any():
            columns[THETA, turned] -= math.tau * np.round(columns[THETA, turned] / math.tau)
        columns[POSE_AT:] = report.wall - columns[POSE_AT:]
        flags = report.flags
        if not placed.all():
            at, places = rows[placed], columns[:RECEIVED_AT, placed]
            rows, columns, flags = rows[counts], columns[:, counts], flags[counts]
        else:
            at, places = rows, columns[:RECEIVED_AT]
        for own, column in zip(self._numbers, places, strict=False):
            own[at] = column
        self._numbers[RECEIVED_AT][rows] = columns[RECEIVED_AT]
        before = self._flags[rows]
        self._flags[rows] = (before & DOUBTED) | (flags & REPORTED_FLAGS)
        newest = self._changed(rows, revision)
        self._described[rows[self._flags[rows] != before]] = newest
        return Observed(newest, missing, all_named)

    def _rows_of(self, report: ReportedElsewhere) -> tuple[Rows, bool]:
        numbering = self._numberings.get(report.gateway)
        if numbering is None or numbering.run != report.run:
            numbering = self._numberings[report.gateway] = Numbering(report.run)
        ids, named = report.ids.astype(np.intp), len(report.names)
        if not named:
            return numbering.rows(ids, self._lives, self._given)
        rows = np.array([self._rows.get(name, -1) for name in report.names], dtype=np.intp)
        lives = np.where(rows >= 0, self._lives[rows] if len(self._lives) else 0, self._given)
        numbering.name(ids[:named], rows, lives)
        others, all_named = numbering.rows(ids[named:], self._lives, self._given)
        return np.concatenate([rows, others]), all_named

    def renew(
        self, robots: Sequence[RobotRecord], details: Mapping[str, tuple[float | None, str | None]]
    ) -> None:
        """Update ``robots`` from their rows; ``details`` are battery and status by name."""
        rows = np.array([self._rows[robot.name] for robot in robots], dtype=np.intp)
        revisions = self._revisions[rows]
        changed = np.flatnonzero(revisions != np.array([robot.revision for robot in robots], np.int64))
        rows = rows[changed]
        columns = (*self._numbers[:BATTERY, rows], self._flags[rows], self._states[rows], revisions[changed])
        values = zip(changed.tolist(), *(column.tolist() for column in columns), strict=True)
        for place, x, y, theta, v, pose_at, received_at, flags, state, revision in values:
            robot = robots[place]
            robot.received_at, robot.state, robot.revision = received_at, STATES[state], revision
            robot.ended_in_order, robot.heard_since = bool(flags & ENDED), bool(flags & HEARD_SINCE)
            robot.located = bool(flags & LOCATED)
            if flags & ONLY_SEEN:
                robot.abilities = ""
            if math.isnan(x):
                robot.pose_at = None
                continue
            robot.pose_at = None if math.isnan(pose_at) else pose_at
            # Rarely changing data are reported separately.
            robot.pose = SendPos.of_checked(
                _OF_A_POSE, (x, y, theta, v, *details.get(robot.name, (None, None)))
            )

    def age(self, now: float, stale_after: float, lost_after: float, revision: int) -> int:
        """Update the states of all to ``now``; return the newest revision after ``revision``."""
        times = self._numbers[RECEIVED_AT]
        np.minimum(times, now, out=times)
        states = self._states_at(now, stale_after, lost_after)
        rows = np.flatnonzero((states != self._states) & (self._revisions >= 0))
        self._states[rows] = states[rows]
        return self._changed(rows, revision)

    def outdated(self, now: float, stale_after: float, lost_after: float) -> list[str]:
        """Return the names of robots with a state that is outdated at ``now``, or last received later."""
        is_outdated = self._states_at(now, stale_after, lost_after) != self._states
        is_outdated |= self._numbers[RECEIVED_AT] > now
        return self._named(np.flatnonzero(is_outdated & (self._revisions >= 0)))

    def driving_unseen(self, since: float) -> list[str]:
        """Return the names of fresh robots that were driving at their last report of a position, at ``since``
        or before. Robots with a doubted position, or none since their Ready, are left out."""
        # A row without a robot, or with a robot without a position, is NaN there.
        unseen = (self._numbers[POSE_AT] <= since) & (np.abs(self._numbers[V]) > STANDING_SPEED)
        unseen &= (self._states == FRESH) & ((self._flags & (LOCATED | ENDED | DOUBTED)) == LOCATED)
        return self._named(np.flatnonzero(unseen & (self._revisions >= 0)))

    def move_times(self, step: ClockStep) -> None:
        """Keep the ages of messages when the clock was set."""
        times = self._numbers[[POSE_AT, RECEIVED_AT]].tolist()
        self._numbers[[POSE_AT, RECEIVED_AT]] = [[step.moved(at) for at in row] for row in times]

    def changed(self, since: int) -> list[str]:
        """Return the names of the robots that changed after revision ``since``."""
        return self._named(np.flatnonzero(self._revisions > since))

    def only_seen(self) -> list[str]:
        """Return the names of the robots that are only seen."""
        return self._named(np.flatnonzero(self._are_only_seen()))

    def count_only_seen(self) -> int:
        """Return the number of robots that are only seen."""
        return int(np.count_nonzero(self._are_only_seen()))

    def _are_only_seen(self) -> npt.NDArray[np.bool_]:
        return ((self._flags & ONLY_SEEN) > 0) & (self._revisions >= 0)

    def places(self, since: int = -1, without: Collection[str] = ()) -> RobotPlaces:
        """Return the positions of robots that changed after ``since``, except of gateways ``without``."""
        if without and self._gateways.keys() <= {*without}:
            # As usual in a fleet, where each gateway judges its own.
            return RobotPlaces([], self._numbers[:, :0], self._states[:0], self._flags[:0])
        rows, names = self._everybody() if since < 0 else (np.flatnonzero(self._revisions > since), None)
        if without:
            left_out = [self._owner(gateway) for gateway in without]
            counts = np.ones(len(self._gateways), dtype=np.bool_)
            counts[left_out] = False
            rows = rows[counts[self._owners[rows]]]
            names = None
        names = self._named(rows) if names is None else names
        return RobotPlaces(names, self._numbers[:, rows], self._states[rows], self._flags[rows])

    def _everybody(self) -> tuple[Rows, list[str]]:
        layout, rows, names = self._all
        if layout != self.layout:
            rows = np.flatnonzero(self._revisions >= 0)
            names = self._named(rows)
            self._all = self.layout, rows, names
        return rows, names

    def _states_at(self, now: float, stale_after: float, lost_after: float) -> Flags:
        ages = now - self._numbers[RECEIVED_AT]
        return state_codes(ages, (self._flags & (ENDED | HEARD_SINCE)) == ENDED, stale_after, lost_after)

    def _named(self, rows: Rows) -> list[str]:
        names = self._names
        return [names[row] for row in rows.tolist()]

    def _changed(self, rows: Rows, revision: int) -> int:
        self._revisions[rows] = np.arange(revision + 1, revision + 1 + len(rows))
        return revision + len(rows)

    def _owner(self, gateway: str) -> int:
        return self._gateways.setdefault(gateway, len(self._gateways))

    def _new_row(self, name: str) -> int:
        if not self._free:
            self._grow()
        row = self._free.pop()
        self._given += 1
        self.layout += 1
        self._rows[name] = row
        self._names[row] = name
        return row

    def _grow(self) -> None:
        have = len(self._names)
        more = max(have, _SPARE)
        self._names += [""] * more
        self._free += range(have + more - 1, have - 1, -1)
        self._numbers = np.concatenate([self._numbers, np.full((NUMBERS, more), np.nan)], axis=1)
        self._flags = np.concatenate([self._flags, np.zeros(more, np.uint8)])
        self._states = np.concatenate([self._states, np.zeros(more, np.uint8)])
        self._owners = np.concatenate([self._owners, np.zeros(more, np.int32)])
        self._revisions = np.concatenate([self._revisions, np.full(more, -1, np.int64)])
        self._described = np.concatenate([self._described, np.full(more, -1, np.int64)])
        self._cells = [memoryview(column) for column in (*self._numbers[:BATTERY], self._revisions)]
        self._lives = np.concatenate([self._lives, np.zeros(more, np.int64)])


def _number(value: float | None) -> float:
    return math.nan if value is None else value
