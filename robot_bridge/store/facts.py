"""Facts about the database itself."""

from __future__ import annotations

import uuid

from sqlalchemy import Connection, delete, insert, select

from .schema import bridge

ID = "id"
"""The name of the fact that tells the database from every other."""
_SITE = "site"


def database_id(connection: Connection) -> str:
    """Return what tells this database from every other; one that has none yet is given it."""
    found = connection.scalar(select(bridge.c.value).where(bridge.c.name == ID))
    if found is None:
        found = str(uuid.uuid4())
        connection.execute(insert(bridge).values(name=ID, value=found))
    return str(found)


def chosen_site(connection: Connection) -> str | None:
    """Return the name of the folder of the site that a supervisor chose, None if none did."""
    found: str | None = connection.scalar(select(bridge.c.value).where(bridge.c.name == _SITE))
    return found


def choose_site(connection: Connection, folder: str) -> None:
    """Note which site a supervisor chose."""
    forget_site(connection)
    connection.execute(insert(bridge).values(name=_SITE, value=folder))


def forget_site(connection: Connection) -> None:
    """Forget which site a supervisor chose."""
    connection.execute(delete(bridge).where(bridge.c.name == _SITE))
