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
"""The name of the fact that tells the database from every other."""
FLEET = "fleet"
"""The name of the fact that tells the fleet on this database from others on the same NATS servers."""
_SITE, _FRAME = "site", "frame"


def database_id(connection: Connection) -> str:
    """Return what tells this database from every other; one that has none yet is given it."""
    return fact(connection, ID, str(uuid.uuid4()))


def fleet_id(connection: Connection) -> str:
    """Return the id of the fleet on this database: the first id of that.

    It stays when the database counts as another one to robots, since accounts on NATS servers are given it.
    """
    return fact(connection, FLEET, database_id(connection))


def known_fleet(connection: Connection) -> str | None:
    """Return the id of the fleet on this database, None where no gateway has served it yet."""
    return _known(connection, FLEET) or _known(connection, ID)


def renew_id(connection: Connection, before: str) -> bool:
    """Have the database count as another one than ``before``; false where somebody was faster.

    Robots forget the ids of messages, which come again: those on SQL, who do not connect, are sent Start.
    What waited in RR was said to the one before.
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
"""SQL that tells robots on SQL the id of the database, with ``params`` of a Start."""

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
    """Return the id of the database and that of the newest message it gave out, 0 before the first.

    None where one of them is not known, as while somebody restores it.
    """
    id = _known(connection, ID)
    newest = connection.scalar(text(_NEWEST[connection.dialect.name]))
    return None if id is None or newest is None else (id, int(newest))


def fact(connection: Connection, name: str, value: str) -> str:
    """Return what is known under ``name``; ``value``, which is noted then, where nothing is.

    Several gateways may ask at once, and are told the same.
    """
    if (found := _known(connection, name)) is None:
        kind = postgresql.insert if connection.dialect.name == "postgresql" else insert
        add = kind(bridge).values(name=name, value=value)
        connection.execute(add.on_conflict_do_nothing() if isinstance(add, postgresql.Insert) else add)
        found = _known(connection, name)
    return str(found)


def replace_fact(connection: Connection, name: str, before: str, value: str) -> bool:
    """Note ``value`` under ``name`` where ``before`` is known; false where another one came before."""
    ours = (bridge.c.name == name) & (bridge.c.value == before)
    return connection.execute(update(bridge).where(ours).values(value=value)).rowcount == 1


def forget_facts(connection: Connection, names: Sequence[str]) -> None:
    """Know nothing under ``names`` any more."""
    connection.execute(delete(bridge).where(bridge.c.name.in_(names)))


_WITH_PLACES = robots, commands, plans, closures
"""Tables of which one has a row wherever there is a place at all."""


def frame_of_places(connection: Connection, frame: str, *, is_alone: bool) -> str:
    """Return the frame that all places in the database are in; ``frame`` from now on where there are none.

    ``is_alone`` tells that no other gateway serves the database, which may have its own ones in mind.
    """
    if is_alone and not any(connection.execute(select(one).limit(1)).first() for one in _WITH_PLACES):
        forget_facts(connection, [_FRAME])
    return fact(connection, _FRAME, frame)


def chosen_site(connection: Connection) -> str | None:
    """Return the name of the folder of the site that a supervisor chose, None if none did."""
    return _known(connection, _SITE)


def choose_site(connection: Connection, folder: str) -> None:
    """Note which site a supervisor chose."""
    # Of several gateways that choose at once each has its turn.
    if connection.execute(update(bridge).where(bridge.c.name == _SITE).values(value=folder)).rowcount == 0:
        forget_site(connection)
        connection.execute(insert(bridge).values(name=_SITE, value=folder))


def forget_site(connection: Connection) -> None:
    """Forget which site a supervisor chose."""
    connection.execute(delete(bridge).where(bridge.c.name == _SITE))


def _known(connection: Connection, name: str) -> str | None:
    found: str | None = connection.scalar(select(bridge.c.value).where(bridge.c.name == name))
    return found


# --- When something was stored last ---

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
