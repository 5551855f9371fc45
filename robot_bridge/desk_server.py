"""How operators connect: JSON-RPC 2.0 on WebSocket, requests in, positions and commands out."""

from __future__ import annotations

import asyncio
import logging
import time
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from . import jsonrpc
from .errors import BridgeError
from .fleet import Fleet
from .messages import (
    PROTOCOL_VERSION,
    AbortAll,
    CommandReport,
    DeskRequest,
    GetCommands,
    GetPositions,
    Hello,
    MessageError,
    RobotReport,
    Send,
    SetPositions,
    Subscribe,
    to_json,
)
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
        self._operator = f"desk {connection.remote_address[0]}"
        self._changed_commands: dict[str, CommandReport] = {}
        self._command_event = asyncio.Event()
        self._tasks: dict[str, asyncio.Task[None]] = {}

    async def run(self) -> None:
        """Serve the connection to its end."""
        self._fleet.listen(self)
        self._start("commands", self._push_commands())
        try:
            async for frame in self._connection:
                await self._connection.send(await self._answer(frame))
        except ConnectionClosed:
            pass
        finally:
            self._fleet.unlisten(self)
            for task in self._tasks.values():
                task.cancel()

    def command_changed(self, command: CommandReport) -> None:
        """Keep the command's newest report until it can be sent."""
        self._changed_commands[command.command] = command
        self._command_event.set()

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
            log.warning("desk of %s: %s", self._operator, error)
            return jsonrpc.error(id, error_code(error), str(error))

    async def _do(self, request: DeskRequest) -> dict[str, Any]:
        if isinstance(request, Hello):
            return self._hello(request)
        if isinstance(request, Subscribe):
            self._start("positions", self._push_positions(1 / request.rate))
            return {}
        if isinstance(request, GetPositions):
            return _positions(self._fleet.reports())
        if isinstance(request, Send):
            return to_json(await self._fleet.send(request, self._operator))
        return _commands(await self._do_with_many(request))

    async def _do_with_many(self, request: SetPositions | AbortAll | GetCommands) -> list[CommandReport]:
        if isinstance(request, SetPositions):
            return await self._fleet.set_positions(request.positions, self._operator)
        if isinstance(request, AbortAll):
            return await self._fleet.abort_all(self._operator, request.command)
        return await self._fleet.commands(request.robot, request.limit)

    def _hello(self, request: Hello) -> dict[str, Any]:
        if request.protocol != PROTOCOL_VERSION:
            raise MessageError(
                f"hello: protocol {request.protocol} is not spoken here, {PROTOCOL_VERSION} is; "
                "install the plugin and the gateway in the same version"
            )
        if not request.operator.strip():
            raise MessageError("hello: operator is empty; give the operator's name, it goes into the log")
        self._operator = request.operator.strip()[:128]
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
                    await self._connection.send(jsonrpc.call("positions", _positions(changed)))
                await asyncio.sleep(interval)
        except ConnectionClosed:
            return

    async def _push_commands(self) -> None:
        try:
            while True:
                await self._command_event.wait()
                self._command_event.clear()
                changed, self._changed_commands = self._changed_commands, {}
                for command in changed.values():
                    await self._connection.send(jsonrpc.call("command", to_json(command)))
        except ConnectionClosed:
            return


def _positions(robots: list[RobotReport]) -> dict[str, Any]:
    return {"t": round(time.time(), 3), "robots": [to_json(robot) for robot in robots]}


def _commands(reports: list[CommandReport]) -> dict[str, Any]:
    return {"commands": [to_json(report) for report in reports]}
