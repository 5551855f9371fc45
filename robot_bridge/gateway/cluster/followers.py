"""Followers: read what other gateways stored, on changes and at intervals.

The beat of a gateway carries, for each kind, the number of its last stored change. A receiver of the same
number has missed none. So a database check is due when a number changes; each second while a living gateway
is silent; and every ten, for changes made by others than gateways.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import secrets
from collections.abc import Mapping
from typing import Protocol

from ...core.logs import log_and_continue
from ..monitoring import until_tick, wait_at_most
from .bus import EVERYBODY
from .membership import Membership
from .messages import Beat, Exchange, Wake, WakeTopic

log = logging.getLogger(__name__)

LOOK_S = 1.0
"""seconds between checks while it is unknown whether anything has changed."""
ANYWAY_S = 10.0
"""seconds after which a check is made though no gateway has changed anything."""
BEAT_HOLDS_S = 2.5
"""seconds for which a beat counts: one or two of the next may be late."""
WAKE_S = 0.02
"""seconds for which changes here are collected before other gateways are woken."""
APART_S = 0.05
"""minimum seconds between checks: in an emergency stop others announce changes without a pause."""


class ChangeNumbers:
    """The number of the last change of each kind at each gateway."""

    def __init__(self, exchange: Exchange, membership: Membership) -> None:
        self._exchange = exchange
        self._membership = membership
        # Random start, so that no number of a run is one of the run before.
        self._numbers = itertools.count(1 + secrets.randbits(48))
        self._own: dict[str, int] = {}
        self._beats: dict[str, Beat] = {}
        exchange.subscribe(Beat, self._receive)

    def add_change(self, topic: WakeTopic) -> None:
        """Number a stored change of this gateway."""
        self._own[topic] = next(self._numbers)

    def send_beat(self) -> None:
        """Send that this gateway is alive, and its last changes."""
        beat = Beat(self._exchange.gateway, self._membership.database_time(), dict(self._own))
        self._exchange.send(EVERYBODY, beat)

    def newest(self, topic: WakeTopic) -> Mapping[str, int] | None:
        """Return the number of the newest change at each living gateway, this one included.

        None if one of them has not sent it of late: it may have changed anything.
        """
        after = self._membership.database_time() - BEAT_HOLDS_S
        found = {self._exchange.gateway: self._own.get(topic, 0)}
        for gateway in self._membership.others():
            beat = self._beats.get(gateway)
            if beat is None or beat.changes is None or beat.t < after:
                return None
            found[gateway] = beat.changes.get(topic, 0)
        return found

    def _receive(self, beat: Beat) -> None:
        self._beats[beat.gw] = beat


class LookSchedule:
    """Decides when to check for changes of a kind."""

    def __init__(self, topic: WakeTopic, numbers: ChangeNumbers) -> None:
        self._topic: WakeTopic = topic
        self._numbers = numbers
        self._known: Mapping[str, int] | None = None
        self._begun_at = 0.0

    def begin_look(self) -> None:
        """Record that a check begins: it finds all changes until now."""
        self._known, self._begun_at = self._numbers.newest(self._topic), asyncio.get_running_loop().time()

    @property
    def is_due(self) -> bool:
        """Whether something may have changed since the last check began."""
        newest = self._numbers.newest(self._topic)
        looked = asyncio.get_running_loop().time() - self._begun_at
        return newest is None or newest != self._known or looked >= ANYWAY_S


class Followed(Protocol):
    """Data stored in the database, and known at each gateway."""

    @property
    def goes_on(self) -> bool:
        """Whether it may change though no gateway stores anything: then it is checked each second."""

    async def follow(self) -> None:
        """Apply the changes since the last check; raises StoreError."""


class Follower:
    """Has ``followed`` check for changes of ``topic``, and wakes other gateways on changes here."""

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
        exchange.subscribe(Wake, self._receive)

    def note_change(self) -> None:
        """Have other gateways check soon: a change is stored that they do not know of."""
        self._numbers.add_change(self._topic)
        self._changed.set()

    def wake(self) -> None:
        """Have a check made soon."""
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
            await wait_at_most(self._woken, until_tick(LOOK_S))
            if self._schedule.is_due or self._followed.goes_on:
                return

    def _receive(self, wake: Wake) -> None:
        if wake.what == self._topic:
            self._woken.set()

    async def _wake_others(self) -> None:
        while True:
            await self._changed.wait()
            await asyncio.sleep(WAKE_S)
            self._changed.clear()
            # Nobody awaits this task: after an error no gateway would be woken any more.
            with log_and_continue(log, "waking other gateways for %s", self._topic):
                self._exchange.wake(self._topic)
