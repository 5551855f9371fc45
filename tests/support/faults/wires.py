"""The two ways in which a robot of these tests speaks to the gateway, written against the wire."""

from __future__ import annotations

import base64
import json
import threading
import time
from collections.abc import Iterable
from typing import Any

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from tests.support.faults.mind import AGAIN_AFTER, Mind
from tests.support.faults.tables import Tables, open_tables

RETRY_AFTER = 0.3
SAY_READY_AGAIN_AFTER = 1.0
LOOK_EVERY = 0.05
"""seconds between two looks at SA."""


class WebSocketRobot:
    """Speaks JSON-RPC; connects again for ever."""

    def __init__(self, mind: Mind, url: str, ended: threading.Event) -> None:
        self._mind = mind
        self._url = f"{url}/robot?robot={mind.name}"
        self._ended = ended
        self._ready = False
        self._calls: dict[int, str] = {}

    def run(self) -> None:
        """Live until told to end."""
        while not self._ended.is_set():
            try:
                with connect(
                    self._url, max_size=None, compression=None, open_timeout=10, close_timeout=5
                ) as wire:
                    self._live(wire)
            except (OSError, TimeoutError, WebSocketException):
                self._ended.wait(RETRY_AFTER)

    def _live(self, wire: ClientConnection) -> None:
        self._ready = False
        self._calls.clear()
        self._mind.untold()
        ready_at = float("inf")
        while not self._ended.is_set():
            try:
                frame = json.loads(wire.recv(LOOK_EVERY))
            except TimeoutError:
                frame = {}
            if frame.get("method") == "Start" or time.time() > ready_at:
                self._call(wire, "Ready", {"magic": self._mind.magic})
                ready_at = float("inf")
            if "method" in frame:
                self._do(wire, frame)
            elif frame and not self._hear_answer(frame):
                ready_at = time.time() + SAY_READY_AGAIN_AFTER
            if self._ready:
                self._tell(wire)

    def _do(self, wire: ClientConnection, frame: dict[str, Any]) -> None:
        params = frame.get("params") or {}
        self._mind.belongs_to(params.get("database"))
        if frame.get("id") is not None:
            self._mind.hear(frame["id"], frame["method"], params)
            wire.send(json.dumps({"jsonrpc": "2.0", "id": frame["id"], "result": {}}))

    def _hear_answer(self, frame: dict[str, Any]) -> bool:
        """Take in the answer to a call; return false when it was a Ready that is refused."""
        op = self._calls.pop(frame["id"], "")
        done = "error" not in frame and frame["result"].get("ok", True)
        if op == "Ready":
            self._ready = done
            return bool(done)
        if done:
            self._mind.taken()
        else:
            self._mind.note("refused", op=op, text=str(frame.get("error", frame.get("result"))))
            self._mind.untold(AGAIN_AFTER)
        return True

    def _tell(self, wire: ClientConnection) -> None:
        now = time.time()
        if (pose := self._mind.pose(now)) is not None:
            wire.send(json.dumps({"jsonrpc": "2.0", "method": "SendPos", "params": pose}))
            self._mind.note("pose", t=now, place=(pose["x"], pose["y"]))
        if (seen := self._mind.observation(now)) is not None:
            image = {} if seen.image is None else {"image": base64.b64encode(seen.image).decode()}
            self._call(wire, seen.op, {**seen.params, **image})

    def _call(self, wire: ClientConnection, op: str, params: dict[str, Any]) -> None:
        id = max(self._calls, default=0) + 1
        self._calls[id] = op
        wire.send(json.dumps({"jsonrpc": "2.0", "id": id, "method": op, "params": params}))


class SqlRobot:
    """Reads and deletes its rows of SA, writes into RR; connects again for ever."""

    def __init__(self, mind: Mind, url: str, ended: threading.Event) -> None:
        self._mind = mind
        self._url = url
        self._ended = ended
        self._ready = False
        self._ready_at = 0.0
        self._unsaid: list[int] = []
        self._heard: set[int] = set()

    def run(self) -> None:
        """Live until told to end."""
        while not self._ended.is_set():
            tables = open_tables(self._mind.name, self._url)
            try:
                self._live(tables)
            except tables.errors as error:
                self._mind.note("cut off", text=" ".join(str(error).split())[:120])
                self._ended.wait(RETRY_AFTER)
            finally:
                tables.close()

    def _live(self, tables: Tables) -> None:
        # What was said last may have been committed or not, and an OpAck does not tell what it is for; that
        # of Ready does, and comes after those of everything before.
        self._ready, self._ready_at = False, 0.0
        while not self._ended.is_set():
            rows = tables.read()
            # What was acted on is acknowledged even if the row is gone when it can be said at last.
            read = self._hear_all(rows)
            self._write(tables, read, self._unsaid)
            self._unsaid = []
            self._ended.wait(LOOK_EVERY)

    def _hear_all(self, rows: Iterable[tuple[int, str, str | None]]) -> list[int]:
        """Take in messages in their order; return the ids of those that can go."""
        read: list[int] = []
        was_ready, is_behind = self._ready, False
        for id, op, params in rows:
            if self._hear(id, op, json.loads(params or "{}")):
                read.append(id)
            else:
                is_behind = True
            if is_behind and self._ready and not was_ready:
                # What stands before the OpAck of Ready is to be done first: it is read again.
                break
        return read

    def _hear(self, id: int, op: str, params: dict[str, Any]) -> bool:
        """Take in a message; return true if it can go.

        Until the gateway has taken this life's Ready the rest is left: it may be sent anew, or is another's.
        """
        self._mind.belongs_to(params.get("database"))
        if op in ("Start", "OpAck") and id in self._heard:
            # It is there again because the transaction in which it was deleted came to nothing.
            return True
        self._heard.add(id)
        if op == "Start":
            self._ready, self._ready_at = False, 0.0
        elif op == "OpAck" and "magic" in params:
            return self._hear_ready(params)
        elif not self._ready:
            # An OpAck of before is for nothing that still waits for one: all of that is told again.
            return op == "OpAck"
        elif op == "OpAck":
            self._hear_ack(params)
        else:
            self._mind.hear(id, op, params)
            if id not in self._unsaid:
                self._unsaid.append(id)
        return True

    def _hear_ready(self, params: dict[str, Any]) -> bool:
        if params["magic"] != self._mind.magic:
            return False
        self._ready = params["ok"]
        self._ready_at = float("inf") if self._ready else time.time() + SAY_READY_AGAIN_AFTER
        self._mind.untold()
        return True

    def _hear_ack(self, params: dict[str, Any]) -> None:
        if params["ok"]:
            self._mind.taken()
        else:
            self._mind.note("refused", text=params.get("reason"))
            self._mind.untold(AGAIN_AFTER)

    def _write(self, tables: Tables, read: list[int], acknowledged: list[int]) -> None:
        """Delete what was read and write what there is to say, in one transaction."""
        now = time.time()
        said: list[tuple[str, dict[str, Any], bytes | None]] = [
            ("OpAck", {"id": id}, None) for id in acknowledged
        ]
        if now >= self._ready_at:
            said.append(("Ready", {"magic": self._mind.magic}, None))
            self._ready_at = float("inf")
        pose = self._mind.pose(now) if self._ready else None
        if pose is not None:
            said.append(("SendPos", pose, None))
        seen = self._mind.observation(now) if self._ready else None
        if seen is not None:
            said.append((seen.op, seen.params, seen.image))
        if read or said:
            tables.write(read, [(op, json.dumps(params), payload) for op, params, payload in said])
        if pose is not None:
            self._mind.note("pose", t=now, place=(pose["x"], pose["y"]))
