"""Work on a database: all or none, together where it can be, said in one line what is wrong."""

from __future__ import annotations

import asyncio
import shutil
import sqlite3
import threading
import time
from functools import partial
from pathlib import Path

import pytest
from sqlalchemy import insert, select, text

from robot_bridge.core.errors import DataRefusedError, LockedError, StoreError
from robot_bridge.gateway.storage import database as database_module
from robot_bridge.gateway.storage.database import WRONG_AT_ONCE_S, Database
from robot_bridge.gateway.storage.rows import BatchedWork
from robot_bridge.gateway.storage.schema import robots, rr, sa
from tests.support.bridge.busy_database import done_together
from tests.support.databases.database_client import LOCKS, tables_locked
from tests.support.patience import START


@pytest.fixture
async def database(url):
    database = Database(url)
    await database.open()
    yield database
    await database.close()


def add(connection, robot, op="Alive"):
    connection.execute(insert(rr).values(robot=robot, op=op))


def names(connection):
    return list(connection.scalars(select(rr.c.robot).order_by(rr.c.id)))


@pytest.mark.parametrize("how", ["missing folder", "a folder", "no database", "read only"])
async def test_a_file_that_cannot_be_used_is_named(tmp_path, how):
    file = tmp_path / "fleet.db"
    url = f"sqlite:///{file}"
    if how == "missing folder":
        url = f"sqlite:///{tmp_path}/none/fleet.db"
    elif how == "a folder":
        file.mkdir()
    elif how == "no database":
        file.write_bytes(b"this is a letter, not a database\n" * 100)
    else:
        sqlite3.connect(file).close()
        url = f"sqlite:///file:{file}?mode=ro&uri=true"
    database = Database(url)
    with pytest.raises(StoreError, match=r"database sqlite:///.*fleet\.db.*; check that it exists"):
        await database.open()
    await database.close()


@pytest.mark.parametrize("kind", ["sqlite"], indirect=True)
@pytest.mark.parametrize("replaced", [False, True])
async def test_a_file_that_was_taken_away_is_not_written_until_it_is_back(url, replaced):
    database = Database(url)
    file = Path(database.url.database)
    aside = file.with_name(f"{file.name}.aside")
    await database.run(add, "a")
    file.rename(aside)
    if replaced:
        shutil.copy(aside, file)
    for ask in (database.run(add, "lost"), database.write_relaxed(add, "lost"), database.read(names)):
        with pytest.raises(StoreError, match=r"fleet-\d+\.db was taken away or replaced while it was in use"):
            await ask
    aside.rename(file)
    await database.run(add, "b")
    assert await database.read(names) == ["a", "b"]
    await database.close()


@pytest.mark.parametrize("kind", ["sqlite"], indirect=True)
@pytest.mark.parametrize("end", ["-wal", "-shm"])
@pytest.mark.parametrize("replaced", [False, True])
async def test_nothing_goes_into_a_log_that_was_taken_away(url, end, replaced):
    database = Database(url)
    await database.run(add, "a")
    file = Path(f"{database.url.database}{end}")
    aside = file.with_name(f"{file.name}.aside")
    file.rename(aside)
    if replaced:
        shutil.copy(aside, file)
    for ask in (database.run(add, "lost"), database.write_relaxed(add, "lost"), database.read(names)):
        with pytest.raises(StoreError, match=rf"fleet-\d+\.db{end} was taken away or replaced"):
            await ask
    aside.rename(file)
    await database.run(add, "b")
    assert await database.read(names) == ["a", "b"]
    await database.close()


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"], indirect=True)
@pytest.mark.parametrize("wrong", ["port", "password", "database"])
async def test_a_server_that_cannot_be_used_is_named_without_the_password(kind, empty_url, wrong):
    from sqlalchemy import make_url

    url = make_url(empty_url)
    secret = url.password if wrong != "password" else "hunter2"
    url = {
        "port": url.set(port=9),
        "password": url.set(password=secret),
        "database": url.set(database="no_such_database"),
    }[wrong]
    database = Database(url)
    with pytest.raises(
        StoreError, match=rf"database {kind}://fleet:\*\*\*@.*; check that the server"
    ) as caught:
        await database.open()
    await database.close()
    assert secret not in str(caught.value)
    assert "\n" not in str(caught.value)


async def test_work_that_fails_is_rolled_back(database):
    def half(connection):
        add(connection, "r1")
        raise RuntimeError("half way")

    with pytest.raises(RuntimeError, match="half way"):
        await database.run(half)
    assert await database.run(names) == []


async def test_work_that_waits_together_is_committed_together_and_fails_alone(database):
    transactions = []

    def begun(connection, robot):
        transactions.append(connection.get_transaction())
        add(connection, robot)
        if robot == "r7":
            raise RuntimeError(robot)

    first = asyncio.create_task(database.run(lambda connection: names(connection)))
    done = await asyncio.gather(
        first, *(database.run(begun, f"r{n}") for n in range(10)), return_exceptions=True
    )
    assert [str(result) for result in done if isinstance(result, Exception)] == ["r7"]
    assert await database.run(names) == [f"r{n}" for n in range(10) if n != 7]
    transactions.clear()
    await asyncio.gather(*(database.run(begun, f"s{n}") for n in range(10)))
    assert len(set(map(id, transactions))) < 10


class AddAll(BatchedWork):
    """Adds rows of robots but for those that are refused, and notes for which it was asked at once."""

    def __init__(self, refused=()):
        self.calls, self.refused = [], refused

    def do_all(self, connection, asked):
        self.calls.append([robot for (robot,) in asked])
        for (robot,) in asked:
            add(connection, robot)
            if robot in self.refused:
                raise StoreError(f"{robot} is another gateway's")
        return [robot.upper() for (robot,) in asked]


async def test_batched_work_that_waits_is_done_at_once_and_told_in_the_order_in_which_it_was_done(database):
    work, told = AddAll(), []

    async def ask(work, *arguments):
        told.append(await database.run(work, *arguments))

    await done_together(database, ask(work, "r1"), ask(names), ask(work, "r2"), ask(work, "r3"))
    assert work.calls == [["r1", "r2", "r3"]]
    # Who read what the others wrote hears of it after them.
    assert told == ["R1", "R2", "R3", ["r1", "r2", "r3"]]


async def test_batched_work_that_fails_for_one_is_done_for_the_others_by_halves(database):
    work = AddAll(refused=["r2"])
    done = await done_together(database, *(database.run(work, f"r{n}") for n in range(5)))
    assert [isinstance(result, StoreError) for result in done] == [False, False, True, False, False]
    assert list(map(len, work.calls)) == [5, 2, 3, 1, 2]
    assert await database.run(names) == ["r0", "r1", "r3", "r4"]


async def test_work_that_is_refused_fails_nobody_elses_though_the_database_is_slow(database):
    def refuse(_):
        raise StoreError("another gateway has the robot")

    def be_slow(_):
        # Longer than after which the database itself is taken to be at fault.
        time.sleep(WRONG_AT_ONCE_S + 0.1)

    work = [be_slow, refuse, partial(add, robot="r1")]
    done = await done_together(database, *map(database.run, work))
    assert [isinstance(result, StoreError) for result in done] == [False, True, False]
    assert await database.run(names) == ["r1"]


async def test_a_statement_that_is_wrong_fails_nobody_elses_work(database):
    def wrong(connection):
        return connection.execute(text("select 1 from nowhere")).first()

    work = [partial(add, robot="r1"), wrong, partial(add, robot="r2")]
    done = await done_together(database, *map(database.run, work))
    assert [isinstance(result, StoreError) for result in done] == [False, True, False]
    assert await database.run(names) == ["r1", "r2"]


async def test_what_is_committed_is_seen_by_others(database, url):
    await database.run(add, "r1")
    other = Database(url)
    assert await other.run(names) == ["r1"]
    await other.close()


async def test_ids_are_never_used_twice(database):
    def write(connection):
        return connection.execute(insert(sa).values(robot="r1", op="Start")).inserted_primary_key[0]

    first = await database.run(write)
    await database.run(lambda connection: connection.execute(sa.delete()).rowcount)
    assert await database.run(write) > first


async def test_a_value_that_the_database_refuses_is_told_apart_from_a_database_out_of_order(database):
    with pytest.raises(DataRefusedError, match="refuses a value"):
        await database.run(add, None)
    with pytest.raises(StoreError) as caught:
        await database.run(lambda connection: connection.execute(text("select 1 from nowhere")).rowcount)
    assert not isinstance(caught.value, DataRefusedError)
    assert await database.run(names) == []


async def test_names_that_differ_in_a_letters_case_are_two_and_every_number_and_letter_is_kept(database):
    strange = "größer \U0001f916 'quoted' \\ %s :x"

    def write(connection):
        for name in ("r1", "R1"):
            connection.execute(
                insert(robots).values(
                    name=name, magic=2**63 - 1, link="sql", received_at=1790000000.123456, pose=strange
                )
            )

    await database.run(write)
    found = await database.run(lambda c: [tuple(row) for row in c.execute(select(robots).order_by("name"))])
    assert [row[0] for row in found] == ["R1", "r1"]
    assert {row[1:3] for row in found} == {(2**63 - 1, "sql")}
    assert all(row._asdict()["received_at"] == 1790000000.123456 for row in await _rows(database))
    assert all(row._asdict()["pose"] == strange for row in await _rows(database))


async def _rows(database):
    return await database.run(lambda connection: list(connection.execute(select(robots))))


async def test_a_map_of_some_megabytes_is_kept(database):
    content = bytes(range(256)) * (6 << 12)

    def write(connection):
        connection.execute(insert(sa).values(robot="r1", op="SetMap", params="x" * 200_000, payload=content))

    await database.run(write)
    (row,) = await database.run(lambda connection: list(connection.execute(select(sa))))
    assert (row.payload, len(row.params)) == (content, 200_000)


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"], indirect=True)
async def test_two_transactions_that_lock_each_other_out_are_both_done(url):
    one, two = Database(url), Database(url)
    await one.run(add, "a")
    await one.run(add, "b")
    locked = {"a": threading.Event(), "b": threading.Event()}

    def cross(connection, first, second, later=0.0):
        connection.execute(rr.update().where(rr.c.robot == first).values(op="Stopped"))
        locked[first].set()
        assert locked[second].wait(START)
        # PostgreSQL looks for this after a second, after which a wait ends as well: the second to wait has
        # to wait still when the first is refused.
        time.sleep(later)
        connection.execute(rr.update().where(rr.c.robot == second).values(op="Stopped"))

    await asyncio.gather(one.run(cross, "a", "b"), two.run(cross, "b", "a", 0.5))
    await one.close()
    await two.close()


@pytest.mark.parametrize("kind", sorted(LOCKS), indirect=True)
async def test_what_waits_for_a_lock_in_vain_fails_alone_and_soon(url, kind, database):
    def add_counted(connection, robot):
        tried.append(robot)
        add(connection, robot)

    def answer(connection, robot):
        connection.execute(insert(sa).values(robot=robot, op="Start"))

    tried = []
    with tables_locked(url, "rr"):
        asked = [database.run(add_counted, "r1"), database.run(answer, "r2"), database.read(names)]
        refused, done, unread = await done_together(database, *asked)
        assert done is None
        for error in (refused, unread):
            assert isinstance(error, StoreError) and "; somebody else has it locked" in str(error)
        # Together twice, and then by itself.
        assert tried == ["r1"] * 3
        # Known to be locked it is waited for once.
        with pytest.raises(StoreError):
            await database.run(add_counted, "r3")
        assert tried[3:] == ["r3"]
    await database.run(add_counted, "r4")
    assert await database.read(names) == ["r4"]
    assert await database.read(lambda one: list(one.scalars(select(sa.c.robot)))) == ["r2"]


@pytest.mark.parametrize("kind", sorted(LOCKS), indirect=True)
async def test_a_lock_that_is_met_again_and_again_is_waited_for_once_in_a_while(
    url, kind, database, monkeypatch
):
    monkeypatch.setattr(database_module, "LOCKED_FOR_S", 0.5)
    tried, attempts = [], []

    def add_counted(connection, robot):
        tried.append(robot)
        add(connection, robot)

    with tables_locked(url, "rr"):
        until = time.monotonic() + 60.0
        # On a busy machine the next one may come after that while.
        while (attempts.count(2) < 2 or 1 not in attempts) and time.monotonic() < until:
            before = len(tried)
            with pytest.raises(LockedError):
                await database.run(add_counted, "r1")
            attempts.append(len(tried) - before)
    assert attempts[0] == 2 and attempts.count(2) >= 2 and 1 in attempts
