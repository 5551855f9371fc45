"""Metadata of the database: its id, the chosen site, the newest time in it."""

from __future__ import annotations

import json
import uuid
from collections.abc import Sequence

from sqlalchemy import Connection, delete, func, insert, select, text, update
from sqlalchemy.dialects import postgresql

from ..schema import audit, bridge, closures, commands, observations, plans, robots, rr, trajectories

# --- Facts about the database itself ---

ID = "id"
"""The name of the fact that distinguishes the database from every other."""
FLEET = "fleet"
"""The name of the fact that distinguishes the fleet from others on the same NATS servers."""
_SITE, _FRAME = "site", "frame"


def database_id(connection: Connection) -> str:
    """Return the unique id of this database; create it if missing."""
    return fact(connection, ID, str(uuid.uuid4()))


def fleet_id(connection: Connection) -> str:
    """Return the id of the fleet on this database: the first id of that.

    It stays when the database gets a new id for robots, since accounts on NATS servers contain it.
    """
    return fact(connection, FLEET, database_id(connection))


def known_fleet(connection: Connection) -> str | None:
    """Return the id of the fleet on this database, None if no gateway has served it yet."""
    return _known(connection, FLEET) or _known(connection, ID)


def renew_id(connection: Connection, before: str) -> bool:
    """Give the database another id than ``before``; return false if it was changed already.

    Robots forget the ids of messages, which are reused: those on SQL, which do not connect, are sent Start.
    Requests waiting in RR belonged to the old id.
    """
    if not replace_fact(connection, ID, before, after := str(uuid.uuid4())):
        return False
    connection.execute(delete(rr))
    connection.execute(text(GREETING.format(schema="")), {"params": json.dumps({"database": after})})
    return True


GREETING = (
    "insert into {schema}sa (robot, op, params) "
    "select name, 'Start', :params from {schema}robots where link = 'sql'"
)
"""SQL that sends robots on SQL the id of the database, with ``params`` of a Start."""

_NEWEST = {
    "sqlite": "select coalesce(max(seq), 0) from sqlite_sequence where name = 'sa'",
    # A gateway's account of an older set-up may not read it.
    "postgresql": (
        "select case when has_sequence_privilege(s, 'select, usage') "
        "then coalesce(pg_sequence_last_value(s), 0) end "
        "from cast(pg_get_serial_sequence('public.sa', 'id') as regclass) as s"
    ),
    "mariadb": (
        "select auto_increment - 1 from information_schema.tables "
        "where table_schema = database() and table_name = 'sa'"
    ),
}


def message_count(connection: Connection) -> tuple[str, int] | None:
    """Return the id of the database and of its newest message, 0 before the first.

    None if one of them is unknown, as during a restore.
    """
    id = _known(connection, ID)
    newest = connection.scalar(text(_NEWEST[connection.dialect.name]))
    return None if id is None or newest is None else (id, int(newest))


def fact(connection: Connection, name: str, value: str) -> str:
    """Return the fact ``name``; if missing, store ``value`` and return it.

    Several gateways may call at once, and get the same.
    """
    if (found := _known(connection, name)) is None:
        kind = postgresql.insert if connection.dialect.name == "postgresql" else insert
        add = kind(bridge).values(name=name, value=value)
        connection.execute(add.on_conflict_do_nothing() if isinstance(add, postgresql.Insert) else add)
        found = _known(connection, name)
    return str(found)


def replace_fact(connection: Connection, name: str, before: str, value: str) -> bool:
    """Replace ``before`` by ``value`` under ``name``; return false if the fact is another one."""
    ours = (bridge.c.name == name) & (bridge.c.value == before)
    return connection.execute(update(bridge).where(ours).values(value=value)).rowcount == 1


def forget_facts(connection: Connection, names: Sequence[str]) -> None:
    """Delete the facts ``names``."""
    connection.execute(delete(bridge).where(bridge.c.name.in_(names)))


_WITH_PLACES = robots, commands, plans, closures
"""Tables of which at least one has a row if the database has any place."""


def frame_of_places(connection: Connection, frame: str, *, is_alone: bool) -> str:
    """Return the frame of all places in the database; if there are none, set and return ``frame``.

    ``is_alone`` means that no other gateway serves the database, which might be about to store places.
    """
    if is_alone and not any(connection.execute(select(one).limit(1)).first() for one in _WITH_PLACES):
        forget_facts(connection, [_FRAME])
    return fact(connection, _FRAME, frame)


def chosen_site(connection: Connection) -> str | None:
    """Return the name of the folder of the site that a supervisor chose, None if none did."""
    return _known(connection, _SITE)


def choose_site(connection: Connection, folder: str) -> None:
    """Store the site chosen by a supervisor."""
    # Concurrent choices of several gateways are serialised.
    if connection.execute(update(bridge).where(bridge.c.name == _SITE).values(value=folder)).rowcount == 0:
        forget_site(connection)
        connection.execute(insert(bridge).values(name=_SITE, value=folder))


def forget_site(connection: Connection) -> None:
    """Delete the site chosen by a supervisor."""
    connection.execute(delete(bridge).where(bridge.c.name == _SITE))


def _known(connection: Connection, name: str) -> str | None:
    found: str | None = connection.scalar(select(bridge.c.value).where(bridge.c.name == name))
    return found


# --- Time of the last stored row ---

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

    Seconds since 1970 by the gateway's clock of then; None if nothing is stored.
    """
    found = [connection.scalar(select(func.max(column))) for column in _TIMES]
    return max((float(at) for at in found if at is not None), default=None)
