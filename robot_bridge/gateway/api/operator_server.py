"""Server of operators: sessions over WebSocket, order of their requests.

Requests that stop robots are begun at once, before all others. Those that may take long are answered aside,
and everything else in turn. A stop overtakes the waiting requests: those that would set robots in motion are
refused then, since they were made before the stop.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import time
from collections import deque
from collections.abc import Callable, Coroutine
from contextlib import AbstractContextManager
from typing import Any, NamedTuple

import msgspec
from websockets.exceptions import ConnectionClosed

from ...core.clock import steady_time
from ...core.errors import (
    BridgeError,
    BusyError,
    LateError,
    OutdatedError,
    OverridableError,
    RefusedError,
)
from ...core.logs import end_on_error, log_and_continue
from ...core.messages import commands
from ...core.messages.administration import PROTOCOL_VERSION, Hello
from ...core.messages.base import DESK_REQUESTS, DeskRequest, MessageError, Priority, Role, to_json
from ...core.messages.commands import Send
from ...core.messages.positions import PositionForm, Subscribe
from ...core.messages.roads import GetRoute
from ...core.messages.safety import EmergencyStop
from ...protocol import jsonrpc
from ...protocol.codec import decode_desk_request, error_code
from ..auth.accounts import TokenKind
from ..auth.authorisation import PATHS, AuthGate, check_permission
from ..auth.client_connection import ClientConnection, RateLimit
from ..fleet.operator_updates import EVERYTHING, Tick
from ..fleet.service import Fleet
from ..fleet.views import ViewWatch
from ..model.events import Answering
from ..monitoring import BackgroundTasks

# --- The order of requests, and which ones a stop overtakes ---

MOST_WAITING, MOST_ASIDE, MOST_STOPPING = 256, 64, 1000
"""requests of one operator that wait their turn, that wait aside, and that stop robots, at most."""
MOST_EMERGENCIES = 50
"""emergency stops of one operator handled at the same time; beyond that the connection waits."""
STOPS_PER_S = 50.0
"""stops a second, MOST_STOPPING at once, that are accepted beyond a desk's rate limit, of operators who may
stop robots: ``abort``, ``abort_all``, ``pause_robot`` and a ``send`` of Abort. Emergency stops always are."""
MOST_BYTES = 4_000_000
"""bytes of one operator's requests that wait, at most in each lane."""


class ScheduledRequest(NamedTuple):
    """A request, the call that it came in, and its length in bytes."""

    call: jsonrpc.Call
    request: DeskRequest[Any]
    size: int

    @property
    def stops(self) -> bool:
        """Return whether the request stops robots."""
        return commands.stops_robots(type(self.request), getattr(self.request, "op", None))

    @property
    def words(self) -> str:
        """The request as operators know it: the method, of a ``send`` the operation."""
        return self.request.op if isinstance(self.request, Send) else self.request.method


Settle = Callable[[ScheduledRequest, Exception | None], Coroutine[Any, Any, None]]
"""Handles a request and sends the operator its outcome; with an exception only sends that, without a wait."""


class RequestScheduler:
    """The requests of one operator that are being handled, or wait."""

    def __init__(self, settle: Settle) -> None:
        self._settle = settle
        self._turn = _Lane(settle)
        self._aside = _Lane(settle)
        self._stopping = BackgroundTasks()
        self._late: list[ScheduledRequest] = []
        """waiting requests that a stop has overtaken."""

    def overtake(self, stop: DeskRequest[Any]) -> None:
        """Withdraw the waiting requests that ``stop``, itself not begun yet, overtakes."""
        self._late += self._turn.withdraw(lambda waiting: _is_overtaken(waiting, stop))

    async def submit(self, scheduled: ScheduledRequest) -> None:
        """Schedule a request; returns at once, or when one that cannot be accepted has been refused."""
        if scheduled.stops:
            await self._stop(scheduled)
        elif scheduled.request.priority is Priority.SLOW:
            await self._ask_aside(scheduled)
        elif not self._turn.submit(scheduled, MOST_WAITING):
            await self._settle(scheduled, _too_many(scheduled))

    async def finish(self) -> None:
        """Wait for requests that stop robots or have been begun; drop the rest, the operator is gone."""
        self._aside.cancel()
        await asyncio.gather(self._stopping.wait(), self._turn.end(), return_exceptions=True)

    async def _stop(self, scheduled: ScheduledRequest) -> None:
        emergency = isinstance(scheduled.request, EmergencyStop)
        if not emergency and len(self._stopping) >= MOST_STOPPING:
            await self._settle(scheduled, _too_many(scheduled))
            return
        self._stopping.start(self._settle(scheduled, None))
        self.overtake(scheduled.request)
        overtaken, self._late = self._late, []
        for late in overtaken:
            await self._settle(late, _overtaken(late, scheduled))
        if emergency:
            await self._stopping.wait(MOST_STOPPING + MOST_EMERGENCIES - 1)

    async def _ask_aside(self, scheduled: ScheduledRequest) -> None:
        for older in self._aside.withdraw(lambda waiting: _is_renewed(waiting, scheduled)):
            await self._settle(older, RefusedError("get_route: it was asked again before this was begun"))
        if not self._aside.submit(scheduled, MOST_ASIDE):
            await self._settle(scheduled, _too_many(scheduled))


class _Lane:
    """Handles requests one after the other."""

    def __init__(self, settle: Settle) -> None:
        self._settle = settle
        self._waiting: deque[ScheduledRequest] = deque()
        self._task: asyncio.Task[None] | None = None

    def submit(self, scheduled: ScheduledRequest, most: int) -> bool:
        """Queue a request; return false when too many wait."""
        waiting = sum(one.size for one in self._waiting)
        if len(self._waiting) >= most or (self._waiting and waiting + scheduled.size > MOST_BYTES):
            return False
        self._waiting.append(scheduled)
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._run())
        return True

    def withdraw(self, which: Callable[[ScheduledRequest], bool]) -> list[ScheduledRequest]:
        """Remove and return the waiting requests that ``which`` selects."""
        gone = [scheduled for scheduled in self._waiting if which(scheduled)]
        self._waiting = deque(scheduled for scheduled in self._waiting if not which(scheduled))
        return gone

    def cancel(self) -> None:
        """Drop all requests unanswered."""
        self._waiting.clear()
        if self._task is not None:
            self._task.cancel()

    async def end(self) -> None:
        """Wait until the begun request is handled; drop the rest."""
        self._waiting.clear()
        if self._task is not None:
            await self._task

    async def _run(self) -> None:
        while self._waiting:
            await self._settle(self._waiting.popleft(), None)


def _is_overtaken(waiting: ScheduledRequest, stop: DeskRequest[Any]) -> bool:
    """Return whether a request would set a robot in motion that the later ``stop`` must stop."""
    robot, stopped = (getattr(one, "robot", None) for one in (waiting.request, stop))
    return commands.is_overtaken(type(waiting.request), robot, stopped)


def _is_renewed(waiting: ScheduledRequest, scheduled: ScheduledRequest) -> bool:
    """Return whether ``scheduled`` asks for the same route with another goal, as while a mouse moves."""
    old, new = waiting.request, scheduled.request
    if not (isinstance(old, GetRoute) and isinstance(new, GetRoute)):
        return False
    return (old.robot, old.start) == (new.robot, new.start)


def _overtaken(late: ScheduledRequest, stop: ScheduledRequest) -> RefusedError:
    return RefusedError(
        f"{late.words}: {stop.words} came after it and before it was begun, so that it was "
        "not done; ask again if it is to be done all the same"
    )


def _too_many(scheduled: ScheduledRequest) -> BusyError:
    return BusyError(
        f"{scheduled.request.method}: too many requests of this connection wait to be answered; "
        "wait for answers, then ask again"
    )


# --- One operator on a WebSocket ---

# --- The operators' protocol: JSON-RPC 2.0 on WebSocket, requests in, positions and commands out ---

log = logging.getLogger(__name__)

OWN = (Hello, Subscribe)
"""Requests on the connection itself; all later ones depend on them."""
SUBJECTS = ("robot", "session", "operator", "site", "observation", "command", "plan")
"""Parameters that name the subject of a request; of several the first counts."""
UNNOTED = ("hello", "subscribe", "find_robots")
"""Requests that change nothing but the connection they come from."""
AT_ONCE = ("emergency",)
"""Notifications sent without an iteration of the loop, in which thousands of robots may come first."""
_STOP = EmergencyStop.method.encode()
NEWS_CHARACTERS = 32_768
"""characters of notifications sent together: a stop of thousands of robots gives one of each."""
VIEW_REST_S = 0.1
"""seconds between frames to a desk whose view moves."""


class OperatorSession:
    """One operator's connection.

    A slow operator gets fewer snapshots, each of the newest state, and of each command the newest report:
    its queue never exceeds one entry for each robot and command.
    """

    def __init__(
        self, fleet: Fleet, connection: ClientConnection, gate: AuthGate, handlers: Answering
    ) -> None:
        self._fleet = fleet
        self._handlers = handlers
        self._connection = connection
        self._gate = gate
        assert connection.identity is not None
        self._operator = connection.identity.name or f"desk {connection.address}"
        self._news: dict[tuple[str, str], dict[str, Any]] = {}
        self._news_event = asyncio.Event()
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._watch: ViewWatch | None = None
        self._lanes = RequestScheduler(self._settle)
        self._stops = RateLimit(STOPS_PER_S, MOST_STOPPING)

    async def run(self) -> None:
        """Serve the connection to its end."""
        self._fleet.listeners.add(self)
        self._start("news", self._push_news())
        self._connection.accept_stops(self._begin_stop, self._is_never_refused)
        try:
            async for frame in self._connection:
                await self._receive(frame)
        except ConnectionClosed:
            pass
        finally:
            self._fleet.listeners.discard(self)
            for task in self._tasks.values():
                task.cancel()
            await self._lanes.finish()

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Keep the newest notification of ``key`` until it can be sent; those of a stop are sent at once."""
        if method in AT_ONCE and self._connection.is_idle:
            self._news.pop((method, key), None)
            if self._connection.write_at_once(jsonrpc.call(method, params)):
                return
        self._news[method, key] = params
        self._news_event.set()

    def _begin_stop(self, frame: bytes) -> bool:
        """Begin an emergency stop as soon as its bytes arrive; it is answered and stored in its turn."""
        if _STOP in frame:
            with log_and_continue(log, "beginning an emergency stop"):
                if (stop := self._permitted_stop(frame)) is not None:
                    self._lanes.overtake(stop)
                    self._fleet.emergency.begin(stop, self._operator)
        return False

    def _permitted_stop(self, frame: bytes) -> EmergencyStop | None:
        """Return the stop in a message if this operator may make it; None for messages decoded in turn."""
        try:
            call = jsonrpc.decode(frame)
            if not (isinstance(call, jsonrpc.Call) and call.method == EmergencyStop.method):
                return None
            # A stop without an id gets one when decoded, and would get another one each time.
            if not isinstance(call.params, dict) or call.params.get("command") is None:
                return None
            request = decode_desk_request(call.method, call.params)
            self._check(request)
        except (MessageError, BridgeError, jsonrpc.FrameError):
            return None
        return request if isinstance(request, EmergencyStop) else None

    def _is_never_refused(self, call: jsonrpc.Call) -> bool:
        """Return whether a call beyond the rate limit is accepted: see :data:`STOPS_PER_S`."""
        kind = DESK_REQUESTS.get(call.method)
        op = call.params.get("op") if isinstance(call.params, dict) else None
        if kind is None or not commands.stops_robots(kind, op):
            return False
        if not self._gate.role(self._connection).includes(kind.least_role):
            return False
        return kind is EmergencyStop or self._stops.consume()

    async def _receive(self, frame: str | bytes) -> None:
        """Answer or schedule a request; never waits for the operator to read: a stop may come next."""
        call = None
        try:
            call = jsonrpc.decode(frame)
            if not isinstance(call, jsonrpc.Call):
                raise jsonrpc.FrameError(jsonrpc.INVALID_REQUEST, "a desk sends requests only", call.id)
            scheduled = ScheduledRequest(call, decode_desk_request(call.method, call.params), len(frame))
        except Exception as error:
            self._connection.send_without_wait(self._refused(call, error))
            return
        if isinstance(scheduled.request, OWN):
            self._connection.send_without_wait(await self._answer(scheduled, None))
        else:
            await self._lanes.submit(scheduled)

    async def _settle(self, scheduled: ScheduledRequest, refusal: Exception | None) -> None:
        """Do a request, unless it is refused, and send its outcome."""
        answer = await self._answer(scheduled, refusal)
        if refusal is not None:
            self._connection.send_without_wait(answer)
            return
        with contextlib.suppress(ConnectionClosed):
            await self._connection.send(answer)

    async def _answer(self, scheduled: ScheduledRequest, refusal: Exception | None) -> str:
        try:
            if refusal is not None:
                raise refusal
            check_deadline(scheduled)
            result = jsonrpc.result(scheduled.call.id, await self._do(scheduled.request))
        except Exception as error:
            return self._refused(scheduled.call, error)
        self._record(scheduled.call)
        return result

    def _refused(self, call: jsonrpc.Call | jsonrpc.Reply | None, error: Exception) -> str:
        """Return the error answer; called where ``error`` was caught."""
        if isinstance(error, jsonrpc.FrameError):
            return jsonrpc.error(error.id, error.code, str(error))
        code, text = jsonrpc.INTERNAL_ERROR, str(error)
        if isinstance(error, (MessageError, BridgeError)):
            self._fleet.repeated.warn(log, self._key_of(call), f"desk of {self._operator}: {error}")
            code = error_code(error)
        else:
            text = self._fleet.repeated.note_unforeseen(log, self._key_of(call), f"desk of {self._operator}")
        if isinstance(call, jsonrpc.Call):
            self._record(call, text, code)
        return jsonrpc.error(call.id if call else None, code, text, _data_of(error))

    def _key_of(self, call: jsonrpc.Call | jsonrpc.Reply | None) -> tuple[str, ...]:
        """Return the key under which log lines about such a request are counted."""
        method = call.method if isinstance(call, jsonrpc.Call) else ""
        return "desk of", self._operator, method if method in DESK_REQUESTS else "unknown methods"

    def _record(self, call: jsonrpc.Call, refusal: str | None = None, code: int | None = None) -> None:
        """Record in the audit log who requested which change, done or refused, and missing permissions."""
        harmless = call.method in UNNOTED or call.method.startswith("get_")
        if call.method not in DESK_REQUESTS or (harmless and code != jsonrpc.FORBIDDEN):
            return
        content = call.params if isinstance(call.params, dict) else {}
        names = (content.get(name) for name in SUBJECTS)
        params = msgspec.json.encode(content).decode()
        self._gate.journal.note(
            self._operator,
            call.method,
            done=refusal is None,
            role=self._gate.role(self._connection).value,
            address=self._connection.address,
            subject=next((str(name) for name in names if name is not None), None),
            # First, since long texts are cut at the end.
            detail="; ".join(str(text) for text in (refusal, content.get("override"), params) if text),
        )

    async def _do(self, request: DeskRequest[Any]) -> dict[str, Any]:
        self._fleet.counters.desk[request.method] += 1
        if isinstance(request, Hello):
            return self._hello(request)
        if isinstance(request, Subscribe):
            self._subscribe(request)
            return {}
        self._check(request)
        return await self._handlers.answer(request, self._operator)

    def _check(self, request: DeskRequest[Any]) -> None:
        role = self._gate.role(self._connection)
        override_role = Role(self._fleet.site.settings.commands.override_role)
        check_permission(request, self._operator, role, override_role)

    def _hello(self, request: Hello) -> dict[str, Any]:
        if request.protocol != PROTOCOL_VERSION:
            raise MessageError(
                f"hello: protocol {request.protocol} is not spoken here, {PROTOCOL_VERSION} is; "
                "install the plugin and the gateway in the same version"
            )
        if not request.operator.strip():
            raise MessageError("hello: operator is empty; give the operator's name, it goes into the log")
        self._operator = self._gate.name_desk(self._connection, request.operator.strip())
        if (suspensions := self._fleet.suspensions.report()).robots:
            self.notify("suspensions", "", to_json(suspensions))
        if (links := self._fleet.links.report()).links:
            self.notify("links", "", to_json(links))
        gateways = self._fleet.gateways_at(PATHS[TokenKind.OPERATOR])
        return {
            "protocol": PROTOCOL_VERSION,
            "site": to_json(self._fleet.site.report),
            "operator": self._operator,
            "role": self._gate.role(self._connection).value,
            "emergency": to_json(self._fleet.emergency.report()),
            "database": self._fleet.reception.database_id,
            "robots": self._fleet.robots.count(),
            "now": round(steady_time(), 3),
            **({} if gateways is None else to_json(gateways)),
        }

    def _subscribe(self, request: Subscribe) -> None:
        watch, view = self._watch, request.view
        if (
            watch is not None
            and view is not None
            and (watch.rate, watch.form) == (request.rate, request.form)
        ):
            watch.show(view)
            return
        self._watch = None
        if view is None:
            self._start("positions", self._push_positions(1 / request.rate, request.form))
            return
        self._watch = ViewWatch(self._fleet.views, view, request.rate, request.form)
        self._start("positions", self._push_view(self._watch))

    def _start(self, name: str, work: Any) -> None:
        if name in self._tasks:
            self._tasks[name].cancel()
        self._tasks[name] = asyncio.create_task(work)

    def _sending(self, what: str) -> AbstractContextManager[None]:
        """Return the context of a task that sends, whose unforeseen error ends the connection."""
        text = f"sending {what} to desk of {self._operator}"
        return end_on_error(log, text, self._connection, ConnectionClosed)

    async def _push_positions(self, interval: float, form: PositionForm) -> None:
        with self._sending("positions"):
            frame, seen = self._fleet.snapshots.after(EVERYTHING, form=form)
            tick = Tick.last(interval, time.monotonic())
            while True:
                if frame is not None:
                    await self._connection.send(frame, text=form is PositionForm.ROWS)
                now = time.monotonic()
                due = tick.following(now)
                await asyncio.sleep(due.wait(now))
                missed = due.number > tick.number + 1
                frame, seen = self._fleet.snapshots.after(EVERYTHING if missed else seen, due, form)
                tick = due

    async def _push_view(self, watch: ViewWatch) -> None:
        tick = Tick.last(1 / watch.rate, time.monotonic())
        with self._sending("positions in view"):
            while True:
                watch.changed.clear()
                frame = watch.next_frame()
                if frame is not None:
                    await self._connection.send(frame, text=watch.form is PositionForm.ROWS)
                now = time.monotonic()
                due = tick.following(now)
                try:
                    async with asyncio.timeout(due.wait(now)):
                        await watch.changed.wait()
                        await asyncio.sleep(VIEW_REST_S)
                except TimeoutError:
                    tick = due

    async def _push_news(self) -> None:
        with self._sending("news"):
            while True:
                await self._news_event.wait()
                self._news_event.clear()
                while self._news:
                    await self._connection.send_together(self._next_news())
                    # With a client that accepts all at once this would not yield: robots must have their
                    # turn.
                    await asyncio.sleep(0)

    def _next_news(self) -> list[str]:
        """Return the oldest waiting notifications, as many as are sent together."""
        frames: list[str] = []
        size = 0
        while self._news and size < NEWS_CHARACTERS:
            method, key = next(iter(self._news))
            params = self._news.pop((method, key))
            # A failed notification of one robot must not keep back those of others.
            with log_and_continue(log, "news of %s", method):
                frames.append(jsonrpc.call(method, params))
                size += len(frames[-1])
        return frames


def _data_of(error: Exception) -> dict[str, Any] | None:
    """Return the data of ``error`` that the desk needs besides its text."""
    if isinstance(error, OutdatedError):
        return error.newer
    if isinstance(error, LateError):
        return {"now": error.now}
    return {"found": error.found} if isinstance(error, OverridableError) else None


def check_deadline(scheduled: ScheduledRequest) -> None:
    """Raise LateError for a request past its deadline, MessageError for an invalid deadline.

    A frame can lie in a buffer for minutes, while a network or this process stood still, and a robot must not
    drive off on a request that its operator has given up. Requests that stop or hold robots are valid at any
    time; those on the connection itself bring the time.
    """
    deadline, request = scheduled.call.deadline, scheduled.request
    if deadline is None or scheduled.stops or request.stops or isinstance(request, OWN):
        return
    if isinstance(deadline, bool) or not isinstance(deadline, (int, float)) or not math.isfinite(deadline):
        raise MessageError(f"{request.method}: deadline is no finite number; give seconds, as now of hello")
    now = round(steady_time(), 3)
    if now > deadline:
        raise LateError(
            f"{request.method}: its turn came {now - deadline:.1f} s after its deadline, so that it was not "
            "done: a robot shall not drive off on an old request; look at the robots, and ask again if it is "
            "still wanted",
            now,
        )
