"""How often Python looks for objects that hold each other: rarely, since everybody waits while it does."""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable

YOUNG, MIDDLE, OLD = 50_000, 5, 4
"""Objects, and rounds, before the next look (see :func:`gc.set_threshold`). A thousand robots that send ten
thousand positions a second have up to 20 000 objects waiting to be stored, whose end is known of without a
look. With fewer YOUNG than that there was one every two seconds, and one of 30 ms every ten; with Python's
own it was one of 140 ms every five. What connections leave behind that are gone waits for a look at the OLD,
which comes after ten thousand of them: see :class:`Leavings`."""
MOST_GONE = 1000
"""Connections that go before the next look at all objects, whatever else there is to do. Each leaves 90
objects that hold each other, 12 kB in all."""
REST = 50.0
"""How many times as long as such a look took none follows: everybody waits while it is done."""


def spare_what_lasts() -> None:
    """Call when everything is loaded: that is not looked at again, and the rest less often."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG, MIDDLE, OLD)


class Leavings:
    """Sees to what connections leave behind: by the time they go it is old, and looks at the old are rare.

    ``clock`` returns seconds that only ever go on.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._looked_at = 0
        self._rests_until = -math.inf

    def clear_away(self, gone: int) -> None:
        """Look at all objects when ``gone``, connections since the start, has grown by MOST_GONE since."""
        began = self._clock()
        if gone - self._looked_at < MOST_GONE or began < self._rests_until:
            return
        self._looked_at = gone
        gc.collect()
        now = self._clock()
        self._rests_until = now + REST * (now - began)
