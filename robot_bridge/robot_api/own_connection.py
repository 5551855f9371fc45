"""A robot's own WebSocket: JSON-RPC 2.0 with the operation codes of the paper as methods.

A robot's requests are calls (SendPos and Alive may be notifications), and the gateway's OpAck is the
result. The gateway's messages are calls whose id is that of the message; the robot's OpAck is the result,
or an error where it will not do it.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, nullcontext
from typing import Any

from websockets.exceptions import ConnectionClosed, ConnectionClosedOK

from .. import jsonrpc
from ..access.visitor import Visitor
from ..fleet import Fleet
from ..messages import to_json
from ..messages.bounds import LARGEST_MESSAGE
from ..store.database import to_its_end
from ..wire import check_size, decode_position
from .robot_session import RobotSession

NAME = "websocket"
PIECE = 1 << 18
"""characters of a message that are sent as one frame."""
PING_TIMEOUT = 1.0
"""seconds after which a robot counts as gone when another one comes under its name."""
REPLACED = 4001
"""Close code for a connection whose robot has connected anew."""


class OwnChannel:
    """The WebSocket of one robot, as its :class:`.channel.Channel`."""

    name = NAME

    def __init__(self, connection: Visitor) -> None:
        self._connection = connection

    @property
    def round_trip(self) -> float | None:
        """Seconds that the last ping took there and back."""
        return self._connection.round_trip

    def call(self, method: str, params: Any = None, id: int | str | None = None) -> str:
        """Return the frame of a request."""
        return jsonrpc.call(method, params, id)

    def result(self, id: int | str | None, value: Any) -> str:
        """Return the frame of a result."""
        return jsonrpc.result(id, value)

    def error(self, id: int | str | None, code: int, text: str) -> str:
        """Return the frame of an error."""
        return jsonrpc.error(id, code, text)

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for nobody: the connection is the robot's alone."""
        return nullcontext()

    async def send(self, frame: str) -> None:
        """Send a frame."""
        await send_frame(self._connection, frame)

    async def answers(self) -> bool:
        """Tell whether the robot answers a ping within a second."""
        return await is_answering(self._connection)

    async def release(self, reason: str) -> None:
        """Close the connection."""
        await self._connection.close(REPLACED, reason)


class OwnConnection:
    """One connection of one robot, from its Start to its end."""

    def __init__(
        self, fleet: Fleet, connection: Visitor, robot: str, admit: Callable[[RobotSession], None]
    ) -> None:
        self._fleet = fleet
        self._connection = connection
        self._channel = OwnChannel(connection)
        self.session = RobotSession(fleet, self._channel, robot, admit)

    async def run(self) -> bool:
        """Serve the connection to its end; return true if the robot closed it in good order."""
        try:
            greeting = to_json(self._fleet.reception.greeting())
            await self._connection.send(self._channel.call("Start", greeting))
            if (call_id := self._fleet.emergency.call_id) is not None:
                self.session.stop_now(call_id)
            self._connection.short_cut.handler = self._take_at_once
            async for frame in self._connection:
                if not self.session.is_replaced:
                    await self._receive(frame)
        except ConnectionClosedOK:
            return True
        except ConnectionClosed:
            return False
        finally:
            self.session.end()
        return self._connection.close_code in (1000, 1001)

    def _take_at_once(self, frame: bytes) -> bool:
        """Take in a position; false for everything else, and while something must be waited for."""
        pose = decode_position(frame)
        return pose is not None and self.session.take_pose(pose)

    async def _receive(self, frame: str | bytes) -> None:
        if len(frame) <= LARGEST_MESSAGE and (pose := decode_position(frame)) is not None:
            await self.session.receive_pose(pose)
            return
        large = True
        try:
            check_size(frame, LARGEST_MESSAGE)
            large = False
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            await self.session.refuse_frame(error, large=large)
            return
        await self.session.receive(message)


async def send_frame(connection: Visitor, frame: str) -> None:
    """Send a message, a large one in several frames: as one it would hold the gateway up while it is copied.

    It is sent to its end though whoever sends it is cancelled: nothing could follow one that is cut off.
    """
    if len(frame) <= PIECE:
        await connection.send(frame)
    else:
        await to_its_end(connection.send(_pieces(frame)))


async def _pieces(frame: str) -> AsyncIterator[str]:
    for begin in range(0, len(frame), PIECE):
        yield frame[begin : begin + PIECE]
        # A connection that takes everything at once waits for nothing, and others are to have their turn.
        await asyncio.sleep(0)


async def is_answering(connection: Visitor) -> bool:
    """Tell whether a client answers a ping within a second."""
    try:
        async with asyncio.timeout(PING_TIMEOUT):
            await (await connection.ping())
    except (ConnectionClosed, TimeoutError):
        return False
    return True
