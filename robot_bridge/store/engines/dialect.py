"""What the bridge asks of a kind of database; the default is a database that needs nothing special."""

from __future__ import annotations

from enum import IntEnum
from typing import Any, ClassVar

from sqlalchemy import URL, Connection, Engine, Transaction
from sqlalchemy.exc import DataError, DBAPIError, IntegrityError, SQLAlchemyError, StatementError

CONNECT_TIMEOUT_S = 5
LOCK_TIMEOUT_S = 1
"""How long the gateway waits for a lock before it makes way (see :mod:`..accounts.stuck`)."""
PATIENCE_S = 10
"""How long one statement may take: a server that is dead or frozen must not hold up the gateway for ever."""


class Mode(IntEnum):
    """What a transaction is for; of several that are done together the highest counts."""

    READ = 1
    """It changes nothing."""
    JOT = 2
    """What it changes may be lost in a power cut, though never before what was changed earlier."""
    WRITE = 3
    """What it changes outlives a power cut."""


class Dialect:
    """One kind of database. ``patience`` is seconds for a statement, or None where a long one is expected."""

    name: ClassVar[str]
    advice: ClassVar[str] = "check that the server runs and that this account may use the database"
    made_by_serve: ClassVar[bool] = False
    """Whether a gateway makes a database that is missing."""
    has_version: ClassVar[bool] = False
    """Whether it can be asked cheaply if another connection wrote (see :meth:`version`)."""
    listens: ClassVar[bool] = False
    """Whether the database tells its readers of new rows (see :mod:`..wakeups`)."""

    def engine(self, url: URL, patience: float | None) -> Engine:
        """Return an engine on ``url``; raises ModuleNotFoundError when its driver is not installed."""
        raise NotImplementedError

    def begin(self, connection: Connection, mode: Mode) -> Transaction:
        """Begin a transaction."""
        return connection.begin()

    def version(self, connection: Connection) -> int | None:
        """Return a number that changes when another connection wrote, or None where there is none."""
        return None

    def backend(self, connection: Connection) -> int | None:
        """Return the number under which notifications of this connection come, or None."""
        return None

    def doze(self, connection: Connection) -> bool:
        """Have those who write into RR tell of it from now on; false while one writes who does not."""
        return False

    def rouse(self, connection: Connection) -> None:
        """Let those who write into RR tell nobody of it."""

    def interrupt(self, driver_connection: Any) -> None:
        """End the wait of another thread for a server that does not answer."""

    def deadlocked(self, error: DBAPIError) -> bool:
        """Tell whether the database gave up this transaction for another's sake: it may be repeated."""
        return False

    def kept_waiting(self, error: DBAPIError) -> bool:
        """Tell whether somebody else held a lock for too long."""
        return False

    def refuses_data(self, error: SQLAlchemyError) -> bool:
        """Tell whether the values were wrong, and not the database out of order."""
        if isinstance(error, (DataError, IntegrityError)):
            return True
        return isinstance(error, StatementError) and not isinstance(error, DBAPIError)

    def cause(self, error: SQLAlchemyError) -> str:
        """Return in one line what the database said."""
        return " ".join(str(getattr(error, "orig", None) or error).split())
