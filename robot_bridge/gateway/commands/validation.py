"""Index of the open commands; validation of new ones against them, rules and abilities."""

from __future__ import annotations

import contextlib
import dataclasses
import math
from collections import Counter
from collections.abc import Iterable, Iterator, KeysView, Mapping, Sequence
from typing import Any, Protocol, runtime_checkable

from ...core.clock import steady_time
from ...core.errors import RefusedError
from ...core.geometry import Polyline
from ...core.messages.base import DeskRequest
from ...core.messages.commands import CommandState
from ...core.messages.robots import MOTIONS, Abort, Command, SetPath, SetPosEnd
from ...core.messages.safety import Ability
from ..model.robots import Robots
from ..site.places import ServedSite, keepout_refusals
from ..storage.repositories.closures import HoldRow
from . import active_command
from .active_command import ActiveCommand, CommandOrder, create_command, recalled, superseded
from .persistence import CommandInsert

# --- Index of the open commands by id, robot and message; no I/O ---


class ActiveCommands:
    """Index of the open commands, to find those that a pose or an OpAck concerns without a search.

    ``queued`` are those with a message waiting in SA, by the id of the message.
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
        """Add a command, or replace its former state."""
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
        """Return the metres driven of paths, where they have grown by ``least`` since they were stored."""
        return {
            id: driven
            for id, stored in self._stored_driven.items()
            if (driven := self._by_id[id].driven) is not None and driven - stored >= least
        }

    def note_progress(self, driven: Mapping[str, float]) -> None:
        """Record the metres driven as stored."""
        self._stored_driven.update({id: metres for id, metres in driven.items() if id in self._stored_driven})


# --- Queries of the open commands; nothing here changes any ---


REPEATED_WITHIN_S = 60.0
"""seconds within which a repeated Abort counts as repeated by a desk, which does so for 30 s."""


class CommandReader:
    """Answers queries from the open commands."""

    def __init__(self, open_commands: ActiveCommands) -> None:
        self._open = open_commands

    def count(self) -> Counter[CommandState]:
        """Return the number of open commands in each state."""
        return Counter(command.report.state for command in self._open)

    def busy_with(self, robot: str) -> str | None:
        """Return the id of the command that makes the robot drive, if any."""
        moving = [c.report.command for c in self._open.of(robot) if c.is_motion]
        return moving[-1] if moving else None

    def task(self, robot: str) -> tuple[SetPosEnd | SetPath, float] | None:
        """Return the robot's motion, and the metres of it (of a path) that it has driven."""
        for command in reversed(self._open.of(robot)):
            if isinstance(command.message, MOTIONS):
                return command.message, command.driven or 0.0
        return None

    def line(self, robot: str) -> Polyline | None:
        """Return the path that the robot has acknowledged as a line, None where it has none."""
        moving = [c for c in self._open.of(robot) if c.is_motion]
        return moving[-1].line if moving else None

    def is_carrying_out(self, robot: str, command: str) -> bool:
        """Return whether the command is the robot's task, and its end was not requested."""
        mine = self._open.of(robot)
        task = self._open.get(command)
        aborted = any(c.is_abort and task is not None and c.sa_id > task.sa_id for c in mine)
        return command == self.busy_with(robot) and not aborted

    def is_being_aborted(self, robot: str, command: str) -> bool:
        """Return whether an Abort will end the command as soon as the robot acknowledges the Abort.

        Not that of an emergency stop, after which no robot continues before it is cleared.
        """
        task = self._open.get(command)
        aborts = [c for c in self._open.of(robot) if c.is_abort and task is not None and c.sa_id > task.sa_id]
        return bool(aborts) and not any(abort.is_emergency for abort in aborts)

    def carried_out(self, robot: str) -> ActiveCommand | None:
        """Return the command that makes the robot drive, None also where its end was requested."""
        id = self.busy_with(robot)
        return self._open.get(id) if id is not None and self.is_carrying_out(robot, id) else None

    def is_open(self, command: str) -> bool:
        """Return whether a command is open."""
        return self._open.get(command) is not None

    def robot_of(self, command: str) -> str | None:
        """Return the robot of an open command."""
        known = self._open.get(command)
        return None if known is None else known.report.robot

    def awaits_abort(self, robot: str) -> bool:
        """Return whether an Abort that is no emergency stop's is on its way to the robot."""
        return any(c.is_abort and not c.is_emergency and c.is_on_its_way for c in self._open.of(robot))

    def awaits_any_abort(self, robot: str) -> bool:
        """Return whether an Abort is on its way to the robot, an emergency stop's or another."""
        return self.awaits_abort(robot) or self.awaits_stop(robot)

    def awaits_abort_after(self, robot: str, sa_id: int) -> bool:
        """Return whether an Abort that is newer than message ``sa_id`` is on its way to the robot."""
        return any(c.is_abort and c.is_on_its_way and c.sa_id > sa_id for c in self._open.of(robot))

    def awaits_stop(self, robot: str) -> bool:
        """Return whether the Abort of an emergency stop is on its way to the robot."""
        return any(c.is_emergency and c.is_on_its_way for c in self._open.of(robot))

    def drives_since(self, robot: str, at: float, doubted_from: float = math.inf) -> bool:
        """Return whether the robot has an open motion from before ``at``, and no stop's Abort after it.

        A motion from after ``doubted_from`` may be from before ``at`` as well. The Abort of an earlier stop
        is still open if the robot was not seen to stand since.
        """
        mine = self._open.of(robot)
        aborted = max((c.sa_id for c in mine if c.is_emergency), default=-1)
        motions = [c.report.steps[0].at for c in mine if c.is_motion and c.sa_id > aborted]
        return any(began <= at or began > doubted_from for began in motions)

    def used_again(
        self, orders: Iterable[CommandOrder], stored: Iterable[ActiveCommand], now: float
    ) -> list[CommandOrder]:
        """Return those ``orders`` of Aborts that are another one than the ``stored`` one of the same id.

        A button sends the same id each time, and a desk without an answer repeats its request. It is the same
        one if it is still to be carried out, or was asked a moment ago, and nothing moved the robot since.
        """
        again = {command.report.command for command in stored if self._is_over(command, now)}
        return [order for order in orders if order.command in again]

    def _is_over(self, abort: ActiveCommand, now: float) -> bool:
        report = abort.report
        if not abort.is_abort or abort.is_emergency:
            return False
        if any(c.is_motion and c.sa_id > abort.sa_id for c in self._open.of(report.robot)):
            return True
        return not report.state.is_open and abs(now - report.steps[0].at) > REPEATED_WITHIN_S

    def undelivered(self) -> dict[int, str]:
        """Return the robot of every message waiting in SA, by the message's id."""
        return {sa_id: command.report.robot for sa_id, command in self._open.queued.items()}

    def robots(self) -> set[str]:
        """Return the robots that have an open command."""
        return {command.report.robot for command in self._open}


# --- Drafts of orders to be stored, or refused ---

_NEEDED: dict[str, Ability] = {"SetPosEnd": "targets", "SetPath": "paths", "SetPosIni": "start"}
"""Required ability of the robot for each message."""


class CommandRule(Protocol):
    """A rule against sending some messages to any robot."""

    def check(self, message: Command) -> None:
        """Raise RefusedError for a message that must not be sent now."""


@runtime_checkable
class SlowCommandRule(CommandRule, Protocol):
    """A rule with a slow preparation."""

    async def prepare(self, message: Command) -> None:
        """Prepare the data that :meth:`check` needs for a message."""


class CommandRules:
    """Checks whether a message may be sent now: by the added rules, and the site's keepouts."""

    def __init__(self, site: ServedSite, robots: Robots) -> None:
        self._site = site
        self._robots = robots
        self._rules: list[CommandRule] = []

    def add(self, rule: CommandRule) -> None:
        """Add a rule for all messages."""
        self._rules.append(rule)

    def check(self, message: Command) -> None:
        """Raise RefusedError for a message that must not be sent to any robot now."""
        for rule in self._rules:
            rule.check(message)

    async def prepare(self, message: Command) -> None:
        """Do the slow preparation for a message."""
        for rule in self._rules:
            if isinstance(rule, SlowCommandRule):
                await rule.prepare(message)

    async def check_keepouts(self, orders: Sequence[CommandOrder]) -> Sequence[RefusedError | None]:
        """Return for each order its refusal, None where it leads into no keepout."""
        straight_from = [self._robots.straight_from(order.robot, order.message) for order in orders]
        return await keepout_refusals(self._site, [order.message for order in orders], straight_from)


class WaitingRobots(dict[str, HoldRow]):
    """The robots that wait for another to pass, by name, as stored."""

    def waits_for(self, robot: str, task: str) -> str | None:
        """Return the robot that must pass before a task of the queue continues, None without one."""
        row = self.get(robot)
        return None if row is None or row.task != task else row.other


class StopTimes:
    """Times of Aborts and pauses, to find the motions that one overtakes while they are checked; no I/O.

    An order that was asked before a stop of its robot must not be stored behind that stop. Times are of
    :func:`.steady_time`.
    """

    def __init__(self) -> None:
        self._newest: dict[str, float] = {}
        self._asked: dict[str | int, float] = {}

    def add(self, robots: Iterable[str]) -> None:
        """Note that ``robots`` are stopped now."""
        self._newest.update(dict.fromkeys(robots, steady_time()))

    def forget(self, robot: str) -> None:
        """Forget the stops of a robot that is removed."""
        self._newest.pop(robot, None)

    @contextlib.contextmanager
    def asking(self, request: str | int, at: float | None = None) -> Iterator[float]:
        """Yield when ``request`` was asked: ``at``, else now; for a repetition meanwhile the first time."""
        is_first = request not in self._asked
        try:
            yield self._asked.setdefault(request, steady_time() if at is None else at)
        finally:
            if is_first:
                del self._asked[request]

    def check(self, order: CommandOrder) -> None:
        """Raise RefusedError for a motion whose robot was stopped after it was asked."""
        is_motion = isinstance(order.message, MOTIONS)
        if is_motion and order.asked is not None and order.asked <= self._newest.get(order.robot, -math.inf):
            raise RefusedError(
                f"robot {order.robot!r}: an Abort or a pause came while this was checked; ask again if it is "
                "still wanted"
            )


class CommandValidator(CommandReader):
    """Checks orders against the rules and the robots' commands, and finds the commands that they end."""

    def __init__(
        self, open_commands: ActiveCommands, robots: Robots, rules: CommandRules, waiting: WaitingRobots
    ) -> None:
        super().__init__(open_commands)
        self._robots = robots
        self._rules = rules
        self._waiting = waiting
        self.stops = StopTimes()

    def note_stop(self, robots: Iterable[str]) -> None:
        """Have no motion of ``robots`` stored that was asked by now."""
        self.stops.add(robots)

    def asking(
        self, request: DeskRequest[Any], at: float | None = None
    ) -> contextlib.AbstractContextManager[float]:
        """Return the context of an operator's request, with the time when it was asked: ``at``, else now.

        Within it the same request, or a repetition of it, counts as asked at that time (steady clock, s).
        """
        return self.stops.asking(getattr(request, "command", id(request)), at)

    async def prepare(self, orders: Sequence[CommandOrder]) -> list[RefusedError | None]:
        """Do the slow checks of orders; return for each its refusal, None where it may be sent."""
        for order in orders:
            await self._rules.prepare(order.message)
        refusals = iter(await self._rules.check_keepouts([order for order in orders if order.fenced]))
        return [next(refusals) if order.fenced else None for order in orders]

    def draft(self, order: CommandOrder, refusal: RefusedError | None, now: float) -> CommandInsert:
        """Return the draft of an order, refused by ``refusal`` or by the present state."""
        try:
            self._rules.check(order.message)
            self.stops.check(order)
            self._check_ability(order)
            self._check_task(order)
        except RefusedError as error:
            refusal = refusal or error
        mine = self._open.of(order.robot)
        command = dataclasses.replace(create_command(order, now), handed=self._robots.pose(order.robot))
        ended, recalls = superseded(order, mine, now), recalled(order, mine, now)
        # Any other message to a robot ends its waiting for another.
        return CommandInsert(order, command, ended, recalls, refusal, order.robot in self._waiting)

    async def consider_way(self, way: Command) -> None:
        """Do the slow preparation for a path to be sent to a robot."""
        await self._rules.prepare(way)

    def check_way(self, robot: str, task: str, way: Command) -> None:
        """Raise RefusedError where a robot must not be sent the ``way`` to its ``task``, or has another."""
        self._rules.check(way)
        if not self.is_carrying_out(robot, task):
            raise _ordered_otherwise(robot)

    def _check_task(self, order: CommandOrder) -> None:
        if order.instead_of is not None and not self._is_open_to(order.robot, order.instead_of):
            raise _ordered_otherwise(order.robot)
        if order.aborts is not None and order.aborts != self.busy_with(order.robot):
            raise RefusedError(
                f"command {order.aborts} is no longer what robot {order.robot!r} is doing; look at the log, "
                "and abort the robot if it is to stop all the same"
            )

    def _check_ability(self, order: CommandOrder) -> None:
        """Raise RefusedError for a message that the robot, as declared in Ready, cannot carry out."""
        name, message = order.robot, order.message
        if name not in self._robots or isinstance(message, Abort):
            return
        robot = self._robots.get(name)
        if self._robots.is_only_seen(name):
            raise RefusedError(f"robot {name!r} is only seen: its link {robot.link} takes no commands for it")
        needed = _NEEDED[type(message).__name__]
        if not robot.can(needed):
            raise RefusedError(
                f"robot {name!r} does not take {type(message).__name__}, only what it said in Ready: "
                f"{robot.abilities}"
            )
        if (getattr(message, "cone", None) or getattr(message, "collect", None)) and not robot.can("cones"):
            raise RefusedError(f"robot {name!r} places and collects no cones; send it there without one")

    def _is_open_to(self, robot: str, task: str) -> bool:
        if task == active_command.NOTHING:
            return not any(c.is_motion or c.is_abort for c in self._open.of(robot))
        return self.is_carrying_out(robot, task)


def _ordered_otherwise(robot: str) -> RefusedError:
    return RefusedError(f"robot {robot!r} has another command by now")
