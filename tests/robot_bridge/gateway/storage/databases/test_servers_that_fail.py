"""A database server that dies, comes back, or no longer answers: nobody waits for ever, and all goes on."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from functools import partial

import pytest
from sqlalchemy import event, insert, select

from robot_bridge.core.errors import DataRefusedError, StoreError, UncertainError
from robot_bridge.gateway.commands.persistence import write_bare_aborts
from robot_bridge.gateway.storage import database as database_module
from robot_bridge.gateway.storage.database import Database, open_engine, read_address
from robot_bridge.gateway.storage.schema import rr
from tests.support.databases.database_client import DatabaseClient
from tests.support.databases.frozen_server import frozen
from tests.support.patience import BUSY, until

SERVERS = pytest.mark.parametrize("kind", ["postgresql", "mariadb"], indirect=True)


@pytest.fixture
def server(kind, request):
    return request.getfixturevalue(f"{kind}_server")


@pytest.fixture
async def database(url):
    database = Database(url, patience=1.0)
    await database.open()
    yield database
    await database.close()


def add(connection, robot):
    connection.execute(insert(rr).values(robot=robot, op="Alive"))


def names(connection):
    return sorted(connection.scalars(select(rr.c.robot)))


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
async def test_one_that_takes_no_writes_is_named_as_that(url, database):
    """It runs, and the account may use it: to look for either would be in vain."""
    name = f'"{database.url.database}"'
    await database.run(
        lambda one: one.exec_driver_sql(f"alter database {name} set default_transaction_read_only = on")
    )
    reader = Database(url, patience=1.0)
    with pytest.raises(
        StoreError, match=r"cannot execute INSERT.*takes no writes.*default_transaction_read_only"
    ):
        await reader.run(add, "r1")
    await reader.close()


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
async def test_one_without_a_connection_to_spare_is_named_as_that(url, database):
    name = f'"{database.url.database}"'
    await database.run(lambda one: one.exec_driver_sql(f"alter database {name} connection limit 0"))
    other = Database(database.url, patience=1.0)
    with pytest.raises(StoreError, match=r"too many connections.*raise max_connections"):
        await other.run(names)
    await other.close()


@pytest.mark.parametrize("kind", ["mariadb"], indirect=True)
async def test_a_mariadb_without_a_connection_to_spare_is_named_as_that(url, server):
    server.sql("set global max_connections = 10")
    others = [Database(url, patience=1.0) for _ in range(11)]
    try:
        with pytest.raises(StoreError, match=r"Too many connections; raise max_connections"):
            for one in others:
                await one.run(names)
    finally:
        for one in others:
            await one.close()
        server.sql("set global max_connections = default")


async def test_one_that_is_given_no_password_says_where_to_give_it(monkeypatch):
    monkeypatch.delenv("PGPASSWORD", raising=False)
    monkeypatch.setenv("PGPASSFILE", "/nowhere")

    async def ask_for_password(reader, writer):
        # The tests' own servers ask for none. What is 8 bytes long asks for encryption.
        while int.from_bytes(await reader.readexactly(4), "big") == 8:
            await reader.readexactly(4)
            writer.write(b"N")
        writer.write(b"R" + (8).to_bytes(4, "big") + (3).to_bytes(4, "big"))
        await reader.read()
        writer.close()

    async with await asyncio.start_server(ask_for_password, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        other = Database(read_address(f"postgresql://gateway@127.0.0.1:{port}/fleet"), patience=1.0)
        with pytest.raises(
            StoreError, match=r"no password supplied; give the file .*--database-password-file"
        ):
            await other.run(names)
        await other.close()


RULES = {
    "postgresql": (
        "create function out_of_service() returns trigger language plpgsql as "
        "$$ begin raise exception '% is out of service', new.robot; end $$",
        "create trigger out_of_service before insert on rr for each row "
        "when (new.robot = 'r1') execute function out_of_service()",
    ),
    "mariadb": (
        "create trigger out_of_service before insert on rr for each row begin if new.robot = 'r1' then "
        "signal sqlstate '45000' set message_text = 'r1 is out of service'; end if; end",
    ),
}


@contextlib.contextmanager
def trigger(url, kind, statements, name, table):
    """Make an administrator's trigger by ``statements``, on PostgreSQL with a function of the same name."""
    client = DatabaseClient(url)
    for statement in statements[kind]:
        client.sql(statement)
    yield client
    client.sql(f"drop trigger {name}" + (f" on {table}" if kind == "postgresql" else ""))
    if kind == "postgresql":
        client.sql(f"drop function {name}")
    client.close()


@SERVERS
async def test_a_row_that_an_administrators_trigger_refuses_is_refused_as_data(url, kind, database):
    """Else the database would count as out of order, and each robot's rows would wait for that one's."""
    with trigger(url, kind, RULES, "out_of_service", "rr"):
        refused, done = await asyncio.gather(
            database.run(add, "r1"), database.run(add, "r2"), return_exceptions=True
        )
        assert isinstance(refused, DataRefusedError) and "r1 is out of service" in str(refused)
        assert done is None and await database.run(names) == ["r2"]


NO_DELETION = {
    "postgresql": (
        "create function kept() returns trigger language plpgsql as "
        "$$ begin raise insufficient_privilege; end $$",
        "create trigger kept before delete on sa for each row execute function kept()",
    ),
    "mariadb": (
        "create trigger kept before delete on sa for each row "
        "signal sqlstate '42000' set mysql_errno = 1142, message_text = 'command denied'",
    ),
}
REFUSED_DELETION = {
    "postgresql": (
        NO_DELETION["postgresql"][0].replace("insufficient_privilege", "exception 'it is kept'"),
        NO_DELETION["postgresql"][1],
    ),
    "mariadb": (
        "create trigger kept before delete on sa for each row "
        "signal sqlstate '45000' set message_text = 'it is kept'",
    ),
}


@SERVERS
@pytest.mark.parametrize("rule", [NO_DELETION, REFUSED_DELETION], ids=["no right", "refused"])
async def test_an_abort_is_written_where_nothing_can_be_withdrawn(url, kind, database, rule):
    """Read first, it stops the robot; the one behind what waits stops it once more."""
    with trigger(url, kind, rule, "kept", "sa") as client:
        client.sql("insert into sa (robot, op, params) values ('r1', 'SetPosEnd', '{}')")
        writing = partial(write_bare_aborts, robots=["r1"], withdrawn=["SetPosEnd"], emergency=True)
        await database.run(writing)
        found = client.sql("select op from sa where robot = 'r1' order by urgent desc, id")
    assert [op for (op,) in found] == ["Abort", "SetPosEnd", "Abort"]


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
async def test_the_row_that_a_constraint_refuses_is_not_named_with_the_constraint(url, database):
    """It differs each time: a trouble that lasts would be a new one for the log with every attempt."""
    await database.run(
        lambda one: one.exec_driver_sql("alter table rr add constraint no_r1 check (robot <> 'r1')")
    )
    texts = set()
    for _ in range(2):
        with pytest.raises(DataRefusedError, match=r'violates check constraint "no_r1"$') as refused:
            await database.run(add, "r1")
        texts.add(str(refused.value))
    assert len(texts) == 1
    await database.run(lambda one: one.exec_driver_sql("alter table rr drop constraint no_r1"))


@SERVERS
async def test_a_server_that_was_restarted_between_two_pieces_of_work_is_not_noticed(database, server):
    await database.run(add, "before")
    server.kill()
    server.start()
    await database.run(add, "after")
    assert await database.read(names) == ["after", "before"]


@SERVERS
async def test_work_on_a_server_that_is_gone_is_refused_at_once_and_done_when_it_is_back(database, server):
    server.kill()
    began = time.monotonic()
    for work in (database.run, database.read):
        with pytest.raises(StoreError, match="check that the server runs"):
            await work(names)
    assert time.monotonic() - began < 15
    server.start()
    await database.run(add, "r1")
    assert await database.read(names) == ["r1"]


@SERVERS
async def test_nobody_waits_for_a_server_that_no_longer_answers(database, server):
    await database.run(add, "r1")
    began = time.monotonic()
    with frozen(server):
        turns = 0
        work = asyncio.gather(*(database.run(names) for _ in range(3)), return_exceptions=True)
        while not work.done():
            await asyncio.sleep(0.05)
            turns += 1
            assert time.monotonic() - began < 25
        assert [isinstance(error, StoreError) for error in await work] == [True] * 3
    assert turns > 10, "the event loop waited, too"
    assert await database.run(names) == ["r1"]


@SERVERS
def test_a_connection_that_is_lost_before_it_is_cut_ends_no_watch(url):
    engine, dialect = open_engine(read_address(url))
    with engine.connect() as connection:
        driver = connection.connection.driver_connection
        driver.close()
        dialect.interrupt(driver)


@pytest.fixture
async def on_a_file(sqlite_url, monkeypatch):
    """A database whose every statement takes too long, by the watch."""
    monkeypatch.setattr(database_module, "WATCH_INTERVAL_S", 0.01)
    database = Database(sqlite_url)
    await database.open()
    database._worker._patience = -2.0
    yield database
    await database.close()


class LostConnection:
    """Work during which the connection is lost, and whose thread then waits until it is ``cut``."""

    def __init__(self):
        self.driver, self.was_cut = None, threading.Event()

    def __call__(self, connection):
        self.driver = connection.connection.driver_connection
        connection.invalidate()
        assert self.was_cut.wait(10 * BUSY)

    def cut(self, driver):
        if driver is self.driver:
            self.was_cut.set()


async def test_a_connection_that_the_thread_has_seen_lost_is_cut_all_the_same(on_a_file, monkeypatch, caplog):
    """SQLAlchemy raises for such a connection, or makes another one in the loop that asks for it."""
    work = LostConnection()
    monkeypatch.setattr(on_a_file.dialect, "interrupt", work.cut)
    sessions = on_a_file.session
    with pytest.raises(StoreError):
        await on_a_file.run(work)
    assert work.was_cut.is_set() and not caplog.records
    assert await on_a_file.read(names) == []
    assert on_a_file.session == sessions + 1


async def test_a_round_of_the_watch_that_fails_is_followed_by_others(on_a_file, monkeypatch, caplog):
    rounds = []

    def interrupt(driver):
        rounds.append(driver)
        1 / (len(rounds) - 1)

    monkeypatch.setattr(on_a_file.dialect, "interrupt", interrupt)
    goes_on = threading.Event()
    work = asyncio.create_task(on_a_file.run(lambda _connection: goes_on.wait(10 * BUSY)))
    await until(lambda: len(rounds) > 1)
    goes_on.set()
    await work
    assert "cutting the connection to a database that does not answer failed" in caplog.text


@SERVERS
async def test_a_statement_that_takes_too_long_is_ended(database, kind):
    numbers = "information_schema.columns"
    slow = "select pg_sleep(30)"
    if kind == "mariadb":
        slow = f"select count(*) from {numbers} a, {numbers} b, {numbers} c, {numbers} d"
    began = time.monotonic()
    with pytest.raises(StoreError):
        await database.run(lambda connection: connection.exec_driver_sql(slow).first())
    assert time.monotonic() - began < 25
    assert await database.run(names) == []


@SERVERS
async def test_a_connection_lost_during_the_commit_leaves_it_open_whether_it_was_done(database, server):
    def dies_before_it_is_committed(connection):
        add(connection, "r1")
        event.listen(connection, "commit", lambda _: server.kill(), once=True)

    with pytest.raises(UncertainError, match="check that the server runs"):
        await database.run(dies_before_it_is_committed)
    server.start()
    assert await database.run(names) == []


@SERVERS
async def test_a_robot_that_locks_its_rows_keeps_nobody_else_waiting_for_ever(url, kind, database, server):
    other = Database(url)
    await other.run(add, "r1")
    held, free = asyncio.Event(), asyncio.Event()
    loop = asyncio.get_running_loop()

    def hold(connection):
        connection.execute(rr.update().where(rr.c.robot == "r1").values(op="Stopped"))
        loop.call_soon_threadsafe(held.set)
        asyncio.run_coroutine_threadsafe(free.wait(), loop).result(60)

    holding = asyncio.create_task(other.run(hold))
    await held.wait()
    began = time.monotonic()
    with pytest.raises(StoreError):
        await database.run(lambda connection: connection.execute(rr.delete()).rowcount)
    assert time.monotonic() - began < 30
    free.set()
    await holding
    await other.close()


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
async def test_notifications_are_heard_again_after_a_restart(database, server, url):
    wakeup = database.wakeup("rr")
    other = Database(url)

    async def told() -> float:
        """Return how long it takes to hear of a row."""
        await asyncio.sleep(0.1)
        assert await wakeup.enable_notifications()
        began = time.monotonic()
        await other.run(add, "r1")
        await wakeup.wait(found=False)
        return time.monotonic() - began

    async def wait_for_nothing() -> None:
        assert await wakeup.enable_notifications()
        await wakeup.wait(found=False)

    await wait_for_nothing()
    await wait_for_nothing()
    assert min([await told() for _ in range(5)]) < 0.5
    server.kill()
    server.start()
    for _ in range(4):
        await wait_for_nothing()
    assert min([await told() for _ in range(5)]) < 0.5
    await wakeup.close()
    await other.close()
