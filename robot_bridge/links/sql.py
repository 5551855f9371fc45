"""The paper's link: robots insert into RR, read their rows of SA and delete them (section IV)."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable

from ..errors import DataRefusedError, NotReadyError, RefusedError, StoreError
from ..exchange import Outcome
from ..fleet import Fleet
from ..messages import PAYLOADS, MessageError, OpAck, check_robot_name
from ..monitoring.unforeseen import note_unforeseen
from ..store import requests
from ..store.database import Database
from ..store.requests import AT_ONCE, RequestRow
from ..store.wakeups import GATEWAY_CHANNEL
from ..wire import decode_request, parse_params

log = logging.getLogger(__name__)

NAME = "sql"
RETRY_AFTER = 1.0
BEAT = "sql link"
"""The name under which each look at the tables is noted."""


class SqlLink:
    """Watches RR and SA. A robot's requests are dealt with in their order; one that fails is answered."""

    def __init__(self, fleet: Fleet, database: Database) -> None:
        self._fleet = fleet
        self._database = database
        self._seen_version: int | None = None
        self._waited_up_to: int | None = None
        """the newest request from before this link read any; None until it is known."""
        self._greeted: set[str] = set()

    async def run(self) -> None:
        """Serve until cancelled; a database that fails for a while is tried again."""
        wakeup = self._database.wakeup(GATEWAY_CHANNEL)
        try:
            while True:
                try:
                    found = await self.poll()
                    if not found and await wakeup.doze():
                        found = await self.poll()
                    self._fleet.tally.beat(BEAT)
                    await wakeup.wait(found=found)
                except StoreError as error:
                    log.error("link sql: %s; trying again in %g s", error, RETRY_AFTER)
                    await asyncio.sleep(RETRY_AFTER)
        finally:
            await wakeup.close()

    async def poll(self) -> bool:
        """Look once whether robots wrote or deleted something, and deal with it; tell whether they did.

        Raises StoreError; what waits is then looked at anew.
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
            self._waited_up_to = await self._fleet.mailboxes.take_up()
        found = False
        while rows := await self._fleet.mailboxes.look(NAME):
            found = True
            await self._deal_with_all(rows)
            if len(rows) < AT_ONCE:
                break
        self._seen_version = version
        return found

    async def _deal_with_all(self, rows: list[RequestRow]) -> None:
        """Deal with requests side by side, those of one robot one after the other."""
        by_robot: dict[str, list[RequestRow]] = {}
        for row in rows:
            by_robot.setdefault(row.robot, []).append(row)
        dealt = await asyncio.gather(*map(self._deal_with_robot, by_robot.values()), return_exceptions=True)
        for result in dealt:
            if isinstance(result, BaseException):
                raise result
        outcomes = [outcome for result in dealt if isinstance(result, list) for outcome in result]
        await self._finish(outcomes, [row.id for row in rows])

    async def _deal_with_robot(self, rows: Iterable[RequestRow]) -> list[Outcome]:
        return [outcome for row in rows if (outcome := await self._deal_with(row)) is not None]

    async def _finish(self, outcomes: list[Outcome], ids: list[int]) -> None:
        try:
            await self._fleet.mailboxes.finish(outcomes, ids, acks=True)
        except DataRefusedError:
            # Nothing that the gateway writes should be refused; what is must not come back for ever.
            note_unforeseen(log, f"link sql: requests {ids}, which stay without an answer")
            await self._fleet.mailboxes.finish([], ids, acks=True)

    async def _deal_with(self, row: RequestRow) -> Outcome | None:
        try:
            check_robot_name(row.robot)
            request = decode_request(row.op, parse_params(row.op, row.params), await self._payload(row))
            waited = row.id <= (self._waited_up_to or 0)
            return await self._fleet.receive(row.robot, NAME, request, row.id, waited=waited)
        except NotReadyError:
            return self._greet(row.robot)
        except (MessageError, RefusedError, DataRefusedError) as error:
            self._fleet.tally.refused[NAME] += 1
            log.warning("link sql: request %d of robot %r: %s", row.id, row.robot, error)
            return _refusal(row, str(error))
        except StoreError:
            raise
        except Exception:
            text = note_unforeseen(log, f"link sql: request {row.id} of robot {row.robot!r}")
            return _refusal(row, f"{row.op}: {text}")

    async def _payload(self, row: RequestRow) -> bytes | None:
        if row.op not in PAYLOADS:
            return None
        return await self._database.run(requests.payload, row.id, self._fleet.observations.check_size)

    def _greet(self, robot: str) -> Outcome | None:
        """Tell a robot that never said Ready that it may, once: it sends positions many times a second."""
        if robot in self._greeted:
            return None
        self._greeted.add(robot)
        return Outcome(robot, answer=self._fleet.reception.greeting())


def _refusal(row: RequestRow, reason: str) -> Outcome:
    return Outcome(row.robot, OpAck(id=row.id, ok=False, reason=reason))
