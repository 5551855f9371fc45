"""Robots held while what concerns them is stored; what may have been stored or not is looked up first."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable
from typing import Any, TypeVar

from ..errors import UncertainError
from ..store.database import Database

T = TypeVar("T")


class RobotLocks:
    """A lock for each robot, by name."""

    def __init__(self) -> None:
        self._locks: dict[str, asyncio.Lock] = {}

    @contextlib.asynccontextmanager
    async def of(self, names: Iterable[str]) -> AsyncIterator[None]:
        """Hold some robots, in the one order in which everybody does."""
        async with contextlib.AsyncExitStack() as stack:
            for name in sorted(set(names)):
                await stack.enter_async_context(self._locks.setdefault(name, asyncio.Lock()))
            yield


class HeldRobots:
    """Robots by name, each held by one at a time: what concerns one waits only for what concerns the same.

    Once a transaction may have been done or not, ``look_up`` finds out what holds before anything else is
    done with any robot; it raises StoreError where it cannot, and is asked again then.
    """

    def __init__(self, database: Database, look_up: Callable[[], Awaitable[None]]) -> None:
        self._database = database
        self._look_up = look_up
        self._locks = RobotLocks()
        self._doubts = self._settled = 0

    @property
    def are_in_doubt(self) -> bool:
        """Whether nobody knows what holds."""
        return self._doubts > self._settled

    @contextlib.asynccontextmanager
    async def of(self, names: Iterable[str]) -> AsyncIterator[None]:
        """Hold some robots, in the one order in which everybody does; none only looks up what is in doubt."""
        async with self._locks.of(names):
            if self.are_in_doubt:
                before = self._doubts
                await self._look_up()
                # What came into doubt meanwhile may not have been seen.
                self._settled = max(self._settled, before)
            yield

    async def run(self, work: Callable[..., T], *arguments: Any) -> T:
        """Run ``work`` in a transaction; raises StoreError, and UncertainError when it may have been done."""
        try:
            return await self._database.run(work, *arguments)
        except UncertainError:
            self._doubts += 1
            raise
