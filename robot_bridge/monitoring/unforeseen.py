"""Errors that nobody foresaw: the log is told all of it, and whoever met one a number to ask by."""

from __future__ import annotations

import logging
import secrets


def note_unforeseen(log: logging.Logger, who: str) -> str:
    """Log the exception that is being handled, met by ``who``; return what they are told of it."""
    number = secrets.token_hex(4)
    log.exception("%s: internal error %s", who, number)
    return f"internal error {number}; the gateway's log says more under this number"
