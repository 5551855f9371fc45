"""Clocks: replaceable in tests and simulations; detection of standstills, clock steps and wrong clocks."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from typing import NamedTuple

_COUNTS_SLEEP: int | None = getattr(time, "CLOCK_BOOTTIME", getattr(time, "CLOCK_MONOTONIC", None))
"""On Linux only the first counts sleep, on macOS the second does, unlike Python's own clock; Windows has
neither, and its clock for :func:`time.monotonic` counts sleep."""


def steady_time() -> float:
    """Return the seconds of a clock that is never set and counts sleep; only differences are meaningful."""
    return time.monotonic() if _COUNTS_SLEEP is None else time.clock_gettime(_COUNTS_SLEEP)


class Clock:
    """The system's clocks, in seconds."""

    def time(self) -> float:
        """Return the seconds since the Unix epoch, UTC; it jumps when the computer's clock is set."""
        return time.time()

    def steady(self) -> float:
        """Return :func:`steady_time`."""
        return steady_time()


SYSTEM_CLOCK = Clock()


@dataclass
class ManualClock(Clock):
    """Clocks that stand until they are moved: ``wall`` is :meth:`time`, ``uptime`` is :meth:`steady`."""

    wall: float = 1_700_000_000.0
    uptime: float = 0.0

    def time(self) -> float:
        """Return ``wall``."""
        return self.wall

    def steady(self) -> float:
        """Return ``uptime``."""
        return self.uptime

    def advance(self, seconds: float) -> None:
        """Move both clocks on by ``seconds``."""
        self.wall += seconds
        self.uptime += seconds


# --- Detecting that this program stood still while messages to it kept arriving ---
# Causes: a debugger or SIGSTOP, or a computer or virtual machine that is asleep.

LONGEST_PAUSE_S = 5.0
"""seconds; a loop that is busy for less has not stood still. A gateway gives up a peer after 10 s."""
LOOK_EVERY_S = 0.5
ABORTS_WITHIN_S = 0.2
"""seconds within which an Abort is still read on a connection whose other messages are too old."""


class StandstillWatch:
    """Detects whether this program has stood still since the watch was made.

    It has if more than ``longest_s`` passed between two calls of :meth:`check`: call it before handling
    anything received; :meth:`wait` makes the other calls.
    """

    def __init__(self, longest_s: float = LONGEST_PAUSE_S, clock: Clock = SYSTEM_CLOCK) -> None:
        self._longest_s = longest_s
        self._clock = clock
        self._checked_at = clock.steady()
        self.seconds = 0.0
        """Duration of the standstill; 0 if there was none."""

    def check(self) -> bool:
        """Return whether it stood still; once true it stays true."""
        since, self._checked_at = self._checked_at, self._clock.steady()
        passed = self._checked_at - since
        if passed > self._longest_s:
            self.seconds = max(self.seconds, passed)
        return self.seconds > 0.0

    async def wait(self) -> None:
        """Return once it has stood still."""
        while not self.check():
            await asyncio.sleep(LOOK_EVERY_S)


# --- Detecting that this computer's clock was set while the gateway uses it ---
# A small computer without a battery for its clock begins with a wrong time, set right once it has a
# network.

LEAST_STEP = 1.0
"""seconds; smaller corrections are normal."""


class ClockStep(NamedTuple):
    """The clock was set forward by ``by`` seconds, back where that is negative, after ``since``.

    ``since`` and ``now``, when that was noticed, are by the clock as it is set now.
    """

    by: float
    since: float
    now: float

    def moved(self, at: float) -> float:
        """Return a time recorded before the step, converted to the clock as it is set now."""
        return at if self.since <= at <= self.now else at + self.by


class ClockWatch:
    """Compares the time of a ``clock`` with its steady one, to notice when that time is set."""

    def __init__(self, clock: Clock = SYSTEM_CLOCK) -> None:
        self._clock = clock
        self._seen = clock.time(), clock.steady()

    def measure_step(self) -> ClockStep | None:
        """Return the step of the clock since the last call, None if it was not set."""
        (then, steady_then), self._seen = self._seen, (self._clock.time(), self._clock.steady())
        now, steady_now = self._seen
        passed = steady_now - steady_then
        by = now - then - passed
        return None if abs(by) < LEAST_STEP else ClockStep(by, now - passed, now)


# --- Plausibility of this computer's clock at start, from the times in the database; no I/O ---
# Covers a clock that is wrong before the gateway runs; :class:`ClockWatch` covers one set later.

LEAST_BEHIND = 5.0
"""seconds; smaller corrections are normal."""
LONG_IDLE = 7 * 86400.0
"""seconds without anything stored after which the clock may be ahead."""
UNKNOWN_AGE = 30 * 86400.0
"""age in seconds assumed for a time that lies in the future by a clock that is behind: long ago, as the true
age is unknown."""
RELEASED = 1_767_225_600.0
"""2026-01-01 UTC: no computer with this version has an earlier time."""
_SET_IT = "set it ('timedatectl' shows it, 'timedatectl set-ntp true' has the network set it)"


class ClockDoubt(NamedTuple):
    """Why the clock may be wrong, with what to do; ``may_be_ahead`` if stored data may seem too old by it."""

    text: str
    may_be_ahead: bool = False


def check_clock_at_start(now: float, newest: float | None) -> ClockDoubt | None:
    """Return why the clock, which says ``now``, may be wrong; None if nothing contradicts it.

    ``newest`` is the newest time in the database, None in an empty one; both are seconds since 1970.
    """
    if newest is not None and newest - now >= LEAST_BEHIND:
        return ClockDoubt(
            f"the clock of this computer says {_utc(now)}, and what was stored last is from {_utc(newest)}: "
            f"the clock is behind now, or was ahead then. If it is behind, end the gateway, {_SET_IT}, and "
            "start the gateway again: until then it stores times that are wrong"
        )
    if now < RELEASED:
        return ClockDoubt(
            f"the clock of this computer says {_utc(now)}, which is before this version was made: end the "
            f"gateway, {_SET_IT}, and start the gateway again"
        )
    if newest is not None and now - newest >= LONG_IDLE:
        return ClockDoubt(
            f"the clock of this computer says {_utc(now)}, and what was stored last is from {_utc(newest)}. "
            f"For a day nothing is deleted for its age; if the clock is ahead, end the gateway before then, "
            f"{_SET_IT}, and start the gateway again",
            may_be_ahead=True,
        )
    return None


def _utc(at: float) -> str:
    return time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(at))
