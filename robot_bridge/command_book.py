"""The open commands of the fleet: issued, delivered, acknowledged, judged, ended; each step stored first."""

from __future__ import annotations

import asyncio
import dataclasses
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from sqlalchemy import Connection

from .arrival import Arrival, judge
from .command_life import advance, is_open, may_become, note
from .messages import (
    Abort,
    CommandReport,
    CommandState,
    CommandStep,
    OpAck,
    SendPos,
    SetPath,
    SetPosEnd,
    to_json,
)
from .store import answers, commands
from .store.database import Database
from .wire import decode_answer

GATEWAY = "gateway"

Command = SetPosEnd | SetPath | Abort


@dataclass(frozen=True)
class Order:
    """A command to be issued: who asks which robot for what, under which id."""

    command: str
    robot: str
    message: Command
    operator: str


@dataclass
class OpenCommand:
    """A command with a step to come; ``sa_id`` is its message's row in SA."""

    report: CommandReport
    sa_id: int
    message: Command
    arrival: Arrival | None = None

    @property
    def is_motion(self) -> bool:
        """Tell whether it makes the robot drive."""
        return not isinstance(self.message, Abort)


class CommandBook:
    """Holds the open commands and takes them through their lives.

    Every change is committed before it is shown: ``changed`` is called with each command's new report, and
    ``outbox_changed`` with the robot for which SA holds something new.
    """

    def __init__(
        self,
        database: Database,
        tolerance: float,
        clock: Callable[[], float],
        changed: Callable[[CommandReport], None],
        outbox_changed: Callable[[str], None],
    ) -> None:
        self._database = database
        self._tolerance = tolerance
        self._clock = clock
        self._changed = changed
        self._outbox_changed = outbox_changed
        self._open: dict[str, OpenCommand] = {}
        self._lock = asyncio.Lock()

    async def restore(self) -> None:
        """Take up the commands that an earlier gateway left open."""
        for report, sa_id in await self._database.run(commands.still_open):
            message = _message(report)
            command = OpenCommand(report, sa_id, message)
            if report.state is CommandState.ACKNOWLEDGED:
                command.arrival = judge(message, self._tolerance, under_way=True)
            self._open[report.command] = command

    def busy_with(self, robot: str) -> str | None:
        """Return the id of the command that makes the robot drive, if any."""
        moving = [c.report.command for c in self._of(robot) if c.is_motion]
        return moving[-1] if moving else None

    def undelivered(self) -> dict[int, str]:
        """Return the robot of every message that waits in SA, by the message's id."""
        return {c.sa_id: c.report.robot for c in self._open.values() if c.report.state is CommandState.QUEUED}

    async def issue(self, orders: list[Order]) -> list[CommandReport]:
        """Store new commands with their messages, all or none; return them as stored.

        A command whose id is known already is returned as it stands and changes nothing.
        """
        async with self._lock:
            issued, ended = await self._database.run(self._write_orders, orders)
            for command in ended:
                self._apply(command)
            for command in issued:
                if command.report.state is CommandState.QUEUED and command.report.command not in self._open:
                    self._apply(command)
                    self._outbox_changed(command.report.robot)
            return [command.report for command in issued]

    async def delivered(self, sa_ids: Iterable[int]) -> None:
        """Note that the messages ``sa_ids`` have reached their robots."""
        wanted = set(sa_ids)
        async with self._lock:
            steps = [
                self._step(command, CommandState.DELIVERED, GATEWAY)
                for command in self._open.values()
                if command.sa_id in wanted and command.report.state is CommandState.QUEUED
            ]
            await self._save(steps)

    async def acknowledged(self, robot: str, ack: OpAck) -> None:
        """Note a robot's OpAck: it took the message on, or (``ok`` false) will not do it, or gave it up."""
        async with self._lock:
            command = next((c for c in self._of(robot) if c.sa_id == ack.id), None)
            steps = [] if command is None else self._taken(command, robot, ack)
            # One transaction: a message that is gone from SA with its step unsaved would be lost.
            await self._database.run(_write_acknowledged, robot, ack.id, steps)
            for step in steps:
                self._apply(step)

    async def observe(self, robot: str, pose: SendPos) -> None:
        """Judge the robot's acknowledged commands by where it is now."""
        for command in self._of(robot):
            deviation = command.arrival.deviation(pose) if command.arrival else None
            if deviation is None:
                continue
            # An Abort has no place that it could be off.
            off = deviation if command.is_motion else None
            async with self._lock:
                if self._open.get(command.report.command) is command:
                    step = self._step(command, CommandState.REACHED, GATEWAY, deviation=off)
                    await self._save([step])

    async def deliver_again(self, robot: str, reason: str) -> None:
        """Send once more what a robot that started anew may have forgotten."""
        async with self._lock:
            forgotten = [c for c in self._of(robot) if c.report.state is not CommandState.QUEUED]
            if not forgotten:
                return
            aborted = self._forgotten_and_aborted(robot)
            gone = {command.report.command for command in aborted}
            again = [
                self._anew(c, reason)
                for c in self._of(robot)
                if c.report.command not in gone and c.sa_id >= min(c.sa_id for c in forgotten)
            ]
            for command in await self._database.run(_write_again, again, aborted):
                self._apply(command)
            self._outbox_changed(robot)

    async def expire(self, older_than: float) -> None:
        """End the commands that were queued before ``older_than`` and never fetched."""
        async with self._lock:
            steps = [
                self._step(command, CommandState.EXPIRED, GATEWAY, "the robot did not fetch it in time")
                for command in self._open.values()
                if command.report.state is CommandState.QUEUED and command.report.steps[0].at < older_than
            ]
            await self._save(steps)

    def _of(self, robot: str) -> list[OpenCommand]:
        return [command for command in self._open.values() if command.report.robot == robot]

    def _step(
        self,
        command: OpenCommand,
        state: CommandState,
        by: str,
        reason: str | None = None,
        deviation: float | None = None,
    ) -> OpenCommand:
        report = advance(command.report, state, self._clock(), by, reason, deviation)
        if state is not CommandState.ACKNOWLEDGED:
            return dataclasses.replace(command, report=report)
        arrival = judge(command.message, self._tolerance)
        return dataclasses.replace(command, report=report, arrival=arrival)

    def _taken(self, command: OpenCommand, robot: str, ack: OpAck) -> list[OpenCommand]:
        """Return what a robot's OpAck of ``command`` changes."""
        if not ack.ok:
            return [self._step(command, CommandState.FAILED, robot, ack.reason)]
        if may_become(command.report.state, CommandState.ACKNOWLEDGED):
            return [self._step(command, CommandState.ACKNOWLEDGED, robot), *self._ended_by(command)]
        if command.arrival is None:
            report = note(command.report, self._clock(), robot, "acknowledged again")
            arrival = judge(command.message, self._tolerance)
            return [dataclasses.replace(command, report=report, arrival=arrival)]
        return []

    def _anew(self, command: OpenCommand, reason: str) -> OpenCommand:
        """Return a command to be sent once more; one that was never fetched keeps its place behind."""
        if command.report.state is CommandState.QUEUED:
            reason = "behind what the robot is told once more"
        report = note(command.report, self._clock(), GATEWAY, reason)
        return dataclasses.replace(command, report=report, arrival=None)

    def _forgotten_and_aborted(self, robot: str) -> list[OpenCommand]:
        """Return the ends of what a robot that started anew forgot and an Abort of an operator gave up."""
        mine = self._of(robot)
        return [
            self._step(c, CommandState.ABORTED, abort.report.operator, "the robot started anew")
            for abort in mine
            for c in mine
            if not abort.is_motion and c.is_motion and c.sa_id < abort.sa_id
        ]

    def _ended_by(self, abort: OpenCommand) -> list[OpenCommand]:
        """Return the commands that an acknowledged Abort ends: those that came before it."""
        if abort.is_motion:
            return []
        return [
            self._step(c, CommandState.ABORTED, abort.report.operator, "the robot acknowledged the Abort")
            for c in self._of(abort.report.robot)
            if c.is_motion and c.sa_id < abort.sa_id
        ]

    def _void(self, order: Order) -> list[OpenCommand]:
        """Return the open commands of the robot that ``order`` ends at once."""
        ended = []
        for command in self._of(order.robot):
            if isinstance(order.message, Abort) and command.is_motion:
                if command.report.state is CommandState.QUEUED:
                    reason = "before the robot fetched it"
                    ended.append(self._step(command, CommandState.ABORTED, order.operator, reason))
            elif command.is_motion is not isinstance(order.message, Abort):
                reason = f"by command {order.command}"
                ended.append(self._step(command, CommandState.SUPERSEDED, order.operator, reason))
        return ended

    def _write_orders(
        self, connection: Connection, orders: list[Order]
    ) -> tuple[list[OpenCommand], list[OpenCommand]]:
        issued, ended = [], []
        for order in orders:
            known = commands.find(connection, order.command)
            if known is not None:
                issued.append(OpenCommand(known, 0, order.message))
                continue
            for command in self._void(order):
                _write(connection, command)
                ended.append(command)
            report = CommandReport(
                command=order.command,
                robot=order.robot,
                op=type(order.message).__name__,
                params=to_json(order.message),
                operator=order.operator,
                state=CommandState.QUEUED,
                steps=[CommandStep(CommandState.QUEUED, self._clock(), order.operator)],
            )
            sa_id = answers.add(connection, order.robot, order.message)
            commands.add(connection, report, sa_id)
            issued.append(OpenCommand(report, sa_id, order.message))
        return issued, ended

    async def _save(self, steps: list[OpenCommand]) -> None:
        if steps:
            await self._database.run(_write_all, steps)
            for command in steps:
                self._apply(command)

    def _apply(self, command: OpenCommand) -> None:
        if is_open(command.report.state):
            self._open[command.report.command] = command
        else:
            self._open.pop(command.report.command, None)
        self._changed(command.report)


def _message(report: CommandReport) -> Command:
    message = decode_answer(report.op, report.params)
    assert isinstance(message, (SetPosEnd, SetPath, Abort))
    return message


def _write(connection: Connection, command: OpenCommand) -> None:
    commands.save(connection, command.report, command.sa_id)
    if not is_open(command.report.state):
        answers.remove(connection, [command.sa_id])


def _write_all(connection: Connection, steps: list[OpenCommand]) -> None:
    for command in steps:
        _write(connection, command)


def _write_acknowledged(
    connection: Connection, robot: str, sa_id: int | None, steps: list[OpenCommand]
) -> None:
    if sa_id is not None:
        answers.remove_own(connection, robot, sa_id)
    _write_all(connection, steps)


def _write_again(
    connection: Connection, again: list[OpenCommand], ended: list[OpenCommand]
) -> list[OpenCommand]:
    _write_all(connection, ended)
    written = list(ended)
    for command in sorted(again, key=lambda c: c.sa_id):
        answers.remove(connection, [command.sa_id])
        sa_id = answers.add(connection, command.report.robot, command.message)
        renewed = dataclasses.replace(command, sa_id=sa_id)
        commands.save(connection, renewed.report, sa_id)
        written.append(renewed)
    return written
