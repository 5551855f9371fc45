"""Log of a process: formats, writing in the background, repeated lines and unforeseen errors."""

from __future__ import annotations

import atexit
import contextlib
import io
import json
import logging
import os
import re
import secrets
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Literal, TextIO

from .clock import SYSTEM_CLOCK, Clock

# --- The log on standard error: lines for people or JSON for programs, without secrets ---

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

    The bridge's own log texts hold none; this is for foreign texts, such as a driver's error.
    """
    for pattern, instead in _SECRETS:
        text = pattern.sub(instead, text)
    return text


def printable(text: str) -> str:
    """Return ``text`` with unprintable characters escaped.

    A name, a status or an error comes from outside: a line break in it would forge lines of the log, and
    other characters could control the terminal.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


class PlainLines(logging.Formatter):
    """Lines for people: time, level, text."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line of ``record``, followed by an indented traceback if there is one."""
        text = printable(without_secrets(record.getMessage()))
        lines = [f"{self.formatTime(record)} {record.levelname} {text}"]
        if record.exc_info:
            traceback = without_secrets(self.formatException(record.exc_info))
            lines += [f"    {printable(line)}" for line in traceback.splitlines()]
        return "\n".join(lines)


class JsonLines(logging.Formatter):
    """One JSON object a line: time (UTC), level, logger, message, and exception if there is one."""

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
    # Its errors are about peers that hang up; the bridge itself logs those that matter.
    logging.getLogger("websockets").setLevel(logging.CRITICAL)
    logging.getLogger("alembic").setLevel(logging.WARNING)
    # It warns of each statement that fails among several, whose error it raises as well.
    logging.getLogger("psycopg").setLevel(logging.ERROR)


# --- Standard output and standard error of a program with an event loop: a thread writes them ---

log = logging.getLogger(__name__)

MOST_UNWRITTEN = 1_000_000
"""characters of one stream that wait to be written; lines beyond them are dropped, and counted."""
WRITTEN_WITHIN = 1.0
"""seconds in which the last lines of a program that ends are written; what is left then is lost."""


class BackgroundStream(io.TextIOBase):
    """A standard stream that makes no writer wait, and raises no errors of its file.

    A terminal stopped by Ctrl+S, a pager, or a pipe that nobody reads would halt an event loop at the next
    line, and with it every stop of a robot.
    """

    def __init__(self, name: str, stream: TextIO) -> None:
        super().__init__()
        self._name, self._encoding, self._file = name, stream.encoding, stream.fileno()
        # Reentrant: a finalizer may log at any moment.
        self._changed = threading.Condition(threading.RLock())
        self._texts: list[str] = []
        self._unwritten = self._dropped = 0
        self._is_idle, self._has_failed = True, False
        threading.Thread(target=self._run, name=name, daemon=True).start()

    @property
    def encoding(self) -> str:  # type: ignore[override]
        """The encoding of the file."""
        return self._encoding

    def fileno(self) -> int:
        """Return the number of the file."""
        return self._file

    def writable(self) -> bool:
        """Return true."""
        return True

    def write(self, text: str) -> int:
        """Have ``text`` written soon; it is dropped while too much waits. Raises TypeError for bytes."""
        if not isinstance(text, str):
            # Typer finds out so whether a stream is one of bytes.
            raise TypeError(f"{self._name} is written as text, not as {type(text).__name__}")
        with self._changed:
            if self._unwritten >= MOST_UNWRITTEN:
                self._dropped += text.count("\n")
            else:
                self._texts.append(text)
                self._unwritten += len(text)
                self._is_idle = False
                self._changed.notify_all()
        return len(text)

    def finish(self, within: float) -> None:
        """Wait until all is written, ``within`` seconds at most."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_idle, within)

    def _run(self) -> None:
        while True:
            with self._changed:
                while not self._texts:
                    self._is_idle = True
                    self._changed.notify_all()
                    self._changed.wait()
                text = "".join(self._texts)
                self._texts.clear()
            lost = self._write_through(text)
            with self._changed:
                self._unwritten -= len(text)
                self._dropped += lost
                # The line about them would only be dropped as well while the file refuses lines.
                dropped = 0 if lost else self._dropped
                self._dropped -= dropped
            if dropped:
                text = "%d lines of %s were dropped: it was not read, or could not be written"
                log.error(text, dropped, self._name)

    def _write_through(self, text: str) -> int:
        """Write ``text``; return the number of lines that could not be written."""
        rest = text.encode(self._encoding, "backslashreplace")
        try:
            # Without the buffer of Python, which a thread that waits here would keep locked at exit.
            while rest:
                rest = rest[os.write(self._file, rest) :]
        except OSError as error:
            if not self._has_failed:
                self._has_failed = True
                log.warning("%s cannot be written: %s", self._name, error.strerror or error)
        return rest.count(b"\n")


def set_up_server_log(form: LogFormat = "text", level: LogLevel = "warning") -> None:
    """As :func:`set_up_log`; from now on threads write all of standard output and standard error."""
    for attribute, name in (("stdout", "standard output"), ("stderr", "standard error")):
        stream = getattr(sys, attribute)
        # One that is closed, or in memory, makes nobody wait.
        with contextlib.suppress(AttributeError, OSError):
            setattr(sys, attribute, BackgroundStream(name, stream))
    set_up_log(form, level)
    atexit.register(finish_writing)


def finish_writing(within: float = WRITTEN_WITHIN) -> None:
    """Wait until standard output and standard error are written, ``within`` seconds at most."""
    until = time.monotonic() + within
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, BackgroundStream):
            stream.finish(max(0.0, until - time.monotonic()))


# --- Unforeseen errors: logged in full, and reported to the caller by a number ---


def log_unforeseen(log: logging.Logger, who: str) -> str:
    """Log the exception being handled, met by ``who``; return the text for them."""
    number = secrets.token_hex(4)
    log.exception("%s: internal error %s", who, number)
    return f"internal error {number}; the gateway's log says more under this number"


@contextlib.contextmanager
def log_and_continue(
    log: logging.Logger,
    what: str,
    *arguments: object,
    except_for: type[Exception] | tuple[type[Exception], ...] = (),
) -> Iterator[None]:
    """Log an exception of the block, which must not prevent the statements after it.

    ``arguments`` replace each %s of ``what``, and are formatted only then. Exceptions in ``except_for`` are
    expected and propagate.
    """
    try:
        yield
    except except_for:
        raise
    except Exception:
        text = what % arguments if arguments else what
        log.exception("%s failed; what comes after it is done all the same", text)


@contextlib.contextmanager
def end_on_error(
    log: logging.Logger, what: str, connection: Any, expected: type[Exception]
) -> Iterator[None]:
    """Log an exception of the block, and end its ``connection`` (of websockets): the peer connects again.

    For tasks that send: else nothing more is sent while the connection stays open. An ``expected`` exception
    ends the block alone.
    """
    try:
        yield
    except expected:
        pass
    except Exception:
        log.exception("%s failed; the connection is ended, and the peer connects again", what)
        # A clean close would say that the peer is not wanted, or was switched off.
        connection.transport.abort()


# --- Lasting troubles, such as a full disk: logged at their beginning, then once a minute

SAY_AGAIN_AFTER = 60.0


class TroubleNews:
    """Decides what to log of lasting troubles: a new text at once, the same one once a minute."""

    def __init__(self) -> None:
        self._last: dict[str, tuple[str, float]] = {}

    def has(self, what: str, text: str) -> bool:
        """Return whether to log that ``what`` fails with ``text``; if so it counts as logged."""
        now = time.monotonic()
        last, at = self._last.get(what, ("", 0.0))
        if text == last and now - at <= SAY_AGAIN_AFTER:
            return False
        self._last[what] = text, now
        return True

    def is_over(self, what: str) -> None:
        """Record that ``what`` succeeded: its next failure is news."""
        self._last.pop(what, None)


# --- Log lines that one robot or operator causes repeatedly: the first in full, then counted

IN_FULL = 5
"""lines of one key that are written at once."""
WINDOW = 60.0
"""seconds after which the unwritten ones are counted in one line."""
MOST_KEYS = 10_000

Key = tuple[str, ...]


@dataclass
class _Run:
    """Lines of one key without a pause of :data:`WINDOW`."""

    log: logging.Logger
    began: float
    written: int = 0
    left_out: int = 0
    last: str = ""


class RepeatedLines:
    """Writes warnings by their keys, such as link, robot and operation, which bound the size of the log."""

    def __init__(self, clock: Clock = SYSTEM_CLOCK) -> None:
        self._clock = clock
        self._runs: dict[Key, _Run] = {}

    def warn(self, log: logging.Logger, key: Key, line: str) -> None:
        """Write ``line`` as a warning, or count it."""
        if self._is_due(log, key, line):
            log.warning("%s", line)

    def note_unforeseen(self, log: logging.Logger, key: Key, who: str) -> str:
        """Log the exception being handled, met by ``who``, or count it; return the text for them."""
        if self._is_due(log, (*key, "internal error"), f"{who}: internal error"):
            return log_unforeseen(log, who)
        return "internal error, again; the gateway's log says more of the first ones"

    def summarise(self) -> None:
        """Write the counts that are due; call it about every second."""
        now = self._clock.steady()
        for key, run in list(self._runs.items()):
            if now - run.began < WINDOW:
                continue
            if not run.left_out:
                del self._runs[key]
                continue
            text = "%s: %d more such lines in %.0f s, the last: %s"
            run.log.warning(text, " ".join(key), run.left_out, now - run.began, run.last)
            run.began, run.left_out = now, 0

    def _is_due(self, log: logging.Logger, key: Key, line: str) -> bool:
        run = self._runs.get(key)
        if run is None:
            if len(self._runs) >= MOST_KEYS:
                del self._runs[next(iter(self._runs))]
            run = self._runs[key] = _Run(log, self._clock.steady())
        if run.written < IN_FULL:
            run.written += 1
            return True
        run.left_out += 1
        run.last = line
        return False
