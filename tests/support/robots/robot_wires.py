"""What a robot says to the gateway and hears from it: one client for each of the two wires.

Plain JSON-RPC and plain SQL, as the integrator's guide has them. How robots behave is said by those who use
these: the tests themselves, :mod:`tests.support.faults.mind`, :mod:`tests.support.hostile.siege`.
"""

from __future__ import annotations

import base64
import json
import time
from collections.abc import Iterable, Sequence
from typing import Any

from robot_bridge.protocol.jsonrpc import INTERNAL_ERROR
from tests.support.databases.database_client import DatabaseClient
from tests.support.patience import BUSY
from tests.support.wire import RefusedError, Wire

PAYLOAD = {"SendImage": "image"}
"""The parameter that is the payload on SQL."""
READ = "select id, op, params, payload from sa where robot = ? order by urgent desc, id"
DELETE = "delete from sa where robot = ? and id = ?"
INSERT = "insert into rr (robot, op, params, payload) values (?, ?, ?, ?)"


class RobotWire(Wire):
    """A robot's connection; keeps what the gateway asked of it."""

    def __init__(self, url: str, **options: Any):
        super().__init__(url, **options)
        self.calls: list[dict[str, Any]] = []

    def ask(self, method: str, params: Any = None, payload: bytes | None = None, **how: Any) -> Any:
        """Call ``method``, with a payload where it has one, and return its result; raises RefusedError."""
        if payload is not None:
            params = {**params, PAYLOAD[method]: base64.b64encode(payload).decode()}
        result = super().ask(method, params, **how)
        if result.get("ok") is False:
            raise RefusedError({"message": result["reason"], "code": None})
        return result

    def hear(self, op: str) -> Any:
        """Return the parameters of the next ``op``, or its payload, and acknowledge it."""
        call = self.wait_for(op)
        self.say(call["id"])
        return map_bytes(call) if op == "SetMap" else call.get("params", {})

    def close(self) -> None:
        """Close the connection."""
        self.connection.close()

    def wait_for(self, method: str, seconds: float = 10.0) -> dict[str, Any]:
        """Return the next call of ``method``, and take it off the list."""
        call = self.until(lambda: next((c for c in self.calls if c["method"] == method), None), seconds)
        self.calls.remove(call)
        return call

    def obey_until(self, method: str, seconds: float = 10.0) -> dict[str, Any]:
        """Acknowledge every call up to the next one of ``method``, and return that."""
        while True:
            self.until(lambda: self.calls, seconds)
            call = self.calls.pop(0)
            if call.get("id") is not None:
                self.say(call["id"])
            if call["method"] == method:
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
        """Say Ready and take the map; return the gateway's acknowledgement.

        Said again, as robots do, where it cannot be stored just now: a gateway that was stopped in the middle
        of a transaction holds its rows until the server ends that.
        """
        until = time.monotonic() + 5 * BUSY
        while True:
            try:
                ack: dict[str, Any] = self.ask("Ready", {"magic": magic, **declared})
                break
            except RefusedError as error:
                if error.code != INTERNAL_ERROR or time.monotonic() > until:
                    raise
                time.sleep(0.2)
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


class SqlRobot(DatabaseClient):
    """A robot that knows nothing but tables rr and sa, as the paper's does.

    ``url`` is that of its own account, where the database has accounts.
    """

    def __init__(self, url: str, name: str):
        super().__init__(url)
        self.name = name

    @property
    def errors(self) -> tuple[type[Exception], ...]:
        """What statements raise when the database cannot be reached, or does not want them."""
        return (self.driver.Error, OSError)

    def waiting(self) -> list[tuple[Any, ...]]:
        """Return what waits for the robot, in the order in which it counts: id, op, params, payload."""
        return self.sql(READ, self.name)

    def write(self, op: Any, params: Any = None, payload: bytes | None = None) -> None:
        """Write a request as it is."""
        self.sql(INSERT, self.name, op, params, payload)

    def exchange(self, read: Sequence[int], said: Iterable[tuple[str, str, bytes | None]]) -> None:
        """Delete what was read and write requests (op, params, payload), in one transaction."""
        self.sql("begin")
        for id in read:
            self.sql(DELETE, self.name, id)
        for request in said:
            self.write(*request)
        self.sql("commit")

    def say(self, op: str, payload: bytes | None = None, **params: Any) -> int:
        """Insert a request and return its id, which SQLite tells."""
        ((id,),) = self.sql(f"{INSERT} returning id", self.name, op, json.dumps(params), payload)
        return int(id)

    def ask(self, op: str, params: dict[str, Any], payload: bytes | None = None) -> dict[str, Any]:
        """Say ``op`` and return its OpAck; raises RefusedError."""
        asked = self.say(op, payload, **params)
        while (ack := self.read("OpAck")[1])["id"] != asked:
            continue
        if not ack["ok"]:
            raise RefusedError({"message": ack["reason"], "code": None})
        return ack

    def tell(self, op: str, params: dict[str, Any]) -> None:
        """Say what is not acknowledged."""
        self.say(op, **params)

    def hear(self, op: str) -> Any:
        """Return the parameters of the next ``op``, or its payload, and acknowledge it."""
        id, params, payload = self.read(op)
        self.say("OpAck", id=id)
        return params if payload is None else payload

    def read(self, op: str, seconds: float = 10.0) -> tuple[int, dict[str, Any], bytes | None]:
        """Wait for an answer, delete it, and return its id, parameters and payload.

        ``seconds`` are an idle machine's.
        """
        until = time.monotonic() + BUSY * seconds
        while not (found := [row for row in self.waiting() if row[1] == op]):
            assert time.monotonic() < until, f"no {op} for {self.name} within {BUSY * seconds:g} s"
            time.sleep(0.01)
        id, _, params, payload = found[0]
        self.sql(DELETE, self.name, id)
        return id, json.loads(params or "{}"), payload


WIRES = {
    "sql": lambda bridge, name: SqlRobot(bridge.database, name),
    "websocket": lambda bridge, name: bridge.robot(name),
}
"""Robots of one gateway by their wire. Each is asked, tells and hears in the same words."""
