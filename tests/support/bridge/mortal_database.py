"""A database whose gateway dies at one of its transactions, as by SIGKILL: before the commit, or after it.

Or the transaction fails, and the gateway lives on: the database's server is away for a moment.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from robot_bridge.core.errors import StoreError, UncertainError
from robot_bridge.gateway.storage.database import Database, DatabaseWorker, _settle, shown
from robot_bridge.gateway.storage.dialects import PATIENCE_S
from robot_bridge.gateway.storage.schema import sa

_ENGINES: dict = {}
"""One for each address: to compile statements anew takes SQLAlchemy longer than the database to do them."""


FAILURES = [(False, StoreError), (False, UncertainError), (True, UncertainError)]
"""Whether the transaction that fails is done, and what its error says about that."""


def newest_message(connection):
    """Return the id of the newest message to a robot, or 0; by the driver: plays ask for it very often."""
    cursor = connection.connection.driver_connection.cursor()
    cursor.execute(f"select max(id) from {sa.name}")
    ((newest,),) = cursor.fetchall()
    cursor.close()
    return newest or 0


class Killed(BaseException):
    """The gateway's process is gone; no Exception, so that nothing in it can live on."""


@dataclass
class Death:
    """When the gateway dies: at the transaction number ``at`` (from 1), its commit ``done`` or not.

    With ``fails`` it does not die of it: the transaction raises such an error. Over several gateways the
    transactions are counted on; it comes once. With ``at`` 0 it never comes. ``writing`` are those that
    changed something, as far as that can be told; to die of others is nothing new.
    """

    at: int = 0
    done: bool = False
    fails: type[StoreError] | None = None
    count: int = 0
    writing: set[int] = field(default_factory=set)

    def comes(self) -> bool:
        """Count a transaction, and tell whether it is the one."""
        self.count += 1
        return self.count == self.at

    @property
    def has_come(self) -> bool:
        """Whether the gateway has died."""
        return 0 < self.at <= self.count


class WorkerInPlace(DatabaseWorker):
    """Does each job at once, in the thread that asks for it: plays are many, and wait for no other thread."""

    def submit(self, job):
        """Do ``job``; its future tells in the next round of the loop, which no thread has to wake."""
        job.loop.call_soon(_settle, self._do([job]))

    def close(self, timeout):
        """Close the connection."""
        self._drop()
        super().close(timeout)


class MortalDatabase(Database):
    """The database of one gateway; when that has died nothing is written or read any more."""

    def __init__(self, address: str, death: Death):
        super().__init__(address)
        self._engine, self.dialect = _ENGINES.setdefault(address, (self._engine, self.dialect))
        self._worker = WorkerInPlace(self._engine, self.dialect, shown(self.url), PATIENCE_S, self.offences)
        self.death = death
        self.dead = False

    async def run(self, work, *arguments):
        """Run ``work``, unless the gateway dies of it, or is dead."""
        return await self._live_through(super().run, work, *arguments)

    async def run_aside(self, work, *arguments):
        """As :meth:`run`, one after the other: nobody keeps anybody waiting here."""
        return await self.run(work, *arguments)

    async def write_relaxed(self, work, *arguments):
        """As :meth:`run`, for work that gives out no message: its id would come again after a power cut."""

        def checked(connection, *arguments):
            before = newest_message(connection)
            result = work(connection, *arguments)
            assert newest_message(connection) <= before, f"{work} gives out a message"
            return result

        return await self._live_through(super().write_relaxed, checked, *arguments)

    async def read(self, work, *arguments):
        """Read, unless the gateway is dead: reading changes nothing, so that it does not die here."""
        self._check()
        return await super().read(work, *arguments)

    async def version(self):
        """As :meth:`read`."""
        self._check()
        return await super().version()

    async def _live_through(self, transaction, work, *arguments):
        self._check()
        dies = self.death.comes()
        number = self.death.count

        def noted(connection, *arguments):
            driver = connection.connection.driver_connection
            before = getattr(driver, "total_changes", 0)
            result = work(connection, *arguments)
            if getattr(driver, "total_changes", 1) != before:
                self.death.writing.add(number)
            return result

        if dies:
            self.dead = self.death.fails is None
            if self.death.done:
                await transaction(noted, *arguments)
            raise Killed if self.death.fails is None else self.death.fails("the server is away")
        return await transaction(noted, *arguments)

    def _check(self):
        if self.dead:
            raise Killed
