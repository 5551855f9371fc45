"""Active commands: life of each, effects of acknowledgements, index by robot; no I/O."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, KeysView, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from ...core.geometry import Polyline
from ...core.messages.base import to_json
from ...core.messages.commands import CommandReport, CommandState, CommandStep
from ...core.messages.robots import Abort, Command, OpAck, SendPos, SetPath, SetPosEnd
from ..model.arrival import Arrival, PathArrival, arrival_judge

# --- The life of a command as reported: queued → delivered → acknowledged → reached, or another end ---

_FORWARD = (CommandState.QUEUED, CommandState.DELIVERED, CommandState.ACKNOWLEDGED, CommandState.REACHED)


class CommandLifeError(Exception):
    """A step that the life of a command does not have."""


def may_become(now: CommandState, then: CommandState) -> bool:
    """Tell whether a command may step from ``now`` to ``then``.

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
    """Return ``command`` one step further; raises CommandLifeError for a step it may not take."""
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
    """Return ``command`` in the same state with one more line in its history."""
    return dataclasses.replace(command, steps=[*command.steps, CommandStep(command.state, at, by, reason)])


# --- A command with a step to come, and how the commands of one robot bear on each other; no I/O ---

GATEWAY = "gateway"
NOTHING = ""


@dataclass(frozen=True)
class CommandOrder:
    """A command to be issued: who asks which robot for what, under which id, and why.

    It is given up when the robot has not fetched it within ``expires_in`` seconds (None: by the site's
    settings). With ``aborts`` it is void unless that command is still the robot's task, with ``instead_of``
    unless that is and nobody has asked for its end; NOTHING stands for a robot that does nothing. ``task``
    is the task of the robot's queue that it is for; an order beside the queue pauses that. One that is
    ``fenced`` is refused where it leads into a keepout of the site.
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

    @property
    def is_emergency(self) -> bool:
        """Whether it is the Abort of an emergency stop."""
        return isinstance(self.message, Abort) and self.message.emergency


@dataclass
class ActiveCommand:
    """A command with a step to come; ``sa_id`` is its message's row in SA, written at ``written_at``.

    ``handed`` is where the robot was, as far as it is known, before it can have read that. It was
    ``out_of_sight`` where it may have driven since then without being seen. While its
    ``acknowledgement_waits`` to be dealt with again the command is not judged.
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
        """Tell whether it makes the robot drive."""
        return isinstance(self.message, (SetPosEnd, SetPath))

    @property
    def is_abort(self) -> bool:
        """Tell whether it ends what the robot does."""
        return isinstance(self.message, Abort)

    @property
    def is_emergency(self) -> bool:
        """Tell whether it is the Abort of an emergency stop."""
        return isinstance(self.message, Abort) and self.message.emergency

    @property
    def is_on_its_way(self) -> bool:
        """Tell whether the robot has not said yet that it took it on."""
        return self.report.state in (CommandState.QUEUED, CommandState.DELIVERED)

    @property
    def acknowledged_at(self) -> float:
        """When the robot took it on last; when it was issued, where it has not."""
        steps = self.report.steps
        taken = [step.at for step in steps if step.state is CommandState.ACKNOWLEDGED]
        return taken[-1] if taken else steps[0].at

    @property
    def driven(self) -> float | None:
        """Metres of its path that the robot has driven, None for what is no path."""
        return self.arrival.driven if isinstance(self.arrival, PathArrival) else None

    @property
    def line(self) -> Polyline | None:
        """Its path once the robot has taken that on, None before and for what is no path."""
        return self.arrival.line if isinstance(self.arrival, PathArrival) else None

    def expired(self, now: float, after: float) -> bool:
        """Tell whether nobody has fetched it in time; ``after`` seconds where it says nothing itself.

        The Abort of an emergency stop waits for its robot however long that is away.
        """
        issued = self.report.steps[0].at
        span = after if self.expires_at is None else self.expires_at - issued
        # One from so far in the future was issued before the clock was set back, nobody knows how long ago.
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
        """Return the command in the same state with a note, and not judged any more."""
        return dataclasses.replace(self, report=note(self.report, at, by, reason), arrival=None)

    def judged(self, tolerance: float) -> ActiveCommand:
        """Return the command as one that the robot has just taken on."""
        judged = arrival_judge(self.message, tolerance, under_way=self.out_of_sight, handed=self.handed)
        return dataclasses.replace(self, arrival=judged)

    def lose_sight(self) -> None:
        """Take it that the robot may have driven since its last pose without being seen."""
        self.out_of_sight = True
        if isinstance(self.arrival, PathArrival):
            self.arrival.lose_sight()


@dataclass(frozen=True)
class Recall:
    """A ``queued`` command whose message is to be taken back from SA, and how it ``ended`` then.

    A robot on SQL may have fetched it without the gateway having seen that yet: then it goes on, and may be
    done already.
    """

    queued: ActiveCommand
    ended: ActiveCommand

    @property
    def fetched(self) -> ActiveCommand:
        """The command where its message had been fetched before."""
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


def superseded(order: CommandOrder, mine: list[ActiveCommand], now: float) -> list[ActiveCommand]:
    """Return the ends of those commands of the robot, ``mine``, that ``order`` takes the place of."""
    reason = f"by command {order.command}"
    return [
        command.step(CommandState.SUPERSEDED, now, order.operator, reason)
        for command in mine
        if _replaces(order.message, command)
    ]


def recalled(order: CommandOrder, mine: list[ActiveCommand], now: float) -> list[Recall]:
    """Return the recalls of those tasks of the robot, ``mine``, that an Abort finds before it fetched them.

    What it has fetched may be done by the time that the Abort comes, so that ends when it acknowledges the
    Abort.
    """
    if not isinstance(order.message, Abort):
        return []
    # Not "before the robot read it": a robot may have done that without having deleted it yet.
    reason = because("before the robot acknowledged it", order.reason)
    queued = [c for c in mine if c.is_motion and c.report.state is CommandState.QUEUED]
    return [Recall(c, c.step(CommandState.ABORTED, now, order.operator, reason)) for c in queued]


def ended_by(abort: ActiveCommand, mine: list[ActiveCommand], now: float, why: str) -> list[ActiveCommand]:
    """Return the ends of those commands of the robot, ``mine``, that came before an Abort of an operator."""
    if not abort.is_abort:
        return []
    reason = because(why, abort.report.steps[0].reason)
    return [
        command.step(CommandState.ABORTED, now, abort.report.operator, reason)
        for command in mine
        if command.is_motion and command.sa_id < abort.sa_id
    ]


def given_up_by(command: ActiveCommand, mine: list[ActiveCommand]) -> ActiveCommand | None:
    """Return the Abort that the robot has acknowledged and that ``command`` came before, None without one.

    ``mine`` are the open commands of the robot. Such a command waits for where the robot is seen to be.
    """
    if not command.is_motion:
        return None
    later = [c for c in mine if c.is_abort and not c.is_on_its_way and c.sa_id > command.sa_id]
    return later[-1] if later else None


def because(what: str, reason: str | None) -> str:
    """Return what happened, with the operator's reason if one was given."""
    return what if not reason else f"{what}: {reason}"


def _replaces(message: Command, command: ActiveCommand) -> bool:
    """Tell whether a new ``message`` makes an older command void: each kind its own."""
    if isinstance(message, (SetPosEnd, SetPath)):
        return command.is_motion
    if command.is_emergency and not (isinstance(message, Abort) and message.emergency):
        return False
    return isinstance(command.message, type(message))


# --- What comes of a robot's commands when it answers to one, or starts again and may have forgotten; no I/O

ABORTED = "the robot acknowledged the Abort"


class RestartedCommands(NamedTuple):
    """The commands of a robot whose messages are written ``again``, and those that have ``ended`` instead."""

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
    """Return what an OpAck of ``command`` changes in those of the robot, ``mine``, in the order of the steps.

    ``tolerance`` is metres within which a target counts as reached; ``unseen`` whether the robot may have
    come further since it was seen last.
    """
    robot = command.report.robot
    if not ack.ok:
        return [command.step(CommandState.FAILED, now, robot, ack.reason)]
    if may_become(command.report.state, CommandState.ACKNOWLEDGED):
        steps = []
        if command.report.state is CommandState.QUEUED:
            # What a robot answers to has reached it, even if that was not seen yet.
            command = command.step(CommandState.DELIVERED, now, GATEWAY)
            steps.append(command)
        steps.append(command.step(CommandState.ACKNOWLEDGED, now, robot).judged(tolerance))
        # One that nobody saw lately may have come to the end of what it had taken on before the Abort
        # reached it: that ends with its next position.
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
    """Return what becomes of the commands of a robot that starts again.

    What was never fetched is written again too, behind the map; but for an Abort that nothing waits before,
    which needs none. What is older than ``expire_after`` seconds is not sent again. ``seen`` tells where a
    robot was seen last.
    """
    ended = [end for command in mine for end in ended_by(command, mine, now, "the robot started anew")]
    ended += [
        command.step(CommandState.EXPIRED, now, GATEWAY, "the robot started anew, and it was too old then")
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
    """Return a command to be sent once more; one that was never fetched keeps its place behind."""
    if command.report.state is CommandState.QUEUED:
        reason = "behind what the robot is told once more"
    noted, handed = command.noted(now, GATEWAY, reason), seen(command.report.robot)
    return dataclasses.replace(noted, written_at=now, handed=handed, out_of_sight=False)


# --- The open commands by their ids, by their robots and by their messages; no I/O ---


class ActiveCommands:
    """Holds them so that what a pose or an OpAck concerns is found without looking at all of them.

    ``queued`` are those whose message waits in SA, by its id.
    """

    def __init__(self) -> None:
        self.queued: dict[int, ActiveCommand] = {}
        self._by_id: dict[str, ActiveCommand] = {}
        self._by_robot: dict[str, dict[str, ActiveCommand]] = {}
        self._stored_driven: dict[str, float] = {}

    def __iter__(self) -> Iterator[ActiveCommand]:
        return iter(list(self._by_id.values()))

    def get(self, command: str) -> ActiveCommand | None:
        """Return a command by its id."""
        return self._by_id.get(command)

    @property
    def robots(self) -> KeysView[str]:
        """The robots that have open commands."""
        return self._by_robot.keys()

    def of(self, robot: str) -> list[ActiveCommand]:
        """Return the commands of a robot, the oldest first."""
        mine = self._by_robot.get(robot)
        return list(mine.values()) if mine else []

    def add(self, command: ActiveCommand) -> None:
        """Take in a command, in place of what was known of it."""
        report = command.report
        former = self._by_id.get(report.command)
        if former is not None:
            self.queued.pop(former.sa_id, None)
        self._by_id[report.command] = command
        self._by_robot.setdefault(report.robot, {})[report.command] = command
        if report.state is CommandState.QUEUED:
            self.queued[command.sa_id] = command
        if command.driven is None:
            self._stored_driven.pop(report.command, None)
        else:
            self._stored_driven[report.command] = command.driven

    def remove(self, command: str) -> None:
        """Forget a command that has ended."""
        former = self._by_id.pop(command, None)
        self._stored_driven.pop(command, None)
        if former is not None:
            self.queued.pop(former.sa_id, None)
            mine = self._by_robot[former.report.robot]
            del mine[command]
            if not mine:
                del self._by_robot[former.report.robot]

    def progress(self, least: float) -> dict[str, float]:
        """Return the metres driven of paths that have grown by ``least`` since they were noted."""
        return {
            id: driven
            for id, stored in self._stored_driven.items()
            if (driven := self._by_id[id].driven) is not None and driven - stored >= least
        }

    def note_progress(self, driven: Mapping[str, float]) -> None:
        """Take note of metres driven that are stored now."""
        self._stored_driven.update({id: metres for id, metres in driven.items() if id in self._stored_driven})
