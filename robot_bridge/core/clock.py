"""The clocks that parts read, as one object that a test or a simulation can move by hand."""

from __future__ import annotations

import time
from dataclasses import dataclass

_COUNTS_SLEEP: int | None = getattr(time, "CLOCK_BOOTTIME", getattr(time, "CLOCK_MONOTONIC", None))
"""On Linux only the first counts sleep, on macOS the second does, unlike Python's own clock; Windows has
neither, and its clock for :func:`time.monotonic` counts sleep."""


def steady_time() -> float:
    """Return seconds of a clock that nobody sets and that counts sleep; only differences mean something."""
    return time.monotonic() if _COUNTS_SLEEP is None else time.clock_gettime(_COUNTS_SLEEP)


class Clock:
    """The system's clocks, in seconds."""

    def time(self) -> float:
        """Return the seconds since the Unix epoch, UTC; whoever sets the computer's clock makes it jump."""
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
