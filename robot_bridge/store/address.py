"""Where a database is: reading its URL, and writing it so that no password is in it."""

from __future__ import annotations

from pathlib import Path

import sqlalchemy
from sqlalchemy import URL, Engine
from sqlalchemy.exc import ArgumentError, NoSuchModuleError

from ..errors import StoreError
from .engines.dialect import PATIENCE_S, Dialect
from .engines.mariadb import MariaDB
from .engines.postgresql import PostgreSQL
from .engines.sqlite import SQLite

FORMS = "sqlite:////path/fleet.db, postgresql://account@host/database or mariadb://account@host/database"
_OTHERS = 0o007


def read_address(text: str, password_file: Path | None = None) -> URL:
    """Return the URL in ``text``, with the password in ``password_file``; raises StoreError."""
    try:
        url = sqlalchemy.make_url(text)
    except (ArgumentError, ValueError):
        # Whatever stands before an @ may be a password.
        raise StoreError(
            f"database URL {text.rpartition('@')[2]!r} cannot be read; write it like {FORMS}"
        ) from None
    if isinstance(_dialect(url), SQLite) and url.database in (None, "", ":memory:"):
        # SQLite would keep it in memory: what is told as queued would go with the process.
        raise StoreError(f"database {shown(url)}: no file is named; write it like sqlite:////path/fleet.db")
    secret = sorted({"password", "passwd", "passfile"} & {key.lower() for key in url.query})
    if secret:
        raise StoreError(
            f"database {shown(url)}: {secret[0]} does not belong into the URL; write the password into a "
            "file and name it with --database-password-file"
        )
    return url if password_file is None else url.set(password=read_password(password_file))


def shown(url: URL) -> str:
    """Return ``url`` as it may be printed: without its password, and without what is asked of the driver."""
    if url.get_backend_name() != "sqlite":
        url = url.set(query={})
    return url.render_as_string(hide_password=True)


def open_engine(url: URL, patience: float | None = PATIENCE_S) -> tuple[Engine, Dialect]:
    """Return an engine on ``url`` and what is particular to its database; raises StoreError."""
    dialect = _dialect(url)
    try:
        return dialect.engine(url, patience), dialect
    except (ModuleNotFoundError, NoSuchModuleError) as error:
        raise StoreError(
            f"database {shown(url)}: its driver is missing ({error}); install it with: "
            f"pip install 'fleet-supervisor-robot-bridge[{dialect.name}]'"
        ) from None
    except (ArgumentError, TypeError, ValueError) as error:
        raise StoreError(f"database {shown(url)}: {error}; write the URL like {FORMS}") from None


def _dialect(url: URL) -> Dialect:
    for kind in (SQLite, PostgreSQL, MariaDB):
        if url.drivername == kind.name:
            return kind()
    raise StoreError(f"database {shown(url)}: {url.drivername} is not supported; write {FORMS}")


def read_password(file: Path) -> str:
    """Return the first line of a file that is closed to others; raises StoreError."""
    try:
        open_to_others = file.stat().st_mode & _OTHERS
        lines = file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise StoreError(f"password file {file}: {reason}; write the password into its first line") from None
    if open_to_others:
        raise StoreError(f"password file {file} can be read by every account here; run: chmod 600 {file}")
    if not lines or not lines[0]:
        raise StoreError(f"password file {file} is empty; write the password into its first line")
    return lines[0]
