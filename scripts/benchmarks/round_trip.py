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
from pathlib import Path
from typing import Any

from plugin_files import ROOT
from sqlalchemy import Connection, make_url
from stage.database_server import DatabaseServer
from stage.mariadb import MariaDb
from stage.postgresql import PostgreSql
from stage.processes import Processes
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
SECONDS = 8.0
PASSWORD = "robot-of-the-benchmark"
POLL_S = {"sqlite": 0.002, "postgresql": 0.0, "mariadb": 0.004}
NAMES = {"sqlite": "SQLite", "postgresql": "PostgreSQL", "mariadb": "MariaDB"}

TEXT = """\
A request (`Stopped`) and its OpAck, from before the robot's insert until the robot has read and deleted the
answer. A real gateway with everything running on the sample site, with one operator who watches; its robots,
a thread and a connection each with the rights of a robot's account, run in one other process on the same
machine, as does the database server, which waits for the disk at every commit. PostgreSQL tells both sides
that there is something new (NOTIFY). On SQLite the robots look after {sqlite:g} ms, on MariaDB after
{mariadb:g} ms, then less and less often, and the gateway every 1 ms to 20 ms. Load of the machine when it
began, by what else ran: {load:.1f}.

### Once a second

{paced}

### As fast as it goes

Each robot asks again as soon as it has its answer.

{closed}
"""


@dataclass(frozen=True)
class Run:
    """What was measured with some robots on a kind of database; ``cpu`` is the gateway's, in cores."""

    kind: str
    robots: int
    seen: Seen
    cpu: float


def measure(_data: Path) -> Part:
    """Measure each kind of database with few and many robots."""
    paced, closed, load = [], [], os.getloadavg()[0]
    for kind in NAMES:
        with _databases(kind) as databases:
            for robots in COUNTS:
                paced.append(measured(databases, kind, robots, rate=1.0))
                closed.append(measured(databases, kind, robots, rate=0.0))
    text = TEXT.format(
        sqlite=POLL_S["sqlite"] * 1e3,
        mariadb=POLL_S["mariadb"] * 1e3,
        load=load,
        paced=_table(paced),
        closed=_table(closed),
    )
    for run in [*paced, *closed]:
        for failure in run.seen.failed:
            print(f"{run.kind}, {run.robots} robots: {failure}", file=sys.stderr)
    failed = any(run.seen.failed for run in [*paced, *closed])
    return Part("Round trips over SQL", text, failed)


def measured(databases: Databases, kind: str, robots: int, rate: float) -> Run:
    """Measure one case on a new database."""
    url, admin_url = next(databases)
    run_once(url, revisions.create)
    # Accounts belong to the server: each case has names of its own.
    names = {f"robot{next(NUMBERS)}": url for _ in range(robots)}
    if kind != "sqlite":
        names = run_once(admin_url, _accounts, list(names), make_url(url))
    plan = Plan(names, SECONDS, rate, POLL_S[kind])
    with tempfile.TemporaryDirectory() as folder, Processes(Path(folder)) as processes:
        seen, cpu = _with_gateway(processes, url, plan)
    return Run(kind, robots, seen, cpu)


@contextmanager
def _databases(kind: str) -> Iterator[Databases]:
    """Yield new databases, each with its owner's and its administrator's URL."""
    if kind == "sqlite":
        with tempfile.TemporaryDirectory() as folder:
            urls = (f"sqlite:///{folder}/fleet-{number}.db" for number in itertools.count(1))
            yield ((url, url) for url in urls)
        return
    server: DatabaseServer = {"postgresql": PostgreSql, "mariadb": MariaDb}[kind](durable=True)
    with server:
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
        began, used = time.perf_counter(), _cpu(gateway.pid)
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.sql_robots"],
            cwd=ROOT / "scripts",
            input=json.dumps(asdict(plan)),
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        cpu = (_cpu(gateway.pid) - used) / (time.perf_counter() - began)
    return Seen(**json.loads(done.stdout)), cpu


def _watch(desk: ClientConnection) -> None:
    """Be an operator who looks on."""
    for number, (method, params) in enumerate((("hello", {"operator": "Ada"}), ("subscribe", {"rate": 5}))):
        desk.send(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}))
    with contextlib.suppress(ConnectionClosed):
        for _ in desk:
            pass


def _cpu(pid: int) -> float:
    """Return the seconds of processor time that a process has used."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def _table(runs: list[Run]) -> str:
    head = ["database", "robots", "p50, ms", "p99, ms", "answers/s", "gateway, cores"]
    return table(head, [_row(run) for run in runs])


def _row(run: Run) -> list[str]:
    times = sorted(run.seen.times) or [0.0]
    worst = times[min(len(times) - 1, int(len(times) * 0.99))]
    return [
        NAMES[run.kind],
        str(run.robots),
        f"{statistics.median(times) * 1e3:.1f}",
        f"{worst * 1e3:.1f}",
        f"{len(run.seen.times) / max(run.seen.seconds, 1e-9):.0f}",
        f"{run.cpu:.2f}",
    ]
