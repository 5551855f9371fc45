"""Robots as last reported: a table filled by messages, and the robots' state as time passes."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages import positions
from ...robot_bridge.core.messages.positions import FleetView, RobotReport, fleet_view, robot_report
from ...robot_bridge.core.messages.safety import RobotState
from ...robot_bridge.core.position_frame import split_frame

# Ten thousand robots ten times a second are too many for an object each. A snapshot becomes columns on
# the thread of the connection; the window works on whole columns and makes a report only of a robot that
# is being viewed.

STATES = (RobotState.FRESH, RobotState.STALE, RobotState.LOST, RobotState.OFFLINE)
STATE_CODES = {state.value: code for code, state in enumerate(STATES)}
UNSURE = len(STATES)
"""The display state of a robot that is fresh and may not be where it is shown; of others it is the code of
their state."""
LOOKS = (*range(len(STATES)), UNSURE)
WORDED = tuple(name for name in positions.POSITION_TEXTS if name != "state")
COLUMNS = (*positions.POSITION_NUMBERS, *WORDED, "state", "stopped", "received")
"""``state`` is an index into :data:`STATES`, ``received`` is on the monotonic clock, those of :data:`WORDED`
are indices into the words of the table; NaN stands for unknown."""
AT = {name: column for column, name in enumerate(COLUMNS)}
SPARE_WORDS = 1000
"""Words beyond two for each robot before those that no robot uses any more are forgotten."""
_TEXTS_AT = [AT[name] for name in WORDED]

Numbers = npt.NDArray[np.float64]


class RemovedRobots(NamedTuple):
    """Robots that no longer exist, those that are out of view, and (n,) the rows that all these had."""

    names: frozenset[str]
    rows: npt.NDArray[np.intp]
    untracked: frozenset[str] = frozenset()

    @property
    def all_names(self) -> frozenset[str]:
        """Those of which nothing is known from now on, whether or not they exist."""
        return self.names | self.untracked


class RobotTable:
    """The newest values of each robot, one row each. A robot keeps its row until one is removed.

    ``names`` has the n names, no two the same, in a list that is never changed, only replaced; ``numbers`` is
    (len(COLUMNS), n); ``words`` are the texts that it refers to. The table takes ownership of the latter two.
    With ``everything`` there are no other robots; ``removed`` are gone for good. With ``view`` they are those
    of a view: with ``everything`` all others are out of it, as ``untracked`` are.
    """

    def __init__(
        self,
        names: list[str] | None = None,
        numbers: Numbers | None = None,
        words: list[str] | None = None,
        *,
        removed: Iterable[str] = (),
        untracked: Iterable[str] = (),
        everything: bool = False,
        view: FleetView | None = None,
    ) -> None:
        self.removed, self.untracked, self.everything = set(removed), set(untracked), everything
        self.view = view
        self.names = [] if names is None else names
        self._numbers = np.empty((len(COLUMNS), 0)) if numbers is None else numbers
        self._found: tuple[list[str], npt.NDArray[np.intp]] = [], np.empty(0, dtype=np.intp)
        """The names whose rows were needed last, and these rows."""
        self._words = [] if words is None else words
        self._places = dict(zip(self._words, range(len(self._words)), strict=True))

    @cached_property
    def _rows(self) -> dict[str, int]:
        """The row of each robot; most tables are merged into another one without the need for it."""
        return dict(zip(self.names, range(len(self.names)), strict=True))

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: str) -> bool:
        return name in self._rows

    @property
    def tells_nothing(self) -> bool:
        """Whether it is empty."""
        return not (self.names or self.removed or self.untracked or self.everything or self.view)

    def gone_by(self, newer: RobotTable) -> list[int]:
        """Return the rows of the robots that by ``newer`` no longer exist or are out of view."""
        if newer.everything:
            return [row for row, name in enumerate(self.names) if name not in newer]
        gone = newer.removed | newer.untracked
        return sorted(row for name in gone if (row := self.row(name)) is not None)

    def drop(self, rows: Collection[int]) -> None:
        """Remove robots; those below them move up."""
        kept = np.delete(np.arange(len(self)), list(rows))
        self.names = [self.names[row] for row in kept.tolist()]
        self._numbers = self._numbers[:, kept]
        vars(self).pop("_rows", None)
        self._found = [], np.empty(0, dtype=np.intp)

    def column(self, name: str) -> Numbers:
        """Return one of :data:`COLUMNS`, a view that holds until the next :meth:`merge`."""
        return self._numbers[AT[name], : len(self.names)]

    def texts(self, name: str) -> tuple[Numbers, list[str]]:
        """Return one of :data:`WORDED` as (n,) indices of words, NaN where none, and the words."""
        return self.column(name), self._words

    def row(self, name: str) -> int | None:
        """Return the row of robot ``name``, None if nothing is known of it."""
        return self._rows.get(name)

    def row_values(self, row: int) -> dict[str, Any]:
        """Return the last values of the robot in ``row``: the fields of its report, as JSON values."""
        values = zip(COLUMNS, self._numbers[:, row].tolist(), strict=True)
        # NaN is the only value that is not equal to itself.
        found: dict[str, Any] = {name: value for name, value in values if value == value}
        for name in WORDED:
            if name in found:
                found[name] = self._words[int(found[name])]
        del found["received"]
        found["robot"] = self.names[row]
        found["state"] = STATES[int(found["state"])].value
        found["stopped"] = found["stopped"] == 1.0
        return found

    def report(self, row: int) -> RobotReport:
        """Return the last report of the robot in ``row``."""
        return robot_report(self.row_values(row))

    def merge(self, newer: RobotTable) -> RemovedRobots:
        """Take over the rows of ``newer``, which is used up, unless it arrived before the known ones.

        Return the robots that no longer exist, or are out of view.
        """
        rows = self.gone_by(newer)
        names = frozenset(self.names[row] for row in rows)
        removed = names & newer.removed if newer.untracked or newer.view else names
        gone = RemovedRobots(removed, np.array(rows, dtype=np.intp), names - removed)
        if rows:
            self.drop(rows)
        self.view = newer.view if newer.everything or newer.view else self.view
        self.everything |= newer.everything
        self.removed |= newer.removed
        # In place: panning over a large fleet leaves many names behind.
        self.untracked |= newer.untracked
        for away in (self.removed, self.untracked):
            # Searching ten thousand names in an empty table takes as long as all else here.
            if away:
                away.difference_update(newer.names)
        numbers, received = newer._numbers[:, : len(newer)], AT["received"]
        self._use_own_words(numbers, newer._words)
        if newer.names == self.names and (numbers[received] >= self.column("received")).all():
            # The same robots again, as when all drive: no need to search each one's row.
            self.names, self._numbers = newer.names, numbers
        else:
            rows = self._rows_of(newer.names)
            taken = np.flatnonzero(numbers[received] >= self._numbers[received, rows])
            self._numbers[:, rows[taken]] = numbers[:, taken]
        if len(self._words) > SPARE_WORDS + 2 * len(self):
            self._forget_words()
        return gone

    def _use_own_words(self, numbers: Numbers, words: list[str]) -> None:
        """Convert indices of ``words`` to indices of this table's own, to which new ones are added."""
        own = [self._places.setdefault(word, len(self._places)) for word in words]
        self._words += list(self._places)[len(self._words) :]
        # A gateway that reports the same robots again uses the same words.
        if own != list(range(len(own))):
            # Unknown values refer to the last one, which is NaN.
            known = np.array([*own, np.nan])
            places = _places(numbers[_TEXTS_AT], len(words))
            numbers[_TEXTS_AT] = known.take(places)

    def _forget_words(self) -> None:
        """Keep the words that some robot uses."""
        texts = self._numbers[_TEXTS_AT, : len(self)]
        used = np.unique(texts[np.isfinite(texts)]).astype(np.intp)
        words, self._words, self._places = self._words, [], {}
        moved = np.full(len(words) + 1, np.nan)
        moved[used] = np.arange(len(used))
        self._words = [words[place] for place in used.tolist()]
        self._places = dict(zip(self._words, range(len(used)), strict=True))
        self._numbers[_TEXTS_AT, : len(self)] = moved[_places(texts, len(words))]

    def _rows_of(self, names: list[str]) -> npt.NDArray[np.intp]:
        """Return the row of each robot of ``names``; new robots are given one."""
        # Where some robots stand and are not reported, the same others drive in message after message.
        if names != self._found[0]:
            try:
                rows = self._find(names)
            except KeyError:
                # To search for new robots takes as long again, and most messages have none.
                self._add([name for name in names if name not in self._rows])
                rows = self._find(names)
            self._found = names, rows
        return self._found[1]

    def _find(self, names: list[str]) -> npt.NDArray[np.intp]:
        return np.fromiter(map(self._rows.__getitem__, names), dtype=np.intp, count=len(names))

    def _add(self, names: list[str]) -> None:
        """Provide rows for new robots."""
        self._rows.update(zip(names, range(len(self), len(self) + len(names)), strict=True))
        self.names = [*self.names, *names]
        missing = len(self.names) - self._numbers.shape[1]
        if missing > 0:
            more = np.full((len(COLUMNS), max(16, missing, self._numbers.shape[1])), -np.inf)
            self._numbers = np.concatenate([self._numbers, more], axis=1)


def _places(places: Numbers, unknown: int) -> npt.NDArray[np.intp]:
    """Return indices of words, ``unknown`` where there is none."""
    # np.nan_to_num takes several times as long.
    return np.where(np.isnan(places), unknown, places).astype(np.intp)


# --- The table of a message: of columns, or of one JSON object for each robot ---


def removed_robots(params: dict[str, Any]) -> dict[str, Any]:
    """Return the robots removed by a message, and the view of the others, as :class:`RobotTable` takes them.

    An older gateway sends none of that. Raises ValueError where they are invalid.
    """
    everything = params.get("everything", False)
    if not isinstance(everything, bool):
        raise ValueError(f"everything is {everything!r}, neither true nor false")
    gone = {name: check_texts(name, params.get(name, [])) for name in ("removed", "untracked")}
    view = params.get("view")
    return {**gone, "everything": everything, "view": None if view is None else fleet_view(view)}


def check_texts(name: str, values: Any) -> list[str]:
    """Return ``values``, a list of texts; raises ValueError with its ``name`` for anything else."""
    if not isinstance(values, list) or not set(map(type, values)) <= {str}:
        raise ValueError(f"{name} is not a list of texts")
    return values


_KNOWN = {*positions.POSITION_NUMBERS, *positions.POSITION_FLAGS, *positions.POSITION_TEXTS}


def table_from_frame(frame: bytes, received: float) -> RobotTable:
    """Return the robots in one binary frame, all of which arrived at ``received``.

    :raises ValueError: when it is not such a frame, or something in it is invalid.
    :raises KeyError: when the head lacks something.
    """
    params, robots, columns, words, table = split_frame(frame)
    missing = [name for name in positions.POSITION_ALWAYS if name not in columns]
    if missing:
        raise KeyError(missing[0])
    numbers = np.full((len(COLUMNS), len(robots)), np.nan)
    for name, column in zip(columns, table, strict=True):
        if name in _KNOWN:
            _check_column(name, column, robots, len(words))
            numbers[AT[name]] = column
    numbers[AT["state"]] = np.array(_states(words))[numbers[AT["state"]].astype(np.intp)]
    _check_column("state", numbers[AT["state"]], robots, len(STATES))
    numbers[AT["received"]] = received
    return RobotTable(robots, numbers, words, **removed_robots(params))


def _states(words: list[str]) -> list[float]:
    """Return the index of each word in STATES, NaN for an unknown one."""
    return [STATE_CODES.get(word, np.nan) for word in words]


def _check_column(name: str, column: npt.NDArray[np.float64], robots: list[str], words: int) -> None:
    """Raise ValueError unless all values in ``column`` are valid."""
    wrong = np.isinf(column)
    if name in positions.POSITION_ALWAYS:
        wrong |= np.isnan(column)
    if name in positions.POSITION_TEXTS:
        # NaN compares false.
        wrong |= (column < 0) | (column >= words) | (column > np.floor(column))
    if wrong.any():
        row = int(wrong.argmax())
        raise ValueError(f"{name} of robot {robots[row]} is {column[row]}, which it cannot be")


def table_from_rows(
    rows: Sequence[dict[str, Any]], received: float, params: dict[str, Any] | None = None
) -> RobotTable:
    """Return the reports of one message, all of which arrived at ``received``.

    Its ``params`` name the robots that no longer exist.

    :raises ValueError: naming the value and the robot, when a number is not finite or a text is none.
    :raises KeyError: when a report lacks its robot, state, age or link.
    """
    # Of duplicates the last one counts, in the place of the first.
    rows = list({values["robot"]: values for values in rows}.values())
    names = [values["robot"] for values in rows]
    if not all(isinstance(name, str) for name in names):
        raise ValueError("the name of a robot is not a text")
    if not all("link" in values and "age" in values for values in rows):
        raise KeyError("link or age of a robot")
    numbers = np.empty((len(COLUMNS), len(names)))
    words: dict[str | None, float] = {None: np.nan}
    for name in positions.POSITION_NUMBERS:
        numbers[AT[name]] = _numbers_of(name, names, [values.get(name) for values in rows])
    for name in WORDED:
        numbers[AT[name]] = _places_of(name, names, [values.get(name) for values in rows], words)
    numbers[AT["state"]] = [_state_code(values["state"]) for values in rows]
    numbers[AT["stopped"]] = [values.get("stopped", False) is True for values in rows]
    numbers[AT["received"]] = received
    known = [word for word in words if word is not None]
    return RobotTable(names, numbers, known, **removed_robots(params or {}))


def _numbers_of(name: str, names: list[str], values: list[Any]) -> npt.NDArray[np.float64]:
    column = _as_numbers(values, may_miss=name not in positions.POSITION_ALWAYS)
    if column is not None:
        return column
    for robot, value in zip(names, values, strict=True):
        if _as_numbers([value], may_miss=name not in positions.POSITION_ALWAYS) is None:
            raise ValueError(f"{name} of robot {robot} is {value!r}, not a finite number")
    raise AssertionError("each is a number by itself")


def _as_numbers(values: list[Any], *, may_miss: bool) -> npt.NDArray[np.float64] | None:
    """Return finite numbers, NaN for None if ``may_miss``; None when there is anything else among them."""
    kinds = set(map(type, values))
    if not kinds <= {float, int, type(None)}:
        return None
    missing = values.count(None) if type(None) in kinds else 0
    try:
        column = np.array(values, dtype=np.float64)
    except OverflowError:
        return None
    is_right = (may_miss or not missing) and np.isfinite(column).sum() + missing == len(values)
    return column if is_right else None


def _places_of(name: str, names: list[str], values: list[Any], words: dict[str | None, float]) -> list[float]:
    """Return the index of each text in ``words``, to which new ones are added."""
    for robot, value in zip(names, values, strict=True):
        if not isinstance(value, str) and (value is not None or name in positions.POSITION_ALWAYS):
            raise ValueError(f"{name} of robot {robot} is {value!r}, not a text")
    # None is a key as well, so that a new word's index is one less than the length.
    return [words.setdefault(value, len(words) - 1) for value in values]


def _state_code(state: Any) -> int:
    try:
        return STATE_CODES[state]
    except (KeyError, TypeError):
        raise ValueError(f"{state!r} is not a robot's state; known are {', '.join(STATE_CODES)}") from None


# --- The robots as the window knows them ---

_NUMBER = re.compile(r"[0-9]+")
_DIGITS = 20
"""Number of digits up to which numbers within names are compared as numbers."""


def name_order(name: str) -> str:
    """Return the sort key of ``name``; no two names have the same."""
    filled = _NUMBER.sub(lambda number: number[0].zfill(_DIGITS), name.casefold())
    return f"{filled}\0{name}"


_FRESH, _STALE, _LOST, _OFFLINE = range(len(STATES))


@dataclass(frozen=True)
class RobotView:
    """One robot at one moment: its last values, its state now and its age in seconds now."""

    name: str
    values: dict[str, Any]
    state: RobotState
    age: float

    @cached_property
    def report(self) -> RobotReport:
        """The newest report."""
        return robot_report(self.values)

    @property
    def has_pose(self) -> bool:
        """Whether the robot has ever reported its position."""
        return self.values.get("x") is not None and self.values.get("y") is not None

    @property
    def is_doubted(self) -> bool:
        """Whether it may not be where it is shown."""
        return self.values.get("doubt") is not None

    @property
    def shown_as(self) -> int:
        """Its display state: index into :data:`STATES`, or :data:`UNSURE`."""
        return UNSURE if self.is_doubted and self.state is RobotState.FRESH else STATES.index(self.state)


@dataclass(frozen=True)
class RobotArrays:
    """The robots at one moment, as arrays with one row each; a robot keeps its row in one arrangement.

    ``xy`` (n, 2) metres in the site frame, ``theta`` (n,) radians in the site frame, ``v`` (n,) metres per
    second, ``accuracy`` (n,) metres, each NaN where not known; ``state`` (n,) index into :data:`STATES`;
    ``age`` (n,) seconds since the last message; ``doubted`` (n,) whether it may not be where ``xy`` is.
    """

    names: list[str]
    xy: Numbers
    theta: Numbers
    v: Numbers
    accuracy: Numbers
    state: npt.NDArray[np.intp]
    age: Numbers
    doubted: npt.NDArray[np.bool_]

    @cached_property
    def shown_as(self) -> npt.NDArray[np.intp]:
        """(n,) display state of each: index into :data:`STATES`, or :data:`UNSURE`."""
        if not self.doubted.any():
            return self.state
        return np.where(self.doubted & (self.state == _FRESH), UNSURE, self.state)


class RobotStates:
    """The newest values of every robot, aged by this computer's own clock.

    When a gateway falls silent, its robots turn stale and lost here all the same, and stay on the map.
    """

    def __init__(self, stale_after: float = 3.0, lost_after: float = 10.0):
        self.stale_after = stale_after
        self.lost_after = lost_after
        self.generation = 0
        """Counts how often everything was forgotten: rows of another generation are other robots."""
        self.arrangement = 0
        """Counts how often rows were assigned to other robots: all were forgotten, or one was removed."""
        self.revision = 0
        """Counts the updates applied."""
        self.fleet: FleetView | None = None
        """The fleet as a whole, where the desk receives the robots in its view only; None otherwise."""
        self._seen = RobotTable()
        self._by_name: list[int] = []
        self._orders: list[str] = []
        """The sort keys of the robots, by row."""

    def __len__(self) -> int:
        return len(self._seen)

    @property
    def count(self) -> int:
        """Number of robots, including those out of view."""
        return len(self._seen) if self.fleet is None else self.fleet.robots

    def set_limits(self, stale_after: float, lost_after: float) -> None:
        """Set the seconds without a message after which robots count as stale and as lost."""
        self.stale_after, self.lost_after = stale_after, lost_after

    def merge(self, sightings: RobotTable) -> RemovedRobots:
        """Apply newer values; those that arrived before the known ones are ignored.

        Return the robots that no longer exist, or are out of view.
        """
        if sightings.tells_nothing:
            return RemovedRobots(frozenset(), np.empty(0, dtype=np.intp))
        gone = self._seen.merge(sightings)
        if sightings.view is not None or sightings.everything:
            self.fleet = sightings.view
        self.revision += 1
        if len(gone.rows):
            # Computing the sort keys of thousands again takes longer than all else, and robots leave views
            # all the time.
            rows = set(gone.rows.tolist())
            self._orders = [order for row, order in enumerate(self._orders) if row not in rows]
            self._by_name = []
            self.arrangement += 1
        return gone

    def clear(self) -> None:
        """Forget every robot."""
        self._seen = RobotTable()
        self._by_name, self._orders = [], []
        self.fleet = None
        self.generation += 1
        self.arrangement += 1
        self.revision += 1

    def row(self, name: str) -> int | None:
        """Return the row of robot ``name`` in the arrays, None if it is not known."""
        return self._seen.row(name)

    def view(self, name: str, now: float) -> RobotView | None:
        """Return robot ``name`` as displayed at ``now`` (monotonic clock), None if not known."""
        row = self._seen.row(name)
        return None if row is None else self.views(now, [row])[0]

    def views(self, now: float, rows: list[int] | None = None) -> list[RobotView]:
        """Return the robots in ``rows``, or every one by name, as displayed at ``now``."""
        rows = self.by_name() if rows is None else rows
        state, age = self._aged(now, rows)
        return [
            RobotView(self._seen.names[row], self._seen.row_values(row), STATES[code], seconds)
            for row, code, seconds in zip(rows, state.tolist(), age.tolist(), strict=True)
        ]

    def arrays(self, now: float, rows: slice = slice(None)) -> RobotArrays:
        """Return the robots in ``rows`` at ``now``; the position is NaN where never reported."""
        seen = self._seen
        state, age = self._aged(now, rows)
        x = seen.column("x")[rows]
        xy = np.empty((len(x), 2))
        xy[:, 0], xy[:, 1] = x, seen.column("y")[rows]
        return RobotArrays(
            names=seen.names if rows == slice(None) else seen.names[rows],
            xy=xy,
            theta=seen.column("theta")[rows].copy(),
            v=seen.column("v")[rows].copy(),
            accuracy=seen.column("accuracy")[rows].copy(),
            state=state,
            age=age,
            doubted=~np.isnan(seen.column("doubt")[rows]),
        )

    def column(self, name: str) -> Numbers:
        """Return one of :data:`COLUMNS`, (n,), of every robot, NaN where not reported."""
        return self._seen.column(name).copy()

    def texts(self, name: str, rows: slice = slice(None)) -> list[str]:
        """Return the last text ``name`` of the robots in ``rows``, empty where there is none."""
        places, words = self._seen.texts(name)
        # Unknown values refer to the entry behind the last word.
        found = [*words, ""]
        at = _places(places[rows], len(words))
        return [found[place] for place in at.tolist()]

    def says(self, name: str, word: str) -> npt.NDArray[np.bool_]:
        """Return which robots' text ``name`` contains ``word``, in lower case; all contain the empty word."""
        places, words = self._seen.texts(name)
        # Unknown values refer to the entry behind the last word.
        holds = np.array([bool(text) and word in text.casefold() for text in words] + [False])
        return holds[_places(places, len(words))]

    def only_seen(self) -> npt.NDArray[np.bool_]:
        """Return which robots have declared that they accept no commands."""
        places, words = self._seen.texts("abilities")
        return places == words.index("") if "" in words else np.zeros(len(places), dtype=bool)

    def doubts(self) -> dict[int, str]:
        """Return by row the reasons why robots may not be where they are shown."""
        places, words = self._seen.texts("doubt")
        rows = np.flatnonzero(places == places)
        found = places[rows].astype(np.intp).tolist()
        return {row: words[place] for row, place in zip(rows.tolist(), found, strict=True)}

    def doubted(self) -> set[str]:
        """Return the names of those robots."""
        names = self._seen.names
        return {names[row] for row in self.doubts()}

    def row_values(self, row: int) -> dict[str, Any]:
        """Return the last values of the robot in ``row``, as received."""
        return self._seen.row_values(row)

    def by_name(self) -> list[int]:
        """Return every row, in the order of the robots' names."""
        names = self._seen.names
        if len(self._by_name) != len(names):
            self._orders += [name_order(name) for name in names[len(self._orders) :]]
            self._by_name = sorted(range(len(names)), key=self._orders.__getitem__)
        return self._by_name

    def _aged(self, now: float, rows: list[int] | slice) -> tuple[npt.NDArray[np.intp], Numbers]:
        """Return states and ages, as ``gateway.model.robot_columns.liveness`` does for a robot that is not
        expected to be silent."""
        age = self._seen.column("age")[rows] + np.maximum(0.0, now - self._seen.column("received")[rows])
        state = self._seen.column("state")[rows].astype(np.intp)
        silent = np.flatnonzero(~(age < self.stale_after))
        reported, here = state[silent], np.where(age[silent] < self.lost_after, _STALE, _LOST)
        # The gateway knows more than the age: which robots have announced that they would be silent.
        state[silent] = np.where((reported == _LOST) | (reported == _OFFLINE), reported, here)
        return state, age
