"""Connection of a client with its limits, and the fast path of its short messages."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import time
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode, Frame, Opcode
from websockets.protocol import OPEN

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.sites.settings_tables import LimitSettings
from ...protocol import jsonrpc
from ..monitoring import BackgroundTasks
from .accounts import TokenKind

# --- Frame boundaries in a client's data, and frames that are one whole short message; no I/O
# Frames are those of RFC 6455, section 5.2.

try:
    from websockets.speedups import apply_mask
except ImportError:
    from websockets.utils import apply_mask

LONGEST = 1000
"""bytes of a short message: below any message limit that a site may set."""
_WHOLE_TEXT = 0x81
_MASKED = 0x80
_TWO_BYTES, _EIGHT_BYTES = 126, 127


def short_text(data: bytes, start: int) -> tuple[bytes, int] | None:
    """Return the message in the frame that begins at ``start``, and where the next frame begins.

    None if that frame is incomplete, or anything but one whole text of at most LONGEST bytes of ASCII:
    invalid or fragmented frames are left to the full implementation of the protocol.
    """
    if len(data) - start < 6 or data[start] != _WHOLE_TEXT:
        return None
    length, mask_at = data[start + 1] - _MASKED, start + 2
    if length == _TWO_BYTES:
        length, mask_at = data[start + 2] << 8 | data[start + 3], start + 4
    elif length == _EIGHT_BYTES:
        # Taken as a length, it would sometimes match 127 bytes of ASCII in a long text.
        return None
    begin = mask_at + 4
    end = begin + length
    if not 0 < length <= LONGEST or end > len(data):
        return None
    text = apply_mask(data[begin:end], data[mask_at:begin])
    return (text, end) if text.isascii() else None


class FrameParser:
    """Tracks the frames in a client's data, in pieces of any length.

    It keeps only an unfinished header.
    """

    __slots__ = ("_header", "_left")

    def __init__(self) -> None:
        self._header = b""
        self._left = 0

    @property
    def between(self) -> bool:
        """Return whether the next byte starts a frame."""
        return not self._left and not self._header

    def pass_over(self, data: bytes) -> None:
        """Track the next bytes."""
        at = 0
        while at < len(data):
            if self._left:
                step = min(self._left, len(data) - at)
                self._left -= step
                at += step
                continue
            header = self._header + data[at : at + 14]
            size, payload = _measured(header)
            if size == 0:
                self._header = header
                return
            at += size - len(self._header)
            self._header, self._left = b"", payload


def _measured(header: bytes) -> tuple[int, int]:
    """Return the bytes of a frame's header and of its payload, (0, 0) while unknown."""
    if len(header) < 2:
        return 0, 0
    mask = 4 if header[1] & _MASKED else 0
    short = header[1] & ~_MASKED
    extended = {_TWO_BYTES: 2, _EIGHT_BYTES: 8}.get(short, 0)
    size = 2 + extended + mask
    if len(header) < size:
        return 0, 0
    return size, int.from_bytes(header[2 : 2 + extended], "big") if extended else short


# --- Rate limit of a client: a token bucket that allows bursts ---


class RateLimit:
    """Allows ``rate`` tokens per second on average and up to ``burst`` at once."""

    __slots__ = ("_at", "_burst", "_left", "_now", "_rate")

    def __init__(self, rate: float, burst: float, clock: Clock = SYSTEM_CLOCK) -> None:
        self._rate, self._burst, self._now = rate, burst, clock.steady
        self._left, self._at = burst, self._now()

    def consume(self) -> bool:
        """Take a token, if there is one; return whether there was."""
        now = self._now()
        self._left = min(self._burst, self._left + (now - self._at) * self._rate)
        self._at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True

    def refund(self) -> None:
        """Return a token to the bucket."""
        self._left = min(self._burst, self._left + 1.0)

    def wait(self) -> float:
        """Return the seconds until the next token."""
        missing = 1.0 - min(self._burst, self._left + (self._now() - self._at) * self._rate)
        return max(0.0, missing / self._rate)


# --- The fast path: short messages bypass the queue of a connection ---

END_OF_REQUEST = b"\r\n\r\n"


class FastPath:
    """Handles messages that need no wait as soon as their bytes arrive.

    The parsing, the queue and the tasks that this saves take several times as long as a position does. It is
    used only while no message is on the slow path: messages are handled in the order sent. The handler
    handles a message, or returns false with nothing done.
    """

    def __init__(self) -> None:
        self._handler: Callable[[bytes], bool] | None = None
        self._counted = True
        self.on_the_long_way = 0
        self._edges: FrameParser | None = None

    def set_handler(self, handler: Callable[[bytes], bool], *, counted: bool = True) -> None:
        """Pass messages to ``handler`` from now on; beyond a limit as well unless they are ``counted``."""
        self._handler, self._counted = handler, counted

    def begin(self, request: bytes) -> None:
        """Track frames from the end of the request on; ``request`` are its last bytes."""
        # With data behind the request the start of the next frame is unknown.
        if request.find(END_OF_REQUEST) == len(request) - len(END_OF_REQUEST):
            self._edges = FrameParser()

    def handle_messages(self, data: bytes, messages: RateLimit) -> int:
        """Handle the messages at the beginning of ``data``, each counted by ``messages``.

        Return the start of the rest for the slow path; call :meth:`pass_over` with that rest.
        """
        start, edges = 0, self._edges
        if self._handler is None or edges is None or not edges.between or self.on_the_long_way:
            return 0
        while (found := short_text(data, start)) is not None:
            message, end = found
            if self._counted and not messages.consume():
                break
            if not self._handler(message):
                if self._counted:
                    messages.refund()
                break
            start = end
        return start

    def pass_over(self, data: bytes) -> None:
        """Track bytes that take the slow path."""
        if self._edges is not None:
            self._edges.pass_over(data)


# --- One connection to the gateway, and its limits ---

log = logging.getLogger(__name__)

CONTROL_FRAMES_PER_S = 20.0
CONTROL_BURST = 100.0
UNSENT_BYTES = 16_384
"""bytes of a connection that the system holds before they are on their way: a stop is sent behind them."""
STOP_PATIENCE_S = 0.5
"""seconds that a stop waits for the rest of a long message to a slow client."""
MOST_UNREAD, MOST_HELD = 1_000_000, 100
"""bytes of answers that a client leaves unread, and answers held while it is sent a long message, at most."""
CLOSE_WITHIN = 0.5
"""Seconds that an expelled client has for a clean close."""
_PING = b"gateway"
_OF_MESSAGES = (Opcode.TEXT, Opcode.BINARY, Opcode.CONT)


@dataclass(frozen=True)
class Identity:
    """The owner of a connection; ``token`` is the token's id, None if no tokens are in use."""

    kind: TokenKind
    name: str | None
    token: str | None
    session: str


class ConnectionLimiter(Protocol):
    """Interface of a connection to the gate."""

    @property
    def limits(self) -> LimitSettings:
        """The present limits."""

    def arrived(self, connection: ClientConnection) -> None:
        """Count a new connection."""

    def left(self, connection: ClientConnection) -> None:
        """Count a connection that is gone."""


class ClientConnection(ServerConnection):
    """A connection whose messages are counted, and which is cut when it accepts no more data."""

    def __init__(self, door: ConnectionLimiter, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._door = door
        self._limits = door.limits
        self._stuck: asyncio.TimerHandle | None = None
        self._silence: asyncio.TimerHandle | None = None
        self._next_ping: asyncio.TimerHandle | None = None
        self._pinged_at: float | None = None
        """when the unanswered ping was sent."""
        self._last_received_at = 0.0
        self._expelled = False
        self.is_gone = False
        """Whether the connection has ended; it is not admitted after that."""
        self.was_cut = False
        """Whether it was cut for a stop."""
        self._control = RateLimit(CONTROL_FRAMES_PER_S, CONTROL_BURST)
        self._messages = self._patience = self._answers = RateLimit(1.0, 1.0)
        self._never_refused: Callable[[jsonrpc.Call], bool] = lambda _call: False
        self._ending: asyncio.Task[None] | None = None
        self._held = BackgroundTasks()
        self._unread = 0
        """bytes of answers written since the client has stopped reading."""
        self.short_cut = FastPath()
        self.identity: Identity | None = None
        self.address = ""
        self.round_trip: float | None = None
        """Round-trip time of the last ping in seconds."""

    # --- the connection's life ------------------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Accept a new connection."""
        peer = transport.get_extra_info("peername") or ("",)
        self.address = str(peer[0])
        super().connection_made(transport)
        self._door.arrived(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Record that the connection is gone."""
        for timer in (self._stuck, self._silence, self._next_ping):
            if timer is not None:
                timer.cancel()
        super().connection_lost(exc)
        self.is_gone = True
        self._door.left(self)

    def let_in(self, identity: Identity, largest_message: int) -> None:
        """Apply the limits of its kind to the connection from now on."""
        self.identity = identity
        limits = self._limits
        rate, burst = {
            TokenKind.ROBOT: (limits.robot_messages_per_s, limits.robot_burst),
            TokenKind.OPERATOR: (limits.desk_messages_per_s, limits.desk_burst),
            TokenKind.LINK: (limits.link_messages_per_s, limits.link_burst),
        }[identity.kind]
        self._messages, self._patience = RateLimit(rate, float(burst)), RateLimit(rate / 10, float(burst))
        self._answers = RateLimit(rate, float(burst))
        self.protocol.max_message_size = largest_message
        # Data buffered by the system for a slow client is old when it arrives, and a stop is behind it.
        own = self.transport.get_extra_info("socket")
        with contextlib.suppress(OSError):
            own.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, limits.send_buffer_bytes)
            if hasattr(socket, "TCP_NOTSENT_LOWAT"):
                own.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)
        self._silence = self.loop.call_later(limits.first_message_s, self._check_silence)

    def handle_at_once(self, handler: Callable[[bytes], bool]) -> None:
        """Pass messages to ``handler`` as their bytes arrive; those that it returns false for are queued."""
        self.short_cut.set_handler(handler)

    def accept_stops(
        self, begin: Callable[[bytes], bool], never_refused: Callable[[jsonrpc.Call], bool]
    ) -> None:
        """Pass messages to ``begin`` as their bytes arrive, and queue calls that are ``never_refused``.

        Both beyond the rate limit as well. ``begin`` returns false: each message is then queued or refused.
        """
        self.short_cut.set_handler(begin, counted=False)
        self._never_refused = never_refused

    @property
    def is_idle(self) -> bool:
        """Whether all written data has been sent: the client reads."""
        return bool(self.transport.get_write_buffer_size() == 0)

    def write_at_once(self, text: str) -> bool:
        """Write a short message without an iteration of the loop.

        Returns false, with nothing done, while another message is being sent in pieces, or the connection is
        not open.
        """
        if self.protocol.state is not OPEN or self.send_in_progress is not None:
            return False
        self.protocol.send_text(text.encode())
        self.send_data()
        return True

    def send_without_wait(self, text: str) -> None:
        """Send an answer without waiting for the client, whose next message may be a stop.

        The client is cut off when it leaves too many unread.
        """
        if self.transport.is_closing():
            return
        if self._stuck is not None:
            self._unread += len(text)
        if self._unread > MOST_UNREAD or len(self._held) >= MOST_HELD:
            self._give_up()
        elif self._held or not self.write_at_once(text):
            self._held.start(self._send_held(text))

    async def _send_held(self, text: str) -> None:
        with contextlib.suppress(ConnectionClosed):
            await self.send(text)

    async def send_together(self, texts: Sequence[str]) -> None:
        """Send short messages, in one piece if possible; raises ConnectionClosed."""
        if self.protocol.state is OPEN and self.send_in_progress is None:
            for text in texts:
                self.protocol.send_text(text.encode())
            self.send_data()
            await self.drain()
        else:
            for text in texts:
                await self.send(text)

    @property
    def is_busy(self) -> bool:
        """Whether a long message is being sent."""
        return self.send_in_progress is not None

    async def cut_if_busy(self) -> None:
        """Wait for the end of a long message that is being sent, before a stop.

        Nothing can be sent between its pieces, and on a slow line it takes minutes: after
        :data:`STOP_PATIENCE_S` the connection is cut. The client connects again, and hears the stop first.
        """
        until = self.loop.time() + STOP_PATIENCE_S
        while (message := self.send_in_progress) is not None:
            await asyncio.wait([message], timeout=max(0.0, until - self.loop.time()))
            if message.done() or self.loop.time() < until:
                continue
            if self.transport.is_closing():
                return
            if self.transport.get_write_buffer_size() > 0:
                self.was_cut = True
                log.warning(
                    "%s from %s is cut off: a stop would wait for the rest of a long message on its slow "
                    "line; it is sent the stop when it connects again",
                    self.who,
                    self.address,
                )
                self.transport.abort()
                return
            # All that was written is on its way: the line is fast, and this process slow.
            until = self.loop.time() + STOP_PATIENCE_S

    async def expel(self, code: int, reason: str) -> None:
        """End the connection, with or without the client's close; further messages are ignored, or all but
        stops where the client did not keep to the limits."""
        self._expelled = True
        try:
            with contextlib.suppress(TimeoutError):
                # Not by wait_for, whose task begins later: the end of the reading closes with 1000 first.
                async with asyncio.timeout(CLOSE_WITHIN):
                    await self.close(code, reason)
        finally:
            self.transport.abort()

    # --- incoming data --------------------------------------------------------------------------------

    def data_received(self, data: bytes) -> None:
        """Receive bytes: short messages are handled at once if possible, the others queued."""
        start = self._deal_with(data)
        if start < len(data):
            rest, is_upgraded = data[start:] if start else data, self.request is not None
            super().data_received(rest)
            if not is_upgraded and self.request is not None:
                self.short_cut.begin(rest)
            else:
                self.short_cut.pass_over(rest)

    def _deal_with(self, data: bytes) -> int:
        if self.protocol.state is not OPEN or self.protocol.current_size is not None or self._expelled:
            return 0
        start = self.short_cut.handle_messages(data, self._messages)
        if start:
            self._last_received_at = self.loop.time()
        return start

    async def __aiter__(self) -> AsyncIterator[Any]:
        """Yield the messages; those beyond the limit are refused, and finally the connection is closed.

        A stop is yielded all the same until the client has closed its side, also behind what led to the end;
        not that of a client that is expelled. Answers have a limit of their own, since nobody sends them
        again: beyond it the connection is closed at once, and asks again when it is open once more.
        """
        async for frame in super().__aiter__():
            if self._expelled and self._ending is None:
                return
            self._last_received_at = self.loop.time()
            is_over = self._ending is not None
            is_beyond = is_over or not self._messages.consume()
            message = _message_in(frame) if is_beyond else None
            is_answer = isinstance(message, jsonrpc.Reply)
            if not is_beyond or (isinstance(message, jsonrpc.Call) and self._never_refused(message)):
                yield frame
            elif is_over:
                # Of what follows a message that was dropped nothing is carried out.
                pass
            elif is_answer and self._answers.consume():
                yield frame
            elif not is_answer and self._patience.consume():
                self._refuse(message)
            else:
                log.warning("%s from %s: too many messages; closed", self.who, self.address)
                self._end(CloseCode.POLICY_VIOLATION, "too many messages a second")
            self.short_cut.on_the_long_way -= 1

    def start_keepalive(self) -> None:
        """Start pinging by a timer: a task and a future for each ping take three times as long."""
        if self.ping_interval is not None:
            self._next_ping = self.loop.call_later(self.ping_interval, self._keep_alive)

    def _keep_alive(self) -> None:
        assert self.ping_interval is not None
        if self.protocol.state is not OPEN:
            return
        now = time.perf_counter()
        if self._pinged_at is None:
            self._pinged_at = now
            self.protocol.send_ping(_PING)
            self.send_data()
        elif self.ping_timeout is not None and now - self._pinged_at >= self.ping_timeout:
            log.info("%s from %s answers no ping; cut off", self.who, self.address)
            self.transport.abort()
            return
        self._next_ping = self.loop.call_later(self.ping_interval, self._keep_alive)

    def process_event(self, event: Any) -> None:
        """Process one frame; pings and empty fragments are counted, since nobody waits for them."""
        if isinstance(event, Frame) and _is_idle_talk(event) and not self._control.consume():
            log.warning("%s from %s: too many control frames; cut off", self.who, self.address)
            self.transport.abort()
            return
        if isinstance(event, Frame) and event.fin and event.opcode in _OF_MESSAGES:
            self.short_cut.on_the_long_way += 1
        if self._pinged_at is not None and _is_answer(event):
            # This clock is finer than that of some event loops.
            self.round_trip, self._pinged_at = time.perf_counter() - self._pinged_at, None
        super().process_event(event)

    @property
    def has_sent(self) -> bool:
        """Whether a message has arrived since admission."""
        return self._last_received_at > 0

    @property
    def who(self) -> str:
        """The connection's owner, for the log."""
        if self.identity is None:
            return "somebody"
        return f"{self.identity.kind.value} {self.identity.name or 'without a name'}"

    def _refuse(self, message: jsonrpc.Call | jsonrpc.Reply | None) -> None:
        text = f"too many messages; wait {max(self._messages.wait(), 0.01):.2f} s and send fewer a second"
        if message is not None and message.id is not None:
            self.send_without_wait(jsonrpc.error(message.id, jsonrpc.TOO_MANY, text))

    def _end(self, code: int, reason: str) -> None:
        self._ending = self.loop.create_task(self.expel(code, reason))

    def _check_silence(self) -> None:
        limits, robot = self._limits, self.identity is not None and self.identity.kind is TokenKind.ROBOT
        if self._last_received_at and not robot:
            return
        due = self._last_received_at + limits.silent_s if self._last_received_at else self.loop.time()
        if due <= self.loop.time():
            log.warning("%s from %s said nothing for too long; closed", self.who, self.address)
            self._end(CloseCode.POLICY_VIOLATION, "silent for too long")
        else:
            self._silence = self.loop.call_at(due, self._check_silence)

    # --- outgoing data --------------------------------------------------------------------------------

    def pause_writing(self) -> None:
        """Start waiting for a slow client."""
        super().pause_writing()
        self._unread = 0
        self._stuck = self.loop.call_later(self._limits.stuck_s, self._give_up)

    def resume_writing(self) -> None:
        """Continue with a client that has caught up."""
        if self._stuck is not None:
            self._stuck.cancel()
            self._stuck = None
        super().resume_writing()

    def _give_up(self) -> None:
        log.warning("%s from %s takes nothing of what it is sent; cut off", self.who, self.address)
        self.transport.abort()


def _message_in(frame: str | bytes) -> jsonrpc.Call | jsonrpc.Reply | None:
    try:
        return jsonrpc.decode(frame)
    except jsonrpc.FrameError:
        return None


def _is_answer(event: Any) -> bool:
    return isinstance(event, Frame) and event.opcode is Opcode.PONG and event.data == _PING


def _is_idle_talk(frame: Frame) -> bool:
    return frame.opcode in (Opcode.PING, Opcode.PONG) or (not frame.data and not frame.fin)
