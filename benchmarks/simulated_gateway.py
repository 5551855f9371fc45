"""A gateway of a large fleet without its sockets: ``python simulated_gateway.py PLAN``.

Its robots, what goes over the bus, and what desks with views are sent are the product's own; robots speak,
and desks hear, in this process. It prints ``ready``, and for each line that says how many ``seconds`` are to
be watched what came of that.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from robot_bridge.core.clock import SYSTEM_CLOCK
from robot_bridge.core.messages.positions import PositionForm, View
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.cluster.bus import Bus, NoBus
from robot_bridge.gateway.cluster.messages import Exchange
from robot_bridge.gateway.cluster.nats_bus import NatsBus
from robot_bridge.gateway.cluster.robot_relay import DetailRelay, PositionRelay
from robot_bridge.gateway.fleet.views import FleetViews, ViewWatch
from robot_bridge.gateway.model.position_checks import AcceptedArea
from robot_bridge.gateway.model.robots import RobotPose, Robots
from tests.support.processes import leave_on_signals

NAMES = ("x", "y", "theta", "v", "battery", "status")
TURN_S, AGE_S = 0.05, 0.5
"""seconds between two robots' turns to speak, and between two looks at who has fallen silent."""
LINK = "link:crowd"


@dataclass(frozen=True)
class Plan:
    """``robots`` of gateway ``number``, each of which says something once a second, over a site of ``side``
    metres; a NATS server's ``url``, or none; ``desks`` of which every second sees the whole site, at ``rate``
    Hz, and the others ``near`` metres of it."""

    number: int
    robots: int
    side: float
    url: str
    desks: int
    rate: float
    near: float


class Gateway:
    """All of it."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.robots = Robots()
        site: Any = SimpleNamespace(report=SimpleNamespace(bounds=(0.0, 0.0, plan.side, plan.side)))
        self._views = FleetViews(self.robots, site, SYSTEM_CLOCK)
        name = f"g{plan.number}"
        bus: Bus = NatsBus([plan.url], name, "fleet.large") if plan.url else NoBus()
        self._exchange = Exchange(name, b"k" * 32, [bus])
        membership: Any = SimpleNamespace(database_time=time.time, clock_offset=0.0)
        relays = PositionRelay, DetailRelay
        self._relays = [relay(self.robots, membership, self._exchange) for relay in relays]
        self._places = (
            np.random.default_rng(plan.number).uniform(0, plan.side - 1.0, (plan.robots, 2)).tolist()
        )
        self._names = [f"robot-{plan.number}-{number:05}" for number in range(plan.robots)]
        self._steps = 0
        self.late, self.frames, self.bytes = 0.0, 0, 0
        for number, robot in enumerate(self._names):
            self.robots.ready(robot, number, LINK, time.time())
            self.robots.observe(robot, self._pose(number), LINK, time.time())

    async def run(self) -> None:
        """Go on until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._exchange.run())
            for relay in self._relays:
                group.create_task(relay.run())
            group.create_task(self._speak())
            group.create_task(self._age())
            for desk in range(self._plan.desks):
                group.create_task(self._watch(desk))

    def _pose(self, number: int) -> SendPos:
        x, y = self._places[number]
        return SendPos.of_checked(NAMES, (x + self._steps * 1e-3, y, 0.3, 1.0, 0.8, "driving"))

    def _due(self, begin: int, end: int) -> Iterator[RobotPose]:
        for turn in range(begin, end):
            self._steps, number = divmod(turn, self._plan.robots)
            yield self._names[number], self._pose(number)

    async def _speak(self) -> None:
        began, told = time.monotonic(), 0
        area = AcceptedArea(-1.0, -1.0, self._plan.side + 100.0, self._plan.side + 100.0, 1.0)
        while True:
            await asyncio.sleep(TURN_S)
            now = time.monotonic() - began
            due = round(now * self._plan.robots)
            self.late = max(self.late, (due - told) / self._plan.robots - TURN_S)
            at = time.time()
            for robot, pose in self._due(told, due):
                self.robots.follow(robot, pose, LINK, at, area)
            told = due

    async def _age(self) -> None:
        while True:
            await asyncio.sleep(AGE_S)
            self.robots.age(time.time())

    async def _watch(self, desk: int) -> None:
        side = self._plan.side if desk % 2 else self._plan.near
        begin = (self._plan.side - side) * (desk + 0.5) / self._plan.desks
        bounds = (begin, begin, begin + side, begin + side)
        watch = ViewWatch(self._views, View(bounds), self._plan.rate, PositionForm.COLUMNS)
        while True:
            await asyncio.sleep(1 / self._plan.rate)
            frame = watch.next_frame()
            if frame is not None:
                self.frames += 1
                self.bytes += len(frame)


async def run(plan: Plan) -> None:
    """Do what is said on standard input until that ends."""
    gateway, loop = Gateway(plan), asyncio.get_running_loop()
    running = asyncio.create_task(gateway.run())
    print("ready", flush=True)
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        cpu, gateway.late, gateway.frames, gateway.bytes = time.process_time(), 0.0, 0, 0
        await asyncio.wait({running}, timeout=json.loads(line)["seconds"])
        if running.done():
            running.result()
        found = {
            "cpu": time.process_time() - cpu,
            "late": gateway.late,
            "frames": gateway.frames,
            "bytes": gateway.bytes,
            "known": gateway.robots.count(),
        }
        print(json.dumps(found), flush=True)
    running.cancel()


if __name__ == "__main__":
    leave_on_signals()
    asyncio.run(run(Plan(**json.loads(sys.argv[1]))))
