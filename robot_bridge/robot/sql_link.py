"""The reference robot's SQL: it inserts into RR, reads its own rows of SA and deletes them."""

from __future__ import annotations

import asyncio
import json
import logging

from sqlalchemy import Connection

from ..errors import StoreError
from ..messages import MessageError, OpAck, Request, to_json
from ..store import answers, requests
from ..store.answers import AnswerRow
from ..store.database import Database
from ..wire import decode_answer, parse_params
from .agent import Agent

log = logging.getLogger(__name__)

POLL_INTERVAL = 0.05
RETRY_AFTER = 1.0


class SqlLink:
    """Writes what the agent says and hands it what is answered, twenty times a second."""

    def __init__(self, database: str, robot: str) -> None:
        self._database = Database(database)
        self._robot = robot
        self._outgoing: list[Request] = []

    def say(self, request: Request) -> None:
        """Write a request at the next turn."""
        self._outgoing.append(request)

    async def run(self, agent: Agent) -> None:
        """Carry messages until cancelled; raises StoreError if the database cannot be used at all."""
        await self._database.open()
        agent.greet()
        try:
            while True:
                try:
                    await self._turn(agent)
                    await asyncio.sleep(POLL_INTERVAL)
                except StoreError as error:
                    log.warning("%s; trying again in %g s", error, RETRY_AFTER)
                    await asyncio.sleep(RETRY_AFTER)
        finally:
            await self._flush([], [])
            await self._database.close()

    async def _turn(self, agent: Agent) -> None:
        rows = await self._database.run(answers.read, self._robot)
        acks = [ack for row in rows if (ack := self._receive(agent, row)) is not None]
        await self._flush([row.id for row in rows], acks)

    def _receive(self, agent: Agent, row: AnswerRow) -> OpAck | None:
        try:
            answer = decode_answer(row.op, parse_params(row.op, row.params), row.payload)
        except MessageError as error:
            return OpAck(id=row.id, ok=False, reason=str(error))
        if isinstance(answer, OpAck) and not answer.ok:
            log.error("the gateway refused request %s: %s", answer.id, answer.reason)
        return agent.receive(answer, row.id)

    async def _flush(self, read: list[int], acks: list[OpAck]) -> None:
        outgoing, self._outgoing = [*acks, *self._outgoing], []
        if not (outgoing or read):
            return
        try:
            await self._database.run(_exchange, self._robot, read, outgoing)
        except StoreError:
            self._outgoing = outgoing[-100:]
            raise


def _exchange(connection: Connection, robot: str, read: list[int], outgoing: list[Request]) -> None:
    answers.remove(connection, read)
    for request in outgoing:
        requests.add(connection, robot, type(request).__name__, json.dumps(to_json(request)))
