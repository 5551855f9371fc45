"""Times in recordings: seconds, parts of seconds, or dates as ISO 8601."""

from __future__ import annotations

from datetime import UTC, datetime

from .samples import LATEST, ValueRefusedError, shown

UNITS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
"""How many of each are a second."""


def seconds_of(text: str, column: str, unit: str = "s") -> float:
    """Return a time as seconds: a number in ``unit``, or a date and time, UTC where it has no offset.

    :raises ValueRefusedError: for what is neither.
    """
    try:
        at = float(text) / UNITS[unit]
    except ValueError:
        at = _of_date(text, column)
    if not -LATEST <= at <= LATEST:
        raise ValueRefusedError(column, f"{shown(text)} is no time in {unit}; give time_unit")
    return at


def _of_date(text: str, column: str) -> float:
    try:
        found = datetime.fromisoformat(text.strip())
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        raise ValueRefusedError(column, f"{shown(text)} is no time") from None
