"""Errors that nobody foresaw: the log is told all of it, and whoever met one a number to ask by."""

from __future__ import annotations

import contextlib
import logging
import secrets
from collections.abc import Iterator


def note_unforeseen(log: logging.Logger, who: str) -> str:
    """Log the exception that is being handled, met by ``who``; return what they are told of it."""
    number = secrets.token_hex(4)
    log.exception("%s: internal error %s", who, number)
    return f"internal error {number}; the gateway's log says more under this number"


@contextlib.contextmanager
def going_on(
    log: logging.Logger, what: str, except_for: type[Exception] | tuple[type[Exception], ...] = ()
) -> Iterator[None]:
    """Log what goes wrong in the block: it must keep nothing after it from being done.

    What is raised ``except_for`` that is known and goes on its way.
    """
    try:
        yield
    except except_for:
        raise
    except Exception:
        log.exception("%s failed; what comes after it is done all the same", what)
