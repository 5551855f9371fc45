"""Rate limit of a client: a token bucket, with some room for bursts."""

from __future__ import annotations

from ...core.clock import SYSTEM_CLOCK, Clock


class RateLimit:
    """Allows ``rate`` takings a second on average and up to ``burst`` at once."""

    __slots__ = ("_at", "_burst", "_left", "_now", "_rate")

    def __init__(self, rate: float, burst: float, clock: Clock = SYSTEM_CLOCK) -> None:
        self._rate, self._burst, self._now = rate, burst, clock.steady
        self._left, self._at = burst, self._now()

    def consume(self) -> bool:
        """Take one, if there is one to take."""
        now = self._now()
        self._left = min(self._burst, self._left + (now - self._at) * self._rate)
        self._at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True

    def give_back(self) -> None:
        """Undo a taking."""
        self._left = min(self._burst, self._left + 1.0)

    def wait(self) -> float:
        """Return the seconds until the next one can be taken."""
        missing = 1.0 - min(self._burst, self._left + (self._now() - self._at) * self._rate)
        return max(0.0, missing / self._rate)
