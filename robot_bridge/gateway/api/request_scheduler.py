"""Scheduler of an operator's requests: their order, and what one overtakes; no socket.

What stops robots is begun at once, whatever was asked before. What may take long is answered aside, and
everything else in turn. A stop overtakes what waits its turn: what of that would set robots in motion is
refused then, since it was asked before they were to stand.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Coroutine
from typing import Any, NamedTuple

from ...core.errors import BusyError, RefusedError
from ...core.messages import Abort, DeskRequest, EmergencyStop, GetRoute, Send
from ...core.messages.operator_requests import Priority
from ...protocol import jsonrpc

MOVING = (Priority.MOVE, Priority.MOVE_SEVERAL)
MOST_WAITING, MOST_ASIDE, MOST_STOPPING = 256, 64, 1000
"""requests of one operator that wait their turn, that wait aside, and that stop robots, at most."""
MOST_EMERGENCIES = 50
"""emergency stops of one operator that are dealt with at the same time; the connection waits then."""
MOST_BYTES = 4_000_000
"""bytes of one operator's requests that wait, at most in each lane."""


class ScheduledRequest(NamedTuple):
    """A request, the call that it came in, and its length in bytes."""

    call: jsonrpc.Call
    request: DeskRequest[Any]
    size: int

    @property
    def stops(self) -> bool:
        """Tell whether it stops robots."""
        sent_by_hand = isinstance(self.request, Send) and self.request.op == Abort.__name__
        return sent_by_hand or self.request.priority is Priority.STOP


Settle = Callable[[ScheduledRequest, Exception | None], Coroutine[Any, Any, None]]
"""Deals with a request and tells the operator what came of it; with an exception it only tells that."""


class RequestScheduler:
    """The requests of one operator that are being dealt with, or wait."""

    def __init__(self, settle: Settle) -> None:
        self._settle = settle
        self._turn = _Lane(settle)
        self._aside = _Lane(settle)
        self._stopping: set[asyncio.Task[None]] = set()

    async def submit(self, asked: ScheduledRequest) -> None:
        """See to a request; returns at once, or when one that cannot be taken has been refused."""
        if asked.stops:
            await self._stop(asked)
        elif asked.request.priority is Priority.SLOW:
            await self._ask_aside(asked)
        elif not self._turn.submit(asked, MOST_WAITING):
            await self._settle(asked, _too_many(asked))

    async def finish(self) -> None:
        """Wait for what stops robots and for what has been begun; forget the rest, the operator is gone."""
        self._aside.cancel()
        await asyncio.gather(*self._stopping, self._turn.end(), return_exceptions=True)

    async def _stop(self, asked: ScheduledRequest) -> None:
        emergency = isinstance(asked.request, EmergencyStop)
        if not emergency and len(self._stopping) >= MOST_STOPPING:
            await self._settle(asked, _too_many(asked))
            return
        task = asyncio.create_task(self._settle(asked, None))
        self._stopping.add(task)
        task.add_done_callback(self._stopping.discard)
        for late in self._turn.withdraw(lambda waiting: _is_overtaken(waiting, asked)):
            await self._settle(late, _overtaken(late, asked))
        while emergency and len(self._stopping) >= MOST_STOPPING + MOST_EMERGENCIES:
            await asyncio.wait(self._stopping, return_when=asyncio.FIRST_COMPLETED)

    async def _ask_aside(self, asked: ScheduledRequest) -> None:
        for older in self._aside.withdraw(lambda waiting: _is_renewed(waiting, asked)):
            await self._settle(older, RefusedError("get_route: it was asked again before this was begun"))
        if not self._aside.submit(asked, MOST_ASIDE):
            await self._settle(asked, _too_many(asked))


class _Lane:
    """Deals with one request after the other."""

    def __init__(self, settle: Settle) -> None:
        self._settle = settle
        self._waiting: deque[ScheduledRequest] = deque()
        self._task: asyncio.Task[None] | None = None

    def submit(self, asked: ScheduledRequest, most: int) -> bool:
        """Take a request; false when too much waits."""
        waiting = sum(one.size for one in self._waiting)
        if len(self._waiting) >= most or (self._waiting and waiting + asked.size > MOST_BYTES):
            return False
        self._waiting.append(asked)
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._run())
        return True

    def withdraw(self, which: Callable[[ScheduledRequest], bool]) -> list[ScheduledRequest]:
        """Return what waits and is not to be dealt with any more."""
        gone = [asked for asked in self._waiting if which(asked)]
        self._waiting = deque(asked for asked in self._waiting if not which(asked))
        return gone

    def cancel(self) -> None:
        """Leave everything unanswered."""
        self._waiting.clear()
        if self._task is not None:
            self._task.cancel()

    async def end(self) -> None:
        """Wait until what has been begun is dealt with; forget the rest."""
        self._waiting.clear()
        if self._task is not None:
            await self._task

    async def _run(self) -> None:
        while self._waiting:
            await self._settle(self._waiting.popleft(), None)


def _is_overtaken(waiting: ScheduledRequest, stop: ScheduledRequest) -> bool:
    """Tell whether a request would set a robot in motion that ``stop``, which came after it, is to stop."""
    if waiting.request.priority not in MOVING:
        return False
    one, other = getattr(stop.request, "robot", None), getattr(waiting.request, "robot", None)
    several = waiting.request.priority is Priority.MOVE_SEVERAL
    return several or one is None or other is None or one == other


def _is_renewed(waiting: ScheduledRequest, asked: ScheduledRequest) -> bool:
    """Tell whether ``asked`` is the same way with another goal, as while a mouse moves."""
    old, new = waiting.request, asked.request
    if not (isinstance(old, GetRoute) and isinstance(new, GetRoute)):
        return False
    return (old.robot, old.start) == (new.robot, new.start)


def _overtaken(late: ScheduledRequest, stop: ScheduledRequest) -> RefusedError:
    return RefusedError(
        f"{late.request.method}: {stop.request.method} came after it and before it was begun, so that it was "
        "not done; ask again if it is to be done all the same"
    )


def _too_many(asked: ScheduledRequest) -> BusyError:
    return BusyError(
        f"{asked.request.method}: too many requests of this connection wait to be answered; "
        "wait for answers, then ask again"
    )
