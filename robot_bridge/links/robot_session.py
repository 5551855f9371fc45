"""One robot's connection on WebSocket: its requests, its acknowledgements, and its outbox."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Coroutine
from typing import Any

from websockets.exceptions import ConnectionClosed, ConnectionClosedOK

from .. import jsonrpc
from ..access.visitor import Visitor
from ..errors import BridgeError, NotReadyError, StoreError
from ..exchange import Outcome
from ..fleet import Fleet
from ..messages import MessageError, OpAck, Ready, Request, to_json
from ..monitoring.unforeseen import note_unforeseen
from ..wire import decode_position, decode_request, error_code
from .delivery import Delivery

log = logging.getLogger(__name__)

NAME = "websocket"
POSITION = jsonrpc.Call("SendPos", None)
PING_TIMEOUT = 1.0
"""seconds after which a robot counts as gone when another one comes under its name."""
REPLACED = 4001
"""Close code for a connection whose robot has connected anew."""


class RobotSession:
    """One connection of one robot; ``admit`` is called when the robot has said Ready on it."""

    def __init__(
        self,
        fleet: Fleet,
        connection: Visitor,
        robot: str,
        admit: Callable[[RobotSession], None],
    ) -> None:
        self.robot = robot
        self._fleet = fleet
        self._connection = connection
        self._admit = admit
        self._admitted = False
        self._delivery = Delivery(fleet, connection, robot)
        self._closing: asyncio.Task[None] | None = None
        self._due: asyncio.Task[None] | None = None

    def replace(self) -> None:
        """End this connection because the robot has connected anew; what still comes in is passed over."""
        self._delivery.end()
        # A connection whose robot is gone takes seconds to close, and the new one must not wait for it.
        self._closing = asyncio.create_task(self._connection.close(REPLACED, "the robot has connected anew"))

    def stop_now(self, call_id: str) -> None:
        """Tell the robot of an emergency stop, under the id ``call_id``."""
        self._delivery.stop_now(call_id)

    def measure(self) -> None:
        """Note how long the last ping took there and back."""
        if self._admitted and self._connection.round_trip is not None:
            self._fleet.robots.measured(self.robot, self._connection.round_trip)

    async def answers(self) -> bool:
        """Tell whether the robot is there: it answers a ping within a second."""
        try:
            async with asyncio.timeout(PING_TIMEOUT):
                await (await self._connection.ping())
        except (ConnectionClosed, TimeoutError):
            return False
        return True

    async def run(self) -> bool:
        """Serve the connection to its end; return true if the robot closed it in good order."""
        try:
            await self._connection.send(jsonrpc.call("Start", to_json(self._fleet.reception.greeting())))
            if (call_id := self._fleet.emergency.call_id) is not None:
                self.stop_now(call_id)
            self._connection.short_cut.handler = self._take_at_once
            async for frame in self._connection:
                if self._closing is None:
                    await self._receive(frame)
        except ConnectionClosedOK:
            return True
        except ConnectionClosed:
            return False
        finally:
            self._delivery.end()
        return self._connection.close_code in (1000, 1001)

    def _take_at_once(self, frame: bytes) -> bool:
        """Take in a position; false for everything else, and while something must be waited for."""
        if not self._admitted or self._closing is not None or self._due is not None:
            return False
        if (pose := decode_position(frame)) is None:
            return False
        try:
            rest = self._fleet.take_pose(self.robot, NAME, pose)
        except Exception as error:
            rest = _failed(error)
        if rest is not None:
            self._due = asyncio.create_task(self._store(rest))
        return True

    async def _store(self, rest: Coroutine[Any, Any, None]) -> None:
        """Store what a position brought about; what comes after it waits."""
        try:
            with contextlib.suppress(ConnectionClosed):
                await self._answer(POSITION, self._outcome(rest))
        finally:
            self._due = None

    async def _outcome(self, rest: Coroutine[Any, Any, None]) -> Outcome:
        await rest
        return Outcome(self.robot)

    async def _receive(self, frame: str | bytes) -> None:
        if self._due is not None:
            await self._due
        if (pose := decode_position(frame)) is not None:
            await self._answer(POSITION, self._ask(pose, None))
            return
        try:
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            await self._connection.send(jsonrpc.error(error.id, error.code, str(error)))
            return
        if isinstance(message, jsonrpc.Call):
            await self._answer(message, self._receive_call(message))
        else:
            await self._receive_reply(message)

    async def _receive_call(self, call: jsonrpc.Call) -> Outcome:
        request = decode_request(call.method, call.params)
        return await self._ask(request, call.id if isinstance(call.id, int) else None)

    async def _answer(self, call: jsonrpc.Call, work: Coroutine[Any, Any, Outcome]) -> None:
        """Await what comes of a call and tell the robot: acknowledged is only what has its answer stored."""
        try:
            outcome = await work
            if outcome.answer is not None:
                await self._fleet.mailboxes.finish([outcome], [], acks=False)
        except (MessageError, BridgeError) as error:
            self._fleet.tally.refused[NAME] += 1
            log.warning("link websocket: robot %r: %s", self.robot, error)
            await self._connection.send(jsonrpc.error(call.id, error_code(error), str(error)))
            return
        except ConnectionClosed:
            raise
        except Exception:
            text = note_unforeseen(log, f"link websocket: robot {self.robot!r}")
            await self._connection.send(jsonrpc.error(call.id, jsonrpc.INTERNAL_ERROR, text))
            return
        if call.id is not None:
            await self._connection.send(jsonrpc.result(call.id, to_json(outcome.ack or OpAck())))
        if call.method == Ready.__name__ and outcome.admitted:
            self._delivery.begin()

    async def _ask(self, request: Request, id: int | None) -> Outcome:
        if not isinstance(request, Ready):
            if not self._admitted:
                raise NotReadyError(
                    f"robot {self.robot!r} has not said Ready on this connection; send Ready first"
                )
            return await self._fleet.receive(self.robot, NAME, request, id)
        # A robot that starts anew inside its own connection is no second one.
        self._fleet.reception.holds.free(self.robot, self)
        outcome = await self._fleet.receive(self.robot, NAME, request, id)
        if outcome.admitted:
            self._admitted = True
            self._admit(self)
        return outcome

    async def _receive_reply(self, reply: jsonrpc.Reply) -> None:
        if not self._admitted:
            return
        try:
            await self._take_reply(reply)
        except StoreError as error:
            log.warning("link websocket: robot %r: %s; it will be asked again", self.robot, error)
            self._delivery.begin()
        except (MessageError, BridgeError) as error:
            log.warning("link websocket: robot %r: %s", self.robot, error)
        except Exception:
            # There is no answer to an answer: what went wrong is between the log and whoever reads it.
            note_unforeseen(log, f"link websocket: robot {self.robot!r}, acknowledgement {reply.id}")

    async def _take_reply(self, reply: jsonrpc.Reply) -> None:
        if isinstance(reply.id, str):
            self._fleet.emergency.answered(self.robot, reply.id, refused=reply.error is not None)
            return
        ack = OpAck(id=reply.id, ok=reply.error is None, reason=reply.error)
        await self._fleet.receive(self.robot, NAME, ack, None)


async def _failed(error: Exception) -> None:
    """Raise what went wrong where every other error is told of."""
    raise error
