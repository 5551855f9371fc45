"""A PostgreSQL server of one's own."""

from __future__ import annotations

import base64
import hashlib
import hmac
import secrets
import signal
from pathlib import Path

from tests.support.databases.database_server import OWNER, DatabaseServer, find_program

FIRST_PASSWORD = "new"
"""The superuser's before a server has begun to serve."""


class PostgreSql(DatabaseServer):
    """PostgreSQL 15 or newer, with passwords (SCRAM) for everyone."""

    scheme = "postgresql"
    account = "postgres"
    admin = "postgres"
    programs = ("postgres", "initdb", "pg_isready", "psql")
    ending = signal.SIGINT  # the fast shutdown: it waits for no client

    def sql(self, text: str, database: str | None = None) -> str:
        return self._ask(text, database or "postgres", self.admin_password)

    def _ask(self, text: str, database: str, password: str) -> str:
        address = ["-h", "127.0.0.1", "-p", str(self.port), "-U", self.admin, "-d", database]
        options = ["-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1"]
        return self._require([self._program("psql"), *options, *address], text, PGPASSWORD=password).strip()

    def copied_database(self, model: str) -> str:
        """Make a copy of the database named so, to which nobody is connected; return its owner's URL."""
        name = f"copy_{next(self._numbers)}"
        # By files: to log each page takes three times as long.
        self.sql(f'create database "{name}" template "{model}" owner {OWNER} strategy file_copy')
        return self.url(name, OWNER, self.owner_password)

    def _options(self) -> list[str]:
        return ["--no-sync", "-A", "scram-sha-256", "-U", self.admin, "-E", "UTF8", "--locale=C.UTF-8"]

    def _initialise(self) -> None:
        secret = self.folder / "password"
        secret.write_text(FIRST_PASSWORD, encoding="utf-8")
        self._give(secret)
        where = [f"--pwfile={secret}", "-D", str(self.folder / "data")]
        self._require([*self._as_account(), self._program("initdb"), *self._options(), *where])

    def _command(self) -> list[str | Path]:
        settings = {
            "listen_addresses": "127.0.0.1",
            "port": str(self.port),
            "unix_socket_directories": str(self.folder),
            "max_connections": "200",
        }
        if not self.durable:
            # What is committed still outlives a kill of the server, though not of the computer.
            settings |= {"fsync": "off", "full_page_writes": "off", "max_wal_size": "128MB"}
        given = [word for name, value in settings.items() for word in ("-c", f"{name}={value}")]
        return [self._program("postgres"), "-D", self.folder / "data", *given]

    def _answers(self) -> bool:
        ask = [self._program("pg_isready"), "-q", "-h", "127.0.0.1", "-p", str(self.port)]
        return self._run(ask).returncode == 0

    def _make_owner(self) -> None:
        text = (
            f"alter role {self.admin} password '{_quick_secret(self.admin_password)}';"
            f"create role {OWNER} login password '{_quick_secret(self.owner_password)}'"
        )
        self._ask(text, "postgres", FIRST_PASSWORD)

    def _create_database(self, name: str) -> None:
        self.sql(f'create database "{name}" owner {OWNER}')

    def _program(self, name: str) -> str:
        newest_first = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
        return find_program(name, *map(str, newest_first))


def _quick_secret(password: str) -> str:
    """Return a SCRAM secret as PostgreSQL stores it, of one round in place of 4096: tests connect often."""
    salt, rounds = secrets.token_bytes(16), 1
    salted = hashlib.pbkdf2_hmac("sha256", password.encode(), salt, rounds)
    client, server = (hmac.digest(salted, name, "sha256") for name in (b"Client Key", b"Server Key"))
    salt, stored, server = (
        base64.b64encode(key).decode() for key in (salt, hashlib.sha256(client).digest(), server)
    )
    return f"SCRAM-SHA-256${rounds}:{salt}${stored}:{server}"
