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
    """The connection to one robot; frames are JSON-RPC 2.0 texts."""

    @property
    def name(self) -> str:
        """The robot's link as shown to operators: ``websocket``, or the name of the link."""

    @property
    def endpoint(self) -> str:
        """The path at the gateway that it connected to."""

    @property
    def round_trip(self) -> float | None:
        """Round-trip time of the last ping in seconds, None before the first."""

    def call(self, method: str, params: Any = None, id: int | str | None = None) -> str:
        """Return the frame of a request, or of a notification if ``id`` is None."""

    def result(self, id: int | str | None, value: Any) -> str:
        """Return the frame that answers the robot's call ``id``."""

    def error(self, id: int | str | None, code: int, text: str) -> str:
        """Return the error frame for the robot's failed call ``id``."""

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for the turn of a message from the outbox; ``urgent`` ones do not wait.

        Many robots may share one connection: a ``large`` message of one must not delay the others.
        """

    async def send(self, frame: str) -> None:
        """Write a frame without waiting for a turn; raises ConnectionClosed."""

    def send_at_once(self, frame: str) -> bool:
        """Write a frame now; return false, with nothing done, if that is impossible."""

    async def answers(self) -> bool:
        """Return whether the other end is alive; takes a second at most."""

    async def release(self, reason: str, *, again: bool = False) -> None:
        """Notify the other end that the robot has another connection now, and stop carrying its messages.

        With ``again`` the other end should reconnect.
        """


async def while_connected(work: Coroutine[Any, Any, None]) -> None:
    """Await ``work``; a closed connection ends it without an error."""
    with contextlib.suppress(ConnectionClosed):
        await work


# --- Delivery of a robot's outbox over its connection, emergency stops first ---

log = logging.getLogger(__name__)

RETRY_AFTER = 1.0
"""seconds until the outbox is read again after a failed read of the database."""

LARGE = 100_000
"""bytes of a message above which its frame is built in another thread."""
PIECE = 3 << 16
"""bytes encoded as base64 at once; a multiple of three, so that pieces can be concatenated."""


class Delivery:
    """Sends one robot its waiting messages while its connection is open."""

    def __init__(self, fleet: Fleet, channel: Channel, robot: str) -> None:
        self._fleet = fleet
        self._channel = channel
        self._robot = robot
        self._work: asyncio.Task[None] | None = None
        self._stops = 0
        self._last = {False: 0, True: 0}
        """the ids of the last sent messages, by urgency."""
        self._stopping = BackgroundTasks()

    @property
    def reader(self) -> Outbox:
        """The answers to read for the robot: those after the ones sent."""
        return self._robot, self._last[False], self._last[True]

    def begin(self) -> None:
        """Deliver the outbox from its beginning: unacknowledged messages are sent again."""
        self.end()
        self._work = asyncio.create_task(self._deliver())

    def begin_later(self) -> None:
        """Deliver the outbox from its beginning in a moment: the database refused the robot's reply."""
        self.end()
        self._work = asyncio.create_task(self._deliver(RETRY_AFTER))

    def end(self) -> None:
        """Stop delivering."""
        if self._work is not None:
            self._work.cancel()

    def stop_now(self, call_id: str, *, emergency: bool = True) -> None:
        """Send the robot an Abort, before anything that was not sent yet.

        It does not wait for the database; an emergency stop's Abort follows from the outbox under its own id.
        """
        self.outdate()
        frame = self._channel.call(Abort.__name__, to_json(Abort(emergency=emergency)), call_id)
        with log_and_continue(log, f"stopping robot {self._robot!r} at once"):
            # A task per robot would come after thousands of others.
            if self._channel.send_at_once(frame):
                return
        self._stopping.start(while_connected(self._channel.send(frame)))

    def outdate(self) -> None:
        """Discard messages read before: the robot is being sent a stop."""
        self._stops += 1

    async def _deliver(self, after: float = 0.0) -> None:
        await asyncio.sleep(after)
        event = self._fleet.outboxes.event(self._robot)
        # Local to this task: an ended one may still be on its way out.
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
                # Whatever the error: a later stop must still reach this robot.
                log_unforeseen(log, f"link {self._channel.name}: what waits for robot {self._robot!r}")
                await asyncio.sleep(RETRY_AFTER)

    async def _send_waiting(self, last: dict[bool, int]) -> bool:
        """Send the messages above ``last``, by urgency; return false when a stop made them out of date."""
        stops = self._stops
        for row in await self._fleet.outboxes.outbox(self._robot, last[False], last[True]):
            # Recorded first: it must never be withdrawn as not yet sent. All else is recorded afterwards, so
            # that no Abort waits for the database, nor behind a message that does.
            drives = row.op in HELD_BACK
            checked_at = steady_time()
            is_due = not drives or await self._fleet.outboxes.mark_sending(self._robot, row.id)
            if self._stops != stops:
                return False
            if is_due and (frame := await self._framed(row)) is not None:
                async with self._channel.lane(urgent=bool(row.urgent), large=len(frame) > LARGE):
                    # While this waited for its turn the robot may have been sent a stop.
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
        # A city's map takes long to encode as text; nobody else must wait for it.
        if row.payload is not None and row.op in PAYLOADS and len(row.payload) > LARGE:
            return await asyncio.to_thread(self._large_frame, row, row.payload)
        return self._frame(row)

    def _large_frame(self, row: AnswerRow, payload: bytes) -> str | None:
        """Return the same as :meth:`_frame`, built in pieces: each blocks the other threads."""
        frame = self._frame(row._replace(payload=b""))
        if frame is None:
            return None
        head, name, tail = frame.rpartition(f'"{PAYLOADS[row.op]}":"')
        pieces = (payload[begin : begin + PIECE] for begin in range(0, len(payload), PIECE))
        return "".join([head, name, *(base64.b64encode(piece).decode("ascii") for piece in pieces), tail])

    def _frame(self, row: AnswerRow) -> str | None:
        """Return the call that delivers a message; None for one that cannot be read, which is skipped."""
        try:
            return self._channel.call(row.op, _params(row), row.id)
        except MessageError as error:
            who = self._channel.name, row.id, self._robot
            log.error("link %s: message %d for robot %r: %s", *who, error)
            return None


def _params(row: AnswerRow) -> dict[str, Any]:
    params: dict[str, Any] = parse_params(row.op, row.params) or {}
    return with_base64(row.op, params, row.payload)
