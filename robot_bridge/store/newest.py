"""When something was stored last."""

from __future__ import annotations

from sqlalchemy import Connection, func, select

from .schema import audit, commands, observations, robots, trajectories

# Each but the few robots has an index.
_TIMES = (
    trajectories.c.received_at,
    commands.c.created_at,
    observations.c.received_at,
    audit.c.at,
    robots.c.received_at,
)


def newest_time(connection: Connection) -> float | None:
    """Return the newest time of a position, command, observation, robot or entry of the audit log.

    Seconds since 1970 by the gateway's clock of then; None where nothing is stored.
    """
    found = [connection.scalar(select(func.max(column))) for column in _TIMES]
    return max((float(at) for at in found if at is not None), default=None)
