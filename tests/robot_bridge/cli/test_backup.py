"""A backup holds what the database held, on each kind of database, and comes back whole or not at all."""

import asyncio
import contextlib
import gzip
import json
import os
import secrets
import sqlite3
import stat
import threading
from pathlib import Path

import pytest
from sqlalchemy import insert, select, text

from robot_bridge.core.errors import BridgeError, StoreError
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.backup import back_up, restore, revision_in
from robot_bridge.gateway.storage.database import read_address, run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from robot_bridge.gateway.storage.schema import bridge, metadata
from robot_bridge.gateway.storage.singleton_lock import SingletonLock

ODD = "it's \"odd\" \\ back\\'slash; -- č 火 🚜 %s :x\n\ttab"
BYTES = bytes(range(256)) * 300
COMPARED = sorted(metadata.tables.keys() - {"rr", "bridge"})


OLDER = "0003"
"""A revision that had neither queues nor placements, and fewer columns of commands."""


def put_back(address, file, *, replace=False):
    return asyncio.run(restore(address, file, replace=replace))


def rows():
    """Rows for every table, with everything in them that is easily lost on the way."""
    step = {"command": "c1", "at": 1790000000.123456, "by": ODD}
    robot = {
        "name": "r1",
        "magic": 2**62,
        "link": "sql",
        "received_at": 0.1,
        "ended_in_order": 1,
        "pose": "{}",
    }
    command = {"id": "c1", "robot": "r1", "op": "SetPath", "params": "x" * 200_000, "operator": ODD}
    image = {"robot": "r1", "kind": "image", "object": ODD, "x": 0.1, "y": 0.2, "image": BYTES}
    place = {"theta": 0.1, "v": 1.0, "fix_time": None}
    return {
        "rr": [{"robot": "r1", "op": "Alive", "params": "{}"}],
        "sa": [
            {"robot": "r1", "op": "SetMap", "params": ODD, "payload": BYTES, "urgent": 0},
            {"robot": "r1", "op": "Abort", "params": None, "payload": None, "urgent": 1},
        ],
        "robots": [robot],
        "commands": [{**command, "state": "queued", "sa_id": 900, "created_at": 1.5, "deviation": 1e-9}],
        "command_steps": [{**step, "state": "queued", "reason": text} for text in (None, ODD)],
        "trajectories": [
            {"robot": f"r{n % 7}", "received_at": 1.79e9 + n / 3, "x": n / 7, "y": -n / 11, **place}
            for n in range(300)
        ],
        "observations": [{**image, "received_at": 3.0, "state": "new"}],
        "operators": [{"name": ODD, "role": "viewer", "created_at": 1.0}],
        "tokens": [{"id": "t1", "kind": "operator", "owner": ODD, "hash": "0" * 64, "created_at": 1.0}],
        "audit": [{"at": 1.0, "who": ODD, "action": "send", "done": 1, "detail": ODD}],
    }


def fill(connection):
    for table, found in rows().items():
        connection.execute(insert(metadata.tables[table]), found)
    if connection.dialect.name == "sqlite":
        connection.exec_driver_sql("update sqlite_sequence set seq = 900 where name = 'sa'")


def contents(connection):
    """Every row of every table, but for the times that a server writes in its own way.

    And but for what robots are told of a restore.
    """
    found = {}
    for name in COMPARED:
        columns = [
            column for column in metadata.tables[name].c if (name, column.name) != ("sa", "created_at")
        ]
        rows = (tuple(row) for row in connection.execute(select(*columns)))
        found[name] = sorted((row for row in rows if "Start" not in row), key=repr)
    return found


def identity(connection):
    return connection.scalar(select(bridge.c.value).where(bridge.c.name == "id"))


@pytest.fixture
def address(url):
    address = read_address(url)
    run_once(address, fill)
    return address


@pytest.fixture
def other(request, kind, new_database, tmp_path):
    """Another database, on which robots have accounts where the server has accounts."""
    if kind == "sqlite":
        return read_address(f"sqlite:///{tmp_path}/other.db")
    url = new_database.another(kind)
    admin = read_address(request.getfixturevalue(f"{kind}_server").admin_url(url))
    run_once(admin, lambda c: role_manager_on(c).add_robot(f"bot{secrets.token_hex(4)}", "password"))
    return read_address(url)


def test_what_was_backed_up_is_what_is_restored(address, other, tmp_path, kind):
    file = tmp_path / "backup"
    assert back_up(address, file) == file.stat().st_size
    put_back(other, file)
    assert run_once(other, contents) == run_once(address, contents)
    assert len(run_once(other, contents)["trajectories"]) == 300
    if kind == "postgresql":  # each of its day, so that days can be dropped
        left = run_once(other, lambda c: c.scalar(text("select count(*) from only trajectories_other")))
        assert left == 0
    assert run_once(other, lambda c: c.scalar(select(metadata.tables["rr"].c.id))) is None
    assert [entry.name for entry in tmp_path.iterdir() if entry.name.startswith(".")] == []


def test_a_restored_database_is_another_and_gives_out_new_numbers(address, other, tmp_path):
    file = tmp_path / "backup"
    back_up(address, file)
    put_back(other, file)
    assert run_once(other, identity) not in (None, run_once(address, identity))
    sa = metadata.tables["sa"]
    new = run_once(
        other,
        lambda c: c.execute(insert(sa).values(robot="r1", op="Start", params="{}")).inserted_primary_key[0],
    )
    # Not only above the rows that are there: a command of the backup knows its message by number 900.
    assert new > 900
    step = metadata.tables["command_steps"]
    run_once(other, lambda c: c.execute(insert(step).values(command="c1", state="x", at=1.0, by="x")))


def test_robots_on_sql_are_told_that_a_restored_database_is_another(address, tmp_path):
    """They do not connect, as others do, and would take new messages for those that they have done."""
    file = tmp_path / "backup"
    robot = {"name": "bot", "magic": 1, "link": "sql", "received_at": 1.0, "ended_in_order": 0}
    run_once(address, lambda c: c.execute(insert(metadata.tables["robots"]).values(**robot)))
    back_up(address, file)
    put_back(address, file, replace=True)
    sa = metadata.tables["sa"]
    starts = run_once(
        address, lambda c: c.execute(select(sa.c.params).where(sa.c.robot == "bot", sa.c.op == "Start")).all()
    )
    assert [json.loads(params) for (params,) in starts] == [{"database": run_once(address, identity)}]


REFUSING_IDS = {
    "sqlite": "create trigger no_new_id before update on bridge when new.name = 'id' "
    "begin select raise(abort, 'no new id'); end",
    "postgresql": "alter table bridge add constraint no_new_id check (name <> 'id') not valid",
    "mariadb": "create trigger no_new_id before insert on bridge for each row begin "
    "if new.name = 'id' then signal sqlstate '45000' set message_text = 'no new id'; end if; end",
}


def test_what_cannot_get_a_new_id_is_not_restored_at_all(address, tmp_path, kind, request):
    """Restored under its old one, robots would take new messages for those that they have done."""
    file = tmp_path / "backup"
    back_up(address, file)
    refusing = f"sqlite:///{file}" if kind == "sqlite" else address
    if kind != "sqlite":
        refusing = read_address(request.getfixturevalue(f"{kind}_server").admin_url(str(address)))
    run_once(refusing, lambda c: c.exec_driver_sql(REFUSING_IDS[kind]))
    run_once(address, lambda c: c.execute(metadata.tables["robots"].delete()))
    before = run_once(address, contents), run_once(address, identity)
    with pytest.raises(StoreError, match=r"no.new.id"):
        put_back(address, file, replace=True)
    assert (run_once(address, contents), run_once(address, identity)) == before


def test_a_database_that_holds_something_is_replaced_only_when_told(address, tmp_path):
    file = tmp_path / "backup"
    before = run_once(address, contents)
    back_up(address, file)
    run_once(address, lambda c: c.execute(metadata.tables["robots"].delete()))
    changed = run_once(address, contents)
    with pytest.raises(
        BridgeError, match="is not empty: it has 1 row in commands; back it up, then give --replace"
    ):
        put_back(address, file)
    assert run_once(address, contents) == changed != before
    put_back(address, file, replace=True)
    assert run_once(address, contents) == before


@pytest.fixture
def empty(request, kind, tmp_path):
    """Make an empty database of the kind: ``empty()``."""
    if kind == "sqlite":
        return lambda: read_address(f"sqlite:///{tmp_path}/{secrets.token_hex(4)}.db")
    return lambda: read_address(request.getfixturevalue(f"{kind}_server").new_database())


def test_a_backup_of_an_older_version_is_restored_and_then_upgraded(empty, tmp_path, kind):
    old, new, fresh, file = empty(), empty(), empty(), tmp_path / "backup"
    run_once(old, revisions.create, OLDER)
    stop = {"id": "s1", "at": 1.5, "by": ODD, "reason": None}
    run_once(old, lambda c: c.execute(insert(metadata.tables["emergency_stops"]).values(stop)))
    back_up(old, file)
    assert revision_in(fresh, file) == OLDER
    if kind == "sqlite":  # the tables are in the file
        assert put_back(new, file) == OLDER
    else:
        run_once(new, revisions.create)
        with pytest.raises(StoreError, match=r"another, empty database, .* create --for-backup"):
            put_back(new, file)
        run_once(fresh, revisions.create, revision_in(fresh, file))
        assert put_back(fresh, file) == OLDER
        new = fresh
    assert run_once(new, revisions.upgrade) == OLDER
    assert run_once(new, revisions.differences) == []
    assert [row[:4] for row in run_once(new, contents)["emergency_stops"]] == [tuple(stop.values())]


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
def test_a_backup_is_not_restored_into_older_tables(address, empty, tmp_path):
    old, file = empty(), tmp_path / "backup"
    run_once(old, revisions.create, OLDER)
    back_up(address, file)
    with pytest.raises(StoreError, match=f"are {OLDER}; run first: robot-bridge database upgrade"):
        put_back(old, file)


def test_a_backup_of_a_newer_version_is_refused(address, empty, tmp_path):
    file = tmp_path / "backup"
    run_once(address, lambda c: c.exec_driver_sql("update alembic_version set version_num = '9999'"))
    try:
        back_up(address, file)
    finally:
        needed = f"update alembic_version set version_num = '{revisions.NEEDED}'"
        run_once(address, lambda c: c.exec_driver_sql(needed))
    before = run_once(address, contents)
    with pytest.raises(StoreError, match=r"revision 9999, .*; install the robot-bridge that wrote it"):
        put_back(address, file, replace=True)
    assert run_once(address, contents) == before


def test_nothing_is_restored_under_a_running_gateway(address, tmp_path):
    file = tmp_path / "backup"
    back_up(address, file)
    gateway = SingletonLock(address)
    asyncio.run(gateway.acquire())
    try:
        with pytest.raises(BridgeError, match="a gateway runs on it: process"):
            put_back(address, file, replace=True)
        back_up(address, tmp_path / "another")
    finally:
        asyncio.run(gateway.release())


def test_a_damaged_backup_changes_nothing(address, tmp_path):
    file = tmp_path / "backup"
    back_up(address, file)
    before = run_once(address, contents)
    whole = file.read_bytes()
    middle = len(whole) // 2
    for damaged in (whole[:middle], whole[:middle] + b"\0" * 5000 + whole[middle + 5000 :]):
        file.write_bytes(damaged)
        with pytest.raises(StoreError, match=r"damaged|malformed|not a database"):
            put_back(address, file, replace=True)
        assert run_once(address, contents) == before


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
def test_a_backup_that_the_server_refuses_changes_nothing(address, tmp_path):
    file = tmp_path / "backup"
    back_up(address, file)
    before = run_once(address, contents)
    with gzip.open(file, "ab") as more:
        more.write(b"\ninsert into robots (name) values ('half a row');\n")
    with pytest.raises(StoreError, match=r"psql failed|mariadb failed"):
        put_back(address, file, replace=True)
    assert run_once(address, contents) == before


def test_a_file_that_is_no_backup_or_of_another_kind_is_named(address, tmp_path, kind):
    text, database = tmp_path / "letter", tmp_path / "some.db"
    text.write_text("Dear Ada")
    with pytest.raises(
        StoreError, match=f"letter is no backup, and database .* is {kind}; give a backup of {kind}"
    ):
        put_back(address, text, replace=True)
    sqlite3.connect(database).execute("create table t (i)").connection.close()
    if kind == "sqlite":
        with gzip.open(text, "wb") as file:
            file.write(b"x")
        with pytest.raises(StoreError, match="is of a database server"):
            put_back(address, text, replace=True)
        # A GeoPackage is a database of SQLite, too.
        with pytest.raises(StoreError, match=r"some.db is no backup: it has no tables of the bridge"):
            put_back(address, database, replace=True)
    else:
        with pytest.raises(StoreError, match="is of sqlite, and database"):
            put_back(address, database, replace=True)
        with gzip.open(text, "wb") as file:
            file.write(b'-- robot-bridge backup {"kind": "oracle", "revision": "0002"}\n')
        with pytest.raises(StoreError, match="is of oracle"):
            put_back(address, text, replace=True)
    with pytest.raises(BridgeError, match="nothing cannot be read: No such file"):
        put_back(address, tmp_path / "nothing")


def test_a_backup_is_for_its_owners_eyes_and_replaces_nothing(address, tmp_path):
    file = tmp_path / "backup"
    back_up(address, file)
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    with pytest.raises(BridgeError, match="is there already; choose another name, or give --replace"):
        back_up(address, file)
    assert back_up(address, file, replace=True) > 0
    with pytest.raises(BridgeError, match="cannot be written"):
        back_up(address, tmp_path / "none" / "backup")


@pytest.mark.parametrize("kind", ["sqlite"])
def test_a_database_is_no_backup_of_itself(address):
    file = Path(address.database)
    before = file.stat().st_ino
    with pytest.raises(BridgeError, match="is the database itself"):
        back_up(address, file, replace=True)
    with pytest.raises(BridgeError, match="is the database itself"):
        put_back(address, file, replace=True)
    assert file.stat().st_ino == before


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
def test_a_program_that_is_missing_is_named_and_no_password(address, tmp_path, kind, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(StoreError) as caught:
        back_up(address, tmp_path / "backup")
    assert "is not installed" in str(caught.value) and "-client" in str(caught.value)
    fake = tmp_path / ("pg_dump" if kind == "postgresql" else "mariadb-dump")
    fake.write_text("#!/bin/sh\necho $0 $@ >&2; exit 3\n")
    fake.chmod(0o700)
    with pytest.raises(StoreError, match=f"{fake.name} failed: ") as caught:
        back_up(address, tmp_path / "backup")
    assert str(address.password) not in str(caught.value)
    assert os.listdir(tmp_path) == [fake.name]  # noqa: PTH208


def test_a_backup_comes_to_its_end_while_a_gateway_writes_all_the_time(tmp_path):
    file = tmp_path / "fleet.db"
    address = read_address(f"sqlite:///{file}")
    run_once(address, revisions.create)
    with contextlib.closing(sqlite3.connect(file, isolation_level=None)) as connection:
        connection.execute("insert into bridge values ('filling', ?)", ("x" * 40_000_000,))
    written, ended = [], threading.Event()
    writer = threading.Thread(target=write_on, args=(file, written, ended))
    writer.start()
    backing_up = threading.Thread(target=back_up, args=(address, tmp_path / "backup.db"), daemon=True)
    try:
        backing_up.start()
        backing_up.join(120)
        came_to_its_end = not backing_up.is_alive()
    finally:
        ended.set()
        writer.join()
    assert came_to_its_end
    assert revision_in(address, tmp_path / "backup.db") == revisions.NEEDED
    assert written


def write_on(file, written, ended):
    """Write a row every few milliseconds, as a gateway does."""
    with contextlib.closing(sqlite3.connect(file, timeout=30, isolation_level=None)) as connection:
        while not ended.wait(0.005):
            connection.execute("insert into audit (at, who, action, done) values (1.0, 'Ada', 'send', 1)")
            written.append(1)
