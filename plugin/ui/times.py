"""Times and ages as text: the operator's clock, and how long ago a robot was heard."""

from __future__ import annotations

import time

from .language import tr


def time_of_day(at: float | None, now: float | None = None) -> str:
    """Return a time, seconds since 1970, as in ``12:03:04``; nothing for none.

    A stop of last night must not read as one of today: where ``now``, this moment unless given, is on another
    day, the date stands before the time.
    """
    return _formatted(at, now, "%Y-%m-%d %H:%M:%S")


def short_time(at: float | None, now: float | None = None) -> str:
    """Return a time as :func:`time_of_day` does, on another day as in ``11-21 12:03``: for narrow columns.

    Their tool tips tell :func:`date_and_time`.
    """
    return _formatted(at, now, "%m-%d %H:%M")


def date_and_time(at: float | None) -> str:
    """Return a time, seconds since 1970, as in ``2026-11-21 12:03:04``; nothing for none.

    For what is written once and read on another day, such as the rows of a layer.
    """
    return "" if at is None else time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(at))


def _formatted(at: float | None, now: float | None, on_another_day: str) -> str:
    if at is None:
        return ""
    then = time.localtime(at)
    is_today = then[:3] == time.localtime(now)[:3]
    return time.strftime("%H:%M:%S" if is_today else on_another_day, then)


def age_in_words(seconds: float) -> str:
    """Return an age as in ``12.3 s``, ``5 min``, ``2.0 h`` or ``3.0 d``."""
    if seconds < 99.95:
        return f"{seconds:.1f} s"
    if seconds < 3570:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h" if seconds < 48 * 3600 else f"{seconds / 86400:.1f} d"


def heard_in_words(state: str, seconds: float, link: object) -> str:
    """Return a robot's ``state``, how long ago it was heard, and how it is connected."""
    return tr("{state}, last heard {age} ago over {link}", state=state, age=age_in_words(seconds), link=link)
