"""Requests across gateways: a request about a robot is done by the gateway that owns the robot.

The request is committed into table ``relayed_requests`` before that gateway is woken, and done by the same
handlers as a local request: only one gateway writes a robot's data. An Abort that is not answered within a
second goes over the bus as well, to the robot's open connection, and is noted at all gateways.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import uuid
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol

import msgspec

from ...core.clock import steady_time
from ...core.errors import (
    STORED_LATER,
    BridgeError,
    BusyError,
    DataRefusedError,
    ForbiddenError,
    OutdatedError,
    OverridableError,
    RefusedError,
    StoreError,
    listed_names,
    unstored_abort,
    with_abort_sent,
)
from ...core.json_decoder import DecodingError, decode_json
from ...core.logs import log_and_continue, log_unforeseen
from ...core.messages.base import DeskRequest, MessageError, to_json
from ...core.messages.commands import (
    AbortAll,
    AbortTask,
    RefusedRobot,
    Send,
    SendMap,
    SetPositions,
    TargetPosition,
)
from ...core.messages.queues import (
    AddTasks,
    GetQueue,
    MakeCurrent,
    MoveTask,
    PauseQueue,
    PauseRobot,
    RemoveTask,
    ResumeQueue,
    SetQueue,
)
from ...core.messages.roads import ResolveConflict
from ...core.messages.robots import Abort
from ...protocol.codec import decode_desk_request
from ..model.events import Answering
from ..model.robots import Robots
from ..monitoring import BackgroundTasks, until_tick, wait_at_most
from ..storage.database import Database
from ..storage.repositories import commands, gateways
from ..storage.repositories.gateways import NewRequest, TakenRequest
from ..storage.repositories.robots import FencedError
from .bus import STOP
from .membership import Membership
from .messages import AbortCall, Exchange, NotedAbort, Wake

log = logging.getLogger(__name__)

RELAYED = (
    Send,
    SendMap,
    AbortTask,
    SetQueue,
    AddTasks,
    MoveTask,
    RemoveTask,
    MakeCurrent,
    PauseQueue,
    PauseRobot,
    ResumeQueue,
    GetQueue,
    ResolveConflict,
)
"""Requests that concern one robot, and are done by the gateway that owns it."""
LOOK_S = 1.0
"""seconds between checks for requests and answers that were not announced."""
ANSWER_WITHIN_S = 12.0
"""seconds that an operator waits: robots of a dead gateway are taken over within seven."""
TOO_OLD_S = 20.0
"""seconds after which no request that moves a robot is begun: nobody expects it any more."""
TAKEN_UP_WITHIN_S, TAKEN_UP_LOOK_S = 5.0, 0.05
"""seconds in which a robot that came to this gateway has to be loaded, and between checks whether it is."""
STORED_WITHIN_S = 1.0
"""seconds after which an unanswered Abort goes over the bus as well."""
STAYS = "it stays noted, and is stored and sent by whichever gateway has the robot or gets it"
MOST_REASONS = 3
"""reasons that an answer names where Aborts of several robots fail."""
MOST_AT_ONCE = 200
FORGET_S = 3600.0


class RelayedOverrideError(OverridableError):
    """Another gateway would do this only with an override."""

    def __init__(self, text: str, found: list[str]) -> None:
        RefusedError.__init__(self, text)
        self.found = found


_PLAIN: dict[str, type[Exception]] = {
    cls.__name__: cls
    for cls in (MessageError, ForbiddenError, BusyError, DataRefusedError, StoreError, RefusedError)
}

Outcome = dict[str, Any] | BridgeError | MessageError
"""The result of a request, or why there is none."""


class UnansweredError(RefusedError):
    """No gateway has answered; ``silent`` says which, without what became of the request."""

    def __init__(self, silent: str, became: str) -> None:
        super().__init__(f"{silent}; {became}")
        self.silent = silent


class AbortNoter(Protocol):
    """Notes Aborts for the gateway that has, or gets, their robots."""

    def note_aborts(self, aborts: Sequence[NotedAbort]) -> None:
        """Have Aborts stored, and sent before anything else of their robots."""

    def withdraw_pauses(self, robots: Iterable[str]) -> None:
        """Have what failed pauses of ``robots`` have left stored no more."""


class OwnCommands(Protocol):
    """The commands of this gateway."""

    def robot_of(self, command: str) -> str | None:
        """Return the robot of an open command."""

    def asking(self, request: DeskRequest[Any], at: float) -> contextlib.AbstractContextManager[float]:
        """Return the context in which ``request`` counts as asked ``at`` a time of the steady clock (s)."""

    def note_stop(self, robots: Iterable[str]) -> None:
        """Have no motion of ``robots`` stored that was asked by now."""


class RequestRelay:
    """Answers operators by ``handlers``, but relays requests about robots of other gateways."""

    def __init__(
        self,
        handlers: Answering,
        robots: Robots,
        membership: Membership,
        exchange: Exchange,
        database: Database,
        noter: AbortNoter,
        own: OwnCommands,
    ) -> None:
        self._handlers = handlers
        self._robots = robots
        self._membership = membership
        self._exchange = exchange
        self._database = database
        self._noter = noter
        self._own = own
        self._asked = asyncio.Event()
        self._answered: dict[int, asyncio.Event] = {}
        self._doing = BackgroundTasks()
        self._links: list[Callable[[str, str], bool]] = []
        exchange.subscribe(Wake, self._woken)
        exchange.subscribe(AbortCall, lambda call: self._abort_here(call.robot, call.call_id))

    def reach(self, link: Callable[[str, str], bool]) -> None:
        """Set ``link``, called with a robot and a call id when another gateway has it aborted directly."""
        self._links.append(link)

    # --- requests of operators of this gateway ---

    async def answer(self, request: DeskRequest[Any], operator: str) -> dict[str, Any]:
        """Return the result of ``request`` as JSON values; raises what its handler raises."""
        if isinstance(request, RELAYED):
            robot = await self._robot_of(request)
            if robot is not None:
                return await self._answer_of(robot, request, operator)
        elif isinstance(request, AbortAll):
            return await self._abort_all(request, operator)
        elif isinstance(request, SetPositions):
            return await self._set_positions(request, operator)
        return await self._handlers.answer(request, operator)

    async def _answer_of(self, robot: str, request: DeskRequest[Any], operator: str) -> dict[str, Any]:
        """Return the answer of the gateway that owns ``robot``."""
        asked = self._membership.database_time()
        if self._robots.gateway_of(robot) is None:
            try:
                return await self._handlers.answer(request, operator)
            except StoreError as error:
                if not (isinstance(error, FencedError) or isinstance(error.__cause__, FencedError)):
                    raise
                # Another gateway claimed it a moment ago.
        outcome = (await self._relay([(robot, request)], operator, asked))[robot]
        if not isinstance(outcome, dict):
            raise outcome
        return outcome

    async def _robot_of(self, request: DeskRequest[Any]) -> str | None:
        """Return the robot of a request, None where there is no such command; raises StoreError."""
        robot: str | None = getattr(request, "robot", None)
        if robot is not None or not isinstance(request, AbortTask) or request.aborts is None:
            return robot
        # No Abort waits for a database that is away where its robot is known without.
        robot = self._robots.doing(request.aborts) or self._own.robot_of(request.aborts)
        if robot is not None:
            return robot
        try:
            async with asyncio.timeout(STORED_WITHIN_S):
                # Where it has ended the owner says so.
                found = await self._database.read(commands.find, request.aborts)
        except (StoreError, TimeoutError) as error:
            reason = str(error) or f"the database has not answered within {STORED_WITHIN_S:g} s"
            raise StoreError(
                f"which robot has command {request.aborts} cannot be looked up: {reason}. "
                "This has aborted nothing: abort the robot by its name, or all robots"
            ) from error
        return None if found is None else found.robot

    async def _abort_all(self, request: AbortAll, operator: str) -> dict[str, Any]:
        """Abort this gateway's robots at once, and have the others abort theirs at the same time."""
        id = request.command or str(uuid.uuid4())
        aborts: list[tuple[str, DeskRequest[Any]]] = [
            (name, AbortTask(str(uuid.uuid5(uuid.NAMESPACE_OID, f"{id} {name}")), name, None, request.reason))
            for name in self._robots.commanded_elsewhere()
        ]
        here = self._robots.commanded()
        own = asyncio.ensure_future(self._handlers.answer(AbortAll(id, request.reason), operator))
        if not aborts:
            return await own
        outcomes, commands = await self._relay(aborts, operator), []
        try:
            commands += (await own)["commands"]
        except (BridgeError, MessageError) as error:
            outcomes |= dict.fromkeys(here, error)
        commands += [found for _, found in sorted(outcomes.items()) if isinstance(found, dict)]
        failed = {name: found for name, found in outcomes.items() if not isinstance(found, dict)}
        if failed:
            raise _partly_aborted([command["robot"] for command in commands], failed)
        return {"commands": commands}

    async def _set_positions(self, request: SetPositions, operator: str) -> dict[str, Any]:
        """Have each gateway send its robots their targets; raises the first error if none does."""
        parts: dict[str | None, list[TargetPosition]] = {}
        for position in request.positions:
            parts.setdefault(self._robots.gateway_of(position.robot), []).append(position)
        if len(parts) <= 1:
            return await self._answer_of(request.positions[0].robot if parts else "", request, operator)
        request.check_named_once()
        for position in request.positions:
            self._robots.check_known(position.robot)
        results = await asyncio.gather(
            *(self._answer_of(part[0].robot, SetPositions(part), operator) for part in parts.values()),
            return_exceptions=True,
        )
        return _joined(request, list(zip(parts.values(), results, strict=True)))

    async def _relay(
        self, requests: Sequence[tuple[str, DeskRequest[Any]]], operator: str, asked: float | None = None
    ) -> dict[str, Outcome]:
        """Return by robot what became of requests about robots of other gateways, one for each robot.

        They were ``asked`` at that time by the database's clock (s), else now.

        :raises StoreError, UnansweredError: when requests that stop no robot are not answered.
        """
        # An Abort makes a robot stand for a pause, too; but a pause that waited too long is refused.
        stops = [(robot, r) for robot, r in requests if _stops(r) or isinstance(r, PauseRobot)]
        answers: dict[str, str] = {}
        relaying = asyncio.ensure_future(self._ask(requests, operator, asked, answers))
        await asyncio.wait({relaying}, timeout=STORED_WITHIN_S if stops else None)
        sent: set[str] = set()
        if stops and (not relaying.done() or relaying.exception() is not None):
            # A robot that is answered about may be sent on by then.
            left = [(robot, request) for robot, request in stops if robot not in answers]
            self._noter.note_aborts([self._noted(robot, r, operator) for robot, r in left if _stops(r)])
            sent = {robot for robot, request in left if self._send_abort(robot, request)}
        outcomes: dict[str, Outcome] = {}
        try:
            await relaying
        except (StoreError, UnansweredError) as error:
            if not stops:
                raise
            left = [(robot, request) for robot, request in stops if robot not in answers]
            failure = self._noted_failure(error, left, sorted(sent - answers.keys()), operator)
            failure.__cause__ = error
            outcomes = {robot: failure for robot, _ in left}
        for robot, answer in answers.items():
            outcomes[robot] = _outcome_in(answer, [robot] if robot in sent else [])
        # Those that stand: what the last pause has left would end what they do next.
        self._noter.withdraw_pauses(robot for robot, _ in stops if isinstance(outcomes[robot], dict))
        return outcomes

    def _noted_failure(
        self,
        error: StoreError | UnansweredError,
        stops: Sequence[tuple[str, DeskRequest[Any]]],
        sent: Sequence[str],
        operator: str,
    ) -> StoreError | RefusedError:
        """Return what says that Aborts are noted, and to whom they went. A pause that fails becomes one."""
        paused = [self._noted(robot, r, operator) for robot, r in stops if isinstance(r, PauseRobot)]
        # Each takes the place of the one that the last pause has left.
        self._noter.withdraw_pauses(abort.robot for abort in paused)
        self._noter.note_aborts(paused)
        to = f"sent over the bus to the gateways of {listed_names(sent)}" if sent else "sent to no robot"
        if isinstance(error, UnansweredError):
            what = unstored_abort(to, is_pause=bool(paused), may_be_stored=True)
            return RefusedError(f"{error.silent}. {what}; {STAYS}: look whether they stand")
        what = unstored_abort(to, is_pause=bool(paused))
        return StoreError(f"{error}. {what}; {STORED_LATER}: look whether they stand")

    def _noted(self, robot: str, request: DeskRequest[Any], operator: str) -> NotedAbort:
        is_pause = isinstance(request, PauseRobot)
        reason: str | None = getattr(request, "abort_reason" if is_pause else "reason", None)
        return NotedAbort(
            getattr(request, "command", str(uuid.uuid4())),
            robot,
            operator,
            self._membership.database_time(),
            reason,
            getattr(request, "aborts", None),
            getattr(request, "expires_in", None),
            of_pause=is_pause,
        )

    def _send_abort(self, robot: str, request: DeskRequest[Any]) -> bool:
        call_id = f"abort-{getattr(request, 'command', uuid.uuid4())}"
        # It may still be connected here.
        self._abort_here(robot, call_id)
        return self._exchange.send(STOP, AbortCall(self._exchange.gateway, robot, call_id))

    async def _ask(
        self,
        requests: Sequence[tuple[str, DeskRequest[Any]]],
        operator: str,
        asked: float | None,
        answers: dict[str, str],
    ) -> None:
        """Add the answers of other gateways to ``answers`` by robot, as they come.

        :raises StoreError, UnansweredError: when not all have come.
        """
        rows = [NewRequest.of(robot, request) for robot, request in requests]
        ids = await self._database.run(gateways.add_requests, rows, operator, self._membership.name, asked)
        for gateway in {self._robots.gateway_of(robot) for robot, _ in requests} - {None}:
            self._exchange.wake("requests", gateway)
        # The robots may have moved here meanwhile.
        self._asked.set()
        await self._collect(dict(zip(ids, [robot for robot, _ in requests], strict=True)), answers)

    async def _collect(self, robots: dict[int, str], answers: dict[str, str]) -> None:
        """Add the answers about ``robots``, which are by the ids of their requests."""
        event = asyncio.Event()
        self._answered.update(dict.fromkeys(robots, event))
        until = asyncio.get_running_loop().time() + ANSWER_WITHIN_S
        left = robots
        try:
            while left:
                event.clear()
                found = await self._database.run(gateways.collect_answers, list(left))
                answers.update((left[id], answer) for id, answer in found.items())
                left = {id: robot for id, robot in left.items() if id not in found}
                pause = min(LOOK_S, until - asyncio.get_running_loop().time())
                if left and pause <= 0:
                    raise await self._unanswered(left)
                if left:
                    await wait_at_most(event, pause)
        finally:
            for id in robots:
                self._answered.pop(id, None)

    async def _unanswered(self, left: dict[int, str]) -> UnansweredError:
        back = await self._database.run(gateways.withdraw_requests, list(left))
        names = listed_names(
            sorted({f"{self._robots.gateway_of(robot) or 'none'} ({robot})" for robot in left.values()})
        )
        what = (
            "was not done" if len(back) == len(left) else "may have been done: look at the robot's commands"
        )
        silent = f"gateway {names} has not answered within {ANSWER_WITHIN_S:g} s"
        return UnansweredError(silent, f"what was asked {what}")

    # --- what other gateways ask of robots of this one ---

    async def run(self) -> None:
        """Process requests of others until cancelled; raises StoreError."""
        while True:
            self._asked.clear()
            await self.begin_waiting()
            await wait_at_most(self._asked, until_tick(LOOK_S))

    async def begin_waiting(self) -> None:
        """Begin the waiting requests about robots of this gateway; raises StoreError."""
        if not await self._database.read(gateways.is_asked, self._membership.me):
            return
        # Before the database says how old they are: none was asked earlier than it seems.
        now = steady_time()
        begun = await self._database.run(gateways.begin_requests, self._membership.me, MOST_AT_ONCE)
        for request in begun:
            self._doing.start(self._do(request, now - request.age))
        if len(begun) == MOST_AT_ONCE:
            # More may wait, such as Aborts of a whole fleet, for which this gateway is not woken again.
            self._asked.set()

    async def forget(self) -> None:
        """Delete what was not collected for an hour; raises StoreError."""
        await self._database.run(gateways.forget_requests, FORGET_S)

    async def _do(self, request: TakenRequest, asked: float) -> None:
        answer = await self._answer_to(request, asked)
        with log_and_continue(log, f"answering gateway {request.asked_by}"):
            if await self._store_answer(request, msgspec.json.encode(answer).decode()):
                self._exchange.wake("answers", request.asked_by)
                # This gateway asked itself: the robot moved here meanwhile.
                self._announce_answers()

    async def _store_answer(self, request: TakenRequest, answer: str) -> bool:
        """Store an answer, retrying while the database is away and the answer is awaited."""
        until = asyncio.get_running_loop().time() + ANSWER_WITHIN_S
        while True:
            try:
                await self._database.run(gateways.answer_request, request.id, answer)
                return True
            except StoreError as error:
                if asyncio.get_running_loop().time() > until:
                    log.error(
                        "gateway %s is not told what became of %s: %s",
                        request.asked_by,
                        request.method,
                        error,
                    )
                    return False
            await asyncio.sleep(until_tick(LOOK_S))

    async def _answer_to(self, taken: TakenRequest, asked: float) -> dict[str, Any]:
        try:
            request = decode_desk_request(taken.method, decode_json(taken.params))
            if not isinstance(request, (*RELAYED, SetPositions)):
                raise MessageError(f"{taken.method} is nothing that one gateway does for another")
            _check_timely(taken, request)
            if not _stops(request) or getattr(request, "aborts", None) is not None:
                await self._await_taken_up(taken.robot)
            with self._own.asking(request, asked):
                return {"result": await self._handlers.answer(request, taken.operator)}
        except Exception as error:
            if type(error).__name__ not in _PLAIN and not isinstance(
                error, (OutdatedError, RefusedError, StoreError)
            ):
                log_unforeseen(log, f"gateway {taken.asked_by}, {taken.method}")
            return {"error": _error_out(error)}

    async def _await_taken_up(self, robot: str) -> None:
        """Wait until a robot that came to this gateway is loaded, with its commands and stops.

        :raises StoreError: when it is not, or went on to another gateway.
        """
        until = asyncio.get_running_loop().time() + TAKEN_UP_WITHIN_S
        while self._robots.gateway_of(robot) is not None:
            if asyncio.get_running_loop().time() > until:
                raise StoreError(f"robot {robot!r} goes from one gateway to another; ask again in a moment")
            await asyncio.sleep(TAKEN_UP_LOOK_S)

    # --- the bus ------------------------------------------------------------------------------------------

    def _woken(self, wake: Wake) -> None:
        if wake.what == "requests":
            self._asked.set()
        elif wake.what == "answers":
            self._announce_answers()

    def _announce_answers(self) -> None:
        for event in set(self._answered.values()):
            event.set()

    def _abort_here(self, robot: str, call_id: str) -> None:
        # Also of a robot elsewhere: it may come here while a motion of it is checked.
        self._own.note_stop([robot])
        for link in self._links:
            with log_and_continue(log, f"sending robot {robot!r} an Abort that is not stored"):
                link(robot, call_id)


def _joined(
    request: SetPositions, parts: Sequence[tuple[Sequence[TargetPosition], dict[str, Any] | BaseException]]
) -> dict[str, Any]:
    """Return the joint result of a request split among gateways; raises if none of them did its part."""
    place = {position.robot: number for number, position in enumerate(request.positions)}
    commands, refused, errors = [], [], []
    for positions, found in parts:
        if isinstance(found, dict):
            commands += found["commands"]
            continue
        if not isinstance(found, (BridgeError, MessageError)):
            raise found
        errors.append(found)
        refused += [RefusedRobot(position.robot, str(found)) for position in positions]
    if len(errors) == len(parts):
        raise errors[0]
    result: dict[str, Any] = {"commands": sorted(commands, key=lambda one: place[one["robot"]])}
    if refused:
        result["refused"] = [to_json(one) for one in sorted(refused, key=lambda one: place[one.robot])]
    return result


def _partly_aborted(
    done: Sequence[str], failed: dict[str, BridgeError | MessageError]
) -> BridgeError | MessageError:
    """Return what says of which robots Aborts are stored, and why not of those that ``failed``.

    An error, where SetPositions has ``refused`` in its result: an operator whose desk does not read that
    would take the Abort of some robots for one of all.
    """
    robots: dict[str, list[str]] = {}
    for robot, error in sorted(failed.items()):
        robots.setdefault(str(error), []).append(robot)
    if not done and len(robots) == 1:
        return next(iter(failed.values()))
    parts = [f"not for {listed_names(names)}: {text}" for text, names in robots.items()]
    if more := [name for names in list(robots.values())[MOST_REASONS:] for name in names]:
        parts[MOST_REASONS:] = [f"and not for {listed_names(more)}"]
    kind = StoreError if any(isinstance(error, StoreError) for error in failed.values()) else RefusedError
    return kind("; ".join([f"Aborts are stored for {listed_names(sorted(done))}", *parts]))


def _stops(request: DeskRequest[Any]) -> bool:
    return isinstance(request, AbortTask) or (isinstance(request, Send) and request.op == Abort.__name__)


def _check_timely(taken: TakenRequest, request: DeskRequest[Any]) -> None:
    """Raise RefusedError for an overdue request, or one that may have been done before."""
    if taken.age > TOO_OLD_S and not _stops(request):
        raise RefusedError(
            f"{taken.method}: asked {taken.age:.0f} s ago, too long ago to be done now; ask again"
        )
    if taken.begun_by is not None and not isinstance(request, (Send, AbortTask)):
        raise RefusedError(
            f"{taken.method}: the gateway that had the robot ended while it did this, or lost the robot; "
            "look whether it is done, then ask again"
        )


def _error_out(error: Exception) -> dict[str, Any]:
    kind = next(
        (cls.__name__ for cls in type(error).__mro__ if cls.__name__ in _PLAIN), RefusedError.__name__
    )
    out: dict[str, Any] = {"kind": kind, "text": str(error)}
    if isinstance(error, OutdatedError):
        out |= {"kind": OutdatedError.__name__, "newer": error.newer}
    elif isinstance(error, OverridableError):
        out |= {"kind": OverridableError.__name__, "found": error.found}
    return out


def _outcome_in(answer: str, sent: Sequence[str]) -> Outcome:
    """Return the result or the error in an answer about robots that were ``sent`` an Abort meanwhile."""
    try:
        return _result_in(answer)
    except (RefusedError, MessageError) as refusal:
        if not sent:
            return refusal
        refused = MessageError if isinstance(refusal, MessageError) else RefusedError
        return refused(with_abort_sent(refusal, sent))
    except BridgeError as error:
        return error


def _result_in(answer: str) -> dict[str, Any]:
    """Return the result in an answer; raises an error contained in it."""
    try:
        content = decode_json(answer)
    except DecodingError:
        content = None
    if isinstance(content, dict) and isinstance(content.get("result"), dict):
        result: dict[str, Any] = content["result"]
        return result
    error = content.get("error") if isinstance(content, dict) else None
    if not isinstance(error, dict):
        raise StoreError(f"an answer of another gateway cannot be read: {answer[:80]}")
    kind, said = error.get("kind"), str(error.get("text", ""))
    if kind == OutdatedError.__name__:
        raise OutdatedError(said, dict(error.get("newer") or {}))
    if kind == OverridableError.__name__:
        raise RelayedOverrideError(said, [str(one) for one in error.get("found") or []])
    raise _PLAIN.get(str(kind), RefusedError)(said)
