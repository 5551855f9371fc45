"""How an emergency stop and the Aborts of its robots get into the database, whatever is wrong with one robot.

All in one transaction where that can be done. Where it cannot, every robot is first sent a bare Abort, which
belongs to no command: inserts alone, which wait for nobody. Then the robots are halved until those are found
that were in the way: each group is a transaction of its own.
"""

from __future__ import annotations

import logging
import uuid
from collections.abc import Awaitable, Callable, Sequence
from functools import partial

from sqlalchemy import Connection
from sqlalchemy.exc import ProgrammingError

from ..command_life.open_command import Order
from ..commanding.book import CommandBook
from ..errors import DataRefusedError, StoreError, UncertainError
from ..messages import Abort, SetPath, SetPosEnd
from ..store import answers, emergency_stops
from ..store.database import Database
from ..store.emergency_stops import StopRow

log = logging.getLogger(__name__)

MOTIONS = (SetPosEnd, SetPath)
HELD_BACK = tuple(cls.__name__ for cls in MOTIONS)


class StopWriter:
    """Writes stops into the database; knows the robots whose Abort is not stored yet."""

    def __init__(self, book: CommandBook, database: Database) -> None:
        self._book = book
        self._database = database
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

    def clear(self) -> None:
        """Owe no robot an Abort: no stop is in force."""
        self._owed.clear()

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
            await self._book.issue(_orders(stop, robots), partial(_write_stop, stop))
            return True
        except UncertainError:
            raise
        except Exception as error:
            _explain(error, "the emergency stop cannot be stored in one transaction and is stored in several")
        is_listed = await self._list(stop)
        self.owe(stop, robots)
        failed = await self._halve(robots, self._send_bare)
        self._have_bare.update(set(robots).difference(failed))
        await self.write_owed()
        return is_listed

    async def write_owed(self) -> None:
        """Store the Aborts that could not be stored before.

        A robot whose Abort is refused, or fails for a reason nobody foresaw, is left with a bare one. What
        fails otherwise is tried again by the next call.

        :raises StoreError: when the database cannot be used.
        """
        by_stop: dict[StopRow, list[str]] = {}
        for robot, stop in self._owed.items():
            by_stop.setdefault(stop, []).append(robot)
        for stop, robots in by_stop.items():
            failed = await self._halve(sorted(robots), partial(self._issue, stop))
            for robot in robots:
                error = failed.get(robot)
                if error is None or await self._is_left_bare(robot, error):
                    self._owed.pop(robot, None)

    async def _is_left_bare(self, robot: str, error: Exception) -> bool:
        if isinstance(error, StoreError) and not isinstance(error, DataRefusedError):
            return False
        if robot not in self._have_bare and await self._halve([robot], self._send_bare):
            return False
        log.error("robot %r is sent an Abort that no command follows: look whether it stands", robot)
        return True

    async def _issue(self, stop: StopRow, robots: Sequence[str]) -> None:
        await self._book.issue(_orders(stop, robots), partial(_withdraw_motions, robots))

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


def _orders(stop: StopRow, robots: Sequence[str]) -> list[Order]:
    abort = Abort(emergency=True)
    return [Order(abort_id(stop, robot), robot, abort, stop.by, stop.reason) for robot in robots]


def _write_stop(stop: StopRow, connection: Connection) -> None:
    emergency_stops.add(connection, stop)
    # Some are no commands' messages, but answers to GetPath.
    answers.remove_everywhere(connection, HELD_BACK)


def _withdraw_motions(robots: Sequence[str], connection: Connection) -> None:
    for robot in robots:
        answers.remove_kinds(connection, robot, HELD_BACK)


def _write_bare(connection: Connection, robots: Sequence[str]) -> None:
    try:
        with connection.begin_nested():
            answers.remove_unlocked(connection, robots, HELD_BACK)
    except ProgrammingError as error:
        # A gateway's account of an older set-up may lock no rows. Without a lock it waits for those who do.
        log.warning("an administrator has to run: robot-bridge database upgrade (%s)", error.orig)
        for robot in robots:
            answers.remove_kinds(connection, robot, HELD_BACK)
    answers.add_all(connection, [(robot, Abort(emergency=True)) for robot in robots])


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
