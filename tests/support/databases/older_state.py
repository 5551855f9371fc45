"""An older state of a database, kept and put back by the tools of its own server, or as a file of SQLite."""

from __future__ import annotations

import contextlib
import math
import os
import shutil
import sqlite3
import subprocess
from pathlib import Path

from sqlalchemy import make_url

from tests.support.databases.database_server import find_program
from tests.support.operators import Desk

TOOLS = {"postgresql": ("pg_dump", "pg_restore"), "mariadb": ("mariadb-dump", "mariadb")}


def abort_there(desk: Desk, robot: str) -> None:
    """Send a robot on that has met another database, and abort it; fail unless it stands soon."""

    def speed() -> float:
        found = desk.robots.get(robot, {})
        return abs(found["v"]) if found.get("v") is not None and found["age"] < 1.0 else math.nan

    # Its task is in no other database.
    desk.until(lambda: speed() < 0.02, 20)
    desk.send(f"target-there-{robot}", robot, "SetPosEnd", x=180.0, y=23.0)
    desk.until(lambda: speed() > 0.1, 20)
    desk.send(f"abort-there-{robot}", robot, "Abort")
    desk.until(lambda: speed() < 0.02)


class OlderState:
    """The database at ``url`` as it is now, kept in ``folder``."""

    def __init__(self, url: str, folder: Path):
        self._url = make_url(url)
        self._kind = self._url.get_backend_name()
        self._copy = folder / "older"
        if self._kind == "sqlite":
            with (
                contextlib.closing(sqlite3.connect(str(self._url.database))) as now,
                contextlib.closing(sqlite3.connect(self._copy)) as then,
            ):
                now.backup(then)
            return
        options = ["-Fc"] if self._kind == "postgresql" else ["--single-transaction"]
        with self._copy.open("wb") as kept:
            subprocess.run([*self._tool(0), *options, str(self._url.database)], **self._run, stdout=kept)

    def put_back(self) -> None:
        """Have the database be as it was."""
        if self._kind == "sqlite":
            file = Path(str(self._url.database))
            for end in ("-wal", "-shm"):
                file.with_name(f"{file.name}{end}").unlink()
            shutil.copyfile(self._copy, file)
            return
        options = ["--clean", "--if-exists", "-d"] if self._kind == "postgresql" else []
        with self._copy.open("rb") as kept:
            subprocess.run([*self._tool(1), *options, str(self._url.database)], **self._run, stdin=kept)

    def _tool(self, which: int) -> list[str]:
        tool = find_program(TOOLS[self._kind][which])
        host, port, user = str(self._url.host), str(self._url.port), str(self._url.username)
        if self._kind == "postgresql":
            return [tool, "-h", host, "-p", port, "-U", user]
        return [tool, "--no-defaults", "--protocol=tcp", "-h", host, "-P", port, "-u", user]

    @property
    def _run(self) -> dict[str, object]:
        password = str(self._url.password)
        return {"check": True, "env": {**os.environ, "PGPASSWORD": password, "MYSQL_PWD": password}}
