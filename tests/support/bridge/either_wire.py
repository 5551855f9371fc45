"""One robot's view of the two wires: ask, be acknowledged or refused, hear. Plain SQL and plain JSON-RPC."""

from __future__ import annotations

import base64
import json
import sqlite3
from typing import Any

from tests.support.bridge.bridge_programs import Bridge, wait_until
from tests.support.bridge.bridge_wires import RefusedError

PAYLOAD = {"SendImage": "image", "SetMap": "map"}


class SqlRobot:
    """A robot that knows nothing but two tables, as the paper's does."""

    def __init__(self, file, name):
        self.connection = sqlite3.connect(file, timeout=5, isolation_level=None)
        self.name = name

    def say(self, op, payload=None, **params):
        """Insert a request and return its id."""
        cursor = self.connection.execute(
            "insert into rr (robot, op, params, payload) values (?, ?, ?, ?)",
            (self.name, op, json.dumps(params), payload),
        )
        return cursor.lastrowid

    def read(self, op, seconds=10.0):
        """Wait for an answer, delete it, and return its id, parameters and payload."""
        query = "select id, params, payload from sa where robot = ? and op = ? order by id limit 1"
        row = wait_until(lambda: self.connection.execute(query, (self.name, op)).fetchone(), seconds, op)
        self.connection.execute("delete from sa where id = ?", (row[0],))
        return row[0], json.loads(row[1] or "{}"), row[2]


class OverSql:
    """A robot on tables rr and sa."""

    def __init__(self, bridge: Bridge, name: str):
        self._robot = SqlRobot(bridge.file, name)

    def ask(self, op: str, params: dict[str, Any], payload: bytes | None = None) -> dict[str, Any]:
        """Say ``op`` and return its OpAck; raises RefusedError."""
        asked = self._robot.say(op, payload, **params)
        while (ack := self._robot.read("OpAck")[1])["id"] != asked:
            continue
        if not ack["ok"]:
            raise RefusedError({"message": ack["reason"], "code": None})
        return ack

    def tell(self, op: str, params: dict[str, Any]) -> None:
        """Say what is not acknowledged."""
        self._robot.say(op, **params)

    def hear(self, op: str) -> Any:
        """Return the parameters of the next ``op``, or its payload, and acknowledge it."""
        id, params, payload = self._robot.read(op)
        self._robot.say("OpAck", id=id)
        return params if payload is None else payload

    def close(self) -> None:
        self._robot.connection.close()


class OverWebSocket:
    """A robot on /robot."""

    def __init__(self, bridge: Bridge, name: str):
        self._wire = bridge.robot(name)

    def ask(self, op: str, params: dict[str, Any], payload: bytes | None = None) -> dict[str, Any]:
        if payload is not None:
            params = {**params, PAYLOAD[op]: base64.b64encode(payload).decode()}
        ack: dict[str, Any] = self._wire.ask(op, params)
        if not ack["ok"]:
            raise RefusedError({"message": ack["reason"], "code": None})
        return ack

    def tell(self, op: str, params: dict[str, Any]) -> None:
        self._wire.tell(op, params)

    def hear(self, op: str) -> Any:
        call = self._wire.wait_for(op)
        self._wire.say(call["id"])
        params = call.get("params", {})
        return base64.b64decode(params[PAYLOAD[op]]) if op in PAYLOAD else params

    def close(self) -> None:
        self._wire.connection.close()


WIRES = {"sql": OverSql, "websocket": OverWebSocket}
