"""A robot's life on either wire, in a thread or turn by turn: it comes back for ever.

What it says is never lost, whatever dies: it says again what may not have been heard, does once what it hears
twice, and leaves what is not for this life. What it does and remembers is its mind's, which has what
:class:`tests.support.faults.mind.Mind` has.
"""

from __future__ import annotations

import base64
import itertools
import json
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from websockets.exceptions import WebSocketException

from tests.support.robots.robot_wires import RobotWire, SqlRobot

RETRY_AFTER = 0.3
AGAIN_AFTER = 1.0
"""seconds after which a refused request is said again, under the same source."""
SAY_READY_AGAIN_AFTER = 1.0
LOOK_EVERY = 0.1
"""seconds between two looks at SA."""


@dataclass
class Said:
    """A request that is said until the gateway has acknowledged it."""

    op: str
    params: dict[str, Any]
    image: bytes | None = None
    say_at: float = 0.0


class MindOverWebSocket:
    """Speaks JSON-RPC; connects again for ever, of several addresses with commas between them to the next."""

    def __init__(self, mind: Any, url: str) -> None:
        self._mind = mind
        self._addresses = itertools.cycle(url.split(","))
        self._address = ""
        self._ready = False
        self._calls: dict[int, str] = {}

    def run(self, ended: threading.Event) -> None:
        """Live until told to end."""
        while not ended.is_set():
            self._address = next(self._addresses)
            try:
                url = f"{self._address}/robot?robot={self._mind.name}"
                with RobotWire(url, open_timeout=10, close_timeout=5) as wire:
                    self._live(wire, ended)
            except (OSError, TimeoutError, WebSocketException):
                ended.wait(RETRY_AFTER)

    def _live(self, wire: RobotWire, ended: threading.Event) -> None:
        self._ready = False
        self._calls.clear()
        self._mind.unsent()
        ready_at = float("inf")
        while not ended.is_set():
            frame = wire.receive(LOOK_EVERY)
            if frame.get("method") == "Start" or time.time() > ready_at:
                self._calls[wire.begin("Ready", {"magic": self._mind.magic})] = "Ready"
                ready_at = float("inf")
            if "method" in frame:
                self._do(wire, frame)
            elif frame and not self._hear_answer(frame):
                ready_at = time.time() + SAY_READY_AGAIN_AFTER
            if self._ready:
                self._tell(wire)

    def _do(self, wire: RobotWire, frame: dict[str, Any]) -> None:
        params = frame.get("params") or {}
        self._mind.belongs_to(params.get("database"))
        if frame.get("id") is not None:
            self._mind.hear(frame["id"], frame["method"], params)
            wire.say(frame["id"])

    def _hear_answer(self, frame: dict[str, Any]) -> bool:
        """Take in the answer to a call; return false when it was a Ready that is refused."""
        op = self._calls.pop(frame["id"], "")
        done = "error" not in frame and frame["result"].get("ok", True)
        if op == "Ready":
            self._ready = done
            if done:
                self._mind.note("ready", address=self._address)
            return bool(done)
        if done:
            self._mind.acknowledged()
        else:
            self._mind.note("refused", op=op, text=str(frame.get("error", frame.get("result"))))
            self._mind.unsent(AGAIN_AFTER)
        return True

    def _tell(self, wire: RobotWire) -> None:
        now = time.time()
        if (pose := self._mind.pose(now)) is not None:
            wire.tell("SendPos", pose)
            self._mind.note("pose", t=now, place=(pose["x"], pose["y"]))
        if (seen := self._mind.request(now)) is not None:
            image = {} if seen.image is None else {"image": base64.b64encode(seen.image).decode()}
            self._calls[wire.begin(seen.op, {**seen.params, **image})] = seen.op


class MindOverSql:
    """Reads and deletes its rows of SA, writes into RR; connects again for ever.

    ``clock`` tells the time that the mind goes by.
    """

    def __init__(self, mind: Any, url: str, clock: Callable[[], float] = time.time) -> None:
        self._mind, self._clock = mind, clock
        self._robot = SqlRobot(url, mind.name)
        self._unsaid: list[int] = []
        self._heard: set[int] = set()
        self.begin()

    def run(self, ended: threading.Event) -> None:
        """Live until told to end."""
        while not ended.is_set():
            self.begin()
            try:
                while not ended.is_set():
                    self.turn()
                    ended.wait(LOOK_EVERY)
            except self._robot.errors as error:
                self._mind.note("cut off", text=" ".join(str(error).split())[:120])
                ended.wait(RETRY_AFTER)
            finally:
                self.close()

    def close(self) -> None:
        """End the connection; the next turn makes another."""
        self._robot.close()

    def begin(self) -> None:
        """Say Ready with the next turn.

        What was said last may have been committed or not, and an OpAck does not tell what it is for; that of
        Ready does, and comes after those of everything before.
        """
        self._ready, self._ready_at = False, 0.0

    def turn(self) -> None:
        """Read and write what there is to read and to write; raises the driver's errors."""
        # What was acted on is acknowledged even if the row is gone when it can be said at last.
        read = self._hear_all(self._robot.waiting())
        self._write(read, self._unsaid)
        self._unsaid = []

    def _hear_all(self, rows: Iterable[tuple[Any, ...]]) -> list[int]:
        """Take in messages in their order; return the ids of those that can go."""
        read: list[int] = []
        was_ready, is_behind = self._ready, False
        for id, op, params, _ in rows:
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
        self._ready_at = float("inf") if self._ready else self._clock() + SAY_READY_AGAIN_AFTER
        self._mind.unsent()
        return True

    def _hear_ack(self, params: dict[str, Any]) -> None:
        if params["ok"]:
            self._mind.acknowledged()
        else:
            self._mind.note("refused", text=params.get("reason"))
            self._mind.unsent(AGAIN_AFTER)

    def _write(self, read: list[int], acknowledged: list[int]) -> None:
        """Delete what was read and write what there is to say, in one transaction."""
        now = self._clock()
        said: list[tuple[str, dict[str, Any], bytes | None]] = [
            ("OpAck", {"id": id}, None) for id in acknowledged
        ]
        if now >= self._ready_at:
            said.append(("Ready", {"magic": self._mind.magic}, None))
            self._ready_at = float("inf")
        pose = self._mind.pose(now) if self._ready else None
        if pose is not None:
            said.append(("SendPos", pose, None))
        seen = self._mind.request(now) if self._ready else None
        if seen is not None:
            said.append((seen.op, seen.params, seen.image))
        if read or said:
            self._robot.exchange(read, [(op, json.dumps(params), payload) for op, params, payload in said])
        if pose is not None:
            self._mind.note("pose", t=now, place=(pose["x"], pose["y"]))
