"""The reference robot's SQL link: it inserts into RR, reads its own rows of SA and deletes them."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
from collections.abc import Sequence
from pathlib import Path

from sqlalchemy import URL, Connection, make_url

from ..core.errors import StoreError
from ..core.messages.base import MessageError, to_json
from ..core.messages.robots import Alive, OpAck, Ready, Request, SendPos
from ..gateway.storage.database import Database
from ..gateway.storage.dialects import GONE
from ..gateway.storage.repositories import requests as answers
from ..gateway.storage.repositories.requests import AnswerRow
from ..gateway.storage.wakeups import robot_channel
from ..protocol.codec import decode_answer, parse_params, payload_of
from .agent import Agent

log = logging.getLogger(__name__)

WRITE_INTERVAL = 0.02
RETRY_AFTER = 1.0


class RobotSqlLink:
    """Writes the agent's messages immediately, and delivers answers as soon as they arrive."""

    def __init__(self, database: str | URL, robot: str) -> None:
        self._address = make_url(database)
        self._database = Database(database)
        self._file = self._inode()
        """Which file of SQLite it reads, None on a server."""
        self._robot = robot
        self._outgoing: list[Request] = []
        self._magic: int | None = None
        """The number of this run, once it has sent Ready."""

    def say(self, request: Request) -> None:
        """Write a request at the next turn."""
        if isinstance(request, Ready):
            self._magic = request.magic
        self._outgoing.append(request)

    async def run(self, agent: Agent) -> None:
        """Carry messages until cancelled."""
        agent.greet()
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(self._read(agent))
                tasks.create_task(self._write())
        finally:
            with contextlib.suppress(StoreError):
                await self._flush([])
            await self._database.close()

    async def _read(self, agent: Agent) -> None:
        wakeup = self._database.wakeup(robot_channel(self._robot))
        try:
            while True:
                try:
                    await wakeup.wait(found=await self._turn(agent))
                except StoreError as error:
                    await self._wait_for_the_database(error)
                    if GONE in str(error):
                        await self._follow_file(agent)
        finally:
            await wakeup.close()

    async def _write(self) -> None:
        while True:
            await asyncio.sleep(WRITE_INTERVAL)
            try:
                await self._flush([])
            except StoreError as error:
                await self._wait_for_the_database(error)

    async def _wait_for_the_database(self, error: StoreError) -> None:
        log.warning("%s; trying again in %g s", error, RETRY_AFTER)
        await asyncio.sleep(RETRY_AFTER)

    async def _follow_file(self, agent: Agent) -> None:
        """Reopen SQLite's file if it was replaced, as the gateway reaches the robot through the new one.

        Not during a turn: rows read in one file must be deleted and acknowledged in the same one.
        """
        file = self._inode()
        if file is None:
            return
        former, self._database = self._database, Database(self._address)
        await former.close()
        if file == self._file:
            # Its write-ahead log may be another one.
            return
        log.warning("robot %s goes on with the file that has taken the place of its database", self._robot)
        self._file = file
        self._outgoing = [one for one in self._outgoing if not isinstance(one, OpAck)]
        agent.greet()

    def _inode(self) -> tuple[int, int] | None:
        path = self._address.database if self._address.get_backend_name() == "sqlite" else None
        try:
            status = None if path is None else Path(path).stat()
        except OSError:
            return None
        return None if status is None else (status.st_dev, status.st_ino)

    async def _turn(self, agent: Agent) -> bool:
        rows = await self._database.read(answers.read_answers, self._robot)
        read, is_behind = [], False
        for row in rows:
            own, ack = self._receive(agent, row)
            if own:
                read.append(row.id)
            is_behind |= not own
            if ack is not None:
                # After the agent's requests about the message.
                self._outgoing.append(ack)
            if own and is_behind and row.op == OpAck.__name__:
                # It may admit the robot: earlier rows, such as an Abort, are handled first.
                break
        await self._flush(read)
        return bool(read)

    def _receive(self, agent: Agent, row: AnswerRow) -> tuple[bool, OpAck | None]:
        """Deliver a row to the agent; return whether it was the agent's own, and its acknowledgement."""
        try:
            answer = decode_answer(row.op, parse_params(row.op, row.params), row.payload)
        except MessageError as error:
            return True, OpAck(id=row.id, ok=False, reason=str(error))
        if not agent.concerns(answer):
            return False, None
        if isinstance(answer, OpAck) and not answer.ok:
            log.error("the gateway refused request %s: %s", answer.id, answer.reason)
        return True, agent.receive(answer, row.id)

    async def _flush(self, read: list[int]) -> None:
        outgoing, self._outgoing = self._outgoing, []
        if not (outgoing or read):
            return
        try:
            await self._database.write_relaxed(_exchange, self._robot, self._magic, read, outgoing)
        except StoreError:
            self._outgoing = [*_still_to_send(outgoing), *self._outgoing]
            raise


def _still_to_send(requests: Sequence[Request]) -> list[Request]:
    """Return the requests to repeat, each once; of positions only the last before each OpAck."""
    kept: list[Request] = []
    position = None
    for request in requests:
        if isinstance(request, SendPos):
            position = request
        elif not isinstance(request, Alive) and request not in kept:
            if isinstance(request, OpAck) and position is not None:
                kept.append(position)
                position = None
            kept.append(request)
    return kept


def _exchange(
    connection: Connection, robot: str, magic: int | None, read: list[int], outgoing: list[Request]
) -> None:
    answers.remove_answers(connection, read)
    answers.add_requests(connection, [_row(robot, magic, request) for request in outgoing])


def _row(robot: str, magic: int | None, request: Request) -> tuple[str, str, str, bytes | None]:
    """Return the row of a request, with the number of its run."""
    params = {**to_json(request), "magic": magic} if magic is not None else to_json(request)
    return robot, type(request).__name__, json.dumps(params), payload_of(request)
