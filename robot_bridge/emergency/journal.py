"""Emergency stops on their way into the database, in a small file of this computer.

A stop goes out before it is stored. Where the database is away then, and the gateway dies before it is back,
the next gateway knows of the stop by this file.
"""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import logging
import os
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from sqlalchemy import URL

from ..core.decoding import DecodingError, decode_json
from ..errors import BridgeError
from ..messages import MessageError, check_command_id
from ..store.emergency_stops import StopRow
from ..store.engines.sqlite import file_of

log = logging.getLogger(__name__)


def journal_file(database: URL, folder: Path) -> Path | None:
    """Return the file for the stops of a gateway on ``database``; None for a database in memory.

    Beside the file of an SQLite database, else in ``folder``: gateways of several databases may share that.
    """
    if database.get_backend_name() == "sqlite":
        file = file_of(database)
        return None if file is None else Path(f"{file}.stop")
    of = f"{database.host}:{database.port}/{database.database}"
    return folder / f"emergency-stop-{hashlib.sha256(of.encode()).hexdigest()[:12]}.json"


class StopJournal:
    """The stops that are not stored yet, as they were written down last; no file where there are none."""

    def __init__(self, file: Path) -> None:
        self._file = file
        # One thread: what is written last is what stands there in the end.
        self._thread = ThreadPoolExecutor(1, "emergency stops")

    def check(self) -> None:
        """Raise BridgeError when stops could not be written down."""
        folder = self._file.parent
        if not (folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)):
            raise BridgeError(
                f"emergency stops cannot be noted in folder {folder}, which is missing or not to be written: "
                "one that is made while the database is away would be forgotten with this gateway; make the "
                "folder, or give another one with --state or ROBOT_BRIDGE_STATE"
            )

    def write(self, stops: Sequence[StopRow]) -> asyncio.Future[None]:
        """Write down ``stops``, and no others; done when they are on the disk.

        What cannot be written is told to the log: it must keep no stop from going out.
        """
        loop = asyncio.get_running_loop()
        return loop.run_in_executor(self._thread, self._write, list(stops))

    def read(self) -> list[StopRow]:
        """Return what an earlier gateway left, oldest first.

        What is there and cannot be read or understood was a stop all the same: one in force that nobody
        needed costs a supervisor's word, one that is forgotten may cost more.
        """
        try:
            content = self._file.read_bytes()
        except FileNotFoundError:
            return []
        except OSError as error:
            log.error(
                "%s cannot be read: %s; an emergency stop is noted there: give this account the right to "
                "read and write it",
                self._file,
                error.strerror,
            )
            return [self._unknown(f"could not be read ({error.strerror})")]
        try:
            # As far as it goes: a damaged byte of a reason hides no stop.
            noted = decode_json(content.decode("utf-8", errors="replace"))
        except DecodingError as error:
            log.error("%s could not be understood: %s", self._file, error)
            noted = None
        if not isinstance(noted, list):
            return [self._unknown("could not be understood")]
        stops = [_stop(one) for one in noted]
        understood = [stop for stop in stops if stop is not None]
        return [*understood, *([self._unknown("could not be understood")] if None in stops else [])]

    def _unknown(self, what: str) -> StopRow:
        """Return the stop that stands for one of which nothing is known."""
        reason = f"{self._file} {what}; look at every robot before this is cleared"
        return StopRow(f"damaged-{time.time_ns()}", time.time(), "gateway", reason)

    def _write(self, stops: list[StopRow]) -> None:
        try:
            if stops:
                self._replace(json.dumps([_plain(stop) for stop in stops]))
            else:
                self._file.unlink(missing_ok=True)
        except Exception as error:
            why = (error.strerror if isinstance(error, OSError) else None) or error
            log.error("emergency stops cannot be noted in %s: %s; they go out all the same", self._file, why)

    def _replace(self, text: str) -> None:
        partial = self._file.with_name(f".{self._file.name}.new")
        file = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
        with open(file, "w", encoding="utf-8") as writing:  # noqa: PTH123 - by its descriptor
            writing.write(text)
            writing.flush()
            os.fsync(file)
        partial.replace(self._file)
        _to_disk(self._file.parent)


def _to_disk(folder: Path) -> None:
    """Have the name of a new file on the disk too; some file systems cannot, and need not."""
    descriptor = os.open(folder, os.O_RDONLY)
    with contextlib.suppress(OSError):
        os.fsync(descriptor)
    os.close(descriptor)


def _plain(stop: StopRow) -> dict[str, object]:
    return {"id": stop.id, "at": stop.at, "by": stop.by, "reason": stop.reason}


def _stop(noted: Any) -> StopRow | None:
    """Return the stop that was noted; None for what is none, or could be stored in no database."""
    if not isinstance(noted, dict):
        return None
    id, at, by, reason = (noted.get(name) for name in ("id", "at", "by", "reason"))
    if not (isinstance(id, str) and isinstance(at, float) and isinstance(by, str)):
        return None
    try:
        check_command_id(id)
    except MessageError:
        return None
    return StopRow(id, at, by, reason if isinstance(reason, str) else None)
