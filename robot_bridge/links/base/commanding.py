"""What robots are told: each in its own order, a message once, and what stops a robot before all else."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from typing import Protocol

from ... import jsonrpc
from ...messages import Answer, OpAck, to_json
from .adapter import Adapter, Command
from .errors import CommandRefusedError, LinkError
from .memory import Done, LinkMemory

log = logging.getLogger(__name__)

OVERTAKEN = "an Abort came before the robot had taken it on"
GONE = "the link speaks for this robot no more"
CallId = int | str | None


class Post(Protocol):
    """Sends a frame to the gateway."""

    def __call__(self, frame: str, *, urgent: bool = False) -> None:
        """Send it; one that is ``urgent`` before the others."""


class _Line:
    """What one robot is still to be told, and the task that tells it."""

    def __init__(self) -> None:
        self.waiting: deque[tuple[CallId, Answer]] = deque()
        self.task: asyncio.Task[None] | None = None


class Commanding:
    """Hands the adapter its commands and tells the gateway what came of each."""

    def __init__(self, adapter: Adapter, memory: LinkMemory, answer_within: float, post: Post) -> None:
        self._adapter = adapter
        self._memory = memory
        self._answer_within = answer_within
        self._post = post
        self._lines: dict[str, _Line] = {}
        self._stops: set[asyncio.Task[None]] = set()

    def enqueue(self, robot: str, call: CallId, message: Answer) -> None:
        """Have ``robot`` told ``message`` behind what it is still to be told."""
        line = self._lines.setdefault(robot, _Line())
        if any(known == call for known, _ in line.waiting):
            return
        line.waiting.append((call, message))
        if line.task is None or line.task.done():
            line.task = asyncio.create_task(self._work(robot, line))

    def stop(self, robot: str, call: CallId, *, emergency: bool) -> None:
        """Have ``robot`` stop now; what it was not told yet it is never told."""
        self.drop(robot, OVERTAKEN)
        task = asyncio.create_task(self._stop(robot, call, emergency=emergency))
        self._stops.add(task)
        task.add_done_callback(self._stops.discard)

    def drop(self, robot: str, reason: str = GONE) -> None:
        """Give up what ``robot`` was not told yet, and what it is being told."""
        line = self._lines.pop(robot, None)
        if line is None:
            return
        for call, _ in line.waiting:
            self._answer(call, reason)
        line.waiting.clear()
        if line.task is not None:
            line.task.cancel()

    async def _stop(self, robot: str, call: CallId, *, emergency: bool) -> None:
        try:
            async with asyncio.timeout(self._answer_within):
                await self._adapter.stop(robot, emergency=emergency)
            self._answer(call, None, urgent=True)
        except CommandRefusedError as error:
            log.error("robot %s does not stop: %s", robot, error)
            self._answer(call, str(error), urgent=True)
        except TimeoutError:
            log.error("robot %s did not answer to an Abort within %g s", robot, self._answer_within)
            self._answer(call, f"no answer within {self._answer_within:g} s", urgent=True)
        except Exception:
            log.exception("robot %s: the Abort failed", robot)
            self._answer(call, "the link failed; its log says more", urgent=True)

    async def _work(self, robot: str, line: _Line) -> None:
        while line.waiting:
            call, message = line.waiting[0]
            id = _message_id(call)
            done = self._memory.find(robot, id) if id is not None else None
            if done is None:
                done = await self._do(robot, call, message)
            line.waiting.popleft()
            self._answer(call, done.refusal)

    async def _do(self, robot: str, call: CallId, message: Answer) -> Done:
        id = _message_id(call)
        if id is None:
            return Done("this message has no id")
        try:
            again = await self._memory.begin(robot, id)
        except LinkError as error:
            return Done(str(error))
        try:
            done = await self._told(Command(robot, id, message, again))
        except asyncio.CancelledError:
            await asyncio.shield(self._memory.finish(robot, id, Done(OVERTAKEN)))
            raise
        await self._memory.finish(robot, id, done)
        return done

    async def _told(self, command: Command) -> Done:
        what = type(command.message).__name__
        try:
            async with asyncio.timeout(self._answer_within):
                await self._adapter.command(command)
        except CommandRefusedError as error:
            return Done(str(error))
        except TimeoutError:
            return Done(f"the robot did not take it on within {self._answer_within:g} s")
        except Exception:
            log.exception("robot %s: %s %d failed", command.robot, what, command.id)
            return Done("the link failed; its log says more")
        return Done()

    def _answer(self, call: CallId, refusal: str | None, *, urgent: bool = False) -> None:
        if call is None:
            return
        if refusal is None:
            self._post(jsonrpc.result(call, to_json(OpAck())), urgent=urgent)
        else:
            self._post(jsonrpc.error(call, jsonrpc.REFUSED, refusal), urgent=urgent)


def _message_id(call: CallId) -> int | None:
    """Return the id of a message in that of its call, ``robot/17``; None for a call without one."""
    id = str(call).rpartition("/")[2]
    return int(id) if id.isascii() and id.isdigit() else None
