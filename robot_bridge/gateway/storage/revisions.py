"""Revisions of the tables: check, create and upgrade them (Alembic)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sqlalchemy import Column, Connection, MetaData, String, Table, inspect, select
from sqlalchemy.types import TypeEngine

from ...core.errors import StoreError
from .schema import metadata

if TYPE_CHECKING:
    from alembic.config import Config

NEEDED = "0014"
"""The revision that this program needs."""
FIRST = "0001"
"""The revision of version 0.1.0, which did not store its revision."""
MIGRATIONS = Path(__file__).with_name("migrations")


class RevisionError(StoreError):
    """The tables are not of the revision that is needed."""


@dataclass(frozen=True)
class RevisionReport:
    """The revision of a database (None: no tables), and its differences from the needed tables."""

    found: str | None
    differences: list[str]

    @property
    def good(self) -> bool:
        """Whether this program can use the database."""
        return self.found == NEEDED and not self.differences

    @property
    def advice(self) -> str:
        """Advice on what must be done."""
        if self.found == NEEDED and self.differences:
            return "somebody changed the tables: put them back, or restore a backup"
        return _advice(self.found)


_version = Table("alembic_version", MetaData(), Column("version_num", String(32), primary_key=True))
_ON_POSTGRESQL_ONLY = frozenset({"ix_trajectories_id"})
"""An index instead of the primary key, which a partitioned table lacks."""
_MARKS = frozenset({"rr", "sa", "commands", "trajectories"})


def current(connection: Connection) -> str | None:
    """Return the revision of the database; None when it has no tables of the bridge."""
    tables = set(inspect(connection).get_table_names())
    if _version.name in tables:
        return connection.scalar(select(_version.c.version_num))
    return FIRST if tables >= _MARKS else None


def must_create(connection: Connection, where: str, made_by_serve: bool) -> bool:
    """Return whether the tables must be created; raises StoreError if an administrator must decide."""
    found = current(connection)
    if found == NEEDED:
        return False
    if found is not None:
        raise RevisionError(f"database {where} is at revision {found}, {_needed(found)}")
    if not made_by_serve:
        raise RevisionError(f"database {where} has no tables of the bridge; {_advice(found)}")
    return True


def create(connection: Connection, revision: str = NEEDED) -> None:
    """Create the tables of ``revision`` in an empty database; raises StoreError if it has tables."""
    found = current(connection)
    if found is not None:
        raise RevisionError(f"the tables are there already, at revision {found}; {_advice(found)}")
    _migrate(connection, revision)


def upgrade(connection: Connection) -> str:
    """Upgrade the tables with their contents; return the revision before."""
    found = current(connection)
    if found is None:
        raise RevisionError(f"there are no tables to upgrade; {_advice(found)}")
    if found > NEEDED:
        raise RevisionError(f"the tables are at revision {found}, {_needed(found)}")
    if found == FIRST and _version.name not in inspect(connection).get_table_names():
        _stamp(connection, FIRST)
    _migrate(connection, NEEDED)
    return found


def report(connection: Connection) -> RevisionReport:
    """Return a report on the tables."""
    found = current(connection)
    return RevisionReport(found, differences(connection) if found == NEEDED else [])


def differences(connection: Connection) -> list[str]:
    """Return in words how the tables differ from those that this program needs."""
    from alembic.autogenerate import compare_metadata
    from alembic.runtime.migration import MigrationContext

    options = {"compare_type": _differs, "include_name": _ours}
    found = compare_metadata(MigrationContext.configure(connection, opts=options), metadata)
    return [_words(change) for change in found]


def _migrate(connection: Connection, revision: str) -> None:
    from alembic import command

    command.upgrade(_config(connection), revision)


def _stamp(connection: Connection, revision: str) -> None:
    from alembic import command

    command.stamp(_config(connection), revision)


def _config(connection: Connection) -> Config:
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    config.attributes["connection"] = connection
    return config


def _needed(found: str) -> str:
    return f"and this version of robot-bridge needs {NEEDED}; {_advice(found)}"


def _advice(found: str | None) -> str:
    if found is None:
        return "make the tables with: robot-bridge database create"
    if found == NEEDED:
        return "nothing is to be done"
    if found < NEEDED:
        return "back it up, then run: robot-bridge database upgrade"
    return "it belongs to a newer robot-bridge; install that one"


def _ours(name: str | None, kind: str, _parents: Any) -> bool:
    return name not in _ON_POSTGRESQL_ONLY and (kind != "table" or name in metadata.tables)


def _differs(
    context: Any,
    _inspected_column: Any,
    _metadata_column: Any,
    inspected: TypeEngine[Any],
    expected: TypeEngine[Any],
) -> bool | None:
    """Return whether two types of a column differ; SQLite only has families of types."""
    if context.dialect.name != "sqlite":
        return None
    return inspected._type_affinity is not expected._type_affinity and _family(inspected) != _family(expected)


def _family(kind: TypeEngine[Any]) -> type[Any]:
    return kind.as_generic()._type_affinity or type(kind)


def _words(change: Any) -> str:
    if isinstance(change, list):
        return "; ".join(_words(part) for part in change)
    kind, *about = change
    names = [str(getattr(part, "name", part)) for part in about if part is not None]
    return f"{kind.replace('_', ' ')}: {', '.join(names[:4])}"
