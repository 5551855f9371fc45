"""Plain JSON-RPC clients of the gateway, written against the protocol and not with the bridge's own code."""

from __future__ import annotations

import base64
import itertools
import json
import time
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from tests.support.bridge.tls_wire import plain_end
from tests.support.patience import BUSY


class RefusedError(Exception):
    """An error that the gateway answered with."""

    def __init__(self, error: dict[str, Any]):
        super().__init__(error["message"])
        self.code = error["code"]
        self.data = error.get("data")
        self.data = error.get("data")


def is_refused(wire: Wire, method: str) -> bool:
    """Call ``method`` and tell whether the gateway refused it."""
    try:
        wire.ask(method)
    except RefusedError:
        return True
    return False


def is_shut(open_wire: Callable[[], Wire]) -> bool:
    """Tell whether nobody gets in without a token."""
    try:
        open_wire().connection.close()
    except InvalidStatus as error:
        return error.response.status_code == 401
    except ConnectionClosed:
        # Let in just before, and put out as the first account came into use.
        return False
    return False


class Wire:
    """One connection. What comes in between is handed to ``_hear``."""

    def __init__(self, url: str, **options: Any):
        if (context := options.pop("ssl", None)) is not None:
            address = urlsplit(url)
            options |= {"unix": True, "sock": plain_end(address.hostname, address.port, context)}
            url = url.replace("wss://", "ws://", 1)
        # All that comes is taken in at once, pings too: a test that does something else is not gone.
        options = {"max_queue": None, "ping_interval": None} | options
        self.connection = connect(url, max_size=None, compression=None, close_timeout=1, **options)
        self._ids = itertools.count(1)

    def ask(self, method: str, params: Any = None, seconds: float = 10.0) -> Any:
        """Call ``method`` and return its result; raises RefusedError."""
        id = next(self._ids)
        frame = {"jsonrpc": "2.0", "method": method, "id": id}
        self.connection.send(json.dumps(frame if params is None else {**frame, "params": params}))
        return self.answer(id, seconds)

    def answer(self, id: Any, seconds: float = 10.0) -> Any:
        """Return the result of call ``id``; ``seconds`` are an idle machine's."""
        until = time.monotonic() + BUSY * seconds
        while True:
            frame = json.loads(self.connection.recv(until - time.monotonic()))
            if "method" in frame:
                self._hear(frame)
            elif frame["id"] == id:
                if "error" in frame:
                    raise RefusedError(frame["error"])
                return frame["result"]

    def tell(self, method: str, params: Any = None) -> None:
        """Send a notification."""
        frame = {"jsonrpc": "2.0", "method": method}
        self.connection.send(json.dumps(frame if params is None else {**frame, "params": params}))

    def until(self, condition: Callable[[], Any], seconds: float = 10.0) -> Any:
        """Listen until ``condition`` is true and return it; ``seconds`` are an idle machine's."""
        until = time.monotonic() + BUSY * seconds
        while not (found := condition()):
            left = until - time.monotonic()
            assert left > 0, f"did not come about within {BUSY * seconds:g} s; {self.state()}"
            try:
                self._hear(json.loads(self.connection.recv(min(left, 0.1))))
            except TimeoutError:
                continue
        return found

    def listen(self, seconds: float) -> None:
        """Take in what comes for ``seconds``."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            try:
                self._hear(json.loads(self.connection.recv(left)))
            except TimeoutError:
                return

    def state(self) -> str:
        """Return what is known, for a failure's message."""
        return ""

    def _hear(self, frame: dict[str, Any]) -> None:
        raise NotImplementedError


class Desk(Wire):
    """An operator's connection; keeps the newest report of each robot, queue and command, all snapshots."""

    def __init__(self, url: str, operator: str, **options: Any):
        super().__init__(url, **options)
        self.robots: dict[str, dict[str, Any]] = {}
        self.commands: dict[str, dict[str, Any]] = {}
        self.queues: dict[str, dict[str, Any]] = {}
        self.observations: dict[int, dict[str, Any]] = {}
        self.snapshots: list[dict[str, Any]] = []
        self.geofence: dict[str, Any] = {}
        self.nearness: dict[str, Any] = {}
        self.suspended: list[dict[str, Any]] = []
        self.links: list[dict[str, Any]] = []
        self.hello = self.ask("hello", {"operator": operator})
        self.site, self.emergency = self.hello["site"], self.hello["emergency"]

    def send(self, command: str, robot: str, op: str, **params: Any) -> dict[str, Any]:
        """Send a command and return its report."""
        report = self.ask("send", {"command": command, "robot": robot, "op": op, "params": params})
        self.commands.setdefault(command, report)
        return report

    def wait_for_robots(self, *names: str, seconds: float = 15.0) -> None:
        """Wait until each robot has said where it is."""
        self.until(lambda: all(self.robots.get(name, {}).get("x") is not None for name in names), seconds)

    def wait_for_step(self, command: str, state: str, seconds: float = 30.0) -> dict[str, Any]:
        """Wait until a command is in ``state``; return its report."""
        self.until(lambda: self.commands.get(command, {}).get("state") == state, seconds)
        return self.commands[command]

    def state(self) -> str:
        return json.dumps({"robots": self.robots, "commands": self.commands, "queues": self.queues}, indent=1)

    def _hear(self, frame: dict[str, Any]) -> None:
        if frame["method"] == "positions":
            self.snapshots.append(frame["params"])
            self.robots.update({robot["robot"]: robot for robot in frame["params"]["robots"]})
        elif frame["method"] == "observation":
            self.observations[frame["params"]["observation"]] = frame["params"]
        elif frame["method"] == "emergency":
            self.emergency = frame["params"]
        elif frame["method"] == "geofence":
            self.geofence = frame["params"]
        elif frame["method"] == "nearness":
            self.nearness = frame["params"]
        elif frame["method"] == "queue":
            self.queues[frame["params"]["robot"]] = frame["params"]
        elif frame["method"] == "suspensions":
            self.suspended = frame["params"]["robots"]
        elif frame["method"] == "links":
            self.links = frame["params"]["links"]
        elif frame["method"] == "command":
            self.commands[frame["params"]["command"]] = frame["params"]


class RobotWire(Wire):
    """A robot's connection; keeps what the gateway asked of it."""

    def __init__(self, url: str, **options: Any):
        super().__init__(url, **options)
        self.calls: list[dict[str, Any]] = []

    def wait_for(self, method: str, seconds: float = 10.0) -> dict[str, Any]:
        """Return the next call of ``method``, and take it off the list."""
        call = self.until(lambda: next((c for c in self.calls if c["method"] == method), None), seconds)
        self.calls.remove(call)
        return call

    def say(self, id: Any, result: Any = None, error: str | None = None) -> None:
        """Answer call ``id`` of the gateway."""
        frame: dict[str, Any] = {"jsonrpc": "2.0", "id": id}
        if error is None:
            frame["result"] = result or {}
        else:
            frame["error"] = {"code": -32000, "message": error}
        self.connection.send(json.dumps(frame))

    def plug_in(self, magic: int, **declared: Any) -> dict[str, Any]:
        """Say Ready and take the map; return the gateway's acknowledgement."""
        ack = self.ask("Ready", {"magic": magic, **declared})
        self.say(self.wait_for("SetMap")["id"])
        return ack

    def state(self) -> str:
        return json.dumps([{**call, "params": str(call.get("params"))[:80]} for call in self.calls])

    def _hear(self, frame: dict[str, Any]) -> None:
        if "method" in frame:
            self.calls.append(frame)


def map_bytes(call: dict[str, Any]) -> bytes:
    """Return the robot map that a SetMap call carries."""
    return base64.b64decode(call["params"]["map"], validate=True)
