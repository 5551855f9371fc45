"""A real gateway on the sample site, with SQLite, and three simulated robots."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

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


def start_gateway(processes: Processes, database: Path, site: Path = SITE) -> str:
    """Start a gateway of ``site`` on any free port and return its address, ``ws://127.0.0.1:PORT``.

    :raises StageError: when it does not come up.
    """
    serve = ["serve", "--site", site, "--port", "0", "--database", f"sqlite:///{database}"]
    processes.start("gateway", [sys.executable, "-m", "robot_bridge", *serve])
    return processes.wait_for_line("gateway", r"listening on (ws://[\w.]+:\d+)", START).group(1)


def start_robots(processes: Processes, address: str, database: Path, speed: float = 1.5) -> None:
    """Start the three robots: two over WebSocket, one over SQL; ``speed`` is their largest, m/s."""
    for seed, start in enumerate(STARTS, start=1):
        way = ["--database", f"sqlite:///{database}"] if start.over_sql else ["--url", f"{address}/robot"]
        pose = ",".join(str(number) for number in start.pose)
        robot = [
            "robot",
            *way,
            "--name",
            start.name,
            f"--pose={pose}",
            "--seed",
            str(seed),
            "--speed",
            str(speed),
        ]
        processes.start(start.name, [sys.executable, "-m", "robot_bridge", *robot])


def account(database: Path, *words: str) -> str:
    """Do something to an operator's account, such as ``add Ada --role viewer``; return what that prints."""
    command = [sys.executable, "-m", "robot_bridge", "operators", *words]
    command += ["--database", f"sqlite:///{database}"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
