"""A layer in a PostGIS whose server no longer answers."""

from __future__ import annotations

import contextlib
import functools
import threading
from collections.abc import Iterator

from sqlalchemy import make_url

from tests.support.databases.frozen_server import frozen
from tests.support.databases.postgresql import PostgreSql
from tests.support.patience import BUSY

THAWS_AFTER = 20.0
"""Seconds on an idle machine: who waits for the server fails then, and does not wait for ever."""


@functools.cache
def _model(server: PostgreSql) -> str:
    """Make a database with PostGIS, and return its name: a copy takes a tenth of the time."""
    database = make_url(server.new_database()).database
    assert database is not None
    server.sql("create extension postgis", database)
    return database


def layer_in_database(server: PostgreSql, wkt: str, kind: str = "Polygon") -> str:
    """Make a database with a table of one feature in EPSG:32633; return what QGIS opens it by."""
    url = make_url(server.copied_database(_model(server)))
    server.sql(
        f"create table bays (id serial primary key, name text, geom geometry({kind}, 32633));"
        f"insert into bays (name, geom) values ('Bay', ST_GeomFromText('{wkt}', 32633));"
        "grant all on bays to public",
        url.database,
    )
    return (
        f"dbname='{url.database}' host=127.0.0.1 port={server.port} user='{url.username}' "
        f"password='{url.password}' key='id' srid=32633 type={kind} table=\"public\".\"bays\" (geom)"
    )


class Freeze:
    """How a server is: until :meth:`end`, or until nobody can wait for it any longer, it does nothing."""

    def __init__(self, server: PostgreSql) -> None:
        self._stack = contextlib.ExitStack()
        self._lock = threading.Lock()
        self._stack.enter_context(frozen(server))
        self.is_frozen = True
        self._timer = threading.Timer(BUSY * THAWS_AFTER, self.end)
        self._timer.start()

    def end(self) -> None:
        """Have the server answer."""
        self._timer.cancel()
        with self._lock:
            self.is_frozen = False
            self._stack.close()


@contextlib.contextmanager
def frozen_for_layers(server: PostgreSql) -> Iterator[Freeze]:
    """A server that does nothing while what is in here is done."""
    freeze = Freeze(server)
    try:
        yield freeze
    finally:
        freeze.end()
