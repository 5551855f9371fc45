"""The reference robot's WebSocket: connects, reconnects, and carries messages both ways."""

from __future__ import annotations

import asyncio
import itertools
import logging
from urllib.parse import quote

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI
from websockets.frames import CloseCode

from ..core.clock import ABORTS_WITHIN_S, LONGEST_PAUSE_S, StandstillWatch
from ..core.errors import AccessError, BridgeError
from ..core.logs import end_on_error
from ..core.messages.administration import Gateways
from ..core.messages.base import MessageError, to_json
from ..core.messages.robots import Abort, Observed, OpAck, Ready, Request, Start
from ..core.reconnection import ClientCredentials, GatewayAddresses, connection_failure
from ..protocol import jsonrpc
from ..protocol.codec import decode_answer, params_of
from .agent import Agent

log = logging.getLogger(__name__)

SAY_AGAIN = 1.0
"""seconds after which an observation that the gateway could not store is sent again."""
REPLACED = 4001
"""Close code after another robot has connected under the same name."""
Frame = str
LARGEST_FRAME = 64 << 20
"""bytes; a whole city's map comes in one frame."""


class RobotWebSocketLink:
    """Sends the agent's messages while connected; others are dropped as outdated.

    Observations are kept, and sent again after the next Ready, until the gateway has acknowledged them. If
    several gateways serve the fleet, it continues at another one when its own does not answer. Of messages
    that waited on a connection while this program stood still for ``longest_pause_s`` seconds, only an Abort
    is obeyed: the rest may be outdated. Messages that still apply are repeated on the next connection.
    """

    def __init__(
        self,
        url: str,
        robot: str,
        credentials: ClientCredentials | None = None,
        longest_pause_s: float = LONGEST_PAUSE_S,
    ) -> None:
        self._credentials = credentials or ClientCredentials()
        self._addresses = GatewayAddresses(url, has_token=self._credentials.token_file is not None)
        self._robot = robot
        self._outgoing: asyncio.Queue[Request | Frame] = asyncio.Queue()
        """Outgoing messages in order: a reply does not overtake earlier messages."""
        self._longest_pause_s = longest_pause_s
        self._standstill = StandstillWatch(longest_pause_s)
        self._connected = False
        self._ids = itertools.count(1)
        self._unsent: list[Observed] = []
        self._pending_requests: dict[int, Request] = {}

    @property
    def _url(self) -> str:
        address = self._addresses.current
        return f"{address}{'&' if '?' in address else '?'}robot={quote(self._robot)}"

    @property
    def unacknowledged_observations(self) -> int:
        """The number of observations that the gateway has not acknowledged yet."""
        return len(self._unsent)

    def say(self, request: Request) -> None:
        """Send a request, if connected."""
        if isinstance(request, Observed):
            self._unsent.append(request)
        if not self._connected:
            return
        self._outgoing.put_nowait(request)
        if isinstance(request, Ready):
            for observed in self._unsent:
                self._outgoing.put_nowait(observed)

    async def run(self, agent: Agent) -> None:
        """Carry messages until cancelled; raises BridgeError for an invalid URL."""
        while True:
            url, ends = self._url, False
            try:
                options = {**self._credentials.options(url), **self._addresses.options()}
                async with connect(url, max_size=LARGEST_FRAME, **options) as connection:
                    await self._carry(connection, agent)
                reason = "the gateway closed the connection"
            except (InvalidURI, AccessError) as error:
                if self._addresses.is_given:
                    raise _to_put_right(error) from None
                reason = str(error)
            except ConnectionClosed as error:
                code = None if error.rcvd is None else error.rcvd.code
                if code == REPLACED:
                    raise BridgeError(
                        f"{url}: another robot has connected under this name; give each its own --name"
                    ) from None
                reason, ends = str(error), code == CloseCode.SERVICE_RESTART
            except (OSError, InvalidHandshake) as error:
                reason = connection_failure(error)
            wait = self._addresses.next_wait(ends=ends)
            log.warning("%s: %s; trying again in %.1f s at %s", url, reason, wait, self._addresses.current)
            await asyncio.sleep(wait)

    async def _carry(self, connection: ClientConnection, agent: Agent) -> None:
        self._outgoing = asyncio.Queue()
        self._pending_requests = {}
        self._standstill = StandstillWatch(self._longest_pause_s)
        tasks = [
            asyncio.create_task(self._send_all(connection)),
            asyncio.create_task(self._end_when_old(connection, agent)),
        ]
        try:
            async for frame in connection:
                if self._standstill.check():
                    agent.wait_for_gateway()
                self._receive(agent, frame)
        finally:
            self._connected = False
            for task in tasks:
                task.cancel()
            if self._standstill.check():
                agent.wait_for_gateway()

    async def _end_when_old(self, connection: ClientConnection, agent: Agent) -> None:
        """End a connection whose received messages are too old."""
        await self._standstill.wait()
        agent.wait_for_gateway()
        log.warning(
            "robot %s stood still for %.0f s: it waits for the gateway", self._robot, self._standstill.seconds
        )
        await asyncio.sleep(ABORTS_WITHIN_S)
        # After an orderly close the robot would count as switched off.
        connection.transport.abort()

    async def _send_all(self, connection: ClientConnection) -> None:
        with end_on_error(log, f"robot {self._robot}: sending", connection, ConnectionClosed):
            while True:
                request = await self._outgoing.get()
                if isinstance(request, str):
                    await connection.send(request)
                    continue
                id = next(self._ids) if request.acknowledged else None
                if id is not None:
                    self._pending_requests[id] = request
                await connection.send(jsonrpc.call(type(request).__name__, params_of(request), id))

    def _receive(self, agent: Agent, frame: str | bytes) -> None:
        try:
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            log.error("%s: %s", self._url, error)
            return
        if isinstance(message, jsonrpc.Reply):
            self._receive_reply(agent, message)
            return
        if self._standstill.check() and message.method != Abort.__name__:
            return
        if message.method == Gateways.method:
            params = message.params if isinstance(message.params, dict) else {}
            self._addresses.learn(params.get("gateways"))
            return
        # Nothing is sent before the gateway's Start.
        self._connected = True
        id = message.id if isinstance(message.id, int) else None
        try:
            answer = decode_answer(message.method, message.params)
            if isinstance(answer, Start):
                self._addresses.answered()
                self._addresses.learn(answer.gateways)
            ack = agent.receive(answer, id)
        except MessageError as error:
            self._outgoing.put_nowait(jsonrpc.error(message.id, jsonrpc.INVALID_PARAMS, str(error)))
            return
        if message.id is not None:
            self._outgoing.put_nowait(_reply(message.id, ack or OpAck(id=id)))

    def _receive_reply(self, agent: Agent, reply: jsonrpc.Reply) -> None:
        request = self._pending_requests.pop(reply.id, None) if isinstance(reply.id, int) else None
        ack = _acknowledgement(reply)
        self._addresses.learn(ack.gateways)
        if isinstance(request, Observed) and reply.code == jsonrpc.INTERNAL_ERROR:
            # Observations that could not be stored are sent again; invalid ones are not.
            asyncio.get_running_loop().call_later(SAY_AGAIN, self._outgoing.put_nowait, request)
        elif isinstance(request, Observed) and request in self._unsent:
            self._unsent.remove(request)
        if not ack.ok:
            log.error("the gateway refused %s: %s", type(request).__name__, ack.reason)
        agent.receive(ack, None)


def _acknowledgement(reply: jsonrpc.Reply) -> OpAck:
    if reply.error is not None:
        return OpAck(ok=False, reason=reply.error)
    try:
        answer = decode_answer("OpAck", reply.result)
    except MessageError as error:
        return OpAck(ok=False, reason=f"its answer cannot be read: {error}")
    return answer if isinstance(answer, OpAck) else OpAck()


def _to_put_right(error: InvalidURI | AccessError) -> BridgeError:
    if isinstance(error, BridgeError):
        return error
    return BridgeError(f"{error}; write the URL as ws://127.0.0.1:8765/robot")


def _reply(id: int | str, ack: OpAck) -> str:
    if ack.ok:
        return jsonrpc.result(id, to_json(ack))
    return jsonrpc.error(id, jsonrpc.REFUSED, ack.reason or "no reason given")
