"""Everything at once: a database, a gateway on it, robots, and desks that send them commands."""

from __future__ import annotations

import contextlib
import json
import random
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, func, make_url, select

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.schema import trajectories
from tests.support.databases.database_server import DatabaseServer, add_accounts
from tests.support.errors import StageError
from tests.support.faults.crew import CREW, Plan
from tests.support.faults.desk import Ledger, SendingDesk
from tests.support.faults.mind import entries
from tests.support.faults.proxy import Proxy
from tests.support.fleet import SITE, serve
from tests.support.operators import ask
from tests.support.patience import BUSY
from tests.support.processes import Processes

EVERY_POSITION = """
[trajectories]
min_distance_m = 0.0
min_turn_deg = 0.0
min_interval_s = 0.0
"""
GATEWAY_KILLED, ROBOTS_KILLED = "gateway killed", "two robots killed"
DESKS = 4
STORED_WITHIN_S = 2.0
"""seconds within which the gateway stores what it was told last, on an idle machine."""
FIRST_ROW, BETWEEN_ROWS = 8.0, 7.0
"""metres: the y of the robots, each in a row of its own."""


@dataclass(frozen=True)
class Death:
    """A process that was killed: alive at ``since``, dead at ``by``; a busy machine takes its time."""

    since: float
    by: float


@dataclass(frozen=True)
class Fault:
    """Something that was done: when it began and when it was over, seconds since 1970-01-01."""

    what: str
    at: float
    until: float


@dataclass
class Place:
    """Where the database is: for the gateway, for the robots, and for the audit; ``server`` if it has one."""

    url: str
    gateway_url: str
    robot_urls: dict[str, str]
    server: DatabaseServer | None = None
    network: Proxy | None = None


@dataclass
class Crew:
    """Robots in one process, which can be killed."""

    robots: dict[str, tuple[str, tuple[float, float]]]
    journal: Path
    life: int = 0
    process: subprocess.Popen[bytes] | None = None
    ends: list[Death] = field(default_factory=list)


@dataclass
class Yard:
    """A context in which all of it runs; what happens is random by ``seed``."""

    folder: Path
    place: Place
    seed: int
    faults: list[Fault] = field(default_factory=list)
    gateway_ends: list[Death] = field(default_factory=list)
    ledger: Ledger = field(default_factory=Ledger)

    def __enter__(self) -> Yard:
        self.random = random.Random(self.seed)
        self._processes = Processes(self.folder / "logs")
        self._processes.__enter__()
        self._site = _site(self.folder)
        self._port = self._gateways = self._started = 0
        self.address = ""
        self._desks: list[SendingDesk] = []
        self.crews: list[Crew] = []
        try:
            self.start_gateway()
            self._start_everybody()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        for desk in self._desks:
            desk.ending.set()
        for desk in self._desks:
            desk.join(5)
        self._processes.__exit__()

    # --- the gateway ----------------------------------------------------------------------------------

    def start_gateway(self) -> None:
        """Start the gateway on the port it had; return once it listens."""
        self._gateways += 1
        name, url = f"gateway-{self._gateways}", self.place.gateway_url
        served = serve(self._processes, self._site, url, port=self._port, name=name, forked=True)
        self._gateway, self.address, self._port = served.process, served.address, served.port

    def kill_gateway(self) -> None:
        """End the gateway the way a power cut does."""
        self.require_gateway()
        self.gateway_ends.append(_kill(self._gateway))

    def require_gateway(self) -> None:
        """Note it as wrong when the gateway has ended by itself."""
        if self._gateway.poll() is not None:
            self.ledger.wrong.append(f"gateway {self._gateways} ended with {self._gateway.returncode}")

    def said(self, pattern: str) -> list[str]:
        """Return the lines that gateways and robots printed with ``pattern`` in them."""
        logs = sorted((self.folder / "logs").glob("*.log"))
        lines = [line for log in logs for line in log.read_text(errors="replace").splitlines()]
        return [line for line in lines if pattern in line]

    # --- robots ---------------------------------------------------------------------------------------

    def kill_crew(self, crew: Crew) -> None:
        """End its robots the way a power cut does."""
        assert crew.process is not None
        crew.ends.append(_kill(crew.process))

    def start_crew(self, crew: Crew, *, remembers: bool = False) -> None:
        """Start its robots, which go on by their journal if they remember."""
        crew.life += 1
        self._started += 1
        name = f"crew-{self._started}"
        plan = self.folder / f"{name}.json"
        plan.write_text(
            json.dumps(asdict(Plan(crew.robots, str(crew.journal), crew.life, remembers))), encoding="utf-8"
        )
        crew.process = self._processes.start_forked(CREW, name, [plan])

    def robot_ends(self) -> dict[str, list[Death]]:
        """Return for each robot when it was killed."""
        return {robot: crew.ends for crew in self.crews for robot in crew.robots}

    def journals(self) -> Iterator[dict[str, Any]]:
        """Yield what all robots wrote down."""
        for crew in self.crews:
            yield from entries(crew.journal)

    # --- time -----------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def fault(self, what: str) -> Iterator[None]:
        """Write down that the body is a fault, and when."""
        began = time.time()
        try:
            yield
        finally:
            self.faults.append(Fault(what, began, time.time()))

    def work(self, shortest: float, longest: float) -> None:
        """Let everybody work for a random while."""
        time.sleep(self.random.uniform(shortest, longest))

    def settle(self, seconds: float = 60.0) -> None:
        """Send nothing new and wait until every command has ended; what has not is wrong."""
        for desk in self._desks:
            desk.resting.set()
        self._wait(lambda: not any(desk.busy for desk in self._desks), seconds)
        stuck = [id for desk in self._desks for id in desk.busy]
        if stuck:
            self.ledger.wrong.append(f"not ended {seconds:g} s after the last fault: {', '.join(stuck)}")

    def go_on(self) -> None:
        """Send commands again."""
        for desk in self._desks:
            desk.resting.clear()

    def finish(self) -> None:
        """Let what runs come to its end, send the robots home, and store what they said last."""
        self.settle()
        self.require_gateway()
        for crew in self.crews:
            assert crew.process is not None
            crew.process.terminate()
            crew.process.wait(20)
        # What is not there then is lost, which the audit tells.
        self._wait(self._last_words_are_stored, STORED_WITHIN_S)

    # ---------------------------------------------------------------------------------------------------

    def _start_everybody(self) -> None:
        homes = {
            name: (5.0, FIRST_ROW + row * BETWEEN_ROWS) for row, name in enumerate(self.place.robot_urls)
        }
        robots = {name: (url or self.address, homes[name]) for name, url in self.place.robot_urls.items()}
        # The last two, one of each kind, are those that are killed.
        for number, names in enumerate((list(robots)[:-2], list(robots)[-2:]), start=1):
            crew = Crew({name: robots[name] for name in names}, self.folder / f"journal-{number}")
            self.crews.append(crew)
            self.start_crew(crew)
        if not self._wait(self._all_are_there, 30):
            raise StageError("the robots did not all come; see the logs of the crews")
        for number in range(DESKS):
            rows = {name: homes[name][1] for name in list(robots)[number::DESKS]}
            desk = SendingDesk(lambda: self.address, rows, f"{self.seed} {number}", self.ledger)
            self._desks.append(desk)
            desk.start()

    def _all_are_there(self) -> bool:
        (known,) = ask(self.address, ("get_positions", {}))
        return {robot["robot"] for robot in known["robots"] if "x" in robot} >= set(self.place.robot_urls)

    def _last_words_are_stored(self) -> bool:
        last: dict[str, float] = {}
        for entry in self.journals():
            if entry["what"] == "pose":
                last[entry["robot"]] = max(entry["t"], last.get(entry["robot"], 0.0))
        return run_once(self.place.url, _newest_stored) == last

    def _wait(self, condition: Callable[[], bool], seconds: float) -> bool:
        until = time.monotonic() + BUSY * seconds
        while not condition():
            if time.monotonic() > until:
                return False
            time.sleep(0.1)
        return True


def _kill(process: subprocess.Popen[bytes]) -> Death:
    since = time.time()
    process.kill()
    process.wait()
    return Death(since, time.time())


def names(count: int) -> list[str]:
    """Return robots' names, those on WebSocket and on SQL in turn."""
    return [f"{'ws' if number % 2 == 0 else 'sq'}{number:02d}" for number in range(count)]


def sqlite_place(folder: Path, count: int) -> Place:
    """Return a new SQLite database in ``folder`` with ``count`` robots, half of them on SQL."""
    url = f"sqlite:///{folder}/fleet.db"
    run_once(url, revisions.create)
    return Place(url, url, {name: "" if name.startswith("ws") else url for name in names(count)})


def server_place(server: DatabaseServer, network: Proxy, count: int) -> Place:
    """Return a new database on ``server``, which the gateway reaches through ``network``."""
    url = server.new_database()
    run_once(url, revisions.create)
    robots = names(count)
    urls = add_accounts(url, server.admin_url(url), [name for name in robots if name.startswith("sq")])
    through = make_url(url).set(port=network.port).render_as_string(hide_password=False)
    return Place(url, through, {name: urls.get(name, "") for name in robots}, server, network)


def _newest_stored(connection: Connection) -> dict[str, float]:
    """Return by the robots' own clocks when the newest position of each was told."""
    newest = select(trajectories.c.robot, func.max(trajectories.c.device_time))
    return dict(map(tuple, connection.execute(newest.group_by(trajectories.c.robot))))


def _site(folder: Path) -> Path:
    """Return a copy of the sample site on which every position is stored."""
    site = folder / "site"
    site.mkdir()
    shutil.copy(SITE / "site.gpkg", site)
    text = (SITE / "site.toml").read_text(encoding="utf-8")
    (site / "site.toml").write_text(text + EVERY_POSITION, encoding="utf-8")
    return site
