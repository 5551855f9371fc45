"""A yard of robots, twenty if nothing else is asked for, on each kind of database, to the audit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.support.databases.database_server import DatabaseServer
from tests.support.databases.mariadb import MariaDb
from tests.support.databases.postgresql import PostgreSql
from tests.support.faults.audit import Findings, audit
from tests.support.faults.disk import Disk
from tests.support.faults.proxy import Proxy
from tests.support.faults.yard import Yard, server_place, sqlite_place

ROBOTS = 20
AFTERWARDS_S = 1.5
"""seconds in which commands are sent after the last fault."""
SERVERS: dict[str, type[DatabaseServer]] = {"postgresql": PostgreSql, "mariadb": MariaDb}


def broken_on_sqlite(folder: Path, seed: int, break_it: Callable[[Yard], None]) -> Findings:
    """Let a yard on a new SQLite database work in ``folder`` while ``break_it`` does what it does to it."""
    return _broken(Yard(folder, sqlite_place(folder, ROBOTS), seed), break_it)


def broken_on_small_disk(
    folder: Path, seed: int, break_it: Callable[[Yard, Disk], None], robots: int = ROBOTS
) -> Findings:
    """As :func:`broken_on_sqlite`, with the database on a disk that can be filled."""
    with Disk(folder / "disk") as disk:
        place = sqlite_place(disk.folder, robots)
        return _broken(Yard(folder, place, seed), lambda yard: break_it(yard, disk))


def broken_on_server(
    kind: str, folder: Path, seed: int, break_it: Callable[[Yard], None], robots: int = ROBOTS
) -> Findings:
    """As :func:`broken_on_sqlite`, on a new server that waits for the disk at every commit.

    The network between it and the gateway can be cut. Raises StageError where no such server is installed.
    """
    server = SERVERS[kind](durable=True)
    server.require_programs()
    with server, Proxy(server.port) as network:
        return _broken(Yard(folder, server_place(server, network, robots), seed), break_it)


def _broken(yard: Yard, break_it: Callable[[Yard], None]) -> Findings:
    with yard:
        break_it(yard)
        yard.work(AFTERWARDS_S, AFTERWARDS_S)
        yard.finish()
        return audit(yard)
