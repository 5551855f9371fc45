"""Robots by the thousand in one process: ``python swarm_robots.py PLAN``, see :mod:`.swarm`.

It prints the seconds that their arrival took, and for each window that comes as a line of JSON what was sent
in it, when it is over.
"""

from __future__ import annotations

import json
import select
import sys
import time
from dataclasses import asdict, dataclass
from typing import Any

from benchmarks.raw_websocket import PING, Inbox, call, connect, frame, pong, result

PAUSE = 0.0005
"""seconds between two looks at the clock."""
ARRIVED_WITHIN = 120.0
"""seconds."""
AT_ONCE = 200
"""messages before robots hear again, however late they are."""


@dataclass
class Sent:
    """What was sent in a window: messages, those that the sockets did not take, the most that one was late in
    milliseconds, and what this process used of a core."""

    messages: int = 0
    held_back: int = 0
    late: float = 0.0
    own_cpu: float = 0.0


class Robot:
    """One robot: it takes its map, says where it is, and answers pings; ``arrived`` once it has the map."""

    def __init__(self, host: str, port: int, number: int, *, rpc: bool) -> None:
        self.sock = connect(host, port, f"/robot?robot=load-{number}")
        self._inbox = Inbox()
        self._left = b""
        self._x, self._step = 10.0 + number % 30, 0
        self._number = number
        self.arrived = not rpc
        if rpc:
            self.sock.sendall(call("Ready", {"magic": number}, 1))

    def tell(self) -> bool:
        """Send a position; return false when the socket takes no more."""
        self._step += 1
        message = frame(
            f'{{"jsonrpc":"2.0","method":"SendPos","params":{{"x":{self._x + self._step % 50 * 0.1:.3f},'
            f'"y":{20 + self._number / 1000:.3f},"theta":0.5,"v":1.0,"t":{time.time():.6f}}}}}'
        )
        return self._send(message)

    def _send(self, message: bytes) -> bool:
        """Send a frame, or return false where the socket does not take it."""
        try:
            self._left = self._left[self.sock.send(self._left) :] if self._left else b""
            if not self._left:
                self._left = message[self.sock.send(message) :]
                return True
        except BlockingIOError:
            pass
        return False

    def hear(self) -> None:
        """Take in what came."""
        for opcode, payload in self._inbox.take(self.sock.recv(1 << 16)):
            if opcode == PING:
                self._send(pong(payload))
            elif not self.arrived:
                self._take_map(payload)

    def _take_map(self, payload: bytes) -> None:
        """Acknowledge the map, if this is it."""
        message = json.loads(payload)
        if message.get("method") == "SetMap":
            self._send(result(message["id"]))
            self.arrived = True


class Robots:
    """All of them."""

    def __init__(self, plan: dict[str, object]) -> None:
        number = int(str(plan["robots"]))
        self._robots = [
            Robot(str(plan["host"]), int(str(plan["port"])), n, rpc=bool(plan["rpc"])) for n in range(number)
        ]
        self._poll = select.epoll()
        self._by_file = {robot.sock.fileno(): robot for robot in self._robots}
        for file in self._by_file:
            self._poll.register(file, select.EPOLLIN)

    def arrive(self) -> None:
        """Hear until every robot has its map."""
        until = time.monotonic() + ARRIVED_WITHIN
        while missing := sum(not robot.arrived for robot in self._robots):
            if time.monotonic() > until:
                raise TimeoutError(f"{missing} robots have no map after {ARRIVED_WITHIN:g} s")
            self.hear(0.02)

    def hear(self, seconds: float) -> None:
        """Take in what comes for that long."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            for file, _ in self._poll.poll(left):
                self._by_file[file].hear()

    def drive(self, begin: float, seconds: float, rate: float, measured: float) -> Sent:
        """Send ``rate`` messages a second of each robot, evenly, from ``begin``; what counts is from
        ``measured`` seconds on."""
        robots, sent, number = self._robots, Sent(), 0
        gap = 1 / (rate * len(robots))
        self.hear(begin - time.monotonic())
        cpu = None
        while (now := time.monotonic()) < begin + seconds:
            if cpu is None and now >= begin + measured:
                cpu, sent.late = time.process_time(), 0.0
            for _ in range(AT_ONCE):
                if (due := begin + number * gap) > now:
                    break
                sent.late = max(sent.late, (now - due) * 1e3)
                if robots[number % len(robots)].tell():
                    sent.messages += 1
                else:
                    sent.held_back += 1
                number += 1
                now = time.monotonic()
            self.hear(PAUSE)
        sent.own_cpu = (time.process_time() - (cpu or 0.0)) / (seconds - measured)
        return sent


def serve(kind: Any) -> None:
    """Drive robots of a ``kind`` like Robots as told on standard input, until that ends."""
    began = time.monotonic()
    robots = kind(json.loads(sys.argv[1]))
    robots.arrive()
    print(time.monotonic() - began, flush=True)
    poll = select.poll()
    poll.register(sys.stdin, select.POLLIN)
    while True:
        if not poll.poll(0):
            robots.hear(0.02)
            continue
        line = sys.stdin.readline()
        if not line:
            return
        print(json.dumps(asdict(robots.drive(**json.loads(line)))), flush=True)


if __name__ == "__main__":
    serve(Robots)
