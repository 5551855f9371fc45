"""Times on the command line."""

from __future__ import annotations

from datetime import UTC, datetime

from ..errors import BridgeError


def span_of(since: str | None, until: str | None) -> tuple[float | None, float | None]:
    """Return ``--since`` and ``--until`` as seconds since 1970.

    :raises BridgeError: for what is no time, and where nothing lies between the two.
    """
    first, last = seconds_of("--since", since), seconds_of("--until", until)
    if first is not None and last is not None and first > last:
        raise BridgeError(f"--since {since!r} is later than --until {until!r}; nothing lies between them")
    return first, last


def seconds_of(option: str, text: str | None) -> float | None:
    """Return ``text``, the value of ``option``, as seconds since 1970; raises BridgeError."""
    if text is None:
        return None
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        raise BridgeError(f"{option} {text!r} is no time; write it like 2026-11-21T08:00") from None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()
