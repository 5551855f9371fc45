"""Times as the operator's clock shows them."""

from __future__ import annotations

import time


def time_of_day(at: float | None, now: float | None = None) -> str:
    """Return a time, seconds since 1970, as in ``12:03:04``; nothing for none.

    A stop of last night must not read as one of today: where ``now``, this moment unless given, is on another
    day, the date stands before the time.
    """
    return _told(at, now, "%Y-%m-%d %H:%M:%S")


def short_time(at: float | None, now: float | None = None) -> str:
    """Return a time as :func:`time_of_day` does, on another day as in ``11-21 12:03``: for narrow columns.

    Their tool tips tell :func:`date_and_time`.
    """
    return _told(at, now, "%m-%d %H:%M")


def date_and_time(at: float | None) -> str:
    """Return a time, seconds since 1970, as in ``2026-11-21 12:03:04``; nothing for none.

    For what is written once and read on another day, such as the rows of a layer.
    """
    return "" if at is None else time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(at))


def _told(at: float | None, now: float | None, on_another_day: str) -> str:
    if at is None:
        return ""
    then = time.localtime(at)
    is_today = then[:3] == time.localtime(now)[:3]
    return time.strftime("%H:%M:%S" if is_today else on_another_day, then)
