"""Robots by the thousand over one link: ``python swarm_link.py PLAN``, as :mod:`.swarm_robots`.

As an adapter does it tells what is new of all robots together, every TOGETHER seconds.
"""

from __future__ import annotations

import json
import select
import struct
import time
from dataclasses import asdict
from typing import Any

from benchmarks.raw_websocket import BINARY, Peer, call, frame
from benchmarks.swarm_robots import ARRIVED_WITHIN, Sent, serve

TOGETHER = 0.05
"""seconds; that of the adapters' own client."""
COLUMNS = ["x", "y", "theta", "v", "device_time"]
HEAD, ALIGNMENT = 4, 8


class LinkRobots:
    """All of them, on one connection."""

    def __init__(self, plan: dict[str, object]) -> None:
        self._count = int(str(plan["robots"]))
        self._names = [f"load-{n}" for n in range(self._count)]
        self._peer = Peer(str(plan["host"]), int(str(plan["port"])), "/link")
        self._poll = select.poll()
        self._poll.register(self._peer.sock, select.POLLIN)
        self._let_in = 0
        self._peer.send(call("hello", {"protocol": 1, "kind": "bench"}, 0))
        for number, name in enumerate(self._names, 1):
            ready = {"robot": name, "magic": number, "abilities": ["targets", "paths"]}
            self._peer.send(call("Ready", ready, number))

    def arrive(self) -> None:
        """Hear until every robot is let in."""
        until = time.monotonic() + ARRIVED_WITHIN
        while self._let_in <= self._count:
            if time.monotonic() > until:
                raise TimeoutError(f"{self._count - self._let_in} robots are not let in")
            self.hear(0.02)

    def hear(self, seconds: float) -> None:
        """Take in what comes for that long, and send what the socket did not take."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self._peer.send()
            if self._poll.poll(left * 1000):
                self._let_in += sum(b'"result"' in payload for _, payload in self._peer.received())

    def do(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Do what is asked: drive."""
        return asdict(self.drive(**asked))

    def drive(self, begin: float, seconds: float, rate: float, measured: float) -> Sent:
        """Send ``rate`` positions a second of each robot, evenly, from ``begin``."""
        sent, number = Sent(), 0
        gap = 1 / (rate * self._count)
        self.hear(begin - time.monotonic())
        cpu = None
        while (now := time.monotonic()) < begin + seconds:
            if cpu is None and now >= begin + measured:
                cpu, sent.late = time.process_time(), 0.0
            due = min(int((now - begin) / gap) + 1, int(seconds / gap)) - number
            # Of a robot that is due twice the last counts, as with the adapters' own client.
            due = min(due, self._count)
            if due > 0:
                sent.late = max(sent.late, (now - begin - number * gap - TOGETHER) * 1e3)
                self._peer.send(frame(self._table(number, due), BINARY))
                number += due
                sent.messages += due
            self.hear(TOGETHER)
        sent.own_cpu = (time.process_time() - (cpu or 0.0)) / (seconds - measured)
        return sent

    def _table(self, first: int, due: int) -> bytes:
        rows = [(first + n) % self._count for n in range(due)]
        params = {"robots": [self._names[row] for row in rows], "columns": COLUMNS, "words": []}
        head = json.dumps({"jsonrpc": "2.0", "method": "positions", "params": params}).encode()
        length = -(-(HEAD + len(head)) // ALIGNMENT) * ALIGNMENT - HEAD
        step = (first // self._count) % 50 * 0.1
        x = [10.0 + row % 30 + step for row in rows]
        y = [20 + row / 1000 for row in rows]
        now = time.time()
        values = [*x, *y, *[0.5] * due, *[1.0] * due, *[now] * due]
        return b"".join(
            [struct.pack("<I", length), head.ljust(length), struct.pack(f"<{len(values)}d", *values)]
        )


if __name__ == "__main__":
    serve(LinkRobots)
