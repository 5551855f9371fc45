"""The part on several gateways: four beside one, commands and stops across, and what dies."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import quantiles
from typing import Any

from benchmarks.clock import table
from benchmarks.cluster_crowd import JITTER_S, Plan
from benchmarks.page import Part, goal
from benchmarks.swarm import Onlooker, cpu_seconds, megabytes_of
from benchmarks.trial import size
from robot_bridge.gateway.cluster.robot_relay import POSITION_TICK_S
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from tests.support.databases.database_server import DatabaseServer
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError
from tests.support.fleet import SITE, Served, serve
from tests.support.nats_server import NatsServer
from tests.support.processes import Processes

GATEWAYS = 4
ROBOTS = size(800, 40)
ROBOT_RATE, DESK_RATE = 1.0, 10.0
SECONDS, SETTLE = size(20.0, 2.0), size(5.0, 1.0)
"""seconds that are watched, and those before them, in which everybody has just come."""
COMMANDS, STOPS, ROUNDS = size(100, 5), size(10, 1), size(3, 1)
NATS_AWAY = 3.0
"""seconds that the bus is away."""
STANDING = size(1.0, 0.2)
"""seconds between a stop and its end."""
OTHERS = range(1, GATEWAYS)
ACROSS_MS, MORE_MS, IN_FORCE_MS, LAST_MS, SHARE, DIED_S, BACK_S = 50, 20, 50, 500, 0.9, 5, 1
"""What is to be kept to: see :func:`report`."""
LATEST_MS = 1000 / DESK_RATE + POSITION_TICK_S * 1000 + ACROSS_MS
"""milliseconds in which a position is to be at a desk elsewhere."""
FRESH_S = 1 / ROBOT_RATE + LATEST_MS / 1000
"""seconds that what a desk elsewhere knows of a robot may be old while all is well."""

TEXT = """\
{gateways} gateways of one fleet on PostgreSQL, which waits for its disk, and one NATS server, and beside
them, in the same run and with the same load, one gateway alone on PostgreSQL. {robots} robots, each on a
WebSocket, dealt out evenly, say where they are {robot_rate:g} times a second; a desk at each gateway
subscribes to all of them at {desk_rate:g} Hz. With one gateway {gateways} desks are at that. All of it is on
this machine's {cpus} processors, robots and these desks together in one process. Delays are from the robot's
clock; a tick of the desk is {desk_tick:.0f} ms, and one between gateways {tick:.0f} ms.

{first}

One position of a robot costs the gateways {cost_one:.0f} µs of processor time with one gateway and
{cost_four:.0f} µs with {gateways}, each of which tells all positions to a desk of its own: {share:.2f} times
as many positions for each second of a core. {share_goal}

### Emergency stops

From when a desk at the first gateway asks, of {stops} stops each: until each gateway says to a desk of its
own that the stop is in force, and until the last robot has heard. Those desks are told no positions, and are
in a process of their own. *Frozen* is SIGSTOP; what the frozen gateway and its robots hear when it wakes does
not count.

{second}

### What dies

NATS {rounds} times, a gateway once. Robots whose gateway ended go to the next one after up to {jitter:g} s,
and what is new was said after that. Once NATS is back, new is what is no older than while all is well, at
most {fresh:.2f} s: each robot says something once in {period:g} s.

{third}
"""


@dataclass
class Run:
    """What came of a number of gateways: see :mod:`.cluster_crowd` for what is in ``watched``."""

    watched: dict[str, Any]
    cpu: float
    """seconds of processor time that the gateways took while that was watched."""
    megabytes: list[float]
    commands: list[float]
    stops: dict[str, list[dict[str, Any]]]
    recovered: dict[str, list[float]]

    @property
    def microseconds(self) -> float:
        """Of a gateway's processor time for each position."""
        return self.cpu / (ROBOTS * ROBOT_RATE * SECONDS) * 1e6


class Fleet:
    """Gateways with everybody at them, and the servers that they need."""

    def __init__(self, database: DatabaseServer, nats: NatsServer | None, gateways: list[Served]) -> None:
        self._database, self._nats, self._gateways = database, nats, gateways
        addresses = [one.address for one in gateways]
        # With one gateway as many desks as with several.
        addresses *= GATEWAYS if len(addresses) == 1 else 1
        self._crowd = _onlooker(Plan(addresses, ROBOTS, ROBOT_RATE, DESK_RATE))
        self._stopping = _onlooker(Plan(addresses, 0, ROBOT_RATE, 0.0))
        """Desks that make stops and hear of them, in a process that has nothing else to do."""

    def end(self) -> None:
        """Let everybody go."""
        self._stopping.end()
        self._crowd.end()

    def measure(self) -> Run:
        """Measure all that these can show."""
        time.sleep(SETTLE)
        cpu = sum(cpu_seconds(one.process.pid) for one in self._gateways)
        watched = self._ask("watch", seconds=SECONDS)
        cpu = sum(cpu_seconds(one.process.pid) for one in self._gateways) - cpu
        memory = [megabytes_of(one.process.pid) for one in self._gateways]
        commands = self._ask("command", desk=0, robots_of=1, count=COMMANDS)
        stops = {"all is well": [self._stop_while(contextlib.nullcontext()) for _ in range(STOPS)]}
        recovered: dict[str, list[float]] = {}
        if self._nats is not None:
            stops["NATS is dead"] = [self._stop_while(self._without_nats()) for _ in range(STOPS)]
            stops["one other gateway is frozen"] = [
                self._stop_while(self._frozen(OTHERS[-1]), without=[OTHERS[-1]]) for _ in range(STOPS)
            ]
            recovered["NATS killed, and back after some seconds"] = [self._lose_nats() for _ in range(ROUNDS)]
            # Last of those: gateways have to catch up after it.
            stops["PostgreSQL is dead"] = [self._stop_while(self._without_database()) for _ in range(STOPS)]
            self._ask("fresh", since=time.time(), desk=0, homes=list(OTHERS), age=FRESH_S)
            recovered["a gateway killed"] = [self._lose_gateway()]
        return Run(watched, cpu, memory, commands, stops, recovered)

    def _ask(self, what: str, **how: Any) -> Any:
        return _answer(self._crowd, what, **how)

    def _stop_while(
        self, trouble: contextlib.AbstractContextManager[None], without: list[int] | None = None
    ) -> dict[str, Any]:
        others: list[int] = without or []
        with trouble:
            found: dict[str, Any] = _answer(self._stopping, "stop", desk=0, without=others)
            stop, began = found["stop"], found["began"]
            found["robots"] = self._ask("stopped", stop=stop, began=began, without=others)
        _answer(self._stopping, "clear")
        time.sleep(STANDING)
        return found

    @contextmanager
    def _without_nats(self) -> Iterator[None]:
        assert self._nats is not None
        self._nats.kill()
        yield
        self._nats.start()

    @contextmanager
    def _without_database(self) -> Iterator[None]:
        self._database.kill()
        yield
        self._database.start()

    @contextmanager
    def _frozen(self, gateway: int) -> Iterator[None]:
        process = self._gateways[gateway].process
        process.send_signal(signal.SIGSTOP)
        yield
        process.send_signal(signal.SIGCONT)

    def _lose_nats(self) -> float:
        with self._without_nats():
            time.sleep(NATS_AWAY)
        seconds: float = self._ask("fresh", since=time.time(), desk=0, homes=list(OTHERS), age=FRESH_S)
        return seconds

    def _lose_gateway(self) -> float:
        gateway, since = self._gateways[OTHERS[-1]].process, time.time()
        gateway.kill()
        gateway.wait()
        seconds: float = self._ask("heard", since=since, desk=0, homes=[OTHERS[-1]])
        return seconds


def _onlooker(plan: Plan) -> Onlooker:
    one = Onlooker(sys.executable, "-m", "benchmarks.cluster_crowd", json.dumps(asdict(plan)))
    one.line()
    return one


def _answer(onlooker: Onlooker, what: str, **how: Any) -> Any:
    onlooker.tell(do=what, **how)
    return onlooker.line()


def measure(_data: Path) -> Part:
    """Measure one gateway and several."""
    try:
        with PostgreSql(durable=True) as database:
            one = _measured(database, several=False)
            several = _measured(database, several=True)
    except StageError as error:
        sys.exit(f"bench: {error}")
    return report(one, several)


def _measured(database: DatabaseServer, *, several: bool) -> Run:
    url = database.new_database()
    run_once(url, revisions.create)
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        root = Path(folder)
        processes = stack.enter_context(Processes(root / "logs"))
        nats = stack.enter_context(NatsServer(root)) if several else None
        gateways = []
        for number in range(GATEWAYS if several else 1):
            state = root / f"state-{number}"
            state.mkdir()
            options: list[Any] = ["--state", state]
            if nats is not None:
                options += ["--gateway-name", f"g{number}", "--bus", nats.url]
            gateways.append(serve(processes, SITE, url, *options, name=f"gateway-{number}"))
        fleet = Fleet(database, nats, gateways)
        try:
            return fleet.measure()
        finally:
            fleet.end()


def report(one: Run, several: Run) -> Part:
    """Return the part of the page."""
    desk_tick, tick = 1000 / DESK_RATE, POSITION_TICK_S * 1000
    share = one.microseconds / several.microseconds
    across = _percentile(several.watched["elsewhere"], 99)
    more = _percentile(several.commands, 50) - _percentile(one.commands, 50)
    in_force = _percentile([ms for stop in several.stops["all is well"] for ms in stop["gateways"]], 99)
    last = max(stop["robots"] for stops in several.stops.values() for stop in stops)
    died = max(several.recovered["a gateway killed"])
    back = max(several.recovered["NATS killed, and back after some seconds"])
    goals = {
        "across": goal(f"p99 at most {LATEST_MS:.0f} ms", across <= LATEST_MS),
        "commands": goal(f"at most {MORE_MS} ms more", more <= MORE_MS),
        "share": goal(f"at least {SHARE}", share >= SHARE),
        "in force": goal(f"p99 at most {IN_FORCE_MS} ms", in_force <= IN_FORCE_MS),
        "last": goal(f"at most {LAST_MS} ms", last <= LAST_MS),
        "died": goal(f"at most {DIED_S} s", died <= DIED_S),
        "back": goal(f"at most {BACK_S} s", back <= BACK_S),
    }
    first = table(
        ["", "one gateway", f"{GATEWAYS} gateways", ""],
        [
            [
                "position → desk at the same gateway, p50 / p99",
                _both(_all(one)),
                _both(several.watched["here"]),
                "",
            ],
            ["position → desk at another one", "", _both(several.watched["elsewhere"]), goals["across"]],
            [
                "command → robot there, p50 / p99",
                _both(one.commands),
                _both(several.commands),
                goals["commands"],
            ],
            ["memory of a gateway", _megabytes(one), _megabytes(several), ""],
            [
                "the robots' process, cores; most that it was late",
                *(f"{run.watched['own_cpu']:.2f}; {run.watched['late']:.0f} ms" for run in (one, several)),
                "",
            ],
        ],
    )
    rows = [(f"one gateway, {name}", stops) for name, stops in one.stops.items()]
    rows += [(f"{GATEWAYS} gateways, {name}", stops) for name, stops in several.stops.items()]
    second = table(
        ["", "in force at a gateway, p50 / worst", "last robot, p50 / worst"],
        [
            [
                name,
                _worst([ms for stop in stops for ms in stop["gateways"]]),
                _worst([s["robots"] for s in stops]),
            ]
            for name, stops in rows
        ],
    )
    second += f"\n\nIn force: {goals['in force']}. Last robot, also of the worst case: {goals['last']}."
    third = table(
        ["", "seconds until a desk elsewhere knows of all its robots what is new", ""],
        [
            [
                f"NATS killed, back after {NATS_AWAY:g} s: since it is back",
                _seconds(several, "NATS killed, and back after some seconds"),
                goals["back"],
            ],
            ["a gateway killed (SIGKILL)", _seconds(several, "a gateway killed"), goals["died"]],
        ],
    )
    text = TEXT.format(
        **{"gateways": GATEWAYS, "robots": ROBOTS, "robot_rate": ROBOT_RATE, "desk_rate": DESK_RATE},
        **{"cpus": os.cpu_count(), "desk_tick": desk_tick, "tick": tick, "first": first, "second": second},
        **{"third": third, "cost_one": one.microseconds, "cost_four": several.microseconds, "share": share},
        **{
            "share_goal": f"{goals['share'].capitalize()}.",
            "stops": STOPS,
            "rounds": ROUNDS,
            "jitter": JITTER_S,
            "fresh": FRESH_S,
            "period": 1 / ROBOT_RATE,
        },
    )
    return Part("Several gateways", text)


def _all(run: Run) -> list[float]:
    return [*run.watched["here"], *run.watched["elsewhere"]]


def _percentile(values: list[float], share: int) -> float:
    return quantiles(values, n=100, method="inclusive")[share - 1] if len(values) > 1 else values[0]


def _both(values: list[float]) -> str:
    return f"{_percentile(values, 50):.0f} / {_percentile(values, 99):.0f} ms"


def _worst(values: list[float]) -> str:
    return f"{_percentile(values, 50):.0f} / {max(values):.0f} ms"


def _megabytes(run: Run) -> str:
    return f"{max(run.megabytes):.0f} MB"


def _seconds(run: Run, what: str) -> str:
    return ", ".join(f"{seconds:.1f}" for seconds in run.recovered[what])
