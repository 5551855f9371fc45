"""The part on several gateways: four beside one, commands and stops across, and what dies."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.clock import table
from benchmarks.cluster_crowd import JITTER_S, Plan
from benchmarks.cluster_gateways import Gateways, median_and_p99, median_and_worst, percentile
from benchmarks.page import Part, goal
from benchmarks.swarm import Onlooker
from benchmarks.trial import size
from robot_bridge.gateway.cluster.robot_relay import POSITION_TICK_S
from tests.support.databases.database_server import DatabaseServer
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError

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
    """Gateways with everybody at them."""

    def __init__(self, gateways: Gateways) -> None:
        self._gateways = gateways
        # With one gateway as many desks as with several.
        addresses = gateways.addresses * (GATEWAYS if len(gateways.addresses) == 1 else 1)
        self._crowd = self._begin(Plan(addresses, ROBOTS, ROBOT_RATE, DESK_RATE))
        self._stopping = self._begin(Plan(addresses, 0, ROBOT_RATE, 0.0))
        """Desks that make stops and hear of them, in a process that has nothing else to do."""

    def measure(self) -> Run:
        """Measure all that these can show."""
        time.sleep(SETTLE)
        cpu = self._gateways.cpu_seconds()
        watched = self._ask("watch", seconds=SECONDS)
        cpu = self._gateways.cpu_seconds() - cpu
        memory = self._gateways.megabytes()
        commands = self._ask("command", desk=0, robots_of=1, count=COMMANDS)
        stops = {"all is well": [self._stop_while(contextlib.nullcontext()) for _ in range(STOPS)]}
        recovered: dict[str, list[float]] = {}
        if self._gateways.nats is not None:
            stops["NATS is dead"] = [self._stop_while(self._gateways.without_nats()) for _ in range(STOPS)]
            stops["one other gateway is frozen"] = [
                self._stop_while(self._gateways.frozen(OTHERS[-1]), without=[OTHERS[-1]])
                for _ in range(STOPS)
            ]
            recovered["NATS killed, and back after some seconds"] = [self._lose_nats() for _ in range(ROUNDS)]
            # Last of those: gateways have to catch up after it.
            stops["PostgreSQL is dead"] = [
                self._stop_while(self._gateways.without_database()) for _ in range(STOPS)
            ]
            self._ask("fresh", since=time.time(), desk=0, homes=list(OTHERS), age=FRESH_S)
            recovered["a gateway killed"] = [self._lose_gateway()]
        return Run(watched, cpu, memory, commands, stops, recovered)

    def _begin(self, plan: Plan) -> Onlooker:
        one = self._gateways.begin("benchmarks.cluster_crowd", asdict(plan))
        one.line()
        return one

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

    def _lose_nats(self) -> float:
        with self._gateways.without_nats():
            time.sleep(NATS_AWAY)
        seconds: float = self._ask("fresh", since=time.time(), desk=0, homes=list(OTHERS), age=FRESH_S)
        return seconds

    def _lose_gateway(self) -> float:
        since = time.time()
        self._gateways.kill(OTHERS[-1])
        seconds: float = self._ask("heard", since=since, desk=0, homes=[OTHERS[-1]])
        return seconds


def _answer(onlooker: Onlooker, what: str, **how: Any) -> Any:
    onlooker.tell(do=what, **how)
    return onlooker.line()


def measure(_data: Path) -> Part:
    """Measure one gateway and several."""
    try:
        with PostgreSql(durable=True) as database:
            one, several = (_measured(database, count) for count in (1, GATEWAYS))
    except StageError as error:
        sys.exit(f"bench: {error}")
    return report(one, several)


def _measured(database: DatabaseServer, count: int) -> Run:
    with Gateways(database, count) as gateways:
        return Fleet(gateways).measure()


def report(one: Run, several: Run) -> Part:
    """Return the part of the page."""
    desk_tick, tick = 1000 / DESK_RATE, POSITION_TICK_S * 1000
    share = one.microseconds / several.microseconds
    across = percentile(several.watched["elsewhere"], 99)
    more = percentile(several.commands, 50) - percentile(one.commands, 50)
    in_force = percentile([ms for stop in several.stops["all is well"] for ms in stop["gateways"]], 99)
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
                median_and_p99(_all(one)),
                median_and_p99(several.watched["here"]),
                "",
            ],
            [
                "position → desk at another one",
                "",
                median_and_p99(several.watched["elsewhere"]),
                goals["across"],
            ],
            [
                "command → robot there, p50 / p99",
                median_and_p99(one.commands),
                median_and_p99(several.commands),
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
                median_and_worst([ms for stop in stops for ms in stop["gateways"]]),
                median_and_worst([s["robots"] for s in stops]),
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


def _megabytes(run: Run) -> str:
    return f"{max(run.megabytes):.0f} MB"


def _seconds(run: Run, what: str) -> str:
    return ", ".join(f"{seconds:.1f}" for seconds in run.recovered[what])
