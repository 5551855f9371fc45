"""Real gateways, each a process of its own, and the three simulated robots of the sample site."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.patience import START
from tests.support.processes import Processes
from tools.plugin_files import ROOT

SITE = ROOT / "resources" / "sample_site"
PROJECT = SITE / "sample_site.qgz"


@dataclass(frozen=True)
class Start:
    """Where a robot stands at first (metres, radians, site frame) and whether it connects by SQL."""

    name: str
    pose: tuple[float, float, float]
    over_sql: bool = False


STARTS = (
    Start("r1", (20.0, 8.0, 0.0)),
    Start("r2", (48.0, 84.0, 0.0), over_sql=True),
    Start("r3", (92.0, 22.0, math.pi)),
)
"""On the straight, on the campus road, and on the handling loop."""


@dataclass(frozen=True)
class Served:
    """A gateway that listens at ``address``, ``ws://127.0.0.1:PORT``."""

    process: subprocess.Popen[bytes]
    address: str

    @property
    def port(self) -> int:
        """The port that it listens on."""
        return int(self.address.rpartition(":")[2])


def serve(
    processes: Processes,
    site: Path,
    database: str,
    *options: Any,
    port: int = 0,
    name: str = "gateway",
    env: Mapping[str, str] | None = None,
    through: Sequence[str] = (),
    forked: bool = False,
    seconds: float = START,
) -> Served:
    """Start a gateway on the database at a URL, on any free port where none is given; wait until it listens.

    ``options`` are more of its command line, ``name`` is that of its process, ``through`` begins its command.
    One that is ``forked`` loads no modules; nothing can be before its command then.

    :raises StageError: when it does not come up.
    """
    words = ["serve", "--site", site, "--port", str(port), "--database", database, *options]
    if forked:
        process = processes.start_bridge(name, words, env=env)
    else:
        command = [*through, sys.executable, "-m", "robot_bridge", *map(str, words)]
        process = processes.start(name, command, env=env)
    return Served(process, processes.wait_for_line(name, r"listening on (wss?://\S+:\d+)", seconds).group(1))


def start_gateway(processes: Processes, database: Path, site: Path = SITE) -> str:
    """Start a gateway of ``site`` on an SQLite file and return its address.

    :raises StageError: when it does not come up.
    """
    return serve(processes, site, f"sqlite:///{database}", forked=True).address


def new_database(folder: Path) -> Path:
    """Return where an SQLite database is to be in ``folder``, with what was there before removed."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in folder.glob("fleet.db*"):
        file.unlink()
    return folder / "fleet.db"


def start_robots(
    processes: Processes,
    address: str,
    database: Path,
    speed: float = 1.5,
    starts: Sequence[Start] = STARTS,
) -> dict[str, subprocess.Popen[bytes]]:
    """Start robots and return their processes; ``speed`` is their largest, m/s."""
    started = {}
    for seed, start in enumerate(starts, start=1):
        way = ["--database", f"sqlite:///{database}"] if start.over_sql else ["--url", f"{address}/robot"]
        pose = ",".join(str(number) for number in start.pose)
        robot = ["robot", *way, "--name", start.name, f"--pose={pose}"]
        robot += ["--seed", str(seed), "--speed", str(speed)]
        started[start.name] = processes.start_bridge(start.name, robot)
    return started


def account(database: Path, *words: str) -> str:
    """Do something to an operator's account, such as ``add Ada --role viewer``; return what that prints."""
    command = [sys.executable, "-m", "robot_bridge", "operators", *words]
    command += ["--database", f"sqlite:///{database}"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
