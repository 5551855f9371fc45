"""Views of a fleet too large to send to a desk as a whole: the robots in a view, or their density.

The positions of all robots are read twice a second for all desks together, the row of a robot is made once
for all desks that see it, and the robots in each cell are counted once. So another desk costs what it is
sent, and the size of the fleet costs the gateway and no desk.
"""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Collection, Sequence
from itertools import islice
from typing import Any, NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt

from ...core.clock import Clock
from ...core.messages.positions import (
    MOST_ALARMED,
    MOST_CELLS,
    POSITION_ALWAYS,
    POSITION_FLAGS,
    POSITION_NUMBERS,
    POSITION_TEXTS,
    AlarmLimits,
    Density,
    FindRobots,
    FleetView,
    FoundRobots,
    GetPositions,
    PositionForm,
    Positions,
    View,
)
from ..model.events import Encoded, handles
from ..model.robot_columns import (
    ACCURACY,
    BATTERY,
    DOUBTED,
    LOST,
    POSE_AT,
    RECEIVED_AT,
    STATES,
    THETA,
    ReportedRows,
    V,
    X,
    Y,
)
from ..model.robots import Robot, Robots, RobotSelection
from ..site.places import Ground
from .operator_updates import EVERYTHING, ReportRow, packed_table, position_table, positions, reports_of

PLACES_EVERY_S = 0.5
"""Age that the positions of all robots may have: a robot that enters a view is sent that much later."""
PLACES_PART = 0.1
"""Share of the gateway's time for reading the positions; in large fleets they are read less often."""
DENSE_UNTIL = 0.9
"""Share of the most robots in a view down to which a density is kept, as hysteresis against flicker."""
SPARE = 1000

Floats = npt.NDArray[np.float64]
Bounds = tuple[float, float, float, float]

# --- Positions of all robots at one moment, as arrays ---

_STATES = tuple(state.value for state in STATES)
_GROUPS = np.array([{"fresh": 0, "offline": 2}.get(state, 1) for state in _STATES])
"""Group of each state: fresh, silent or offline."""


class FleetPlaces:
    """All robots at one moment; results are computed once. ``bounds`` are the site's."""

    def __init__(self, robots: Robots, bounds: Bounds) -> None:
        places = robots.places()
        self.names, self._codes, self._bounds = places.names, places.states, bounds
        self._disbelieved = (places.flags & DOUBTED) > 0
        self._x, self._y, self._battery, self._accuracy = places.table[[X, Y, BATTERY, ACCURACY]]
        self.counts = dict(zip(_STATES, np.bincount(self._codes, minlength=4).tolist(), strict=True))
        self._alarmed: dict[AlarmLimits, tuple[list[str], int]] = {}
        self._grid: DensityGrid | None = None

    def inside(self, bounds: Bounds) -> list[int]:
        """Return the rows of the robots within ``bounds``."""
        x_min, y_min, x_max, y_max = bounds
        x, y = self._x, self._y
        within = (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max)
        rows: list[int] = np.flatnonzero(within).tolist()
        return rows

    def alarmed(self, limits: AlarmLimits) -> tuple[list[str], int]:
        """Return the first :data:`MOST_ALARMED` robots with an alarm, and the number of those with one."""
        if limits not in self._alarmed:
            rows = np.flatnonzero(self._are_alarmed(limits))
            first = [self.names[row] for row in rows[:MOST_ALARMED].tolist()]
            self._alarmed[limits] = first, len(rows)
        return self._alarmed[limits]

    def density(self, bounds: Bounds) -> Density:
        """Return the number of robots in each cell of a grid over ``bounds``."""
        if self._grid is None:
            self._grid = DensityGrid(self._x, self._y, _GROUPS[self._codes])
        return self._grid.over(bounds)

    def _are_alarmed(self, limits: AlarmLimits) -> npt.NDArray[np.bool_]:
        # Unknown values are NaN, and compare false.
        found: npt.NDArray[np.bool_] = (self._codes == LOST) | self._disbelieved
        if limits.low_battery is not None:
            found |= self._battery < limits.low_battery
        if limits.unsure is not None:
            found |= self._accuracy >= limits.unsure
        if limits.outside is not None:
            x_min, y_min, x_max, y_max = self._bounds
            margin = limits.outside
            found |= (self._x < x_min - margin) | (self._x > x_max + margin)
            found |= (self._y < y_min - margin) | (self._y > y_max + margin)
        return found


# --- Density of robots: one fine grid of all, and coarser ones as its sums ---

BASE_CELLS = 512
"""Cells of the finest grid of all robots along an axis, at most."""


class Cells(NamedTuple):
    """Part of the grid with cells of 2**``level`` m: its first cell, from the origin, and its size."""

    level: int
    column: int
    row: int
    columns: int
    rows: int

    @classmethod
    def over(cls, bounds: Bounds, most: int, level: int = 0) -> Cells:
        """Return the smallest cells of which at most ``most`` an axis cover ``bounds``."""
        x_min, y_min, x_max, y_max = bounds
        while True:
            size = 2.0**level
            column, row = math.floor(x_min / size), math.floor(y_min / size)
            columns, rows = math.floor(x_max / size) - column + 1, math.floor(y_max / size) - row + 1
            if max(columns, rows) <= most:
                return cls(level, column, row, columns, rows)
            level += 1


class DensityGrid:
    """Number of robots in each cell; ``x`` and ``y`` (n,), metres, and ``groups`` (n,), 0, 1 or 2."""

    def __init__(self, x: Floats, y: Floats, groups: npt.NDArray[np.intp]) -> None:
        placed = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
        self._x, self._y, self._groups = x[placed], y[placed], groups[placed]
        self._levels: list[tuple[Cells, npt.NDArray[np.intp]]] = []
        """Each twice as coarse as the one before."""
        if len(placed):
            x_min, x_max = float(self._x.min()), float(self._x.max())
            y_min, y_max = float(self._y.min()), float(self._y.max())
            base = Cells.over((x_min, y_min, x_max, y_max), BASE_CELLS)
            self._levels.append((base, self._counted(base)))
        self._made: dict[Cells, Density] = {}

    def over(self, bounds: Bounds) -> Density:
        """Return the density over ``bounds``; the same object for all views of the same cells."""
        cells = Cells.over(bounds, MOST_CELLS)
        if cells not in self._made:
            self._made[cells] = _density(cells, self._counts(cells))
        return self._made[cells]

    def _counts(self, cells: Cells) -> npt.NDArray[np.intp]:
        """Return (3, rows, columns) the number of robots of each group in each of ``cells``."""
        counts = np.zeros((3, cells.rows, cells.columns), dtype=np.intp)
        if not self._levels:
            return counts
        base = self._levels[0][0].level
        if cells.level < base:
            return self._counted(cells)
        while len(self._levels) <= cells.level - base:
            self._levels.append(_halved(*self._levels[-1]))
        have, counted = self._levels[cells.level - base]
        (here, there), (in_here, in_there) = (
            _shared(cells.row, cells.rows, have.row, have.rows),
            _shared(cells.column, cells.columns, have.column, have.columns),
        )
        counts[:, here, in_here] = counted[:, there, in_there]
        return counts

    def _counted(self, cells: Cells) -> npt.NDArray[np.intp]:
        size = 2.0**cells.level
        column = np.floor(self._x / size) - cells.column
        row = np.floor(self._y / size) - cells.row
        inside = np.flatnonzero((column >= 0) & (column < cells.columns) & (row >= 0) & (row < cells.rows))
        places = (self._groups[inside] * cells.rows + row[inside].astype(np.intp)) * cells.columns
        places += column[inside].astype(np.intp)
        counted = np.bincount(places, minlength=3 * cells.rows * cells.columns)
        return counted.reshape(3, cells.rows, cells.columns)


def _halved(cells: Cells, counts: npt.NDArray[np.intp]) -> tuple[Cells, npt.NDArray[np.intp]]:
    """Return the next coarser grid: each of its cells is the sum of four."""
    row, column = cells.row // 2, cells.column // 2
    rows = (cells.row + cells.rows + 1) // 2 - row
    columns = (cells.column + cells.columns + 1) // 2 - column
    whole = np.zeros((3, 2 * rows, 2 * columns), dtype=np.intp)
    down, right = cells.row - 2 * row, cells.column - 2 * column
    whole[:, down : down + cells.rows, right : right + cells.columns] = counts
    sums = whole.reshape(3, rows, 2, columns, 2).sum(axis=(2, 4))
    return Cells(cells.level + 1, column, row, columns, rows), sums


def _shared(first: int, count: int, other: int, others: int) -> tuple[slice, slice]:
    """Return the overlap of two ranges, given by first and count: as a slice of each."""
    begin, end = max(first, other), min(first + count, other + others)
    end = max(begin, end)
    return slice(begin - first, end - first), slice(begin - other, end - other)


def _density(cells: Cells, counts: npt.NDArray[np.intp]) -> Density:
    size = 2.0**cells.level
    flat = counts.reshape(3, -1)
    full = np.flatnonzero(flat.any(axis=0))
    fresh, silent, offline = flat[:, full].tolist()
    return Density(
        size,
        cells.column * size,
        cells.row * size,
        cells.columns,
        cells.rows,
        full.tolist(),
        fresh,
        silent,
        offline,
    )


# --- Rows of the table of robots, each made once for all desks that see its robot ---

_COLUMNS = (*POSITION_NUMBERS, *POSITION_FLAGS, *POSITION_TEXTS)
_AT = {name: place for place, name in enumerate(_COLUMNS)}
_TEXTS_AT = [_AT[name] for name in POSITION_TEXTS]
_AGES = {"age": ("received_at", RECEIVED_AT), "pose_age": ("pose_at", POSE_AT)}
"""Where the times are of a robot of this gateway, and in the numbers that others report."""
_MOVING = {"x": X, "y": Y, "theta": THETA, "v": V}


class RowStore:
    """The newest row of each robot that a desk sees; made again when its robot has changed."""

    def __init__(self, robots: Robots) -> None:
        self._robots = robots
        self._forget()

    def table(self, names: Sequence[str], now: float) -> tuple[dict[str, Floats], list[str]]:
        """Return the table of existing robots as :func:`position_table`."""
        if not names:
            return {name: np.empty(0) for name in POSITION_ALWAYS}, []
        if len(self._words) > SPARE + 2 * len(self._rows) or len(self._rows) > SPARE + 4 * len(names):
            # Words that no robot uses any more, and robots that no desk sees.
            self._forget()
        rows = self._rows_of(names)
        reported = self._robots.reported(names)
        is_own = np.ones(len(names), dtype=np.bool_)
        is_own[reported.places] = False
        own = self._robots.known(names[place] for place in np.flatnonzero(is_own).tolist())
        self._write_changed(rows[is_own], own, now)
        if len(reported.places):
            self._update(rows[reported.places], names, reported, now)
        table = self._table[:, rows]
        for name, (since, number) in _AGES.items():
            times = np.empty(len(names))
            times[is_own] = np.array([getattr(robot, since) for robot in own], np.float64)
            times[reported.places] = reported.table[number]
            table[_AT[name]] = np.maximum(now - times, 0.0).round(3)
        words = self._own_words(table)
        known = ~np.isnan(table).all(axis=1)
        return {name: table[place] for name, place in _AT.items() if known[place]}, words

    def _forget(self) -> None:
        self._rows: dict[str, int] = {}
        self._revisions = np.empty(0, np.int64)
        self._described = np.empty(0, np.int64)
        """the revisions of robots when their row was last changed, and when it was last made as a whole."""
        self._table = np.empty((len(_COLUMNS), 0))
        self._words: dict[str, int] = {}

    def _rows_of(self, names: Sequence[str]) -> npt.NDArray[np.intp]:
        known = self._rows
        rows = np.array([known.setdefault(name, len(known)) for name in names], np.intp)
        missing = len(known) - len(self._revisions)
        if missing > 0:
            more = max(missing, len(self._revisions))
            self._revisions = np.concatenate([self._revisions, np.full(more, -1)])
            self._described = np.concatenate([self._described, np.full(more, -1)])
            self._table = np.concatenate([self._table, np.full((len(_COLUMNS), more), np.nan)], axis=1)
        return rows

    def _update(
        self, rows: npt.NDArray[np.intp], names: Sequence[str], reported: ReportedRows, now: float
    ) -> None:
        """Update the rows of robots of other gateways: of most only position and state have changed."""
        is_whole = self._described[rows] >= reported.described
        # With its first position a robot has a battery and a status, too.
        is_whole &= ~np.isnan(self._table[_AT["x"], rows])
        others = reported.places[~is_whole].tolist()
        self._write_changed(rows[~is_whole], self._robots.known(names[place] for place in others), now)
        moved = np.flatnonzero(is_whole & (self._revisions[rows] != reported.revisions))
        if not len(moved):
            return
        at = rows[moved]
        for name, number in _MOVING.items():
            self._table[_AT[name]][at] = reported.table[number][moved]
        words = np.array([self._words.setdefault(word, len(self._words)) for word in _STATES], np.float64)
        self._table[_AT["state"]][at] = words[reported.states[moved]]
        self._revisions[at] = reported.revisions[moved]

    def _write_changed(self, rows: npt.NDArray[np.intp], robots: Sequence[Robot], now: float) -> None:
        revisions = np.array([robot.revision for robot in robots], np.int64)
        changed = np.flatnonzero(self._revisions[rows] != revisions)
        if not len(changed):
            return
        at, robots = rows[changed], [robots[place] for place in changed.tolist()]
        columns, words = position_table(robots, now)
        own = np.array([self._words.setdefault(word, len(self._words)) for word in words], np.float64)
        fresh = np.full((len(_COLUMNS), len(robots)), np.nan)
        for name, values in columns.items():
            if name in POSITION_TEXTS:
                known = ~np.isnan(values)
                fresh[_AT[name], known] = own[values[known].astype(np.intp)]
            else:
                fresh[_AT[name]] = values
        self._table[:, at] = fresh
        self._revisions[at] = self._described[at] = revisions[changed]

    def _own_words(self, table: Floats) -> list[str]:
        """Return the words that ``table`` uses, and renumber its texts to them."""
        texts = table[_TEXTS_AT]
        known = ~np.isnan(texts)
        places = texts[known].astype(np.intp)
        used = np.zeros(len(self._words), dtype=np.bool_)
        used[places] = True
        texts[known] = (np.cumsum(used) - 1)[places]
        table[_TEXTS_AT] = texts
        words = list(self._words)
        return [words[place] for place in np.flatnonzero(used).tolist()]


# --- The views of all desks ---


class FleetViews:
    """Shared data of the views of all desks, and the search for robots by name."""

    def __init__(self, robots: Robots, site: Ground, clock: Clock) -> None:
        self.robots = robots
        self.clock = clock
        self.rows = RowStore(robots)
        self._site = site
        self._places: FleetPlaces | None = None
        self._due_at = -math.inf

    def places(self) -> FleetPlaces:
        """Return all positions of at most :data:`PLACES_EVERY_S` ago, in large fleets a little longer."""
        now = self.clock.steady()
        if self._places is None or now >= self._due_at:
            began = time.perf_counter()
            self._places = FleetPlaces(self.robots, self._site.report.bounds)
            took = time.perf_counter() - began
            self._due_at = now + max(PLACES_EVERY_S, took / PLACES_PART)
        return self._places

    @handles(GetPositions)
    async def now(self, request: GetPositions) -> Encoded[Positions]:
        """Return the present positions of all robots, or the content of a view."""
        if request.view is not None:
            return Encoded(ViewWatch(self, request.view, 1.0, PositionForm.ROWS).everything())
        rows = reports_of(self.robots.changed(EVERYTHING), self.clock.time(), ReportRow)
        return Encoded(positions(rows, everything=True))

    @handles(FindRobots)
    async def find(self, request: FindRobots) -> Encoded[FoundRobots]:
        """Return the robots with names that contain a text, or equal it, by name."""
        text, known = request.text.lower(), self.robots.names()
        if request.whole:
            names = [name for name in known if name.lower() == text]
        else:
            names = [name for name in known if text in name.lower()]
        page = islice((name for name in names if name > request.after), request.limit)
        rows = reports_of(self.robots.known(page), self.clock.time(), ReportRow)
        return Encoded({"t": round(time.time(), 3), "robots": rows, "count": len(names)})


class ViewWatch:
    """State of one desk's view: what was sent to it, and what must be sent next."""

    def __init__(self, views: FleetViews, view: View, rate: float, form: PositionForm) -> None:
        self.rate, self.form = rate, form
        self.changed = asyncio.Event()
        """set when the desk shows another view."""
        self._views = views
        self._view = view
        self._places: FleetPlaces | None = None
        """positions by which the robots to be sent were chosen."""
        self._chosen: list[str] = []
        self._selection: RobotSelection | None = None
        """selection of the chosen robots; None once others were chosen."""
        self._is_dense = False
        self._sent: set[str] = set()
        self._seen = EVERYTHING
        self._seen_view: FleetView | None = None

    def show(self, view: View) -> None:
        """Show another view from now on."""
        self._view, self._places = view, None
        self.changed.set()

    def next_frame(self) -> bytes | None:
        """Return the frame with the changes since the last one; None without any."""
        robots, seen, sent = self._views.robots, self._seen, self._sent
        fleet = self._choose()
        news: dict[str, Any] = {}
        removed = [] if seen == EVERYTHING else [name for name in robots.removed(seen) if name in sent]
        fresh: list[str] = []
        selection = self._selection
        if selection is None or robots.is_outdated(selection):
            self._selection = selection = robots.select(self._chosen)
            self._sent = set(selection.names)
            fresh = [name for name in selection.names if name not in sent]
            if untracked := sorted(sent - self._sent - set(removed)):
                news["untracked"] = untracked
        met = set(fresh)
        fresh += [name for name in robots.changed_of(selection, seen) if name not in met]
        if fleet != self._seen_view:
            news["view"] = _known_fields(fleet)
        self._seen, self._seen_view = robots.revision, fleet
        if not (fresh or removed or news):
            return None
        return self._encoded(fresh, removed, news, everything=seen == EVERYTHING)

    def everything(self) -> dict[str, Any]:
        """Return the whole content of the view now, as the result of ``get_positions``."""
        fleet = self._choose()
        there = self._views.robots.known(self._chosen)
        rows = reports_of(there, self._views.clock.time(), ReportRow)
        return {**positions(rows, everything=True), "view": _known_fields(fleet)}

    def _choose(self) -> FleetView:
        """Choose the robots to send, when the positions were read again or the view was changed."""
        places = self._views.places()
        if places is self._places and self._seen_view is not None:
            return self._seen_view
        self._places, view = places, self._view
        rows = places.inside(view.bounds)
        self._is_dense = len(rows) > view.most * (DENSE_UNTIL if self._is_dense else 1.0)
        alarmed, alarms = places.alarmed(view.alarms)
        one_by_one = [] if self._is_dense else [places.names[row] for row in rows]
        chosen = list(dict.fromkeys([*view.always, *alarmed, *one_by_one]))
        if chosen != self._chosen:
            self._chosen, self._selection = chosen, None
        return FleetView(
            robots=len(places.names),
            **places.counts,
            inside=len(rows),
            alarmed=alarms,
            density=places.density(view.bounds) if self._is_dense else None,
        )

    def _encoded(
        self, names: Sequence[str], removed: Collection[str], news: dict[str, Any], *, everything: bool
    ) -> bytes:
        now, t = self._views.clock.time(), round(time.time(), 3)
        if self.form is PositionForm.ROWS:
            rows = reports_of(self._views.robots.known(names), now, ReportRow)
            params = {**positions(rows, list(removed), everything=everything), **news}
            return msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": params})
        columns, words = self._views.rows.table(names, now)
        news = {"removed": list(removed), "everything": everything, **news}
        return packed_table(t, names, columns, words, self.form, **news)


def _known_fields(fleet: FleetView) -> dict[str, Any]:
    return {name: value for name, value in vars(fleet).items() if value is not None}
