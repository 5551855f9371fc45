"""The real programs: a gateway and reference robots, each a process of its own."""

from __future__ import annotations

import contextlib
import itertools
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from subprocess import Popen
from typing import Any, ClassVar
from weakref import WeakSet

from tests.support.databases.database_client import DatabaseClient
from tests.support.fleet import serve
from tests.support.operators import Desk
from tests.support.patience import BUSY
from tests.support.processes import Processes
from tests.support.robots.robot_wires import RobotWire
from tests.support.wire import Wire

RUNS = itertools.count(1)
LONGEST_PAUSE_S = 0.1
"""before a condition is looked at again."""


def wait_until(condition: Callable[[], Any], seconds: float = 10.0, what: str = "") -> Any:
    """Return what ``condition`` returns once that is true; fail after ``seconds`` of an idle machine."""
    until, pause = time.monotonic() + BUSY * seconds, 0.01
    while not (found := condition()):
        assert time.monotonic() < until, f"not within {BUSY * seconds:g} s: {what or condition}"
        time.sleep(pause)
        # Many conditions ask a database, each time over a new connection.
        pause = min(1.2 * pause, LONGEST_PAUSE_S)
    return found


class Bridge:
    """One gateway on one site and one database, its robots, and who talks to it."""

    open_ones: ClassVar[WeakSet[Bridge]] = WeakSet()

    def __init__(self, processes: Processes, site: Path, database: str):
        self.site, self.database = site, database
        self.address, self.port = "", 0
        self.options: list[Any] = []
        """More options of the gateway's command line."""
        self._processes = processes
        self._names: list[str] = []
        self._running: list[str] = []
        self._wires: list[Wire] = []
        self._had: tuple[set[str], set[Wire]] | None = None
        self.open_ones.add(self)

    @property
    def file(self) -> Path:
        """The file of a SQLite database."""
        return Path(self.database.removeprefix("sqlite:///"))

    def start_gateway(self) -> None:
        """Start the gateway, on the port it had if it ran before; return once it listens."""
        self._gateway_name = name = self._unique("gateway")
        where = self._processes, self.site, self.database
        served = serve(*where, *self.options, port=self.port, name=name, forked=True)
        self.gateway = self.process = served.process
        self.address, self.port = served.address, served.port

    def start_robot(
        self,
        name: str,
        pose: tuple[float, float, float],
        *,
        sql: bool | str = False,
        options: Sequence[Any] = (),
    ) -> Popen[bytes]:
        """Start a fast reference robot, with more ``options`` of its command line.

        ``sql`` is the URL of the database, or true for the gateway's own.
        """
        way = (
            ["--database", self.database if sql is True else sql]
            if sql
            else ["--url", f"{self.address}/robot"]
        )
        where = ",".join(str(number) for number in pose)
        fast = ["--speed", "5", "--turn-rate", "6", "--acceleration", "8", "--rate", "10"]
        self._run(name, ["robot", *way, "--name", name, f"--pose={where}", *fast, *options])
        return self.process

    def start_link(self, kind: str, config: Path) -> Popen[bytes]:
        """Start an adapter with the settings in ``config``."""
        self._run(f"link-{kind}", ["link", kind, "--config", config])
        return self.process

    def _run(self, name: str, command: list[Any]) -> None:
        unique = self._unique(name)
        self.process = self._processes.start_bridge(unique, command)

    def _unique(self, name: str) -> str:
        self._names.append(f"{name}-{next(RUNS)}")
        self._running.append(self._names[-1])
        return self._names[-1]

    def kill_gateway(self) -> None:
        """End the gateway the way a power cut does."""
        self.gateway.kill()
        self.gateway.wait(BUSY * 5)

    def desk(self, operator: str = "Ada", **options: Any) -> Desk:
        """Return an operator's connection."""
        desk = Desk(f"{self.address}/desk", operator, **options)
        self._wires.append(desk)
        return desk

    def robot(self, name: str | None = None, **options: Any) -> RobotWire:
        """Return a robot's connection that does nothing by itself."""
        wire = RobotWire(f"{self.address}/robot" + (f"?robot={name}" if name else ""), **options)
        self._wires.append(wire)
        return wire

    def hang_up(self) -> None:
        """Cut every connection; a close in good order would wait for what nobody read."""
        for wire in self._wires:
            wire.hang_up()

    def end(self) -> None:
        """End the gateway and the robots, so that they take no time from the next test."""
        self.hang_up()
        while self._running:
            self._processes.end(self._running.pop())

    def begin_test(self) -> None:
        """Remember what runs and who is connected: that was there before a test."""
        self._had = set(self._running), set(self._wires)

    def end_test(self) -> None:
        """End what a test has started on its own: robots that drive and desks that nobody reads cost time.

        A gateway that was there before goes on, also where the test has started it again.
        """
        if self._had is None:
            self.end()
            return
        had, connected = self._had
        for name in [name for name in self._running if name not in had and not name.startswith("gateway-")]:
            self._running.remove(name)
            self._processes.end(name)
        for wire in [wire for wire in self._wires if wire not in connected]:
            self._wires.remove(wire)
            wire.hang_up()

    def sql(self, text: str, *values: Any) -> list[tuple[Any, ...]]:
        """Run one statement as any other program would."""
        with contextlib.closing(DatabaseClient(self.database)) as client:
            return client.sql(text, *values)

    def gateway_output(self) -> str:
        """Return what the gateway has printed since it was started last."""
        return self._processes.log(self._gateway_name).read_text(encoding="utf-8")

    def output(self) -> str:
        """Return what the gateway and the robots have printed."""
        logs = [self._processes.log(name).read_text(encoding="utf-8") for name in self._names]
        return "\n".join(logs)
