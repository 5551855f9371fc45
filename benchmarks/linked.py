"""An adapter between its robots and a gateway, watched from a desk: its CPU, its memory, and the delay."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.load import serving
from benchmarks.swarm import cpu_seconds, megabytes_of
from tests.support.processes import Processes, dying_with_this

HERE = Path(__file__).parent
FRESH = re.compile(r'^robot_bridge_robots\{state="fresh"\} (\S+)', re.MULTILINE)
PROBING = 50.0
"""Hz at which the desk asks that tells how old positions are."""
COME_WITHIN = 150.0
"""seconds in which all robots must have come to the gateway."""
START = 60.0
SETTLE = 2.5
"""seconds after which a desk that came has been told all that was there before."""


class NotMeasuredError(Exception):
    """Why something could not be measured; the page says so."""


@dataclass(frozen=True)
class Window:
    """What came of some seconds: delays in ms (median, p99), and processor time in cores."""

    delays: list[float | None]
    adapter: float
    gateway: float

    def row(self) -> list[str]:
        """Return the delays, and the processor time of adapter and gateway, as a table tells them."""
        delays = ["–" if one is None else f"{one:.0f}" for one in self.delays]
        return [*delays, f"{100 * self.adapter:.0f} %", f"{100 * self.gateway:.0f} %"]


class Linked:
    """A gateway and an adapter that run, and a desk that looks on."""

    def __init__(self, port: int, gateway: int, adapter: int, folder: Path, processes: Processes) -> None:
        self.port, self.folder, self.processes = port, folder, processes
        self._gateway, self._adapter = gateway, adapter
        self._operators: subprocess.Popen[str] | None = None

    def wait_for(self, robots: int) -> None:
        """Wait until so many robots are fresh; raises NotMeasuredError."""
        until = time.monotonic() + COME_WITHIN
        while (come := self._fresh()) < robots:
            if time.monotonic() > until:
                said = self.processes.log("adapter").read_text("utf-8", "replace")[-400:]
                raise NotMeasuredError(f"{come} of {robots} robots came within {COME_WITHIN:g} s: {said}")
            time.sleep(0.5)

    def look(self) -> None:
        """Let a desk look on from now on."""
        plan = {
            **{"host": "127.0.0.1", "port": self.port, "operators": 1, "operator_rate": 5.0},
            **{"probe_rate": PROBING, "stuck": 0, "rpc": True},
        }
        self._operators = subprocess.Popen(
            dying_with_this([sys.executable, "-m", "benchmarks.swarm_operators", json.dumps(plan)]),
            cwd=HERE.parent,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._line()
        time.sleep(SETTLE)

    def window(self, seconds: float) -> Window:
        """Return what comes of the next seconds."""
        assert self._operators is not None and self._operators.stdin is not None
        pids = (self._adapter, self._gateway)
        begin = time.monotonic()
        self._operators.stdin.write(json.dumps({"begin": begin, "seconds": seconds}) + "\n")
        self._operators.stdin.flush()
        before = [cpu_seconds(pid) for pid in pids]
        time.sleep(max(0.0, begin + seconds - time.monotonic()))
        took = time.monotonic() - begin
        adapter, gateway = ((cpu_seconds(p) - b) / took for p, b in zip(pids, before, strict=True))
        return Window(self._line()["delays"], adapter, gateway)

    def end(self) -> None:
        """Let the desk go."""
        if self._operators is not None:
            self._operators.kill()
            self._operators.wait()

    def megabytes(self) -> tuple[float, float]:
        """Return the resident memory of the adapter and of the gateway, in MB."""
        return megabytes_of(self._adapter), megabytes_of(self._gateway)

    def _fresh(self) -> int:
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/metrics", timeout=START) as page:
            found = FRESH.search(page.read().decode())
        return int(float(found.group(1))) if found else 0

    def _line(self) -> Any:
        assert self._operators is not None and self._operators.stdout is not None
        line = self._operators.stdout.readline()
        if not line:
            raise RuntimeError(f"the desk ended with status {self._operators.wait()}")
        return None if line == "ready\n" else json.loads(line)


@contextmanager
def linked(kind: str, settings: str, env: Mapping[str, str] | None = None) -> Iterator[Linked]:
    """Run an adapter with ``settings``, the tables of its kind, and a gateway for it."""
    with tempfile.TemporaryDirectory() as name, serving() as (gateway, port):
        folder = Path(name)
        file = folder / "bench.toml"
        file.write_text(f'[gateway]\nurl = "ws://127.0.0.1:{port}/link"\n{settings}', "utf-8")
        with Processes(folder / "logs") as processes:
            command = [sys.executable, "-m", "robot_bridge", "link", kind, "--config", file]
            adapter = processes.start("adapter", command, env={**os.environ, **(env or {})})
            running = Linked(port, gateway, adapter.pid, folder, processes)
            try:
                yield running
            finally:
                running.end()
