"""The part on a large fleet: four gateways, each with what one alone has, and desks with views.

The robots of one fleet speak while those of the others are silent, in turns: the speed of a machine may
change within minutes.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import mean
from typing import Any, NamedTuple

from benchmarks.clock import Spread, spread, table
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
TURNS = size(6, 2)
"""turns of each fleet."""
SECONDS, SETTLE = size(8.0, 2.0), size(5.0, 2.0)
"""seconds of a turn that are watched, and those before, in which all have just begun to speak."""
STOPS, WELL_STOPS = size(3, 1), size(30, 1)
"""emergency stops while something is dead or frozen, of each kind, and while all is well."""
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
robots each on WebSockets, {all_robots} in all; and beside them, in the same run, {gateways} gateways that
each serve a fleet of their own on PostgreSQL with {robots}: those of one of the others, at the same places.
Robots say where they are {rate:g} times a
second. Each gateway has two desks at {desk_rate:g} Hz, as the panel in QGIS asks: one shows {near} robots, of
all gateways of its fleet, and one the whole site, as a density. All of it is on this machine's {cpus}
processors, the robots of each gateway and the desks of each fleet in processes of their own. The robots of
one gateway with a fleet of its own, of all four of those, and of the one fleet speak in turns, {turns} times
for {seconds:g} s. Delays are from the moment at which a robot was to speak; a tick of the desk is
{desk_tick:.0f} ms, and one between gateways {tick:.0f} ms.

{rows}

A position at a desk of another gateway: {across_goal}.

Four gateways of one fleet take in {share:.2f} times as many positions for each second of a core as one does
with a quarter of the robots, by turn. {share_goal} Four that share nothing but the machine take in
{apart:.2f} times as many as one of them by itself.

### Emergency stops of many robots

From when a desk at the first gateway asks, of {well_stops} stops while all is well and {stops} of each other
kind: until the stop is in force at each gateway, which a desk or a robot of it has heard then, and until the
last of {stopped} robots has heard, which go on saying where they are. What came of one stop is stored before
the next. *Frozen* is SIGSTOP; the frozen gateway and its robots do not count.

{rows_of_stops}

In force, while all is well: {in_force_goal}. Last robot, also of the worst case: {last_goal}.
"""


@dataclass
class Run:
    """What came of a fleet in a turn: delays in ms; ``cpu`` and ``bus`` are seconds of processor time."""

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


class Turns(NamedTuple):
    """Runs of one gateway, of all those that each have a fleet of their own, and of those of one fleet."""

    one: list[Run]
    apart: list[list[Run]]
    several: list[Run]

    def share(self) -> Spread:
        """Return how many times as many positions the gateways of one fleet take in for each second."""
        return spread(a.microseconds / b.microseconds for a, b in zip(self.one, self.several, strict=True))

    def share_apart(self) -> Spread:
        """Return the same of gateways that each have a fleet of their own."""
        costs = [mean(run.microseconds for run in runs) for runs in self.apart]
        return spread(a.microseconds / cost for a, cost in zip(self.one, costs, strict=True))


class Stop(NamedTuple):
    """Milliseconds until a stop was in force at each gateway, and until the last robot heard of it."""

    in_force: list[float]
    last: float


def measure(_data: Path) -> Part:
    """Measure one gateway and several."""
    try:
        with PostgreSql(durable=True) as database:
            return report(_turns(database), _stopped(database))
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
    """Gateways, each with ``robots`` of its own, which go on at another one where they ``follow``.

    The robots of gateway n are each ``stride``-th, ``count``-th without one, from ``first`` + n on.
    """

    def __init__(
        self,
        database: PostgreSql,
        count: int,
        robots: int,
        *,
        first: int = 0,
        stride: int = 0,
        follow: bool = False,
    ) -> None:
        self._robots, self._first, self._stride, self._follow = robots, first, stride or count, follow
        super().__init__(database, count, 2 * count * robots)

    def start(self, count: int, room: int) -> None:
        """Start the gateways, and their robots; return when every robot has its map."""
        super().start(count, room)
        plan = {"host": "127.0.0.1", "robots": self._robots, "stride": self._stride}
        others = self.addresses if self._follow else []
        self.crowds = [
            self.begin(
                "benchmarks.cluster_swarm",
                {**plan, "port": one.port, "first": self._first + number, "gateways": [one.address, *others]},
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
        return Drive(begin, {"crowds": self._stride, "robots": self._robots, "rate": rate, "begin": wall})

    def wait_until_calm(self) -> None:
        """Wait until the gateways have stored what came of a stop."""
        until = time.monotonic() + CALM_WITHIN
        while time.monotonic() < until:
            cpu = self.cpu_seconds()
            time.sleep(1.0)
            if self.cpu_seconds() - cpu < BUSY:
                return


class WatchedFleet:
    """A fleet with desks, whose robots speak when it is their turn."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        plan = Onlookers(fleet.addresses, _subscriptions(len(fleet.addresses)))
        self._desks = fleet.begin("benchmarks.cluster_onlookers", asdict(plan))
        self._desks.line()

    def begin(self) -> Drive:
        """Have its robots speak for a turn."""
        drive = self._fleet.drive(0.5, SETTLE + SECONDS, RATE, SETTLE)
        begin = drive.schedule["begin"] + SETTLE
        self._desks.tell(schedule=drive.schedule, begin=begin, seconds=SECONDS)
        return drive

    def used(self) -> tuple[float, float]:
        """Return the processor time that its gateways have used, and its bus."""
        return self._fleet.cpu_seconds(), _of_the_bus(self._fleet)

    def run(self, before: tuple[float, float], now: tuple[float, float]) -> Run:
        """Return what came of a turn, in which so much was used."""
        sent, seen = [crowd.line() for crowd in self._fleet.crowds], self._desks.line()
        return Run(
            seen["here"],
            seen["elsewhere"],
            round(len(self._fleet.gateways) * ROBOTS * RATE * SECONDS),
            now[0] - before[0],
            now[1] - before[1],
            self._fleet.megabytes(),
            max(one["late"] for one in sent),
        )


def _turns(database: PostgreSql) -> Turns:
    with ExitStack() as stack:
        apart = [
            WatchedFleet(stack.enter_context(Fleet(database, 1, ROBOTS, first=quarter, stride=GATEWAYS)))
            for quarter in range(GATEWAYS)
        ]
        several = WatchedFleet(stack.enter_context(Fleet(database, GATEWAYS, ROBOTS)))
        turns = Turns([], [], [])
        for number in range(TURNS):
            turns.one.extend(_turn([apart[number % GATEWAYS]]))
            turns.apart.append(_turn(apart))
            turns.several.extend(_turn([several]))
        return turns


def _turn(fleets: Sequence[WatchedFleet]) -> list[Run]:
    """Have the robots of fleets speak, all at the same time; return what came of each fleet."""
    drive = [fleet.begin() for fleet in fleets][-1]
    drive.wait(SETTLE)
    before = [fleet.used() for fleet in fleets]
    drive.wait(SETTLE + SECONDS)
    now = [fleet.used() for fleet in fleets]
    return [fleet.run(*used) for fleet, *used in zip(fleets, before, now, strict=True)]


def _of_the_bus(fleet: Fleet) -> float:
    """Return the processor time that the NATS server has used, where there is one."""
    return 0.0 if fleet.nats is None else cpu_seconds(fleet.nats.pid)


def _subscriptions(count: int) -> list[dict[str, Any]]:
    """Return what the desks ask for: at each of ``count`` gateways robots one by one, and a density.

    Where one gateway has a quarter of the robots, a view of as many of them is larger.
    """
    rows = NEAR // ROW + 1
    columns = NEAR // rows
    rows *= GATEWAYS // count
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
        # Robots have just got their maps.
        fleet.wait_until_calm()
        cases: dict[str, tuple[Callable[[], AbstractContextManager[None]], list[int]]] = {
            "all is well": (nullcontext, []),
            "NATS is dead": (fleet.without_nats, []),
            "one other gateway is frozen": (lambda: fleet.frozen(others[-1]), others[-1:]),
            "PostgreSQL is dead": (fleet.without_database, []),
        }
        return {
            name: [
                _stop(fleet, desks, trouble, without)
                for _ in range(WELL_STOPS if trouble is nullcontext else STOPS)
            ]
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
        last, in_force = made["began"], []
        by_desks = iter(made["gateways"])
        for number, crowd in enumerate(fleet.crowds):
            if number not in without:
                crowd.tell(stop=made["stop"])
                found = crowd.line()
                if found["heard"] < ROBOTS:
                    missed = ROBOTS - found["heard"]
                    raise RuntimeError(f"{missed} robots of gateway {number} did not hear of {made['stop']}")
                last = max(last, found["last"])
                in_force.append(min(next(by_desks), (found["first"] - made["began"]) * 1e3))
    desks.tell(do="clear")
    desks.line()
    time.sleep(STANDING)
    fleet.wait_until_calm()
    return Stop(in_force, (last - made["began"]) * 1e3)


def report(turns: Turns, stops: dict[str, list[Stop]]) -> Part:
    """Return the part of the page."""
    kinds = turns.one, [run for runs in turns.apart for run in runs], turns.several
    share = turns.share()
    several = turns.several
    across = [ms for run in several for ms in run.elsewhere]
    rows = table(
        ["", "one gateway", f"{GATEWAYS} gateways of {GATEWAYS} fleets", f"{GATEWAYS} gateways of one fleet"],
        [
            ["robots", ROBOTS, GATEWAYS * ROBOTS, GATEWAYS * ROBOTS],
            [
                "processor time of gateways for a position, µs",
                *(f"{spread(run.microseconds for run in runs):.0f}" for runs in kinds),
            ],
            ["... of the NATS server", "", "", f"{mean(run.bus / run.sent * 1e6 for run in several):.1f}"],
            [
                "position → desk at the same gateway, p50 / p99",
                *(median_and_p99([ms for run in runs for ms in run.here]) for runs in kinds),
            ],
            ["position → desk at another one", "", "", median_and_p99(across)],
            [
                "memory of a gateway, MB",
                *(f"{max(mb for run in runs for mb in run.megabytes):.0f}" for runs in kinds),
            ],
            ["most that a robot was late, ms", *(f"{max(run.late for run in runs):.0f}" for runs in kinds)],
        ],
    )
    in_force = [ms for stop in stops["all is well"] for ms in stop.in_force]
    last = max(stop.last for some in stops.values() for stop in some)
    stopped = table(
        ["", "in force at a gateway, p50 / p99", "worst", "last robot, p50 / worst"],
        [
            [
                name,
                median_and_p99(times := [ms for stop in some for ms in stop.in_force]),
                f"{max(times):.0f} ms",
                median_and_worst([s.last for s in some]),
            ]
            for name, some in stops.items()
        ],
    )
    text = TEXT.format(
        **{"gateways": GATEWAYS, "robots": ROBOTS, "all_robots": GATEWAYS * ROBOTS, "rate": RATE},
        **{"desk_rate": DESK_RATE, "near": NEAR, "cpus": os.cpu_count(), "desk_tick": 1000 / DESK_RATE},
        **{"tick": POSITION_TICK_S * 1000, "rows": rows, "turns": TURNS, "seconds": SECONDS},
        **{"share": share, "apart": turns.share_apart()},
        across_goal=goal(f"p99 at most {LATEST_MS:.0f} ms", percentile(across, 99) <= LATEST_MS),
        **{"stops": STOPS, "well_stops": WELL_STOPS, "stopped": GATEWAYS * ROBOTS, "rows_of_stops": stopped},
        in_force_goal=goal(f"p99 at most {IN_FORCE_MS} ms", percentile(in_force, 99) <= IN_FORCE_MS),
        last_goal=goal(f"at most {LAST_MS} ms", last <= LAST_MS),
        share_goal=f"{goal(f'at least {SHARE}', share.median >= SHARE).capitalize()}.",
    )
    return Part("Several gateways and a large fleet", text)
