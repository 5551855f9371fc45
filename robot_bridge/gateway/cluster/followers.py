"""Followers: what other gateways stored is looked up when it has changed, and once in a while.

The beat of a gateway says by a number of each kind which change it stored last. Who hears the same number
again has missed none. So a look in the database is due when a number is another one; each second while a
living gateway is not heard; and every ten, for what others than gateways change.
"""

from __future__ import annotations

import asyncio
import itertools
import secrets
from collections.abc import Mapping
from typing import Protocol

from ..monitoring import wait_at_most
from .bus import EVERYBODY
from .membership import Membership
from .messages import Beat, Exchange, Wake, WakeTopic

LOOK_S = 1.0
"""seconds between two looks while it is not known whether anything has changed."""
ANYWAY_S = 10.0
"""seconds after which somebody looks though no gateway has changed anything."""
BEAT_HOLDS_S = 2.5
"""seconds for which a beat counts: one or two of the next may be late."""
WAKE_S = 0.02
"""seconds for which changes here wait for one another before other gateways are woken."""
APART_S = 0.05
"""seconds between two looks at least: in an emergency stop others tell of changes without a pause."""


class ChangeNumbers:
    """The number of the change of each kind that each gateway stored last."""

    def __init__(self, exchange: Exchange, membership: Membership) -> None:
        self._exchange = exchange
        self._membership = membership
        # At random, so that no number of a run is one of the run before.
        self._numbers = itertools.count(1 + secrets.randbits(48))
        self._own: dict[str, int] = {}
        self._beats: dict[str, Beat] = {}
        exchange.subscribe(Beat, self._hear)

    def add_change(self, topic: WakeTopic) -> None:
        """Give a number to a change of this gateway, which is stored."""
        self._own[topic] = next(self._numbers)

    def send_beat(self) -> None:
        """Say that this gateway is there, and what it changed last."""
        beat = Beat(self._exchange.gateway, self._membership.database_time(), dict(self._own))
        self._exchange.send(EVERYBODY, beat)

    def newest(self, topic: WakeTopic) -> Mapping[str, int] | None:
        """Return the number of the newest change at each gateway that lives, this one included.

        None where one of them has not said of late: it may have changed anything.
        """
        after = self._membership.database_time() - BEAT_HOLDS_S
        found = {self._exchange.gateway: self._own.get(topic, 0)}
        for gateway in self._membership.others():
            beat = self._beats.get(gateway)
            if beat is None or beat.changes is None or beat.t < after:
                return None
            found[gateway] = beat.changes.get(topic, 0)
        return found

    def _hear(self, beat: Beat) -> None:
        self._beats[beat.gw] = beat


class LookSchedule:
    """When it is time to look for changes of a kind."""

    def __init__(self, topic: WakeTopic, numbers: ChangeNumbers) -> None:
        self._topic: WakeTopic = topic
        self._numbers = numbers
        self._known: Mapping[str, int] | None = None
        self._begun_at = 0.0

    def begin_look(self) -> None:
        """Note that a look begins: it will find what was changed until now."""
        self._known, self._begun_at = self._numbers.newest(self._topic), asyncio.get_running_loop().time()

    @property
    def is_due(self) -> bool:
        """Whether something may have changed since the last look began."""
        newest = self._numbers.newest(self._topic)
        looked = asyncio.get_running_loop().time() - self._begun_at
        return newest is None or newest != self._known or looked >= ANYWAY_S


class Followed(Protocol):
    """What is stored in the database, and known at each gateway."""

    @property
    def goes_on(self) -> bool:
        """Whether it may change though no gateway stores anything: then it is looked at each second."""

    async def follow(self) -> None:
        """Take in what has changed since the last look; raises StoreError."""


class Follower:
    """Has ``followed`` look for ``topic``, and other gateways where this one has changed something of it."""

    def __init__(
        self,
        topic: WakeTopic,
        followed: Followed,
        exchange: Exchange,
        numbers: ChangeNumbers,
    ) -> None:
        self._topic: WakeTopic = topic
        self._followed = followed
        self._exchange = exchange
        self._numbers = numbers
        self._schedule = LookSchedule(topic, numbers)
        self._woken = asyncio.Event()
        self._changed = asyncio.Event()
        exchange.subscribe(Wake, self._hear)

    def note_change(self) -> None:
        """Have the others look soon: something is stored that they do not know of."""
        self._numbers.add_change(self._topic)
        self._changed.set()

    def wake(self) -> None:
        """Look soon."""
        self._woken.set()

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        waking = asyncio.create_task(self._wake_others())
        try:
            while True:
                self._woken.clear()
                self._schedule.begin_look()
                await self._followed.follow()
                await asyncio.sleep(APART_S)
                await self._wait_until_due()
        finally:
            waking.cancel()

    async def _wait_until_due(self) -> None:
        while not self._woken.is_set():
            await wait_at_most(self._woken, LOOK_S)
            if self._schedule.is_due or self._followed.goes_on:
                return

    def _hear(self, wake: Wake) -> None:
        if wake.what == self._topic:
            self._woken.set()

    async def _wake_others(self) -> None:
        while True:
            await self._changed.wait()
            await asyncio.sleep(WAKE_S)
            self._changed.clear()
            self._exchange.wake(self._topic)
