"""Persistence of emergency stops and unstored Aborts: journal files of this computer, then the database."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import hashlib
import json
import logging
import math
import os
import threading
import time
import uuid
from collections.abc import Awaitable, Callable, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import URL, Connection, select

from ...core.errors import (
    BridgeError,
    DataRefusedError,
    LockedError,
    StoreError,
    UncertainError,
    listed_names,
)
from ...core.files import write_state, write_state_into
from ...core.json_decoder import DecodingError, decode_json
from ...core.logs import TroubleNews
from ...core.messages.base import MessageError, check_command_id, check_expires_in, check_robot_name
from ...core.messages.commands import ABORT_VALID_S
from ...core.messages.robots import MOTION_OPS, Abort
from ..commands.active_command import CommandOrder, KeptAbort
from ..commands.persistence import write_bare_aborts
from ..commands.service import CommandService
from ..storage.database import Database, start_task
from ..storage.dialects import sqlite_file_of
from ..storage.repositories import emergency_stops, requests
from ..storage.repositories.emergency_stops import StopRow
from ..storage.repositories.robots import FencedError

# --- Journals: small files of this computer that outlive the gateway ---
# A stop or an Abort is sent before it is stored. Where the database is unavailable then, and the gateway dies
# before it is back, the next gateway reads it here; a stop in force also where an older state is restored.

log = logging.getLogger(__name__)


def journal_files(database: URL, folder: Path, gateway: str | None = None) -> tuple[Path, Path] | None:
    """Return the journals of a gateway on ``database``: of stops, and of Aborts; None for one in memory.

    They are beside the file of an SQLite database, else in ``folder``, which gateways of several databases
    may share, and so may several named gateways (``gateway``) of one database.
    """
    if database.get_backend_name() == "sqlite":
        file = sqlite_file_of(database)
        return None if file is None else (Path(f"{file}.stop"), Path(f"{file}.aborts"))
    of = f"{database.host}:{database.port}/{database.database}"
    name = "" if gateway is None else f"-{gateway}"
    of = f"{hashlib.sha256(of.encode()).hexdigest()[:12]}{name}.json"
    return folder / f"emergency-stop-{of}", folder / f"aborts-{of}"


FULL = (errno.ENOSPC, errno.EDQUOT)
NOT_UNDERSTOOD = "could not be understood"
T = TypeVar("T")


class Entry:
    """An entry of a journal. All methods raise MessageError for one that is none."""

    def __init__(self, noted: Any) -> None:
        if not isinstance(noted, dict):
            raise MessageError(f"{type(noted).__name__} in place of an object")
        self._noted = noted

    def value(self, name: str, kind: type[T]) -> T:
        """Return the value of ``name``, which is a ``kind``."""
        value = self.optional(name, kind)
        if value is None:
            raise MessageError(f"{name} is missing")
        return value

    def optional(self, name: str, kind: type[T]) -> T | None:
        """Return the value of ``name``, which is a ``kind``, or None where it has none."""
        value = self._noted.get(name)
        if value is None or isinstance(value, kind):
            return value
        raise MessageError(f"{name} is no {kind.__name__}")

    def id(self, name: str) -> str:
        """Return the value of ``name``, which is the id of a command."""
        check_command_id(value := self.value(name, str))
        return value

    @property
    def reason(self) -> str | None:
        """The reason, None also where it is no text: it keeps no stop from being one."""
        reason = self._noted.get("reason")
        return reason if isinstance(reason, str) else None


class JournalFile:
    """A list of JSON objects in a file; there is no file where the list is empty.

    ``what`` names the entries in messages; ``room`` are the bytes reserved for them in case the disk is full.
    """

    what = ""
    room = 16_384

    def __init__(self, file: Path) -> None:
        self._file = file
        # Two: the second stop on a full disk is written before the first one's room is free again.
        self._rooms = [file.with_name(f".{file.name}.{name}") for name in ("room", "spare")]
        self._fault = ""
        # One thread: the last write wins.
        self._thread = ThreadPoolExecutor(1, self.what)
        self._lock = threading.Lock()
        self._due: Future[bool] | None = None

    def check(self) -> None:
        """Raise BridgeError when entries could not be written; reserve room for them."""
        folder = self._file.parent
        if not (folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)):
            raise BridgeError(
                f"{self.what} cannot be noted in folder {folder}, which is missing or not to be written: "
                "one that is made while the database is away would be forgotten with this gateway; make the "
                "folder, or give another one with --state or ROBOT_BRIDGE_STATE"
            )
        self._set_room_aside()

    def write_entries(self, entries: Iterable[object]) -> Future[bool]:
        """Write ``entries``, and no others; the future is done when they are on the disk.

        A failed write is logged, and its result is false: it must not prevent a stop from being sent.
        """
        noted = list(entries)
        return self._thread.submit(self._write, lambda: noted)

    def write_present(self, entries: Callable[[], Iterable[object]]) -> Future[bool]:
        """Write what ``entries`` returns when the thread calls it, once for all calls until then.

        The future is as of :meth:`write_entries`.
        """
        # Held but for a moment: the thread may begin before what it writes is known to be due.
        with self._lock:
            if self._due is None:
                self._due = self._thread.submit(self._write_present, entries)
            return self._due

    def _write_present(self, entries: Callable[[], Iterable[object]]) -> bool:
        # What changes from here on is due again, whether it is among these or not.
        with self._lock:
            self._due = None
        return self._write(entries)

    def read_entries(self, decode: Callable[[Entry], T]) -> tuple[list[T], str | None]:
        """Return the entries that an earlier gateway left, oldest first, and what is wrong with the file.

        ``decode`` raises MessageError for an entry that is none, or that no database could store; the others
        are returned all the same.
        """
        noted, fault = self._content()
        decoded = []
        for one in noted:
            try:
                decoded.append(decode(Entry(one)))
            except MessageError:
                fault = NOT_UNDERSTOOD
        return decoded, fault

    def _content(self) -> tuple[list[Any], str | None]:
        try:
            content = self._file.read_bytes()
        except FileNotFoundError:
            return [], None
        except OSError as error:
            log.error(
                "%s cannot be read: %s; %s are noted there: give this account the right to read and write it",
                self._file,
                error.strerror,
                self.what,
            )
            return [], f"could not be read ({error.strerror})"
        try:
            # Decoded as far as possible: a damaged byte of a reason must not hide a stop.
            noted = decode_json(content.decode("utf-8", errors="replace"))
        except DecodingError as error:
            log.error("%s could not be understood: %s", self._file, error)
            noted = None
        return (noted, None) if isinstance(noted, list) else ([], NOT_UNDERSTOOD)

    def _write(self, entries: Callable[[], Iterable[object]]) -> bool:
        try:
            # One by one: other threads have their turns between those of a whole fleet.
            noted = [json.dumps(one) for one in entries()]
            if noted:
                self._write_text(f"[{', '.join(noted)}]".encode())
            else:
                self._file.unlink(missing_ok=True)
                self._set_room_aside()
        except Exception as error:
            why = (error.strerror if isinstance(error, OSError) else None) or error
            if (fault := f"{self.what} cannot be noted in {self._file}: {why}") != self._fault:
                log.error("%s; they go out all the same", fault)
            self._fault = fault
            return False
        self._fault = ""
        return True

    def _write_text(self, text: bytes) -> None:
        try:
            write_state(self._file, text, mode=0o600)
        except OSError as error:
            if error.errno not in FULL:
                raise
            rooms = [room for room in self._rooms if room.is_file()]
            if not rooms:
                raise
            write_state_into(rooms[0], self._file, text)

    def _set_room_aside(self) -> None:
        # A disk that is already full has no room; a stop that cannot be written then is logged.
        for room in self._rooms:
            with contextlib.suppress(OSError):
                if not room.is_file():
                    write_state(room, b" " * self.room, mode=0o600)


class StopJournal(JournalFile):
    """The stops in force or not stored."""

    what = "emergency stops"

    def write(self, stops: Sequence[StopRow]) -> Future[bool]:
        """Write ``stops``, and no others; see :meth:`write_entries`."""
        return self.write_entries(
            {"id": stop.id, "at": stop.at, "by": stop.by, "reason": stop.reason} for stop in stops
        )

    def read(self) -> list[StopRow]:
        """Return the stops that an earlier gateway left, oldest first.

        An entry that cannot be read or decoded counts as a stop all the same: a needless one is cleared by a
        supervisor, a forgotten one may cost more.
        """
        stops, fault = self.read_entries(_stop)
        return stops if fault is None else [*stops, self._unknown(fault)]

    def _unknown(self, what: str) -> StopRow:
        """Return a stop in place of one that cannot be read."""
        reason = f"{self._file} {what}; look at every robot before this is cleared"
        return StopRow(f"damaged-{time.time_ns()}", time.time(), "gateway", reason)


def _stop(noted: Entry) -> StopRow:
    return StopRow(noted.id("id"), noted.value("at", float), noted.value("by", str), noted.reason)


class AbortJournal(JournalFile):
    """The Aborts that are sent and not stored in the database with the id ``database``."""

    what = "Aborts"
    room = 262_144

    def __init__(self, file: Path, database: str) -> None:
        super().__init__(file)
        self._database = database

    def write(self, kept: Sequence[KeptAbort], settled: Sequence[str] = ()) -> Future[bool]:
        """Write ``kept``, and no others; see :meth:`write_entries`."""
        return self.write_entries(map(self._plain, kept))

    def write_newest(self, kept: Callable[[], Iterable[KeptAbort]]) -> Future[bool]:
        """Write what ``kept`` returns, and no others, once for many calls; see :meth:`write_present`."""
        return self.write_present(lambda: map(self._plain, kept()))

    def read(self, now: float | None = None) -> list[KeptAbort]:
        """Return the Aborts that an earlier gateway left on this database, less than a day ago.

        ``now`` is by the clock of the times in the file (s), else the computer's. None of the Aborts is from
        later: a clock was set back. What cannot be understood is logged, and kept beside for whoever looks
        into it. The file is written without what is dropped.
        """
        noted, fault = self.read_entries(partial(self._understood, time.time() if now is None else now))
        if fault is not None:
            unread = self._file.with_name(f"{self._file.name}.unread")
            with contextlib.suppress(OSError):
                self._file.replace(unread)
            log.error(
                "%s %s and is %s now: look whether robots stand that were sent an Abort",
                self._file,
                fault,
                unread.name,
            )
        kept = [one for one in noted if one is not None]
        if len(kept) < len(noted) or (kept and fault is not None):
            self.write(kept)
        return kept

    def left_for(self, robots: Iterable[str]) -> list[KeptAbort]:
        """Return none: there is no other gateway."""
        return []

    def _plain(self, kept: KeptAbort) -> dict[str, object]:
        order = kept.order
        return {
            "command": order.command,
            "robot": order.robot,
            "by": order.operator,
            "reason": order.reason,
            "aborts": order.aborts,
            "expires_in": order.expires_in,
            "emergency": order.is_emergency,
            "of_pause": order.of_pause,
            "at": kept.at,
            "database": self._database,
        }

    def _understood(self, now: float, noted: Entry) -> KeptAbort | None:
        """Return the noted Abort; None for one of another database, or too old; raises MessageError."""
        command, robot = noted.id("command"), check_robot_name(noted.value("robot", str))
        at, expires_in = noted.value("at", float), noted.optional("expires_in", float)
        check_expires_in(expires_in, math.inf)
        emergency = noted.optional("emergency", bool) is True
        aborts = None if noted.optional("aborts", str) is None else noted.id("aborts")
        order = CommandOrder(
            command,
            robot,
            Abort(emergency=emergency),
            noted.value("by", str),
            noted.reason,
            expires_in=expires_in,
            aborts=aborts,
            of_pause=noted.optional("of_pause", bool) is True,
        )
        is_elsewhere = noted.optional("database", str) != self._database
        if is_elsewhere or now - at > ABORT_VALID_S:
            which = "of another database" if is_elsewhere else "too old"
            log.warning("%s: Abort %s of robot %r is dropped: it is %s", self._file, command, robot, which)
            return None
        return KeptAbort(order, min(at, now), is_left=True)


# --- Storing an emergency stop and the Aborts of its robots, despite faults of single robots or tables ---
# All in one transaction where possible. Else every robot is first sent a bare Abort, which belongs to no
# command: inserts into one table, over a second connection, which wait for no lock. Then the robots are
# halved until the failing ones are found: each group is a transaction of its own. Of a table that takes
# nothing a few robots show that it is none of theirs.

BARE_AFTER_S = 1.0
"""seconds after which robots that only read the database are sent a bare Abort of a stop that is not stored
yet: somebody may have a table locked that they do not read."""

MOST_ALIKE = 8
"""robots that fail by themselves, one after the other and in the same way, before others are not tried."""


class StopWriter:
    """Writes stops into the database; keeps the robots whose Abort is not stored yet ("owed")."""

    def __init__(self, commands: CommandService, database: Database) -> None:
        self._commands = commands
        self._database = database
        self._news = TroubleNews()
        self._failed_alone: set[str] = set()
        """robots that failed by themselves when they were tried last."""
        self._owed: dict[str, StopRow] = {}
        self._have_bare: dict[str, set[str]] = {}
        """robots that were sent bare Aborts, with the ids of the stops."""

    @property
    def is_owing(self) -> bool:
        """Whether the Abort of any robot is not stored yet."""
        return bool(self._owed)

    def forget(self, robot: str) -> None:
        """Drop the owed Abort of a removed robot."""
        self._owed.pop(robot, None)

    def end(self) -> None:
        """Hand the owed Aborts to the command service, which stores them first: the stop is over."""
        self._commands.keep_aborts(
            order for robot, stop in self._owed.items() for order in orders_of(stop, [robot])
        )
        self._owed.clear()
        self._have_bare.clear()
        self._news = TroubleNews()

    def owe(self, stop: StopRow, robots: Sequence[str]) -> None:
        """Have the next :meth:`write_owed` send ``robots`` the Abort of ``stop``."""
        self._owed.update(dict.fromkeys(robots, stop))
        for robot in robots:
            self._have_bare.pop(robot, None)

    async def write(self, stop: StopRow, robots: Sequence[str], readers: Sequence[str] = ()) -> bool:
        """Store a stop with the Aborts of ``robots``, of which ``readers`` hear of it by the database alone.

        Return false where the database refuses the stop as data; the Aborts are stored all the same.

        :raises StoreError: when the database cannot be used; the stop must then be written again.
        """
        issuing = start_task(self._issue(stop, robots, partial(_write_stop, stop)))
        await asyncio.wait({issuing}, timeout=BARE_AFTER_S)
        early = [] if issuing.done() else await self.add_bare(stop, readers)
        try:
            await issuing
            return True
        except UncertainError:
            raise
        except Exception as error:
            text = "the emergency stop cannot be stored in one transaction and is stored in several"
            # On a full disk this is retried every few seconds for as long as that lasts.
            if self._news.has(stop.id, str(error)):
                _explain(error, text)
        self._owed.update(dict.fromkeys(robots, stop))
        for robot in early:
            # A motion that was being written meanwhile may have followed that Abort.
            self._have_bare[robot].discard(stop.id)
        await self.add_bare(stop, robots)
        is_listed = await self._list(stop)
        await self.write_owed()
        return is_listed

    async def write_owed(self) -> None:
        """Store the Aborts that could not be stored before.

        A robot whose Abort is refused, or fails unexpectedly, keeps a bare one; one that another gateway has
        by now is left to that gateway. Other failures are retried by the next call.

        :raises StoreError: when the database cannot be used.
        """
        by_stop: dict[StopRow, list[str]] = {}
        for robot, stop in self._owed.items():
            by_stop.setdefault(stop, []).append(robot)
        for stop, robots in by_stop.items():
            write = partial(self._issue, stop, also=_withdraw_motions)
            failed = await self._halve(sorted(robots), write, self._database.run)
            for robot in robots:
                error = failed.get(robot)
                if error is None or await self._is_settled(stop, robot, error):
                    self._owed.pop(robot, None)

    async def _is_settled(self, stop: StopRow, robot: str, error: Exception) -> bool:
        if isinstance(error, FencedError):
            # The gateway that has the robot now knows of the stop, and sends it that Abort.
            return True
        if isinstance(error, StoreError) and not isinstance(error, DataRefusedError):
            return False
        await self.add_bare(stop, [robot])
        if stop.id not in self._have_bare.get(robot, ()):
            return False
        log.error("robot %r is sent an Abort that no command follows: look whether it stands", robot)
        return True

    async def _issue(
        self,
        stop: StopRow,
        robots: Sequence[str],
        also: Callable[[Sequence[str], Connection], None],
    ) -> None:
        await self._commands.issue(orders_of(stop, robots), partial(also, robots))

    async def add_bare(self, stop: StopRow, robots: Sequence[str]) -> list[str]:
        """Send a bare Abort to those of ``robots`` that were sent none of this stop, and return them.

        Failures are logged.
        """
        without = [robot for robot in robots if stop.id not in self._have_bare.get(robot, ())]
        try:
            failed = await self._halve(without, self._send_bare, self._database.run_aside)
        except StoreError as error:
            if self._news.has("bare", str(error)):
                _explain(error, "Aborts of an emergency stop cannot be stored")
            return []
        sent = [robot for robot in without if robot not in failed]
        for robot in sent:
            self._have_bare.setdefault(robot, set()).add(stop.id)
        return sent

    async def _send_bare(self, robots: Sequence[str]) -> None:
        # What keeps the stop itself from being stored may keep the other connection waiting.
        await self._database.run_aside(_write_bare, robots)

    async def _list(self, stop: StopRow) -> bool:
        """Store the stop alone; in ASCII and without a reason where the database refuses it."""
        for row in (stop, _in_plain_letters(stop)):
            try:
                await self._database.run(emergency_stops.add, row)
                return True
            except DataRefusedError as error:
                log.error("emergency stop %s: %s", ascii(row.id), error)
        return False

    async def _halve(
        self,
        robots: Sequence[str],
        write: Callable[[Sequence[str]], Awaitable[None]],
        run: Callable[[Callable[[Connection], None]], Awaitable[None]],
    ) -> dict[str, Exception]:
        """Write for all ``robots`` at once, else half by half; return the failed robots with their errors.

        ``run`` is that of the connection which ``write`` uses. Where :data:`MOST_ALIKE` robots fail in the
        same way a table is at fault and no robot: others are not tried by themselves then, and come first in
        the next call.

        :raises StoreError: when it failed because the database cannot be used.
        """
        alike: list[str] = []

        async def search(some: Sequence[str]) -> dict[str, Exception]:
            try:
                await write(some)
                alike.clear()
                return {}
            except Exception as error:
                await run(_use)
                text = str(error)
                if len(some) == 1:
                    self._failed_alone.add(some[0])
                    if alike and alike[-1] != text:
                        alike.clear()
                    alike.append(text)
                    return {some[0]: error}
                # An error of one robot's data, or of its fence, says nothing of others.
                if (
                    type(error) in (StoreError, LockedError)
                    and len(alike) >= MOST_ALIKE
                    and text == alike[-1]
                ):
                    return dict.fromkeys(some, error)
            half = len(some) // 2
            return {**await search(some[:half]), **await search(some[half:])}

        in_order = sorted(robots, key=self._failed_alone.__contains__)
        self._failed_alone.difference_update(robots)
        failed = await search(in_order) if in_order else {}
        self._log_failed(failed)
        return failed

    def _log_failed(self, failed: dict[str, Exception]) -> None:
        """Log errors of robots, the same one of several together."""
        robots: dict[str, list[str]] = {}
        for robot, error in sorted(failed.items()):
            robots.setdefault(str(error), []).append(robot)
        for text, names in robots.items():
            what = f"Aborts of {listed_names(names)}" if names[1:] else f"the Abort of robot {names[0]!r}"
            if self._news.has(what, text):
                _explain(failed[names[0]], f"{what} cannot be stored")


def abort_id(stop: StopRow, robot: str) -> str:
    """Return the id of the Abort of a robot for a stop: the same whenever it is stored."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"emergency {stop.id} {robot}"))


def orders_of(stop: StopRow, robots: Sequence[str]) -> list[CommandOrder]:
    """Return the Aborts of a stop."""
    abort = Abort(emergency=True)
    return [CommandOrder(abort_id(stop, robot), robot, abort, stop.by, stop.reason) for robot in robots]


def _write_stop(stop: StopRow, robots: Sequence[str], connection: Connection) -> None:
    # This withdraws not only the messages of commands, but answers to GetPath, too.
    if emergency_stops.add(connection, stop):
        requests.remove_everywhere(connection, MOTION_OPS)
    else:
        # Another gateway stored it, and may have cleared it by now: its robots may be sent on.
        _withdraw_motions(robots, connection)


def _withdraw_motions(robots: Sequence[str], connection: Connection) -> None:
    requests.remove_kinds(connection, robots, MOTION_OPS)


def _write_bare(connection: Connection, robots: Sequence[str]) -> None:
    write_bare_aborts(connection, robots, MOTION_OPS, emergency=True)


def _use(connection: Connection) -> None:
    """Check that the database can be used; raises where it cannot."""
    connection.execute(select(1))


def _in_plain_letters(stop: StopRow) -> StopRow:
    return stop._replace(by=ascii(stop.by)[1:-1][:128], reason=None)


def _explain(error: Exception, text: str) -> None:
    if isinstance(error, StoreError):
        log.error("%s: %s", text, error)
    else:
        log.error(text, exc_info=error)
