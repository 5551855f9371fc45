"""The part on what a tick costs a gateway whose desks are told of the robots in their views."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from benchmarks.clock import spread
from benchmarks.page import Part
from benchmarks.trial import size
from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.positions import FindRobots, PositionForm, View
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.fleet.operator_updates import EVERYTHING, Snapshots
from robot_bridge.gateway.fleet.views import FleetViews, ViewWatch
from robot_bridge.gateway.model.robots import Robots

ROBOTS = size(100_000, 20_000)
SIDE = 10_000.0
"""metres of the site."""
NEAR = 2200.0
"""metres of a view whose robots come one by one."""
ROUNDS = size(7, 2)
STEP = 0.5
"""metres that a robot moves between two ticks."""
NAMES = ("x", "y", "theta", "v", "battery", "status")

TEXT = """\
{robots} robots at random places of a site of {side} × {side} m; all of them move between two ticks. One
process, no sockets: making what is sent, not sending it.

| | milliseconds |
|---|---|
{rows}

A frame of all robots is {all_kb} kB, one of the {near} in view {near_kb} kB, a density {density_kb} kB.
"""


class Fleet:
    """Robots that all move, and what desks are told of them."""

    def __init__(self, number: int = ROBOTS, side: float = SIDE, step: float = 1e-3) -> None:
        self.robots, self.clock = Robots(), ManualClock(wall=100.0)
        site = SimpleNamespace(report=SimpleNamespace(bounds=(0.0, 0.0, side, side)))
        self.views = FleetViews(self.robots, site, self.clock)  # type: ignore[arg-type]
        self.snapshots = Snapshots(self.robots, self.clock)
        self._places = np.random.default_rng(1).uniform(0, side - 1.0, (number, 2)).tolist()
        self._moves, self._step = 0, step
        for robot in range(number):
            self.robots.ready(f"robot-{robot:06}", robot, "websocket", 100.0)
        self.move()

    def move(self) -> None:
        """Move all robots on."""
        self._moves += 1
        for number, (x, y) in enumerate(self._places):
            pose = SendPos.of_checked(NAMES, (x + self._moves * self._step, y, 0.3, 1.0, 0.8, "driving"))
            self.robots.observe(f"robot-{number:06}", pose, "websocket", 100.0)

    def watch(self, bounds: tuple[float, float, float, float]) -> ViewWatch:
        """Return what a desk is told that sees so much."""
        return ViewWatch(self.views, View(bounds), 5.0, PositionForm.COLUMNS)

    def look_up(self) -> None:
        """Look up where all robots are."""
        self.clock.advance(60.0)
        self.views.places()

    def density(self) -> None:
        """Count the robots in each cell."""
        self.views.places().density((0.0, 0.0, SIDE, SIDE))


def measure(data: Path) -> Part:
    """Measure on robots that are made up."""
    fleet = Fleet(step=STEP)
    one, other, whole = (fleet.watch((0.0, 0.0, side, side)) for side in (NEAR, NEAR, SIDE))
    for watch in (one, other, whole):
        watch.next_frame()
    times: dict[str, list[float]] = {}
    frames: dict[str, int] = {}

    def timed(what: str, work: Callable[[], Any]) -> None:
        begin = time.perf_counter()
        made = work()
        times.setdefault(what, []).append(1000 * (time.perf_counter() - begin))
        if isinstance(made, bytes):
            frames[what] = len(made)

    for _ in range(ROUNDS):
        fleet.move()
        every = "a frame of all robots, for all desks without a view"
        timed(every, lambda: fleet.snapshots.after(EVERYTHING, form=PositionForm.COLUMNS).frame)
        timed("where all are, for all desks with one, twice a second at most", fleet.look_up)
        timed("the cells of the whole site, for all desks that see them", fleet.density)
        timed("a frame of the robots in view, for the first desk that sees them", one.next_frame)
        timed("the same for another desk that sees them", other.next_frame)
        timed("a frame of a density", whole.next_frame)
        timed("a frame where nothing changed", one.next_frame)
        timed("a search by name", lambda: asyncio.run(fleet.views.find(FindRobots("77"))))
    kb = {what: round(length / 1000) for what, length in frames.items()}
    rows = "\n".join(f"| {what} | {spread(found):.1f} |" for what, found in times.items())
    text = TEXT.format(
        robots=ROBOTS,
        side=round(SIDE),
        rows=rows,
        near=len(fleet.views.places().inside((0.0, 0.0, NEAR, NEAR))),
        all_kb=kb[every],
        near_kb=kb["the same for another desk that sees them"],
        density_kb=kb["a frame of a density"],
    )
    return Part("Desks that see a part of a large fleet", text)
