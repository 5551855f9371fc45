"""The part on SQL: how long a robot waits for its answer, and how many answers a second one gateway gives."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from plugin_files import ROOT
from sqlalchemy import Connection, make_url
from stage.database_server import DatabaseServer
from stage.mariadb import MariaDb
from stage.postgresql import PostgreSql
from stage.processes import Processes, dying_with_this
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from robot_bridge.store import revisions
from robot_bridge.store.accounts.choice import keeper_on
from robot_bridge.store.database import run_once

from .clock import table
from .page import Part
from .sql_robots import Plan, Seen

Databases = Iterator[tuple[str, str]]
NUMBERS = itertools.count(1)
SITE = ROOT / "resources" / "sample_site"
COUNTS = (1, 20, 100)
SECONDS = 3.0
ONCE_A_SECOND, ON_AND_ON = 1.0, 0.0
PASSWORD = "robot-of-the-benchmark"
POLL_S = {"sqlite": 0.002, "postgresql": 0.0, "mariadb": 0.004}

TEXT = """\
A request (`Stopped`) and its OpAck. A real gateway with everything running on the sample site, with one
operator who watches; its robots, a thread and a connection each with the rights of a robot's account, run in
one other process on the same machine, as does the database server, which waits for the disk at every commit
that is asked of it durably. The robots' drivers are in C, on MariaDB `python3-mysqldb`: in the field every
robot has a computer of its own, and what its driver takes is here taken from the server and the gateway.
PostgreSQL tells robots that there is something new (NOTIFY), and the gateway when it has nothing to do. On
SQLite the robots look after {sqlite:g} ms, on MariaDB after {mariadb:g} ms, then less and less often, and the
gateway every 0.3 ms to 20 ms, on PostgreSQL too while requests come. Each figure is of {seconds:g} s.

*Robots not waiting for the disk* begin their sessions on PostgreSQL with `set synchronous_commit = off`, as
the reference robot does; on SQLite all do the like (`synchronous = normal`). What a power cut takes of a
robot's requests had no answer. MariaDB leaves robots no choice: *nobody waiting for the disk* is
`innodb_flush_log_at_trx_commit = 2`, with which a power cut also takes what operators were told is queued
([what to choose](operation.md#waiting-for-the-disk)).

The bare loop is the least that can answer them (`scripts/benchmarks/bare_sql.py`): one connection with the
gateway's driver and commits that wait for the disk as the gateway's do, no checks and nothing else to do. In
brackets, the gateway's answers of its.

To write 4 KiB and wait for the disk took {disk:.1f} ms (median) before, and {disk_after:.1f} ms afterwards; a
durable request and its deletion wait for it once each, and so does the answer on MariaDB. Load of the machine
when it began and when it ended: {load:.1f} and {after:.1f}.

### Once a second

From before the robot's insert until it has read and deleted the answer.

{paced}

### As fast as it goes

Each robot asks again as soon as it has its answer, and deletes that in the same transaction.

{closed}
"""


@dataclass(frozen=True)
class Case:
    """A kind of database; ``durable``: commits wait for its disk, robots' where those have a choice.

    The bare loop is run on those alone.
    """

    name: str
    kind: str
    durable: bool = True


CASES = (
    Case("SQLite", "sqlite"),
    Case("PostgreSQL", "postgresql"),
    Case("PostgreSQL, robots not waiting for the disk", "postgresql", durable=False),
    Case("MariaDB", "mariadb"),
    Case("MariaDB, nobody waiting for the disk", "mariadb", durable=False),
)


@dataclass(frozen=True)
class Run:
    """What was measured with some robots; ``cpu`` is what answered them took, in cores."""

    case: Case
    robots: int
    rate: float
    bare: bool
    seen: Seen
    cpu: float

    @property
    def answers(self) -> float:
        """Answers a second."""
        return len(self.seen.times) / max(self.seen.seconds, 1e-9)

    def percentile(self, share: float) -> float:
        """Return the milliseconds within which this share of the answers came."""
        times = sorted(self.seen.times) or [0.0]
        return times[min(len(times) - 1, int(len(times) * share))] * 1e3


def measure(_data: Path) -> Part:
    """Measure each kind of database with few and many robots."""
    if find_spec("MySQLdb") is None:
        sys.exit("bench: robots on MariaDB need their driver: apt-get install python3-mysqldb")
    runs, load, disk = [], os.getloadavg()[0], _milliseconds_to_disk()
    for case in CASES:
        with _databases(case) as databases:
            for robots in COUNTS:
                runs += [
                    measured(databases, case, robots, rate, bare=bare)
                    for rate in (ONCE_A_SECOND, ON_AND_ON)
                    for bare in ((False, True) if case.durable else (False,))
                ]
    text = TEXT.format(
        seconds=SECONDS,
        sqlite=POLL_S["sqlite"] * 1e3,
        mariadb=POLL_S["mariadb"] * 1e3,
        disk=disk,
        disk_after=_milliseconds_to_disk(),
        load=load,
        after=os.getloadavg()[0],
        paced=_table([run for run in runs if run.rate == ONCE_A_SECOND]),
        closed=_table([run for run in runs if run.rate == ON_AND_ON]),
    )
    for run in runs:
        for failure in run.seen.failed:
            print(f"{run.case.name}, {run.robots} robots: {failure}", file=sys.stderr)
    return Part("Round trips over SQL", text, any(run.seen.failed for run in runs))


def measured(databases: Databases, case: Case, robots: int, rate: float, *, bare: bool) -> Run:
    """Measure robots on a new database with the gateway, or with the least that can answer."""
    url, admin_url = next(databases)
    run_once(url, revisions.create)
    # Accounts belong to the server: each run has names of its own.
    names = {f"robot{next(NUMBERS)}": url for _ in range(robots)}
    if case.kind != "sqlite":
        names = run_once(admin_url, _accounts, list(names), make_url(url))
    plan = Plan(names, SECONDS, rate, POLL_S[case.kind], case.durable)
    with tempfile.TemporaryDirectory() as folder, Processes(Path(folder)) as processes:
        answered = _with_bare_loop if bare else _with_gateway
        seen, cpu = answered(processes, url, plan)
    return Run(case, robots, rate, bare, seen, cpu)


@contextmanager
def _databases(case: Case) -> Iterator[Databases]:
    """Yield new databases, each with its owner's and its administrator's URL."""
    if case.kind == "sqlite":
        with tempfile.TemporaryDirectory() as folder:
            urls = (f"sqlite:///{folder}/fleet-{number}.db" for number in itertools.count(1))
            yield ((url, url) for url in urls)
        return
    server: DatabaseServer = {"postgresql": PostgreSql, "mariadb": MariaDb}[case.kind](durable=True)
    with server:
        if case.kind == "mariadb" and not case.durable:
            server.sql("set global innodb_flush_log_at_trx_commit = 2")
        yield ((url, server.admin_url(url)) for url in iter(server.new_database, None))


def _accounts(connection: Connection, names: list[str], url: Any) -> dict[str, str]:
    keeper = keeper_on(connection)
    for name in names:
        keeper.add_robot(name, PASSWORD)
    shared = url.set(database=keeper.robots_database(), password=PASSWORD)
    return {name: shared.set(username=name).render_as_string(hide_password=False) for name in names}


def _with_gateway(processes: Processes, url: str, plan: Plan) -> tuple[Seen, float]:
    serve = ["serve", "--site", SITE, "--port", "0", "--database", url]
    gateway = processes.start("gateway", [sys.executable, "-m", "robot_bridge", *serve])
    address = processes.wait_for_line("gateway", r"listening on (ws://[\w.]+:\d+)", 30).group(1)
    with connect(f"{address}/desk") as desk:
        threading.Thread(target=_watch, args=(desk,), daemon=True).start()
        return _ask(plan, gateway.pid)


def _with_bare_loop(processes: Processes, url: str, plan: Plan) -> tuple[Seen, float]:
    path = os.pathsep.join([str(ROOT), str(ROOT / "scripts")])
    command = [sys.executable, "-m", "benchmarks.bare_sql", url]
    loop = processes.start("loop", command, env={"PYTHONPATH": path})
    processes.wait_for_line("loop", "answering", 30)
    return _ask(plan, loop.pid)


def _ask(plan: Plan, pid: int) -> tuple[Seen, float]:
    """Let the robots ask; return what they saw, and the cores that process ``pid`` took meanwhile."""
    began, used = time.perf_counter(), _cpu(pid)
    done = subprocess.run(
        dying_with_this([sys.executable, "-m", "benchmarks.sql_robots"]),
        cwd=ROOT / "scripts",
        input=json.dumps(asdict(plan)),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    cpu = (_cpu(pid) - used) / (time.perf_counter() - began)
    return Seen(**json.loads(done.stdout)), cpu


def _watch(desk: ClientConnection) -> None:
    """Be an operator who looks on."""
    for number, (method, params) in enumerate((("hello", {"operator": "Ada"}), ("subscribe", {"rate": 5}))):
        desk.send(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}))
    with contextlib.suppress(ConnectionClosed):
        for _ in desk:
            pass


def _milliseconds_to_disk() -> float:
    """Return the median of writing 4 KiB to the end of a file and waiting for the disk."""
    times = []
    with tempfile.TemporaryFile(buffering=0) as file:
        for _ in range(200):
            began = time.perf_counter()
            file.write(os.urandom(4096))
            os.fdatasync(file.fileno())
            times.append(time.perf_counter() - began)
    return statistics.median(times) * 1e3


def _cpu(pid: int) -> float:
    """Return the seconds of processor time that a process has used."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def _table(runs: list[Run]) -> str:
    head = ["database", "robots", "p50, ms", "p99, ms", "answers/s", "cores"]
    head += ["bare loop: p50, ms", "answers/s"]
    peers = {(run.case, run.robots): run for run in runs if run.bare}
    return table(head, [_row(run, peers.get((run.case, run.robots))) for run in runs if not run.bare])


def _row(run: Run, peer: Run | None) -> list[str]:
    beside = ["", ""]
    if peer is not None:
        answers = f"{peer.answers:.0f} ({run.answers / max(peer.answers, 1e-9):.2f})"
        beside = [f"{peer.percentile(0.5):.1f}", answers]
    return [
        run.case.name,
        str(run.robots),
        f"{run.percentile(0.5):.1f}",
        f"{run.percentile(0.99):.1f}",
        f"{run.answers:.0f}",
        f"{run.cpu:.2f}",
        *beside,
    ]
