"""Delivery of a robot's outbox over its channel, an emergency stop before anything else."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import logging
from collections.abc import Coroutine
from contextlib import AbstractAsyncContextManager
from typing import Any, Protocol

from websockets.exceptions import ConnectionClosed

from ...core.clock import steady_time
from ...core.errors import StoreError
from ...core.logs import log_and_continue, log_unforeseen
from ...core.messages.base import MessageError, to_json
from ...core.messages.robots import PAYLOADS, Abort, SetMap
from ...protocol.codec import parse_params, with_base64
from ..fleet.emergency_persistence import HELD_BACK
from ..fleet.service import Fleet
from ..monitoring import BackgroundTasks
from ..storage.repositories.requests import AnswerRow, Outbox


class Channel(Protocol):
    """The way to and from one robot; frames are JSON-RPC 2.0 texts."""

    @property
    def name(self) -> str:
        """What operators see as the robot's link: ``websocket``, or the name of the link."""

    @property
    def endpoint(self) -> str:
        """The path at a gateway that its connection was made to."""

    @property
    def round_trip(self) -> float | None:
        """Seconds that the last ping took there and back, None before the first."""

    def call(self, method: str, params: Any = None, id: int | str | None = None) -> str:
        """Return the frame of a request, or of a notification where ``id`` is None."""

    def result(self, id: int | str | None, value: Any) -> str:
        """Return the frame that answers the robot's call ``id``."""

    def error(self, id: int | str | None, code: int, text: str) -> str:
        """Return the frame that tells why the robot's call ``id`` failed."""

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for the turn of a message from the outbox: what is ``urgent`` waits for nothing.

        Many robots may share one connection: a ``large`` message of one is not to keep the others waiting.
        """

    async def send(self, frame: str) -> None:
        """Write a frame without waiting for a turn; raises ConnectionClosed."""

    def send_at_once(self, frame: str) -> bool:
        """Write a frame now; false where that cannot be, and nothing was done."""

    async def answers(self) -> bool:
        """Tell whether the other end is there; takes a second at most."""

    async def release(self, reason: str, *, again: bool = False) -> None:
        """Tell the other end that the robot has another connection now, and carry nothing more for it.

        It had better connect ``again`` where that may not be so.
        """


async def while_connected(work: Coroutine[Any, Any, None]) -> None:
    """Do ``work``, to which the end of the connection is an end like any other."""
    with contextlib.suppress(ConnectionClosed):
        await work


# --- How a robot's outbox goes out over its connection, and an emergency stop before anything else ---

log = logging.getLogger(__name__)

RETRY_AFTER = 1.0
"""seconds after which the outbox is looked at again when the database could not be read."""

LARGE = 100_000
"""bytes of a message above which its frame is made in another thread."""
PIECE = 3 << 16
"""bytes that are written as base64 at once; a multiple of three, so that pieces follow one another."""


class Delivery:
    """Sends one robot what waits for it, for as long as its connection is open."""

    def __init__(self, fleet: Fleet, channel: Channel, robot: str) -> None:
        self._fleet = fleet
        self._channel = channel
        self._robot = robot
        self._work: asyncio.Task[None] | None = None
        self._stops = 0
        self._last = {False: 0, True: 0}
        """the ids of the messages that were sent last, by urgency."""
        self._stopping = BackgroundTasks()

    @property
    def reader(self) -> Outbox:
        """The answers to read for the robot: what comes behind what it was sent."""
        return self._robot, self._last[False], self._last[True]

    def begin(self) -> None:
        """Deliver the outbox from its beginning: what was not acknowledged is sent again."""
        self.end()
        self._work = asyncio.create_task(self._deliver())

    def begin_later(self) -> None:
        """Deliver the outbox from its beginning in a moment: the database did not take what it said."""
        self.end()
        self._work = asyncio.create_task(self._deliver(RETRY_AFTER))

    def end(self) -> None:
        """Deliver nothing more."""
        if self._work is not None:
            self._work.cancel()

    def stop_now(self, call_id: str, *, emergency: bool = True) -> None:
        """Send the robot an Abort, before anything that was not sent yet.

        It does not wait for the database; an emergency stop's follows from the outbox under an id of its own.
        """
        self.outdate()
        frame = self._channel.call(Abort.__name__, to_json(Abort(emergency=emergency)), call_id)
        with log_and_continue(log, f"stopping robot {self._robot!r} at once"):
            # A task of each would come after thousands of others.
            if self._channel.send_at_once(frame):
                return
        self._stopping.start(while_connected(self._channel.send(frame)))

    def outdate(self) -> None:
        """Send nothing of what was read before: the robot is being told to stop."""
        self._stops += 1

    async def _deliver(self, after: float = 0.0) -> None:
        await asyncio.sleep(after)
        event = self._fleet.outboxes.event(self._robot)
        # Of this task alone: one that was ended may still be on its way out.
        last = self._last = {False: 0, True: 0}
        while True:
            event.clear()
            try:
                if await self._send_waiting(last):
                    await event.wait()
            except ConnectionClosed:
                return
            except StoreError as error:
                log.error("link %s: robot %r: %s", self._channel.name, self._robot, error)
                await asyncio.sleep(RETRY_AFTER)
            except Exception:
                # Whatever it was: this robot must be told to stop by what comes after it.
                log_unforeseen(log, f"link {self._channel.name}: what waits for robot {self._robot!r}")
                await asyncio.sleep(RETRY_AFTER)

    async def _send_waiting(self, last: dict[bool, int]) -> bool:
        """Send the messages above ``last``, by urgency; return false when a stop made them out of date."""
        stops = self._stops
        for row in await self._fleet.outboxes.outbox(self._robot, last[False], last[True]):
            # Noted first: it must never be taken back as something that the robot cannot have. All else is
            # noted afterwards, so that no Abort waits for the database, nor behind what does.
            drives = row.op in HELD_BACK
            checked_at = steady_time()
            is_due = not drives or await self._fleet.outboxes.mark_sending(self._robot, row.id)
            if self._stops != stops:
                return False
            if is_due and (frame := await self._framed(row)) is not None:
                async with self._channel.lane(urgent=bool(row.urgent), large=len(frame) > LARGE):
                    # While this waited for its turn the robot may have been told to stop.
                    if self._stops != stops:
                        return False
                    if drives and not self._fleet.outboxes.may_send(self._robot, checked_at):
                        return False
                    await self._channel.send(frame)
            last[row.urgent] = row.id
            if not drives:
                await self._fleet.outboxes.delivered([row.id])
        return True

    async def _framed(self, row: AnswerRow) -> str | None:
        if row.payload is None and row.op == SetMap.__name__:
            row = row._replace(payload=await self._fleet.maps.whole_or_around(self._robot))
        # A city's map takes a while to be written as text, for which nobody else is to wait.
        if row.payload is not None and row.op in PAYLOADS and len(row.payload) > LARGE:
            return await asyncio.to_thread(self._large_frame, row, row.payload)
        return self._frame(row)

    def _large_frame(self, row: AnswerRow, payload: bytes) -> str | None:
        """Return what :meth:`_frame` does, piece by piece: each holds up the other threads."""
        frame = self._frame(row._replace(payload=b""))
        if frame is None:
            return None
        head, name, tail = frame.rpartition(f'"{PAYLOADS[row.op]}":"')
        pieces = (payload[begin : begin + PIECE] for begin in range(0, len(payload), PIECE))
        return "".join([head, name, *(base64.b64encode(piece).decode("ascii") for piece in pieces), tail])

    def _frame(self, row: AnswerRow) -> str | None:
        """Return the call that delivers a message; None for one that cannot be read, which is left out."""
        try:
            return self._channel.call(row.op, _params(row), row.id)
        except MessageError as error:
            who = self._channel.name, row.id, self._robot
            log.error("link %s: message %d for robot %r: %s", *who, error)
            return None


def _params(row: AnswerRow) -> dict[str, Any]:
    params: dict[str, Any] = parse_params(row.op, row.params) or {}
    return with_base64(row.op, params, row.payload)
