"""Several gateways of one fleet, robots, and desks that send commands and stops, while anything is killed."""

from __future__ import annotations

import contextlib
import itertools
import json
import random
import re
import subprocess
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from websockets.exceptions import WebSocketException

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from tests.support.databases.database_server import DatabaseServer
from tests.support.errors import StageError
from tests.support.faults.audit import Deaths, Findings, judged, load_stored
from tests.support.faults.crew import CREW, Plan
from tests.support.faults.desk import Ledger, SendingDesk
from tests.support.faults.yard import BETWEEN_ROWS, FIRST_ROW, GATEWAY_KILLED, Fault
from tests.support.fleet import SITE
from tests.support.nats_server import NatsCluster
from tests.support.operators import open_desk
from tests.support.patience import BUSY, START
from tests.support.processes import Processes, free_port
from tests.support.wire import RefusedError

AGAIN = "messages that came again under their id"
NATS_KILLED, DATABASE_KILLED = "NATS server killed", "PostgreSQL killed"
TOLERATED = r"an emergency stop is in force|has not answered within|is stopped by an emergency|shutting down"
"""What a desk may be refused for while gateways die and stops are in force."""
NOT_DONE = r"an emergency stop is in force|what was asked was not done"
"""Refusals after which the robot must not have been sent the command."""
ROWS, DESKS = 20, 4
STOP_EVERY_S, STANDING_S = (3.0, 9.0), (0.2, 1.0)
HEARD_WITHIN_S, STARTED_AGAIN_S = 30.0, 2.0
LISTENING = r"listening on ws"
WAYS_OUT = (OSError, TimeoutError, WebSocketException, RefusedError)


@dataclass
class Stop:
    """An emergency stop: when it was asked for, robots heard, its end was asked for, it was cleared."""

    id: str
    at: float
    heard: dict[str, float] = field(default_factory=dict)
    ended: float = float("inf")
    cleared: float = float("inf")

    @property
    def seconds(self) -> float:
        """Until the last robot heard."""
        return max(self.heard.values(), default=float("nan")) - self.at


class Journal:
    """What robots wrote down, read as it grows; lines on positions are left out."""

    def __init__(self, file: Path) -> None:
        self._file, self._read = file, 0
        self.lines: list[dict[str, Any]] = []

    def read(self) -> list[dict[str, Any]]:
        """Return the lines that are new."""
        if not self._file.is_file():
            return []
        with self._file.open("rb") as stream:
            stream.seek(self._read)
            text = stream.read()
        whole = text[: text.rfind(b"\n") + 1]
        self._read += len(whole)
        new = [json.loads(line) for line in whole.splitlines() if b'"what": "pose"' not in line]
        self.lines += new
        return new


class StoppingDesk(threading.Thread):
    """A supervisor at any gateway, who makes a stop, waits until all robots heard, and ends it."""

    def __init__(self, addresses: list[str], robots: set[str], journal: Journal, seed: str) -> None:
        super().__init__(name="stops", daemon=True)
        self._addresses, self._robots, self._journal = addresses, robots, journal
        self._random = random.Random(seed)
        self.stops: list[Stop] = []
        self.wrong: list[str] = []
        self.ending = threading.Event()

    def run(self) -> None:
        """Make one stop after the other until told to end; the last one is ended, too."""
        for number in itertools.count(1):
            if self.ending.wait(self._random.uniform(*STOP_EVERY_S)):
                return
            stop = Stop(f"stop-{number:04d}", time.time())
            self.stops.append(stop)
            self._run_with_retry("emergency_stop", {"command": stop.id, "reason": "everything is killed"})
            self._await_robots(stop)
            time.sleep(self._random.uniform(*STANDING_S))
            stop.ended = time.time()
            self._run_with_retry("clear_emergency_stop", {"stop": stop.id, "reason": "all stand"})
            stop.cleared = time.time()

    def _await_robots(self, stop: Stop) -> None:
        until = time.time() + HEARD_WITHIN_S * BUSY
        while self._robots - stop.heard.keys():
            for line in self._journal.read():
                if line["what"] == "acted" and line["id"] == f"emergency-{stop.id}":
                    stop.heard.setdefault(line["robot"], line["at"])
            if time.time() > until:
                missed = sorted(self._robots - stop.heard.keys())
                self.wrong.append(f"{stop.id} was missed by {', '.join(missed)}")
                return
            time.sleep(0.02)

    def _run_with_retry(self, method: str, params: dict[str, Any]) -> None:
        """Ask at one gateway after the other until one has done it."""
        until, said = time.time() + HEARD_WITHIN_S * BUSY, ""
        while time.time() < until:
            try:
                with open_desk(self._random.choice(self._addresses), operator="Bea") as desk:
                    desk.ask(method, params)
                    return
            except WAYS_OUT as error:
                said = str(error)
                time.sleep(0.2)
        self.wrong.append(f"{method} {params} was not done: {said}")


class ClusterYard:
    """A context in which all of it runs; what happens is random by ``seed``."""

    def __init__(
        self, folder: Path, server: DatabaseServer, nats: NatsCluster, seed: int, gateways: int, robots: int
    ) -> None:
        self._folder, self.server, self.nats, self._seed = folder, server, nats, seed
        self.random = random.Random(seed)
        self._url = server.new_database()
        run_once(self._url, revisions.create)
        self.faults: list[Fault] = []
        self.ledger = Ledger()
        self._ports = [free_port() for _ in range(gateways)]
        self._starts = [0] * gateways
        self._up_since: list[float | None] = [None] * gateways
        self._running: list[subprocess.Popen[bytes]] = []
        self.names = [f"ws{number:02d}" for number in range(robots)]
        self._file = folder / "journal"
        self.journal = Journal(self._file)

    @property
    def addresses(self) -> list[str]:
        """Those of the gateways, as robots and desks connect to them."""
        return [f"ws://127.0.0.1:{port}" for port in self._ports]

    def __enter__(self) -> ClusterYard:
        self._processes = Processes(self._folder / "logs")
        self._processes.__enter__()
        self._desks: list[SendingDesk] = []
        try:
            self._running = [self._start(number) for number in range(len(self._ports))]
            for number in range(len(self._ports)):
                self._processes.wait_for_line(self._name(number), LISTENING, START)
            self.stopping = StoppingDesk(self.addresses, set(self.names), self.journal, f"{self._seed} stops")
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

    # --- gateways -------------------------------------------------------------------------------------

    def _name(self, number: int) -> str:
        return f"gateway-{number}-{self._starts[number]}"

    def _start(self, number: int) -> subprocess.Popen[bytes]:
        self._starts[number] += 1
        self._up_since[number] = None
        state = self._folder / f"state-{number}"
        state.mkdir(exist_ok=True)
        words = ["serve", "--site", SITE, "--port", self._ports[number], "--database", self._url]
        words += ["--state", state, "--gateway-name", f"g{number}", "--bus", self.nats.url]
        return self._processes.start_bridge(self._name(number), list(map(str, words)))

    def is_up(self, number: int) -> bool:
        """Tell whether a gateway runs and listens."""
        if self._running[number].poll() is not None:
            return False
        text = self._processes.log(self._name(number)).read_text(encoding="utf-8", errors="replace")
        return re.search(LISTENING, text) is not None

    def _mind_gateways(self) -> None:
        """Start again what could not start, as a service manager does: its database was away."""
        for number, process in enumerate(self._running):
            if (status := process.poll()) is None:
                continue
            said = self._processes.log(self._name(number)).read_text(encoding="utf-8", errors="replace")
            if re.search(LISTENING, said):
                self.ledger.wrong.append(f"gateway g{number} ended with {status}: {said.strip()[-300:]}")
            elif "Traceback" in said:
                self.ledger.wrong.append(f"gateway g{number} did not start: {said.strip()[-300:]}")
            self._running[number] = self._start(number)

    # --- what is killed -------------------------------------------------------------------------------

    def kill_gateway(self) -> None:
        """Kill a gateway that is up while another one is, and start it again after a while."""
        up = self._wait_for(lambda: [n for n in range(len(self._ports)) if self.is_up(n)], least=2)
        number = self.random.choice(up)
        away = self.random.uniform(0.0, STARTED_AGAIN_S)
        with self.fault(f"{GATEWAY_KILLED} g{number}"):
            self._running[number].kill()
            self._running[number].wait()
            time.sleep(away)
            self._running[number] = self._start(number)

    def kill_nats_server(self) -> None:
        """Kill one of the NATS servers, and start it again after a while."""
        server = self.random.choice(list(self.nats.servers.values()))
        with self.fault(NATS_KILLED):
            server.kill()
            self.work(0.0, STARTED_AGAIN_S)
            server.start()

    def kill_database(self) -> None:
        """Kill PostgreSQL, and start it again after a while."""
        with self.fault(DATABASE_KILLED):
            self.server.kill()
            self.work(0.0, STARTED_AGAIN_S)
            self.server.start()

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
        until = time.monotonic() + self.random.uniform(shortest, longest)
        while (left := until - time.monotonic()) > 0:
            self._mind_gateways()
            time.sleep(min(0.2, left))

    def _wait_for(self, found: Callable[[], list[int]], least: int) -> list[int]:
        until = time.monotonic() + BUSY * 30
        while len(some := found()) < least:
            if time.monotonic() > until:
                raise StageError(f"gateways do not come up again; see the logs in {self._folder}")
            self.work(0.1, 0.2)
        return some

    # --- the end --------------------------------------------------------------------------------------

    def finish(self) -> None:
        """Let what runs come to its end, and send the robots home."""
        self.stopping.ending.set()
        self._await(lambda: not self.stopping.is_alive(), 4 * HEARD_WITHIN_S, "the last stop was not ended")
        for desk in self._desks:
            desk.resting.set()
        self._await(lambda: not any(desk.busy for desk in self._desks), 60.0, "commands have not ended")
        self.ledger.wrong += [f"{id} has not ended" for desk in self._desks for id in desk.busy][:20]
        self._crew.terminate()
        self._crew.wait(60)
        self.journal.read()

    def _await(self, condition: Callable[[], bool], seconds: float, wrong: str) -> None:
        until = time.monotonic() + BUSY * seconds
        while not condition():
            if time.monotonic() > until:
                self.ledger.wrong.append(f"{wrong} after {BUSY * seconds:g} s")
                return
            self.work(0.1, 0.1)

    def audit(self) -> Findings:
        """Judge what happened, once it is finished."""
        stored = run_once(self._url, load_stored)
        kinds = [replace(fault, what=fault.what.rpartition(" g")[0] or fault.what) for fault in self.faults]
        lines = self.journal.lines
        stops = [(stop.at, stop.cleared) for stop in self.stopping.stops]
        findings = judged(self.ledger, kinds, stored, lines, Deaths([], {}), stops)
        findings.wrong += self.stopping.wrong
        findings.wrong += list(moved_while_stopped(lines, self.stopping.stops))
        findings.wrong += list(done_though_refused(lines, self.ledger.refused))
        for log in sorted((self._folder / "logs").glob("*.log")):
            if "Traceback" in (text := log.read_text(encoding="utf-8", errors="replace")):
                findings.wrong.append(f"{log.name}: {text[text.index('Traceback') :][:3000]}")
        findings.back_after = list(taken_up_again(lines, self.faults, self.addresses))
        findings.counts["stops"] = len(self.stopping.stops)
        findings.counts[AGAIN] = sum(line["what"] == "again" for line in lines)
        return findings

    # --- the beginning --------------------------------------------------------------------------------

    def _start_everybody(self) -> None:
        rows = {name: FIRST_ROW + number % ROWS * BETWEEN_ROWS for number, name in enumerate(self.names)}
        robots = {}
        for number, name in enumerate(self.names):
            turn = number % len(self._ports)
            url = ",".join([*self.addresses[turn:], *self.addresses[:turn]])
            robots[name] = (url, (5.0, rows[name]))
        plan = self._folder / "crew.json"
        plan.write_text(json.dumps(asdict(Plan(robots, str(self._file), 1, False))), encoding="utf-8")
        self._crew = self._processes.start_forked(CREW, "crew", [plan])
        for number in range(DESKS):
            own = {name: rows[name] for name in self.names[number::DESKS]}
            turns = itertools.cycle([*self.addresses[number:], *self.addresses[:number]])
            desk = SendingDesk(
                lambda turns=turns: next(turns), own, f"{self._seed} {number}", self.ledger, TOLERATED
            )
            self._desks.append(desk)
        self._wait_for_robots()
        for desk in self._desks:
            desk.start()
        self.stopping.start()

    def _wait_for_robots(self) -> None:
        until = time.monotonic() + BUSY * 30
        there: set[str] = set()
        while there < set(self.names):
            there |= {line["robot"] for line in self.journal.read() if line["what"] == "ready"}
            if time.monotonic() > until:
                raise StageError(f"the robots did not all come; see the logs in {self._folder}")
            time.sleep(0.1)


# --- What is judged beside what the audit does --------------------------------------------------------------


def moved_while_stopped(lines: Iterable[dict[str, Any]], stops: Sequence[Stop]) -> Iterator[str]:
    """Yield each command that a robot acted on between hearing of a stop and the asking for its end."""
    for line in lines:
        if line["what"] != "acted" or line["op"] == "Abort":
            continue
        for stop in stops:
            if stop.heard.get(line["robot"], float("inf")) < line["at"] < stop.ended:
                number = line["number"]
                yield f"{line['robot']} was sent {line['op']} {number} while {stop.id} was in force"


def done_though_refused(lines: Iterable[dict[str, Any]], refused: Mapping[str, str]) -> Iterator[str]:
    """Yield each command that was acted on though the desk was told that it was not done."""
    acted = {
        f"{line['robot']}-{line['number']:06d}"
        for line in lines
        if line["what"] == "acted" and line["op"] != "Abort"
    }
    for id, said in refused.items():
        if id in acted and re.search(NOT_DONE, said):
            yield f"command {id} was acted on, though the desk was told: {said}"


def taken_up_again(
    lines: Iterable[dict[str, Any]], faults: Iterable[Fault], addresses: Sequence[str]
) -> Iterator[float]:
    """Yield for each gateway that was killed the seconds until another one had its last robot."""
    ready = sorted((line for line in lines if line["what"] == "ready"), key=lambda line: float(line["at"]))
    for fault in faults:
        kind, _, number = fault.what.rpartition(" g")
        if kind != GATEWAY_KILLED:
            continue
        at: dict[str, str] = {}
        again: dict[str, float] = {}
        for line in ready:
            if line["at"] < fault.at:
                at[line["robot"]] = line["address"]
            else:
                again.setdefault(line["robot"], line["at"] - fault.at)
        hit = [robot for robot, address in at.items() if address == addresses[int(number)]]
        found = [again[robot] for robot in hit if robot in again]
        if found:
            yield max(found)
