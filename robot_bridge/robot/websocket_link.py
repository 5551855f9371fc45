"""The reference robot's WebSocket: connects, connects again, and carries messages both ways."""

from __future__ import annotations

import asyncio
import itertools
import logging
import random
from typing import Any
from urllib.parse import quote

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI

from .. import jsonrpc
from ..errors import BridgeError
from ..messages import MessageError, OpAck, Request, to_json
from ..wire import decode_answer, decode_map
from .agent import Agent

log = logging.getLogger(__name__)

FIRST_WAIT = 0.5
LONGEST_WAIT = 10.0
REPLACED = 4001
"""Close code of a gateway to which another robot has connected under the same name."""
LARGEST_FRAME = 64 << 20
"""bytes; a whole city's map comes in one frame."""


class WebSocketLink:
    """Carries what the agent says while connected; what it says in between is dropped as out of date."""

    def __init__(self, url: str, robot: str) -> None:
        self._url = f"{url}{'&' if '?' in url else '?'}robot={quote(robot)}"
        self._outgoing: asyncio.Queue[Request] = asyncio.Queue()
        self._connected = False
        self._ids = itertools.count(1)

    def say(self, request: Request) -> None:
        """Send a request, if connected."""
        if self._connected:
            self._outgoing.put_nowait(request)

    async def run(self, agent: Agent) -> None:
        """Carry messages until cancelled; raises BridgeError for a URL that cannot be right."""
        wait = FIRST_WAIT
        while True:
            try:
                async with connect(self._url, max_size=LARGEST_FRAME, close_timeout=1) as connection:
                    wait = FIRST_WAIT
                    await self._carry(connection, agent)
                reason = "the gateway closed the connection"
            except InvalidURI as error:
                raise BridgeError(f"{error}; write the URL as ws://127.0.0.1:8765/robot") from None
            except ConnectionClosed as error:
                if error.rcvd is not None and error.rcvd.code == REPLACED:
                    raise BridgeError(
                        f"{self._url}: another robot has connected under this name; give each its own --name"
                    ) from None
                reason = str(error)
            except (OSError, InvalidHandshake) as error:
                reason = str(error)
            log.warning("%s: %s; trying again in %.1f s", self._url, reason, wait)
            await asyncio.sleep(wait * random.uniform(0.8, 1.2))
            wait = min(wait * 2, LONGEST_WAIT)

    async def _carry(self, connection: ClientConnection, agent: Agent) -> None:
        self._outgoing = asyncio.Queue()
        self._connected = True
        sending = asyncio.create_task(self._send_all(connection))
        try:
            async for frame in connection:
                await self._receive(connection, agent, frame)
        finally:
            self._connected = False
            sending.cancel()

    async def _send_all(self, connection: ClientConnection) -> None:
        try:
            while True:
                request = await self._outgoing.get()
                id = next(self._ids) if request.acknowledged else None
                await connection.send(jsonrpc.call(type(request).__name__, to_json(request), id))
        except ConnectionClosed:
            return

    async def _receive(self, connection: ClientConnection, agent: Agent, frame: str | bytes) -> None:
        try:
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            log.error("%s: %s", self._url, error)
            return
        if isinstance(message, jsonrpc.Reply):
            if message.error is not None:
                log.error("the gateway refused request %s: %s", message.id, message.error)
            return
        id = message.id if isinstance(message.id, int) else None
        try:
            ack = agent.receive(_answer(message), id)
        except MessageError as error:
            await connection.send(jsonrpc.error(id, jsonrpc.INVALID_PARAMS, str(error)))
            return
        if id is not None:
            await connection.send(_reply(id, ack or OpAck(id=id)))


def _answer(call: jsonrpc.Call) -> Any:
    if call.method != "SetMap" or not isinstance(call.params, dict) or "map" not in call.params:
        return decode_answer(call.method, call.params)
    return decode_answer(call.method, None, decode_map(call.params["map"]))


def _reply(id: int, ack: OpAck) -> str:
    if ack.ok:
        return jsonrpc.result(id, to_json(ack))
    return jsonrpc.error(id, jsonrpc.REFUSED, ack.reason or "no reason given")
