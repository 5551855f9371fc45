"""Robots by the thousand in one process: ``python swarm_robots.py PLAN``, see :mod:`.swarm`.

It prints the seconds that their arrival took, and for each window that comes as a line of JSON what was sent
in it, when it is over.
"""

from __future__ import annotations

import json
import select
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, Generic, TypeVar

from benchmarks.raw_websocket import TEXT, Peer, call, frame, result

PAUSE = 0.0005
"""seconds between two looks at the clock."""
ARRIVED_WITHIN = 120.0
"""seconds."""
BETWEEN = 20
"""robots that connect before those that have come hear again."""
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


class Robot(Peer):
    """One robot: it takes its map, says where it is, and answers pings; ``arrived`` once it has the map."""

    def __init__(self, host: str, port: int, number: int, *, rpc: bool) -> None:
        super().__init__(host, port, f"/robot?robot=load-{number}")
        self._x, self._step = 10.0 + number % 30, 0
        self.number = number
        self.arrived = not rpc
        if rpc:
            self.opened()

    def opened(self) -> None:
        """Say Ready, on each connection under the same number."""
        self.send(call("Ready", {"magic": self.number}, 1))

    def tell(self) -> bool:
        """Send a position; return false when the socket takes no more."""
        self._step += 1
        message = frame(
            f'{{"jsonrpc":"2.0","method":"SendPos","params":{{"x":{self._x + self._step % 50 * 0.1:.3f},'
            f'"y":{20 + self.number / 1000:.3f},"theta":0.5,"v":1.0,"t":{time.time():.6f}}}}}'
        )
        return self.offer(message)

    def hear(self) -> None:
        """Take in what came."""
        for opcode, payload in self.received():
            if opcode == TEXT:
                self.take_text(payload)

    def take_text(self, payload: bytes) -> None:
        """Take in a message."""
        if not self.arrived:
            self._take_map(payload)

    def _take_map(self, payload: bytes) -> None:
        """Acknowledge the map, if this is it."""
        message = json.loads(payload)
        if message.get("method") == "SetMap":
            self.send(result(message["id"]))
            self.arrived = True


Kind = TypeVar("Kind", bound=Robot)


class Robots(ABC, Generic[Kind]):
    """All of them."""

    def __init__(self, plan: dict[str, Any]) -> None:
        self.robots: list[Kind] = []
        self._by_file: dict[int, Kind] = {}
        self._poll = select.epoll()
        for robot in self.make(plan):
            self.robots.append(robot)
            self.watch(robot)
            if len(self.robots) % BETWEEN == 0:
                # Who answers no pings is cut off before thousands have come.
                while self._take_in(0.0):
                    pass

    @abstractmethod
    def make(self, plan: dict[str, Any]) -> Iterator[Kind]:
        """Yield robots that have said Ready."""

    def arrive(self) -> None:
        """Hear until every robot has its map."""
        until = time.monotonic() + ARRIVED_WITHIN
        while missing := sum(not robot.arrived for robot in self.robots):
            if time.monotonic() > until:
                raise TimeoutError(f"{missing} robots have no map after {ARRIVED_WITHIN:g} s")
            self.hear(0.02)

    def hear(self, seconds: float) -> None:
        """Take in what comes for that long."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self._take_in(left)

    def _take_in(self, seconds: float) -> bool:
        """Take in what has come, or is the first to come in that time; tell whether anything did."""
        found = self._poll.poll(seconds)
        for file, events in found:
            robot = self._by_file[file]
            if events & select.EPOLLOUT:
                robot.send()
                self._poll.modify(file, select.EPOLLIN)
            if events == select.EPOLLOUT:
                continue
            try:
                robot.hear()
            except ConnectionError as error:
                self.lost(robot, error)
        return bool(found)

    def lost(self, robot: Kind, error: ConnectionError) -> None:
        """Deal with a connection that was lost; raises ``error`` where nobody is to lose one."""
        raise error

    def watch(self, robot: Kind, *, opening: bool = False) -> None:
        """Hear what comes on the connection that a robot has now, or asks for."""
        self._by_file[robot.sock.fileno()] = robot
        self._poll.register(robot.sock.fileno(), select.EPOLLIN | (select.EPOLLOUT if opening else 0))

    def do(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Do what is asked: drive."""
        return asdict(self.drive(**asked))

    def drive(self, begin: float, seconds: float, rate: float, measured: float) -> Sent:
        """Send ``rate`` messages a second of each robot, evenly, from ``begin``; what counts is from
        ``measured`` seconds on."""
        robots, sent, number = self.robots, Sent(), 0
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


class PlainRobots(Robots[Robot]):
    """Robots that say where they are, and hear nothing but their maps."""

    def make(self, plan: dict[str, Any]) -> Iterator[Robot]:
        """Yield robots that have said Ready."""
        for number in range(plan["robots"]):
            yield Robot(plan["host"], plan["port"], number, rpc=plan["rpc"])


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
        print(json.dumps(robots.do(json.loads(line))), flush=True)


if __name__ == "__main__":
    serve(PlainRobots)
