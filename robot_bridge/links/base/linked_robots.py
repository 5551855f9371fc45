"""Robots of a link: their state, commands in order, positions as binary frames."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import msgspec
import numpy as np
import numpy.typing as npt

from ...core.messages.base import to_json
from ...core.messages.links import LinkColumns
from ...core.messages.robots import Answer, OpAck, Ready, Request, SendGPS, SendPos, Stopped
from ...core.messages.safety import Ability
from ...core.position_frame import METHOD, NEEDED, NUMBERS, TEXTS, packed_frame
from ...protocol import jsonrpc
from .adapter import Adapter, Command
from .errors import CommandRefusedError, LinkError
from .memory import CompletedCall, LinkMemory

# --- State of one robot of a link; no I/O ---

NEW_ENOUGH = 2.0
"""seconds: an older position is not sent when the gateway is back."""
FIRST_WAIT, LONGEST_WAIT = 1.0, 30.0
"""seconds until Ready is sent again for a refused robot."""


@dataclass
class Kept:
    """A robot's request, kept until the gateway has acknowledged it; ``call`` is its id while pending."""

    request: Request
    answer: asyncio.Future[OpAck]
    call: int | None = None


@dataclass
class LinkedRobot:
    """``can`` are the abilities declared in its Ready. A position is ``fresh`` until sent to the gateway."""

    name: str
    can: tuple[Ability, ...]
    path_cones: bool = False
    admitted: bool = False
    position: SendPos | SendGPS | None = None
    position_at: float = 0.0
    fresh: bool = False
    is_alive: bool = False
    kept: list[Kept] = field(default_factory=list)
    wait: float = FIRST_WAIT

    @property
    def is_only_seen(self) -> bool:
        """Whether it takes no commands, so that there is nothing to stop."""
        return not self.can

    def ready(self, magic: int) -> Ready:
        """Return its first request."""
        return Ready(magic, path_cones=self.path_cones or None, abilities=list(self.can))

    def change(self, can: tuple[Ability, ...], path_cones: bool) -> bool:
        """Set its present abilities; return whether they changed."""
        before = self.can, self.path_cones
        self.can, self.path_cones = can, path_cones
        return before != (can, path_cones)

    def place(self, position: SendPos | SendGPS) -> None:
        """Replace its position by the newest."""
        self.position, self.position_at, self.fresh = position, time.monotonic(), True

    def admit(self) -> None:
        """Record that the gateway has admitted it: its recent position is sent again."""
        self.admitted, self.wait = True, FIRST_WAIT
        self.fresh = self.position is not None and time.monotonic() - self.position_at < NEW_ENOUGH

    def lose(self) -> None:
        """Record that the gateway no longer admits it."""
        self.admitted = self.fresh = self.is_alive = False
        for kept in self.kept:
            kept.call = None

    def next_wait(self) -> float:
        """Return the seconds until its next Ready."""
        wait, self.wait = self.wait, min(self.wait * 2, LONGEST_WAIT)
        return wait

    def keep(self, kept: Kept) -> None:
        """Keep a request; a Stopped replaces one that was not sent yet."""
        if isinstance(kept.request, Stopped):
            for older in [k for k in self.kept if isinstance(k.request, Stopped) and k.call is None]:
                self.kept.remove(older)
                older.answer.cancel()
        self.kept.append(kept)

    def unsent(self) -> Iterator[Kept]:
        """Yield the requests not sent yet on this connection."""
        return (kept for kept in list(self.kept) if kept.call is None)


# --- Positions of many robots as one binary frame, and those of GPS as calls; no I/O ---

NOTHING = float("nan")


def frame_of(positions: Sequence[tuple[str, SendPos]]) -> bytes:
    """Return the frame with positions of robots; fields unknown for all of them are omitted."""
    columns: dict[str, npt.NDArray[np.float64]] = {}
    words: dict[str, int] = {}
    poses = [pose for _, pose in positions]
    for column, parameter in NUMBERS.items():
        values = [getattr(pose, parameter) for pose in poses]
        if column in NEEDED or any(value is not None for value in values):
            columns[column] = np.array([NOTHING if v is None else v for v in values], dtype=np.float64)
    for name in TEXTS:
        texts = [getattr(pose, name) for pose in poses]
        if any(text is not None for text in texts):
            places = [NOTHING if t is None else words.setdefault(t, len(words)) for t in texts]
            columns[name] = np.array(places, dtype=np.float64)
    table = LinkColumns([name for name, _ in positions], list(columns), list(words))
    head = msgspec.json.encode({"jsonrpc": "2.0", "method": METHOD, "params": table})
    return packed_frame(head, columns.values())


def gps_call(robot: str, fix: SendGPS) -> str:
    """Return the frame with a robot's GPS position."""
    return jsonrpc.call(SendGPS.__name__, {"robot": robot, **to_json(fix)})


# --- Messages to robots: in order for each robot, each executed once, stops before all others

log = logging.getLogger(__name__)

OVERTAKEN = "an Abort came before the robot had taken it on"
GONE = "the link speaks for this robot no more"
CallId = int | str | None


class Post(Protocol):
    """Sends a frame to the gateway."""

    def __call__(self, frame: str, *, urgent: bool = False) -> None:
        """Send it; one that is ``urgent`` before the others."""


class _Line:
    """The waiting messages of one robot, and the task that delivers them."""

    def __init__(self) -> None:
        self.waiting: deque[tuple[CallId, Answer]] = deque()
        self.task: asyncio.Task[None] | None = None


class Commanding:
    """Passes commands to the adapter and sends the gateway the outcome of each."""

    def __init__(self, adapter: Adapter, memory: LinkMemory, answer_within: float, post: Post) -> None:
        self._adapter = adapter
        self._memory = memory
        self._answer_within = answer_within
        self._post = post
        self._lines: dict[str, _Line] = {}
        self._stops: set[asyncio.Task[None]] = set()
        self._is_closed = False

    def enqueue(self, robot: str, call: CallId, message: Answer) -> None:
        """Queue ``message`` for ``robot`` behind its waiting ones."""
        line = self._lines.setdefault(robot, _Line())
        if any(known == call for known, _ in line.waiting):
            return
        line.waiting.append((call, message))
        if line.task is None or line.task.done():
            line.task = asyncio.create_task(self._work(robot, line))

    def stop(self, robot: str, call: CallId, *, emergency: bool) -> None:
        """Stop ``robot`` now; its waiting messages are dropped."""
        self.drop(robot, OVERTAKEN)
        task = asyncio.create_task(self._stop(robot, call, emergency=emergency))
        self._stops.add(task)
        task.add_done_callback(self._stops.discard)

    def drop(self, robot: str, reason: str = GONE) -> None:
        """Drop the waiting messages of ``robot``, and cancel the one being delivered."""
        line = self._lines.pop(robot, None)
        if line is None:
            return
        for call, _ in line.waiting:
            self._answer(call, reason)
        line.waiting.clear()
        if line.task is not None:
            line.task.cancel(OVERTAKEN if reason == GONE else reason)

    def close(self) -> None:
        """Drop all commands; record and answer nothing more: their ids now belong to other messages."""
        self._is_closed = True
        for robot in list(self._lines):
            self.drop(robot)

    async def calm(self, robot: str) -> str | None:
        """Stop a robot without a request; return None, or why its side has not confirmed the stop."""
        self.drop(robot)
        return await self._stopped(robot, emergency=False)

    async def _stop(self, robot: str, call: CallId, *, emergency: bool) -> None:
        self._answer(call, await self._stopped(robot, emergency=emergency), urgent=True)

    async def _stopped(self, robot: str, *, emergency: bool) -> str | None:
        try:
            async with asyncio.timeout(self._answer_within):
                await self._adapter.stop(robot, emergency=emergency)
        except CommandRefusedError as error:
            log.error("robot %s does not stop: %s", robot, error)
            return str(error)
        except TimeoutError:
            log.error("robot %s did not answer to an Abort within %g s", robot, self._answer_within)
            return f"no answer within {self._answer_within:g} s"
        except Exception:
            log.exception("robot %s: the Abort failed", robot)
            return "the link failed; its log says more"
        return None

    async def _work(self, robot: str, line: _Line) -> None:
        while line.waiting:
            call, message = line.waiting[0]
            id = _message_id(call)
            done = self._memory.find(robot, id) if id is not None else None
            if done is None:
                done = await self._do(robot, call, message)
            line.waiting.popleft()
            self._answer(call, done.refusal)

    async def _do(self, robot: str, call: CallId, message: Answer) -> CompletedCall:
        id = _message_id(call)
        if id is None:
            return CompletedCall("this message has no id")
        try:
            again = await self._memory.begin(robot, id)
        except LinkError as error:
            return CompletedCall(str(error))
        try:
            done = await self._carried_out(Command(robot, id, message, again))
        except asyncio.CancelledError as error:
            reason = str(error) or OVERTAKEN
            await asyncio.shield(self._finish(robot, id, CompletedCall(reason)))
            raise
        await self._finish(robot, id, done)
        return done

    async def _finish(self, robot: str, id: int, done: CompletedCall) -> None:
        if not self._is_closed:
            await self._memory.finish(robot, id, done)

    async def _carried_out(self, command: Command) -> CompletedCall:
        what = type(command.message).__name__
        longest = self._answer_within + self._adapter.holds_s
        try:
            async with asyncio.timeout(longest):
                await self._adapter.command(command)
        except CommandRefusedError as error:
            return CompletedCall(str(error))
        except TimeoutError:
            return CompletedCall(f"the robot did not take it on within {longest:g} s")
        except Exception:
            log.exception("robot %s: %s %d failed", command.robot, what, command.id)
            return CompletedCall("the link failed; its log says more")
        return CompletedCall()

    def _answer(self, call: CallId, refusal: str | None, *, urgent: bool = False) -> None:
        if call is None or self._is_closed:
            return
        if refusal is None:
            self._post(jsonrpc.result(call, to_json(OpAck())), urgent=urgent)
        else:
            self._post(jsonrpc.error(call, jsonrpc.REFUSED, refusal), urgent=urgent)


def _message_id(call: CallId) -> int | None:
    """Return the id of a message in that of its call, ``robot/17``; None for a call without one."""
    id = str(call).rpartition("/")[2]
    return int(id) if id.isascii() and id.isdigit() else None
