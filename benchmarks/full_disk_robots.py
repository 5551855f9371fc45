"""Robots of a day on a full disk: ``python full_disk_robots.py HOST PORT NUMBER RATE OBJECTS_EVERY``.

Each drives round on a circle and says where it is at RATE Hz, and every OBJECTS_EVERY seconds that it saw
something. It stands for a moment when it is told to abort. The process prints ``ready`` when every robot has
its map, and for each line that it is told one of JSON: what robots heard and said until then.
"""

from __future__ import annotations

import contextlib
import heapq
import json
import math
import select
import sys
import time
from typing import Any

from benchmarks.raw_websocket import TEXT, Peer, call, result

COLUMNS, FIRST, APART, RADIUS = 10, (12.0, 12.0), 14.0, 3.0
"""robots in a row; metres: the middle of the first circle, from one to the next, and the radius."""
TURN = 0.2
"""radians from one position to the next: more than half a metre, all of which are worth storing."""
STANDS_S = 1.0
ARRIVED_WITHIN = 120.0


class Robot(Peer):
    """One robot and its wire."""

    def __init__(self, host: str, port: int, number: int) -> None:
        self.name = f"full-{number:02d}"
        row, column = divmod(number, COLUMNS)
        self._middle = FIRST[0] + column * APART, FIRST[1] + row * APART
        self._angle, self._stands_until = float(number), 0.0
        self._number, self._objects = number, 0
        self.has_map, self.lost = False, 0
        self.positions = 0
        self.said = 0
        self.answers = {"accepted": 0, "refused": 0}
        self.aborts: list[float] = []
        self.driven: list[str] = []
        super().__init__(host, port, f"/robot?robot={self.name}")

    def open(self) -> None:
        """Connect and say that it is ready.

        :raises ConnectionError: when the gateway does not take it.
        """
        super().open()
        self.send(call("Ready", {"magic": self._number + 1}, 1))

    def drive(self, now: float) -> None:
        """Say where it is."""
        stands = now < self._stands_until
        self._angle += 0.0 if stands else TURN
        place = [
            round(m + RADIUS * f(self._angle), 3)
            for m, f in zip(self._middle, (math.cos, math.sin), strict=True)
        ]
        theta = round(math.remainder(self._angle + math.pi / 2, math.tau), 4)
        pose = {"x": place[0], "y": place[1], "theta": theta, "v": 0.0 if stands else 1.0}
        # It is not said where the gateway does not read as fast: nobody wants old positions.
        with contextlib.suppress(ConnectionError):
            self.positions += self.offer(call("SendPos", pose))

    def see(self) -> None:
        """Say that it saw something."""
        self._objects += 1
        self.said += 1
        seen = {"x": self._middle[0], "y": self._middle[1], "object": "cone", "source": str(self._objects)}
        self.send(call("SetObject", seen, 1000 + self._objects))

    def hear(self) -> None:
        """Take in what came, and answer it."""
        for opcode, payload in self.received():
            if opcode == TEXT:
                self._hear(json.loads(payload))

    def _hear(self, message: dict[str, Any]) -> None:
        method, id = message.get("method"), message.get("id")
        if method is None:
            if isinstance(id, int) and id > 1000:
                self.answers["refused" if "error" in message else "accepted"] += 1
            return
        if method == "Abort":
            self.aborts.append(time.monotonic())
            self._stands_until = time.monotonic() + STANDS_S
        elif method in ("SetPosEnd", "SetPath"):
            self.driven.append(str(id))
        self.has_map = self.has_map or method == "SetMap"
        if id is not None:
            self.send(result(id))


class Crowd:
    """All of them, in one thread."""

    def __init__(self, host: str, port: int, number: int) -> None:
        self._poll = select.epoll()
        self._robots = [Robot(host, port, k) for k in range(number)]
        self._by_file: dict[int, Robot] = {}
        for robot in self._robots:
            self._add(robot)
        self._poll.register(sys.stdin.fileno(), select.EPOLLIN)

    def arrive(self) -> None:
        """Return when every robot has its map."""
        until = time.monotonic() + ARRIVED_WITHIN
        while not all(robot.has_map for robot in self._robots):
            if time.monotonic() > until:
                sys.exit("full_disk_robots: not every robot was sent its map")
            self._listen(0.1)

    def live(self, rate: float, objects_every: float) -> None:
        """Drive until standard input ends."""
        now, gap = time.monotonic(), 1.0 / rate
        due = [(now + gap * k / len(self._robots), k, False) for k in range(len(self._robots))]
        due += [
            (now + objects_every * (k + 1) / len(self._robots), k, True) for k in range(len(self._robots))
        ]
        heapq.heapify(due)
        while self._listen(max(0.0, due[0][0] - time.monotonic())):
            now = time.monotonic()
            # Not all that is due at once: what came has its turn in between.
            for _ in range(len(self._robots)):
                at, k, sees = due[0]
                if at > now:
                    break
                if not self._open_anew(self._robots[k]):
                    pass
                elif sees:
                    self._robots[k].see()
                else:
                    self._robots[k].drive(now)
                heapq.heapreplace(due, (max(at + (objects_every if sees else gap), now), k, sees))

    def _listen(self, seconds: float) -> bool:
        for file, _ in self._poll.poll(seconds):
            if (robot := self._by_file.get(file)) is not None:
                self._hear(file, robot)
            elif not sys.stdin.readline():
                return False
            else:
                print(json.dumps(self._seen()), flush=True)
        return True

    def _add(self, robot: Robot) -> None:
        self._by_file[robot.sock.fileno()] = robot
        self._poll.register(robot.sock.fileno(), select.EPOLLIN)

    def _hear(self, file: int, robot: Robot) -> None:
        try:
            robot.hear()
        except ConnectionError:
            robot.lost += 1
            self._poll.unregister(file)
            del self._by_file[file]
            robot.sock.close()

    def _open_anew(self, robot: Robot) -> bool:
        """Tell whether a robot is connected; one that is not tries it, at each of its positions."""
        if robot.sock.fileno() < 0:
            try:
                robot.open()
            except ConnectionError:
                robot.sock.close()
                return False
            self._add(robot)
        return True

    def _seen(self) -> dict[str, Any]:
        robots = self._robots
        return {
            "positions": sum(robot.positions for robot in robots),
            "said": sum(robot.said for robot in robots),
            "lost": sum(robot.lost for robot in robots),
            "answers": {kind: sum(robot.answers[kind] for robot in robots) for kind in robots[0].answers},
            "aborts": {robot.name: robot.aborts for robot in robots},
            "driven": {robot.name: robot.driven for robot in robots},
        }


def main() -> None:
    """Connect them all and let them live."""
    host, port, number, rate, objects_every = sys.argv[1:]
    crowd = Crowd(host, int(port), int(number))
    crowd.arrive()
    print("ready", flush=True)
    crowd.live(float(rate), float(objects_every))


if __name__ == "__main__":
    main()
