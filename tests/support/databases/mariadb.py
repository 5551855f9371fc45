"""A MariaDB server of one's own."""

from __future__ import annotations

from pathlib import Path

from tests.support.databases.database_server import OWNER, DatabaseServer


class MariaDb(DatabaseServer):
    """MariaDB 10.11 or newer, with passwords for everyone."""

    scheme = "mariadb"
    account = "mysql"
    admin = "root"
    programs = ("mariadbd", "mariadb-install-db", "mariadb-admin", "mariadb")

    def sql(self, text: str, database: str | None = None) -> str:
        address = ["--protocol=tcp", "-h", "127.0.0.1", "-P", str(self.port), "-u", self.admin]
        options = ["--no-defaults", "--batch", "--skip-column-names", *address, database or "mysql"]
        return self._require(
            [self._program("mariadb"), *options], text, MYSQL_PWD=self.admin_password
        ).strip()

    def _options(self) -> list[str]:
        return ["--skip-test-db", "--auth-root-authentication-method=normal", "--skip-name-resolve"]

    def _initialise(self) -> None:
        options = ["--no-defaults", f"--datadir={self.folder / 'data'}", *self._options()]
        # Each server removes what it finds of others in the folder for temporary tables.
        install = [*self._as_account(), self._program("mariadb-install-db"), *options]
        self._require(install, TMPDIR=str(self.folder))

    def _command(self) -> list[str | Path]:
        options = [
            f"--datadir={self.folder / 'data'}",
            f"--tmpdir={self.folder}",
            f"--socket={self.folder / 'mariadb.sock'}",
            f"--pid-file={self.folder / 'mariadb.pid'}",
            f"--port={self.port}",
            "--bind-address=127.0.0.1",
            "--max-connections=200",
            "--character-set-server=utf8mb4",
        ]
        if not self.durable:
            # What is committed still outlives a kill of the server, though not of the computer.
            options += ["--innodb-flush-log-at-trx-commit=2", "--innodb-flush-method=nosync"]
        return [self._program("mariadbd"), "--no-defaults", *options]

    def _answers(self) -> bool:
        # A ping succeeds without a password too, but not while nobody listens.
        address = ["--no-defaults", "--protocol=tcp", "-h", "127.0.0.1", "-P", str(self.port)]
        return self._run([self._program("mariadb-admin"), *address, "ping"]).returncode == 0

    def _make_owner(self) -> None:
        # A new server's root has no password and is reached over the socket.
        socket = f"--socket={self.folder / 'mariadb.sock'}"
        text = (
            "drop user if exists ''@'localhost', ''@'%';"
            f"set password for root@localhost = password('{self.admin_password}');"
            f"create or replace user root@'127.0.0.1' identified by '{self.admin_password}';"
            "grant all on *.* to root@'127.0.0.1' with grant option;"
            f"create user {OWNER}@'127.0.0.1' identified by '{self.owner_password}';"
        )
        self._require([self._program("mariadb"), "--no-defaults", socket, "-u", "root"], text)

    def _create_database(self, name: str) -> None:
        self.sql(f"create database `{name}`; grant all on `{name}`.* to {OWNER}@'127.0.0.1'")
