"""Base of the role managers, and limits of robots' writes."""

from __future__ import annotations

import abc
from collections.abc import Iterable

from sqlalchemy import Connection, text

from ....core.errors import BridgeError
from ....core.messages.base import check_robot_name

LARGEST_PARAMS = 64 << 10
"""Bytes of a request's parameters."""
LARGEST_PAYLOAD = 15 << 20
"""Bytes of a request's payload, less than the default largest packet of MariaDB (16 MiB)."""
MOST_WAITING = 2_000
"""Requests of one robot that wait for the gateway; more are refused until some are processed."""
MOST_PAYLOADS = 64
"""Of those, requests with a payload."""
MOST_CONNECTIONS = 8
"""Connections of one robot."""
STATEMENT_SECONDS = 10
"""Seconds that a robot's statement or idle transaction may take, unless the robot changes that."""
LIMITS = {
    "params": LARGEST_PARAMS,
    "payload": LARGEST_PAYLOAD,
    "waiting": MOST_WAITING,
    "payloads": MOST_PAYLOADS,
}
"""The limits enforced by the tables and their triggers, by their names in the statements."""

_LONGEST_DATABASE = 40


class AccountError(BridgeError):
    """An account cannot be made, found or removed."""


class RoleManager(abc.ABC):
    """Makes and removes accounts over the connection of an administrator of the server.

    Every method needs existing tables and raises AccountError if it refuses; refusals of the server are
    SQLAlchemyError.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def add_robot(self, name: str, password: str) -> None:
        """Create a robot's account, which may write its own rows of RR, and read and delete its own of SA."""
        self._check_name(name)
        self._refuse_taken(name)
        self.prepare()
        self._make_robot(name, password)

    def remove_robot(self, name: str) -> None:
        """End a robot's connections, remove its account and its rows of RR and SA; its history stays."""
        self._require_robot(name)
        self._drop_robot(name)

    def rotate_robot(self, name: str, password: str) -> None:
        """Give a robot's account another password and end the connections made with the old one."""
        self._require_robot(name)
        self._set_password(name, password)
        self._end_connections(name)

    def add_gateway(self, name: str, password: str) -> None:
        """Create the account of the gateway: access to every table, but no right to alter one."""
        self._check_name(name)
        self._refuse_taken(name)
        self.prepare()
        self._make_gateway(name, password)

    @abc.abstractmethod
    def robots_database(self) -> str:
        """Return the name of the database that robots connect to."""

    @abc.abstractmethod
    def robots(self) -> list[str]:
        """Return the robots that have an account in this database, by name."""

    @abc.abstractmethod
    def gateways(self) -> list[str]:
        """Return the accounts that may run the gateway on this database, by name."""

    @abc.abstractmethod
    def prepare(self) -> None:
        """Set up the common parts of all accounts; repeated it changes nothing."""

    @abc.abstractmethod
    def renew_rights(self) -> None:
        """Grant the gateways' accounts the tables created by an upgrade."""

    @abc.abstractmethod
    def _exists(self, name: str) -> bool: ...

    @abc.abstractmethod
    def _make_robot(self, name: str, password: str) -> None: ...

    @abc.abstractmethod
    def _drop_robot(self, name: str) -> None: ...

    @abc.abstractmethod
    def _set_password(self, name: str, password: str) -> None: ...

    @abc.abstractmethod
    def _end_connections(self, name: str) -> None: ...

    @abc.abstractmethod
    def _make_gateway(self, name: str, password: str) -> None: ...

    def _check_name(self, name: str) -> None:
        check_robot_name(name)

    def _check_database(self, name: str) -> None:
        if len(name) > _LONGEST_DATABASE:
            raise AccountError(
                f"database name {name!r} is longer than {_LONGEST_DATABASE} characters, and accounts are "
                "named after it; rename the database"
            )

    def _delete_messages(self, robot: str, schema: str) -> None:
        """Delete a robot's rows in RR and SA, which are in ``schema`` (quoted)."""
        for table in ("rr", "sa"):
            delete = text(f"delete from {schema}.{table} where robot = :robot")  # nosec B608 # quoted
            self._connection.execute(delete, {"robot": robot})

    def _refuse_taken(self, name: str) -> None:
        if name in self.robots():
            raise AccountError(
                f"robot {name!r} has an account already; 'robot-bridge robots rotate {name}' gives it "
                f"another password, 'robot-bridge robots remove {name}' removes it"
            )
        if self._exists(name):
            raise AccountError(
                f"the server has an account {name!r} already, which is no robot of this database; "
                "choose another name, or remove that account on the server"
            )

    def _require_robot(self, name: str) -> None:
        known = self.robots()
        if name not in known:
            raise AccountError(
                f"robot {name!r} has no account in this database; those that have: "
                f"{', '.join(known) or 'none yet'}. 'robot-bridge robots add' makes one"
            )

    def _all(self, statements: Iterable[str]) -> None:
        for statement in statements:
            self._do(statement)

    def _do(self, statement: str) -> None:
        # Without parameters the drivers do not interpret percent signs.
        self._connection.exec_driver_sql(statement, execution_options={"no_parameters": True})

    def _names(self, query: str) -> list[str]:
        result = self._connection.exec_driver_sql(query, execution_options={"no_parameters": True})
        return sorted(set(result.scalars()))
