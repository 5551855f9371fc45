"""Robots' accounts, made as whoever runs a site makes them."""

from __future__ import annotations

import itertools
import subprocess
from pathlib import Path

from sqlalchemy import make_url

from tests.support.bridge.command_line import run_command

NUMBERS = itertools.count(1)


class Accounts:
    """Makes accounts in a database server and takes them away; SQLite has none, and needs none."""

    def __init__(self, kind: str, admin_url: str, folder: Path):
        self._kind, self._admin_url, self._folder = kind, admin_url, folder
        self._names: list[str] = []

    def add(self, database: str) -> tuple[str, str]:
        """Make a robot's account; return its name and its URL."""
        name = f"robot{next(NUMBERS)}"
        if self._kind == "sqlite":
            return name, database
        secret = self._folder / f"{name}.password"
        secret.write_text(f"Secret-{name}\n", encoding="utf-8")
        secret.chmod(0o600)
        said = self._run("add", name, "--password-file", str(secret)).stderr
        self._names.append(name)
        url = make_url(said.rsplit(" connects to ", 1)[1].strip())
        return name, url.set(password=f"Secret-{name}").render_as_string(hide_password=False)

    def remove(self) -> None:
        """Take the accounts away: they belong to the server, not to the database."""
        for name in self._names:
            self._run("remove", name)

    def _run(self, *words: str) -> subprocess.CompletedProcess[str]:
        done = run_command("robots", *words, "--database", self._admin_url)
        assert done.returncode == 0, done.stderr
        return done
