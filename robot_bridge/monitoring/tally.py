"""What the gateway counts while it works: plain numbers, so that a message costs no more than an addition."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field


@dataclass
class Tally:
    """Numbers since the start of the gateway; ``beats`` are the times of the last successes of its tasks.

    ``requests`` by link and operation, ``refused`` by link, ``desk`` by method, ``steps`` by command state,
    ``failures`` by task.
    """

    requests: Counter[tuple[str, str]] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    desk: Counter[str] = field(default_factory=Counter)
    steps: Counter[str] = field(default_factory=Counter)
    failures: Counter[str] = field(default_factory=Counter)
    beats: dict[str, float] = field(default_factory=dict)

    def beat(self, task: str) -> None:
        """Note that ``task`` did its work just now."""
        self.beats[task] = time.monotonic()

    def age(self, task: str) -> float | None:
        """Return the seconds since ``task`` did its work, None if it never did."""
        last = self.beats.get(task)
        return None if last is None else time.monotonic() - last
