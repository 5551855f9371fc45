"""Noticing that this computer's clock was set, while the gateway goes by it.

A small computer without a battery for its clock begins with a wrong time, set right once it has a network.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from .steady_time import steady_time

LEAST_STEP = 1.0
"""seconds; less is what a clock is corrected by all the time."""


class ClockStep(NamedTuple):
    """The clock was set forward by ``by`` seconds, back where that is negative, after ``since``.

    ``since`` and ``now``, when that was noticed, are by the clock as it is set now.
    """

    by: float
    since: float
    now: float

    def moved(self, at: float) -> float:
        """Return a time that was noted before as the clock would have it now."""
        return at if self.since <= at <= self.now else at + self.by


class ClockWatch:
    """Holds a ``clock``, seconds since 1970, against a ``steady`` one."""

    def __init__(self, clock: Callable[[], float], steady: Callable[[], float] = steady_time) -> None:
        self._clock, self._steady = clock, steady
        self._seen = clock(), steady()

    def look(self) -> ClockStep | None:
        """Return how the clock was set since the last look, None where it was not."""
        (then, steady_then), self._seen = self._seen, (self._clock(), self._steady())
        now, steady_now = self._seen
        passed = steady_now - steady_then
        by = now - then - passed
        return None if abs(by) < LEAST_STEP else ClockStep(by, now - passed, now)
