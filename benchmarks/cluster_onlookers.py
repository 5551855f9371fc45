"""Desks of several gateways that see a part of a large fleet: ``python cluster_onlookers.py PLAN``.

It prints ``ready`` when all have subscribed, and for each window that comes as a line of JSON the delays of
what desks were told in it, or how long it took until the first desk had heard of all robots of a gateway.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from benchmarks.cluster_crowd import Desk
from benchmarks.cluster_swarm import NAME, Schedule

ARRIVED_WITHIN = 60.0


@dataclass(frozen=True)
class Plan:
    """A desk for each of ``subscriptions``, dealt out to the gateways at ``addresses`` in turns."""

    addresses: list[str]
    subscriptions: list[dict[str, Any]]


class Times:
    """When robots said what desks are told: by a schedule, once there is one."""

    def __init__(self) -> None:
        self.schedule: Schedule | None = None

    def times(self, frame: bytes) -> Iterator[tuple[str, float]]:
        """Yield robots of a table of positions, and when each said that it is there."""
        if self.schedule is not None:
            yield from self.schedule.times(frame)


async def run(plan: Plan) -> None:
    """Do what is said on standard input until that ends."""
    times, loop = Times(), asyncio.get_running_loop()
    homes = [number % len(plan.addresses) for number in range(len(plan.subscriptions))]
    desks = [
        Desk(plan.addresses[at], subscription, times)
        for at, subscription in zip(homes, plan.subscriptions, strict=True)
    ]
    tasks = [asyncio.create_task(desk.live()) for desk in desks]
    async with asyncio.timeout(ARRIVED_WITHIN):
        for desk in desks:
            await desk.up.wait()
    print("ready", flush=True)
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        window = json.loads(line)
        times.schedule = Schedule(**window["schedule"])
        if "heard" in window:
            names, since = times.schedule.robots_of(window["heard"]["home"]), window["heard"]["since"]
            print(json.dumps(await desks[0].until_heard(names, since)), flush=True)
            continue
        await asyncio.sleep(window["begin"] - time.time())
        for desk in desks:
            desk.delays = []
        await asyncio.sleep(window["seconds"])
        found: dict[str, list[float]] = {"here": [], "elsewhere": []}
        for at, desk in zip(homes, desks, strict=True):
            for name, delay in desk.delays or ():
                is_here = int(name[len(NAME) :]) % len(plan.addresses) == at
                found["here" if is_here else "elsewhere"].append(delay)
            desk.delays = None
        print(json.dumps(found), flush=True)
    for task in tasks:
        task.cancel()


if __name__ == "__main__":
    asyncio.run(run(Plan(**json.loads(sys.argv[1]))))
