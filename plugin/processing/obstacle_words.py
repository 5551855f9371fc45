"""How large a map is, in words."""

from __future__ import annotations

from ..language import tr_count


def obstacles_in_words(obstacles: int, segments: int) -> str:
    """Return how many obstacles there are, and of how many segments."""
    return ", ".join(
        (tr_count(obstacles, "1 obstacle", "%n obstacles"), tr_count(segments, "1 segment", "%n segments"))
    )
