"""Robots that say Ready: let in, told what they are to know, or refused as a second one of their name."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from functools import partial

from .commanding.book import CommandBook
from .emergency.stops import EmergencyStops
from .exchange import Outcome
from .handshake import Holds, refusal
from .mailboxes import Mailboxes
from .map_sending import MapSending
from .messages import Answer, OpAck, Ready, SetMap, Start
from .robots import Robots
from .served_site import ServedSite
from .store import facts
from .store import robots as stored_robots
from .store.database import Database
from .trajectories.saving import Saving

log = logging.getLogger(__name__)


class Reception:
    """Takes robots in. ``holds`` are the connections that they hold, told by their links."""

    def __init__(
        self,
        site: ServedSite,
        robots: Robots,
        commands: CommandBook,
        emergency: EmergencyStops,
        mailboxes: Mailboxes,
        maps: MapSending,
        saving: Saving,
        database: Database,
        clock: Callable[[], float],
    ) -> None:
        self.holds = Holds()
        self._site = site
        self._robots = robots
        self._commands = commands
        self._emergency = emergency
        self._mailboxes = mailboxes
        self._maps = maps
        self._saving = saving
        self._database = database
        self._clock = clock
        self._database_id = ""
        self._greeting: dict[str, asyncio.Lock] = {}

    async def restore(self) -> None:
        """Learn the name of the database, which robots are greeted with; raises StoreError."""
        self._database_id = await self._database.run(facts.database_id)

    @property
    def database_id(self) -> str:
        """The name that tells the database from every other."""
        return self._database_id

    def greeting(self) -> Start:
        """Return what robots are told when the gateway begins to listen to them."""
        return Start(self._database_id)

    async def receive(self, robot: str, link: str, request: Ready, id: int | None) -> Outcome:
        """Let a robot in that said Ready as request ``id``, or refuse it, one of a name at a time.

        :raises StoreError: when that cannot be stored; the robot is not in then.
        """
        async with self._greeting.setdefault(robot, asyncio.Lock()):
            reason = await self._refusal(robot, request.magic)
            if reason is not None:
                log.warning("link %s: a second robot said Ready: %s", link, reason)
                return Outcome(robot, OpAck(id=id, ok=False, reason=reason, magic=request.magic))
            content, part = None, False
            if request.abilities is None or "map" in request.abilities:
                offer = await self._maps.first(robot)
                content, part = SetMap(offer.content), not offer.is_whole
            ack = OpAck(id=id, magic=request.magic, robot=robot, database=self._database_id)
            welcome: list[Answer | None] = [ack if link == "sql" else None, content]
            if await self._let_in(robot, link, request, [one for one in welcome if one is not None]):
                return Outcome(robot, ack, content, written=True, part=part)
            return Outcome(robot, ack, content, void=("Start", "OpAck"), part=part)

    async def _let_in(self, robot: str, link: str, ready: Ready, welcome: list[Answer]) -> bool:
        """Let a robot in; tell whether it starts anew, and ``welcome`` is written before all else for it."""
        if starts_anew := self._robots.starts_anew(robot, ready.magic):
            # Before it is known by its new number: after a failure it must be seen to start anew once more.
            await self._mailboxes.delivered_by_deletion(self._robots.get(robot).link)
            reason = f"robot {robot} started anew; sent once more"
            expire_after = self._site.settings.commands.expire_after_s
            # In one transaction: a gateway that dies next must not take it for one that starts anew again,
            # and send it once more what it is doing by then.
            note_run = partial(stored_robots.note_run, robot=self._robots.get(robot), magic=ready.magic)
            await self._commands.deliver_again(robot, reason, expire_after, welcome, note_run)
        self._robots.ready(robot, ready.magic, link, self._clock(), ready.paths, ready.can)
        self._saving.touch(robot)
        if starts_anew:
            await self._saving.save(robot)
        if not self._robots.is_only_seen(robot):
            await self._emergency.ready(robot)
        return starts_anew

    async def _refusal(self, robot: str, magic: int) -> str | None:
        if robot not in self._robots:
            return None
        known, limit = self._robots.get(robot), self._site.report.stale_after
        return await refusal(known, magic, self._clock() - known.received_at, limit, self.holds)
