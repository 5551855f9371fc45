"""The paper's link: robots insert into RR, read their rows of SA and delete them (section IV)."""

from __future__ import annotations

import asyncio
import logging

from ..errors import NotReadyError, StoreError
from ..fleet import Fleet, Outcome
from ..messages import MessageError, OpAck, Start, check_robot_name
from ..store.database import Database
from ..store.requests import RequestRow
from ..wire import decode_request, parse_params

log = logging.getLogger(__name__)

NAME = "sql"
RETRY_AFTER = 1.0


class SqlLink:
    """Watches RR and SA. Requests are dealt with in their order; one that fails is answered, not retried."""

    def __init__(self, fleet: Fleet, database: Database, poll_interval: float = 0.02) -> None:
        self._fleet = fleet
        self._database = database
        self._poll_interval = poll_interval
        self._seen_version = -1
        self._greeted: set[str] = set()

    async def run(self) -> None:
        """Serve until cancelled; a database that fails for a while is tried again."""
        while True:
            try:
                await self.poll()
                await asyncio.sleep(self._poll_interval)
            except StoreError as error:
                log.error("link sql: %s; trying again in %g s", error, RETRY_AFTER)
                self._seen_version = -1
                await asyncio.sleep(RETRY_AFTER)

    async def poll(self) -> None:
        """Look once whether robots wrote or deleted something, and deal with it."""
        version = await self._database.changed_elsewhere()
        if version == self._seen_version:
            return
        # What a robot read comes before what it says to it: it may delete and acknowledge at once.
        await self._fleet.delivered_by_deletion(NAME)
        while rows := await self._fleet.take_requests():
            outcomes = [outcome for row in rows if (outcome := await self._deal_with(row)) is not None]
            await self._fleet.finish(outcomes, [row.id for row in rows], acks=True)
        self._seen_version = version

    async def _deal_with(self, row: RequestRow) -> Outcome | None:
        try:
            check_robot_name(row.robot)
            request = decode_request(row.op, parse_params(row.op, row.params))
            return await self._fleet.receive(row.robot, NAME, request, row.id)
        except NotReadyError:
            return self._greet(row.robot)
        except MessageError as error:
            log.warning("link sql: request %d of robot %r: %s", row.id, row.robot, error)
            return Outcome(row.robot, OpAck(id=row.id, ok=False, reason=str(error)))

    def _greet(self, robot: str) -> Outcome | None:
        """Tell a robot that never said Ready that it may, once: it sends positions many times a second."""
        if robot in self._greeted:
            return None
        self._greeted.add(robot)
        return Outcome(robot, answer=Start())
