"""Names in a text, which has no room for thousands."""

from __future__ import annotations

from collections.abc import Sequence

MOST_TOLD = 10


def told(names: Sequence[str]) -> str:
    """Return ``names`` in one line: the first ten and how many more there are, ``none`` without any."""
    if not names:
        return "none"
    more = len(names) - MOST_TOLD
    return ", ".join(names[:MOST_TOLD]) + (f" and {more} more" if more > 0 else "")
