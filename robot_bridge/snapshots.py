"""Positions as operators are sent them: what changed, encoded once for all who ask at the same rate."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import msgspec

from .messages import PositionForm, RobotReport
from .position_columns import frame
from .robots import Robots

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
"""A report as it is encoded: what is unknown is left out, and msgspec makes and writes it several times as
fast as a dataclass. Thousands of them are told every second."""


def positions(rows: Sequence[Any], removed: Sequence[str] = (), *, everything: bool) -> dict[str, Any]:
    """Return rows as the parameters of ``positions`` and the result of ``get_positions``.

    With ``everything`` they are all that there are; else ``removed`` are gone since what was told last.
    """
    told: dict[str, Any] = {"t": round(time.time(), 3), "robots": rows}
    if removed:
        told["removed"] = removed
    return {**told, "everything": True} if everything else told


class Snapshot(NamedTuple):
    """A ``positions`` notification as a frame; None where nothing changed up to ``revision``."""

    frame: bytes | None
    revision: int


class Tick(NamedTuple):
    """A moment that all who are told every ``interval`` seconds share."""

    interval: float
    number: int

    @classmethod
    def last(cls, interval: float, now: float) -> Tick:
        """Return the newest tick at ``now``, seconds of :func:`time.monotonic`."""
        return cls(interval, math.floor(now / interval))

    def following(self, now: float) -> Tick:
        """Return the next tick that is still to come; a timer that went off early counts as on time."""
        return Tick(self.interval, max(self.number, math.floor(now / self.interval)) + 1)

    def wait(self, now: float) -> float:
        """Return the seconds until this tick."""
        return max(0.0, self.number * self.interval - now)


class Snapshots:
    """Makes the frames: at each tick what changed since the one before, and everything for who missed that.

    So a hundred operators at one rate cost two encodings a tick and form at most, however slow some of them
    are. ``clock`` is the one by which robots' messages came in.
    """

    def __init__(self, robots: Robots, clock: Callable[[], float]) -> None:
        self._robots = robots
        self._clock = clock
        self._made: dict[float, tuple[int, dict[tuple[PositionForm, int], Snapshot]]] = {}

    def after(
        self, revision: int, tick: Tick | None = None, form: PositionForm = PositionForm.ROWS
    ) -> Snapshot:
        """Return what changed after ``revision``, an earlier snapshot's or EVERYTHING.

        Who asks for the same ``tick`` is told the same; without one it is what is known now.
        """
        if tick is None:
            return self._make(revision, form)
        number, made = self._made.pop(tick.interval, (tick.number, {}))
        if number != tick.number:
            made = {}
        if (form, revision) not in made:
            made[form, revision] = self._make(revision, form)
        # Clients choose their rates; the one that was asked for longest ago is forgotten.
        self._made[tick.interval] = (tick.number, made)
        if len(self._made) > MOST_RATES:
            del self._made[next(iter(self._made))]
        return made[form, revision]

    def _make(self, revision: int, form: PositionForm) -> Snapshot:
        return Snapshot(self._encoded(revision, form), self._robots.revision)

    def _encoded(self, revision: int, form: PositionForm) -> bytes | None:
        now, changed = self._clock(), self._robots.changed(revision)
        everything = revision == EVERYTHING
        removed = [] if everything else self._robots.removed(revision)
        if not (changed or removed or everything):
            return None
        if form is PositionForm.COLUMNS:
            return frame(round(time.time(), 3), changed, now, removed, everything=everything)
        rows = self._robots.rows(now, revision, ReportRow)
        params = positions(rows, removed, everything=everything)
        return msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": params})
