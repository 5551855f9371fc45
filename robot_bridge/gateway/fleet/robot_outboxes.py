"""Outboxes of robots: answers into SA, requests out of RR, their outcomes, and delivery of maps."""

from __future__ import annotations

import asyncio
import logging
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from sqlalchemy import Connection

from ...core.errors import RefusedError, StoreError
from ...core.logs import TroubleNews, log_unforeseen
from ...core.messages.base import Done
from ...core.messages.commands import SendMap
from ...core.messages.robots import MOTION_OPS, Answer, OpAck, SetMap, Start
from ...core.messages.safety import RobotState
from ...core.robotmap.model import Border, EncodedMap
from ..commands.service import CommandService
from ..model.events import handles
from ..model.robots import RobotPose, Robots
from ..site.places import ServedSite
from ..storage.database import Database
from ..storage.repositories import commands, trajectories
from ..storage.repositories import requests as answers
from ..storage.repositories.requests import AnswerRow, Outbox
from ..storage.repositories.trajectories import PackedFix
from ..storage.rows import BatchedWork
from ..trajectories.recording import TrajectoryWriter
from .emergency_stop import EmergencyStops

log = logging.getLogger(__name__)

# --- Outcomes of robots' requests, and their storage: answers into SA, and requests out of RR ---

WHOLE_SITE = SetMap(b"")
"""The map of the whole site for a robot that reads no rows itself: its link has the map at hand.

The map of a city has megabytes: written, checkpointed and deleted for each robot it delays all others.
"""


@dataclass(frozen=True)
class RequestOutcome:
    """Outcome of a robot's request: its OpAck, an answer, and the kinds of older answers that are void.

    With ``written`` it is in SA already, and only the request must still be deleted. ``part``: its map is a
    part of the site, and more of it may have to follow.
    """

    robot: str
    ack: OpAck | None = None
    answer: Answer | None = None
    void: tuple[str, ...] = ()
    written: bool = False
    part: bool = False

    @property
    def admitted(self) -> bool:
        """Return whether the request was a Ready, and accepted."""
        return self.ack is not None and self.ack.ok and self.ack.magic is not None

    def rows(self, *, acks: bool) -> list[tuple[str, Answer]]:
        """Return the rows to be written into SA, the OpAck first."""
        if self.written:
            return []
        messages: list[Answer | None] = [self.ack if acks else None, self.answer]
        return [(self.robot, message) for message in messages if message is not None]

    def voided(self) -> tuple[str, ...]:
        """Return the kinds of older answers that are void, such as an older map or Start."""
        if self.written:
            return ()
        renewed = isinstance(self.answer, (SetMap, Start))
        return (*self.void, type(self.answer).__name__) if renewed else self.void


def answer_rows(outcomes: Sequence[RequestOutcome], *, acks: bool) -> list[tuple[str, Answer]]:
    """Return the rows to be written into SA, without those that a later Ready of the same robot makes void.

    A robot that repeated Ready while no gateway read it is given the map of the whole site once.
    """
    void: defaultdict[str, set[str]] = defaultdict(set)
    kept: list[tuple[str, Answer]] = []
    for outcome in reversed(outcomes):
        gone = void[outcome.robot]
        kept += [row for row in reversed(outcome.rows(acks=acks)) if type(row[1]).__name__ not in gone]
        if outcome.admitted:
            gone.update(outcome.voided())
    return kept[::-1]


def finish_requests(
    connection: Connection,
    outcomes: Sequence[RequestOutcome],
    rows: Sequence[tuple[str, Answer]],
    request_ids: Sequence[int],
    fixes: Sequence[PackedFix],
) -> None:
    """Write the outcomes of requests, and the positions of robots, and delete the requests."""
    void: defaultdict[str, set[str]] = defaultdict(set)
    for outcome in outcomes:
        void[outcome.robot].update(outcome.voided())
    answers.remove_void(connection, void)
    for outcome in outcomes:
        if request_ids and outcome.admitted and isinstance(outcome.answer, SetMap):
            # It may have used another link before, and must read the rows itself from now on.
            answers.fill_maps(connection, outcome.robot, outcome.answer.map)
    answers.add_answers(connection, rows)
    trajectories.add(connection, fixes)
    answers.remove_requests(connection, request_ids)


class _FinishCalls(BatchedWork[None]):
    """Writes the outcomes of requests that did not come through a table, without robots' positions."""

    def do_all(
        self,
        connection: Connection,
        asked: Sequence[tuple[Sequence[RequestOutcome], Sequence[tuple[str, Answer]]]],
    ) -> Sequence[None]:
        """Write the outcomes of all calls, with their rows for SA."""
        outcomes: list[RequestOutcome] = []
        rows: list[tuple[str, Answer]] = []
        for more, their_rows in asked:
            # The outcome of a robot's later request may make the answer to an earlier one void.
            if {one.robot for one in more} & {one.robot for one in outcomes}:
                finish_requests(connection, outcomes, rows, [], [])
                outcomes, rows = [], []
            outcomes += more
            rows += their_rows
        finish_requests(connection, outcomes, rows, [], [])
        return [None] * len(asked)


finish_calls = _FinishCalls()


def finish_and_read(
    connection: Connection,
    outcomes: Sequence[RequestOutcome],
    rows: Sequence[tuple[str, Answer]],
    reader: Outbox,
) -> list[AnswerRow]:
    """Write the outcomes of requests, and return the messages that then wait for one robot."""
    finish_requests(connection, outcomes, rows, [], [])
    return answers.read_answers(connection, *reader)


def read_requests(connection: Connection, sent: Sequence[int]) -> tuple[list[answers.RequestRow], set[int]]:
    """Return the oldest requests, and those of the messages ``sent`` that are still unread."""
    # In this order: a robot deletes what it read before it acknowledges it.
    rows = answers.read_requests(connection)
    return rows, answers.waiting(connection, sent)


# --- The robots' mailboxes in the database: messages for each in SA, and their requests in RR ---
# A message stays in SA until its robot has read it, a request in RR until its answer is stored: if one is
# lost on the way it is sent again.


class RobotOutboxes:
    """Mailboxes that links read and write for their robots; coroutines raise StoreError."""

    def __init__(
        self,
        database: Database,
        robots: Robots,
        commands: CommandService,
        emergency: EmergencyStops,
        saving: TrajectoryWriter,
    ) -> None:
        self._database = database
        self._robots = robots
        self._commands = commands
        self._emergency = emergency
        self._saving = saving
        self._events: dict[str, asyncio.Event] = {}
        self._changes: Counter[str] = Counter()
        self._fresh: dict[str, tuple[Outbox, list[AnswerRow]]] = {}
        """messages read when an answer was written, until anything else is written for that robot."""
        self.parts: asyncio.Queue[str] = asyncio.Queue()
        """robots for which a map of a part of the site was stored in place of the whole one."""

    def event(self, robot: str) -> asyncio.Event:
        """Return the event that is set whenever SA has something new for the robot."""
        return self._events.setdefault(robot, asyncio.Event())

    def changed(self, robot: str) -> None:
        """Record that SA has something new for the robot."""
        self._changes[robot] += 1
        self._fresh.pop(robot, None)
        self.event(robot).set()

    async def outbox(self, robot: str, after: int, after_urgent: int = 0) -> list[AnswerRow]:
        """Return the robot's messages, urgent ones first, without those held back now."""
        reader = robot, after, after_urgent
        read, rows = self._fresh.pop(robot, (None, []))
        if read != reader:
            rows = await self._database.read(answers.read_outbox, *reader)
        return [row for row in rows if row.op not in MOTION_OPS] if self._emergency.in_force else rows

    async def waiting_aborts(self, robot: str, after: int, after_urgent: int) -> set[int]:
        """Return the ids of the Aborts among the robot's messages that :meth:`outbox` would return."""
        return await self._database.read(answers.waiting_aborts, robot, after, after_urgent)

    async def mark_sending(self, robot: str, id: int) -> bool:
        """Record that message ``id`` of SA is about to be sent to its robot; false if it must not be."""
        return await self._commands.mark_sending(robot, id)

    def may_send(self, robot: str, checked_at: float) -> bool:
        """Return whether the permission of :meth:`mark_sending` at ``checked_at`` (steady clock) holds."""
        return self._commands.may_send(robot, checked_at)

    async def delivered(self, ids: Iterable[int]) -> None:
        """Record that messages of SA have reached their robots."""
        await self._commands.delivered(ids)

    async def delivered_by_deletion(self, link: str) -> None:
        """Record the messages that the robots of ``link`` have read and deleted from SA themselves."""
        sent = self._undelivered(link)
        if sent:
            await self._commands.delivered(sent - await self._database.run(answers.waiting, sorted(sent)))

    async def load_backlog(self) -> int:
        """Load the backlog in RR from before this gateway read it; return the id of its newest request.

        Acknowledgements in it may have been processed already: their commands are judged only by positions
        that come after them.
        """
        # Only robots with an unfinished command: for others nothing is read here.
        waiting = sorted(self._commands.robots())
        newest, acknowledged = await self._database.read(answers.backlog, waiting)
        for robot, ids in acknowledged.items():
            for id in ids:
                self._commands.await_again(robot, id)
        return newest

    async def read_requests(self, link: str) -> list[answers.RequestRow]:
        """Return the oldest requests in RR, which stay there until :meth:`finish`; record what was read."""
        sent = self._undelivered(link)
        rows, waiting = await self._database.read(read_requests, sorted(sent))
        if rows and (late := self._undelivered(link) - sent):
            # Sent while the database was read; the acknowledgement may be among the rows already.
            sent |= late
            waiting |= await self._database.read(answers.waiting, sorted(late))
        if sent - waiting:
            await self._commands.delivered(sent - waiting)
        return rows

    async def finish(
        self,
        outcomes: list[RequestOutcome],
        request_ids: list[int],
        *,
        acks: bool,
        reader: Outbox | None = None,
    ) -> None:
        """Write the answers of requests into SA, with their OpAcks if ``acks``, and delete them from RR.

        One transaction, with the positions that they reported: a request is either answered and deleted, or
        will be processed again. A robot that said Ready is stored before. ``reader`` is the robot of a single
        outcome, whose connection then sends the answer without reading SA once more.
        """
        fresh = None
        if outcomes or request_ids:
            rows = answer_rows(outcomes, acks=acks)
            if admitted := {outcome.robot for outcome in outcomes if outcome.admitted}:
                # Together: one by one, the Readys of a whole fleet may outlast a gateway that is soon killed.
                await self._saving.save(*admitted)
            # Answers must outlive a power cut, even a map, which would be sent again: else the next message
            # would have its id, and a robot acknowledges a known id and does nothing, even for an Abort.
            if request_ids:
                # A request that a power cut brought back is processed again.
                # It may have waited for long: the robot's position then must not be in memory alone.
                work = finish_requests, outcomes, rows, request_ids
                await self._saving.write_with(*work, lasting=bool(rows))
            elif reader is None or not all(
                isinstance(one.answer, SetMap) and not one.admitted for one in outcomes
            ):
                await self._database.run(finish_calls, outcomes, rows)
            else:
                changes = self._changes[reader[0]]
                read = await self._database.run(finish_and_read, outcomes, rows, reader)
                # Anything else written for it meanwhile may not be included.
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


# --- Delivery of maps to robots: a part at once, and the rest when it is known ---

RETRY_AFTER = 1.0
"""seconds after which a map that could not be stored is stored once more."""

Place = tuple[float, float]


class MapSender:
    """Sends robots the map of the whole site, or of a window around them where the whole is too large.

    A robot never waits for a map to be made: it is sent a window, and the whole one when it is ready.
    """

    def __init__(self, site: ServedSite, robots: Robots, outboxes: RobotOutboxes, database: Database) -> None:
        self._site = site
        self._robots = robots
        self._outboxes = outboxes
        self._database = database
        self._parts: dict[str, Border] = {}
        """area of the newest map of each robot that was not sent the whole one."""
        self._making = asyncio.Lock()
        self._unplaced: set[str] = set()
        """robots that have such a map, and have not reported their position yet."""
        self._news = TroubleNews()

    async def first(self, robot: str, *, reads_itself: bool) -> tuple[SetMap, bool]:
        """Return the map that ``robot`` is sent after the acknowledgement of its Ready, and whether it is a
        part of the site.

        A part must be marked in the :class:`RequestOutcome`, so that more can follow. Raises StoreError.
        """
        offer = await self._offer(robot)
        self._unplaced.discard(robot)
        self._parts[robot] = offer.border
        is_at_hand = offer.is_whole and not reads_itself
        return WHOLE_SITE if is_at_hand else SetMap(offer.content), not offer.is_whole

    def located(self, poses: Sequence[RobotPose]) -> None:
        """Record that robots have reported their positions."""
        if self._unplaced:
            for robot in self._unplaced.intersection([robot for robot, _ in poses]):
                self._unplaced.discard(robot)
                self._outboxes.parts.put_nowait(robot)

    @handles(SendMap)
    async def send_requested(self, request: SendMap) -> Done:
        """Store the map for a robot; it replaces one that still waits for it.

        :raises RefusedError: for a robot that is not known, or is not connected.
        """
        self._robots.check_known(request.robot)
        robot = self._robots.get(request.robot)
        if robot.state is RobotState.OFFLINE:
            raise RefusedError(
                f"robot {request.robot!r} is offline; it is sent the map by itself when it connects"
            )
        if not robot.can("map"):
            raise RefusedError(f"robot {request.robot!r} takes no maps, as it said when it connected")
        await self.send(request.robot)
        return Done()

    async def send(self, robot: str) -> None:
        """Send ``robot`` the map of the whole site, or of its surroundings; raises StoreError."""
        content = await asyncio.to_thread(self._site.whole_map)
        if content is None:
            await self._store(robot, SetMap((await self._offer(robot)).content))
        else:
            await self._store_whole(robot, content)

    async def whole_or_around(self, robot: str) -> bytes:
        """Return the map of the whole site, or of the surroundings of ``robot``; raises StoreError."""
        if (whole := self._site.small_map_at_hand()) is not None:
            return whole.content
        # While it is made again all robots may wait for it, but only one thread: other work needs the rest.
        async with self._making:
            content = await asyncio.to_thread(self._site.whole_map)
        return (await self._offer(robot)).content if content is None else content

    async def send_all(self) -> None:
        """Send the robots of this gateway their map; those that are offline get it with their next Ready."""
        for name in self._robots.names():
            if name not in self._robots:
                continue
            robot = self._robots.get(name)
            if robot.gateway is None and robot.state is not RobotState.OFFLINE and robot.can("map"):
                await self.send(name)

    async def run(self) -> None:
        """Send the maps that follow the parts sent to robots, until cancelled."""
        await asyncio.to_thread(self._site.whole_map)
        while True:
            robot = await self._outboxes.parts.get()
            try:
                await self._follow(robot)
            except StoreError as error:
                if self._news.has("map", str(error)):
                    log.error("the map for robot %r: %s; trying again in %g s", robot, error, RETRY_AFTER)
                self._outboxes.parts.put_nowait(robot)
                await asyncio.sleep(RETRY_AFTER)
            except Exception:
                # The maps of all other robots must be sent; raised, it would recur and end the gateway.
                log_unforeseen(log, f"the map for robot {robot!r}")

    async def _follow(self, robot: str) -> None:
        content = await asyncio.to_thread(self._site.whole_map)
        if robot not in self._robots:
            return
        known = self._robots.get(robot)
        if content is not None:
            await self._store_whole(robot, content)
        elif known.pose is None or not known.located:
            self._unplaced.add(robot)
        elif not self._parts[robot].holds(known.pose.x, known.pose.y):
            await self.send(robot)

    async def _offer(self, robot: str) -> EncodedMap:
        if (whole := self._site.small_map_at_hand()) is not None:
            return whole
        place = await self._place(robot)
        return await asyncio.to_thread(self._site.map_at_once, place)

    async def _place(self, robot: str) -> Place | None:
        """Return the last position of the robot, else the one of its last SetPosIni."""
        pose = self._robots.get(robot).pose if robot in self._robots else None
        if pose is not None:
            return pose.x, pose.y
        given = await self._database.read(commands.last_given_track, robot, ("SetPosIni",))
        if given is None:
            return None
        x, y = given.params.get("x"), given.params.get("y")
        return (float(x), float(y)) if isinstance(x, (int, float)) and isinstance(y, (int, float)) else None

    async def _store_whole(self, robot: str, content: bytes) -> None:
        reads_itself = self._robots.get(robot).link == "sql"
        await self._store(robot, SetMap(content) if reads_itself else WHOLE_SITE)

    async def _store(self, robot: str, message: SetMap) -> None:
        await self._outboxes.finish([RequestOutcome(robot, answer=message)], [], acks=False)
