"""How often Python looks for objects that hold each other: rarely, since everybody waits while it does."""

from __future__ import annotations

import gc

YOUNG, MIDDLE, OLD = 50_000, 5, 4
"""Objects, and rounds, before the next look (see :func:`gc.set_threshold`). A thousand robots that send ten
thousand positions a second have up to 20 000 objects waiting to be stored, whose end is known of without a
look. With fewer YOUNG than that there was one every two seconds, and one of 30 ms every ten; with Python's
own it was one of 140 ms every five. Rarer still, and what connections that are gone leave behind would wait
for too long: a thousand leave 80 000 objects, 10 MB."""


def spare_what_lasts() -> None:
    """Call when everything is loaded: that is not looked at again, and the rest less often."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG, MIDDLE, OLD)
