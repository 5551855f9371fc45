"""Robots on WebSocket: JSON-RPC 2.0 with the operation codes of the paper as methods.

A robot's requests are calls (SendPos and Alive may be notifications), and the gateway's OpAck is the
result. The gateway's messages are calls whose id is that of the message; the robot's OpAck is the result,
or an error where it will not do it.
"""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from collections.abc import Callable
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed, ConnectionClosedOK

from .. import jsonrpc
from ..errors import BridgeError, NotReadyError, StoreError
from ..fleet import Fleet, Outcome
from ..messages import MessageError, OpAck, Ready, Request, to_json
from ..store.answers import AnswerRow
from ..wire import decode_request, error_code, parse_params, with_base64

log = logging.getLogger(__name__)

NAME = "websocket"
PING_TIMEOUT = 1.0
"""seconds after which a robot counts as gone when another one comes under its name."""
REPLACED = 4001
"""Close code for a connection whose robot has connected anew."""


class WebSocketLink:
    """Serves the connections of robots; the one on which a robot said Ready last is the one that counts."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._names: Counter[str] = Counter()
        self._holders: dict[str, RobotSession] = {}

    async def serve(self, connection: ServerConnection, robot: str | None) -> None:
        """Serve one connection to its end; without a name the robot is given one."""
        name = robot or self._free_name()
        session = RobotSession(self._fleet, connection, name, self._admit)
        self._names[name] += 1
        try:
            in_order = await session.run()
        finally:
            self._names -= Counter([name])
            held = self._holders.get(name) is session
            if held:
                self._fleet.holds.free(name, session)
                del self._holders[name]
        if in_order and held:
            self._fleet.closed(name)

    def _admit(self, session: RobotSession) -> None:
        """Let ``session`` be the connection of its robot, and end the one before."""
        former = self._holders.get(session.robot)
        self._holders[session.robot] = session
        self._fleet.holds.take(session.robot, session)
        if former is not None and former is not session:
            former.replace()

    def _free_name(self) -> str:
        taken = {*self._fleet.robots.names(), *self._names}
        return next(name for n in range(1, len(taken) + 2) if (name := f"robot-{n}") not in taken)


class RobotSession:
    """One connection of one robot; ``admit`` is called when the robot has said Ready on it."""

    def __init__(
        self,
        fleet: Fleet,
        connection: ServerConnection,
        robot: str,
        admit: Callable[[RobotSession], None],
    ) -> None:
        self.robot = robot
        self._fleet = fleet
        self._connection = connection
        self._admit = admit
        self._admitted = False
        self._delivery: asyncio.Task[None] | None = None
        self._closing: asyncio.Task[None] | None = None

    def replace(self) -> None:
        """End this connection because the robot has connected anew; what still comes in is passed over."""
        if self._delivery is not None:
            self._delivery.cancel()
        # A connection whose robot is gone takes seconds to close, and the new one must not wait for it.
        self._closing = asyncio.create_task(self._connection.close(REPLACED, "the robot has connected anew"))

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
            await self._connection.send(jsonrpc.call("Start", to_json(self._fleet.greeting())))
            async for frame in self._connection:
                if self._closing is None:
                    await self._receive(frame)
        except ConnectionClosedOK:
            return True
        except ConnectionClosed:
            return False
        finally:
            if self._delivery is not None:
                self._delivery.cancel()
        return self._connection.close_code in (1000, 1001)

    async def _receive(self, frame: str | bytes) -> None:
        try:
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            await self._connection.send(jsonrpc.error(error.id, error.code, str(error)))
            return
        if isinstance(message, jsonrpc.Call):
            await self._receive_call(message)
        else:
            await self._receive_reply(message)

    async def _receive_call(self, call: jsonrpc.Call) -> None:
        try:
            request = decode_request(call.method, call.params)
            outcome = await self._ask(request, call.id if isinstance(call.id, int) else None)
        except (MessageError, BridgeError) as error:
            log.warning("link websocket: robot %r: %s", self.robot, error)
            await self._connection.send(jsonrpc.error(call.id, error_code(error), str(error)))
            return
        await self._respond(call, outcome)
        if isinstance(request, Ready) and outcome.admitted:
            self._deliver_from_the_start()

    async def _ask(self, request: Request, id: int | None) -> Outcome:
        if not isinstance(request, Ready):
            if not self._admitted:
                raise NotReadyError(
                    f"robot {self.robot!r} has not said Ready on this connection; send Ready first"
                )
            return await self._fleet.receive(self.robot, NAME, request, id)
        # A robot that starts anew inside its own connection is no second one.
        self._fleet.holds.free(self.robot, self)
        outcome = await self._fleet.receive(self.robot, NAME, request, id)
        if outcome.admitted:
            self._admitted = True
            self._admit(self)
        return outcome

    async def _respond(self, call: jsonrpc.Call, outcome: Outcome) -> None:
        if call.id is not None:
            await self._connection.send(jsonrpc.result(call.id, to_json(outcome.ack or OpAck())))
        if outcome.answer is not None:
            await self._fleet.finish([outcome], [], acks=False)

    async def _receive_reply(self, reply: jsonrpc.Reply) -> None:
        if not (self._admitted and isinstance(reply.id, int)):
            return
        try:
            ack = OpAck(id=reply.id, ok=reply.error is None, reason=reply.error)
            await self._fleet.receive(self.robot, NAME, ack, None)
        except (MessageError, BridgeError) as error:
            log.warning("link websocket: robot %r: %s", self.robot, error)

    def _deliver_from_the_start(self) -> None:
        """Begin to deliver the outbox; what the robot had not acknowledged is sent to it again."""
        if self._delivery is not None:
            self._delivery.cancel()
        self._delivery = asyncio.create_task(self._deliver())

    async def _deliver(self) -> None:
        last = 0
        event = self._fleet.outbox_event(self.robot)
        while True:
            event.clear()
            try:
                for row in await self._fleet.outbox(self.robot, last):
                    await self._connection.send(jsonrpc.call(row.op, _params(row), row.id))
                    await self._fleet.delivered([row.id])
                    last = row.id
            except ConnectionClosed:
                return
            except StoreError as error:
                log.error("link websocket: robot %r: %s", self.robot, error)
                await asyncio.sleep(1)
                continue
            await event.wait()


def _params(row: AnswerRow) -> dict[str, Any]:
    params: dict[str, Any] = parse_params(row.op, row.params) or {}
    return with_base64(row.op, params, row.payload)
