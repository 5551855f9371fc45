"""How operators connect: JSON-RPC 2.0 on WebSocket, requests in, positions and commands out."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import replace
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from . import jsonrpc
from .desk_requests import Caller, answer, positions
from .errors import BridgeError
from .fleet import Fleet
from .messages import PROTOCOL_VERSION, DeskRequest, Hello, MessageError, Role, Subscribe, to_json
from .wire import decode_desk_request, error_code

log = logging.getLogger(__name__)


class DeskSession:
    """One operator's connection.

    A slow operator gets fewer snapshots, each of the newest state, and of each command the newest report:
    what waits for it never grows beyond one entry for each robot and command.
    """

    def __init__(self, fleet: Fleet, connection: ServerConnection) -> None:
        self._fleet = fleet
        self._connection = connection
        address = str(connection.remote_address[0])
        self._caller = Caller(f"desk {address}", Role.SUPERVISOR, address)
        self._news: dict[tuple[str, str], dict[str, Any]] = {}
        self._news_event = asyncio.Event()
        self._tasks: dict[str, asyncio.Task[None]] = {}

    async def run(self) -> None:
        """Serve the connection to its end."""
        self._fleet.listen(self)
        self._start("news", self._push_news())
        try:
            async for frame in self._connection:
                await self._connection.send(await self._answer(frame))
        except ConnectionClosed:
            pass
        finally:
            self._fleet.unlisten(self)
            for task in self._tasks.values():
                task.cancel()

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Keep the newest news of ``key`` until they can be sent."""
        self._news[method, key] = params
        self._news_event.set()

    async def _answer(self, frame: str | bytes) -> str:
        id: int | str | None = None
        try:
            call = jsonrpc.decode(frame)
            if not isinstance(call, jsonrpc.Call):
                raise jsonrpc.FrameError(jsonrpc.INVALID_REQUEST, "a desk sends requests only", call.id)
            id = call.id
            return jsonrpc.result(id, await self._do(decode_desk_request(call.method, call.params)))
        except jsonrpc.FrameError as error:
            return jsonrpc.error(error.id, error.code, str(error))
        except (MessageError, BridgeError) as error:
            log.warning("desk of %s: %s", self._caller.operator, error)
            return jsonrpc.error(id, error_code(error), str(error))

    async def _do(self, request: DeskRequest) -> dict[str, Any]:
        if isinstance(request, Hello):
            return self._hello(request)
        if isinstance(request, Subscribe):
            self._start("positions", self._push_positions(1 / request.rate))
            return {}
        return await answer(self._fleet, request, self._caller)

    def _hello(self, request: Hello) -> dict[str, Any]:
        if request.protocol != PROTOCOL_VERSION:
            raise MessageError(
                f"hello: protocol {request.protocol} is not spoken here, {PROTOCOL_VERSION} is; "
                "install the plugin and the gateway in the same version"
            )
        if not request.operator.strip():
            raise MessageError("hello: operator is empty; give the operator's name, it goes into the log")
        self._caller = replace(self._caller, operator=request.operator.strip()[:128])
        return {"protocol": PROTOCOL_VERSION, "site": to_json(self._fleet.site.report)}

    def _start(self, name: str, work: Any) -> None:
        if name in self._tasks:
            self._tasks[name].cancel()
        self._tasks[name] = asyncio.create_task(work)

    async def _push_positions(self, interval: float) -> None:
        seen = -1
        try:
            while True:
                changed = self._fleet.reports(since=seen)
                seen = self._fleet.robots.revision
                if changed:
                    await self._connection.send(jsonrpc.call("positions", positions(changed)))
                await asyncio.sleep(interval)
        except ConnectionClosed:
            return

    async def _push_news(self) -> None:
        try:
            while True:
                await self._news_event.wait()
                self._news_event.clear()
                news, self._news = self._news, {}
                for (method, _), params in news.items():
                    await self._connection.send(jsonrpc.call(method, params))
        except ConnectionClosed:
            return
