"""How often Python looks for objects that hold each other: rarely, since everybody waits while it does."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping

YOUNG, MIDDLE, OLD = 10_000, 5, 20
"""Objects, and rounds, before the next look (see :func:`gc.set_threshold`). Ten thousand positions a second
come to two young rounds of 3 ms, and to one of all objects in about a minute; with Python's own thresholds it
is one every five seconds."""
LOOK_AT_ALL_AFTER_S = 300.0
"""A thousand robots' connections and all that hangs on them take 140 ms to look at. What a look at all
objects found in use is therefore left out of the following ones for so long. Longer, and what connections
that are gone leave behind would wait for too long: about 10 kB each."""

_ALL = 2
"""The generation of objects with which all are looked at."""


class Sparing:
    """Sets apart what has lasted, and takes it back for a look once in LOOK_AT_ALL_AFTER_S; see :mod:`gc`."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._looked_at = clock()

    def __call__(self, phase: str, info: Mapping[str, int]) -> None:
        """Take note that a look begins or ends."""
        if info["generation"] != _ALL:
            return
        if phase == "stop":
            gc.freeze()
        elif self._clock() - self._looked_at >= LOOK_AT_ALL_AFTER_S:
            self._looked_at = self._clock()
            gc.unfreeze()


def spare_what_lasts() -> None:
    """Call when everything is loaded: that is looked at seldom, and the rest less often."""
    gc.callbacks.append(Sparing())
    gc.collect()
    gc.set_threshold(YOUNG, MIDDLE, OLD)
