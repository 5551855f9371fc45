"""The paper's link: robots insert into RR, read their rows of SA and delete them (section IV)."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Iterable
from typing import NamedTuple

from ...core.errors import DataRefusedError, NotReadyError, OtherRunError, RefusedError, StoreError
from ...core.logs import TroubleNews
from ...core.messages.base import LARGEST_MESSAGE, MessageError, check_robot_name, is_robot_name
from ...core.messages.robots import PAYLOADS, REQUESTS, OpAck
from ...protocol.codec import decode_request, parse_params
from ..fleet.robot_outboxes import RequestOutcome
from ..fleet.service import Fleet
from ..storage.database import Database
from ..storage.repositories import requests
from ..storage.repositories.requests import AT_ONCE, RequestRow
from ..storage.wakeups import GATEWAY_CHANNEL

log = logging.getLogger(__name__)

NAME = "sql"
TURN_S = 0.01
"""seconds of processing rows before other tasks have their turn, such as an emergency stop."""
RETRY_AFTER = 1.0
BEAT = "sql link"
"""The name under which each poll of the tables is recorded."""


class HandledRequests(NamedTuple):
    """Outcomes of some requests of one robot, and their ids."""

    outcomes: list[RequestOutcome]
    ids: list[int]


class SqlInterface:
    """Watches RR and SA. A robot's requests are processed in order; one that fails is answered."""

    def __init__(self, fleet: Fleet, database: Database) -> None:
        self._fleet = fleet
        self._database = database
        self._seen_version: int | None = None
        self._waited_up_to: int | None = None
        """the newest request from before this link's first read; None until it is known."""
        self._greeted: set[str] = set()
        self._news = TroubleNews()
        self._turn_ends = 0.0

    async def run(self) -> None:
        """Serve until cancelled; retries while the database fails."""
        wakeup = self._database.wakeup(GATEWAY_CHANNEL)
        try:
            while True:
                try:
                    found = await self.poll()
                    if not found and await wakeup.enable_notifications():
                        found = await self.poll()
                    self._fleet.counters.beat(BEAT)
                    self._news.is_over("link sql")
                    await wakeup.wait(found=found)
                except StoreError as error:
                    if self._news.has("link sql", str(error)):
                        log.error("link sql: %s; trying again until it works", error)
                    await asyncio.sleep(RETRY_AFTER)
        finally:
            await wakeup.close()

    async def poll(self) -> bool:
        """Poll once for rows that robots wrote or deleted, and process them; return whether there were any.

        Raises StoreError; the waiting rows are then read again.
        """
        try:
            return await self._poll()
        except StoreError:
            self._seen_version = self._waited_up_to = None
            raise

    async def _poll(self) -> bool:
        version = await self._database.version()
        if version is not None and version == self._seen_version:
            return False
        if self._waited_up_to is None:
            self._waited_up_to = await self._fleet.outboxes.load_backlog()
        found = False
        while rows := await self._fleet.outboxes.read_requests(NAME):
            found = True
            await self._deal_with_all(rows)
            if len(rows) < AT_ONCE:
                break
        self._seen_version = version
        return found

    async def _deal_with_all(self, rows: list[RequestRow]) -> None:
        """Process requests concurrently, those of one robot one after the other."""
        by_robot: dict[str, list[RequestRow]] = {}
        for row in rows:
            by_robot.setdefault(row.robot, []).append(row)
        dealt = await asyncio.gather(*map(self._deal_with_robot, by_robot.values()), return_exceptions=True)
        done = [
            HandledRequests(result, [row.id for row in some])
            for some, result in zip(by_robot.values(), dealt, strict=True)
            if not isinstance(result, BaseException)
        ]
        # Processed requests are answered, even if another robot's failed. A Ready needs a table that the
        # others do not need: while somebody has that locked, only robots that say Ready wait.
        saying_ready: list[HandledRequests] = []
        others: list[HandledRequests] = []
        for one in done:
            (saying_ready if any(outcome.admitted for outcome in one.outcomes) else others).append(one)
        for some_done in (others, saying_ready):
            if some_done:
                await self._finish(some_done)
        for result in dealt:
            if isinstance(result, BaseException):
                raise result

    async def _deal_with_robot(self, rows: Iterable[RequestRow]) -> list[RequestOutcome]:
        outcomes = []
        for row in rows:
            if (outcome := await self._deal_with(row)) is not None:
                outcomes.append(outcome)
            if time.monotonic() > self._turn_ends:
                await asyncio.sleep(0)
                self._turn_ends = time.monotonic() + TURN_S
        return outcomes

    async def _finish(self, dealt: list[HandledRequests]) -> None:
        """Store the outcomes of robots' requests: all at once, else robot by robot."""
        outcomes = [outcome for one in dealt for outcome in one.outcomes]
        ids = [id for one in dealt for id in one.ids]
        try:
            await self._fleet.outboxes.finish(outcomes, ids, acks=True)
        except DataRefusedError as error:
            if len(dealt) > 1:
                for one in dealt:
                    await self._finish([one])
                return
            # Of what the gateway writes only an administrator's rule refuses anything; it must not repeat for
            # ever.
            robot = repr(outcomes[0].robot) if outcomes else "unknown"
            line = f"link sql: robot {robot}: requests {ids} stay without an answer: {error}"
            self._fleet.repeated.warn(log, ("link sql:", "robot", robot, "answers"), line)
            await self._fleet.outboxes.finish([], ids, acks=True)

    async def _deal_with(self, row: RequestRow) -> RequestOutcome | None:
        try:
            check_robot_name(row.robot)
            self._check_size(row)
            request = decode_request(row.op, parse_params(row.op, row.params), await self._payload(row))
            waited = row.id <= (self._waited_up_to or 0)
            return await self._fleet.receive(row.robot, NAME, request, row.id, waited=waited)
        except NotReadyError:
            return self._greet(row.robot)
        except (MessageError, RefusedError, DataRefusedError) as error:
            self._fleet.counters.refused[NAME] += 1
            text = f"link sql: request {row.id} of robot {row.robot!r}: {error}"
            self._fleet.repeated.warn(log, _key_of(row), text)
            if isinstance(error, OtherRunError) and not REQUESTS[row.op].acknowledged:
                # It expects no answer, and answers would flood the robot that owns the account.
                return None
            if not is_robot_name(row.robot):
                # Nobody may read what is written for it.
                return None
            return _refusal(row, str(error))
        except StoreError:
            raise
        except Exception:
            who = f"link sql: request {row.id} of robot {row.robot!r}"
            text = self._fleet.repeated.note_unforeseen(log, _key_of(row), who)
            return _refusal(row, f"{row.op}: {text}")

    def _check_size(self, row: RequestRow) -> None:
        if row.size is None or row.size <= LARGEST_MESSAGE:
            return
        text = f"{row.op}: params has {row.size} characters; at most {LARGEST_MESSAGE} are taken"
        if row.id > (self._waited_up_to or 0):
            self._fleet.refuse_large(row.robot, NAME, text)
        raise MessageError(text)

    async def _payload(self, row: RequestRow) -> bytes | None:
        if row.op not in PAYLOADS:
            return None
        return await self._database.run(requests.payload, row.id, self._fleet.observations.check_size)

    def _greet(self, robot: str) -> RequestOutcome | None:
        """Ask a robot that never sent Ready for it, once: it sends positions many times a second."""
        if robot in self._greeted:
            return None
        self._greeted.add(robot)
        return RequestOutcome(robot, answer=self._fleet.reception.greeting())


def _key_of(row: RequestRow) -> tuple[str, ...]:
    """Return the key under which log lines about such rows are counted."""
    return "link sql:", "robot", repr(row.robot), row.op if row.op in REQUESTS else "unknown operations"


def _refusal(row: RequestRow, reason: str) -> RequestOutcome:
    return RequestOutcome(row.robot, OpAck(id=row.id, ok=False, reason=reason))
