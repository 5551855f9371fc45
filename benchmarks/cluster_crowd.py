"""Robots and desks of several gateways: ``python cluster_crowd.py PLAN``.

It prints ``ready`` when every robot has its map, and an answer to each line of JSON that asks for something.
Robots go to the next gateway when theirs ends; nobody is told that it did but by the connection.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import random
import sys
import time
from collections.abc import Awaitable, Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidMessage

from benchmarks.appliance_crowd import PLACES, Sayings, rpc_call

ARRIVED_WITHIN, HEARD_WITHIN = 120.0, 30.0
"""seconds until all robots have their maps, and until what is waited for is given up."""
ROW, APART = 35, 5.5
"""robots in a row, and metres between them: the sample site holds a thousand."""
AGAIN_AFTER_S = 1.0
"""seconds after which a robot whose Ready was refused says it again."""
JITTER_S = 0.5
"""seconds within which a robot that lost its gateway goes to the next, at random."""
GONE = (ConnectionClosed, InvalidHandshake, InvalidMessage, OSError, TimeoutError)


@dataclass(frozen=True)
class Plan:
    """Gateways by address; ``robots`` are dealt out to them, and each has a desk that is told at ``rate``.

    At a rate of 0 desks do not subscribe to positions.
    """

    addresses: list[str]
    robots: int
    robot_rate: float
    rate: float


class Timetable(Protocol):
    """Knows when robots said what desks are told."""

    def times(self, frame: bytes) -> Iterable[tuple[str, float]]:
        """Return robots of a table of positions, and when each said that it is there."""


class Robot:
    """One robot: it acknowledges all that it is sent, and notes when it heard of what."""

    def __init__(self, number: int, plan: Plan, sayings: Sayings) -> None:
        self.number, self.home = number, number % len(plan.addresses)
        self.name = f"load-{number}"
        self.heard: dict[str, float] = {}
        """When it heard of what, by the id of that."""
        self.since = self.map_since = 0.0
        self.asked, self.told_to_drive = 0.0, 0.0
        self.has_map = asyncio.Event()
        self._plan, self._sayings, self._steps = plan, sayings, itertools.count()
        self._socket: ClientConnection | None = None

    @property
    def place(self) -> tuple[float, float]:
        """Where it is: a millimetre further with each look."""
        row, column = divmod(self.number, ROW)
        creep = next(self._steps) % 1000 / 1000
        return round(3.0 + column * APART + creep, PLACES), round(3.0 + row * APART, PLACES)

    @property
    def state(self) -> str:
        """Where it is connected, since when, and since when it has its map there."""
        where = "nowhere" if self._socket is None else str(self._socket.remote_address[1])
        return f"at {where} since {self.since:.1f}, map {self.map_since:.1f}, now {time.time():.1f}"

    def is_told(self) -> bool:
        """Tell whether it was told to drive since that was asked for."""
        return self.told_to_drive > self.asked

    async def live(self) -> None:
        """Be connected to one gateway or another until cancelled."""
        for turn in itertools.count(self.home):
            address = self._plan.addresses[turn % len(self._plan.addresses)]
            try:
                async with _open(f"{address}/robot?robot={self.name}") as self._socket:
                    self.since = time.time()
                    await self._socket.send(rpc_call("Ready", {"magic": self.number + 1}, 1))
                    await self._hear(self._socket)
            except GONE:
                pass
            self._socket = None
            await asyncio.sleep(random.uniform(0.0, JITTER_S))

    async def drive(self) -> None:
        """Say where it is, to whoever it is connected to."""
        if self._socket is None or not self.has_map.is_set():
            return
        (x, y), at = self.place, time.time()
        self._sayings.note(self.name, (x, y), at)
        with contextlib.suppress(*GONE):
            await self._socket.send(rpc_call("SendPos", {"x": x, "y": y, "theta": 0.5, "v": 0.1, "t": at}))

    async def _hear(self, socket: ClientConnection) -> None:
        async for text in socket:
            message = json.loads(text)
            if message.get("id") == 1 and "error" in message:
                # The database is away: it says Ready again until it is taken.
                await asyncio.sleep(AGAIN_AFTER_S)
                await socket.send(rpc_call("Ready", {"magic": self.number + 1}, 1))
            if "method" not in message or "id" not in message:
                continue
            self.heard.setdefault(message["id"], time.time())
            if message["method"] == "SetPosEnd":
                self.told_to_drive = time.time()
            if message["method"] == "SetMap":
                self.has_map.set()
                self.map_since = time.time()
            await socket.send(json.dumps({"jsonrpc": "2.0", "id": message["id"], "result": {}}))


class Desk:
    """A desk at one gateway: when it was told of what the robots said, and of stops."""

    def __init__(self, address: str, subscription: dict[str, Any] | None, sayings: Timetable) -> None:
        self._address, self._subscription, self._sayings = address, subscription, sayings
        self._ids, self._answers = itertools.count(10), dict[int, asyncio.Future[Any]]()
        self._socket: ClientConnection | None = None
        self.newest: dict[str, tuple[float, float]] = {}
        """Of each robot what is newest: when it said that, and when the desk was told."""
        self.delays: list[tuple[str, float]] | None = None
        self.in_force: dict[str, float] = {}
        self.emergency: dict[str, Any] = {}
        self.up = asyncio.Event()

    async def live(self) -> None:
        """Be connected until cancelled."""
        while True:
            try:
                async with _open(f"{self._address}/desk") as self._socket:
                    await self._socket.send(rpc_call("hello", {"operator": "Ada"}, 1))
                    if self._subscription is not None:
                        await self._socket.send(rpc_call("subscribe", self._subscription, 2))
                    self.up.set()
                    await self._hear(self._socket)
            except GONE:
                pass
            self._socket = None
            self.up.clear()
            await asyncio.sleep(0.2)

    async def ask(self, method: str, params: dict[str, Any]) -> Any:
        """Return the answer to a request; raises RuntimeError where it is refused."""
        if self._socket is None:
            raise RuntimeError("not connected")
        number = next(self._ids)
        self._answers[number] = asyncio.get_running_loop().create_future()
        await self._socket.send(rpc_call(method, params, number))
        return await self._answers[number]

    async def until_heard(self, robots: Iterable[str], since: float) -> float:
        """Return the seconds from ``since`` until this desk had what all ``robots`` said later."""
        missing, last = dict.fromkeys(robots), since
        async with asyncio.timeout(HEARD_WITHIN):
            while missing:
                for robot in list(missing):
                    said, at = self.newest.get(robot, (0.0, 0.0))
                    if said > since:
                        last = max(last, at)
                        del missing[robot]
                await asyncio.sleep(0.01)
        return last - since

    async def _hear(self, socket: ClientConnection) -> None:
        async for message in socket:
            now = time.time()
            if isinstance(message, str):
                self._read(json.loads(message), now)
                continue
            for robot, said in self._sayings.times(message):
                if said > self.newest.get(robot, (0.0, 0.0))[0]:
                    self.newest[robot] = (said, now)
                    if self.delays is not None:
                        self.delays.append((robot, (now - said) * 1e3))

    def _read(self, message: dict[str, Any], now: float) -> None:
        if message.get("method") == "emergency":
            self.emergency = message["params"]
            if self.emergency["in_force"]:
                self.in_force.setdefault(self.emergency["stop"], now)
        elif (answer := self._answers.pop(message.get("id", 0), None)) is not None:
            if "error" in message:
                answer.set_exception(RuntimeError(message["error"]["message"]))
            else:
                answer.set_result(message["result"])


class Crowd:
    """All of them; what may be asked of it are its methods whose names begin with ``do_``."""

    def __init__(self, plan: Plan) -> None:
        self._plan, sayings = plan, Sayings()
        self._robots = [Robot(number, plan, sayings) for number in range(plan.robots)]
        subscription = {"rate": plan.rate, "form": "columns"} if plan.rate else None
        self._desks = [Desk(address, subscription, sayings) for address in plan.addresses]
        self._tasks: list[asyncio.Task[None]] = []
        self._numbers, self._late = itertools.count(1), 0.0

    async def arrive(self) -> None:
        """Connect everybody; return when every robot has its map."""
        for number, robot in enumerate(self._robots):
            self._tasks.append(asyncio.create_task(robot.live()))
            if number % 20 == 19:
                await asyncio.sleep(0.05)
        self._tasks += [asyncio.create_task(desk.live()) for desk in self._desks]
        async with asyncio.timeout(ARRIVED_WITHIN):
            for one in (*(robot.has_map for robot in self._robots), *(desk.up for desk in self._desks)):
                await one.wait()
        if self._robots:
            self._tasks.append(asyncio.create_task(self._drive()))

    async def do_watch(self, seconds: float) -> dict[str, Any]:
        """Return the delays of positions in milliseconds, of robots at the desk's gateway and of others."""
        for desk in self._desks:
            desk.delays = []
        cpu, began, self._late = time.process_time(), time.monotonic(), 0.0
        await asyncio.sleep(seconds)
        own_cpu = (time.process_time() - cpu) / (time.monotonic() - began)
        here: list[float] = []
        elsewhere: list[float] = []
        homes = {robot.name: robot.home for robot in self._robots}
        for number, desk in enumerate(self._desks):
            for name, delay in desk.delays or ():
                (here if homes[name] == number else elsewhere).append(delay)
            desk.delays = None
        return {"here": here, "elsewhere": elsewhere, "own_cpu": own_cpu, "late": self._late}

    async def do_command(self, desk: int, robots_of: int, count: int) -> list[float]:
        """Return the milliseconds from a desk's request to the robot, of one command after the other."""
        found = []
        for robot in [one for one in self._robots if one.home == robots_of][:count]:
            command, (x, y) = f"command-{next(self._numbers):08d}", robot.place
            began = robot.asked = time.time()
            params = {
                "command": command,
                "robot": robot.name,
                "op": "SetPosEnd",
                "params": {"x": x, "y": y},
                "override": "robots of a benchmark stand anywhere",
            }
            await self._desks[desk].ask("send", params)
            await _until(robot.is_told)
            found.append((robot.told_to_drive - began) * 1e3)
        return found

    async def do_stop(self, desk: int, without: Sequence[int] = ()) -> dict[str, Any]:
        """Make a stop; return its id, when that was, and the milliseconds until each gateway but ``without``
        says that it is in force."""
        stop, began = f"bench-{next(self._numbers):08d}", time.time()
        asked = asyncio.create_task(
            self._desks[desk].ask("emergency_stop", {"command": stop, "reason": "measured"})
        )
        desks = [one for number, one in enumerate(self._desks) if number not in without]
        await _until(lambda: all(stop in one.in_force for one in desks))
        await asked
        return {
            "stop": stop,
            "began": began,
            "gateways": [(one.in_force[stop] - began) * 1e3 for one in desks],
        }

    async def do_stopped(self, stop: str, began: float, without: Sequence[int] = ()) -> float:
        """Return the milliseconds from ``began`` until the last robot heard, those of ``without`` aside."""
        robots = [robot for robot in self._robots if robot.home not in without]
        try:
            await _until(lambda: all(f"emergency-{stop}" in robot.heard for robot in robots))
        except TimeoutError:
            missed = [one for one in robots if f"emergency-{stop}" not in one.heard]
            text = ", ".join(f"{one.name} of {one.home} ({one.state})" for one in missed[:20])
            raise RuntimeError(f"{len(missed)} robots did not hear of {stop}: {text}") from None
        return (max(robot.heard[f"emergency-{stop}"] for robot in robots) - began) * 1e3

    async def do_clear(self) -> None:
        """Clear the stop as soon as that can be, and wait until no gateway has it any more."""
        async with asyncio.timeout(HEARD_WITHIN):
            while any(desk.emergency.get("in_force") for desk in self._desks):
                try:
                    await self._desks[0].ask("clear_emergency_stop", {"reason": "measured"})
                except RuntimeError:
                    await asyncio.sleep(0.2)
                await asyncio.sleep(0.05)

    async def do_heard(self, since: float, desk: int, homes: Sequence[int]) -> float:
        """Return the seconds from ``since`` until a desk had what all robots of ``homes`` said later."""
        robots = [robot.name for robot in self._robots if robot.home in homes]
        return await self._desks[desk].until_heard(robots, since)

    async def do_fresh(self, since: float, desk: int, homes: Sequence[int], age: float) -> float:
        """Return the seconds from ``since`` until what a desk was told of no robot of ``homes`` is older than
        ``age`` seconds."""
        told = self._desks[desk].newest
        robots = [robot.name for robot in self._robots if robot.home in homes]

        def all_fresh() -> bool:
            oldest = min(told.get(name, (0.0, 0.0))[0] for name in robots)
            return time.time() - oldest <= age

        await _until(all_fresh)
        return time.time() - since

    async def _drive(self) -> None:
        began, gap = time.monotonic(), 1 / (self._plan.robot_rate * len(self._robots))
        for number in itertools.count():
            due = began + number * gap
            if (left := due - time.monotonic()) > 0:
                await asyncio.sleep(left)
            elif number % 50 == 0:
                await asyncio.sleep(0)
            self._late = max(self._late, (time.monotonic() - due) * 1e3)
            await self._robots[number % len(self._robots)].drive()


async def _until(holds: Callable[[], bool]) -> None:
    async with asyncio.timeout(HEARD_WITHIN):
        while not holds():
            await asyncio.sleep(0.002)


def _open(url: str) -> connect:
    return connect(url, compression=None, max_size=None, max_queue=None, ping_interval=None, open_timeout=20)


async def run(plan: Plan) -> None:
    """Do what is said on standard input until that ends."""
    crowd, loop = Crowd(plan), asyncio.get_running_loop()
    await crowd.arrive()
    print("ready", flush=True)
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        asked = json.loads(line)
        do: Callable[..., Awaitable[Any]] = getattr(crowd, f"do_{asked.pop('do')}")
        print(json.dumps(await do(**asked)), flush=True)


if __name__ == "__main__":
    asyncio.run(run(Plan(**json.loads(sys.argv[1]))))
