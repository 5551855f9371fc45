"""Commands with all their steps, and the tracks given to robots."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from sqlalchemy import (
    ARRAY,
    BigInteger,
    Connection,
    Select,
    Text,
    and_,
    bindparam,
    cast,
    delete,
    func,
    select,
    true,
)

from ....core.json_decoder import decode_json
from ....core.messages.commands import CommandReport, CommandState, CommandStep
from ....core.messages.robots import Abort
from ..rows import (
    Row,
    add_rows,
    beside_the_time,
    change_rows,
    delete_oldest,
    is_one_of,
    padded_pieces,
    readable,
)
from ..schema import command_steps, commands

# --- Commands and their steps ---

# Built once: SQLAlchemy takes longer to build a statement than the database to do it.
_NEW = "id", "robot", "op", "params", "operator", "state", "driven", "sa_id", "created_at", "expires_at"
_CHANGED = "id", "state", "deviation", "stood_x", "stood_y", "stood_theta", "driven", "sa_id"
_BY_ID = select(commands).where(commands.c.id.in_(bindparam("ids", expanding=True)))
_BY_MESSAGES = select(commands).where(
    commands.c.robot.in_(bindparam("robots", expanding=True)),
    commands.c.sa_id.in_(bindparam("messages", expanding=True)),
)
_STEPS = (
    select(command_steps)
    .where(command_steps.c.command.in_(bindparam("commands", expanding=True)))
    .order_by(command_steps.c.id)
)


# On PostgreSQL each is found by an index, whatever the server's statistics: it may assume that a list matches
# most rows, and of two lists it searches every pair.
_IDS = func.unnest(cast(bindparam("ids"), ARRAY(Text))).table_valued("id").render_derived()
_WANTED = (
    func.unnest(cast(bindparam("robots"), ARRAY(Text)), cast(bindparam("messages"), ARRAY(BigInteger)))
    .table_valued("robot", "message")
    .render_derived()
)
_EACH_OF_IDS = select(commands).join(_IDS, commands.c.id == _IDS.c.id)
_EACH_OF_MESSAGES = select(commands).join(
    _WANTED, and_(commands.c.robot == _WANTED.c.robot, commands.c.sa_id == _WANTED.c.message)
)
_OF_ONE = select(command_steps).where(command_steps.c.command == _IDS.c.id).offset(0).lateral()
_EACH_OF_STEPS = select(_OF_ONE).select_from(_IDS.join(_OF_ONE, true())).order_by(_OF_ONE.c.id)


class StoredCommand(NamedTuple):
    """A command with data used only by the gateway.

    ``sa_id`` is the row of SA that holds its message, ``driven`` the driven metres of its path,
    ``expires_at`` when it is given up if not fetched (None: by the site's settings).
    """

    report: CommandReport
    sa_id: int
    driven: float | None = None
    expires_at: float | None = None


def add_all(connection: Connection, new: Sequence[StoredCommand]) -> None:
    """Write new commands with their steps."""
    add_rows(connection, commands, _NEW, [_row(command) for command in new])
    _add_steps(connection, [(c.report.command, step) for c in new for step in c.report.steps])


def save_all(connection: Connection, changed: Sequence[StoredCommand]) -> None:
    """Write the newest step of each of some stored commands."""
    rows = [
        (
            *(c.report.command, c.report.state.value, c.report.deviation),
            *(c.report.stood or (None,) * 3),
            *(c.driven, c.sa_id),
        )
        for c in changed
    ]
    change_rows(connection, commands, _CHANGED, rows)
    _add_steps(connection, [(c.report.command, c.report.steps[-1]) for c in changed])


def save_driven(connection: Connection, driven: Mapping[str, float]) -> None:
    """Write the driven metres of the paths of some commands."""
    change_rows(connection, commands, ("id", "driven"), list(driven.items()))


def find_all(connection: Connection, ids: Sequence[str]) -> dict[str, StoredCommand]:
    """Return those of some commands that are stored, by their ids."""
    at_once = connection.dialect.name == "postgresql"
    query = _EACH_OF_IDS if at_once else _BY_ID
    return {
        command.report.command: command
        for some in ([list(ids)] if at_once else padded_pieces(ids))
        for command in _load(connection, query, {"ids": some})
    }


def find(connection: Connection, command: str) -> CommandReport | None:
    """Return a command by its id."""
    found = find_all(connection, [command]).get(command)
    return None if found is None else found.report


def find_messages(
    connection: Connection, messages: Sequence[tuple[str, int]]
) -> dict[tuple[str, int], StoredCommand]:
    """Return the commands of robots whose ``messages`` are, or were, those rows of SA, by robot and id."""
    wanted = set(messages)
    found: dict[tuple[str, int], StoredCommand] = {}
    at_once = connection.dialect.name == "postgresql"
    for some in [messages] if at_once else padded_pieces(messages):
        robots, ids = ([one[n] for one in some] for n in range(2))
        # By the index of both, which also finds a command of a robot with another one's id.
        query = _EACH_OF_MESSAGES if at_once else _BY_MESSAGES
        for command in _load(connection, query, {"robots": robots, "messages": ids}):
            if (key := (command.report.robot, command.sa_id)) in wanted:
                found[key] = command
    return found


def newest(
    connection: Connection, robot: str | None, limit: int, ops: Sequence[str] = ()
) -> list[CommandReport]:
    """Return the newest commands first, of one robot or of all, and of the kinds ``ops`` if given."""
    query = select(commands).order_by(commands.c.created_at.desc(), commands.c.sa_id.desc()).limit(limit)
    if robot is not None:
        query = query.where(commands.c.robot == robot)
    if ops:
        query = query.where(commands.c.op.in_(ops))
    return [command.report for command in _load(connection, query)]


def still_open(connection: Connection, robots: Sequence[str] | None = None) -> list[StoredCommand]:
    """Return the open commands, oldest first, of some robots or of all."""
    states = [state.value for state in CommandState if state.is_open]
    query = select(commands).where(commands.c.state.in_(states)).order_by(commands.c.sa_id)
    if robots is not None:
        query = query.where(is_one_of(connection, commands.c.robot, robots))
    return _load(connection, query)


def of_kind_since(connection: Connection, op: str, since: float) -> list[CommandReport]:
    """Return the commands of one kind that were issued at ``since`` or later, oldest first."""
    query = select(commands).where(commands.c.op == op, commands.c.created_at >= since)
    return [command.report for command in _load(connection, query.order_by(commands.c.sa_id))]


def aborted_since(connection: Connection, robots: Sequence[str], since: float) -> set[str]:
    """Return those of ``robots`` for which an Abort was issued at ``since`` or later."""
    query = select(commands.c.robot).where(is_one_of(connection, commands.c.robot, robots))
    return set(
        connection.scalars(query.where(commands.c.created_at >= since, commands.c.op == Abort.__name__))
    )


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` ended commands from before a time, with their steps; return how many."""
    ended = [state.value for state in CommandState if not state.is_open]
    has_ended = beside_the_time(commands.c.state).in_(ended)
    gone = delete_oldest(connection, commands.c.id, commands.c.created_at, before, limit, has_ended)
    if gone:
        connection.execute(delete(command_steps).where(command_steps.c.command.in_(gone)))
    return len(gone)


def _row(command: StoredCommand) -> Row:
    report = command.report
    what = report.command, report.robot, report.op, json.dumps(report.params), report.operator
    return *what, report.state.value, command.driven, command.sa_id, report.steps[0].at, command.expires_at


def _load(
    connection: Connection, query: Select[tuple[object, ...]], values: Mapping[str, Any] | None = None
) -> list[StoredCommand]:
    rows = connection.execute(query, values).mappings().all()
    steps: dict[str, list[CommandStep]] = {row["id"]: [] for row in rows}
    for command, step in readable(
        _steps(connection, list(steps)), _step, lambda row: f"a step of command {row['command']}"
    ):
        steps[command].append(step)
    return list(
        readable(rows, lambda row: _stored(row, steps[row["id"]]), lambda row: f"command {row['id']}")
    )


def _steps(connection: Connection, commands: Sequence[str]) -> Iterator[Mapping[Any, Any]]:
    if connection.dialect.name == "postgresql":
        yield from connection.execute(_EACH_OF_STEPS, {"ids": list(commands)}).mappings()
        return
    for some in padded_pieces(commands):
        yield from connection.execute(_STEPS, {"commands": some}).mappings()


def _stored(row: Mapping[Any, Any], steps: list[CommandStep]) -> StoredCommand:
    return StoredCommand(
        CommandReport(
            command=row["id"],
            robot=row["robot"],
            op=row["op"],
            params=_params(row["params"]),
            operator=row["operator"],
            state=CommandState(row["state"]),
            steps=steps,
            deviation=row["deviation"],
            stood=_stood(row["stood_x"], row["stood_y"], row["stood_theta"]),
        ),
        sa_id=row["sa_id"],
        driven=row["driven"],
        expires_at=row["expires_at"],
    )


def _step(row: Mapping[Any, Any]) -> tuple[str, CommandStep]:
    return row["command"], CommandStep(CommandState(row["state"]), row["at"], row["by"], row["reason"])


def _params(text: str) -> dict[str, Any]:
    params = decode_json(text)
    if not isinstance(params, dict):
        raise TypeError(f"params is {type(params).__name__}")
    return params


def _stood(x: float | None, y: float | None, theta: float | None) -> tuple[float, float, float] | None:
    return None if x is None or y is None or theta is None else (x, y, theta)


def _add_steps(connection: Connection, steps: Sequence[tuple[str, CommandStep]]) -> None:
    rows = [(command, step.state.value, step.at, step.by, step.reason) for command, step in steps]
    add_rows(connection, command_steps, ("command", "state", "at", "by", "reason"), rows)


# --- Begin and end of a robot's track, from its commands ---


class GivenTrack(NamedTuple):
    """A track given to a robot, with its outcome."""

    op: str
    params: dict[str, Any]
    state: CommandState


_LAST_OF = (
    select(commands.c.op, commands.c.params, commands.c.state)
    .where(commands.c.robot == bindparam("of"), commands.c.op.in_(bindparam("ops", expanding=True)))
    .order_by(commands.c.created_at.desc(), commands.c.sa_id.desc())
    .limit(1)
)


def last_given_track(connection: Connection, robot: str, ops: Sequence[str]) -> GivenTrack | None:
    """Return the robot's newest command of ``ops``."""
    row = connection.execute(_LAST_OF, {"of": robot, "ops": ops}).one_or_none()
    return None if row is None else GivenTrack(row[0], decode_json(row[1]), CommandState(row[2]))


# --- Steps in the order of writing, for gateways that follow those of others ---

STEP_MARGIN = 500
"""ids that may still be missing below the newest: the transaction that took an id first may commit last."""
STEPS_AT_ONCE = 2000


def newest_step(connection: Connection) -> int:
    """Return the id of the newest step, 0 without one."""
    return int(connection.scalar(select(func.max(command_steps.c.id))) or 0)


def steps_after(connection: Connection, id: int) -> list[tuple[int, str]]:
    """Return the oldest steps after one: their ids, and their commands."""
    query = select(command_steps.c.id, command_steps.c.command).where(command_steps.c.id > id)
    return [
        (int(row[0]), str(row[1])) for row in connection.execute(query.order_by("id").limit(STEPS_AT_ONCE))
    ]
