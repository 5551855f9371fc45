"""How commands and their messages in SA are written, in one transaction; called in the database's thread.

Nothing here changes anything but the database, so that a transaction can be done again.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from sqlalchemy import Connection

from ..command_life.open_command import OpenCommand, Order, Recall, because
from ..command_life.states import is_open, note
from ..errors import RefusedError
from ..messages import Abort, Answer, Command, CommandReport, SetPosIni
from ..store import answers, closures, commands, queues, requests
from ..store.commands import StoredCommand
from ..store.queues import Hold
from ..wire import decode_answer


class Draft(NamedTuple):
    """An order with the command it makes, ends and recalls of older ones, and why it is refused, if it is.

    ``ends_waiting`` is true for a robot that waits for another.

    An order whose command is stored already is neither done again nor refused.
    """

    order: Order
    command: OpenCommand
    ended: list[OpenCommand]
    recalls: list[Recall]
    refusal: RefusedError | None = None
    ends_waiting: bool = False


class Written(NamedTuple):
    """What was written: commands as they now stand, in the order asked for, and older ones that changed."""

    issued: list[OpenCommand]
    changed: list[OpenCommand]


FORGOTTEN = ("Start", "OpAck", "SetMap")
"""What waits for a robot that starts anew, and is void."""
Also = Callable[[Connection], None]
"""More to be written in the same transaction."""
AlsoOf = Callable[[str], Also]
"""What more is to be written, made from the id of the command that the robot then carries out."""


def write_drafts(connection: Connection, drafts: Sequence[Draft], also: Also | None = None) -> Written:
    """Write new commands with their messages; raises RefusedError for the first that is refused."""
    known = commands.find_all(connection, [draft.order.command for draft in drafts])
    new = [draft for draft in drafts if draft.order.command not in known]
    for draft in new:
        if draft.refusal is not None:
            raise draft.refusal
    changed = [command for draft in new for command in draft.ended]
    write_all(connection, changed)
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
    return Written(issued, changed)


def write_all(connection: Connection, steps: Sequence[OpenCommand]) -> None:
    """Write the newest step of commands; what ended takes its message out of SA."""
    commands.save_all(connection, [_stored(command) for command in steps])
    answers.remove(connection, [c.sa_id for c in steps if not is_open(c.report.state)])


def write_recalls(connection: Connection, recalls: Sequence[Recall]) -> list[OpenCommand]:
    """Take messages back that were not fetched, and write what becomes of their commands; return those.

    Fetched is also what its robot has acknowledged without having deleted it, read by the gateway or not.
    """
    taken_back = answers.take_back(connection, [recall.queued.sa_id for recall in recalls])
    if taken_back:
        taken_back -= _acknowledged(connection, recalls)
    steps = [recall.ended if recall.queued.sa_id in taken_back else recall.fetched for recall in recalls]
    commands.save_all(connection, [_stored(command) for command in steps])
    return steps


def _acknowledged(connection: Connection, recalls: Sequence[Recall]) -> set[int]:
    """Return the messages of ``recalls`` whose OpAcks stand in RR; looked for when the messages are gone."""
    by_robot = requests.acknowledged(connection, sorted({recall.queued.report.robot for recall in recalls}))
    return {r.queued.sa_id for r in recalls if r.queued.sa_id in by_robot[r.queued.report.robot]}


def write_acknowledged(
    connection: Connection, robot: str, sa_id: int | None, steps: Sequence[OpenCommand]
) -> None:
    """Write what a robot's OpAck of message ``sa_id`` changes, and take that out of SA."""
    if sa_id is not None:
        answers.remove_own(connection, robot, sa_id)
    write_all(connection, steps)


def write_late(connection: Connection, robot: str, sa_id: int, at: float) -> CommandReport | None:
    """Take message ``sa_id``, which no open command waits for, out of SA.

    A robot may have read the message of a command that ended while it was on its way: then its log says so,
    once, and is returned.
    """
    answers.remove_own(connection, robot, sa_id)
    stored = commands.find_message(connection, robot, sa_id)
    if stored is None or is_open(stored.report.state) or any(s.by == robot for s in stored.report.steps):
        return None
    report = note(stored.report, at, robot, "the robot had read it by then, and acknowledged it")
    commands.save_all(connection, [stored._replace(report=report)])
    return report


def write_again(
    connection: Connection,
    robot: str,
    welcome: Sequence[Answer],
    again: Sequence[OpenCommand],
    ended: Sequence[OpenCommand],
    note_run: Callable[[Connection], bool],
) -> list[OpenCommand]:
    """Write ``welcome`` for a robot that starts anew, then the messages of its commands; return those.

    All that is done once for each run of a robot: ``note_run`` notes that, and returns false where it was
    noted before, by a transaction of which nobody heard that it was done. The messages keep the order in
    which they stood. Nothing else that sets a robot in motion stays: it answers questions that the robot has
    forgotten.
    """
    if not note_run(connection):
        return []
    write_all(connection, ended)
    again = sorted(again, key=lambda command: command.sa_id)
    answers.remove(connection, [command.sa_id for command in again])
    answers.remove_kinds(connection, robot, [*FORGOTTEN, *answers.ORDERS])
    answers.add_all(connection, [(robot, message) for message in welcome])
    ids = answers.add_numbered(connection, [(c.report.robot, c.message) for c in again])
    renewed = [dataclasses.replace(command, sa_id=id) for command, id in zip(again, ids, strict=True)]
    commands.save_all(connection, [_stored(command) for command in renewed])
    return [*ended, *renewed]


def write_driven(connection: Connection, driven: Mapping[str, float]) -> None:
    """Write how many metres of their paths robots have driven, by command."""
    commands.save_driven(connection, driven)


def opened(stored: StoredCommand, message: Command | None = None) -> OpenCommand:
    """Return a stored command as one with a step to come, not judged yet."""
    report = stored.report
    if message is None:
        decoded = decode_answer(report.op, report.params)
        assert isinstance(decoded, Command)
        message = decoded
    return OpenCommand(report, stored.sa_id, message, expires_at=stored.expires_at)


def _held(draft: Draft) -> Hold | None:
    """Return why the robot's queue pauses: it must not overtake whoever orders the robot about."""
    order, message = draft.order, draft.order.message
    if order.task is not None or isinstance(message, SetPosIni):
        return None
    reason = f"{order.operator} ordered {type(message).__name__} beside the queue"
    if isinstance(message, Abort):
        what = "emergency stop by" if message.emergency else "aborted by"
        reason = because(f"{what} {order.operator}", order.reason)
    return Hold(order.robot, reason, order.operator, draft.command.report.steps[0].at)


def _stored(command: OpenCommand) -> StoredCommand:
    return StoredCommand(command.report, command.sa_id, command.driven, command.expires_at)
