"""More robots on one link than a phone is told of one by one."""

from __future__ import annotations

import json
import threading
from typing import Any

import numpy as np
from websockets.sync.client import connect

from robot_bridge.core.position_frame import packed_frame

RUNNER = "van-7"


class Crowd:
    """Robots in rows all over the site on one link, and one that drives to and fro in its corner."""

    def __init__(self, address: str, count: int) -> None:
        self._count = count
        self.names = [f"load-{n:04}" for n in range(count)] + [RUNNER]
        self._link, self._over = connect(f"{address}/link", max_size=None), threading.Event()
        self._call("hello", {"protocol": 1, "kind": "crowd"}, 0)
        for number, name in enumerate(self.names, 1):
            self._call("Ready", {"robot": name, "magic": number, "abilities": ["targets", "paths"]}, number)
        self._threads = [threading.Thread(target=work) for work in (self._drive, self._drain)]
        for thread in self._threads:
            thread.start()

    def end(self) -> None:
        """Have all of them fall silent."""
        self._over.set()
        self._threads[0].join()
        self._link.close()
        self._threads[1].join()

    def _call(self, method: str, params: dict[str, Any], number: int) -> None:
        self._link.send(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}))

    def _drain(self) -> None:
        for _ in self._link:
            pass

    def _drive(self) -> None:
        rows, columns = np.divmod(np.arange(self._count), 40)
        x, y, steps = 5 + 4.8 * columns, 5 + 5.4 * rows, 0
        params = {"robots": self.names, "columns": ["x", "y", "theta", "v"], "words": []}
        head = json.dumps({"jsonrpc": "2.0", "method": "positions", "params": params}).encode()
        while not self._over.wait(0.5):
            steps += 1
            table = [np.append(x, 190 + steps % 10), np.append(y, 155.0), np.zeros(self._count + 1)]
            self._link.send(packed_frame(head, [*table, np.zeros(self._count + 1)]))
