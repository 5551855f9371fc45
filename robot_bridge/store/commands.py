"""Commands and every step of their lives."""

from __future__ import annotations

import json
from collections.abc import Iterable

from sqlalchemy import Connection, Select, insert, select, update

from ..command_life import is_open
from ..messages import CommandReport, CommandState, CommandStep
from .schema import command_steps, commands


def add(connection: Connection, command: CommandReport, sa_id: int) -> None:
    """Write a new command whose message is row ``sa_id`` of SA."""
    connection.execute(
        insert(commands).values(
            id=command.command,
            robot=command.robot,
            op=command.op,
            params=json.dumps(command.params),
            operator=command.operator,
            state=command.state.value,
            sa_id=sa_id,
            created_at=command.steps[0].at,
        )
    )
    _add_steps(connection, command, command.steps)


def save(connection: Connection, command: CommandReport, sa_id: int) -> None:
    """Write the newest step of a command that is stored already."""
    connection.execute(
        update(commands)
        .where(commands.c.id == command.command)
        .values(state=command.state.value, deviation=command.deviation, sa_id=sa_id)
    )
    _add_steps(connection, command, command.steps[-1:])


def find(connection: Connection, command: str) -> CommandReport | None:
    """Return a command by its id."""
    found = _load(connection, select(commands).where(commands.c.id == command))
    return found[0][0] if found else None


def newest(connection: Connection, robot: str | None, limit: int) -> list[CommandReport]:
    """Return the newest commands first, of one robot or of all."""
    query = select(commands).order_by(commands.c.created_at.desc(), commands.c.sa_id.desc()).limit(limit)
    if robot is not None:
        query = query.where(commands.c.robot == robot)
    return [command for command, _ in _load(connection, query)]


def still_open(connection: Connection) -> list[tuple[CommandReport, int]]:
    """Return the commands that have a step to come, oldest first, each with the id of its row in SA."""
    states = [state.value for state in CommandState if is_open(state)]
    query = select(commands).where(commands.c.state.in_(states)).order_by(commands.c.sa_id)
    return _load(connection, query)


def _load(connection: Connection, query: Select[tuple[object, ...]]) -> list[tuple[CommandReport, int]]:
    rows = connection.execute(query).mappings().all()
    steps: dict[str, list[CommandStep]] = {row["id"]: [] for row in rows}
    wanted = select(command_steps).where(command_steps.c.command.in_(steps)).order_by(command_steps.c.id)
    for step in connection.execute(wanted).mappings():
        steps[step["command"]].append(
            CommandStep(CommandState(step["state"]), step["at"], step["by"], step["reason"])
        )
    return [
        (
            CommandReport(
                command=row["id"],
                robot=row["robot"],
                op=row["op"],
                params=json.loads(row["params"]),
                operator=row["operator"],
                state=CommandState(row["state"]),
                steps=steps[row["id"]],
                deviation=row["deviation"],
            ),
            row["sa_id"],
        )
        for row in rows
    ]


def _add_steps(connection: Connection, command: CommandReport, steps: Iterable[CommandStep]) -> None:
    connection.execute(
        insert(command_steps),
        [
            {
                "command": command.command,
                "state": step.state.value,
                "at": step.at,
                "by": step.by,
                "reason": step.reason,
            }
            for step in steps
        ],
    )
