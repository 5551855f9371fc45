"""Databases with the tables of today, the first of a kind made in earnest, the others copied or emptied."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from sqlalchemy import make_url

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.schema import metadata
from tests.support.databases.database_client import DatabaseClient

KINDS = ("sqlite", "postgresql", "mariadb")
MADE = """
select md5(string_agg(made, '; ' order by made)) from (
  select 'table ' || concat_ws(
      ',', relname, relkind, relowner, relacl, relrowsecurity, relforcerowsecurity
    ) as made
    from pg_class where relnamespace = 'public'::regnamespace
  union all
  select 'column ' || concat_ws(',', relname, attname, atttypid, attnotnull, attacl, atthasdef, attisdropped)
    from pg_attribute join pg_class on pg_class.oid = attrelid
    where attnum > 0 and relnamespace = 'public'::regnamespace
  union all
  select 'constraint ' || concat_ws(',', conrelid, conname, convalidated)
    from pg_constraint where connamespace = 'public'::regnamespace
  union all
  select 'trigger ' || concat_ws(',', tgname, tgrelid, tgenabled) from pg_trigger
  union all
  select 'function ' || concat_ws(',', oid, proname, proacl) from pg_proc
    where pronamespace = 'public'::regnamespace
  union all
  select 'policy ' || concat_ws(',', polname, polrelid) from pg_policy
  union all
  select 'schema ' || concat_ws(',', nspname, nspowner, nspacl) from pg_namespace
    where nspname !~ '^pg_'
  union all
  select 'database ' || concat_ws(',', datdba, datacl, datallowconn, datconnlimit) from pg_database
    where datname = current_database()
  union all
  select 'setting ' || concat_ws(',', setrole, setconfig) from pg_db_role_setting
    where setdatabase = (select oid from pg_database where datname = current_database())
  union all
  select 'owner ' || concat_ws(',', rolcanlogin, rolconnlimit, rolvaliduntil) from pg_roles
    where rolname = current_user
) as everything
"""
"""What a database of PostgreSQL is made of besides its rows, as one word."""
CLIENTS = """
select count(*) from pg_stat_activity
  where datname = current_database() and pid <> pg_backend_pid() and backend_type = 'client backend'
"""
BEGIN_AT_ONE = "select setval(oid, 1, false) from pg_class where relkind = 'S'"

MADE_LATER = """
select 1 from information_schema.check_constraints where constraint_schema = database()
union all select 1 from information_schema.triggers where trigger_schema = database()
"""
"""What the tables of MariaDB have only where a test has made it."""
FULL = " union all ".join(f"(select '{name}' from {name} limit 1)" for name in metadata.tables)
"""Which tables have rows."""


class DatabaseMaker:
    """Makes databases; ``server`` returns the running server of a kind (see the fixtures)."""

    def __init__(self, folder: Path, server: Callable[[str], Any]):
        self._folder = folder
        self._server = server
        self._models: dict[str, str] = {}
        self._made = 0
        self._used = ""
        """The last database of PostgreSQL that was given away."""
        self._as_made = ""
        self._clients: dict[str, DatabaseClient] = {}
        """Connections, by kind: a server takes longer to open one than to look through a database."""

    def __call__(self, kind: str) -> str:
        """Return the URL of a database of ``kind`` that nothing is in.

        Of MariaDB there is one at a time: it has no quick way to copy a database. One of PostgreSQL is given
        again when nobody is connected to it any more.
        """
        self._made += 1
        if kind == "mariadb":
            return self._emptied(self._models.get(kind))
        if kind not in self._models:
            self._models[kind] = self._first(kind)
        return self._copied_file() if kind == "sqlite" else self._copied_or_emptied()

    def another(self, kind: str) -> str:
        """Return the URL of one more, whether or not somebody is connected to the last."""
        if kind == "mariadb":
            return self._first(kind)
        if kind not in self._models:
            self._models[kind] = self._first(kind)
        self._made += 1
        return self._copied_file() if kind == "sqlite" else self._copied()

    def at(self, file: Path) -> str:
        """Make a database of SQLite in a file; return its URL."""
        shutil.copy(self("sqlite").removeprefix("sqlite:///"), file)
        return f"sqlite:///{file}"

    def _first(self, kind: str) -> str:
        url = f"sqlite:///{self._folder}/model.db" if kind == "sqlite" else self._server(kind).new_database()
        with ThreadPoolExecutor(1) as thread:
            # Fixtures and tests with a running loop ask for it too, and a thread runs one loop at a time.
            thread.submit(run_once, url, revisions.create).result()
        if kind == "sqlite":
            DatabaseClient(url).sql("pragma wal_checkpoint(truncate)")
        return url

    def _copied_file(self) -> str:
        file = self._folder / f"fleet-{self._made}.db"
        shutil.copy(self._models["sqlite"].removeprefix("sqlite:///"), file)
        return f"sqlite:///{file}"

    def _copied_or_emptied(self) -> str:
        """A copy costs PostgreSQL 7 MB in 300 files, which it takes longer to remove than to write."""
        if not self._used or not self._do(self._used, _emptied_as_made, self._as_made):
            self._used = self._copied()
            self._as_made = str(self._do(self._used, _made_of))
        return self._used

    def _copied(self) -> str:
        model = self._models["postgresql"].rsplit("/", 1)[1]
        return str(self._server("postgresql").copied_database(model))

    def _emptied(self, url: str | None) -> str:
        if url is None or not self._do(url, _truncated):
            url = self._models["mariadb"] = self._first("mariadb")
        return url

    def close(self) -> None:
        """Close the connections."""
        for client in self._clients.values():
            client.close()

    def _do(self, url: str, work: Callable[..., Any], *arguments: Any) -> Any:
        """Do ``work(client, ...)`` on a database, on a new connection where a test has cut the last one.

        False where nobody is let in any more.
        """
        kind = make_url(url).drivername
        client = self._clients.get(kind)
        if client is None or client.url != make_url(url):
            if client is not None:
                client.close()
            client = self._clients[kind] = DatabaseClient(url)
        lost = client.driver.OperationalError, client.driver.InterfaceError
        for _ in range(2):
            try:
                return work(client, *arguments)
            except lost:
                client.close()
        return False


def _made_of(client: DatabaseClient) -> str:
    return str(client.sql(MADE)[0][0])


def _emptied_as_made(client: DatabaseClient, as_made: str) -> bool:
    """Empty a database of PostgreSQL, unless somebody is connected to it or it is made otherwise by now."""
    if client.sql(CLIENTS) != [(0,)] or client.sql(MADE) != [(as_made,)]:
        return False
    full = {name for (name,) in client.sql(FULL)}
    for table in reversed(metadata.sorted_tables):
        if table.name in full:
            client.sql(f"delete from {table.name}")  # to truncate a table takes ten times as long
    client.sql(BEGIN_AT_ONE)
    return True


def _truncated(client: DatabaseClient) -> bool:
    """Empty a database of MariaDB, unless it is made otherwise by now."""
    there = {name for (name,) in client.sql("show tables")}
    if there != {*metadata.tables, "alembic_version"} or client.sql(MADE_LATER):
        return False
    # What was deleted has used up numbers; only where rows come and go do tests look at them.
    for table in {"rr", "sa"}.union(name for (name,) in client.sql(FULL)):
        client.sql(f"truncate table {table}")
    return True
