"""Which kind of accounts a database has."""

from __future__ import annotations

from sqlalchemy import Connection

from .keeper import AccountError, AccountKeeper
from .mariadb import MariaDbAccounts
from .postgresql import PostgreSqlAccounts

_KINDS: dict[str, type[AccountKeeper]] = {
    "postgresql": PostgreSqlAccounts,
    "mysql": MariaDbAccounts,
    "mariadb": MariaDbAccounts,
}


def has_accounts(backend: str) -> bool:
    """Tell whether a kind of database (sqlite, postgresql, mariadb) has accounts."""
    return backend in _KINDS


def keeper_on(connection: Connection) -> AccountKeeper:
    """Return who makes the accounts of the database behind ``connection``; raises AccountError for SQLite."""
    kind = _KINDS.get(connection.dialect.name)
    if kind is None:
        raise AccountError("SQLite has no accounts: robots elsewhere come in over WebSocket, with a token")
    return kind(connection)
