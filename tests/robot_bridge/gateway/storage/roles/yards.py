"""A real database with the tables of the bridge and an account for each robot and for the gateway."""

from __future__ import annotations

import contextlib
import secrets
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import psycopg
import pymysql
import sqlalchemy

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from robot_bridge.gateway.storage.schema import metadata

MINE, OTHER = ROBOTS = ("iso-1", "iso-2")
GATEWAY = "iso-gateway"
SECRET = "secret of another robot"


class RefusedError(Exception):
    """What the database says no to; ``code`` is PostgreSQL's SQLSTATE or MariaDB's number."""

    def __init__(self, code: Any, text: str):
        super().__init__(f"{code}: {text}")
        self.code = code


@dataclass
class Yard:
    """One database; ``side`` is the name of the one that robots connect to."""

    server: Any
    url: str
    passwords: dict[str, str]
    _open: dict[str, Session] = field(default_factory=dict)
    _pid: int = 0
    _stack: contextlib.ExitStack = field(default_factory=contextlib.ExitStack)

    @property
    def kind(self) -> str:
        return self.server.scheme

    @property
    def name(self) -> str:
        return self.url.rsplit("/", 1)[1]

    @property
    def side(self) -> str:
        return self.name if self.kind == "postgresql" else f"{self.name}_robots"

    @property
    def base(self) -> str:
        """Where the tables are, as a statement names it."""
        return "public" if self.kind == "postgresql" else self.name

    @property
    def admin(self) -> str:
        return self.server.admin_url(self.url)

    def address(self, account: str) -> str:
        """Return the URL that ``account`` connects to."""
        database = self.name if account == GATEWAY else self.side
        return self.server.url(database, account, self.passwords[account])

    @contextlib.contextmanager
    def session(self, account: str) -> Iterator[Session]:
        """A connection of its own for ``account``, or for ``admin``; each statement is a transaction."""
        url = sqlalchemy.make_url(self.admin if account == "admin" else self.address(account))
        if self.kind == "postgresql":
            connection = psycopg.connect(
                host=url.host,
                port=url.port,
                user=url.username,
                password=url.password,
                dbname=url.database,
                autocommit=True,
            )
        else:
            connection = pymysql.connect(
                host=url.host,
                port=url.port,
                user=url.username,
                password=url.password,
                database=url.database,
                autocommit=True,
            )
        with contextlib.closing(connection):
            yield Session(connection)

    def of(self, account: str) -> Session:
        """Return a connection of ``account`` that stays open for the next who asks."""
        if self._pid != self.server.pid:  # another test killed the server, and started it again
            self.close()
            self._pid = self.server.pid
        if account not in self._open:
            self._open[account] = self._stack.enter_context(self.session(account))
        return self._open[account]

    def close(self) -> None:
        """Close what :meth:`of` has opened."""
        self._stack.close()
        self._open.clear()

    def sql(self, statement: str) -> list[tuple[Any, ...]]:
        """Run a statement as the administrator."""
        return self.of("admin").run(statement)

    def fill(self) -> None:
        """Put one row of each robot into RR and SA, and nothing else."""
        for robot in ROBOTS:
            self.of(robot).run(f"insert into rr (op, params) values ('GetMap', '{robot}: {SECRET}')")
            self.sql(f"insert into sa (robot, op, params) values ('{robot}', 'Start', '{robot}: {SECRET}')")

    def empty(self) -> None:
        """Take every row out of RR and SA."""
        for table in ("rr", "sa"):
            self.sql(f"delete from {table}")

    def content(self) -> list[tuple[Any, ...]]:
        """Return every row of every table but the audit log, each as a text; on MariaDB a sum of each table.

        In one statement: hundreds of attempts are looked at so, before and after.
        """
        names = [name for name in metadata.tables if name != "audit"]
        if self.kind == "mariadb":
            return self.sql(f"checksum table {', '.join(names)}")
        return self.sql(" union all ".join(f"select '{name}', t::text from {name} t" for name in names))


class Session:
    """One connection."""

    def __init__(self, connection: Any):
        self._connection = connection

    def run(self, statement: str) -> list[tuple[Any, ...]]:
        """Return the rows of a statement; raises RefusedError."""
        cursor = self._do(statement)
        return [tuple(row) for row in cursor.fetchall()] if cursor.description else []

    def change(self, statement: str) -> int:
        """Return how many rows a statement changed; raises RefusedError."""
        return self._do(statement).rowcount

    def _do(self, statement: str) -> Any:
        cursor = self._connection.cursor()
        try:
            cursor.execute(statement)
        except psycopg.Error as error:
            raise RefusedError(error.sqlstate, str(error)) from None
        except pymysql.Error as error:
            raise RefusedError(error.args[0], str(error)) from None
        return cursor


def make_yard(server: Any) -> Yard:
    """Make the tables, and the accounts as the command line makes them."""
    yard = Yard(server, server.new_database(), {})
    run_once(yard.url, revisions.create)
    yard.passwords = {name: secrets.token_urlsafe(12) for name in (*ROBOTS, GATEWAY)}
    run_once(yard.admin, _add_accounts, yard.passwords)
    return yard


def _add_accounts(connection: Any, passwords: dict[str, str]) -> None:
    keeper = role_manager_on(connection)
    for name in ROBOTS:
        keeper.add_robot(name, passwords[name])
    keeper.add_gateway(GATEWAY, passwords[GATEWAY])


def remove_accounts(yard: Yard) -> None:
    """Take the accounts away again: they belong to the server, which other tests use."""
    for name in ROBOTS:
        run_once(yard.admin, lambda connection, name=name: role_manager_on(connection).remove_robot(name))
