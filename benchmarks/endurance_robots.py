"""Robots that live for as long as the process: ``python endurance_robots.py HOST PORT NUMBER``.

Each circles about a place of its own and says where it is, between once and ten times a second. It acts on
what it is sent: it drives to a target or along a path, or gives up and circles again. It prints ``ready``
when all are connected.
"""

from __future__ import annotations

import heapq
import json
import math
import select
import sys
import time
from collections.abc import Sequence
from typing import Any

from benchmarks.raw_websocket import PING, TEXT, Inbox, call, connect, frame, pong

AREA = (8.0, 8.0, 192.0, 152.0)
"""x_min, y_min, x_max, y_max of the sample site, metres, in which they circle."""
RADIUS = 0.9
"""Metres: two neighbours of a thousand never come so close that it would be an alarm."""
SPEED = 1.2
"""m/s."""
STAYS = 4.0
"""Seconds that a robot stands at its target before it circles again."""
SILENT_EVERY, SILENT = 50, 15.0
"""Every so many-th robot falls silent for so many seconds of each two minutes."""
PAUSE = 0.002
"""Seconds between two looks at the clock."""

Place = tuple[float, float]


class Body:
    """Where a robot is: on its circle, or on its way along places to drive to."""

    def __init__(self, home: Place, phase: float) -> None:
        self._home, self._phase = home, phase
        self._way: list[Place] = []
        self._stays_until = 0.0
        self._at = 0.0
        self.x, self.y, self.theta, self.v = *home, 0.0, 0.0

    def drive(self, places: Sequence[Place]) -> None:
        """Go along ``places``, metres in the site frame."""
        self._way = list(places)
        self._stays_until = 0.0

    def give_up(self) -> None:
        """Go nowhere any more."""
        self._way = []
        self._stays_until = 0.0

    def go_on(self, now: float) -> None:
        """Be where it is at ``now``."""
        step = min(2.0, now - self._at) * SPEED if self._at else 0.0
        self._at = now
        if self._way:
            self._go_to(self._way[0], step, now)
        elif now < self._stays_until:
            self.v = 0.0
        else:
            angle = self._phase + now * SPEED / RADIUS
            goal = (self._home[0] + RADIUS * math.cos(angle), self._home[1] + RADIUS * math.sin(angle))
            self._go_to(goal, step, now)

    def _go_to(self, goal: Place, step: float, now: float) -> None:
        dx, dy = goal[0] - self.x, goal[1] - self.y
        left = math.hypot(dx, dy)
        if left > 1e-6:
            self.theta = math.atan2(dy, dx)
        if left > step:
            self.x += dx / left * step
            self.y += dy / left * step
            self.v = SPEED
            return
        (self.x, self.y), self.v = goal, SPEED
        if self._way:
            del self._way[0]
            if not self._way:
                self.v, self._stays_until = 0.0, now + STAYS


class Robot:
    """One robot and its wire, which it opens anew when the gateway has closed it."""

    def __init__(self, host: str, port: int, number: int, home: Place) -> None:
        self.every = 1.0 / (1 + number % 10)
        self._host, self._port, self._number = host, port, number
        self._body = Body(home, number * 2.4)
        self.connect()

    @property
    def is_away(self) -> bool:
        """Whether its wire is closed."""
        return self.sock.fileno() < 0

    def connect(self) -> None:
        """Open the wire and say that it is ready.

        :raises ConnectionError: when the gateway does not take it.
        """
        self.sock = connect(self._host, self._port, f"/robot?robot=robot-{self._number:04d}")
        self._inbox = Inbox()
        self._left = b""
        self._send(call("Ready", {"magic": self._number + 1}, 1))

    def tell(self, now: float) -> None:
        """Say where it is, unless it is a silent one."""
        body = self._body
        body.go_on(now)
        if self._number % SILENT_EVERY == 0 and (now + self._number) % 120.0 < SILENT:
            return
        pose = {"x": round(body.x, 3), "y": round(body.y, 3), "theta": round(body.theta, 4), "v": body.v}
        told = {"battery": round(0.9 - self._number % 60 / 100, 2), "accuracy": 0.05, "t": time.time()}
        self._send(call("SendPos", {**pose, **told}))

    def hear(self) -> bool:
        """Take in what came, and do it; false when the gateway has closed the wire."""
        try:
            data = self.sock.recv(1 << 16)
        except ConnectionError:
            data = b""
        if not data:
            return False
        for opcode, payload in self._inbox.take(data):
            if opcode == PING:
                self._send(pong(payload))
            elif opcode == TEXT:
                self._obey(json.loads(payload))
        return True

    def _obey(self, message: dict[str, Any]) -> None:
        params = message.get("params") or {}
        match message.get("method"):
            case "SetPosEnd":
                self._body.drive([(params["x"], params["y"])])
            case "SetPath":
                self._body.drive([(x, y) for x, y in params["points"]])
            case "Abort":
                self._body.give_up()
        if "method" in message and message.get("id") is not None:
            self._send(frame(json.dumps({"jsonrpc": "2.0", "id": message["id"], "result": {}})))

    def _send(self, message: bytes) -> None:
        """Send a frame; what the socket does not take now goes first the next time."""
        self._left += message
        try:
            self._left = self._left[self.sock.send(self._left) :]
        except (BlockingIOError, ConnectionError):
            # A wire that is closed is seen when it is read.
            return


def homes(number: int) -> list[Place]:
    """Return ``number`` places on a grid in AREA."""
    x_min, y_min, x_max, y_max = AREA
    columns = math.ceil(math.sqrt(number * (x_max - x_min) / (y_max - y_min)))
    rows = math.ceil(number / columns)
    dx, dy = (x_max - x_min) / columns, (y_max - y_min) / rows
    return [(x_min + (k % columns + 0.5) * dx, y_min + (k // columns + 0.5) * dy) for k in range(number)]


class Crowd:
    """All of them, in one thread."""

    def __init__(self) -> None:
        self._poll = select.epoll()
        self._by_file: dict[int, Robot] = {}

    def add(self, robot: Robot) -> None:
        """Listen to a robot's wire, too."""
        self._by_file[robot.sock.fileno()] = robot
        self._poll.register(robot.sock.fileno(), select.EPOLLIN)

    def hear(self, seconds: float) -> None:
        """Take in what comes, waiting for so long at most."""
        for file, _ in self._poll.poll(seconds):
            robot = self._by_file[file]
            if not robot.hear():
                del self._by_file[file]
                self._poll.unregister(file)
                robot.sock.close()
                self._open_anew(robot)

    def _open_anew(self, robot: Robot) -> None:
        """Connect a robot again; where the gateway has no time for it, that is tried at its next position."""
        try:
            robot.connect()
        except ConnectionError:
            return
        self.add(robot)

    def live(self) -> None:
        """Let them tell where they are until the process is ended."""
        robots = list(self._by_file.values())
        now = time.monotonic()
        due = [(now + robot.every * k / len(robots), k) for k, robot in enumerate(robots)]
        heapq.heapify(due)
        while True:
            self.hear(PAUSE)
            now = time.monotonic()
            while due[0][0] <= now:
                at, k = due[0]
                if robots[k].is_away:
                    self._open_anew(robots[k])
                if not robots[k].is_away:
                    robots[k].tell(now)
                # After a hold-up it goes on from now: nobody wants old positions all at once.
                heapq.heapreplace(due, (max(at + robots[k].every, now), k))


def main() -> None:
    """Connect them all and let them live."""
    host, port, number = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    crowd = Crowd()
    for k, home in enumerate(homes(number)):
        crowd.add(Robot(host, port, k, home))
        # The first ones have pings to answer while the last ones connect.
        crowd.hear(0.0)
    print("ready", flush=True)
    crowd.live()


if __name__ == "__main__":
    main()
