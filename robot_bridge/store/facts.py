"""Facts about the database itself."""

from __future__ import annotations

import uuid

from sqlalchemy import Connection, insert, select

from .schema import bridge


def database_id(connection: Connection) -> str:
    """Return what tells this database from every other; one that has none yet is given it."""
    found = connection.scalar(select(bridge.c.value).where(bridge.c.name == "id"))
    if found is None:
        found = str(uuid.uuid4())
        connection.execute(insert(bridge).values(name="id", value=found))
    return str(found)
