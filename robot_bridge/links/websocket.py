"""Robots on WebSocket: JSON-RPC 2.0 with the operation codes of the paper as methods.

A robot's requests are calls (SendPos and Alive may be notifications), and the gateway's OpAck is the
result. The gateway's messages are calls whose id is that of the message; the robot's OpAck is the result,
or an error where it will not do it.
"""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections import Counter
from collections.abc import Callable

from websockets.exceptions import ConnectionClosed, ConnectionClosedOK

from .. import jsonrpc
from ..access.visitor import Visitor
from ..errors import BridgeError, NotReadyError, StoreError
from ..exchange import Outcome
from ..fleet import Fleet
from ..messages import MessageError, OpAck, Ready, Request, to_json
from ..wire import decode_position, decode_request, error_code
from .delivery import Delivery

log = logging.getLogger(__name__)

NAME = "websocket"
POSITION = jsonrpc.Call("SendPos", None)
PING_TIMEOUT = 1.0
"""seconds after which a robot counts as gone when another one comes under its name."""
REPLACED = 4001
"""Close code for a connection whose robot has connected anew."""


class WebSocketLink:
    """Serves the connections of robots; the one on which a robot said Ready last is the one that counts."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._names: Counter[str] = Counter()
        self._sessions: set[RobotSession] = set()
        self._holders: dict[str, RobotSession] = {}
        fleet.emergency.reach(self._stop_all)

    async def serve(self, connection: Visitor, robot: str | None) -> None:
        """Serve one connection to its end; without a name the robot is given one."""
        name = robot or self._free_name()
        session = RobotSession(self._fleet, connection, name, self._admit)
        self._names[name] += 1
        self._sessions.add(session)
        try:
            in_order = await session.run()
        finally:
            self._sessions.discard(session)
            self._names -= Counter([name])
            held = self._holders.get(name) is session
            if held:
                self._fleet.holds.free(name, session)
                del self._holders[name]
        if in_order and held:
            self._fleet.closed(name)

    def measure(self) -> None:
        """Note the latency of every robot's connection."""
        for session in self._holders.values():
            session.measure()

    def _stop_all(self, call_id: str) -> None:
        for session in self._sessions:
            session.stop_now(call_id)

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
            await self._connection.send(jsonrpc.call("Start", to_json(self._fleet.greeting())))
            if (call_id := self._fleet.emergency.call_id) is not None:
                self.stop_now(call_id)
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

    async def _receive(self, frame: str | bytes) -> None:
        if (pose := decode_position(frame)) is not None:
            await self._receive_call(POSITION, pose)
            return
        try:
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            await self._connection.send(jsonrpc.error(error.id, error.code, str(error)))
            return
        if isinstance(message, jsonrpc.Call):
            await self._receive_call(message)
        else:
            await self._receive_reply(message)

    async def _receive_call(self, call: jsonrpc.Call, request: Request | None = None) -> None:
        try:
            request = request or decode_request(call.method, call.params)
            outcome = await self._ask(request, call.id if isinstance(call.id, int) else None)
        except (MessageError, BridgeError) as error:
            self._fleet.tally.refused[NAME] += 1
            log.warning("link websocket: robot %r: %s", self.robot, error)
            await self._connection.send(jsonrpc.error(call.id, error_code(error), str(error)))
            return
        except ConnectionClosed:
            raise
        except Exception:
            number = secrets.token_hex(4)
            log.exception("link websocket: robot %r: internal error %s", self.robot, number)
            text = f"internal error {number}; the gateway's log says more under this number"
            await self._connection.send(jsonrpc.error(call.id, jsonrpc.INTERNAL_ERROR, text))
            return
        await self._respond(call, outcome)
        if isinstance(request, Ready) and outcome.admitted:
            self._delivery.begin()

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
        if not self._admitted:
            return
        if isinstance(reply.id, str):
            self._fleet.emergency.answered(self.robot, reply.id, refused=reply.error is not None)
            return
        try:
            ack = OpAck(id=reply.id, ok=reply.error is None, reason=reply.error)
            await self._fleet.receive(self.robot, NAME, ack, None)
        except StoreError as error:
            log.warning("link websocket: robot %r: %s; it will be asked again", self.robot, error)
            self._delivery.begin()
        except (MessageError, BridgeError) as error:
            log.warning("link websocket: robot %r: %s", self.robot, error)
        except Exception:
            log.exception(
                "link websocket: robot %r: internal error in acknowledgement %s", self.robot, reply.id
            )
