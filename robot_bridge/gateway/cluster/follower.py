"""What gateways share in the database: looked up each second, and at once when another has changed it."""

from __future__ import annotations

import asyncio
from typing import Protocol

from ..monitoring import wait_at_most
from .exchange import Exchange
from .messages import Wake, WakeTopic

LOOK_S = 1.0
"""seconds between two looks when nobody tells of a change."""
WAKE_S = 0.02
"""seconds for which changes here wait for one another before other gateways are woken."""


class Followed(Protocol):
    """What is stored in the database, and known at each gateway."""

    async def follow(self) -> None:
        """Take in what has changed since the last look; raises StoreError."""


class Follower:
    """Has ``followed`` look for ``topic``, and other gateways where this one has changed something of it."""

    def __init__(self, topic: WakeTopic, followed: Followed, exchange: Exchange) -> None:
        self._topic: WakeTopic = topic
        self._followed = followed
        self._exchange = exchange
        self._woken = asyncio.Event()
        self._changed = asyncio.Event()
        exchange.subscribe(Wake, self._wake)

    def note_change(self) -> None:
        """Have the others look soon: something is stored that they do not know of."""
        self._changed.set()

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        waking = asyncio.create_task(self._wake_others())
        try:
            while True:
                self._woken.clear()
                await self._followed.follow()
                await wait_at_most(self._woken, LOOK_S)
        finally:
            waking.cancel()

    def _wake(self, wake: Wake) -> None:
        if wake.what == self._topic:
            self._woken.set()

    async def _wake_others(self) -> None:
        while True:
            await self._changed.wait()
            await asyncio.sleep(WAKE_S)
            self._changed.clear()
            self._exchange.wake(self._topic)
