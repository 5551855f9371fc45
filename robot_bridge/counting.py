"""A number of things in words."""

from __future__ import annotations


def counted(number: int, thing: str) -> str:
    """Return ``number`` with what it is a number of: ``1 cone``, ``2 cones``."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
