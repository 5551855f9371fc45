"""The part on SQL: how long a robot waits for its answer, and how many answers a second one gateway gives."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
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

from sqlalchemy import Connection, make_url
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from benchmarks.clock import Spread, spread, table
from benchmarks.page import Part
from benchmarks.sql_robots import Plan, Seen
from benchmarks.trial import size
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from robot_bridge.gateway.storage.wakeups import LONGEST_S, SHORTEST_S
from tests.support.databases.database_server import DatabaseServer
from tests.support.databases.mariadb import MariaDb
from tests.support.databases.postgresql import PostgreSql
from tests.support.processes import Processes, dying_with_this
from tools.plugin_files import ROOT

Databases = Iterator[tuple[str, str]]
NUMBERS = itertools.count(1)
SITE = ROOT / "resources" / "sample_site"
COUNTS = size((1, 20, 100), (1, 5))
ROUNDS = size(3, 2)
"""How often each is measured on the same database, for so many seconds:"""
SECONDS = size(2.0, 1.0)
ONCE_A_SECOND, ON_AND_ON = 1.0, 0.0
PASSWORD = "robot-of-the-benchmark"
GATHER_S, BLOCK = 0.002, 4096
"""Seconds that the bare loop waits for more in one of its ways, and bytes that are written to the disk."""
POLL_S = {"sqlite": 0.002, "postgresql": 0.0, "mariadb": 0.004}

TEXT = """\
A request (`Stopped`) and its OpAck. A real gateway with everything running on the sample site, with one
operator who watches; its robots, a thread and a connection each with the rights of a robot's account, run
in one other process on the same machine, as does the database server, which waits for the disk at every
commit that is asked of it durably. The robots' drivers are in C, on MariaDB `python3-mysqldb`: in the field
every robot has a computer of its own, and what its driver takes is here taken from the server and the
gateway. PostgreSQL tells robots that there is something new (NOTIFY), and the gateway when it has nothing
to do. On SQLite the robots look after {sqlite:g} ms, on MariaDB after {mariadb:g} ms, then less and less
often, and the gateway every {soonest:g} ms to {latest:g} ms, on PostgreSQL too while requests come. Each
figure is of {rounds} rounds of {seconds:g} s.

*Robots not waiting for the disk* begin their sessions on PostgreSQL with `set synchronous_commit = off`, as
the reference robot does; on SQLite all do the like (`synchronous = normal`). What a power cut takes of a
robot's requests had no answer. MariaDB leaves robots no choice: *nobody waiting for the disk* is
`innodb_flush_log_at_trx_commit = 2`, with which a power cut also takes what operators were told is queued
([what to choose](operation.md#waiting-for-the-disk)).

The bare loop (`benchmarks/bare_sql.py`) has one connection with the gateway's driver, waits for the
disk as the gateway does, is told of new rows as the gateway is, checks nothing and has nothing else to do.
Behind it, in round brackets, the gateway's answers of its. It looks again as soon as it has answered; asked
as fast as it goes it also ran with a pause of {gather:g} ms before each look, in which more requests
gather, and of the two the one with more answers stands in the table. As fast as it goes the gateway gave more
answers than the loop in {beyond}.

To write {block} bytes and wait for the disk took {disk:.2f} ms before, and {disk_after:.2f} ms afterwards; a
durable request and its deletion wait for it once each, and so does the answer on MariaDB.

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
    """What was measured with some robots: of each round what they saw, and the cores that answering took."""

    case: Case
    robots: int
    rate: float
    bare: bool
    rounds: list[tuple[Seen, float]]

    @property
    def answers(self) -> Spread:
        """Answers a second."""
        return spread(len(seen.times) / max(seen.seconds, 1e-9) for seen, _ in self.rounds)

    @property
    def cpu(self) -> Spread:
        """What answered took, in cores."""
        return spread(cpu for _, cpu in self.rounds)

    @property
    def failed(self) -> list[str]:
        """What robots failed with."""
        return [failure for seen, _ in self.rounds for failure in seen.failed]

    def percentile(self, share: float) -> Spread:
        """Return the milliseconds within which this share of the answers came, of each round."""
        return spread(_percentile(seen.times, share) for seen, _ in self.rounds)


def measure(_data: Path) -> Part:
    """Measure each kind of database with few and many robots."""
    if find_spec("MySQLdb") is None:
        sys.exit("bench: robots on MariaDB need their driver: apt-get install python3-mysqldb")
    runs, disk = [], _milliseconds_to_disk()
    for case in CASES:
        with _databases(case) as databases:
            for robots in COUNTS:
                for rate in (ONCE_A_SECOND, ON_AND_ON):
                    runs.append(measured(databases, case, robots, rate))
                    print(_row(runs[-1], None), file=sys.stderr, flush=True)
                    if case.durable:
                        runs.append(_bare(databases, case, robots, rate))
    text = TEXT.format(
        seconds=SECONDS,
        sqlite=POLL_S["sqlite"] * 1e3,
        mariadb=POLL_S["mariadb"] * 1e3,
        rounds=ROUNDS,
        soonest=SHORTEST_S * 1e3,
        latest=LONGEST_S * 1e3,
        gather=GATHER_S * 1e3,
        beyond=_beyond(runs),
        block=BLOCK,
        disk=disk,
        disk_after=_milliseconds_to_disk(),
        paced=_table([run for run in runs if run.rate == ONCE_A_SECOND]),
        closed=_table([run for run in runs if run.rate == ON_AND_ON]),
    )
    for run in runs:
        for failure in run.failed:
            print(f"{run.case.name}, {run.robots} robots: {failure}", file=sys.stderr)
    return Part("Round trips over SQL", text, any(run.failed for run in runs))


def _bare(databases: Databases, case: Case, robots: int, rate: float) -> Run:
    """Return what the bare loop does; as fast as it goes, the better of its two ways."""
    pauses = (0.0,) if rate else (0.0, GATHER_S)
    runs = [measured(databases, case, robots, rate, bare=True, gather=pause) for pause in pauses]
    return max(runs, key=lambda run: run.answers.median)


def _beyond(runs: list[Run]) -> str:
    """Return in how many rows of the closed loop the gateway gave more answers than the bare loop."""
    closed = [run for run in runs if run.rate == ON_AND_ON]
    peers = {(run.case, run.robots): run.answers.median for run in closed if run.bare}
    pairs = {(run.case, run.robots): run.answers.median for run in closed if not run.bare}
    more = sum(pairs[key] > peer for key, peer in peers.items())
    return f"{more} of {len(peers)} rows"


def measured(
    databases: Databases, case: Case, robots: int, rate: float, *, bare: bool = False, gather: float = 0.0
) -> Run:
    """Measure robots on a new database with the gateway, or with the bare loop that pauses to ``gather``."""
    url, admin_url = next(databases)
    run_once(url, revisions.create)
    # Accounts belong to the server: each run has names of its own.
    names = {f"robot{next(NUMBERS)}": url for _ in range(robots)}
    if case.kind != "sqlite":
        names = run_once(admin_url, _accounts, list(names), make_url(url))
    plan = Plan(names, SECONDS, rate, POLL_S[case.kind], case.durable)
    with tempfile.TemporaryDirectory() as folder, Processes(Path(folder)) as processes:
        rounds = (
            _with_bare_loop(processes, url, plan, gather) if bare else _with_gateway(processes, url, plan)
        )
    return Run(case, robots, rate, bare, rounds)


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
    keeper = role_manager_on(connection)
    for name in names:
        keeper.add_robot(name, PASSWORD)
    shared = url.set(database=keeper.robots_database(), password=PASSWORD)
    return {name: shared.set(username=name).render_as_string(hide_password=False) for name in names}


def _with_gateway(processes: Processes, url: str, plan: Plan) -> list[tuple[Seen, float]]:
    serve = ["serve", "--site", SITE, "--port", "0", "--database", url]
    gateway = processes.start("gateway", [sys.executable, "-m", "robot_bridge", *serve])
    address = processes.wait_for_line("gateway", r"listening on (ws://[\w.]+:\d+)", 30).group(1)
    with connect(f"{address}/desk") as desk:
        threading.Thread(target=_watch, args=(desk,), daemon=True).start()
        return [_ask(plan, gateway.pid) for _ in range(ROUNDS)]


def _with_bare_loop(processes: Processes, url: str, plan: Plan, gather: float) -> list[tuple[Seen, float]]:
    command = [sys.executable, "-m", "benchmarks.bare_sql", url, str(gather)]
    loop = processes.start("loop", command, env={"PYTHONPATH": str(ROOT)})
    processes.wait_for_line("loop", "answering", 30)
    return [_ask(plan, loop.pid) for _ in range(ROUNDS)]


def _ask(plan: Plan, pid: int) -> tuple[Seen, float]:
    """Let the robots ask; return what they saw, and the cores that process ``pid`` took meanwhile."""
    began, used = time.perf_counter(), _cpu(pid)
    done = subprocess.run(
        dying_with_this([sys.executable, "-m", "benchmarks.sql_robots"]),
        cwd=ROOT,
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


def _percentile(times: list[float], share: float) -> float:
    found = sorted(times) or [0.0]
    return found[min(len(found) - 1, int(len(found) * share))] * 1e3


def _milliseconds_to_disk() -> Spread:
    """Return what it takes to write a block to the end of a file and to wait for the disk."""
    times = []
    with tempfile.TemporaryFile(buffering=0) as file:
        for _ in range(200):
            began = time.perf_counter()
            file.write(os.urandom(BLOCK))
            os.fdatasync(file.fileno())
            times.append((time.perf_counter() - began) * 1e3)
    return spread(times)


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
        ratio = run.answers.median / max(peer.answers.median, 1e-9)
        answers = f"{peer.answers:.0f} ({ratio:.2f})"
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
