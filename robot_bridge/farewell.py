"""The end of a gateway in good order: every client is told, and none of them holds it up."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable

from websockets.asyncio.server import Server, ServerConnection
from websockets.frames import CloseCode

from .access.visitor import Visitor
from .fleet import Fleet
from .messages import Stopping, to_json

REASON = "the gateway ends; connect again after a while"
FIRST_WORDS = 0.1
"""seconds for operators' sessions to send what they are told last."""
CLOSED_WITHIN = 0.8
"""seconds for the closing handshakes, all at once; who has not closed by then is cut off."""


async def say_farewell(server: Server, fleet: Fleet) -> None:
    """Take no more connections, tell operators ``stopping``, and close every connection with code 1012."""
    server.close(close_connections=False)
    fleet.listeners.announce("stopping", "", to_json(Stopping(REASON)))
    await asyncio.sleep(FIRST_WORDS)
    connections: Iterable[ServerConnection] = list(server.connections)
    closing = [asyncio.create_task(_close(connection)) for connection in connections]
    if closing:
        await asyncio.wait(closing, timeout=CLOSED_WITHIN)
    for connection in list(server.handlers):
        connection.transport.abort()
    try:
        async with asyncio.timeout(CLOSED_WITHIN):
            await server.wait_closed()
    except TimeoutError:
        pass  # a handler that does not end, for whatever reason, ends with the process


async def _close(connection: ServerConnection) -> None:
    if isinstance(connection, Visitor):
        await connection.expel(CloseCode.SERVICE_RESTART, REASON)
    else:
        await connection.close(CloseCode.SERVICE_RESTART, REASON)
