"""Gateways of one fleet as processes, what may be killed beside them, and milliseconds for the tables."""

from __future__ import annotations

import json
import signal
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import quantiles
from typing import Any

from benchmarks.load import site_with_room
from benchmarks.swarm import Onlooker, cpu_seconds, megabytes_of
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from tests.support.databases.database_server import DatabaseServer
from tests.support.fleet import SITE, serve
from tests.support.nats_server import NatsServer
from tests.support.processes import Processes


class Gateways(ExitStack):
    """A context with ``count`` gateways on a new database; several have a NATS server between them.

    With ``room`` so many robots may connect from one address.
    """

    def __init__(self, database: DatabaseServer, count: int, room: int = 0) -> None:
        super().__init__()
        self._database = database
        try:
            self.start(count, room)
        except BaseException:
            self.close()
            raise

    def start(self, count: int, room: int) -> None:
        """Start the gateways; return when they listen."""
        url = self._database.new_database()
        run_once(url, revisions.create)
        root = Path(self.enter_context(tempfile.TemporaryDirectory(prefix="fleet-gateways-")))
        site = site_with_room(root, room) if room else SITE
        processes = self.enter_context(Processes(root / "logs"))
        self.nats = self.enter_context(NatsServer(root)) if count > 1 else None
        self.gateways = []
        for number in range(count):
            state = root / f"state-{number}"
            state.mkdir()
            options: list[Any] = ["--state", state]
            if self.nats is not None:
                options += ["--gateway-name", f"g{number}", "--bus", self.nats.url]
            self.gateways.append(serve(processes, site, url, *options, name=f"gateway-{number}"))
        self.addresses = [one.address for one in self.gateways]

    def cpu_seconds(self) -> float:
        """Return the processor time that all gateways have used."""
        return sum(cpu_seconds(one.process.pid) for one in self.gateways)

    def megabytes(self) -> list[float]:
        """Return the memory that each gateway has now."""
        return [megabytes_of(one.process.pid) for one in self.gateways]

    def begin(self, module: str, plan: dict[str, Any]) -> Onlooker:
        """Start a process that ends with this."""
        onlooker = Onlooker(sys.executable, "-m", module, json.dumps(plan))
        self.callback(onlooker.end)
        return onlooker

    @contextmanager
    def without_nats(self) -> Iterator[None]:
        """Have the bus dead."""
        assert self.nats is not None
        self.nats.kill()
        yield
        self.nats.start()

    @contextmanager
    def without_database(self) -> Iterator[None]:
        """Have the database server dead."""
        self._database.kill()
        yield
        self._database.start()

    @contextmanager
    def frozen(self, gateway: int) -> Iterator[None]:
        """Have a gateway stand still."""
        process = self.gateways[gateway].process
        process.send_signal(signal.SIGSTOP)
        yield
        process.send_signal(signal.SIGCONT)

    def kill(self, gateway: int) -> None:
        """Kill a gateway; return when it has ended."""
        process = self.gateways[gateway].process
        process.kill()
        process.wait()


def percentile(values: list[float], share: int) -> float:
    """Return the value below which so many of a hundred lie."""
    return quantiles(values, n=100, method="inclusive")[share - 1] if len(values) > 1 else values[0]


def median_and_p99(values: list[float]) -> str:
    """Return both as a cell of a table."""
    return f"{percentile(values, 50):.0f} / {percentile(values, 99):.0f} ms"


def median_and_worst(values: list[float]) -> str:
    """Return both as a cell of a table."""
    return f"{percentile(values, 50):.0f} / {max(values):.0f} ms"
