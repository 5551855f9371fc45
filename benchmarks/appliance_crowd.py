"""Robots, desks and phones of a site with a small computer: ``python appliance_crowd.py PLAN``, over TLS.

It prints ``ready`` when every robot has its map, and for each window that comes as a line of JSON what was
seen in it, when it is over.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import math
import ssl
import sys
import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from websockets.asyncio.client import ClientConnection, connect

from robot_bridge.core.messages.positions import PLACE_COLUMNS, PositionForm
from robot_bridge.core.position_frame import PLACE_VALUE, POSITION_HEAD, POSITION_VALUE

ARRIVED_WITHIN = 120.0
STOP_WITHIN = 30.0
"""seconds until every robot has heard of a stop, or it counts as not heard."""
STANDING = 1.0
"""seconds that the robots stand before a stop is cleared."""
CENTRES, RADIUS, SPEED = (30.0, 12.0, 14.0), 5.0, 1.0
"""Robots drive round on circles in rows: the first one's centre and the distance between two, in metres; the
metres of the radius, and metres a second."""
COLUMNS = 10
PLACES, REMEMBERED = 3, 60
"""digits after the point of a metre, which tell places apart, and places of each robot that are kept."""
MEASURED_S = 5
"""seconds of which a phone counts the bytes, as its page does."""
PLACES_FORM = PositionForm.PLACES.value

Place = tuple[float, float]


@dataclass(frozen=True)
class Plan:
    """Who is there: ``ca`` is the file of the authority that signed for ``address``.

    Desks and phones ask for positions by ``desk`` and ``phone``, the parameters of ``subscribe``. A phone to
    which more than ``budget`` bytes of them come in a minute asks for less, as its page does: for places
    alone, and then at the next of ``phone_rates``.
    """

    address: str
    ca: str
    robots: int
    robot_rate: float
    desks: int
    desk: dict[str, Any]
    phones: int
    phone: dict[str, Any]
    phone_rates: list[float]
    budget: int


@dataclass
class Watched:
    """What one kind of client was told in a window: delays in milliseconds, bytes a client, and what for.

    ``subscription`` is what the first of them had asked for by the end.
    """

    delays: list[float] = field(default_factory=list)
    bytes: float = 0.0
    subscription: dict[str, Any] = field(default_factory=dict)


@dataclass
class Seen:
    """What came of a window.

    ``stops`` are the milliseconds of each emergency stop from when a desk asked for it to the last robot, NaN
    for one that some robot never heard of; ``answers`` until the desk was answered. ``late`` is the most that
    a robot was behind its time in milliseconds, ``own_cpu`` what this process used of a core.
    """

    positions: float = 0.0
    desk: Watched = field(default_factory=Watched)
    phone: Watched = field(default_factory=Watched)
    stops: list[float] = field(default_factory=list)
    answers: list[float] = field(default_factory=list)
    late: float = 0.0
    own_cpu: float = 0.0


class Sayings:
    """When robots said where they are, by robot and place: a table of places alone tells no times."""

    def __init__(self) -> None:
        self._said: dict[str, dict[Place, float]] = defaultdict(dict)

    def note(self, robot: str, place: Place, at: float) -> None:
        """Note where a robot says that it is, and forget what it said long ago."""
        said = self._said[robot]
        said.setdefault(place, at)
        if len(said) > REMEMBERED:
            del said[next(iter(said))]

    def times(self, frame: bytes) -> Iterator[tuple[str, float]]:
        """Yield when robots said what a table of positions tells of them."""
        begin = POSITION_HEAD + int.from_bytes(frame[:POSITION_HEAD], "little")
        head = json.loads(frame[POSITION_HEAD:begin])["params"]
        columns = head["columns"]
        value = PLACE_VALUE if set(columns) <= set(PLACE_COLUMNS) else POSITION_VALUE
        table = dict(
            zip(columns, np.frombuffer(frame, value, -1, begin).reshape(len(columns), -1), strict=True)
        )
        if not {"x", "y"} <= table.keys():
            return
        places = zip(*(np.round(table[name].astype(float), PLACES).tolist() for name in "xy"), strict=True)
        for robot, place in zip(head["robots"], places, strict=True):
            if (at := self._said[robot].get(place)) is not None:
                yield robot, at


class Robot:
    """One robot: it acknowledges all that it is sent, and stands once it is told to."""

    def __init__(self, number: int, socket: ClientConnection, sayings: Sayings) -> None:
        self._socket, self._number, self._sayings = socket, number, sayings
        self._name = f"load-{number}"
        self._angle, self._moved_at = float(number), time.monotonic()
        self.has_map, self.heard_stop = False, asyncio.Event()
        self.stands = False

    @classmethod
    async def arrive(cls, number: int, plan: Plan, context: ssl.SSLContext, sayings: Sayings) -> Robot:
        """Return a robot that has said Ready."""
        robot = cls(number, await _open(plan, f"/robot?robot=load-{number}", context), sayings)
        await robot._socket.send(rpc_call("Ready", {"magic": number + 1}, 1))
        return robot

    async def hear(self) -> None:
        """Answer what comes, until the connection ends."""
        async for text in self._socket:
            message = json.loads(text)
            if "method" not in message or "id" not in message:
                continue
            if message["method"] == "Abort" and message["params"].get("emergency"):
                self.stands = True
                self.heard_stop.set()
            self.has_map = self.has_map or message["method"] == "SetMap"
            await self._socket.send(json.dumps({"jsonrpc": "2.0", "id": message["id"], "result": {}}))

    async def drive(self) -> None:
        """Say where it is now."""
        now = time.monotonic()
        speed = 0.0 if self.stands else SPEED
        self._angle += speed * (now - self._moved_at) / RADIUS
        self._moved_at = now
        x, y, apart = CENTRES
        row, column = divmod(self._number, COLUMNS)
        place = (
            round(x + column * apart + RADIUS * math.cos(self._angle), PLACES),
            round(y + row * apart + RADIUS * math.sin(self._angle), PLACES),
        )
        theta, at = math.remainder(self._angle + math.pi / 2, 2 * math.pi), time.time()
        pose = {"x": place[0], "y": place[1], "theta": round(theta, 4), "v": speed, "t": at}
        self._sayings.note(self._name, place, at)
        await self._socket.send(rpc_call("SendPos", pose))


class Watcher:
    """A desk or a phone, which only looks; a desk also stops everybody."""

    def __init__(
        self, socket: ClientConnection, sayings: Sayings, watched: Callable[[], Watched | None]
    ) -> None:
        self._socket, self._sayings, self._watched = socket, sayings, watched
        self._positions_received = 0
        self._ids, self._answers = itertools.count(3), dict[int, asyncio.Future[Any]]()

    @classmethod
    async def arrive(
        cls,
        plan: Plan,
        context: ssl.SSLContext,
        subscription: dict[str, Any],
        sayings: Sayings,
        watched: Callable[[], Watched | None],
    ) -> Watcher:
        """Return one that has asked for positions."""
        watcher = cls(await _open(plan, "/desk", context), sayings, watched)
        watcher.subscription = subscription
        await watcher._socket.send(rpc_call("hello", {"operator": "Ada"}, 1))
        await watcher._socket.send(rpc_call("subscribe", subscription, 2))
        return watcher

    async def look(self) -> None:
        """Take in what comes, until the connection ends."""
        newest: dict[str, float] = {}
        async for message in self._socket:
            now, watched = time.time(), self._watched()
            if watched is not None:
                watched.bytes += len(message)
            if isinstance(message, str):
                self._settle(json.loads(message))
                continue
            self._positions_received += len(message)
            for robot, sent in self._sayings.times(message):
                if sent > newest.get(robot, 0.0):
                    newest[robot] = sent
                    if watched is not None:
                        watched.delays.append((now - sent) * 1e3)

    async def keep_to(self, budget: int, rates: list[float]) -> None:
        """Ask for less when positions take more than ``budget`` bytes a minute, as the field page does.

        The page asks for more again after a quiet minute, and this does not.
        """
        received = deque([self._positions_received], maxlen=MEASURED_S + 1)
        while True:
            await asyncio.sleep(1.0)
            received.append(self._positions_received)
            if len(received) <= MEASURED_S or (received[-1] - received[0]) / MEASURED_S * 60 <= budget:
                continue
            slower = [rate for rate in rates if rate < self.subscription["rate"]]
            if self.subscription["form"] != PLACES_FORM:
                self.subscription = {**self.subscription, "form": PLACES_FORM}
            elif slower:
                self.subscription = {**self.subscription, "rate": max(slower)}
            await self.ask("subscribe", self.subscription)
            received = deque([self._positions_received], maxlen=MEASURED_S + 1)

    async def ask(self, method: str, params: dict[str, Any]) -> Any:
        """Return the answer to a request.

        :raises RuntimeError: when it is refused.
        """
        number = next(self._ids)
        self._answers[number] = asyncio.get_running_loop().create_future()
        await self._socket.send(rpc_call(method, params, number))
        return await self._answers[number]

    def _settle(self, message: dict[str, Any]) -> None:
        answer = self._answers.pop(message.get("id", 0), None) if "method" not in message else None
        if answer is None:
            return
        if "error" in message:
            answer.set_exception(RuntimeError(message["error"]["message"]))
        else:
            answer.set_result(message["result"])


class Crowd:
    """All of them on one gateway."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._context = ssl.create_default_context(cafile=plan.ca)
        self._seen: Seen | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._robots: list[Robot] = []
        self._desks: list[Watcher] = []
        self._phones: list[Watcher] = []
        self._sayings = Sayings()
        self._numbers = itertools.count()

    async def arrive(self) -> None:
        """Connect everybody; return when every robot has its map.

        :raises TimeoutError: when one has none.
        """
        plan, context = self._plan, self._context
        for number in range(plan.robots):
            robot = await Robot.arrive(number, plan, context, self._sayings)
            self._robots.append(robot)
            self._tasks.append(asyncio.create_task(robot.hear()))
        for _ in range(plan.desks):
            desk = await Watcher.arrive(
                plan, context, plan.desk, self._sayings, lambda: self._seen and self._seen.desk
            )
            self._desks.append(desk)
            self._tasks.append(asyncio.create_task(desk.look()))
        for _ in range(plan.phones):
            phone = await Watcher.arrive(
                plan, context, plan.phone, self._sayings, lambda: self._seen and self._seen.phone
            )
            self._phones.append(phone)
            self._tasks.append(asyncio.create_task(phone.look()))
            self._tasks.append(asyncio.create_task(phone.keep_to(plan.budget, plan.phone_rates)))
        async with asyncio.timeout(ARRIVED_WITHIN):
            while not all(robot.has_map for robot in self._robots):
                await asyncio.sleep(0.1)

    async def see(self, seconds: float, settle: float, stops: int) -> Seen:
        """Let everybody work for ``settle`` and for ``seconds``, which count, with so many stops in them.

        :raises RuntimeError: when the gateway ended a connection or refused a stop.
        """
        driving = asyncio.create_task(self._drive())
        await asyncio.sleep(settle)
        seen = self._seen = Seen()
        began, cpu = time.monotonic(), time.process_time()
        for number in range(stops):
            await self._sleep_until(began + seconds * (number + 0.5) / stops)
            await self._stop(seen)
        await self._sleep_until(began + seconds)
        self._seen = None
        seen.own_cpu = (time.process_time() - cpu) / (time.monotonic() - began)
        seen.positions /= time.monotonic() - began
        driving.cancel()
        await asyncio.gather(driving, return_exceptions=True)
        for kind, watchers in ((seen.desk, self._desks), (seen.phone, self._phones)):
            kind.bytes /= len(watchers)
            kind.subscription = watchers[0].subscription
        return seen

    async def _sleep_until(self, at: float) -> None:
        while (left := at - time.monotonic()) > 0:
            await asyncio.sleep(min(left, 0.5))
            for task in self._tasks:
                if task.done():
                    raise RuntimeError(f"the gateway ended a connection ({task.exception()})")

    async def _drive(self) -> None:
        """Let each robot say where it is, evenly, one after the other."""
        began, gap = time.monotonic(), 1 / (self._plan.robot_rate * len(self._robots))
        for number in itertools.count():
            due = began + number * gap
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            if self._seen is not None:
                self._seen.late = max(self._seen.late, (time.monotonic() - due) * 1e3)
                self._seen.positions += 1
            await self._robots[number % len(self._robots)].drive()

    async def _stop(self, seen: Seen) -> None:
        for robot in self._robots:
            robot.heard_stop.clear()
        stop, desk, began = f"bench-{next(self._numbers):08d}", self._desks[0], time.monotonic()
        asked = asyncio.create_task(desk.ask("emergency_stop", {"command": stop, "reason": "measured"}))
        asked.add_done_callback(lambda _: seen.answers.append((time.monotonic() - began) * 1e3))
        try:
            async with asyncio.timeout(STOP_WITHIN):
                await asyncio.gather(*(robot.heard_stop.wait() for robot in self._robots))
                seen.stops.append((time.monotonic() - began) * 1e3)
        except TimeoutError:
            seen.stops.append(math.nan)
        await asked
        await asyncio.sleep(STANDING)
        await desk.ask("clear_emergency_stop", {"stop": stop, "reason": "measured"})
        for robot in self._robots:
            robot.stands = False


def rpc_call(method: str, params: dict[str, Any], id: int | None = None) -> str:
    """Return a JSON-RPC call; a notification without ``id``."""
    message = {"jsonrpc": "2.0", "method": method, "params": params}
    return json.dumps(message if id is None else {**message, "id": id})


async def _open(plan: Plan, path: str, context: ssl.SSLContext) -> ClientConnection:
    return await connect(
        plan.address + path, ssl=context, compression=None, max_size=None, max_queue=None, ping_interval=None
    )


async def run(plan: Plan) -> None:
    """Do what is said on standard input until that ends."""
    crowd, loop = Crowd(plan), asyncio.get_running_loop()
    await crowd.arrive()
    print("ready", flush=True)
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        print(json.dumps(asdict(await crowd.see(**json.loads(line)))), flush=True)


if __name__ == "__main__":
    asyncio.run(run(Plan(**json.loads(sys.argv[1]))))
