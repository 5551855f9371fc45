"""How long to wait before the next attempt to reach the gateway."""

from __future__ import annotations

import random
from collections.abc import Callable


class Backoff:
    """Waits that double from attempt to attempt, up to a longest one, each cut at random by up to a half.

    The chance keeps the desks of a site from coming back all in the same moment after a restart. Every wait
    lies between ``shortest`` and ``longest`` seconds.
    """

    def __init__(
        self, shortest: float = 0.5, longest: float = 15.0, chance: Callable[[], float] = random.random
    ):
        self._shortest = shortest
        self._longest = longest
        self._chance = chance
        self._attempts = 0

    @property
    def attempts(self) -> int:
        """How many waits were handed out since the last success."""
        return self._attempts

    def next_wait(self) -> float:
        """Return the seconds to wait before the next attempt."""
        span = min(self._longest, self._shortest * 2 ** (min(self._attempts, 30) + 1))
        self._attempts += 1
        return max(self._shortest, span * (1.0 - 0.5 * self._chance()))

    def reset(self) -> None:
        """Begin with short waits again, after a success."""
        self._attempts = 0
