"""How operators connect: JSON-RPC 2.0 on WebSocket, requests in, positions and commands out."""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from typing import Any

import msgspec
from websockets.exceptions import ConnectionClosed

from . import jsonrpc
from .access.gate import Gate
from .access.visitor import Visitor
from .desk_requests import Caller, answer
from .errors import BridgeError
from .fleet import Fleet
from .messages import (
    DESK_REQUESTS,
    PROTOCOL_VERSION,
    DeskRequest,
    Hello,
    MessageError,
    Subscribe,
    to_json,
)
from .snapshots import EVERYTHING, next_tick
from .wire import decode_desk_request, error_code

log = logging.getLogger(__name__)

UNNOTED = ("hello", "subscribe")
"""Requests that change nothing but the connection they come from."""


class DeskSession:
    """One operator's connection.

    A slow operator gets fewer snapshots, each of the newest state, and of each command the newest report:
    what waits for it never grows beyond one entry for each robot and command.
    """

    def __init__(self, fleet: Fleet, connection: Visitor, gate: Gate) -> None:
        self._fleet = fleet
        self._connection = connection
        self._gate = gate
        assert connection.identity is not None
        self._operator = connection.identity.name or f"desk {connection.address}"
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
        call = None
        try:
            call = jsonrpc.decode(frame)
            if not isinstance(call, jsonrpc.Call):
                raise jsonrpc.FrameError(jsonrpc.INVALID_REQUEST, "a desk sends requests only", call.id)
            result = jsonrpc.result(call.id, await self._do(decode_desk_request(call.method, call.params)))
        except jsonrpc.FrameError as error:
            return jsonrpc.error(error.id, error.code, str(error))
        except (MessageError, BridgeError) as error:
            log.warning("desk of %s: %s", self._operator, error)
            return self._refused(call, error_code(error), str(error))
        except Exception:
            number = secrets.token_hex(4)
            log.exception("desk of %s: internal error %s", self._operator, number)
            text = f"internal error {number}; the gateway's log says more under this number"
            return self._refused(call, jsonrpc.INTERNAL_ERROR, text)
        self._note(call)
        return result

    def _refused(self, call: jsonrpc.Call | jsonrpc.Reply | None, code: int, text: str) -> str:
        if isinstance(call, jsonrpc.Call):
            self._note(call, text, code)
        return jsonrpc.error(call.id if call else None, code, text)

    def _note(self, call: jsonrpc.Call, refusal: str | None = None, code: int | None = None) -> None:
        """Write down who asked for what to be changed, done or refused, and what a role does not reach."""
        harmless = call.method in UNNOTED or call.method.startswith("get_")
        if call.method not in DESK_REQUESTS or (harmless and code != jsonrpc.FORBIDDEN):
            return
        asked = call.params if isinstance(call.params, dict) else {}
        names = (asked.get(name) for name in ("robot", "session", "observation", "command"))
        params = msgspec.json.encode(asked).decode()
        self._gate.journal.note(
            self._operator,
            call.method,
            done=refusal is None,
            role=self._gate.role(self._connection).value,
            address=self._connection.address,
            subject=next((str(name) for name in names if name is not None), None),
            detail=params if refusal is None else f"{refusal}; {params}",
        )

    async def _do(self, request: DeskRequest) -> dict[str, Any]:
        self._fleet.tally.desk[request.method] += 1
        if isinstance(request, Hello):
            return self._hello(request)
        if isinstance(request, Subscribe):
            self._start("positions", self._push_positions(1 / request.rate))
            return {}
        role = self._gate.role(self._connection)
        return await answer(self._fleet, request, Caller(self._operator, role, self._connection.address))

    def _hello(self, request: Hello) -> dict[str, Any]:
        if request.protocol != PROTOCOL_VERSION:
            raise MessageError(
                f"hello: protocol {request.protocol} is not spoken here, {PROTOCOL_VERSION} is; "
                "install the plugin and the gateway in the same version"
            )
        if not request.operator.strip():
            raise MessageError("hello: operator is empty; give the operator's name, it goes into the log")
        self._operator = self._gate.name_desk(self._connection, request.operator.strip()[:128])
        return {
            "protocol": PROTOCOL_VERSION,
            "site": to_json(self._fleet.site.report),
            "operator": self._operator,
            "role": self._gate.role(self._connection).value,
            "emergency": to_json(self._fleet.emergency.report()),
        }

    def _start(self, name: str, work: Any) -> None:
        if name in self._tasks:
            self._tasks[name].cancel()
        self._tasks[name] = asyncio.create_task(work)

    async def _push_positions(self, interval: float) -> None:
        seen = EVERYTHING
        try:
            while True:
                frame, revision = self._fleet.snapshots.after(seen)
                tick = time.monotonic() // interval
                if frame is not None:
                    await self._connection.send(frame, text=True)
                await asyncio.sleep(next_tick(interval))
                missed = time.monotonic() // interval > tick + 1.5
                seen = EVERYTHING if missed else revision
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
