"""How often Python looks for objects that hold each other: rarely, since everybody waits while it does."""

from __future__ import annotations

import gc

YOUNG, MIDDLE, OLD = 10_000, 5, 20
"""Objects, and rounds, before the next look (see :func:`gc.set_threshold`). Ten thousand positions a second
come to two young rounds of 3 ms, and to one of all objects in about a minute; with Python's own thresholds it
is one every five seconds, of 140 ms with a thousand robots. Seldomer still, and what connections that are
gone leave behind would wait for too long."""


def spare_what_lasts() -> None:
    """Call when everything is loaded: that is not looked at again, and the rest less often."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG, MIDDLE, OLD)
