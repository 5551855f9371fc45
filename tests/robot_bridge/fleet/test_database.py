"""A database that cannot be used is named with what is wrong, and a wrong address with what is right."""

from __future__ import annotations

import sqlite3

import pytest

from robot_bridge.errors import StoreError
from robot_bridge.store.database import Database, open_engine


@pytest.mark.parametrize(
    ("url", "text"),
    [
        ("fleet.db", "database URL 'fleet.db' cannot be read; write it like sqlite:////path/fleet.db"),
        ("postgresql://u@h/d", r"only SQLite is supported; write sqlite:////path/fleet.db"),
    ],
)
def test_an_address_of_no_sqlite_database_is_refused(url, text):
    with pytest.raises(StoreError, match=text):
        open_engine(url)


def test_a_password_in_an_address_is_not_shown():
    with pytest.raises(StoreError) as caught:
        open_engine("postgresql://u:hunter2@h/d")
    assert "hunter2" not in str(caught.value)


@pytest.mark.parametrize("kind", ["missing folder", "a folder", "no database", "read only"])
async def test_a_database_that_cannot_be_used_is_named(tmp_path, kind):
    file = tmp_path / "fleet.db"
    url = f"sqlite:///{file}"
    if kind == "missing folder":
        url = f"sqlite:///{tmp_path}/none/fleet.db"
    elif kind == "a folder":
        file.mkdir()
    elif kind == "no database":
        file.write_bytes(b"this is a letter, not a database\n" * 100)
    else:
        sqlite3.connect(file).close()
        url = f"sqlite:///file:{file}?mode=ro&uri=true"
    database = Database(url)
    with pytest.raises(StoreError, match=r"database sqlite:///.*fleet\.db.*; check that it exists"):
        await database.open()
    await database.close()


async def test_work_that_fails_is_rolled_back(tmp_path):
    database = Database(f"sqlite:///{tmp_path}/fleet.db")
    await database.open()

    def half(connection):
        connection.exec_driver_sql("insert into rr (robot, op) values ('r1', 'Alive')")
        raise RuntimeError("half way")

    with pytest.raises(RuntimeError):
        await database.run(half)
    count = await database.run(lambda c: c.exec_driver_sql("select count(*) from rr").scalar_one())
    await database.close()
    assert count == 0


async def test_ids_are_never_used_twice(tmp_path):
    database = Database(f"sqlite:///{tmp_path}/fleet.db")
    await database.open()

    def add(connection):
        return connection.exec_driver_sql("insert into sa (robot, op) values ('r1', 'Start')").lastrowid

    first = await database.run(add)
    await database.run(lambda c: c.exec_driver_sql("delete from sa"))
    second = await database.run(add)
    await database.close()
    assert second > first
