"""The accounts as a running gateway knows them: read again whenever they change, also by another program."""

from __future__ import annotations

from sqlalchemy import Connection

from ..messages import Role
from ..store.database import Database
from . import accounts
from .accounts import Grant
from .tokens import TokenKind, digest


class AccountBook:
    """Every token in memory, so that nobody who knocks makes the database work.

    While the database is away those who were known go on.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._fingerprint: tuple[object, ...] | None = None
        self._by_hash: dict[str, Grant] = {}
        self._by_token: dict[str, Grant] = {}

    async def refresh(self) -> bool:
        """Take over what changed and tell whether anything did; raises StoreError."""
        found = await self._database.run(_read, self._fingerprint)
        if found is None:
            return False
        self._fingerprint, grants = found
        self._by_hash = {grant.hash: grant for grant in grants}
        self._by_token = {grant.token: grant for grant in grants}
        return True

    def is_open(self, kind: TokenKind) -> bool:
        """Tell whether no token of ``kind`` was ever made, so that there is nothing to tell people by."""
        return not any(grant.kind is kind for grant in self._by_hash.values())

    def find(self, token: str) -> Grant | None:
        """Return what ``token`` is, None for one that nobody made."""
        return self._by_hash.get(digest(token))

    def grant(self, token_id: str) -> Grant | None:
        """Return the token with an id."""
        return self._by_token.get(token_id)

    def has_operator(self, now: float, role: Role = Role.VIEWER) -> bool:
        """Tell whether somebody with at least ``role`` has a token that holds at ``now``."""
        return any(
            grant.role is not None and grant.role.includes(role) and grant.fault(now) is None
            for grant in self._by_hash.values()
        )


def _read(
    connection: Connection, known: tuple[object, ...] | None
) -> tuple[tuple[object, ...], list[Grant]] | None:
    fingerprint = accounts.fingerprint(connection)
    return None if fingerprint == known else (fingerprint, accounts.grants(connection))
