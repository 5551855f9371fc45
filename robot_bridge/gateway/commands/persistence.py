"""Persistence of commands: transactions, locks by robot, order of processing."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import logging
from collections import deque
from collections.abc import AsyncIterator, Callable, Collection, Coroutine, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol, TypeVar

from sqlalchemy import Connection
from sqlalchemy.exc import IntegrityError, OperationalError, ProgrammingError

from ...core.errors import DataRefusedError, RefusedError, StoreError, UncertainError, UsedIdError
from ...core.logs import TroubleNews, log_and_continue
from ...core.messages.commands import CommandReport
from ...core.messages.robots import Abort, Answer, Command, SendPos, SetPosIni
from ...protocol.codec import decode_answer
from ..monitoring import BackgroundTasks
from ..storage.database import Database
from ..storage.repositories import closures, commands, queues
from ..storage.repositories import requests as answers
from ..storage.repositories.commands import StoredCommand
from ..storage.repositories.queues import QueueHold
from ..storage.repositories.robots import SOLE_FENCE, OwnerFence
from ..storage.rows import BatchedWork, do_together
from .active_command import ActiveCommand, CommandOrder, Recall, because, note

log = logging.getLogger(__name__)

# --- Writing commands and their messages in SA, in one transaction; called in the database's thread
# Nothing here changes anything but the database, so that a transaction can be repeated.


class CommandInsert(NamedTuple):
    """An order with its command, the ends and recalls of older ones, and the refusal of the order, if any.

    ``ends_waiting`` is true for a robot that waits for another.

    An order with a command that is stored already is neither done again nor refused.
    """

    order: CommandOrder
    command: ActiveCommand
    ended: list[ActiveCommand]
    recalls: list[Recall]
    refusal: RefusedError | None = None
    ends_waiting: bool = False


class WrittenCommands(NamedTuple):
    """Written commands: the ordered ones in their new states, in order, and older ones that changed.

    ``known`` are the ids of ordered ones that were stored before.
    """

    issued: list[ActiveCommand]
    changed: list[ActiveCommand]
    known: Collection[str] = ()


FORGOTTEN = ("Start", "OpAck", "SetMap")
"""Messages that are void when their robot restarts."""
Also = Callable[[Connection], None]
"""Further writes in the same transaction."""
_NOT_DELETED = ((1142,), (1644,))
"""MariaDB's codes for a missing right and for what a trigger refuses, which its driver does not class as
PostgreSQL's does."""
AlsoOf = Callable[[str], Also]
"""Makes the further writes from the id of the command that the robot then carries out."""


def insert_commands(
    connection: Connection, drafts: Sequence[CommandInsert], also: Also | None = None
) -> WrittenCommands:
    """Write new commands with their messages; raises RefusedError for the first that is refused."""
    known = commands.find_all(connection, [draft.order.command for draft in drafts])
    for draft in drafts:
        if (before := known.get(draft.order.command)) is not None:
            check_same(before.report, draft.order)
    new = [draft for draft in drafts if draft.order.command not in known]
    for draft in new:
        if draft.refusal is not None:
            raise draft.refusal
    changed = [command for draft in new for command in draft.ended]
    write_steps(connection, changed)
    changed += write_recalls(connection, [recall for draft in new for recall in draft.recalls])
    ids = answers.add_numbered(connection, [(d.order.robot, d.order.message) for d in new])
    written = {
        draft.order.command: dataclasses.replace(draft.command, sa_id=id)
        for draft, id in zip(new, ids, strict=True)
    }
    commands.add_all(connection, [_stored(command) for command in written.values()])
    queues.hold(connection, [hold for draft in new if (hold := _held(draft)) is not None])
    for draft in new:
        if draft.ends_waiting and not isinstance(draft.order.message, SetPosIni):
            closures.release(connection, draft.order.robot)
    if also is not None:
        also(connection)
    issued = [written.get(d.order.command) or opened(known[d.order.command], d.order.message) for d in drafts]
    return WrittenCommands(issued, changed, known)


def check_same(known: CommandReport, order: CommandOrder) -> None:
    """Raise UsedIdError unless ``order`` is the ``known`` command of the same id, asked for again."""
    if (known.robot, known.op) != (order.robot, type(order.message).__name__):
        raise UsedIdError(
            f"command {known.command!r} is a {known.op} of robot {known.robot!r} that was sent before; give "
            "each command an id of its own, say a UUID"
        )


class _WriteSteps(BatchedWork[None]):
    """Writes the newest step of commands; for ended ones it removes the message from SA."""

    def do_all(
        self, connection: Connection, asked: Sequence[tuple[Sequence[ActiveCommand]]]
    ) -> Sequence[None]:
        """Write the steps of all calls."""
        steps = [command for (some,) in asked for command in some]
        commands.save_all(connection, [_stored(command) for command in steps])
        answers.remove_answers(connection, [c.sa_id for c in steps if not c.report.state.is_open])
        return [None] * len(asked)


write_steps = _WriteSteps()


def write_recalls(connection: Connection, recalls: Sequence[Recall]) -> list[ActiveCommand]:
    """Withdraw messages that were not fetched, and write the new states of their commands; return those.

    A message also counts as fetched if its robot has acknowledged it without deleting it, whether the gateway
    has read that or not.
    """
    taken_back = answers.withdraw_unread(connection, [recall.queued.sa_id for recall in recalls])
    if taken_back:
        taken_back -= _acknowledged(connection, recalls)
    steps = [recall.ended if recall.queued.sa_id in taken_back else recall.fetched for recall in recalls]
    commands.save_all(connection, [_stored(command) for command in steps])
    return steps


def _acknowledged(connection: Connection, recalls: Sequence[Recall]) -> set[int]:
    """Return the messages of ``recalls`` with OpAcks in RR; to be read after deleting the messages."""
    by_robot = answers.acknowledged(connection, sorted({recall.queued.report.robot for recall in recalls}))
    return {r.queued.sa_id for r in recalls if r.queued.sa_id in by_robot[r.queued.report.robot]}


class _WriteAcknowledged(BatchedWork[None]):
    """Writes the changes by robots' OpAcks of messages in SA; removes these messages."""

    def do_all(
        self, connection: Connection, asked: Sequence[tuple[str, int | None, Sequence[ActiveCommand]]]
    ) -> Sequence[None]:
        """Write the changes by each OpAck: robot, message and steps."""
        answers.remove_own(connection, [(robot, sa_id) for robot, sa_id, _ in asked if sa_id is not None])
        return write_steps.do_all(connection, [(steps,) for _, _, steps in asked])


write_acknowledged = _WriteAcknowledged()


class _WriteLate(BatchedWork[CommandReport | None]):
    """Removes messages without an open command from SA.

    A robot may have read the message of a command that ended while it was on its way: then this is recorded
    in the command's log, once, and the result is its report.
    """

    def do_all(
        self, connection: Connection, asked: Sequence[tuple[str, int, float]]
    ) -> list[CommandReport | None]:
        """Remove the message of each call, by robot, id and time."""
        messages = [(robot, sa_id) for robot, sa_id, _ in asked]
        answers.remove_own(connection, messages)
        found = commands.find_messages(connection, messages)
        noted: list[StoredCommand] = []
        reports: list[CommandReport | None] = []
        for robot, sa_id, at in asked:
            stored = found.get((robot, sa_id))
            report = None if stored is None else _with_late_reading(stored.report, at)
            if stored is not None and report is not None:
                noted.append(stored._replace(report=report))
                found[robot, sa_id] = noted[-1]
            reports.append(report)
        commands.save_all(connection, noted)
        return reports


write_late = _WriteLate()


def _with_late_reading(report: CommandReport, at: float) -> CommandReport | None:
    if report.state.is_open or any(step.by == report.robot for step in report.steps):
        return None
    return note(report, at, report.robot, "the robot had read it by then, and acknowledged it")


def write_again(
    connection: Connection,
    robot: str,
    welcome: Sequence[Answer],
    again: Sequence[ActiveCommand],
    ended: Sequence[ActiveCommand],
    note_run: Callable[[Connection], bool],
) -> list[ActiveCommand]:
    """Write ``welcome`` for a robot that restarted, then the messages of its commands; return those.

    This is done once for each run of a robot: ``note_run`` records it, and returns false where it is already
    recorded, by a transaction with an unknown outcome. The messages keep their order. Other messages that
    set a robot in motion are removed: they answer questions that the robot has forgotten.
    """
    if not note_run(connection):
        return []
    write_steps(connection, ended)
    again = sorted(again, key=lambda command: command.sa_id)
    answers.remove_answers(connection, [command.sa_id for command in again])
    answers.remove_kinds(connection, [robot], [*FORGOTTEN, *answers.ORDERS])
    answers.add_answers(connection, [(robot, message) for message in welcome])
    ids = answers.add_numbered(connection, [(c.report.robot, c.message) for c in again])
    renewed = [dataclasses.replace(command, sa_id=id) for command, id in zip(again, ids, strict=True)]
    commands.save_all(connection, [_stored(command) for command in renewed])
    return [*ended, *renewed]


def write_driven(connection: Connection, driven: Mapping[str, float]) -> None:
    """Write the metres of their paths that robots have driven, by command."""
    commands.save_driven(connection, driven)


def write_bare_aborts(
    connection: Connection, robots: Sequence[str], withdrawn: Sequence[str], *, emergency: bool
) -> None:
    """Write Aborts that belong to no command, in place of operations ``withdrawn``: SA alone is needed.

    The Abort of an emergency is read before operations that cannot be withdrawn, so that another one is
    written behind them.
    """
    aborts = [Abort(emergency=emergency)]
    if not _withdraw_unlocked(connection, robots, withdrawn) and emergency:
        aborts.append(Abort())
    answers.add_answers(connection, [(robot, abort) for robot in robots for abort in aborts])


def _withdraw_unlocked(connection: Connection, robots: Sequence[str], kinds: Sequence[str]) -> bool:
    """Remove messages of ``kinds`` for ``robots``; return false where a right or a trigger forbids it."""
    # A gateway's account of an older set-up may lock no rows. Without a lock it waits for those who do.
    for remove in (answers.remove_unlocked, answers.remove_kinds):
        try:
            with connection.begin_nested():
                remove(connection, robots, kinds)
            return True
        except (ProgrammingError, IntegrityError, OperationalError) as error:
            code = getattr(error.orig, "args", ())[:1]
            if isinstance(error, OperationalError) and code not in _NOT_DELETED:
                raise
            log.warning(
                "what an Abort makes void stays in sa: a trigger or rule there has to let it go, or an "
                "administrator has to run: robot-bridge database upgrade (%s)",
                error.orig,
            )
    return False


def opened(stored: StoredCommand, message: Command | None = None) -> ActiveCommand:
    """Return a stored command as an open one, not judged yet."""
    report = stored.report
    if message is None:
        decoded = decode_answer(report.op, report.params)
        assert isinstance(decoded, Command)
        message = decoded
    return ActiveCommand(report, stored.sa_id, message, expires_at=stored.expires_at)


def _held(draft: CommandInsert) -> QueueHold | None:
    """Return the pause of the robot's queue, which must not interfere with an order outside it."""
    order, message = draft.order, draft.order.message
    if order.task is not None or isinstance(message, SetPosIni):
        return None
    reason = f"{order.operator} ordered {type(message).__name__} beside the queue"
    if isinstance(message, Abort):
        what = "emergency stop by" if message.emergency else "aborted by"
        reason = because(f"{what} {order.operator}", order.reason)
    return QueueHold(order.robot, reason, order.operator, draft.command.report.steps[0].at)


def _stored(command: ActiveCommand) -> StoredCommand:
    return StoredCommand(command.report, command.sa_id, command.driven, command.expires_at)


# --- Locks on robots during transactions; after one with an unknown outcome the database is read first

T = TypeVar("T")


class NamedLocks:
    """A lock for each robot, by name."""

    def __init__(self) -> None:
        self._locks: dict[str, asyncio.Lock] = {}

    @contextlib.asynccontextmanager
    async def of(self, names: Iterable[str]) -> AsyncIterator[None]:
        """Hold the locks of some robots, always in the same order."""
        async with contextlib.AsyncExitStack() as stack:
            for name in sorted(set(names)):
                await stack.enter_async_context(self._locks.setdefault(name, asyncio.Lock()))
            yield


class StoredCommands(Protocol):
    """In-memory state of the stored commands."""

    async def read_again(self) -> None:
        """Read the stored state; raises StoreError where this fails, and is called again then."""


class RobotLocks:
    """Locks by robot, so that work on a robot waits only for work on the same one.

    After a transaction with an unknown outcome, ``known`` is updated to the stored state before anything
    else is done with any robot.
    """

    def __init__(self, database: Database, known: StoredCommands, fence: OwnerFence = SOLE_FENCE) -> None:
        self._database = database
        self._known = known
        self._fence = fence
        self._fenced = _FencedWork(fence)
        self._locks = NamedLocks()
        self._doubts = self._settled = 0

    @property
    def has_uncertain_commit(self) -> bool:
        """Whether a transaction with an unknown outcome is not resolved yet."""
        return self._doubts > self._settled

    @contextlib.asynccontextmanager
    async def of(self, names: Iterable[str]) -> AsyncIterator[None]:
        """Hold some robots, always in the same order; with none it only resolves uncertain commits."""
        async with self._locks.of(names):
            if self.has_uncertain_commit:
                before = self._doubts
                await self._known.read_again()
                # Commits that became uncertain meanwhile may not have been read.
                self._settled = max(self._settled, before)
            yield

    async def run(self, names: Iterable[str], work: Callable[..., T], *arguments: Any) -> T:
        """Run ``work`` on the robots ``names`` in a transaction.

        :raises FencedError: when this gateway does not have all of them: nothing is done then.
        :raises StoreError: when the database cannot be used; UncertainError when it may have been done.
        """
        try:
            if self._fence is SOLE_FENCE:
                return await self._database.run(work, *arguments)
            return await self._database.run(self._fenced, list(names), work, arguments)
        except UncertainError:
            self._doubts += 1
            raise

    async def confirm(self, names: Sequence[str]) -> None:
        """Raise FencedError unless this gateway has the robots ``names``; StoreError where unknown."""
        if self._fence is not SOLE_FENCE:
            await self._database.read(self._fence.check, names)


class _FencedWork(BatchedWork[Any]):
    """Work on robots of this gateway, all of them checked by one statement."""

    def __init__(self, fence: OwnerFence) -> None:
        self._fence = fence

    def do_all(
        self, connection: Connection, asked: Sequence[tuple[Sequence[str], Callable[..., Any], Any]]
    ) -> list[Any]:
        """Do the work of all calls ``(robots, work, arguments)``; raises FencedError for all."""
        self._fence.check(connection, sorted({robot for robots, _, _ in asked for robot in robots}))
        results = dict(do_together(connection, [(work, arguments) for _, work, arguments in asked]))
        return [results[number] for number in range(len(asked))]


# --- Messages of a robot on its commands, in order: acknowledgements stored, positions judged after them

MOST_WAITING = 500
"""messages of one robot that may wait; beyond that the oldest positions are dropped."""


class ArrivalEvaluator(Protocol):
    """Judges the commands of robots by their positions."""

    def evaluate_arrival(self, robot: str, pose: SendPos) -> Coroutine[Any, Any, None] | None:
        """Return the coroutine that stores the commands that are done, None without any."""

    def lose_sight(self, robot: str) -> None:
        """Record that a robot may have driven without being seen."""


class _Work(NamedTuple):
    """A piece of storing, and the future of its caller."""

    work: Coroutine[Any, Any, Any]
    future: asyncio.Future[Any]


class RobotSequences:
    """Processes the messages of each robot in order, although the database may take seconds for some.

    Only positions wait here without a caller: they are shown and recorded before they are judged, so that
    operators do not wait for the database.
    """

    def __init__(self, evaluator: ArrivalEvaluator) -> None:
        self._evaluator = evaluator
        self._waiting: dict[str, deque[_Work | SendPos]] = {}
        self._tasks = BackgroundTasks()
        self._news = TroubleNews()

    def add_position(self, robot: str, pose: SendPos) -> bool:
        """Queue a position to be judged after the work in progress; return false if there is none."""
        waiting = self._waiting.get(robot)
        if waiting is None:
            return False
        if len(waiting) >= MOST_WAITING:
            oldest = next((entry for entry in waiting if isinstance(entry, SendPos)), None)
            if oldest is not None:
                waiting.remove(oldest)
            self._evaluator.lose_sight(robot)
        waiting.append(pose)
        return True

    def add(self, robot: str, work: Coroutine[Any, Any, T]) -> asyncio.Future[T]:
        """Begin ``work`` now, or after the work in progress; it continues when its caller is cancelled."""
        future: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        entry = _Work(work, future)
        if (waiting := self._waiting.get(robot)) is not None:
            waiting.append(entry)
            return future
        self._waiting[robot] = deque([entry])
        self._tasks.start(self._run(robot))
        return future

    async def _run(self, robot: str) -> None:
        waiting = self._waiting[robot]
        try:
            while waiting:
                entry = waiting.popleft()
                if isinstance(entry, SendPos):
                    await self._judge_position(robot, entry)
                else:
                    await _do(entry)
        finally:
            del self._waiting[robot]
            for entry in waiting:
                if isinstance(entry, _Work):
                    entry.work.close()
                    entry.future.cancel()

    async def _judge_position(self, robot: str, pose: SendPos) -> None:
        with log_and_continue(log, f"a position of robot {robot!r}"):
            try:
                if (work := self._evaluator.evaluate_arrival(robot, pose)) is not None:
                    await work
            except StoreError as error:
                # Its command is still open, and judged by the next position, which may come at once.
                if self._news.has(robot if isinstance(error, DataRefusedError) else "", str(error)):
                    log.warning("robot %r: %s", robot, error)


async def _do(entry: _Work) -> None:
    try:
        result = await entry.work
    except asyncio.CancelledError:
        entry.future.cancel()
        raise
    except BaseException as error:
        # On any exception: the caller would wait forever.
        if not entry.future.done():
            entry.future.set_exception(error)
    else:
        if not entry.future.done():
            entry.future.set_result(result)
