"""Operators in one process: ``python swarm_operators.py PLAN``, see :mod:`.swarm`.

It prints ``ready``, and for each window that comes as a line of JSON what was seen in it, when it is over.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import math
import re
import sys
import threading
import time
from dataclasses import asdict, dataclass, field

import msgspec
import numpy as np

from benchmarks.raw_websocket import BINARY, Stream, call, connect
from robot_bridge.core.messages.positions import PositionForm
from robot_bridge.core.position_frame import POSITION_HEAD, POSITION_VALUE

DEVICE_TIME = "device_time"


@dataclass
class Told:
    """Times in milliseconds, median and 99th percentile; None where nothing was told.

    ``delays`` are from a robot's clock to the probe, of positions that are new to it; ``ages`` are from the
    gateway's clock to one of the other operators.
    """

    delays: list[float | None] = field(default_factory=list)
    ages: list[float | None] = field(default_factory=list)


class _Table(msgspec.Struct):
    """The head of a table of positions: who is in it, and which column is which."""

    robots: list[str]
    columns: list[str]


class _Head(msgspec.Struct):
    params: _Table


class _Pose(msgspec.Struct):
    y: float
    t: float


class _Forwarded(msgspec.Struct):
    """What a peer that forwards every position sends; ``y`` tells the robot."""

    params: _Pose


class Operators:
    """All of them, the probe and those that never read among them."""

    def __init__(self, plan: dict[str, object]) -> None:
        self._plan = plan
        self._delays: list[float] = []
        self._ages: list[float] = []
        self._window = (0.0, 0.0)
        self._tasks: list[asyncio.Task[None]] = []
        self._stuck: list[object] = []

    async def connect(self) -> None:
        """Connect and subscribe."""
        plan = self._plan
        for number in range(int(str(plan["operators"]))):
            operator = await self._subscribed(plan["operator_rate"])
            self._begin(operator, self._age if number == 0 and plan["rpc"] else None)
        self._begin(await self._subscribed(plan["probe_rate"]), self._delay)
        for _ in range(int(str(plan["stuck"]))):
            self._stuck.append(await self._subscribed(plan["operator_rate"], 4096))

    async def see(self, begin: float, seconds: float) -> Told:
        """Return what is seen from ``begin`` (of :func:`time.monotonic`) on."""
        self._window = begin, begin + seconds
        self._delays.clear()
        self._ages.clear()
        await asyncio.sleep(begin + seconds - time.monotonic())
        return Told(_median_and_p99(self._delays), _median_and_p99(self._ages))

    async def _subscribed(self, rate: object, receive_buffer: int | None = None) -> Stream:
        host, port = str(self._plan["host"]), int(str(self._plan["port"]))
        stream = await Stream.on(await asyncio.to_thread(connect, host, port, "/desk", receive_buffer))
        positions = {"rate": rate, "form": PositionForm.COLUMNS}
        stream.writer.write(call("hello", {"operator": "load"}, 1) + call("subscribe", positions, 2))
        return stream

    def _begin(self, stream: Stream, look: object) -> None:
        self._tasks.append(asyncio.create_task(self._read(stream, look)))

    async def _read(self, stream: Stream, look: object) -> None:
        newest: dict[object, float] = {}
        while True:
            kind, payload = await stream.receive()
            now, at = time.time(), time.monotonic()
            if look is not None:
                look(kind, payload, now, newest, self._window[0] <= at < self._window[1])  # type: ignore[operator]

    def _delay(
        self, kind: int, payload: bytes, now: float, newest: dict[object, float], counts: bool
    ) -> None:
        for robot, sent in self._positions(kind, payload):
            if sent > newest.get(robot, 0.0):
                # Also before a window: what is told once more in it, for something else, is not new there.
                newest[robot] = sent
                if counts:
                    self._delays.append((now - sent) * 1e3)

    def _age(
        self, _kind: int, payload: bytes, now: float, _newest: dict[object, float], counts: bool
    ) -> None:
        if not counts:
            return
        if found := re.search(rb'"params":\{"t":([0-9.]+)', payload[:200]):
            self._ages.append((now - float(found.group(1))) * 1e3)

    def _positions(self, kind: int, payload: bytes) -> list[tuple[object, float]]:
        if not self._plan["rpc"]:
            pose = msgspec.json.decode(payload, type=_Forwarded).params
            return [(pose.y, pose.t)]
        if kind != BINARY:
            return []
        begin = POSITION_HEAD + int.from_bytes(payload[:POSITION_HEAD], "little")
        head = msgspec.json.decode(payload[POSITION_HEAD:begin], type=_Head).params
        if DEVICE_TIME not in head.columns:
            return []
        robots = len(head.robots)
        offset = begin + head.columns.index(DEVICE_TIME) * robots * np.dtype(POSITION_VALUE).itemsize
        times = np.frombuffer(payload, POSITION_VALUE, robots, offset).tolist()
        return [(robot, at) for robot, at in zip(head.robots, times, strict=True) if not math.isnan(at)]


def _median_and_p99(times: list[float]) -> list[float | None]:
    found = sorted(times)
    return [round(found[int(part * (len(found) - 1))], 1) if found else None for part in (0.5, 0.99)]


async def run(plan: dict[str, object]) -> None:
    """Watch as told on standard input until that ends."""
    operators, lines = Operators(plan), asyncio.Queue[str]()
    loop = asyncio.get_running_loop()
    await operators.connect()
    print("ready", flush=True)

    def read() -> None:
        for line in itertools.chain(iter(sys.stdin.readline, ""), [""]):
            loop.call_soon_threadsafe(lines.put_nowait, line)

    threading.Thread(target=read, daemon=True).start()
    while line := await lines.get():
        print(json.dumps(asdict(await operators.see(**json.loads(line)))), flush=True)


if __name__ == "__main__":
    asyncio.run(run(json.loads(sys.argv[1])))
