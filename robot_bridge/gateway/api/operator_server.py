"""Server of operators: sessions over WebSocket, and the order of their requests."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from typing import Any

import msgspec
from websockets.exceptions import ConnectionClosed

from ...core.errors import BridgeError, OutdatedError, OverridableError
from ...core.logs import log_and_continue
from ...core.messages import (
    DESK_REQUESTS,
    PROTOCOL_VERSION,
    DeskRequest,
    Hello,
    MessageError,
    PositionForm,
    Role,
    Subscribe,
    to_json,
)
from ...protocol import jsonrpc
from ...protocol.codec import decode_desk_request, error_code
from ..auth.client_connection import ClientConnection
from ..auth.gate import AuthGate
from ..auth.permissions import check_permission
from ..fleet.operator_updates import EVERYTHING, Tick
from ..fleet.service import Fleet
from ..model.request_handlers import RequestHandlers
from .request_scheduler import RequestScheduler, ScheduledRequest

# --- How operators connect: JSON-RPC 2.0 on WebSocket, requests in, positions and commands out ---

log = logging.getLogger(__name__)

OWN = (Hello, Subscribe)
"""Requests that concern the connection itself; everything later goes by them."""
SUBJECTS = ("robot", "session", "operator", "site", "observation", "command", "plan")
"""Parameters that say what a request is about; of several the first."""
UNNOTED = ("hello", "subscribe")
"""Requests that change nothing but the connection they come from."""


class OperatorSession:
    """One operator's connection.

    A slow operator gets fewer snapshots, each of the newest state, and of each command the newest report:
    what waits for it never grows beyond one entry for each robot and command.
    """

    def __init__(
        self, fleet: Fleet, connection: ClientConnection, gate: AuthGate, handlers: RequestHandlers
    ) -> None:
        self._fleet = fleet
        self._handlers = handlers
        self._connection = connection
        self._gate = gate
        assert connection.identity is not None
        self._operator = connection.identity.name or f"desk {connection.address}"
        self._news: dict[tuple[str, str], dict[str, Any]] = {}
        self._news_event = asyncio.Event()
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._lanes = RequestScheduler(self._settle)

    async def run(self) -> None:
        """Serve the connection to its end."""
        self._fleet.listeners.add(self)
        self._start("news", self._push_news())
        try:
            async for frame in self._connection:
                await self._take(frame)
        except ConnectionClosed:
            pass
        finally:
            self._fleet.listeners.discard(self)
            for task in self._tasks.values():
                task.cancel()
            await self._lanes.finish()

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Keep the newest news of ``key`` until they can be sent."""
        self._news[method, key] = params
        self._news_event.set()

    async def _take(self, frame: str | bytes) -> None:
        call = None
        try:
            call = jsonrpc.decode(frame)
            if not isinstance(call, jsonrpc.Call):
                raise jsonrpc.FrameError(jsonrpc.INVALID_REQUEST, "a desk sends requests only", call.id)
            asked = ScheduledRequest(call, decode_desk_request(call.method, call.params), len(frame))
        except Exception as error:
            await self._connection.send(self._refused(call, error))
            return
        if isinstance(asked.request, OWN):
            await self._settle(asked, None)
        else:
            await self._lanes.submit(asked)

    async def _settle(self, asked: ScheduledRequest, refusal: Exception | None) -> None:
        """Do what is asked, unless it is refused, and tell what came of it."""
        with contextlib.suppress(ConnectionClosed):
            await self._connection.send(await self._answer(asked, refusal))

    async def _answer(self, asked: ScheduledRequest, refusal: Exception | None) -> str:
        try:
            if refusal is not None:
                raise refusal
            result = jsonrpc.result(asked.call.id, await self._do(asked.request))
        except Exception as error:
            return self._refused(asked.call, error)
        self._note(asked.call)
        return result

    def _refused(self, call: jsonrpc.Call | jsonrpc.Reply | None, error: Exception) -> str:
        """Return the answer that tells why; called where ``error`` was caught."""
        if isinstance(error, jsonrpc.FrameError):
            return jsonrpc.error(error.id, error.code, str(error))
        code, text = jsonrpc.INTERNAL_ERROR, str(error)
        if isinstance(error, (MessageError, BridgeError)):
            self._fleet.repeated.warn(log, self._key_of(call), f"desk of {self._operator}: {error}")
            code = error_code(error)
        else:
            text = self._fleet.repeated.note_unforeseen(log, self._key_of(call), f"desk of {self._operator}")
        if isinstance(call, jsonrpc.Call):
            self._note(call, text, code)
        return jsonrpc.error(call.id if call else None, code, text, _data_of(error))

    def _key_of(self, call: jsonrpc.Call | jsonrpc.Reply | None) -> tuple[str, ...]:
        """Return what lines of the log about such a request are counted under."""
        method = call.method if isinstance(call, jsonrpc.Call) else ""
        return "desk of", self._operator, method if method in DESK_REQUESTS else "unknown methods"

    def _note(self, call: jsonrpc.Call, refusal: str | None = None, code: int | None = None) -> None:
        """Write down who asked for what to be changed, done or refused, and what a role does not reach."""
        harmless = call.method in UNNOTED or call.method.startswith("get_")
        if call.method not in DESK_REQUESTS or (harmless and code != jsonrpc.FORBIDDEN):
            return
        asked = call.params if isinstance(call.params, dict) else {}
        names = (asked.get(name) for name in SUBJECTS)
        params = msgspec.json.encode(asked).decode()
        self._gate.journal.note(
            self._operator,
            call.method,
            done=refusal is None,
            role=self._gate.role(self._connection).value,
            address=self._connection.address,
            subject=next((str(name) for name in names if name is not None), None),
            # First, since what is too long is cut at its end.
            detail="; ".join(str(text) for text in (refusal, asked.get("override"), params) if text),
        )

    async def _do(self, request: DeskRequest[Any]) -> dict[str, Any]:
        self._fleet.tally.desk[request.method] += 1
        if isinstance(request, Hello):
            return self._hello(request)
        if isinstance(request, Subscribe):
            self._start("positions", self._push_positions(1 / request.rate, request.form))
            return {}
        role = self._gate.role(self._connection)
        override_role = Role(self._fleet.site.settings.commands.override_role)
        check_permission(request, self._operator, role, override_role)
        return await self._handlers.answer(request, self._operator)

    def _hello(self, request: Hello) -> dict[str, Any]:
        if request.protocol != PROTOCOL_VERSION:
            raise MessageError(
                f"hello: protocol {request.protocol} is not spoken here, {PROTOCOL_VERSION} is; "
                "install the plugin and the gateway in the same version"
            )
        if not request.operator.strip():
            raise MessageError("hello: operator is empty; give the operator's name, it goes into the log")
        self._operator = self._gate.name_desk(self._connection, request.operator.strip())
        if (suspensions := self._fleet.suspensions.report()).robots:
            self.notify("suspensions", "", to_json(suspensions))
        if (links := self._fleet.links.report()).links:
            self.notify("links", "", to_json(links))
        return {
            "protocol": PROTOCOL_VERSION,
            "site": to_json(self._fleet.site.report),
            "operator": self._operator,
            "role": self._gate.role(self._connection).value,
            "emergency": to_json(self._fleet.emergency.report()),
            "database": self._fleet.reception.database_id,
        }

    def _start(self, name: str, work: Any) -> None:
        if name in self._tasks:
            self._tasks[name].cancel()
        self._tasks[name] = asyncio.create_task(work)

    async def _push_positions(self, interval: float, form: PositionForm) -> None:
        frame, seen = self._fleet.snapshots.after(EVERYTHING, form=form)
        tick = Tick.last(interval, time.monotonic())
        try:
            while True:
                if frame is not None:
                    await self._connection.send(frame, text=form is PositionForm.ROWS)
                now = time.monotonic()
                due = tick.following(now)
                await asyncio.sleep(due.wait(now))
                missed = due.number > tick.number + 1
                frame, seen = self._fleet.snapshots.after(EVERYTHING if missed else seen, due, form)
                tick = due
        except ConnectionClosed:
            return

    async def _push_news(self) -> None:
        try:
            while True:
                await self._news_event.wait()
                self._news_event.clear()
                news, self._news = self._news, {}
                for (method, _), params in news.items():
                    # What cannot be told of one robot must not keep back what is told of others.
                    with log_and_continue(log, f"news of {method}", except_for=ConnectionClosed):
                        await self._connection.send(jsonrpc.call(method, params))
        except ConnectionClosed:
            return


def _data_of(error: Exception) -> dict[str, Any] | None:
    """Return what the desk has to know of ``error`` besides its text."""
    if isinstance(error, OutdatedError):
        return error.newer
    return {"found": error.found} if isinstance(error, OverridableError) else None
