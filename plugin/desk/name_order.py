"""The order in which people look for names: r2 before r10, and capitals among small letters."""

from __future__ import annotations

import re

_NUMBER = re.compile(r"[0-9]+")
_DIGITS = 20
"""To so many digits numbers within names are compared as numbers."""


def name_order(name: str) -> str:
    """Return what ``name`` is sorted by; no two names have the same."""
    filled = _NUMBER.sub(lambda number: number[0].zfill(_DIGITS), name.casefold())
    return f"{filled}\0{name}"
