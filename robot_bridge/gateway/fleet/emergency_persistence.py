"""Persistence of emergency stops: a journal file of this computer, then the database."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import logging
import os
import time
import uuid
from collections.abc import Awaitable, Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection
from sqlalchemy.exc import ProgrammingError

from ...core.errors import BridgeError, DataRefusedError, StoreError, UncertainError
from ...core.files import write_state, write_state_into
from ...core.json_decoder import DecodingError, decode_json
from ...core.logs import TroubleNews
from ...core.messages.base import MessageError, check_command_id
from ...core.messages.robots import Abort, SetPath, SetPosEnd
from ..commands.active_command import CommandOrder
from ..commands.service import CommandService
from ..storage.database import Database
from ..storage.dialects import sqlite_file_of
from ..storage.repositories import emergency_stops, requests
from ..storage.repositories.emergency_stops import StopRow
from ..storage.repositories.robots import FencedError

# --- Emergency stops in force, or on their way into the database, in a small file of this computer ---
# A stop goes out before it is stored. Where the database is away then, and the gateway dies before it is
# back, or where an older state of the database is put back, the next gateway knows of the stop by this file.

log = logging.getLogger(__name__)


def journal_file(database: URL, folder: Path, gateway: str | None = None) -> Path | None:
    """Return the file for the stops of a gateway on ``database``; None for a database in memory.

    Beside the file of an SQLite database, else in ``folder``: gateways of several databases may share that,
    and those of one that have names, each a ``gateway``.
    """
    if database.get_backend_name() == "sqlite":
        file = sqlite_file_of(database)
        return None if file is None else Path(f"{file}.stop")
    of = f"{database.host}:{database.port}/{database.database}"
    name = "" if gateway is None else f"-{gateway}"
    return folder / f"emergency-stop-{hashlib.sha256(of.encode()).hexdigest()[:12]}{name}.json"


FULL = (errno.ENOSPC, errno.EDQUOT)
ROOM = 16_384
"""bytes that are set aside for stops on a disk that is full by then."""


class StopJournal:
    """The stops in force or not stored, as they were written down last; no file where there are none."""

    def __init__(self, file: Path) -> None:
        self._file = file
        # Two: the second stop on a full disk is noted before the first one's room is free again.
        self._rooms = [file.with_name(f".{file.name}.{name}") for name in ("room", "spare")]
        # One thread: what is written last is what stands there in the end.
        self._thread = ThreadPoolExecutor(1, "emergency stops")

    def check(self) -> None:
        """Raise BridgeError when stops could not be written down; set room aside for them."""
        folder = self._file.parent
        if not (folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)):
            raise BridgeError(
                f"emergency stops cannot be noted in folder {folder}, which is missing or not to be written: "
                "one that is made while the database is away would be forgotten with this gateway; make the "
                "folder, or give another one with --state or ROBOT_BRIDGE_STATE"
            )
        self._set_room_aside()

    def write(self, stops: Sequence[StopRow]) -> Future[None]:
        """Write down ``stops``, and no others; done when they are on the disk.

        What cannot be written is told to the log: it must keep no stop from going out.
        """
        return self._thread.submit(self._write, list(stops))

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
                self._write_text(json.dumps([_plain(stop) for stop in stops]).encode())
            else:
                self._file.unlink(missing_ok=True)
                self._set_room_aside()
        except Exception as error:
            why = (error.strerror if isinstance(error, OSError) else None) or error
            log.error("emergency stops cannot be noted in %s: %s; they go out all the same", self._file, why)

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
        # On a disk that is full already there is none; what cannot be noted then is told to the log.
        for room in self._rooms:
            with contextlib.suppress(OSError):
                if not room.is_file():
                    write_state(room, b" " * ROOM, mode=0o600)


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


# --- How an emergency stop and the Aborts of its robots get into the database, whatever is wrong with one
# robot All in one transaction where that can be done. Where it cannot, every robot is first sent a bare
# Abort, which
# belongs to no command: inserts alone, which wait for nobody. Then the robots are halved until those are
# found
# that were in the way: each group is a transaction of its own.

MOTIONS = (SetPosEnd, SetPath)
HELD_BACK = tuple(cls.__name__ for cls in MOTIONS)


class StopWriter:
    """Writes stops into the database; knows the robots whose Abort is not stored yet."""

    def __init__(self, commands: CommandService, database: Database) -> None:
        self._commands = commands
        self._database = database
        self._news = TroubleNews()
        self._owed: dict[str, StopRow] = {}
        self._have_bare: set[str] = set()
        """those of them that were sent a bare Abort."""

    @property
    def is_owing(self) -> bool:
        """Whether some robot's Abort is not stored."""
        return bool(self._owed)

    def forget(self, robot: str) -> None:
        """Owe a robot no Abort: it was removed."""
        self._owed.pop(robot, None)

    def end(self) -> None:
        """Leave the Aborts that are owed still to the book, which stores them first: the stop is over."""
        self._commands.keep_aborts(
            order for robot, stop in self._owed.items() for order in orders_of(stop, [robot])
        )
        self._owed.clear()
        self._news = TroubleNews()

    def owe(self, stop: StopRow, robots: Sequence[str]) -> None:
        """Have the next :meth:`write_owed` send ``robots`` the Abort of ``stop``."""
        self._owed.update(dict.fromkeys(robots, stop))
        self._have_bare.difference_update(robots)

    async def write(self, stop: StopRow, robots: Sequence[str]) -> bool:
        """Store a stop with the Aborts of ``robots``.

        Return false where the database refuses the stop as data; the Aborts are stored all the same.

        :raises StoreError: when the database cannot be used; the stop is then to be written again.
        """
        try:
            await self._commands.issue(orders_of(stop, robots), partial(_write_stop, stop, robots))
            return True
        except UncertainError:
            raise
        except Exception as error:
            text = "the emergency stop cannot be stored in one transaction and is stored in several"
            # On a full disk this is tried every few seconds for as long as that lasts.
            if self._news.has(stop.id, str(error)):
                _explain(error, text)
        is_listed = await self._list(stop)
        self.owe(stop, robots)
        failed = await self._halve(robots, self._send_bare)
        self._have_bare.update(set(robots).difference(failed))
        await self.write_owed()
        return is_listed

    async def write_owed(self) -> None:
        """Store the Aborts that could not be stored before.

        A robot whose Abort is refused, or fails for a reason nobody foresaw, is left with a bare one; one
        that another gateway has by now is left to that. What fails otherwise is tried again by the next call.

        :raises StoreError: when the database cannot be used.
        """
        by_stop: dict[StopRow, list[str]] = {}
        for robot, stop in self._owed.items():
            by_stop.setdefault(stop, []).append(robot)
        for stop, robots in by_stop.items():
            failed = await self._halve(sorted(robots), partial(self._issue, stop))
            for robot in robots:
                error = failed.get(robot)
                if error is None or await self._is_settled(robot, error):
                    self._owed.pop(robot, None)

    async def _is_settled(self, robot: str, error: Exception) -> bool:
        if isinstance(error, FencedError):
            # The gateway that has the robot by now knows of the stop, and sends it that Abort.
            return True
        if isinstance(error, StoreError) and not isinstance(error, DataRefusedError):
            return False
        if robot not in self._have_bare and await self._halve([robot], self._send_bare):
            return False
        log.error("robot %r is sent an Abort that no command follows: look whether it stands", robot)
        return True

    async def _issue(self, stop: StopRow, robots: Sequence[str]) -> None:
        await self._commands.issue(orders_of(stop, robots), partial(_withdraw_motions, robots))

    async def _send_bare(self, robots: Sequence[str]) -> None:
        await self._database.run(_write_bare, robots)

    async def _list(self, stop: StopRow) -> bool:
        """Store the stop alone; in plain letters and without a reason where the database refuses it."""
        for row in (stop, _in_plain_letters(stop)):
            try:
                await self._database.run(emergency_stops.add, row)
                return True
            except DataRefusedError as error:
                log.error("emergency stop %s: %s", ascii(row.id), error)
        return False

    async def _halve(
        self, robots: Sequence[str], write: Callable[[Sequence[str]], Awaitable[None]]
    ) -> dict[str, Exception]:
        """Write for all ``robots`` at once, else half by half; return those for which it failed, and why.

        :raises StoreError: when it failed since the database cannot be used.
        """
        if not robots:
            return {}
        try:
            await write(robots)
            return {}
        except Exception as error:
            await self._database.run(_use)
            if len(robots) == 1:
                _explain(error, f"the Abort of robot {robots[0]!r} cannot be stored")
                return {robots[0]: error}
        half = len(robots) // 2
        return {**await self._halve(robots[:half], write), **await self._halve(robots[half:], write)}


def abort_id(stop: StopRow, robot: str) -> str:
    """Return the id of the command that tells a robot of a stop: the same whenever it is stored."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{stop.id} {robot}"))


def orders_of(stop: StopRow, robots: Sequence[str]) -> list[CommandOrder]:
    """Return the Aborts of a stop."""
    abort = Abort(emergency=True)
    return [CommandOrder(abort_id(stop, robot), robot, abort, stop.by, stop.reason) for robot in robots]


def _write_stop(stop: StopRow, robots: Sequence[str], connection: Connection) -> None:
    # What is withdrawn is not commands' messages alone, but answers to GetPath, too.
    if emergency_stops.add(connection, stop):
        requests.remove_everywhere(connection, HELD_BACK)
    else:
        # Another gateway stored it, and may have cleared it by now: its robots may be sent on.
        _withdraw_motions(robots, connection)


def _withdraw_motions(robots: Sequence[str], connection: Connection) -> None:
    requests.remove_kinds(connection, robots, HELD_BACK)


def _write_bare(connection: Connection, robots: Sequence[str]) -> None:
    try:
        with connection.begin_nested():
            requests.remove_unlocked(connection, robots, HELD_BACK)
    except ProgrammingError as error:
        # A gateway's account of an older set-up may lock no rows. Without a lock it waits for those who do.
        log.warning("an administrator has to run: robot-bridge database upgrade (%s)", error.orig)
        requests.remove_kinds(connection, robots, HELD_BACK)
    requests.add_answers(connection, [(robot, Abort(emergency=True)) for robot in robots])


def _use(connection: Connection) -> None:
    """Use the database: raises where it cannot be used at all."""
    emergency_stops.ids(connection, most=1)


def _in_plain_letters(stop: StopRow) -> StopRow:
    return stop._replace(by=ascii(stop.by)[1:-1][:128], reason=None)


def _explain(error: Exception, text: str) -> None:
    if isinstance(error, StoreError):
        log.error("%s: %s", text, error)
    else:
        log.error(text, exc_info=error)
