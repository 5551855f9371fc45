"""How often Python looks for objects that hold each other: rarely, since everybody waits while it does."""

from __future__ import annotations

import gc

YOUNG, MIDDLE, OLD = 50_000, 5, 4
"""Objects, and rounds, before the next look (see :func:`gc.set_threshold`). A thousand robots that send ten
thousand positions a second have up to 20 000 objects waiting to be stored, whose end is known of without a
look. With fewer YOUNG than that there was one every two seconds, and one of 30 ms every ten; with Python's
own it was one of 140 ms every five. What connections leave behind that are gone waits for a look at the OLD,
which comes after ten thousand of them: see :class:`Leavings`."""
MOST_GONE = 200
"""Connections that go before the next look at all objects, whatever else there is to do. Each leaves 90
objects that hold each other, 15 kB: twelve thousand, after which Python would look by itself, left 250 MB,
and everybody would have waited for seconds while it cleared them away."""


def spare_what_lasts() -> None:
    """Call when everything is loaded: that is not looked at again, and the rest less often."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG, MIDDLE, OLD)


class Leavings:
    """Sees to what connections leave behind: by the time they go it is old, and looks at the old are rare."""

    def __init__(self) -> None:
        self._looked_at = 0

    def clear_away(self, gone: int) -> None:
        """Look at all objects when ``gone``, connections since the start, has grown by MOST_GONE since."""
        if gone - self._looked_at >= MOST_GONE:
            self._looked_at = gone
            gc.collect()
