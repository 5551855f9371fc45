"""Robots of one gateway among several, in rows over the site: ``python cluster_swarm.py PLAN``.

A robot moves on by a millimetre with each message, so that a place says when it was said: see
:class:`Schedule`. What is printed, and read, is as with :mod:`.swarm_robots`.
"""

from __future__ import annotations

import heapq
import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

import numpy as np

from benchmarks.raw_websocket import frame
from benchmarks.raw_websocket import result as call_result
from benchmarks.swarm_robots import Robot, Robots, Sent, serve
from robot_bridge.core.position_frame import POSITION_HEAD, POSITION_VALUE
from robot_bridge.core.reconnection import GatewayAddresses
from robot_bridge.gateway.fleet.emergency_stop import NAME_PREFIX

ROW, APART, CORNER = 150, 1.25, 3.0
"""robots in a row, and metres between them, from a corner of the sample site."""
NAME = "load-"
STOPPED_WITHIN = 30.0
"""seconds after which a robot that has not heard of a stop counts as not having heard."""


def home(number: int) -> tuple[float, float]:
    """Return where a robot begins: robots of following numbers stand beside each other."""
    row, column = divmod(number, ROW)
    return CORNER + column * APART, CORNER + row * APART


@dataclass(frozen=True)
class Schedule:
    """When robots say where they are: ``crowds`` processes have each ``robots`` of them, in turns, and send
    ``rate`` messages a second of each from ``begin`` on, in seconds since 1970."""

    crowds: int
    robots: int
    rate: float
    begin: float

    def robots_of(self, crowd: int) -> list[str]:
        """Return the names of the robots of a process."""
        return [f"{NAME}{number * self.crowds + crowd}" for number in range(self.robots)]

    def times(self, message: bytes) -> Iterator[tuple[str, float]]:
        """Yield when robots said what a table of positions tells of them."""
        begin = POSITION_HEAD + int.from_bytes(message[:POSITION_HEAD], "little")
        head = json.loads(message[POSITION_HEAD:begin])["params"]
        names, columns = head["robots"], head["columns"]
        if not names or "x" not in columns:
            return
        table = np.frombuffer(message, POSITION_VALUE, -1, begin).reshape(len(columns), -1)
        numbers = np.array([int(name[len(NAME) :]) for name in names])
        steps = np.rint((table[columns.index("x")] - CORNER - numbers % ROW * APART) * 1000) - 1
        turns = steps * self.robots + numbers // self.crowds
        said = self.begin + turns / (self.rate * self.robots)
        yield from (
            (name, at) for name, at, step in zip(names, said.tolist(), steps, strict=True) if step >= 0
        )


class RowRobot(Robot):
    """A robot in its row."""

    def __init__(self, host: str, port: int, number: int, *, rpc: bool) -> None:
        super().__init__(host, port, number, rpc=rpc)
        self._x, self._y = home(number)
        self.stops: dict[str, float] = {}
        """When it heard of each stop first, by the id of the call."""

    def go_home(self) -> None:
        """Begin again where it began."""
        self._step = 0

    def tell(self) -> bool:
        """Send a position; return false when the socket takes no more, or there is no gateway."""
        self._step += 1
        if not self.arrived:
            return False
        try:
            return self.offer(self._position())
        except ConnectionError:
            # Seen when it is read.
            return False

    def _position(self) -> bytes:
        return frame(
            f'{{"jsonrpc":"2.0","method":"SendPos","params":{{"x":{self._x + self._step / 1000:.3f},'
            f'"y":{self._y:.3f},"theta":0.5,"v":0.1,"t":{time.time():.6f}}}}}'
        )

    def take_text(self, payload: bytes) -> None:
        """Take in a message; note when a stop came, and acknowledge it."""
        if not self.arrived:
            super().take_text(payload)
            if self.arrived and self._step:
                # As each robot does after its Ready: it drives on meanwhile.
                self.send(self._position())
        if b'"Abort"' in payload:
            message = json.loads(payload)
            self.stops.setdefault(str(message["id"]), time.time())
            self.send(call_result(message["id"]))


class RowRobots(Robots[RowRobot]):
    """Those of one gateway: each ``stride``-th from the ``first`` on.

    Where there are other ``gateways`` they go on there when theirs has died, as the reference robot does.
    """

    def __init__(self, plan: dict[str, Any]) -> None:
        self._gateways = plan["gateways"]
        self._due: list[tuple[float, int, RowRobot]] = []
        super().__init__(plan)
        self._addresses = {robot: GatewayAddresses(self._gateways[0]) for robot in self.robots}
        for addresses in self._addresses.values():
            addresses.learn(self._gateways)

    def lost(self, robot: RowRobot, error: ConnectionError) -> None:
        """Have a robot connect again, to its gateway and then to others."""
        if len(self._gateways) == 1:
            raise error
        robot.sock.close()
        robot.arrived = False
        due = time.monotonic() + self._addresses[robot].next_wait()
        heapq.heappush(self._due, (due, robot.number, robot))

    def hear(self, seconds: float) -> None:
        """Connect those whose time has come, and take in what comes for that long."""
        while self._due and self._due[0][0] <= time.monotonic():
            robot = heapq.heappop(self._due)[-1]
            address = urlsplit(self._addresses[robot].current)
            robot.begin_open(str(address.hostname), int(address.port or 0))
            self.watch(robot, opening=True)
        super().hear(seconds)

    def drive(self, begin: float, seconds: float, rate: float, measured: float) -> Sent:
        """Send positions, from their homes on: see :class:`Schedule`."""
        for robot in self.robots:
            robot.go_home()
        return super().drive(begin, seconds, rate, measured)

    def do(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Do what is asked: drive, or say how many robots heard of a stop, when the first did, and last."""
        if "stop" not in asked:
            return super().do(asked)
        until, id = time.monotonic() + STOPPED_WITHIN, f"{NAME_PREFIX}{asked['stop']}"
        while any(id not in robot.stops for robot in self.robots) and time.monotonic() < until:
            self.hear(0.02)
        times = [robot.stops[id] for robot in self.robots if id in robot.stops]
        return {"heard": len(times), "first": min(times, default=0.0), "last": max(times, default=0.0)}

    def make(self, plan: dict[str, Any]) -> Iterator[RowRobot]:
        """Yield robots that have said Ready."""
        end = plan["first"] + plan["stride"] * plan["robots"]
        for number in range(plan["first"], end, plan["stride"]):
            yield RowRobot(plan["host"], plan["port"], number, rpc=True)


if __name__ == "__main__":
    serve(RowRobots)
