"""Robots as the gateway reports them: one table of numbers, filled from JSON rows or binary frames."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages import positions
from ...robot_bridge.core.messages.json_values import fleet_view, robot_report
from ...robot_bridge.core.messages.positions import FleetView, RobotReport
from ...robot_bridge.core.messages.safety import RobotState
from ...robot_bridge.core.position_frame import split_frame

# Ten thousand robots ten times a second are too many to make an object of each. A snapshot becomes columns on
# the thread of the connection; the window works on whole columns and makes a report only of the robot that
# somebody looks at.

STATES = (RobotState.FRESH, RobotState.STALE, RobotState.LOST, RobotState.OFFLINE)
WORDED = tuple(name for name in positions.POSITION_TEXTS if name != "state")
COLUMNS = (*positions.POSITION_NUMBERS, *WORDED, "state", "stopped", "received")
"""``state`` is an index into :data:`STATES`, ``received`` is on the monotonic clock, those of :data:`WORDED`
are indices into the words of the table; NaN is what is not known."""
AT = {name: column for column, name in enumerate(COLUMNS)}
SPARE_WORDS = 1000
"""Words beyond two for each robot before those are forgotten that no robot says any more."""
_TEXTS_AT = [AT[name] for name in WORDED]

Numbers = npt.NDArray[np.float64]


class RemovedRobots(NamedTuple):
    """Robots that are there no more, those that are out of view, and (n,) the rows that all these had."""

    names: frozenset[str]
    rows: npt.NDArray[np.intp]
    untracked: frozenset[str] = frozenset()

    @property
    def all_names(self) -> frozenset[str]:
        """Those of whom nothing is known from now on, whether they are there or not."""
        return self.names | self.untracked


class RobotTable:
    """The newest that was told of each robot, one row each. A robot keeps its row until one is removed.

    ``names`` has the n names, no two the same; ``numbers`` is (len(COLUMNS), n); ``words`` are the texts that
    it points at. All are the table's own from then on. With ``everything`` there are no other robots;
    ``removed`` are gone for good. With ``view`` they are those of a view: others than ``everything`` are out
    of it, as ``untracked`` are.
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
        self._rows = dict(zip(self.names, range(len(self.names)), strict=True))
        self._words = [] if words is None else words
        self._places = dict(zip(self._words, range(len(self._words)), strict=True))

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: str) -> bool:
        return name in self._rows

    @property
    def tells_nothing(self) -> bool:
        """Whether there is nothing in it."""
        return not (self.names or self.removed or self.untracked or self.everything or self.view)

    def gone_by(self, newer: RobotTable) -> list[int]:
        """Return the rows of the robots that are there no more or out of view, as ``newer`` tells."""
        if newer.everything:
            return [row for row, name in enumerate(self.names) if name not in newer]
        gone = newer.removed | newer.untracked
        return sorted(row for name in gone if (row := self.row(name)) is not None)

    def drop(self, rows: Collection[int]) -> None:
        """Take robots out; those below them move up."""
        kept = np.delete(np.arange(len(self)), list(rows))
        self.names = [self.names[row] for row in kept.tolist()]
        self._numbers = self._numbers[:, kept]
        self._rows = dict(zip(self.names, range(len(self.names)), strict=True))

    def column(self, name: str) -> Numbers:
        """Return one of :data:`COLUMNS`, a view that holds until the next :meth:`merge`."""
        return self._numbers[AT[name], : len(self.names)]

    def texts(self, name: str) -> tuple[Numbers, list[str]]:
        """Return one of :data:`WORDED` as (n,) places in the words, NaN where none, and the words."""
        return self.column(name), self._words

    def row(self, name: str) -> int | None:
        """Return the row of robot ``name``, None if nothing was told of it."""
        return self._rows.get(name)

    def row_values(self, row: int) -> dict[str, Any]:
        """Return what was told last of the robot in ``row``: what its report holds, as JSON values."""
        values = zip(COLUMNS, self._numbers[:, row].tolist(), strict=True)
        # NaN is the one value that is not equal to itself.
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
        """Return what was told last of the robot in ``row``."""
        return robot_report(self.row_values(row))

    def merge(self, newer: RobotTable) -> RemovedRobots:
        """Take over what is in ``newer``, which is used up, unless it arrived before what is known.

        Return the robots that are there no more, or out of view.
        """
        rows = self.gone_by(newer)
        names = frozenset(self.names[row] for row in rows)
        removed = names & newer.removed if newer.untracked or newer.view else names
        gone = RemovedRobots(removed, np.array(rows, dtype=np.intp), names - removed)
        if rows:
            self.drop(rows)
        self.view = newer.view if newer.everything or newer.view else self.view
        self.everything |= newer.everything
        self.removed = (self.removed | newer.removed).difference(newer.names)
        # In place: who pans over a large fleet leaves many names behind.
        self.untracked |= newer.untracked
        self.untracked.difference_update(newer.names)
        numbers, received = newer._numbers[:, : len(newer)], AT["received"]
        self._say_in_own_words(numbers, newer._words)
        if newer.names == self.names and (numbers[received] >= self.column("received")).all():
            # Everything again, as when all robots drive: no need to look for each one's row.
            self._numbers = numbers
        else:
            rows = self._rows_of(newer.names)
            taken = np.flatnonzero(numbers[received] >= self._numbers[received, rows])
            self._numbers[:, rows[taken]] = numbers[:, taken]
        if len(self._words) > SPARE_WORDS + 2 * len(self):
            self._forget_words()
        return gone

    def _say_in_own_words(self, numbers: Numbers, words: list[str]) -> None:
        """Make places in ``words`` places in this table's own, which grow by those that are new."""
        own = [self._places.setdefault(word, len(self._places)) for word in words]
        self._words += list(self._places)[len(self._words) :]
        # A gateway that tells of the same robots again does so in the same words.
        if own != list(range(len(own))):
            # What is not known points at the last one, which is none.
            known = np.array([*own, np.nan])
            places = np.nan_to_num(numbers[_TEXTS_AT], nan=len(words)).astype(np.intp)
            numbers[_TEXTS_AT] = known.take(places)

    def _forget_words(self) -> None:
        """Keep the words that some robot says."""
        texts = self._numbers[_TEXTS_AT, : len(self)]
        used = np.unique(texts[np.isfinite(texts)]).astype(np.intp)
        words, self._words, self._places = self._words, [], {}
        moved = np.full(len(words) + 1, np.nan)
        moved[used] = np.arange(len(used))
        self._words = [words[place] for place in used.tolist()]
        self._places = dict(zip(self._words, range(len(used)), strict=True))
        self._numbers[_TEXTS_AT, : len(self)] = moved[np.nan_to_num(texts, nan=len(words)).astype(np.intp)]

    def _rows_of(self, names: list[str]) -> npt.NDArray[np.intp]:
        known = self._rows
        for name in names:
            if name not in known:
                known[name] = len(self.names)
                self.names.append(name)
        missing = len(self.names) - self._numbers.shape[1]
        if missing > 0:
            more = np.full((len(COLUMNS), max(16, missing, self._numbers.shape[1])), -np.inf)
            self._numbers = np.concatenate([self._numbers, more], axis=1)
        return np.fromiter(map(known.__getitem__, names), dtype=np.intp, count=len(names))


def removed_robots(params: dict[str, Any]) -> dict[str, Any]:
    """Return who is gone, by a message, and what is known of the others, as :class:`RobotTable` has them.

    An older gateway tells nothing of that. Raises ValueError where they are not what they have to be.
    """
    everything = params.get("everything", False)
    if not isinstance(everything, bool):
        raise ValueError(f"everything is {everything!r}, neither true nor false")
    gone = {name: check_texts(name, params.get(name, [])) for name in ("removed", "untracked")}
    view = params.get("view")
    return {**gone, "everything": everything, "view": None if view is None else fleet_view(view)}


def check_texts(name: str, values: Any) -> list[str]:
    """Return ``values``, a list of texts; raises ValueError, with its ``name``, for anything else."""
    if not isinstance(values, list) or not set(map(type, values)) <= {str}:
        raise ValueError(f"{name} is not a list of texts")
    return values


_STATE_CODES = {state.value: code for code, state in enumerate(STATES)}


def table_from_rows(
    rows: Sequence[dict[str, Any]], received: float, params: dict[str, Any] | None = None
) -> RobotTable:
    """Return the reports of one message, all of which arrived at ``received``.

    Its ``params`` tell which robots are there no more.

    :raises ValueError: when a number is none, or not finite, or a text is none; it names it and the robot.
    :raises KeyError: when a report lacks its robot, state, age or link.
    """
    # What is told twice counts as told last, in the place where it was told first.
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
    """Return finite numbers, and NaN for None where they may miss; None when anything else is among them."""
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
    """Return the place of each text among ``words``, which grow by those that are new."""
    for robot, value in zip(names, values, strict=True):
        if not isinstance(value, str) and (value is not None or name in positions.POSITION_ALWAYS):
            raise ValueError(f"{name} of robot {robot} is {value!r}, not a text")
    # None is among them as well, so that a new word's place is one less than how many there are.
    return [words.setdefault(value, len(words) - 1) for value in values]


def _state_code(state: Any) -> int:
    try:
        return _STATE_CODES[state]
    except (KeyError, TypeError):
        raise ValueError(f"{state!r} is not a robot's state; known are {', '.join(_STATE_CODES)}") from None


_KNOWN = {*positions.POSITION_NUMBERS, *positions.POSITION_FLAGS, *positions.POSITION_TEXTS}


def table_from_frame(frame: bytes, received: float) -> RobotTable:
    """Return the robots in one binary frame, all of which arrived at ``received``.

    :raises ValueError: when it is not such a frame, or something in it is not what it has to be.
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
    """Return which of STATES each word is, NaN for one that is none."""
    return [_STATE_CODES.get(word, np.nan) for word in words]


def _check_column(name: str, column: npt.NDArray[np.float64], robots: list[str], words: int) -> None:
    """Raise ValueError unless everything in ``column`` can be what it has to be."""
    wrong = np.isinf(column)
    if name in positions.POSITION_ALWAYS:
        wrong |= np.isnan(column)
    if name in positions.POSITION_TEXTS:
        # What is NaN compares false.
        wrong |= (column < 0) | (column >= words) | (column > np.floor(column))
    if wrong.any():
        row = int(wrong.argmax())
        raise ValueError(f"{name} of robot {robots[row]} is {column[row]}, which it cannot be")
