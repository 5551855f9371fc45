"""The part on load: how many positions one gateway takes, and how old they are when operators see them."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from plugin_files import ROOT
from stage.processes import Processes

from .clock import table
from .page import Part
from .swarm import Plan

SITE = ROOT / "resources" / "sample_site"
HERE = Path(__file__).parent
SECONDS = 15.0
LIMITS = """
[limits]
per_address = 5000
desks_per_account = 100
"""
MALLOC = {"MALLOC_MMAP_THRESHOLD_": "4194304", "MALLOC_TRIM_THRESHOLD_": "67108864"}

TEXT = """\
Robots on WebSocket send positions; operators subscribe to all robots at 5 Hz; everything runs: validation,
limits, liveness, trajectories into SQLite, metrics. The gateway has a process and, as `taskset` holds it,
one core of its own; robots and operators share the other. The delay is from the robot's clock to one more
operator, who subscribes at 50 Hz, and is of positions that are new to it: at 5 Hz the newest position of a
robot is up to 0.2 s old by nature. The wire's delay is from the gateway's clock to an operator at 5 Hz.
Where robots were late by more than some tens of milliseconds, the machine was too busy for the figures
beside it.

{load}

The last two rows are a WebSocket server of a few lines on the same library and loop
(`scripts/benchmarks/plain_fanout.py`): what the wire alone costs on this machine, and what it comes to
without conflation. Not measured here: a rosbridge server in Rust, which on 100 000 messages/s delivered
18 500 of them at 147 % of a core with 13 s of delay.

### Operators who do not read

Ten more operators subscribe at 5 Hz and never read.

{stuck}
"""


@dataclass(frozen=True)
class Measured:
    """What one run came to."""

    name: str
    seen: dict[str, Any]

    def row(self) -> list[str]:
        """Return the row of the table."""
        seen = self.seen
        return [
            self.name,
            f"{seen['sent'] / seen['seconds']:,.0f}",
            f"{100 * seen['cpu']:.0f} %",
            _both(seen["delays"]),
            _both(seen["ages"]),
            f"{seen['late']:.0f}",
            f"{seen['megabytes_before']:.0f} → {seen['megabytes']:.0f}",
        ]


def _both(times: list[float | None]) -> str:
    return "–" if None in times else " / ".join(f"{value}" for value in times)


HEAD = [
    "",
    "positions/s",
    "of a core",
    "delay, ms: median / p99",
    "wire, ms: median / p99",
    "robots late, ms",
    "memory, MB",
]


def measure(_data: Path) -> Part:
    """Measure on the sample site."""
    load = [_run(f"{robots} robots × 10 Hz, 20 operators", robots, 10.0) for robots in (100, 1000)]
    peers = [
        _run("the wire alone: positions decoded and dropped", 1000, 10.0, peer="--drop", operators=0),
        _run("every position forwarded to every operator", 1000, 10.0, peer="--forward"),
    ]
    stuck = _run("1000 robots × 10 Hz, 20 operators, 10 stuck", 1000, 10.0, stuck=10)
    text = TEXT.format(
        load=table(HEAD, [run.row() for run in [*load, *peers]]),
        stuck=table(HEAD, [load[-1].row(), stuck.row()]),
    )
    return Part("Load", text)


def _run(
    name: str, robots: int, rate: float, *, stuck: int = 0, peer: str = "", operators: int = 20
) -> Measured:
    with tempfile.TemporaryDirectory() as folder, _server(Path(folder), peer) as (pid, port):
        plan = Plan("127.0.0.1", port, robots, rate, SECONDS, operators, stuck=stuck, pid=pid, rpc=not peer)
        done = subprocess.run(
            ["taskset", "-c", "1", sys.executable, HERE / "swarm.py", json.dumps(asdict(plan))],
            stdout=subprocess.PIPE,
            check=True,
        )
        seen = json.loads(done.stdout)
    print(name, seen, file=sys.stderr)
    return Measured(name, seen)


@contextmanager
def _server(folder: Path, peer: str) -> Iterator[tuple[int, int]]:
    command: list[str | Path] = [sys.executable, HERE / "plain_fanout.py", peer]
    if not peer:
        site = folder / "site"
        site.mkdir()
        shutil.copy(SITE / "site.gpkg", site)
        (site / "site.toml").write_text((SITE / "site.toml").read_text("utf-8") + LIMITS, "utf-8")
        options = ["--site", site, "--database", f"sqlite:///{folder}/fleet.db", "--port", "0"]
        command = [sys.executable, "-m", "robot_bridge", "serve", *options]
    with Processes(folder / "logs") as processes:
        process = processes.start("server", ["taskset", "-c", "0", *command], env=MALLOC)
        port = processes.wait_for_line("server", r"listening on ws://\S+:(\d+)", 30).group(1)
        yield process.pid, int(port)
