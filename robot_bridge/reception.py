"""Robots that say Ready: let in, told what they are to know, or refused as a second one of their name."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from .commanding.book import CommandBook
from .emergency.stops import EmergencyStops
from .exchange import Outcome
from .handshake import Holds, refusal
from .mailboxes import Mailboxes
from .messages import OpAck, Ready, SetMap, Start
from .robots import Robots
from .served_site import ServedSite
from .store import facts
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
        self._saving = saving
        self._database = database
        self._clock = clock
        self._database_id = ""
        self._greeting: dict[str, asyncio.Lock] = {}

    async def restore(self) -> None:
        """Learn the name of the database, which robots are greeted with; raises StoreError."""
        self._database_id = await self._database.run(facts.database_id)

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
            await self._let_in(robot, link, request.magic)
            content = await asyncio.to_thread(self._site.whole_map)
            ack = OpAck(id=id, magic=request.magic, robot=robot, database=self._database_id)
            return Outcome(robot, ack, SetMap(content), void=("Start", "OpAck"))

    async def _let_in(self, robot: str, link: str, magic: int) -> None:
        if starts_anew := self._robots.starts_anew(robot, magic):
            # Before it is known by its new number: after a failure it must be seen to start anew once more.
            await self._mailboxes.delivered_by_deletion(self._robots.get(robot).link)
            reason = f"robot {robot} started anew; sent once more"
            await self._commands.deliver_again(robot, reason, self._site.settings.commands.expire_after_s)
        self._robots.ready(robot, magic, link, self._clock())
        self._saving.touch(robot)
        if starts_anew:
            # Not only with its answer: should the gateway die until then, it has not started anew once more.
            await self._saving.save(robot)
        await self._emergency.ready(robot)

    async def _refusal(self, robot: str, magic: int) -> str | None:
        if robot not in self._robots:
            return None
        known, limit = self._robots.get(robot), self._site.report.stale_after
        return await refusal(known, magic, self._clock() - known.received_at, limit, self.holds)
