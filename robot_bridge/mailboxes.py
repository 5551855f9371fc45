"""The robots' mailboxes in the database: what waits for each in SA, and what they have said into RR.

A message stays in SA until its robot has read it, a request in RR until its answer is stored: what is lost on
the way is sent again.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Iterable

from . import exchange
from .commanding.book import CommandBook
from .emergency.stops import HELD_BACK, EmergencyStops
from .exchange import Outcome, Reader
from .messages import SetMap
from .robots import Robots
from .store import answers, requests
from .store.answers import AnswerRow
from .store.database import Database
from .trajectories.saving import Saving


class Mailboxes:
    """What links read and write for the robots at their other ends; coroutines raise StoreError."""

    def __init__(
        self,
        database: Database,
        robots: Robots,
        commands: CommandBook,
        emergency: EmergencyStops,
        saving: Saving,
    ) -> None:
        self._database = database
        self._robots = robots
        self._commands = commands
        self._emergency = emergency
        self._saving = saving
        self._events: dict[str, asyncio.Event] = {}
        self._changes: Counter[str] = Counter()
        self._fresh: dict[str, tuple[Reader, list[AnswerRow]]] = {}
        """what was read as an answer was written, until anything else is written for that robot."""
        self.parts: asyncio.Queue[str] = asyncio.Queue()
        """the robots for which a map of a part of the site was stored in place of the whole one."""

    def event(self, robot: str) -> asyncio.Event:
        """Return the event that is set whenever SA holds something new for the robot."""
        return self._events.setdefault(robot, asyncio.Event())

    def changed(self, robot: str) -> None:
        """Note that SA holds something new for the robot."""
        self._changes[robot] += 1
        self._fresh.pop(robot, None)
        self.event(robot).set()

    async def outbox(self, robot: str, after: int, after_urgent: int = 0) -> list[AnswerRow]:
        """Return the robot's messages as :func:`.answers.read`, without those that must not be sent now."""
        reader = robot, after, after_urgent
        read, rows = self._fresh.pop(robot, (None, []))
        if read != reader:
            rows = await self._database.read(answers.read, *reader)
        return [row for row in rows if row.op not in HELD_BACK] if self._emergency.in_force else rows

    async def hand_over(self, robot: str, id: int) -> bool:
        """Note that message ``id`` of SA is about to be sent to its robot; false where it must not be."""
        return await self._commands.hand_over(robot, id)

    async def delivered(self, ids: Iterable[int]) -> None:
        """Note that messages of SA have reached their robots."""
        await self._commands.delivered(ids)

    async def delivered_by_deletion(self, link: str) -> None:
        """Note the messages that the robots of ``link`` have read and deleted from SA themselves."""
        sent = self._undelivered(link)
        if sent:
            await self._commands.delivered(sent - await self._database.run(answers.waiting, sorted(sent)))

    async def take_up(self) -> int:
        """Take note of what waits in RR from before it was read; return the id of the newest of it.

        Acknowledgements among that may have been dealt with already: their commands are judged by positions
        that come after them alone.
        """
        # Only what concerns a command with a step to come: of other robots nothing is read here.
        waiting = sorted(self._commands.robots())
        newest, acknowledged = await self._database.read(requests.backlog, waiting)
        for robot, ids in acknowledged.items():
            for id in ids:
                self._commands.await_again(robot, id)
        return newest

    async def look(self, link: str) -> list[requests.RequestRow]:
        """Return the oldest requests in RR, which stay there until :meth:`finish`; note what was read."""
        sent = self._undelivered(link)
        rows, waiting = await self._database.read(exchange.look, sorted(sent))
        if rows and (late := self._undelivered(link) - sent):
            # Sent while the database looked; its acknowledgement may be among the rows already.
            sent |= late
            waiting |= await self._database.read(answers.waiting, sorted(late))
        if sent - waiting:
            await self._commands.delivered(sent - waiting)
        return rows

    async def finish(
        self, outcomes: list[Outcome], request_ids: list[int], *, acks: bool, reader: Reader | None = None
    ) -> None:
        """Write the answers of requests into SA, with their OpAcks if ``acks``, and delete them from RR.

        One transaction, with the positions that they told: a request is either answered and gone, or will be
        dealt with again. A robot that said Ready is stored before. ``reader`` is the robot of a single
        outcome, whose connection then sends the answer without reading SA once more.
        """
        fresh = None
        if outcomes or request_ids:
            rows = exchange.rows_of(outcomes, acks=acks)
            if admitted := {outcome.robot for outcome in outcomes if outcome.admitted}:
                # Together: one by one, the Readys of a whole fleet outlast a gateway that is killed soon.
                await self._saving.save(*admitted)
            if request_ids:
                # A request whose answer a power cut undid is there again, and is dealt with again.
                # It may have waited for long: where the robot was then must not be in memory alone.
                await self._saving.jot_with(exchange.finish, outcomes, rows, request_ids)
            elif not all(isinstance(one.answer, SetMap) and not one.admitted for one in outcomes):
                await self._database.run(exchange.finish, outcomes, rows, request_ids, [])
            # A map that a power cut undoes is sent again: the robot says Ready on its next connection.
            elif reader is None:
                await self._database.jot(exchange.finish, outcomes, rows, request_ids, [])
            else:
                changes = self._changes[reader[0]]
                read = await self._database.jot(exchange.finish_and_read, outcomes, rows, reader)
                # Whatever else was written for it meanwhile may not be among that.
                fresh = (reader, read) if self._changes[reader[0]] == changes else None
        for outcome in outcomes:
            if outcome.answer is not None:
                self.changed(outcome.robot)
            if outcome.part:
                self.parts.put_nowait(outcome.robot)
        if fresh is not None:
            self._fresh[fresh[0][0]] = fresh

    def _undelivered(self, link: str) -> set[int]:
        return {
            id
            for id, robot in self._commands.undelivered().items()
            if robot in self._robots and self._robots.get(robot).link == link
        }
