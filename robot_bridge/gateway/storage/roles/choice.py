"""Choice of the role manager for a database."""

from __future__ import annotations

from sqlalchemy import Connection

from .mariadb import MariaDbRoles
from .postgresql import PostgreSqlRoles
from .role_manager import AccountError, RoleManager

_KINDS: dict[str, type[RoleManager]] = {
    "postgresql": PostgreSqlRoles,
    "mysql": MariaDbRoles,
    "mariadb": MariaDbRoles,
}


def has_accounts(backend: str) -> bool:
    """Return whether a kind of database (sqlite, postgresql, mariadb) has accounts."""
    return backend in _KINDS


def role_manager_on(connection: Connection) -> RoleManager:
    """Return the role manager of the database behind ``connection``; raises AccountError for SQLite."""
    kind = _KINDS.get(connection.dialect.name)
    if kind is None:
        raise AccountError("SQLite has no accounts: robots elsewhere come in over WebSocket, with a token")
    return kind(connection)


def map_readers_on(connection: Connection) -> PostgreSqlRoles:
    """Return the manager of accounts that read the views of the fleet; raises AccountError elsewhere."""
    if connection.dialect.name != "postgresql":
        raise AccountError("only PostgreSQL has accounts for the views of the fleet; a file is read as it is")
    return PostgreSqlRoles(connection)
