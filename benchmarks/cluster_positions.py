"""The part on a large fleet: four gateways, each with what one alone has, and desks with views."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.clock import table
from benchmarks.cluster_crowd import Plan as Desks
from benchmarks.cluster_gateways import Gateways, median_and_p99, median_and_worst, percentile
from benchmarks.cluster_onlookers import Plan as Onlookers
from benchmarks.cluster_swarm import APART, ROW, home
from benchmarks.page import Part, goal
from benchmarks.swarm import Onlooker, cpu_seconds
from benchmarks.trial import size
from robot_bridge.gateway.cluster.robot_relay import POSITION_TICK_S
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError

GATEWAYS = 4
ROBOTS, RATE = size(1250, 50), 1.0
"""robots of a gateway, and how often each says where it is in a second."""
NEAR, DESK_RATE = size(500, 20), 10.0
"""robots in a view that shows them one by one, and frames a second."""
SECONDS, SETTLE = size(20.0, 3.0), size(15.0, 2.0)
"""seconds that are watched, and those before, in which everybody has just come."""
STOPS = size(3, 1)
"""emergency stops of each kind."""
BUSY, CALM_WITHIN = 1.0, size(60.0, 5.0)
"""cores that all gateways take at most when what came of a stop is stored, and seconds until then at most."""
WHILE_STOPPED, STANDING = size(3.0, 1.5), size(1.0, 0.2)
"""seconds for which robots go on speaking about a stop, and between a stop and the next one."""
TROUBLE = 0.3
"""seconds for which something is dead or frozen before a stop, and all in all less than a lease lasts."""
SHARE, ACROSS_MS, IN_FORCE_MS, LAST_MS = 0.9, 50, 50, 500
"""What is to be kept to: see :func:`report`."""
LATEST_MS = 1000 / DESK_RATE + POSITION_TICK_S * 1000 + ACROSS_MS
"""milliseconds in which a position is to be at a desk elsewhere."""

TEXT = """\
{gateways} gateways of one fleet on PostgreSQL, which waits for its disk, and one NATS server, with {robots}
robots each on WebSockets, {all_robots} in all; and beside them, in the same run, one gateway alone on
PostgreSQL with {robots}. Robots say where they are {rate:g} times a second. Each gateway has two desks at
{desk_rate:g} Hz, as the panel in QGIS asks: one shows {near} robots, of all gateways, and one the whole site,
as a density. All of it is on this machine's {cpus} processors, the robots of each gateway and all desks in
processes of their own. Delays are from the moment at which a robot was to speak; a tick of the desk is
{desk_tick:.0f} ms, and one between gateways {tick:.0f} ms.

{rows}

Four gateways take in {share:.2f} times as many positions for each second of a core as one does with a quarter
of the robots. {share_goal}

### Emergency stops of many robots

From when a desk at the first gateway asks, of {stops} stops each: until each gateway says to a desk of its
own that the stop is in force, and until the last of {stopped} robots has heard, which go on saying where they
are. What came of one stop is stored before the next. *Frozen* is SIGSTOP; the frozen gateway and its robots
do not count.

{rows_of_stops}

In force, while all is well: {in_force_goal}. Last robot, also of the worst case: {last_goal}.
"""


@dataclass
class Run:
    """What came of a number of gateways: delays in ms; ``cpu`` and ``bus`` are seconds of processor time."""

    here: list[float]
    elsewhere: list[float]
    sent: int
    cpu: float
    bus: float
    megabytes: list[float]
    late: float

    @property
    def microseconds(self) -> float:
        """Of the gateways' processor time for each position."""
        return self.cpu / self.sent * 1e6


class Stop(NamedTuple):
    """Milliseconds until a stop was in force at each gateway, and until the last robot heard of it."""

    in_force: list[float]
    last: float


def measure(_data: Path) -> Part:
    """Measure one gateway and several."""
    try:
        with PostgreSql(durable=True) as database:
            one, several = (_watched(database, count) for count in (1, GATEWAYS))
            return report(one, several, _stopped(database))
    except StageError as error:
        sys.exit(f"bench: {error}")


class Drive(NamedTuple):
    """When robots begin to say where they are, by the steady clock, and their ``schedule`` for desks."""

    begin: float
    schedule: dict[str, Any]

    def wait(self, seconds: float) -> None:
        """Return ``seconds`` after the beginning; at once where that is over."""
        time.sleep(max(0.0, self.begin + seconds - time.monotonic()))


class Fleet(Gateways):
    """Gateways, each with ``robots`` of its own, which go on at another one where they ``follow``."""

    def __init__(self, database: PostgreSql, count: int, robots: int, *, follow: bool = False) -> None:
        self._robots, self._follow = robots, follow
        super().__init__(database, count, 2 * count * robots)

    def start(self, count: int, room: int) -> None:
        """Start the gateways, and their robots; return when every robot has its map."""
        super().start(count, room)
        plan = {"host": "127.0.0.1", "robots": self._robots, "stride": count}
        others = self.addresses if self._follow else []
        self.crowds = [
            self.begin(
                "benchmarks.cluster_swarm",
                {**plan, "port": one.port, "first": number, "gateways": [one.address, *others]},
            )
            for number, one in enumerate(self.gateways)
        ]
        for crowd in self.crowds:
            crowd.line()

    def drive(self, after: float, seconds: float, rate: float, measured: float = 0.0) -> Drive:
        """Have all robots say where they are ``rate`` times a second, in ``after`` seconds and for so many;
        what counts is from ``measured`` on."""
        begin = time.monotonic() + after
        for crowd in self.crowds:
            crowd.tell(begin=begin, seconds=seconds, rate=rate, measured=measured)
        wall = time.time() + begin - time.monotonic()
        return Drive(begin, {"crowds": len(self.crowds), "robots": self._robots, "rate": rate, "begin": wall})

    def wait_until_calm(self) -> None:
        """Wait until the gateways have stored what came of a stop."""
        until = time.monotonic() + CALM_WITHIN
        while time.monotonic() < until:
            cpu = self.cpu_seconds()
            time.sleep(1.0)
            if self.cpu_seconds() - cpu < BUSY:
                return


def _watched(database: PostgreSql, count: int) -> Run:
    with Fleet(database, count, ROBOTS) as fleet:
        plan = Onlookers(fleet.addresses, _subscriptions(count))
        desks = fleet.begin("benchmarks.cluster_onlookers", asdict(plan))
        desks.line()
        drive = fleet.drive(0.5, SETTLE + SECONDS, RATE, SETTLE)
        desks.tell(schedule=drive.schedule, begin=drive.schedule["begin"] + SETTLE, seconds=SECONDS)
        drive.wait(SETTLE)
        before = fleet.cpu_seconds(), _of_the_bus(fleet)
        drive.wait(SETTLE + SECONDS)
        now = fleet.cpu_seconds(), _of_the_bus(fleet)
        sent, seen = [crowd.line() for crowd in fleet.crowds], desks.line()
        return Run(
            seen["here"],
            seen["elsewhere"],
            round(count * ROBOTS * RATE * SECONDS),
            now[0] - before[0],
            now[1] - before[1],
            fleet.megabytes(),
            max(one["late"] for one in sent),
        )


def _of_the_bus(fleet: Fleet) -> float:
    """Return the processor time that the NATS server has used, where there is one."""
    return 0.0 if fleet.nats is None else cpu_seconds(fleet.nats.pid)


def _subscriptions(count: int) -> list[dict[str, Any]]:
    """Return what the desks ask for: at each of ``count`` gateways robots one by one, and a density."""
    rows = NEAR // ROW + 1
    columns = NEAR // rows
    found = []
    for number in range(count):
        x, y = home(number * rows * ROW)
        half = APART / 2
        near = [x - half, y - half, x + columns * APART - half, y + rows * APART - half]
        for bounds, most in ((near, 5000), ([0.0, 0.0, 1e4, 1e4], 1)):
            view = {"bounds": bounds, "most": most}
            found.append({"rate": DESK_RATE, "form": "columns", "view": view})
    # Dealt out to the gateways in turns: the first half shows robots, the other one densities.
    return found[::2] + found[1::2]


def _stopped(database: PostgreSql) -> dict[str, list[Stop]]:
    """Return what came of emergency stops, by what was dead or frozen."""
    others = list(range(1, GATEWAYS))
    with Fleet(database, GATEWAYS, ROBOTS) as fleet:
        desks = fleet.begin("benchmarks.cluster_crowd", asdict(Desks(fleet.addresses, 0, RATE, 0.0)))
        desks.line()
        cases: dict[str, tuple[Callable[[], AbstractContextManager[None]], list[int]]] = {
            "all is well": (nullcontext, []),
            "NATS is dead": (fleet.without_nats, []),
            "one other gateway is frozen": (lambda: fleet.frozen(others[-1]), others[-1:]),
            "PostgreSQL is dead": (fleet.without_database, []),
        }
        return {
            name: [_stop(fleet, desks, trouble, without) for _ in range(STOPS)]
            for name, (trouble, without) in cases.items()
        }


def _stop(
    fleet: Fleet, desks: Onlooker, trouble: Callable[[], AbstractContextManager[None]], without: list[int]
) -> Stop:
    drive = fleet.drive(0.2, WHILE_STOPPED, RATE)
    # Robots speak for a third of the time before the stop; trouble begins late in it, since a gateway that is
    # frozen for longer than its lease loses its robots.
    drive.wait(WHILE_STOPPED / 3 - TROUBLE)
    with trouble():
        time.sleep(TROUBLE)
        desks.tell(do="stop", desk=0, without=without)
        made = desks.line()
        for crowd in fleet.crowds:
            crowd.line()
        last = made["began"]
        for number, crowd in enumerate(fleet.crowds):
            if number not in without:
                crowd.tell(stop=made["stop"])
                found = crowd.line()
                if found["heard"] < ROBOTS:
                    missed = ROBOTS - found["heard"]
                    raise RuntimeError(f"{missed} robots of gateway {number} did not hear of {made['stop']}")
                last = max(last, found["last"])
    desks.tell(do="clear")
    desks.line()
    time.sleep(STANDING)
    fleet.wait_until_calm()
    return Stop(made["gateways"], (last - made["began"]) * 1e3)


def report(one: Run, several: Run, stops: dict[str, list[Stop]]) -> Part:
    """Return the part of the page."""
    share = one.microseconds / several.microseconds
    across = percentile(several.elsewhere, 99)
    rows = table(
        ["", "one gateway", f"{GATEWAYS} gateways", ""],
        [
            ["robots", ROBOTS, GATEWAYS * ROBOTS, ""],
            [
                "processor time of gateways for a position",
                f"{one.microseconds:.0f} µs",
                f"{several.microseconds:.0f} µs",
                "",
            ],
            ["... of the NATS server", "", f"{several.bus / several.sent * 1e6:.1f} µs", ""],
            [
                "position → desk at the same gateway, p50 / p99",
                median_and_p99(one.here),
                median_and_p99(several.here),
                "",
            ],
            [
                "position → desk at another one",
                "",
                median_and_p99(several.elsewhere),
                goal(f"p99 at most {LATEST_MS:.0f} ms", across <= LATEST_MS),
            ],
            ["memory of a gateway", f"{max(one.megabytes):.0f} MB", f"{max(several.megabytes):.0f} MB", ""],
            ["most that a robot was late", f"{one.late:.0f} ms", f"{several.late:.0f} ms", ""],
        ],
    )
    in_force = [ms for stop in stops["all is well"] for ms in stop.in_force]
    last = max(stop.last for some in stops.values() for stop in some)
    stopped = table(
        ["", "in force at a gateway, p50 / worst", "last robot, p50 / worst"],
        [
            [
                name,
                median_and_worst([ms for stop in some for ms in stop.in_force]),
                median_and_worst([s.last for s in some]),
            ]
            for name, some in stops.items()
        ],
    )
    text = TEXT.format(
        **{"gateways": GATEWAYS, "robots": ROBOTS, "all_robots": GATEWAYS * ROBOTS, "rate": RATE},
        **{"desk_rate": DESK_RATE, "near": NEAR, "cpus": os.cpu_count(), "desk_tick": 1000 / DESK_RATE},
        **{"tick": POSITION_TICK_S * 1000, "rows": rows, "share": share},
        **{"stops": STOPS, "stopped": GATEWAYS * ROBOTS, "rows_of_stops": stopped},
        in_force_goal=goal(f"p99 at most {IN_FORCE_MS} ms", percentile(in_force, 99) <= IN_FORCE_MS),
        last_goal=goal(f"at most {LAST_MS} ms", last <= LAST_MS),
        share_goal=f"{goal(f'at least {SHARE}', share >= SHARE).capitalize()}.",
    )
    return Part("Several gateways and a large fleet", text)
