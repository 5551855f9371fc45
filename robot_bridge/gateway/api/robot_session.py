"""Session of one robot: its connection, its requests, messages delivered to it."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Awaitable, Coroutine, Iterator
from contextlib import AbstractAsyncContextManager, nullcontext
from dataclasses import replace
from typing import Any

from websockets.exceptions import ConnectionClosed, ConnectionClosedOK
from websockets.frames import CloseCode

from ...core.errors import BridgeError, DataRefusedError, NotReadyError, StoreError
from ...core.logs import Key
from ...core.messages.administration import Gateways
from ...core.messages.base import LARGEST_MESSAGE, MessageError, to_json
from ...core.messages.robots import REQUESTS, OpAck, Ready, Request, SendPos
from ...protocol import jsonrpc
from ...protocol.codec import check_size, decode_position, decode_request, error_code
from ..auth.accounts import TokenKind
from ..auth.authorisation import PATHS
from ..auth.client_connection import ClientConnection
from ..fleet.link_supervision import ConnectionClaims
from ..fleet.robot_outboxes import RequestOutcome
from ..fleet.service import Fleet
from ..monitoring import BackgroundTasks
from ..storage.database import to_its_end
from ..storage.repositories.robots import FencedError
from .delivery import Channel, Delivery, while_connected

log = logging.getLogger(__name__)

# --- One robot behind a channel: its requests, its acknowledgements, and its outbox ---

_OTHERS = ("frames", "replies")
"""Kinds of refused messages other than calls of an operation."""
POSITION = jsonrpc.Call("SendPos", None)
ANEW = "the robot has connected anew"
MOST_DUE = 50
"""messages of a robot being stored at once; further ones wait for them."""


class RobotSessions:
    """The current session of each robot: the one on which it last sent Ready."""

    def __init__(self, claims: ConnectionClaims) -> None:
        self._claims = claims
        self._holders: dict[str, RobotSession] = {}
        self._applicants: dict[str, RobotSession] = {}
        """sessions with a Ready that could not be stored yet."""

    def __iter__(self) -> Iterator[RobotSession]:
        return iter(list(self._holders.values()))

    def get(self, robot: str) -> RobotSession | None:
        """Return the session of a robot, None if it is not connected."""
        return self._holders.get(robot)

    def applicant(self, robot: str) -> RobotSession | None:
        """Return the session on which a robot has said Ready, and waits for the database."""
        return self._applicants.get(robot)

    def await_admission(self, session: RobotSession) -> None:
        """Record that ``session`` has said Ready, until it is admitted, refused or released."""
        self._applicants[session.robot] = session

    def refuse(self, session: RobotSession) -> None:
        """Record that ``session`` waits no more."""
        if self._applicants.get(session.robot) is session:
            del self._applicants[session.robot]

    def admit(self, session: RobotSession) -> None:
        """Make ``session`` the connection of its robot, and end the previous one."""
        self.refuse(session)
        former = self._holders.get(session.robot)
        self._holders[session.robot] = session
        self._claims.claim(session.robot, session)
        if former is not None and former is not session:
            former.replace()

    def release(self, session: RobotSession) -> bool:
        """Remove ``session``; return whether its robot was connected by it."""
        self.refuse(session)
        held = self._holders.get(session.robot) is session
        if held:
            self._claims.free(session.robot, session)
            del self._holders[session.robot]
        return held


class RobotSession:
    """One robot on one channel; after its Ready it is admitted to ``sessions``."""

    def __init__(
        self,
        fleet: Fleet,
        channel: Channel,
        robot: str,
        sessions: RobotSessions,
    ) -> None:
        self.robot = robot
        self._fleet = fleet
        self._channel = channel
        self._sessions = sessions
        self._admitted = False
        self._delivery = Delivery(fleet, channel, robot)
        self._closing: asyncio.Task[None] | None = None
        self._due = BackgroundTasks()
        self._has_ended = False
        self._sent_gateways: list[str] | None = None

    # --- called by its connection -----------------------------------------------------------------

    @property
    def is_replaced(self) -> bool:
        """Whether the robot has reconnected elsewhere: further messages here are ignored."""
        return self._closing is not None

    def replace(self, reason: str = ANEW, *, again: bool = False) -> None:
        """Stop carrying messages: the robot has reconnected, or should do so (``again``)."""
        self.end()
        # A dead connection takes seconds to close, and the new one must not wait for it.
        self._closing = asyncio.create_task(self._channel.release(reason, again=again))

    def end(self) -> None:
        """Stop delivering: the channel is gone. Messages being stored are stored to the end."""
        self._has_ended = True
        self._delivery.end()

    def stop_now(self, call_id: str, *, emergency: bool = True) -> None:
        """Send the robot an Abort with the id ``call_id`` without any wait."""
        self._delivery.stop_now(call_id, emergency=emergency)

    def outdate(self) -> None:
        """Discard messages read before: the robot is sent a stop with the others of its link."""
        self._delivery.outdate()

    def ask_again(self) -> None:
        """Send unacknowledged messages again in a moment: a reply was not processed."""
        if self._admitted and not self._has_ended:
            self._delivery.begin_later()

    def measure(self) -> None:
        """Record the round-trip time of the last ping."""
        if self._admitted and self._channel.round_trip is not None:
            self._fleet.robots.measured(self.robot, self._channel.round_trip)

    async def answers(self) -> bool:
        """Return whether the robot is alive, as far as its channel knows."""
        return await self._channel.answers()

    async def send_gateways(self) -> None:
        """Send the robot the addresses of the fleet's gateways; before its Ready, Start and OpAck carry them.

        :raises ConnectionClosed: when the connection is gone.
        """
        gateways = self._fleet.gateways_at(self._channel.endpoint)
        if gateways is not None and self._admitted and not self._has_ended:
            # The next OpAck carries them as well, for robots that ignore unknown messages.
            await self._channel.send(self._channel.call(Gateways.method, to_json(gateways)))

    # --- incoming messages ---

    def accept_pose(self, pose: SendPos) -> bool:
        """Process a position at once; return false, with nothing done, unless :meth:`listens`."""
        if not self.listens():
            return False
        rest: Awaitable[None] | Exception | None
        try:
            rest = self._fleet.accept_pose(self.robot, self._channel.name, pose)
        except Exception as error:
            rest = error
        if rest is not None:
            self.follow_up(rest)
        return True

    def listens(self) -> bool:
        """Return whether the robot is admitted, and not too many of its messages are still being stored."""
        return self._admitted and self._closing is None and len(self._due) < MOST_DUE

    def follow_up(self, rest: Awaitable[None] | Exception) -> None:
        """Await the further processing of a position, or send its error."""
        self._due.start(while_connected(self._answer(POSITION, self._outcome(rest))))

    async def receive_pose(self, pose: SendPos) -> None:
        """Process a position, at once if possible; else after the messages being stored, or refuse it."""
        if not self.accept_pose(pose):
            await self._due.wait()
            await self._answer(POSITION, self._ask(pose, None))

    async def receive(self, message: jsonrpc.Call | jsonrpc.Reply) -> None:
        """Process a call, after the messages still being stored, or begin to process a reply."""
        if isinstance(message, jsonrpc.Call):
            await self._due.wait()
            await self._answer(message, self._receive_call(message))
        else:
            await self._due.wait(MOST_DUE - 1)
            self._receive_reply(message)

    async def refuse_frame(self, error: jsonrpc.FrameError, *, large: bool = False) -> None:
        """Send the robot that a frame cannot be read, and notify operators if it was too ``large``."""
        await self._due.wait()
        if large and self._admitted:
            self._fleet.refuse_large(self.robot, self._channel.name, str(error))
        self._warn(self._key_of("frames"), f"{self._who}: {error}")
        await self._channel.send(self._channel.error(error.id, error.code, str(error)))

    @property
    def _who(self) -> str:
        return f"link {self._channel.name}: robot {self.robot!r}"

    async def _outcome(self, rest: Awaitable[None] | Exception) -> RequestOutcome:
        if isinstance(rest, Exception):
            raise rest
        await rest
        return RequestOutcome(self.robot)

    async def _receive_call(self, call: jsonrpc.Call) -> RequestOutcome:
        request = decode_request(call.method, call.params)
        return await self._ask(request, call.id if isinstance(call.id, int) else None)

    async def _answer(self, call: jsonrpc.Call, work: Coroutine[Any, Any, RequestOutcome]) -> None:
        """Await the outcome of a call and send it: a call is acknowledged only once its answer is stored."""
        channel = self._channel
        try:
            outcome = await work
            if outcome.answer is not None or outcome.admitted:
                reader = self._delivery.reader
                await self._fleet.outboxes.finish([outcome], [], acks=False, reader=reader)
        except (MessageError, BridgeError) as error:
            self._warn(self._key_of(call.method, error), f"{self._who}: {error}")
            await channel.send(channel.error(call.id, error_code(error), str(error)))
            return
        except ConnectionClosed:
            raise
        except Exception:
            text = self._log_unforeseen(call.method, self._who)
            await channel.send(channel.error(call.id, jsonrpc.INTERNAL_ERROR, text))
            return
        begins = call.method == Ready.__name__ and outcome.admitted
        if call.id is not None:
            send = self._delivery.send_result if begins else channel.send
            await send(channel.result(call.id, to_json(self._acknowledgement(outcome))))
        if begins:
            self._delivery.begin()

    def _acknowledgement(self, outcome: RequestOutcome) -> OpAck:
        """Return the OpAck of a call, with the gateways of the fleet if changed since last sent."""
        ack, gateways = outcome.ack or OpAck(), self._fleet.gateway_urls(self._channel.endpoint)
        if gateways == self._sent_gateways and not outcome.admitted:
            return ack
        self._sent_gateways = gateways
        return replace(ack, gateways=gateways)

    async def _ask(self, request: Request, id: int | None) -> RequestOutcome:
        if not isinstance(request, Ready):
            if not self._admitted:
                raise NotReadyError(
                    f"robot {self.robot!r} has not said Ready on this connection; send Ready first"
                )
            return await self._fleet.receive(self.robot, self._channel.name, request, id)
        # A robot that restarts on its own connection is not a second one.
        self._fleet.reception.holds.free(self.robot, self)
        self._sessions.await_admission(self)
        try:
            outcome = await self._fleet.receive(self.robot, self._channel.name, request, id)
            if outcome.admitted:
                self._fleet.check_owned(self.robot)
        except Exception as error:
            # Where the database does not answer it says Ready again, and hears Aborts until then.
            if isinstance(error, FencedError) or not isinstance(error, StoreError):
                self._sessions.refuse(self)
            raise
        if not outcome.admitted:
            self._sessions.refuse(self)
        else:
            self._admitted = True
            self._sessions.admit(self)
        return outcome

    def _receive_reply(self, reply: jsonrpc.Reply) -> None:
        if not self._admitted:
            return
        storing: Awaitable[None] | Exception
        try:
            if isinstance(reply.id, str):
                self._fleet.emergency.answered(self.robot, reply.id, refused=reply.error is not None)
                return
            ack = OpAck(id=reply.id, ok=reply.error is None, reason=reply.error)
            storing = self._fleet.acknowledge(self.robot, self._channel.name, ack)
        except Exception as error:
            storing = error
        self._due.start(while_connected(self._finish_reply(reply.id, storing)))

    async def _finish_reply(self, id: int | str | None, storing: Awaitable[None] | Exception) -> None:
        try:
            await self._outcome(storing)
        except DataRefusedError as error:
            # If it were asked again, the robot would send the same refused reply, for ever.
            log.error("%s: %s; what it said is left out", self._who, error)
        except StoreError as error:
            line = f"{self._who}: {error}; it will be asked again"
            self._fleet.repeated.warn(log, self._key_of("replies", error), line)
            self.ask_again()
        except (MessageError, BridgeError) as error:
            self._warn(self._key_of("replies", error), f"{self._who}: {error}")
        except Exception:
            # A reply has no answer: the error goes to the log only.
            self._log_unforeseen("replies", f"{self._who}, acknowledgement {id}")

    def _warn(self, key: Key, line: str) -> None:
        """Count a refusal, and log it unless it repeats."""
        self._fleet.counters.refused[self._channel.name] += 1
        self._fleet.repeated.warn(log, key, line)

    def _log_unforeseen(self, method: str, who: str) -> str:
        return self._fleet.repeated.note_unforeseen(log, self._key_of(method), who)

    def _key_of(self, method: str, error: Exception | None = None) -> Key:
        """Return the key that log lines are counted by: a full database counts once for all robots."""
        if isinstance(error, StoreError) and not isinstance(error, DataRefusedError):
            return f"link {self._channel.name}:", "database"
        what = method if method in REQUESTS or method in _OTHERS else "unknown operations"
        return f"link {self._channel.name}:", "robot", repr(self.robot), what


# --- A robot's own WebSocket: JSON-RPC 2.0 with the operation codes of the paper as methods ---
# A robot's requests are calls (SendPos and Alive may be notifications), and the gateway's OpAck is the
# result. The gateway's messages are calls with the id of the message; the robot's OpAck is the result, or an
# error if it refuses.

NAME = "websocket"
FRAME_PIECE = 1 << 15
"""characters of a message sent as one frame: a stop is sent behind a whole one."""
PING_TIMEOUT = 1.0
"""seconds after which a robot counts as gone when another one connects under its name."""
REPLACED = 4001
"""Close code for a connection whose robot has reconnected."""


class RobotChannel:
    """The WebSocket of one robot, as its :class:`.robot_session.Channel`."""

    name = NAME
    endpoint = PATHS[TokenKind.ROBOT]

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection

    @property
    def round_trip(self) -> float | None:
        """Round-trip time of the last ping in seconds."""
        return self._connection.round_trip

    def call(self, method: str, params: Any = None, id: int | str | None = None) -> str:
        """Return the frame of a request."""
        return jsonrpc.call(method, params, id)

    def result(self, id: int | str | None, value: Any) -> str:
        """Return the frame of a result."""
        return jsonrpc.result(id, value)

    def error(self, id: int | str | None, code: int, text: str) -> str:
        """Return the frame of an error."""
        return jsonrpc.error(id, code, text)

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Do not wait: the connection serves this robot alone."""
        return nullcontext()

    async def send(self, frame: str) -> None:
        """Send a frame."""
        await send_frame(self._connection, frame)

    def send_at_once(self, frame: str) -> bool:
        """Write a frame now; return false while another one is being sent."""
        return self._connection.write_at_once(frame)

    @property
    def is_busy(self) -> bool:
        """Whether a long message is being sent."""
        return self._connection.is_busy

    async def cut_if_busy(self) -> None:
        """Wait for the end of a long message, or cut the connection."""
        await self._connection.cut_if_busy()

    async def answers(self) -> bool:
        """Return whether the robot answers a ping within a second."""
        return await is_answering(self._connection)

    async def release(self, reason: str, *, again: bool = False) -> None:
        """Close the connection."""
        await self._connection.close(CloseCode.SERVICE_RESTART if again else REPLACED, reason)


class RobotConnection:
    """One connection of one robot, from its Start to its end."""

    def __init__(
        self, fleet: Fleet, connection: ClientConnection, robot: str, sessions: RobotSessions
    ) -> None:
        self._fleet = fleet
        self._connection = connection
        self._channel = RobotChannel(connection)
        self.session = RobotSession(fleet, self._channel, robot, sessions)

    async def run(self) -> bool:
        """Serve the connection to its end; return true if the robot closed it cleanly."""
        try:
            greeting = self._fleet.greeting(self._channel.endpoint)
            await self._connection.send(self._channel.call("Start", to_json(greeting)))
            if (call_id := self._fleet.emergency.call_id) is not None:
                self.session.stop_now(call_id)
            self._connection.handle_at_once(self._take_at_once)
            async for frame in self._connection:
                if not self.session.is_replaced:
                    await self._receive(frame)
        except ConnectionClosedOK:
            return True
        except ConnectionClosed:
            return False
        finally:
            self.session.end()
        return self._connection.close_code in (1000, 1001)

    def _take_at_once(self, frame: bytes) -> bool:
        """Process a position; return false for everything else, and while a wait is needed."""
        pose = decode_position(frame)
        return pose is not None and self.session.accept_pose(pose)

    async def _receive(self, frame: str | bytes) -> None:
        if len(frame) <= LARGEST_MESSAGE and (pose := decode_position(frame)) is not None:
            await self.session.receive_pose(pose)
            return
        large = True
        try:
            check_size(frame, LARGEST_MESSAGE)
            large = False
            message = jsonrpc.decode(frame)
        except jsonrpc.FrameError as error:
            await self.session.refuse_frame(error, large=large)
            return
        await self.session.receive(message)


async def send_frame(connection: ClientConnection, frame: str) -> None:
    """Send a message, a large one in several frames: as one it would block the gateway while it is copied,
    and be buffered as a whole before a stop.

    It is sent to its end even if the sender is cancelled: nothing could follow a truncated message.
    """
    if len(frame) <= FRAME_PIECE:
        await connection.send(frame)
    else:
        await to_its_end(connection.send(_pieces(frame)))


async def _pieces(frame: str) -> AsyncIterator[str]:
    for begin in range(0, len(frame), FRAME_PIECE):
        yield frame[begin : begin + FRAME_PIECE]
        # A connection that accepts everything at once would not yield, and others must have their turn.
        await asyncio.sleep(0)


async def is_answering(connection: ClientConnection) -> bool:
    """Return whether a client answers a ping within a second."""
    try:
        async with asyncio.timeout(PING_TIMEOUT):
            await (await connection.ping())
    except (ConnectionClosed, TimeoutError):
        return False
    return True
