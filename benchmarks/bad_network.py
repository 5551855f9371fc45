"""A network that drops a link at random moments, the same ones each time."""

from __future__ import annotations

import random
import threading

from tests.support.faults.proxy import Proxy

SEED = 6
PAUSES = (5.0, 40.0)
"""The least and the most seconds between two drops of the link."""


class BadNetwork:
    """Drops the link that leads through ``proxy``, in three ways, until it is ended.

    ``pauses`` are the least and the most seconds between two drops.
    """

    def __init__(self, proxy: Proxy, pauses: tuple[float, float] = PAUSES) -> None:
        self._proxy, self._pauses, self._chance = proxy, pauses, random.Random(SEED)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bad network")
        self.drops = {"reset": 0, "cable pulled": 0, "gateway out of reach": 0}

    def __enter__(self) -> BadNetwork:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ended.wait(self._chance.uniform(*self._pauses)):
            how = self._chance.choice(list(self.drops))
            self.drops[how] += 1
            if how == "cable pulled":
                self._proxy.stall()
                self._ended.wait(self._chance.uniform(1.0, 9.0))
            else:
                self._proxy.refuse()
                self._ended.wait(0.1 if how == "reset" else self._chance.uniform(1.0, 6.0))
            self._proxy.forward()
