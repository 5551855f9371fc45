"""Lines of the log that one robot or operator causes again and again: the first in full, then counted."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass

from .unforeseen import note_unforeseen

IN_FULL = 5
"""lines of one key that are written as they come."""
WINDOW = 60.0
"""seconds after which those that were not written are counted in one line."""
MOST_KEYS = 10_000

Key = tuple[str, ...]


@dataclass
class _Run:
    """Lines of one key without a pause of :data:`WINDOW`."""

    log: logging.Logger
    began: float
    written: int = 0
    left_out: int = 0
    last: str = ""


class RepeatedLines:
    """Writes warnings by their keys, such as link, robot and operation, which bound the size of the log."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._runs: dict[Key, _Run] = {}

    def warn(self, log: logging.Logger, key: Key, line: str) -> None:
        """Write ``line`` as a warning, or count it."""
        if self._is_to_be_written(log, key, line):
            log.warning("%s", line)

    def note_unforeseen(self, log: logging.Logger, key: Key, who: str) -> str:
        """Log the exception that is being handled, met by ``who``, or count it; return what they are told."""
        if self._is_to_be_written(log, (*key, "internal error"), f"{who}: internal error"):
            return note_unforeseen(log, who)
        return "internal error, again; the gateway's log says more of the first ones"

    def summarise(self) -> None:
        """Write the counts that are due; to be called every second or so."""
        now = self._clock()
        for key, run in list(self._runs.items()):
            if now - run.began < WINDOW:
                continue
            if not run.left_out:
                del self._runs[key]
                continue
            text = "%s: %d more such lines in %.0f s, the last: %s"
            run.log.warning(text, " ".join(key), run.left_out, now - run.began, run.last)
            run.began, run.left_out = now, 0

    def _is_to_be_written(self, log: logging.Logger, key: Key, line: str) -> bool:
        run = self._runs.get(key)
        if run is None:
            if len(self._runs) >= MOST_KEYS:
                del self._runs[next(iter(self._runs))]
            run = self._runs[key] = _Run(log, self._clock())
        if run.written < IN_FULL:
            run.written += 1
            return True
        run.left_out += 1
        run.last = line
        return False
