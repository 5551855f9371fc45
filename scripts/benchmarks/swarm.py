"""Robots and operators by the hundred, as one process that costs little: raw sockets, frames made once.

``python swarm.py '{"host": ..., "port": ..., ...}'`` (see :class:`Plan`) prints what it saw as JSON (see
:class:`Seen`), of the times the median and the 99th percentile.
"""

from __future__ import annotations

import asyncio
import base64
import json
import os
import re
import socket
import struct
import sys
import time
from dataclasses import asdict, dataclass, field


@dataclass(frozen=True)
class Plan:
    """How many of whom do what for how long.

    ``rate`` is positions a second of each robot. ``operators`` subscribe at ``operator_rate``, ``stuck`` ones
    subscribe and never read. One more operator, the probe, subscribes at
    ``probe_rate`` and measures. ``pid`` is the gateway's process, whose time and memory are read.
    ``rpc`` is false for the peer, which forwards every position to every operator as it is.
    """

    host: str
    port: int
    robots: int
    rate: float
    seconds: float
    operators: int = 20
    operator_rate: float = 5.0
    stuck: int = 0
    probe_rate: float = 50.0
    pid: int = 0
    rpc: bool = True


@dataclass
class Seen:
    """What came of it: positions sent, times in ms, and what the gateway used.

    ``delays`` are from a robot's clock to the probe, of positions that are new to it; ``ages`` are from the
    gateway's clock to an operator at ``operator_rate``. ``cpu`` is the gateway's and ``own_cpu`` this
    process's, in cores; ``late`` is the most that a robot was behind its rate, in ms: above some tens the
    machine was too busy to measure on.
    """

    sent: int = 0
    seconds: float = 0.0
    delays: list[float] = field(default_factory=list)
    ages: list[float] = field(default_factory=list)
    cpu: float = 0.0
    own_cpu: float = 0.0
    late: float = 0.0
    megabytes_before: float = 0.0
    megabytes: float = 0.0


def frame(text: str | bytes) -> bytes:
    """Return a client's text frame; its mask is zero, which leaves the payload as it is."""
    payload = text.encode() if isinstance(text, str) else text
    if len(payload) < 126:
        return struct.pack("!BBI", 0x81, 0x80 | len(payload), 0) + payload
    return struct.pack("!BBHI", 0x81, 0x80 | 126, len(payload), 0) + payload


def call(method: str, params: object, id: int | None = None) -> bytes:
    """Return the frame of a JSON-RPC call."""
    value = {"jsonrpc": "2.0", "method": method, "params": params}
    return frame(json.dumps(value if id is None else {**value, "id": id}))


async def connect(plan: Plan, path: str, receive_buffer: int | None = None) -> Stream:
    """Open a WebSocket by hand."""
    sock = socket.socket()
    if receive_buffer:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    sock.setblocking(False)
    await asyncio.get_running_loop().sock_connect(sock, (plan.host, plan.port))
    reader, writer = await asyncio.open_connection(sock=sock, limit=1 << 22)
    key = base64.b64encode(os.urandom(16)).decode()
    writer.write(
        f"GET {path} HTTP/1.1\r\nHost: {plan.host}:{plan.port}\r\nUpgrade: websocket\r\n"
        f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    answer = await reader.readuntil(b"\r\n\r\n")
    if b" 101 " not in answer:
        raise ConnectionError(answer.decode(errors="replace"))
    return Stream(reader, writer)


class Stream:
    """One connection."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader, self.writer = reader, writer

    async def receive(self) -> bytes:
        """Return the payload of the next text frame; pings are answered."""
        while True:
            first, second = await self.reader.readexactly(2)
            length = second & 0x7F
            if length == 126:
                (length,) = struct.unpack("!H", await self.reader.readexactly(2))
            elif length == 127:
                (length,) = struct.unpack("!Q", await self.reader.readexactly(8))
            payload = await self.reader.readexactly(length)
            if first & 0x0F == 9:
                self.writer.write(struct.pack("!BBI", 0x8A, 0x80 | length, 0) + payload)
            elif first & 0x0F == 1:
                return payload

    async def drain_for_ever(self) -> None:
        """Read whatever comes and answer pings, as a robot with nothing to do."""
        while True:
            await self.receive()


class Swarm:
    """Runs a plan."""

    def __init__(self, plan: Plan) -> None:
        self.plan, self.seen = plan, Seen()
        self._tasks: list[asyncio.Task[None]] = []
        self._measuring = False

    async def run(self) -> Seen:
        """Bring everybody up, let them settle, measure for ``seconds``."""
        robots = [await self._robot(number) for number in range(self.plan.robots)]
        for number in range(self.plan.operators):
            operator = await self._operator(self.plan.operator_rate)
            self._start(operator.drain_for_ever() if number or not self.plan.rpc else self._age(operator))
        self._start(self._measure(await self._operator(self.plan.probe_rate)))
        stuck = [await self._operator(self.plan.operator_rate, 4096) for _ in range(self.plan.stuck)]
        for number, robot in enumerate(robots):
            self._start(self._drive(number, robot))
        await asyncio.sleep(3)
        await self._watch()
        for task in self._tasks:
            task.cancel()
        del stuck
        return self.seen

    async def _watch(self) -> None:
        cpu, start, sent = cpu_seconds(self.plan.pid), time.monotonic(), self.seen.sent
        own, self.seen.late = time.process_time(), 0.0
        self.seen.megabytes_before = megabytes_of(self.plan.pid)
        self._measuring = True
        await asyncio.sleep(self.plan.seconds)
        self._measuring = False
        self.seen.seconds = time.monotonic() - start
        self.seen.cpu = (cpu_seconds(self.plan.pid) - cpu) / self.seen.seconds
        self.seen.own_cpu = (time.process_time() - own) / self.seen.seconds
        self.seen.sent -= sent
        self.seen.megabytes = megabytes_of(self.plan.pid)

    def _start(self, work: object) -> None:
        self._tasks.append(asyncio.create_task(work))  # type: ignore[arg-type]

    async def _robot(self, number: int) -> Stream:
        stream = await connect(self.plan, f"/robot?robot=load-{number}")
        stream.writer.write(call("Ready", {"magic": number}, 1))
        self._start(stream.drain_for_ever())
        return stream

    async def _operator(self, rate: float, receive_buffer: int | None = None) -> Stream:
        stream = await connect(self.plan, "/desk", receive_buffer)
        stream.writer.write(call("hello", {"operator": "load"}, 1) + call("subscribe", {"rate": rate}, 2))
        return stream

    async def _drive(self, number: int, robot: Stream) -> None:
        interval = 1 / self.plan.rate
        due = time.monotonic() + interval * (number / self.plan.robots)
        x, step = 10.0 + number % 30, 0
        while True:
            due += interval
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            self.seen.late = max(self.seen.late, (time.monotonic() - due) * 1e3)
            step += 1
            robot.writer.write(
                frame(
                    f'{{"jsonrpc":"2.0","method":"SendPos","params":{{"x":{x + step % 50 * 0.1:.3f},'
                    f'"y":{20 + number / 1000:.3f},"theta":0.5,"v":1.0,"t":{time.time():.6f}}}}}'
                )
            )
            self.seen.sent += 1

    async def _measure(self, probe: Stream) -> None:
        newest: dict[str, float] = {}
        while True:
            payload = await probe.receive()
            now = time.time()
            if not self._measuring:
                continue
            for robot, sent in _positions(payload, self.plan.rpc):
                if sent > newest.get(robot, 0.0):
                    newest[robot] = sent
                    self.seen.delays.append((now - sent) * 1e3)

    async def _age(self, operator: Stream) -> None:
        while True:
            payload = await operator.receive()
            if self._measuring and (found := re.search(rb'"params":\{"t":([0-9.]+)', payload[:200])):
                self.seen.ages.append((time.time() - float(found.group(1))) * 1e3)


def _positions(payload: bytes, rpc: bool) -> list[tuple[str, float]]:
    value = json.loads(payload)
    if not rpc:
        return [(str(value["params"]["y"]), value["params"]["t"])] if value["method"] == "SendPos" else []
    if value.get("method") != "positions":
        return []
    robots = value["params"]["robots"]
    return [(robot["robot"], robot["device_time"]) for robot in robots if "device_time" in robot]


def cpu_seconds(pid: int) -> float:
    """Return the processor time that process ``pid`` has used."""
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:  # noqa: PTH123
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def megabytes_of(pid: int) -> float:
    """Return the memory that process ``pid`` has now."""
    with open(f"/proc/{pid}/statm", encoding="ascii") as file:  # noqa: PTH123
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    """Run the plan on the command line."""
    try:
        import uvloop

        run = uvloop.run
    except ImportError:
        run = asyncio.run
    seen = asdict(run(Swarm(Plan(**json.loads(sys.argv[1]))).run()))
    for name in ("delays", "ages"):
        times = sorted(seen.pop(name))
        seen[name] = [
            round(times[int(part * (len(times) - 1))], 1) if times else None for part in (0.5, 0.99)
        ]
    print(json.dumps(seen))


if __name__ == "__main__":
    main()
