"""The part on the attack surface: 10 000 pieces of nonsense for a real gateway, and what it made of them."""

from __future__ import annotations

import contextlib
import json
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, given, settings
from plugin_files import ROOT
from stage.fuzzing import Conversation, desk_frames, handshakes, knock, robot_frames, rr_rows
from stage.processes import Processes
from websockets.sync.client import connect

from .page import Part

CASES = {"robot": 3500, "desk": 3500, "handshake": 1500, "sql": 1500}
LIMITS = """
[limits]
robot_messages_per_s = 1e5
robot_burst = 100000
desk_messages_per_s = 1e5
desk_burst = 100000
"""

TEXT = """\
Frames from nearly right to nonsense on two connections of each endpoint at once, requests to the port from
nearly right to binary (with accounts in use, none with a right token), and rows of table `rr`; after each, a
right question on the same connection has to be answered, to whoever asked it and without anything of the
gateway's inside.

| what | cases | wrong |
| --- | --- | --- |
{rows}

The gateway ran on throughout: {alive}. Tracebacks in its log: {tracebacks}. Its memory grew by {grown} MB.
"""


@dataclass
class Tally:
    """How many cases were tried, and how many went wrong."""

    tried: int = 0
    wrong: int = 0


def measure(_data: Path) -> Part:
    """Try everything and return the part."""
    with tempfile.TemporaryDirectory() as folder, Processes(Path(folder) / "logs") as processes:
        gateway = _Gateway(processes, Path(folder))
        before = gateway.memory()
        tallies = {name: _tally(CASES[name], *attack) for name, *attack in gateway.attacks()}
        alive = gateway.process.poll() is None
        grown = gateway.memory() - before if alive else 0
        tracebacks = processes.log("gateway").read_text(encoding="utf-8", errors="replace").count("Traceback")
    rows = "\n".join(f"| {name} | {tally.tried} | {tally.wrong} |" for name, tally in tallies.items())
    text = TEXT.format(rows=rows, alive="yes" if alive else "NO", tracebacks=tracebacks, grown=grown)
    failed = not alive or tracebacks > 0 or any(tally.wrong for tally in tallies.values())
    return Part("Attack surface", text, failed)


def _tally(count: int, strategy: Any, attempt: Callable[[Any], None]) -> Tally:
    tally = Tally()

    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(strategy)
    def run(case: Any) -> None:
        tally.tried += 1
        try:
            attempt(case)
        except Exception as error:
            tally.wrong += 1
            print(f"{case!r}: {type(error).__name__}: {error}"[:500], file=sys.stderr)

    run()
    return tally


class _Gateway:
    """A gateway on the sample site with accounts, whose rates are no limit."""

    def __init__(self, processes: Processes, folder: Path) -> None:
        shutil.copytree(ROOT / "resources" / "sample_site", folder / "site")
        with (folder / "site" / "site.toml").open("a", encoding="utf-8") as settings_file:
            settings_file.write(LIMITS)
        self._file = folder / "fleet.db"
        self._operators = self._run("operators", "add", "Ada", "--role", "supervisor")
        self._robots = [self._run("robots", "token", name) for name in ("fuzzed-1", "fuzzed-2")]
        serve = ["serve", "--site", folder / "site", "--port", "0", "--database", f"sqlite:///{self._file}"]
        self.process = processes.start("gateway", [sys.executable, "-m", "robot_bridge", *serve])
        found = processes.wait_for_line("gateway", r"listening on ws://127\.0\.0\.1:(\d+)", 20)
        self._port = int(found.group(1))

    def _run(self, *words: str) -> str:
        command = [sys.executable, "-m", "robot_bridge", *words, "--database", f"sqlite:///{self._file}"]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    def attacks(self) -> Iterator[tuple[str, Any, Callable[[Any], None]]]:
        """Yield for each way in its name, what to send, and how.

        A connection is made when its turn comes: one that nobody reads for minutes is cut, and rightly so.
        """
        robots = [self._robot(number, token) for number, token in enumerate(self._robots, 1)]
        yield "robot", robot_frames, lambda frame: [robot.say(frame) for robot in robots]
        desks = [self._desk(number) for number in (1, 2)]
        yield "desk", desk_frames, lambda frame: [desk.say(frame) for desk in desks]
        yield "handshake", handshakes, self._knock
        yield "sql", rr_rows, self._write

    def _robot(self, number: int, token: str) -> Conversation:
        wire = self._connect("/robot", token)
        name = f"fuzzed-{number}"
        conversation = Conversation(wire, name, "SendPos", {"x": 1, "y": 2, "theta": 0, "v": 0})
        wire.send('{"jsonrpc": "2.0", "id": 0, "method": "Ready", "params": {"magic": 1}}')
        while json.loads(wire.recv(10)).get("id") != 0:
            continue
        return conversation

    def _desk(self, number: int) -> Conversation:
        wire = self._connect("/desk", self._operators)
        wire.send('{"jsonrpc": "2.0", "id": null, "method": "hello", "params": {"operator": "Ada"}}')
        return Conversation(wire, f"desk-{number}", "get_commands", {"limit": 1})

    def _connect(self, path: str, token: str) -> Any:
        headers = {"Authorization": f"Bearer {token}"}
        url = f"ws://127.0.0.1:{self._port}{path}"
        return connect(url, additional_headers=headers, max_size=None, compression=None)

    def _knock(self, request: bytes) -> None:
        answer = knock("127.0.0.1", self._port, request)
        assert not answer.startswith((b"HTTP/1.1 101", b"HTTP/1.1 500")), answer[:200]

    def _write(self, row: tuple[Any, ...]) -> None:
        with self._database() as connection:
            try:
                connection.execute("insert into rr (robot, op, params, payload) values (?, ?, ?, ?)", row)
            except UnicodeEncodeError:
                return
            until = time.monotonic() + 10
            while connection.execute("select id from rr").fetchone():
                assert time.monotonic() < until, "a row of rr is not dealt with"
                time.sleep(0.005)

    @contextlib.contextmanager
    def _database(self) -> Iterator[sqlite3.Connection]:
        with contextlib.closing(sqlite3.connect(self._file, timeout=5, isolation_level=None)) as connection:
            yield connection

    def memory(self) -> int:
        """Return the gateway's resident memory in MB."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS"))) // 1024
