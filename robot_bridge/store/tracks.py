"""Where the track of a robot begins and ends, from the commands that it was given."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from sqlalchemy import Connection, select

from ..core.decoding import decode_json
from ..messages import CommandState
from .schema import commands


class Given(NamedTuple):
    """What a robot was given, and what became of it."""

    op: str
    params: dict[str, Any]
    state: CommandState


def last_given(connection: Connection, robot: str, ops: Sequence[str]) -> Given | None:
    """Return the robot's newest command of ``ops``."""
    query = (
        select(commands.c.op, commands.c.params, commands.c.state)
        .where(commands.c.robot == robot, commands.c.op.in_(ops))
        .order_by(commands.c.created_at.desc(), commands.c.sa_id.desc())
        .limit(1)
    )
    row = connection.execute(query).one_or_none()
    return None if row is None else Given(row[0], decode_json(row[1]), CommandState(row[2]))
