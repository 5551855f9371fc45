"""Steps of commands in the order in which they were written, for gateways that follow those of others."""

from __future__ import annotations

from sqlalchemy import Connection, func, select

from ..schema import command_steps

MARGIN = 500
"""ids that may still be missing below the newest: who took a number first may commit last."""
AT_ONCE = 2000


def newest(connection: Connection) -> int:
    """Return the id of the newest step, 0 without one."""
    return int(connection.scalar(select(func.max(command_steps.c.id))) or 0)


def after(connection: Connection, id: int) -> list[tuple[int, str]]:
    """Return the oldest steps after one: their ids, and the commands that they are of."""
    query = select(command_steps.c.id, command_steps.c.command).where(command_steps.c.id > id)
    return [(int(row[0]), str(row[1])) for row in connection.execute(query.order_by("id").limit(AT_ONCE))]
