"""Updates for operators: robots as reports and as tables of numbers, and snapshots of changes."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple, TypeVar

import msgspec
import numpy as np
import numpy.typing as npt

from ...core.clock import Clock
from ...core.messages.positions import (
    PLACE_COLUMNS,
    POSITION_ALWAYS,
    POSITION_TEXTS,
    PositionForm,
    RobotReport,
)
from ...core.position_frame import METHOD, PLACE_VALUE, POSITION_VALUE, packed_frame
from ..model.robots import Robot, Robots

# --- Robots as reports, an object for each; no I/O ---

Report = TypeVar("Report")


def reports_of(robots: Iterable[Robot], now: float, kind: Callable[..., Report]) -> list[Report]:
    """Return ``robots`` as ``kind``, which takes the parameters of a RobotReport by name."""
    return [
        _report(robot, now, kind) if robot.doubt is None else _report_in_doubt(robot, now, kind)
        for robot in robots
    ]


def _report_in_doubt(robot: Robot, now: float, kind: Callable[..., Report]) -> Report:
    # The status has it as well, for desks that do not know the field.
    return _report(robot, now, partial(kind, doubt=robot.doubt), robot.doubt)


def _report(robot: Robot, now: float, kind: Callable[..., Report], doubt: str | None = None) -> Report:
    pose, latency = robot.pose, robot.latency
    if pose is None or robot.pose_at is None:
        return kind(
            robot=robot.name,
            state=robot.state,
            age=_thousandths(now - robot.received_at),
            link=robot.link,
            stopped=robot.ended_in_order,
            status=doubt,
            command=robot.command,
            latency=None if latency is None else round(latency, 4),
            paths=robot.paths,
            abilities=robot.abilities,
        )
    return kind(
        robot=robot.name,
        state=robot.state,
        age=_thousandths(now - robot.received_at),
        link=robot.link,
        stopped=robot.ended_in_order,
        x=pose.x,
        y=pose.y,
        theta=pose.theta,
        accuracy=pose.accuracy,
        altitude=pose.altitude,
        theta_from=pose.theta_from,
        v=pose.v,
        device_time=pose.t,
        fix_time=pose.fix_t,
        pose_age=_thousandths(now - robot.pose_at),
        battery=pose.battery,
        status=pose.status if doubt is None else doubt,
        command=robot.command,
        latency=None if latency is None else round(latency, 4),
        paths=robot.paths,
        abilities=robot.abilities,
    )


def _thousandths(seconds: float) -> float:
    """Return ``seconds``, not below 0, in whole milliseconds; ``round`` takes three times as long."""
    return int(seconds * 1000 + 0.5) / 1000 if seconds > 0 else 0.0


# --- Robots as the table of numbers that :mod:`...core.messages.positions` describes; no I/O ---

_OF_A_ROBOT = {
    "age": "received_at",
    "pose_age": "pose_at",
    **{name: name for name in ("latency", "link", "command", "paths", "abilities", "doubt")},
    "stopped": "ended_in_order",
    "state": "state._value_",
}
_OF_A_POSE = {
    **{name: name for name in ("x", "y", "theta", "v", "battery", "accuracy", "altitude")},
    **{name: name for name in ("status", "theta_from")},
    "device_time": "t",
    "fix_time": "fix_t",
}
"""Columns of a report, and where their values are."""
_AGES = {"age", "pose_age"}
"""Columns of seconds since a time, in whole milliseconds."""
_ROBOT, _POSE = attrgetter(*_OF_A_ROBOT.values()), attrgetter(*_OF_A_POSE.values())
_NOWHERE = (None,) * len(_OF_A_POSE)


def position_table(
    robots: Sequence[Robot], now: float
) -> tuple[dict[str, npt.NDArray[np.float64]], list[str]]:
    """Return the table of ``robots`` at ``now``: (n,) by column, and the words of texts."""
    if not robots:
        return {name: np.empty(0) for name in POSITION_ALWAYS}, []
    facts = zip(*[_ROBOT(robot) for robot in robots], strict=True)
    poses = zip(*[_NOWHERE if robot.pose is None else _POSE(robot.pose) for robot in robots], strict=True)
    by_column = {**dict(zip(_OF_A_ROBOT, facts, strict=True)), **dict(zip(_OF_A_POSE, poses, strict=True))}
    words: dict[str | None, float] = {None: float("nan")}
    columns = {}
    for name, values in by_column.items():
        # Counting None in the columns that nearly all robots have takes longer than reading one value.
        if values[0] is None and values.count(None) == len(values):
            continue
        columns[name] = _places(values, words) if name in POSITION_TEXTS else np.array(values, np.float64)
    for name in columns.keys() & _AGES:
        columns[name] = np.maximum(now - columns[name], 0.0).round(3)
    if "latency" in columns:
        columns["latency"] = np.round(columns["latency"], 4)
    return columns, [word for word in words if word is not None]


def table_frame(
    t: float,
    robots: Sequence[Robot],
    now: float,
    removed: Sequence[str] = (),
    *,
    everything: bool = False,
    form: PositionForm = PositionForm.COLUMNS,
) -> bytes:
    """Return the binary frame of ``robots`` at ``now``, under the gateway's time ``t``.

    With ``everything`` they are all robots; else ``removed`` were removed since the last frame.
    """
    columns, words = position_table(robots, now)
    names = [robot.name for robot in robots]
    return packed_table(t, names, columns, words, form, removed=list(removed), everything=everything)


def packed_table(
    t: float,
    names: Sequence[str],
    columns: dict[str, npt.NDArray[np.float64]],
    words: Sequence[str],
    form: PositionForm,
    **news: Any,
) -> bytes:
    """Return the binary frame of a table by :func:`position_table`; ``news`` are added to its head."""
    value = POSITION_VALUE
    if form is PositionForm.PLACES:
        columns = {name: columns[name] for name in PLACE_COLUMNS if name in columns}
        value = PLACE_VALUE
    params = {"t": t, "robots": names, "columns": list(columns), "words": words, **news}
    text = msgspec.json.encode({"jsonrpc": "2.0", "method": METHOD, "params": params})
    return packed_frame(text, columns.values(), value)


def _places(texts: Sequence[str | None], words: dict[str | None, float]) -> npt.NDArray[np.float64]:
    """Return the index of each text in ``words``, to which new ones are added; NaN for None."""
    if texts.count(texts[0]) == len(texts):
        # Nearly all robots are in one state and on one link.
        return np.full(len(texts), words.setdefault(texts[0], len(words) - 1))
    # None is among them as well, so that a new word's index is one less than the number of words.
    return np.array([words.setdefault(text, len(words) - 1) for text in texts], dtype=np.float64)


# --- Positions sent to operators: changes, encoded once for all desks of the same rate

EVERYTHING = -1
MOST_RATES = 64
"""rates whose last snapshot is kept."""

ReportRow = msgspec.defstruct(
    "ReportRow",
    [
        (f.name, Any) if f.default is not None else (f.name, Any, None)
        for f in dataclasses.fields(RobotReport)
    ],
    omit_defaults=True,
    gc=False,
)
"""A report as encoded: unknown fields are left out, and msgspec makes and writes it several times as fast as
a dataclass. Thousands of them are sent every second."""


def positions(rows: Sequence[Any], removed: Sequence[str] = (), *, everything: bool) -> dict[str, Any]:
    """Return rows as the parameters of ``positions`` and the result of ``get_positions``.

    With ``everything`` they are all robots; else ``removed`` were removed since the last frame.
    """
    message: dict[str, Any] = {"t": round(time.time(), 3), "robots": rows}
    if removed:
        message["removed"] = removed
    return {**message, "everything": True} if everything else message


class Snapshot(NamedTuple):
    """A ``positions`` notification as a frame; None where nothing changed up to ``revision``."""

    frame: bytes | None
    revision: int


class Tick(NamedTuple):
    """A time shared by all desks that are updated every ``interval`` seconds."""

    interval: float
    number: int

    @classmethod
    def last(cls, interval: float, now: float) -> Tick:
        """Return the newest tick at ``now``, seconds of :func:`time.monotonic`."""
        return cls(interval, math.floor(now / interval))

    def following(self, now: float) -> Tick:
        """Return the next tick after ``now``; a timer that fired early counts as on time."""
        return Tick(self.interval, max(self.number, math.floor(now / self.interval)) + 1)

    def wait(self, now: float) -> float:
        """Return the seconds until this tick."""
        return max(0.0, self.number * self.interval - now)


class Snapshots:
    """Makes the frames: at each tick the changes since the one before, or everything for who missed that.

    So a hundred operators at one rate cost two encodings a tick and form at most, however slow some of them
    are. ``clock`` is the one by which robots' messages were received.
    """

    def __init__(self, robots: Robots, clock: Clock) -> None:
        self._robots = robots
        self._clock = clock
        self._made: dict[float, tuple[int, dict[tuple[PositionForm, int], Snapshot]]] = {}

    def after(
        self, revision: int, tick: Tick | None = None, form: PositionForm = PositionForm.ROWS
    ) -> Snapshot:
        """Return the changes after ``revision``, an earlier snapshot's or EVERYTHING.

        The snapshot of a ``tick`` is shared by all its desks; without a tick it is the present state.
        """
        if tick is None:
            return self._make(revision, form)
        number, made = self._made.pop(tick.interval, (tick.number, {}))
        if number != tick.number:
            made = {}
        if (form, revision) not in made:
            made[form, revision] = self._make(revision, form)
        # Clients choose their rates; the least recently used one is dropped.
        self._made[tick.interval] = (tick.number, made)
        if len(self._made) > MOST_RATES:
            del self._made[next(iter(self._made))]
        return made[form, revision]

    def _make(self, revision: int, form: PositionForm) -> Snapshot:
        return Snapshot(self._encoded(revision, form), self._robots.revision)

    def _encoded(self, revision: int, form: PositionForm) -> bytes | None:
        now, changed = self._clock.time(), self._robots.changed(revision)
        everything = revision == EVERYTHING
        removed = [] if everything else self._robots.removed(revision)
        if not (changed or removed or everything):
            return None
        if form is not PositionForm.ROWS:
            return table_frame(round(time.time(), 3), changed, now, removed, everything=everything, form=form)
        rows = reports_of(changed, now, ReportRow)
        params = positions(rows, removed, everything=everything)
        return msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": params})
