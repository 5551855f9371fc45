"""The log on standard error: lines for people or JSON for programs, neither with a secret in it."""

from __future__ import annotations

import json
import logging
import re
import sys
from datetime import UTC, datetime
from typing import Literal, TextIO

LogFormat = Literal["text", "json"]
LogLevel = Literal["debug", "info", "warning", "error"]

_SECRETS = (
    (re.compile(r"(?i)\b(bearer\s+)[\w.~+/=-]+"), r"\1***"),
    (re.compile(r"(?i)\b(\w+(?:\+\w+)?://[^\s/:@]*):[^\s/]*@"), r"\1:***@"),
    (re.compile(r"(?i)\b(password|passwd|token|secret)(\s*=\s*)(\"[^\"]*\"|'[^']*'|[^\s,;&]+)"), r"\1\2***"),
    (re.compile(r"\b(fleet_(?:op|robot|link)_)[\w-]+"), r"\1***"),
)


def without_secrets(text: str) -> str:
    """Return ``text`` with what looks like a password or a token replaced by ``***``.

    What the bridge logs holds none; this is for texts that come from elsewhere, such as a driver's error.
    """
    for pattern, instead in _SECRETS:
        text = pattern.sub(instead, text)
    return text


def printable(text: str) -> str:
    """Return ``text`` with an escape for whatever is no printable character.

    A name, a status or an error comes from outside: with a line break in it, it would forge lines of the log,
    and with others it would do to the terminal what it likes.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


class PlainLines(logging.Formatter):
    """Lines for people: time, level, text."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line of ``record``, with an indented traceback behind it where there is one."""
        text = printable(without_secrets(record.getMessage()))
        lines = [f"{self.formatTime(record)} {record.levelname} {text}"]
        if record.exc_info:
            traceback = without_secrets(self.formatException(record.exc_info))
            lines += [f"    {printable(line)}" for line in traceback.splitlines()]
        return "\n".join(lines)


class JsonLines(logging.Formatter):
    """One JSON object a line: time (UTC), level, logger, message, and exception where there is one."""

    def format(self, record: logging.LogRecord) -> str:
        """Return ``record`` as one line of JSON."""
        entry = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": without_secrets(record.getMessage()),
        }
        if record.exc_info:
            entry["exception"] = without_secrets(self.formatException(record.exc_info))
        text = json.dumps(entry, ensure_ascii=False)
        return text if text.isprintable() else "".join(map(_in_json, text))


def _in_json(character: str) -> str:
    return character if character.isprintable() else json.dumps(character)[1:-1]


def set_up_log(form: LogFormat = "text", level: LogLevel = "warning", stream: TextIO | None = None) -> None:
    """Send the log of this process to ``stream`` (standard error by default), in place of where it went."""
    handler = logging.StreamHandler(stream or sys.stderr)
    handler.setFormatter(JsonLines() if form == "json" else PlainLines())
    logging.basicConfig(level=level.upper(), handlers=[handler], force=True)
    # Its errors are about peers that hang up; what matters of them the bridge says itself.
    logging.getLogger("websockets").setLevel(logging.CRITICAL)
    logging.getLogger("alembic").setLevel(logging.WARNING)
