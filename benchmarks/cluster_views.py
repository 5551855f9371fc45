"""The part on 100 000 robots over four gateways, simulated: what the bus costs, and desks with views."""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.clock import Spread, in_a_process, table
from benchmarks.page import Part, goal
from benchmarks.simulated_gateway import Plan
from benchmarks.swarm import Onlooker, cpu_seconds, megabytes_of
from benchmarks.trial import size
from robot_bridge.gateway.cluster.robot_relay import POSITION_TICK_S
from tests.support.errors import StageError
from tests.support.nats_server import NatsServer

GATEWAYS = 4
ROBOTS = size(25_000, 500)
"""of a gateway; each says where it is once a second."""
DESKS, RATE = 10, 10.0
"""of a gateway, and frames a second, as the panel in QGIS asks."""
SIDE, NEAR = 10_000.0, 800.0
"""metres of the site, and of a view that shows robots one by one."""
DENSE = 20_000
"""robots of which a desk that sees all of them is told a density."""
SETTLE, SECONDS = size(8.0, 2.0), size(20.0, 2.0)
BUS_PERCENT, DESK_MS = 5.0, 9.0
"""of a core for 25 000 positions a second, and of the window's thread for an update."""
SHARE = 25_000

TEXT = """\
{robots} robots of {gateways} gateways, at random places of {side} × {side} m, say where they are once a
second; each gateway has {desks} desks with views at {rate:g} Hz, of which half show {near} × {near} m, with
{seen:.0f} robots, and half the whole site as a density. Robots and desks are simulated: they speak and hear
in the gateway's process, without sockets and database. What goes over the bus, and how frames are made, is
the product's own, and NATS is a real server. Each row is of {seconds:g} s.

{rows}

The bus costs what gateways with it and without desks take more than without it, and its server: {bus:.1f} %
of a core for {share} positions a second, each of which goes to {others} other gateways within {tick:.0f} ms
({bus_goal}).

The window of a desk in QGIS that shows the whole site, with {count} robots as a density over an orthophoto
and roads, takes {desk} ms of its thread for an update that comes {rate:g} times a second: frame taken in,
prepared, painted ({desk_goal}). Its process has {megabytes:.0f} MB.
"""


@dataclass(frozen=True)
class Run:
    """What came of it: cores that each gateway and the server took, megabytes, and the most seconds late."""

    gateways: list[float]
    server: float
    megabytes: list[float]
    server_megabytes: float
    late: float
    frames: float
    frame_bytes: float


def measure(data: Path) -> Part:
    """Measure on robots that are made up."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    try:
        alone = _measured(bus=False, desks=0)
        shared = _measured(bus=True, desks=0)
        watched = _measured(bus=True, desks=DESKS)
    except StageError as error:
        sys.exit(f"bench: {error}")
    number = max(GATEWAYS * ROBOTS, DENSE)
    seen = in_a_process(f"from benchmarks.desk_canvas import density\ndensity({str(data)!r}, {number})")
    return report(alone, shared, watched, seen)


def _measured(*, bus: bool, desks: int) -> Run:
    with ExitStack() as stack:
        root = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="fleet-views-")))
        nats = stack.enter_context(NatsServer(root)) if bus else None
        gateways = []
        for number in range(GATEWAYS):
            plan = Plan(number, ROBOTS, SIDE, "" if nats is None else nats.url, desks, RATE, NEAR)
            command = [sys.executable, "-m", "benchmarks.simulated_gateway", json.dumps(asdict(plan))]
            gateways.append(Onlooker(*command))
            stack.callback(gateways[-1].end)
        for one in gateways:
            one.line()
        time.sleep(SETTLE)
        cpu = 0.0 if nats is None else cpu_seconds(nats.pid)
        for one in gateways:
            one.tell(seconds=SECONDS)
        found = [one.line() for one in gateways]
        wanted = GATEWAYS * ROBOTS if bus else ROBOTS
        if any(one["known"] != wanted for one in found):
            raise StageError(f"gateways know of {[one['known'] for one in found]} robots of {wanted}")
        frames = sum(one["frames"] for one in found)
        return Run(
            [one["cpu"] / SECONDS for one in found],
            0.0 if nats is None else (cpu_seconds(nats.pid) - cpu) / SECONDS,
            [megabytes_of(one.pid) for one in gateways],
            0.0 if nats is None else megabytes_of(nats.pid),
            max(one["late"] for one in found),
            frames / SECONDS,
            sum(one["bytes"] for one in found) / max(frames, 1),
        )


def report(alone: Run, shared: Run, watched: Run, desk: dict[str, Any]) -> Part:
    """Return the part of the page."""
    more = sum(shared.gateways) - sum(alone.gateways) + shared.server
    bus = 100 * more / (GATEWAYS * ROBOTS) * SHARE
    update = Spread(*desk["ms"])
    names = {"no bus, no desks": alone, "NATS, no desks": shared, f"NATS, {GATEWAYS * DESKS} desks": watched}
    rows = table(
        [
            "",
            "gateways, cores each",
            "NATS, cores",
            "a gateway, MB",
            "NATS, MB",
            "frames/s",
            "a frame, kB",
            "robots late, ms",
        ],
        [
            [
                name,
                f"{min(one.gateways):.2f}–{max(one.gateways):.2f}",
                f"{one.server:.3f}" if one.server else "",
                f"{max(one.megabytes):.0f}",
                f"{one.server_megabytes:.0f}" if one.server else "",
                f"{one.frames:.0f}" if one.frames else "",
                f"{one.frame_bytes / 1000:.1f}" if one.frames else "",
                f"{1000 * one.late:.0f}",
            ]
            for name, one in names.items()
        ],
    )
    text = TEXT.format(
        **{"robots": GATEWAYS * ROBOTS, "gateways": GATEWAYS, "side": round(SIDE), "desks": DESKS},
        **{"rate": RATE, "near": round(NEAR), "seconds": SECONDS, "rows": rows, "bus": bus, "share": SHARE},
        **{"others": GATEWAYS - 1, "tick": POSITION_TICK_S * 1000},
        seen=GATEWAYS * ROBOTS * (NEAR / SIDE) ** 2,
        bus_goal=goal(f"at most {BUS_PERCENT:g} %", bus <= BUS_PERCENT),
        **{"count": GATEWAYS * ROBOTS, "desk": f"{update:.1f}", "megabytes": desk["megabytes"]},
        desk_goal=goal(f"at most {DESK_MS:g} ms", update.median <= DESK_MS),
    )
    return Part("100 000 robots over several gateways", text)
