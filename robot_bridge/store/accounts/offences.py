"""What robots' accounts do to everybody else, as the connections of this program notice it."""

from __future__ import annotations

from collections.abc import Iterable
from queue import Empty, SimpleQueue
from typing import TypeVar

T = TypeVar("T")


class Offences:
    """Robots that kept this program waiting, and backends that flooded it; used by several threads."""

    def __init__(self) -> None:
        self._blocking: SimpleQueue[str] = SimpleQueue()
        self._flooding: SimpleQueue[int] = SimpleQueue()

    def add_blocking(self, robots: Iterable[str]) -> None:
        """Note robots whose transactions were ended because this program waited for them."""
        for robot in robots:
            self._blocking.put(robot)

    def add_flood(self, backend: int) -> None:
        """Note the number of a connection that sent far more notifications than robots have reason to."""
        self._flooding.put(backend)

    def drain(self) -> tuple[list[str], list[int]]:
        """Return the robots and the backends noted since the last call, once for each offence."""
        return _drained(self._blocking), _drained(self._flooding)


def _drained(queue: SimpleQueue[T]) -> list[T]:
    found = []
    try:
        while True:
            found.append(queue.get_nowait())
    except Empty:
        return found
