"""The clock by which ages are told: nobody sets it, and it goes on while the computer sleeps."""

from __future__ import annotations

import time

_GOES_ON_ASLEEP: int | None = getattr(time, "CLOCK_BOOTTIME", getattr(time, "CLOCK_MONOTONIC", None))
"""On Linux only the first counts sleep, on macOS the second does, unlike Python's own clock; Windows has
neither, and its clock for :func:`time.monotonic` counts sleep."""


def steady_time() -> float:
    """Return seconds of which only differences mean something."""
    return time.monotonic() if _GOES_ON_ASLEEP is None else time.clock_gettime(_GOES_ON_ASLEEP)
