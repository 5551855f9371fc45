"""Delivery of a robot's outbox over its channel, an emergency stop before anything else."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import logging
from collections.abc import Coroutine, Sequence
from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

from websockets.exceptions import ConnectionClosed

from ...core.clock import steady_time
from ...core.errors import LockedError, StoreError
from ...core.logs import log_and_continue
from ...core.messages.base import MessageError, to_json
from ...core.messages.robots import MOTION_OPS, PAYLOADS, Abort, SetMap
from ...protocol.codec import parse_params, with_base64
from ..fleet.service import Fleet
from ..monitoring import BackgroundTasks
from ..storage.repositories.requests import AnswerRow, Outbox

T = TypeVar("T")


class Interruptible(Protocol):
    """A connection on which a stop does not wait for a long message to its end."""

    @property
    def is_busy(self) -> bool:
        """Whether a message would have to wait for another one."""

    async def send(self, frame: str) -> None:
        """Write a frame without waiting for a turn; raises ConnectionClosed."""

    async def cut_if_busy(self) -> None:
        """Wait for the end of a long message that is being sent, before a stop.

        A connection on which that takes too long is cut: the other end hears the stop when it connects again.
        """


async def send_stop(connection: Interruptible, frame: str) -> None:
    """Send a stop, before the rest of a long message to a slow client; raises ConnectionClosed."""
    await connection.cut_if_busy()
    await connection.send(frame)


class Channel(Interruptible, Protocol):
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
CUT_AGAIN_S = 0.05
"""seconds until a message that was just begun is cut for an Abort."""
ABORT, MAP = Abort.__name__, SetMap.__name__


@dataclass
class _SentMessages:
    """What a robot was sent on one connection.

    That is all up to ``last``, of urgent messages up to ``last_urgent``, and ``aborts`` above those: an Abort
    is sent before older messages. ``newest_abort`` is the id of the newest one.
    """

    last: int = 0
    last_urgent: int = 0
    aborts: set[int] = field(default_factory=set)
    newest_abort: int = 0

    def record(self, row: AnswerRow) -> None:
        """Record a message that was sent, or left out."""
        if row.op == ABORT:
            self.newest_abort = max(self.newest_abort, row.id)
        if row.urgent:
            self.last_urgent = row.id
        elif row.op == ABORT:
            self.aborts.add(row.id)
        else:
            self.last = row.id

    def unsent(self, rows: Sequence[AnswerRow]) -> list[AnswerRow]:
        """Return those of the ``rows`` above ``last`` that were not sent, Aborts first."""
        self.aborts &= {row.id for row in rows}
        left = [row for row in rows if row.id not in self.aborts]
        return sorted(left, key=lambda row: row.op != ABORT)

    def is_revoked(self, row: AnswerRow) -> bool:
        """Return whether ``row`` moves the robot, and is older than an Abort that it was sent."""
        return row.op in MOTION_OPS and row.id < self.newest_abort


class Delivery:
    """Sends one robot its waiting messages while its connection is open."""

    def __init__(self, fleet: Fleet, channel: Channel, robot: str) -> None:
        self._fleet = fleet
        self._channel = channel
        self._robot = robot
        self._work: asyncio.Task[None] | None = None
        self._stops = 0
        self._sent = _SentMessages()
        self._stopping = BackgroundTasks()

    @property
    def reader(self) -> Outbox:
        """The answers to read for the robot: those after the ones sent."""
        return self._robot, self._sent.last, self._sent.last_urgent

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
        frame = self._channel.call(ABORT, to_json(Abort(emergency=emergency)), call_id)
        with log_and_continue(log, f"stopping robot {self._robot!r} at once"):
            # A task per robot would come after thousands of others.
            if self._channel.send_at_once(frame):
                return
        self._stopping.start(while_connected(send_stop(self._channel, frame)))

    def outdate(self) -> None:
        """Discard messages read before: the robot is being sent a stop."""
        self._stops += 1

    async def _deliver(self, after: float = 0.0) -> None:
        await asyncio.sleep(after)
        event = self._fleet.outboxes.event(self._robot)
        # Local to this task: an ended one may still be on its way out.
        sent = self._sent = _SentMessages()
        while True:
            event.clear()
            try:
                if await self._send_waiting(sent):
                    await event.wait()
            except ConnectionClosed:
                return
            except StoreError as error:
                self._log_trouble(error)
                await asyncio.sleep(RETRY_AFTER)
            except Exception:
                # Whatever the error: a later stop must still reach this robot.
                who = f"link {self._channel.name}: what waits for robot {self._robot!r}"
                self._fleet.repeated.note_unforeseen(log, (who,), who)
                await asyncio.sleep(RETRY_AFTER)

    def _log_trouble(self, error: StoreError) -> None:
        """Log why messages wait, unless that repeats: of all robots together where the database is at fault.

        It is tried again every second, for each robot.
        """
        link = f"link {self._channel.name}:"
        of_all = type(error) is StoreError or isinstance(error, LockedError)
        cause = ("database",) if of_all else ("robot", repr(self._robot))
        self._fleet.repeated.warn(log, (link, *cause, "outbox"), f"{link} robot {self._robot!r}: {error}")

    async def send_result(self, frame: str) -> None:
        """Send the result of a Ready, behind which the outbox is delivered: no Abort waits for it.

        :raises ConnectionClosed: when the connection is gone.
        """
        if not self._channel.is_busy:
            await self._channel.send(frame)
            return
        begun = asyncio.Event()
        begun.set()
        # An Abort may wait already.
        self._fleet.outboxes.event(self._robot).set()
        await self._watch(self._channel.send(frame), begun, self._sent)

    async def _send_waiting(self, sent: _SentMessages) -> bool:
        """Send the messages that are not in ``sent``; return false when what was read is out of date."""
        stops, event = self._stops, self._fleet.outboxes.event(self._robot)
        for row in sent.unsent(await self._fleet.outboxes.outbox(self._robot, sent.last, sent.last_urgent)):
            # Recorded first: it must never be withdrawn as not yet sent. All else is recorded afterwards, so
            # that no Abort waits for the database, nor behind a message that does.
            drives = row.op in MOTION_OPS
            checked_at = steady_time()
            is_due = not sent.is_revoked(row) and (
                not drives or await self._fleet.outboxes.mark_sending(self._robot, row.id)
            )
            if self._stops != stops:
                return False
            if is_due:
                begun = asyncio.Event()
                sending = self._send(row, stops, checked_at, begun)
                may_wait = row.op == MAP or (row.op != ABORT and self._channel.is_busy)
                if not await (self._watch(sending, begun, sent) if may_wait else sending):
                    return False
            sent.record(row)
            if not drives:
                await self._fleet.outboxes.delivered([row.id])
            if row.op == MAP and event.is_set():
                return False
        return True

    async def _send(self, row: AnswerRow, stops: int, checked_at: float, begun: asyncio.Event) -> bool:
        """Send a message in its turn; return false, with nothing sent, when it must not be sent any more.

        :raises ConnectionClosed: when the connection is gone.
        """
        if (frame := await self._framed(row)) is None:
            return True
        async with self._channel.lane(urgent=row.op == ABORT, large=len(frame) > LARGE):
            # While this waited for its turn the robot may have been sent a stop.
            if self._stops != stops:
                return False
            if row.op in MOTION_OPS and not self._fleet.outboxes.may_send(self._robot, checked_at):
                return False
            begun.set()
            if row.op == ABORT:
                await send_stop(self._channel, frame)
            else:
                await self._channel.send(frame)
        return True

    async def _watch(
        self, work: Coroutine[Any, Any, T], begun: asyncio.Event, sent: _SentMessages
    ) -> T | None:
        """Await the sending of a message; an Abort for the robot waits neither for its turn nor for its end.

        Returns None, with nothing sent, if an Abort came before it was ``begun``.
        """
        event, has_news = self._fleet.outboxes.event(self._robot), False
        sending = asyncio.create_task(work)
        woken = asyncio.create_task(event.wait())
        try:
            while not sending.done():
                await asyncio.wait((sending, woken), return_when=asyncio.FIRST_COMPLETED)
                if not woken.done():
                    continue
                event.clear()
                has_news = True
                woken = asyncio.create_task(event.wait())
                while not sending.done() and await self._has_abort(sent):
                    await self._channel.cut_if_busy()
                    if not begun.is_set():
                        return None
                    await asyncio.wait((sending,), timeout=CUT_AGAIN_S)
            return await sending
        finally:
            woken.cancel()
            sending.cancel()
            if has_news:
                event.set()

    async def _has_abort(self, sent: _SentMessages) -> bool:
        reader = self._robot, sent.last, sent.last_urgent
        try:
            return not sent.aborts.issuperset(await self._fleet.outboxes.waiting_aborts(*reader))
        except StoreError:
            # The next read of the outbox logs it.
            loop, event = asyncio.get_running_loop(), self._fleet.outboxes.event(self._robot)
            loop.call_later(RETRY_AFTER, event.set)
            return False

    async def _framed(self, row: AnswerRow) -> str | None:
        if row.payload is None and row.op == MAP:
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
