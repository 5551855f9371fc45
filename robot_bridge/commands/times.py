"""Times on the command line."""

from __future__ import annotations

from datetime import UTC, datetime

from ..errors import BridgeError


def seconds_of(option: str, text: str | None) -> float | None:
    """Return ``text``, the value of ``option``, as seconds since 1970; raises BridgeError."""
    if text is None:
        return None
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        raise BridgeError(f"{option} {text!r} is no time; write it like 2026-11-21T08:00") from None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()
