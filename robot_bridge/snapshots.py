"""Positions as operators are sent them: what changed, encoded once for all who ask at the same rate."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import msgspec

from .messages import RobotReport
from .robots import Robots

EVERYTHING = -1


_Row = msgspec.defstruct(
    "_Row",
    [
        (f.name, Any) if f.default is not None else (f.name, Any, None)
        for f in dataclasses.fields(RobotReport)
    ],
    omit_defaults=True,
)
"""A report as it is encoded: what is unknown is left out."""


def positions(robots: Sequence[RobotReport]) -> dict[str, Any]:
    """Return reports as the parameters of ``positions`` and the result of ``get_positions``.

    They are for :func:`msgspec.json.encode`, which takes rows twice as fast as dictionaries: thousands of
    them are told every second.
    """
    return {"t": round(time.time(), 3), "robots": [_Row(*vars(robot).values()) for robot in robots]}


class Snapshot(NamedTuple):
    """A ``positions`` notification as a text frame; None where nothing changed up to ``revision``."""

    frame: bytes | None
    revision: int


class Snapshots:
    """Makes the frames. Who misses one is sent everything, which others who missed one are sent too.

    So a hundred operators cost two encodings a tick at most, however slow some of them are.
    """

    def __init__(self, robots: Robots, reports: Callable[[int], list[RobotReport]]) -> None:
        self._robots = robots
        self._reports = reports
        self._made: dict[int, Snapshot] = {}
        self._made_at = EVERYTHING

    def after(self, revision: int) -> Snapshot:
        """Return what changed after ``revision``, an earlier snapshot's or EVERYTHING."""
        now = self._robots.revision
        if now != self._made_at:
            self._made.clear()
            self._made_at = now
        if revision not in self._made:
            self._made[revision] = Snapshot(self._encode(revision), now)
        return self._made[revision]

    def _encode(self, revision: int) -> bytes | None:
        changed = self._reports(revision)
        if not changed:
            return None
        return msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": positions(changed)})


def next_tick(interval: float, now: float | None = None) -> float:
    """Return the seconds to the next tick of ``interval``: the same moments for all who share it."""
    now = time.monotonic() if now is None else now
    return interval - math.fmod(now, interval)
