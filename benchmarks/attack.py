"""The part on the attack surface: 20 000 pieces of nonsense from every account, and what came of them."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.page import Part, goal
from tests.support.databases.mariadb import MariaDb
from tests.support.databases.postgresql import PostgreSql
from tests.support.hostile.fuzzing import handshakes, knock, try_cases
from tests.support.hostile.hostile_values import DEPTHS
from tests.support.hostile.siege import GENEROUS, WORST_ROWS, Siege, cases, unread_rows
from tests.support.processes import Processes
from tools.plugin_files import ROOT

HANDSHAKES = 2000
BATCHES, SAID, WAITING, BESIDE = 10, 500, 80, 20
"""On each database: so often, so many cases said, so many waiting at the start, so many beside a stop."""
SERVERS = {"sqlite": None, "postgresql": PostgreSql, "mariadb": MariaDb}

HEADS = ["database", "cases", "wrong", "restarts", "checks that failed", "slowest stop to the last robot"]
HEADS += ["gateway alive", "tracebacks", "memory grown in the first run by"]
TEXT = """\
Every account of a gateway speaks: robots over WebSocket and over SQL, each under an account of its own
where the database has any, links, viewers, operators and supervisors. Calls nearly right, with values that
are deep, of {brackets} brackets, long, of another kind, NULs, lone surrogates and numbers of hundreds of
digits; nonsense; emergency stops and everything else that an operator may ask for. After each a right
question on the same connection has to be answered, to whoever asked it and without anything of the
gateway's inside. After every {said} an emergency stop is made beside {beside} unread rows, and the gateway
is killed and started again with {waiting} rows waiting. Each time a well-behaved robot over SQL, one
over WebSocket and one over a link must get a command, and the stop within {within:g} s.

{table}

Of the cases, the checks and the requests {faults} went wrong ({all_well}). The slowest stop was at the last
robot after {slowest:.2f} s ({in_time}).

Requests to the port from nearly right to binary, none with a right token: {knocked}, wrong {unlocked}.
"""


@dataclass
class Tally:
    """How many cases were tried, and how many went wrong."""

    tried: int = 0
    wrong: int = 0

    def of(self, attempt: Callable[[Any], None]) -> Callable[[Any], None]:
        """Return ``attempt``, counted; what it raises is printed."""

        def counted(case: Any) -> None:
            self.tried += 1
            try:
                attempt(case)
            except Exception as error:
                self.wrong += 1
                print(f"{case!r:.500}: {type(error).__name__}: {error}"[:1500], file=sys.stderr)

        return counted


@dataclass
class Result:
    """What came of one database."""

    cases: Tally
    checks: Tally
    restarts: int = 0
    slowest_stop: float = 0.0
    alive: bool = False
    tracebacks: int = 0
    grown: int = 0

    @property
    def failed(self) -> bool:
        """Whether anything was not as it must be."""
        late = self.slowest_stop > WITHIN
        return bool(self.cases.wrong or self.checks.wrong or self.tracebacks or late) or not self.alive


WITHIN = 1.0


def measure(_data: Path) -> Part:
    """Try everything and return the part."""
    results = {kind: _besiege(kind) for kind in SERVERS}
    knocks = _knocks()
    heads = [f"| {' | '.join(HEADS)} |", f"|{' --- |' * len(HEADS)}"]
    table = "\n".join([*heads, *(_row(kind, result) for kind, result in results.items())])
    failed = bool(knocks.wrong) or any(result.failed for result in results.values())
    slowest = max(result.slowest_stop for result in results.values())
    faults = knocks.wrong + sum(result.cases.wrong + result.checks.wrong for result in results.values())
    text = TEXT.format(
        brackets=max(DEPTHS),
        said=SAID,
        waiting=WAITING,
        beside=BESIDE,
        within=WITHIN,
        table=table,
        faults=faults,
        all_well=goal("none", faults == 0),
        slowest=slowest,
        in_time=goal(f"at most {WITHIN:g} s", slowest <= WITHIN),
        knocked=knocks.tried,
        unlocked=knocks.wrong,
    )
    return Part("Attack surface", text, failed)


def _row(kind: str, result: Result) -> str:
    cells = [kind, result.cases.tried, result.cases.wrong, result.restarts, result.checks.wrong]
    cells += [f"{result.slowest_stop:.2f} s", "yes" if result.alive else "NO", result.tracebacks]
    return f"| {' | '.join(map(str, cells))} | {result.grown} MB |"


def _besiege(kind: str) -> Result:
    cases_tally, checks = Tally(), Tally()
    result = Result(cases_tally, checks)
    with _siege(kind) as siege:
        memory = _memory(siege.process.pid)
        for number in range(BATCHES):
            try_cases(SAID, cases(kind), cases_tally.of(siege.say))
            if number == 0:
                result.grown = _memory(siege.process.pid) - memory
            beside: list[Any] = [("sql", row) for row in WORST_ROWS]
            try_cases(BESIDE, unread_rows, cases_tally.of(beside.append))
            checks.of(siege.check)(beside)
            siege.kill()
            try_cases(WAITING, unread_rows, cases_tally.of(lambda case: siege.say(case, unread=True)))
            checks.of(lambda _: siege.start())("start")
            checks.of(siege.check)(())
            result.restarts += 1
        result.alive = siege.process.poll() is None
        result.slowest_stop = siege.slowest_stop
        result.tracebacks = siege.log().count("Traceback")
    return result


@contextlib.contextmanager
def _siege(kind: str) -> Iterator[Siege]:
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        processes = stack.enter_context(Processes(folder / "logs"))
        url, admin = f"sqlite:///{folder}/fleet.db", None
        if (server_class := SERVERS[kind]) is not None:
            server = stack.enter_context(server_class())
            url = server.new_database()
            admin = server.admin_url(url)
        siege = Siege(processes, _site(folder), url, admin)
        stack.callback(siege.close)
        yield siege


def _site(folder: Path) -> Path:
    shutil.copytree(ROOT / "resources" / "sample_site", folder / "site")
    with (folder / "site" / "site.toml").open("a", encoding="utf-8") as settings:
        settings.write(GENEROUS)
    return folder / "site"


def _memory(pid: int) -> int:
    """Return the resident memory of a process in MB, 0 where it has ended."""
    with contextlib.suppress(FileNotFoundError, StopIteration):
        status = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
        return int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS"))) // 1024
    return 0


def _knocks() -> Tally:
    """Knock at a gateway whose tokens nobody here knows."""
    tally = Tally()
    with tempfile.TemporaryDirectory() as name, Processes(Path(name) / "logs") as processes:
        folder = Path(name)
        database = ["--database", f"sqlite:///{folder}/fleet.db"]
        for words in (["operators", "add", "Ada", "--role", "supervisor"], ["robots", "token", "r1"]):
            command = [sys.executable, "-m", "robot_bridge", *words, *database]
            subprocess.run(command, capture_output=True, check=True)
        serve = ["serve", "--site", str(_site(folder)), "--port", "0", *database]
        gateway = processes.start("gateway", [sys.executable, "-m", "robot_bridge", *serve])
        found = processes.wait_for_line("gateway", r"listening on ws://127\.0\.0\.1:(\d+)", 20)
        time.sleep(1.5)  # accounts hold within a second

        def attempt(request: bytes) -> None:
            answer = knock("127.0.0.1", int(found.group(1)), request)
            assert not answer.startswith((b"HTTP/1.1 101", b"HTTP/1.1 500")), answer[:200]

        try_cases(HANDSHAKES, handshakes, tally.of(attempt))
        log = processes.log("gateway").read_text(encoding="utf-8", errors="replace")
        if gateway.poll() is not None or "Traceback" in log:
            tally.wrong += 1
    return tally
