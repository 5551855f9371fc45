"""The command line of accounts on a bridge's database."""

from __future__ import annotations

import subprocess

from tests.support.bridge.command_line import run_command


class Accounts:
    """The command line on one database."""

    def __init__(self, database: str):
        self.database = database

    def run(self, *words: object) -> subprocess.CompletedProcess[str]:
        """Run ``robot-bridge`` with these words on the database."""
        return run_command(*words, "--database", self.database)

    def do(self, *words: object) -> str:
        """Run what must succeed; return what it printed on standard output."""
        done = self.run(*words)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    def operator(self, name: str, role: str, *words: object) -> dict[str, dict[str, str]]:
        """Make an operator; return what its connections are opened with."""
        return bearing(self.do("operators", "add", name, "--role", role, *words))

    def robot(self, name: str) -> dict[str, dict[str, str]]:
        """Make a robot's token; return what its connections are opened with."""
        return bearing(self.do("robots", "token", name))


def bearing(token: str) -> dict[str, dict[str, str]]:
    """Return the options of a connection that carries ``token``."""
    return {"additional_headers": {"Authorization": f"Bearer {token}"}}
