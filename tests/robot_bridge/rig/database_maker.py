"""Databases with the tables of today, made quickly: one of each kind is made in earnest and then copied."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from database_client import DatabaseClient

from robot_bridge.store import revisions
from robot_bridge.store.database import run_once
from robot_bridge.store.schema import metadata

KINDS = ("sqlite", "postgresql", "mariadb")


class DatabaseMaker:
    """Makes databases; ``server`` returns the running server of a kind (see the fixtures)."""

    def __init__(self, folder: Path, server: Callable[[str], object]):
        self._folder = folder
        self._server = server
        self._models: dict[str, str] = {}
        self._made = 0

    def __call__(self, kind: str) -> str:
        """Return the URL of a database of ``kind`` that nothing is in.

        Of MariaDB there is one at a time: it has no quick way to copy a database.
        """
        self._made += 1
        model = self._models.get(kind)
        if kind == "mariadb":
            return self._emptied(model)
        if model is None:
            model = self._models[kind] = self._first(kind)
        if kind == "sqlite":
            file = self._folder / f"fleet-{self._made}.db"
            shutil.copy(model.removeprefix("sqlite:///"), file)
            return f"sqlite:///{file}"
        server, name = self._server(kind), f"copy_{self._made}"
        source = model.rsplit("/", 1)[1]
        server.sql(f'create database "{name}" template "{source}" owner fleet')
        return model.removesuffix(source) + name

    def _first(self, kind: str) -> str:
        url = f"sqlite:///{self._folder}/model.db" if kind == "sqlite" else self._server(kind).new_database()
        run_once(url, revisions.create)
        if kind == "sqlite":
            DatabaseClient(url).sql("pragma wal_checkpoint(truncate)")
        return url

    def _emptied(self, url: str | None) -> str:
        if url is None or not _truncated(url):
            url = self._models["mariadb"] = self._first("mariadb")
        return url


def _truncated(url: str) -> bool:
    client = DatabaseClient(url)
    try:
        there = {name for (name,) in client.sql("show tables")}
        if there != {*metadata.tables, "alembic_version"}:
            return False
        if client.sql(
            "select 1 from information_schema.check_constraints where constraint_schema = database()"
        ):
            return False
        for table in metadata.tables:
            # What was deleted has used up numbers; only where rows come and go do tests look at them.
            if table in ("rr", "sa") or client.sql(f"select 1 from {table} limit 1"):
                client.sql(f"truncate table {table}")
        return True
    finally:
        client.close()
