"""Where in a recording it is, by a clock that only goes forward; no I/O."""

from __future__ import annotations

import math


class PlayClock:
    """Seconds of a recording, ``speed`` of them for each second of the clock that ``now`` is read from.

    The place is always reckoned from where it was set last, never summed up, so it does not drift.
    """

    def __init__(self, place: float, speed: float, now: float, *, paused: bool = False) -> None:
        self._place = place
        self._since = now
        self._speed = speed
        self._paused = paused

    @property
    def speed(self) -> float:
        """Seconds of the recording for each second."""
        return self._speed

    @property
    def is_paused(self) -> bool:
        """Whether it stands."""
        return self._paused

    def place(self, now: float) -> float:
        """Return the recording's time at ``now``."""
        return self._place if self._paused else self._place + (now - self._since) * self._speed

    def when(self, place: float) -> float:
        """Return the clock's time at which ``place`` is reached; infinite while it stands."""
        return math.inf if self._paused else self._since + (place - self._place) / self._speed

    def seek(self, place: float, now: float) -> None:
        """Go to ``place``."""
        self._place, self._since = place, now

    def change(self, now: float, *, speed: float, paused: bool) -> None:
        """Go on from where it is with another speed, or stand."""
        self.seek(self.place(now), now)
        self._speed, self._paused = speed, paused
