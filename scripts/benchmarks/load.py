"""The part on load: how many positions one gateway takes, and how old they are when operators see them."""

from __future__ import annotations

import itertools
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from plugin_files import ROOT
from stage.processes import Processes

from .clock import table
from .page import Part
from .swarm import Plan, Seen, Swarm

SITE = ROOT / "resources" / "sample_site"
HERE = Path(__file__).parent
SERVER_CORE, SWARM_CORE = 0, 1
MANY = 1000
SECONDS = 15.0
STEP_SECONDS = 8.0
STEPS = (10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0)
"""positions a second of each of a thousand robots; the gateway itself allows no more than 100."""
GOAL_RATE, GOAL_MS = 25_000, 50
"""positions a second that a gateway is to take with a p99 below so many milliseconds."""
LIMITS = """
[limits]
per_address = 5000
desks_per_account = 100
"""
MALLOC = {"MALLOC_MMAP_THRESHOLD_": "4194304", "MALLOC_TRIM_THRESHOLD_": "67108864"}

TEXT = """\
Robots on WebSocket send positions; operators subscribe to all robots at 5 Hz, in the form that the panel in
QGIS asks for; everything runs: validation, limits, liveness, trajectories into SQLite, metrics. The gateway
has a process and, as `taskset` holds it, one core of its own. The robots are one process that only sends, the
operators one that only looks; these two share the other core. The delay is from the robot's clock to one more
operator, who subscribes at 50 Hz, and is of positions that are new to it: at 5 Hz the newest position of a
robot is up to 0.2 s old by nature. The wire's delay is from the gateway's clock to an operator at 5 Hz.
Measuring begins when every robot has its map and the gateway nothing left to do: {robots} robots that
connected one after the other had their maps after {arrival:.1f} s. Where robots were late by more than some
tens of milliseconds, the machine was too busy for the figures beside it. Load of the machine as the part
began and ended: {began:.1f} and {ended:.1f} on {cores} cores.

{load}

The last two rows are a WebSocket server of a few lines on the same library and loop
(`scripts/benchmarks/plain_fanout.py`): what that library alone costs on this machine, message by message, and
what it comes to without conflation. The gateway takes short messages out of the bytes itself, before they are
queued, so it may cost less than the library's queue alone. Not measured here: a rosbridge server in Rust,
which on 100 000 messages/s delivered 18 500 of them at 147 % of a core with 13 s of delay.

### Saturation

1000 robots, 20 operators and the one who measures; the rate is raised step by step, each for {window:.0f} s.
A step counts as kept up when every socket took every message and the gateway had read all of them, by its own
count, within 0.5 s after the last was sent.

{steps}

{verdict}

### Operators who do not read

Ten more operators subscribe at 5 Hz and never read.

{stuck}
"""


@dataclass(frozen=True)
class Measured:
    """What one window came to, and the seconds that the robots took to arrive before it."""

    name: str
    seen: Seen
    arrival: float

    def row(self) -> list[str]:
        """Return the row of the table."""
        seen = self.seen
        return [
            self.name,
            f"{seen.rate:,.0f}",
            f"{100 * seen.cpu:.0f} %",
            _both(seen.delays),
            _both(seen.ages),
            f"{seen.late:.0f}",
            f"{seen.megabytes_before:.0f} → {seen.megabytes:.0f}",
        ]

    def step(self) -> list[str]:
        """Return the row of the table on saturation."""
        seen = self.seen
        kept = "yes" if seen.kept_up else f"no: {seen.unread} unread, {seen.held_back} not taken"
        own = f"{100 * seen.own_cpu:.0f} %"
        return [*self.row()[1:4], f"{seen.read_after:.2f}", kept, f"{seen.late:.0f}", own]


HEAD = [
    "",
    "positions/s",
    "of a core",
    "delay, ms: median / p99",
    "wire, ms: median / p99",
    "robots late, ms",
    "memory, MB",
]
STEP_HEAD = [*HEAD[1:4], "all read after, s", "kept up", "robots late, ms", "robots' process, of a core"]


def measure(_data: Path) -> Part:
    """Measure on the sample site."""
    began = os.getloadavg()[0]
    load = [_run(f"{robots} robots × 10 Hz, 20 operators", robots) for robots in (100, MANY)]
    peers = [
        _run("the wire alone: positions decoded and dropped", 1000, peer="--drop", operators=0),
        _run("every position forwarded to every operator", 1000, peer="--forward"),
    ]
    stuck = _run("1000 robots × 10 Hz, 20 operators, 10 stuck", 1000, stuck=10)
    steps = list(_saturate())
    text = TEXT.format(
        began=began,
        ended=os.getloadavg()[0],
        cores=os.cpu_count(),
        window=STEP_SECONDS,
        robots=MANY,
        arrival=load[-1].arrival,
        load=table(HEAD, [run.row() for run in [*load, *peers]]),
        steps=table(STEP_HEAD, [step.step() for step in steps]),
        verdict=_verdict([step.seen for step in steps]),
        stuck=table(HEAD, [load[-1].row(), stuck.row()]),
    )
    return Part("Load", text)


def _run(name: str, robots: int, *, stuck: int = 0, peer: str = "", operators: int = 20) -> Measured:
    with _server(peer) as (pid, port):
        plan = Plan("127.0.0.1", port, pid, robots, operators, stuck=stuck, rpc=not peer)
        with Swarm(plan, SWARM_CORE) as swarm:
            return _told(Measured(name, swarm.window(10.0, SECONDS), swarm.arrival))


def _saturate() -> Iterator[Measured]:
    """Yield steps up to the first at which the gateway falls behind, or the robots do."""
    with _server() as (pid, port), Swarm(Plan("127.0.0.1", port, pid, 1000), SWARM_CORE) as swarm:
        for rate in STEPS:
            seen = swarm.window(rate, STEP_SECONDS)
            step = _told(Measured(f"1000 robots × {rate:.0f} Hz", seen, swarm.arrival))
            yield step
            if not (step.seen.kept_up and step.seen.swarm_kept_up):
                return


def _verdict(steps: Sequence[Seen]) -> str:
    """Return what is claimed: the highest rate that was kept up before the first that was not."""
    kept = list(itertools.takewhile(lambda seen: seen.kept_up, steps))
    if not kept:
        return "Not even the first step was kept up."
    best = max(kept, key=lambda seen: seen.rate)
    claim = f"Highest rate kept up: **{best.rate:,.0f} positions/s**, with a p99 of {best.delays[1]} ms."
    if goal := [seen for seen in kept if abs(seen.rate - GOAL_RATE) < GOAL_RATE / 100]:
        claim += f" At {goal[0].rate:,.0f} positions/s the p99 was {goal[0].delays[1]} ms."
    if fast := list(itertools.takewhile(lambda seen: (seen.delays[1] or 0.0) < GOAL_MS, kept)):
        claim += f" The p99 was below {GOAL_MS} ms at every step up to {fast[-1].rate:,.0f} positions/s."
    if not kept[-1].swarm_kept_up:
        claim += " Then the robots' process could not send faster: where the gateway ends is not measured."
    elif len(kept) == len(STEPS):
        claim += " No higher one was tried: a robot may send 100 messages a second."
    return claim


def _told(measured: Measured) -> Measured:
    print(measured, file=sys.stderr, flush=True)
    return measured


def _both(times: list[float | None]) -> str:
    return "–" if None in times else " / ".join(f"{value}" for value in times)


def site_with_room(folder: Path) -> Path:
    """Return the sample site, copied into ``folder``, with limits that let a crowd in from one address."""
    site = folder / "site"
    site.mkdir(exist_ok=True)
    shutil.copy(SITE / "site.gpkg", site)
    (site / "site.toml").write_text((SITE / "site.toml").read_text("utf-8") + LIMITS, "utf-8")
    return site


@contextmanager
def _server(peer: str = "") -> Iterator[tuple[int, int]]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        command: list[str | Path] = [sys.executable, HERE / "plain_fanout.py", peer]
        if not peer:
            options = [
                "--site",
                site_with_room(folder),
                "--database",
                f"sqlite:///{folder}/fleet.db",
                "--port",
                "0",
            ]
            command = [sys.executable, "-m", "robot_bridge", "serve", *options]
        with Processes(folder / "logs") as processes:
            pinned = ["taskset", "-c", str(SERVER_CORE), *command]
            process = processes.start("server", pinned, env=MALLOC)
            port = processes.wait_for_line("server", r"listening on ws://\S+:(\d+)", 60).group(1)
            yield process.pid, int(port)
