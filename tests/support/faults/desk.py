"""An operator's program that sends robots numbered commands and writes down what it was told."""

from __future__ import annotations

import itertools
import random
import re
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from websockets.exceptions import WebSocketException

from tests.support.faults.mind import FIRST_X, STEP_X
from tests.support.wire import Wire

ANSWER_WITHIN = 40.0
"""seconds after which an answer is no longer waited for: the same is asked again on a new connection."""
PAUSE, PAUSE_REFUSED = 0.1, 1.0
"""seconds between the end of a robot's command and its next one, and after one that was refused."""
SHARE_ABORTED, SHARE_PATHS = 0.12, 0.1
LONGEST_BEFORE_ABORT = 0.15
ENDS = ("reached", "aborted", "failed", "expired", "superseded")
DATABASE_AWAY = -32603
NOTHING = r"(?!)"


@dataclass
class Ledger:
    """What the desk was told: of each command id when it was taken, how it ended, or why it was refused."""

    told: dict[str, float] = field(default_factory=dict)
    ended: dict[str, str] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)
    repeated: int = 0


@dataclass
class Task:
    """A command, and the Abort that follows it if one does. Asked again until there is an answer."""

    robot: str
    messages: list[dict[str, Any]]
    next_at: float = 0.0

    @property
    def ids(self) -> list[str]:
        """The ids of its commands."""
        return [message["command"] for message in self.messages]


class SendingDesk(threading.Thread):
    """One connection for some robots; each has one task at a time, and the next after that has ended.

    A refusal is wrong unless the database was away, or ``tolerated``, a regular expression, is found in it.
    """

    def __init__(
        self,
        address: Callable[[], str],
        robots: dict[str, float],
        seed: str,
        ledger: Ledger,
        tolerated: str = NOTHING,
    ) -> None:
        super().__init__(name=f"desk {seed}", daemon=True)
        self._address = address
        self._rows = robots
        self._random = random.Random(seed)
        self._ledger = ledger
        self._tolerated = re.compile(tolerated)
        self._numbers = itertools.count(1)
        self._tasks: dict[str, Task] = {}
        self._rest_until = dict.fromkeys(robots, 0.0)
        self._asked: dict[int, tuple[str, float]] = {}
        self.resting = threading.Event()
        self.ending = threading.Event()

    @property
    def busy(self) -> list[str]:
        """The ids of commands that have not ended yet."""
        return [id for task in list(self._tasks.values()) for id in task.ids]

    def run(self) -> None:
        """Work until told to end, on one connection after the other."""
        while not self.ending.is_set():
            try:
                with Wire(f"{self._address()}/desk", open_timeout=10, close_timeout=0.2) as wire:
                    self._work(wire)
            except (OSError, TimeoutError, WebSocketException):
                self.ending.wait(0.1)
            self._ledger.repeated += len({id for id, _ in self._asked.values() if id})
            self._asked.clear()

    def _work(self, wire: Wire) -> None:
        self._ask(wire, "hello", {"operator": "Ada"})
        for robot in self._tasks:
            self._ask(wire, "get_commands", {"robot": robot, "limit": 5})
        while not self.ending.is_set():
            for message in self._due(time.time()):
                self._ask(wire, "send", message)
            if frame := wire.receive(0.03):
                self._hear(frame)
            if any(time.time() - at > ANSWER_WITHIN for _, at in self._asked.values()):
                return

    def _due(self, now: float) -> Iterator[dict[str, Any]]:
        asked = {id for id, _ in self._asked.values()}
        for robot in self._rows:
            task = self._tasks.get(robot)
            if task is None:
                if self.resting.is_set() or now < self._rest_until[robot]:
                    continue
                task = self._tasks[robot] = self._new(robot)
            for number, message in enumerate(task.messages):
                id = message["command"]
                if id in self._ledger.told or id in self._ledger.refused:
                    continue
                if id not in asked and (number == 0 or self._follows(task, now)):
                    yield message
                break

    def _follows(self, task: Task, now: float) -> bool:
        """Tell whether it is time for the Abort, a moment after the command was taken."""
        if not task.next_at:
            task.next_at = now + self._random.uniform(0, LONGEST_BEFORE_ABORT)
        return now >= task.next_at

    def _new(self, robot: str) -> Task:
        number = next(self._numbers)
        id = f"{robot}-{number:06d}"
        # The next target is out of reach of this one, so that standing there is no arrival here.
        x, y = round(FIRST_X + number * STEP_X, 3), self._rows[robot] + number % 2 * 2.0
        op, params = "SetPosEnd", {"x": x, "y": y}
        if self._random.random() < SHARE_PATHS:
            op, params = "SetPath", {"points": [[x, y], [x + 1.5, y]]}
        messages = [{"command": id, "robot": robot, "op": op, "params": params}]
        if self._random.random() < SHARE_ABORTED:
            messages.append({"command": f"{id}-abort", "robot": robot, "op": "Abort"})
        return Task(robot, messages)

    def _ask(self, wire: Wire, method: str, params: dict[str, Any]) -> None:
        call = wire.begin(method, params)
        if method == "send":
            self._asked[call] = (params["command"], time.time())

    def _hear(self, frame: dict[str, Any]) -> None:
        if frame.get("method") == "command":
            self._take(frame["params"])
        elif "error" in frame:
            self._refused(frame)
        elif "method" not in frame:
            id, _ = self._asked.pop(frame["id"], ("", 0.0))
            if id:
                self._ledger.told[id] = time.time()
                self._take(frame["result"])
                self._finish(id)
            for report in frame["result"].get("commands", ()):
                self._take(report)

    def _refused(self, frame: dict[str, Any]) -> None:
        id, _ = self._asked.pop(frame["id"], ("", 0.0))
        code, text = frame["error"]["code"], frame["error"]["message"]
        known = code == DATABASE_AWAY and not text.startswith("internal error")
        if not (known or self._tolerated.search(text)):
            self._ledger.wrong.append(f"command {id or frame['id']} was refused: {text}")
        if id:
            self._ledger.refused[id] = text
            self._finish(id, PAUSE_REFUSED)

    def _take(self, report: dict[str, Any]) -> None:
        if report["state"] in ENDS:
            self._ledger.ended[report["command"]] = report["state"]
            self._finish(report["command"])

    def _finish(self, id: str, pause: float = PAUSE) -> None:
        """End the task when all of it has ended or was refused; without its command there is no Abort."""
        task = self._tasks.get(id.split("-")[0])
        if task is None or id not in task.ids:
            return
        done = [i for i in task.ids if self._ended(i)]
        if len(done) == len(task.ids) or task.ids[0] in self._ledger.refused:
            del self._tasks[task.robot]
            self._rest_until[task.robot] = time.time() + pause

    def _ended(self, id: str) -> bool:
        if id in self._ledger.refused:
            return True
        return id in self._ledger.told and id in self._ledger.ended
