"""Active commands: states of each, effects of acknowledgements; Aborts not stored; no I/O."""

from __future__ import annotations

import contextlib
import dataclasses
import logging
import time
import uuid
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from ...core.errors import RefusedError, listed_names
from ...core.geometry import Polyline
from ...core.messages.base import to_json
from ...core.messages.commands import ABORT_VALID_S, CommandReport, CommandState, CommandStep
from ...core.messages.robots import MOTIONS, Abort, Command, OpAck, SendPos
from ..model.arrival import Arrival, PathArrival, arrival_judge

log = logging.getLogger(__name__)

# --- States of a command as reported: queued → delivered → acknowledged → reached, or another end ---

_FORWARD = (CommandState.QUEUED, CommandState.DELIVERED, CommandState.ACKNOWLEDGED, CommandState.REACHED)


class CommandLifeError(Exception):
    """A step that is not allowed in the state of a command."""


def may_become(now: CommandState, then: CommandState) -> bool:
    """Return whether a command may step from ``now`` to ``then``.

    Steps may be skipped forward (an acknowledgement proves the delivery) and never go back.
    """
    if not now.is_open:
        return False
    if then in _FORWARD:
        return _FORWARD.index(then) > _FORWARD.index(now)
    return True


def advance(
    command: CommandReport,
    state: CommandState,
    at: float,
    by: str,
    reason: str | None = None,
    deviation: float | None = None,
    stood: tuple[float, float, float] | None = None,
) -> CommandReport:
    """Return ``command`` one step further; raises CommandLifeError for a step that is not allowed."""
    if not may_become(command.state, state):
        raise CommandLifeError(
            f"command {command.command} is {command.state.value} and cannot become {state.value}"
        )
    return dataclasses.replace(
        command,
        state=state,
        steps=[*command.steps, CommandStep(state, at, by, reason)],
        deviation=command.deviation if deviation is None else deviation,
        stood=command.stood if stood is None else stood,
    )


def note(command: CommandReport, at: float, by: str, reason: str) -> CommandReport:
    """Return ``command`` in the same state with one more step in its history."""
    return dataclasses.replace(command, steps=[*command.steps, CommandStep(command.state, at, by, reason)])


# --- Open commands, and the effects of the commands of one robot on each other; no I/O ---

GATEWAY = "gateway"
NOTHING = ""


@dataclass(frozen=True)
class CommandOrder:
    """A command to be issued: its id, robot, message, operator and reason.

    It expires when the robot has not fetched it within ``expires_in`` seconds (None: by the site's settings).
    With ``aborts`` it is void unless that command is still the robot's task, with ``instead_of`` unless that
    is and its end was not requested; NOTHING stands for an idle robot. ``task`` is the task of the robot's
    queue that it is for; an order outside the queue pauses the queue. One that is ``fenced`` is refused where
    it leads into a keepout of the site, one with ``asked`` where its robot was stopped after that time
    (:func:`.steady_time`). ``of_pause``: an Abort that a failed pause has left, void once another succeeds.
    """

    command: str
    robot: str
    message: Command
    operator: str
    reason: str | None = None
    expires_in: float | None = None
    aborts: str | None = None
    task: str | None = None
    instead_of: str | None = None
    fenced: bool = False
    asked: float | None = None
    of_pause: bool = False

    @property
    def is_emergency(self) -> bool:
        """Whether it is the Abort of an emergency stop."""
        return isinstance(self.message, Abort) and self.message.emergency

    @property
    def kept_as(self) -> tuple[str | None, bool]:
        """What it is kept as while it is not stored: a failed pause replaces no operator's Abort."""
        return self.aborts, self.of_pause

    @property
    def is_stop(self) -> bool:
        """Whether it is the Abort of whatever the robot does, not of one command or task."""
        return isinstance(self.message, Abort) and self.aborts is None and self.task is None


@dataclass
class ActiveCommand:
    """An open command; ``sa_id`` is the row of its message in SA, written at ``written_at``.

    ``handed`` is the robot's last known pose before it can have read the message. The robot is
    ``out_of_sight`` if it may have driven since then without being seen. While its ``acknowledgement_waits``
    to be processed again the command is not judged.
    """

    report: CommandReport
    sa_id: int
    message: Command
    arrival: Arrival | None = None
    expires_at: float | None = None
    written_at: float | None = None
    handed: SendPos | None = None
    out_of_sight: bool = False
    acknowledgement_waits: bool = False

    @property
    def is_motion(self) -> bool:
        """Return whether it makes the robot drive."""
        return isinstance(self.message, MOTIONS)

    @property
    def is_abort(self) -> bool:
        """Return whether it is an Abort, which ends the robot's task."""
        return isinstance(self.message, Abort)

    @property
    def is_emergency(self) -> bool:
        """Return whether it is the Abort of an emergency stop."""
        return isinstance(self.message, Abort) and self.message.emergency

    @property
    def is_on_its_way(self) -> bool:
        """Return whether the robot has not acknowledged it yet."""
        return self.report.state in (CommandState.QUEUED, CommandState.DELIVERED)

    @property
    def acknowledged_at(self) -> float:
        """Time of its last acknowledgement; time of its issue without one."""
        steps = self.report.steps
        times = [step.at for step in steps if step.state is CommandState.ACKNOWLEDGED]
        return times[-1] if times else steps[0].at

    @property
    def driven(self) -> float | None:
        """Metres of its path that the robot has driven, None for other commands."""
        return self.arrival.driven if isinstance(self.arrival, PathArrival) else None

    @property
    def line(self) -> Polyline | None:
        """Its path once the robot has acknowledged it, None before and for other commands."""
        return self.arrival.line if isinstance(self.arrival, PathArrival) else None

    def expired(self, now: float, after: float) -> bool:
        """Return whether it was not fetched in time: by ``expires_at``, else within ``after`` seconds.

        The Abort of an emergency stop never expires, however long its robot is away. Another one waits for a
        day: the robot may be on its way to a target that it was sent before.
        """
        issued = self.report.steps[0].at
        if self.expires_at is not None:
            span = self.expires_at - issued
        else:
            span = max(after, ABORT_VALID_S) if self.is_abort else after
        # One from as far in the future was issued before the clock was set back, at an unknown time.
        return not self.is_emergency and abs(now - issued) >= span

    def step(
        self,
        state: CommandState,
        at: float,
        by: str,
        reason: str | None = None,
        deviation: float | None = None,
        stood: tuple[float, float, float] | None = None,
    ) -> ActiveCommand:
        """Return the command one step further."""
        return dataclasses.replace(self, report=advance(self.report, state, at, by, reason, deviation, stood))

    def noted(self, at: float, by: str, reason: str) -> ActiveCommand:
        """Return the command in the same state with a note, and without an arrival judge."""
        return dataclasses.replace(self, report=note(self.report, at, by, reason), arrival=None)

    def judged(self, tolerance: float) -> ActiveCommand:
        """Return the command with its arrival judge, as just acknowledged by the robot."""
        judged = arrival_judge(self.message, tolerance, under_way=self.out_of_sight, handed=self.handed)
        return dataclasses.replace(self, arrival=judged)

    def lose_sight(self) -> None:
        """Allow for the robot having driven since its last pose without being seen."""
        self.out_of_sight = True
        if isinstance(self.arrival, PathArrival):
            self.arrival.lose_sight()


@dataclass(frozen=True)
class Recall:
    """A ``queued`` command with a message to be withdrawn from SA, and the command as ``ended`` by that.

    A robot on SQL may have fetched it without the gateway having seen that yet: then the command continues,
    and may be done already.
    """

    queued: ActiveCommand
    ended: ActiveCommand

    @property
    def fetched(self) -> ActiveCommand:
        """The command if its message had already been fetched."""
        return self.queued.step(CommandState.DELIVERED, self.ended.report.steps[-1].at, GATEWAY)


def create_command(order: CommandOrder, now: float) -> ActiveCommand:
    """Return the command of ``order`` before it is stored, with no row in SA."""
    report = CommandReport(
        command=order.command,
        robot=order.robot,
        op=type(order.message).__name__,
        params=to_json(order.message),
        operator=order.operator,
        state=CommandState.QUEUED,
        steps=[CommandStep(CommandState.QUEUED, now, order.operator, order.reason)],
    )
    expires_at = None if order.expires_in is None else now + order.expires_in
    return ActiveCommand(report, 0, order.message, expires_at=expires_at, written_at=now)


def aborts_renamed(orders: Sequence[CommandOrder]) -> list[CommandOrder]:
    """Return Aborts under new ids, since theirs were used before; none if not all ``orders`` are Aborts."""
    if not (orders and all(isinstance(order.message, Abort) for order in orders)):
        return []
    robots = listed_names([order.robot for order in orders])
    log.warning("%s: the Abort is sent under another id, since its own was used before", robots)
    return [dataclasses.replace(order, command=str(uuid.uuid4())) for order in orders]


def superseded(order: CommandOrder, mine: list[ActiveCommand], now: float) -> list[ActiveCommand]:
    """Return the ends of those commands of the robot, ``mine``, that ``order`` replaces."""
    reason = f"by command {order.command}"
    return [
        command.step(CommandState.SUPERSEDED, now, order.operator, reason)
        for command in mine
        if _replaces(order.message, command)
    ]


def recalled(order: CommandOrder, mine: list[ActiveCommand], now: float) -> list[Recall]:
    """Return the recalls, by an Abort, of those motions of the robot, ``mine``, that it has not fetched.

    Fetched ones may be done by the time that the Abort arrives, so they end when the robot acknowledges the
    Abort.
    """
    if not isinstance(order.message, Abort):
        return []
    # Not "before the robot read it": a robot may have done that without having deleted it yet.
    reason = because("before the robot acknowledged it", order.reason)
    queued = [c for c in mine if c.is_motion and c.report.state is CommandState.QUEUED]
    return [Recall(c, c.step(CommandState.ABORTED, now, order.operator, reason)) for c in queued]


def ended_by(abort: ActiveCommand, mine: list[ActiveCommand], now: float, why: str) -> list[ActiveCommand]:
    """Return the ends of those motions of the robot, ``mine``, that were issued before an Abort."""
    if not abort.is_abort:
        return []
    reason = because(why, abort.report.steps[0].reason)
    return [
        command.step(CommandState.ABORTED, now, abort.report.operator, reason)
        for command in mine
        if command.is_motion and command.sa_id < abort.sa_id
    ]


def given_up_by(command: ActiveCommand, mine: list[ActiveCommand]) -> ActiveCommand | None:
    """Return the Abort after ``command`` that the robot has acknowledged, None without one.

    ``mine`` are the open commands of the robot. Such a command waits for the robot's next position.
    """
    if not command.is_motion:
        return None
    later = [c for c in mine if c.is_abort and not c.is_on_its_way and c.sa_id > command.sa_id]
    return later[-1] if later else None


def because(what: str, reason: str | None) -> str:
    """Return ``what`` happened, with the operator's reason if one was given."""
    return what if not reason else f"{what}: {reason}"


def _replaces(message: Command, command: ActiveCommand) -> bool:
    """Return whether a new ``message`` makes an older ``command`` of the same kind void."""
    if isinstance(message, MOTIONS):
        return command.is_motion
    if command.is_emergency and not (isinstance(message, Abort) and message.emergency):
        return False
    return isinstance(command.message, type(message))


# --- Effects on a robot's commands of its acknowledgements, and of its restart; no I/O

ABORTED = "the robot acknowledged the Abort"


class RestartedCommands(NamedTuple):
    """The commands of a robot with messages to be written ``again``, and those that ``ended`` instead."""

    again: list[ActiveCommand]
    ended: list[ActiveCommand]


def acknowledge_command(
    command: ActiveCommand,
    ack: OpAck,
    mine: list[ActiveCommand],
    now: float,
    tolerance: float,
    *,
    unseen: bool,
) -> list[ActiveCommand]:
    """Return the changes by an OpAck of ``command`` in the robot's commands, ``mine``, in order of the steps.

    ``tolerance`` is the metres within which a target counts as reached; ``unseen`` whether the robot may have
    moved since its last position.
    """
    robot = command.report.robot
    if not ack.ok:
        return [command.step(CommandState.FAILED, now, robot, ack.reason)]
    if may_become(command.report.state, CommandState.ACKNOWLEDGED):
        steps = []
        if command.report.state is CommandState.QUEUED:
            # A message that a robot answers has reached it, even if its delivery was not seen yet.
            command = command.step(CommandState.DELIVERED, now, GATEWAY)
            steps.append(command)
        steps.append(command.step(CommandState.ACKNOWLEDGED, now, robot).judged(tolerance))
        # A robot that was not seen lately may have completed its motion before the Abort reached it: that
        # command ends with its next position.
        ending = [one for one in mine if not (unseen and one.arrival)]
        return [*steps, *ended_by(command, ending, now, ABORTED)]
    if command.arrival is None:
        return [command.noted(now, robot, "acknowledged again").judged(tolerance)]
    return []


def restart_commands(
    mine: list[ActiveCommand],
    reason: str,
    now: float,
    expire_after: float,
    seen: Callable[[str], SendPos | None],
) -> RestartedCommands:
    """Return the changes of the commands of a robot that restarted.

    Commands never fetched are written again too, after the map; but not an Abort with nothing before it,
    which needs no map. Those older than ``expire_after`` seconds are not sent again. ``seen`` returns the
    last pose of a robot.
    """
    ended = [end for command in mine for end in ended_by(command, mine, now, "the robot started anew")]
    ended += [
        command.step(CommandState.EXPIRED, now, GATEWAY, "the robot restarted when the command had expired")
        for command in mine
        if command.is_on_its_way and command.expired(now, expire_after)
    ]
    # Of two ends of one command the first counts.
    ends = {command.report.command: command for command in reversed(ended)}
    moved = [c.sa_id for c in mine if c.report.state is not CommandState.QUEUED or not c.is_abort]
    first = min(moved, default=0)
    left = [c for c in mine if moved and c.report.command not in ends and c.sa_id >= first]
    return RestartedCommands(
        [_to_be_sent_again(command, reason, now, seen) for command in left], list(ends.values())
    )


def _to_be_sent_again(
    command: ActiveCommand, reason: str, now: float, seen: Callable[[str], SendPos | None]
) -> ActiveCommand:
    """Return a command to be sent again; one never fetched keeps its place after the others."""
    if command.report.state is CommandState.QUEUED:
        reason = "sent after what is sent to the robot again"
    noted, handed = command.noted(now, GATEWAY, reason), seen(command.report.robot)
    return dataclasses.replace(noted, written_at=now, handed=handed, out_of_sight=False)


# --- Aborts that could not be stored, kept until they are ---

SENT_ON_S = 60.0
"""seconds after an Abort that another gateway could not store from which a newer motion makes it void:
clocks of gateways differ."""
YOUNG_S = 600.0
"""seconds for which that holds. An older Abort would stop a robot for no visible reason: see LATER_S."""
LATER_S = 2.0
"""the same for an older Abort: twice the difference of clocks above which it is logged."""


class KeptAbort(NamedTuple):
    """An Abort that is not stored, kept since ``at`` (wall clock, s).

    ``is_left``: it comes from another gateway, or from one that ended. Its robot may have been sent on since.
    """

    order: CommandOrder
    at: float
    is_left: bool = False

    def check_not_sent_on(self, newest: CommandReport, now: float) -> None:
        """Raise RefusedError where ``newest``, the last motion of its robot, was asked after it."""
        if newest.steps[0].at > self.at + (SENT_ON_S if now - self.at < YOUNG_S else LATER_S):
            raise RefusedError(
                f"it was not stored, and the robot has been sent on since ({newest.op} of "
                f"{newest.operator}): look whether it does what it should, and abort it if not"
            )


class AbortNotes(Protocol):
    """Aborts noted where a gateway that is killed does not lose them."""

    def write(self, kept: Sequence[KeptAbort], settled: Sequence[str] = ()) -> Future[bool] | None:
        """Write what this gateway keeps, in the background; the result is whether that was done.

        The Aborts with the ids ``settled`` are stored, or void. What is in neither may be kept by another
        gateway.
        """

    def read(self) -> list[KeptAbort]:
        """Return the Aborts that an earlier gateway left for this one alone."""

    def left_for(self, robots: Iterable[str]) -> list[KeptAbort]:
        """Return the Aborts of ``robots`` that were left for the gateway that has them."""


class UnstoredAborts:
    """The newest unstored Abort of each robot, of each single command to be aborted, and of a failed pause.

    The Abort of an emergency stop is among them once the stop is over: before, the stop keeps it. They are
    written to ``notes``, if given.
    """

    def __init__(self, notes: AbortNotes | None = None) -> None:
        self._kept: dict[str, dict[tuple[str | None, bool], KeptAbort]] = {}
        self._orders: dict[str, CommandOrder] = {}
        """the orders of the kept ones, by id."""
        self._aside: set[str] = set()
        """ids of those that are noted, and not due."""
        self._notes = notes
        self._settled: list[str] = []
        self._is_noted = True
        self._writing: Future[bool] | None = None

    def restore(self, is_known: Callable[[str], bool]) -> None:
        """Keep the Aborts of known robots that an earlier gateway left, drop the others; reads a file."""
        for left in [] if self._notes is None else self._notes.read():
            log.warning("robot %r: Abort %s was not stored", left.order.robot, left.order.command)
            if is_known(left.order.robot):
                self._keep(left)
            else:
                # It would meet whoever comes by that name.
                self._settle(left.order.command)
        self.write_notes()

    def keep(self, orders: Iterable[CommandOrder]) -> Future[bool] | None:
        """Keep the Aborts among ``orders``; return the writing of the notes, if there are any."""
        for order in orders:
            if isinstance(order.message, Abort):
                self._keep(KeptAbort(order, time.time()))
        self.write_notes()
        return self._writing

    def keep_left(self, left: Iterable[KeptAbort]) -> None:
        """Keep Aborts that are noted already, unless a newer one is kept in their place."""
        for one in left:
            mine = self._kept.get(one.order.robot, {}).get(one.order.kept_as)
            if mine is not None and mine.order.command == one.order.command:
                continue
            if mine is None or mine.at < one.at:
                self._keep(one)
            else:
                self._settle(one.order.command)

    def keep_left_for(self, robots: Iterable[str]) -> None:
        """Keep the Aborts of ``robots`` that were left for the gateway that has them."""
        if self._notes is not None:
            self.keep_left(self._notes.left_for(robots))

    def write_notes(self) -> None:
        """Have the notes say what is kept, unless they do; what could not be written is written again."""
        writing = self._writing
        has_failed = writing is not None and writing.done() and not writing.result()
        if self._notes is not None and (has_failed or not self._is_noted):
            settled, self._settled = self._settled, []
            self._writing = self._notes.write(self._all(), settled)
        self._is_noted = True

    def of(self, robots: Iterable[str]) -> list[KeptAbort]:
        """Return the Aborts of ``robots`` that are due."""
        mine = [kept for robot in robots for kept in self._kept.get(robot, {}).values()]
        return [kept for kept in mine if kept.order.command not in self._aside]

    @contextlib.contextmanager
    def replacing_failed_pauses(self, robot: str) -> Iterator[None]:
        """Keep what failed pauses have left noted, not due, while another one is tried; forget it after that.

        It stays as it is where that fails.
        """
        left = [kept.order for kept in self._kept.get(robot, {}).values() if kept.order.of_pause]
        ids = {order.command for order in left}
        self._aside |= ids
        try:
            yield
            for order in left:
                self.discard(order)
        finally:
            self._aside -= ids

    def robots(self) -> list[str]:
        """Return the names of the robots with unstored Aborts."""
        return list(self._kept)

    def postpone(self, robot: str) -> None:
        """Move a robot to the end: others must not wait while its Aborts cannot be stored.

        Another gateway may have stored them by then, or have the robot.
        """
        if (mine := self._kept.pop(robot, None)) is not None:
            self._kept[robot] = mine

    def drop(self, robot: str) -> None:
        """Leave the Aborts of a robot to the gateway that has it; noted by the next :meth:`write_notes`."""
        for kept in self._kept.pop(robot, {}).values():
            self._orders.pop(kept.order.command, None)
            self._is_noted = False

    def end(self, robots: Collection[str]) -> None:
        """Forget the Aborts of robots that are removed; noted by the next :meth:`write_notes`."""
        self.keep_left_for(robots)
        for robot in robots:
            for kept in self._kept.pop(robot, {}).values():
                self._settle(kept.order.command)

    def discard(self, order: CommandOrder) -> None:
        """Forget an Abort, unless a newer one is kept in its place; noted by the next :meth:`write_notes`.

        If the gateway is killed before that, the next one finds its id stored, and nothing changes.
        """
        mine = self._kept.get(order.robot, {})
        kept = mine.get(order.kept_as)
        if kept is not None and kept.order is order:
            del mine[order.kept_as]
            self._settle(order.command)
        if not mine:
            self._kept.pop(order.robot, None)

    def discard_settled(self, ids: Iterable[str]) -> None:
        """Forget the Aborts with these ids: another gateway has stored them, or found them void."""
        for order in [order for id in ids if (order := self._orders.get(id)) is not None]:
            self.discard(order)

    def _all(self) -> list[KeptAbort]:
        return [kept for mine in self._kept.values() for kept in mine.values()]

    def _keep(self, kept: KeptAbort) -> None:
        order = kept.order
        mine = self._kept.setdefault(order.robot, {})
        before = mine.get(order.kept_as)
        if before is not None and before.order.command == order.command:
            kept = kept._replace(at=before.at)
        elif before is not None:
            self._settle(before.order.command)
        mine[order.kept_as] = kept
        self._orders[order.command] = order
        self._is_noted = False

    def _settle(self, id: str) -> None:
        self._orders.pop(id, None)
        if self._notes is not None:
            self._settled.append(id)
        self._is_noted = False
