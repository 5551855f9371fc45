"""One gateway at a time on a database, on each kind of database."""

import asyncio
import json
import secrets
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
from sqlalchemy import insert, select, text

from robot_bridge.core.errors import BridgeError, FatalError, StoreError
from robot_bridge.core.messages.robots import Abort
from robot_bridge.gateway.storage import singleton_lock
from robot_bridge.gateway.storage.database import Database, open_engine, read_address, run_once
from robot_bridge.gateway.storage.repositories import requests
from robot_bridge.gateway.storage.repositories.metadata import database_id, fact, renew_id
from robot_bridge.gateway.storage.schema import bridge, metadata
from robot_bridge.gateway.storage.singleton_lock import (
    MessageNote,
    SingletonLock,
    check_no_sole_gateway,
    no_gateway,
)
from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.database_server import add_accounts
from tests.support.patience import BUSY, START, until

HOLDER = """
import asyncio, sys
from robot_bridge.gateway.storage.database import read_address
from robot_bridge.gateway.storage.singleton_lock import SingletonLock
async def main():
    await SingletonLock(read_address(sys.argv[1])).acquire()
    print("taken", flush=True)
    await asyncio.sleep(60)
asyncio.run(main())
"""


@pytest.fixture
def address(url):
    return read_address(url)


@pytest.fixture
def held_elsewhere(url):
    """Another process that holds the database."""
    process = subprocess.Popen([sys.executable, "-c", HOLDER, url], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "taken\n"
    yield process
    process.kill()
    process.wait(5)


async def test_a_second_gateway_is_refused_and_told_which_one_runs(address, held_elsewhere):
    with pytest.raises(BridgeError) as caught:
        await SingletonLock(address).acquire()
    assert f"another gateway runs on it: process {held_elsewhere.pid} on " in str(caught.value)
    assert "end that one first, or give this one a database of its own" in str(caught.value)


async def test_the_next_one_takes_over_when_the_first_is_killed(address, held_elsewhere):
    held_elsewhere.send_signal(signal.SIGKILL)
    gateway = SingletonLock(address)
    await gateway.acquire()
    await gateway.release()


async def test_the_next_one_takes_over_when_the_first_ends(address):
    first, second = SingletonLock(address), SingletonLock(address)
    await first.acquire()
    await first.release()
    await second.acquire()
    await second.release()


async def test_the_lock_is_in_nobodys_way(address, kind):
    """Others write the table that is locked, and the rows beside the one that is."""
    gateway = SingletonLock(address)
    await gateway.acquire()
    database = Database(address)
    try:
        await database.run(lambda c: c.execute(insert(bridge).values(name="fact", value="1")))
        names = await database.run(lambda c: set(c.scalars(select(bridge.c.name))))
        assert names >= {"fact"} if kind == "sqlite" else names >= {"fact", "gateway", "gateway_lock"}
    finally:
        await database.close()
        await gateway.release()


@pytest.fixture
def server(kind, request):
    return request.getfixturevalue(f"{kind}_server")


@pytest.fixture
def often(monkeypatch):
    monkeypatch.setattr(singleton_lock, "PING_INTERVAL", 0.1)


async def holding(gateway):
    await gateway.acquire()
    return asyncio.create_task(gateway.hold())


async def holds(gateway):
    try:
        await asyncio.to_thread(gateway._lock.ping)
    except (BridgeError, AssertionError):
        return False
    return True


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
async def test_the_lock_is_taken_again_when_the_server_comes_back(address, server, often, caplog):
    gateway = SingletonLock(address)
    hold = await holding(gateway)
    server.kill()
    await asyncio.sleep(0.5)
    server.start()
    async with asyncio.timeout(10 * BUSY):
        while not await holds(gateway):
            await asyncio.sleep(0.1)
    with pytest.raises(BridgeError, match="another gateway runs on it"):
        await SingletonLock(address).acquire()
    assert not hold.done()
    assert "its lock is taken anew as soon as it is back" in caplog.text
    hold.cancel()
    await gateway.release()


@pytest.mark.parametrize("kind", ["mariadb"])
async def test_a_limit_of_idle_transactions_does_not_cut_the_lock(address, server):
    """Else another gateway could take the database every few seconds."""
    server.sql("set global idle_transaction_timeout = 1, global idle_write_transaction_timeout = 1")
    try:
        lock = singleton_lock.ServerLock(address)
        assert lock.acquire()
        limits = "@@idle_transaction_timeout + @@idle_write_transaction_timeout + "
        limits += "@@idle_readonly_transaction_timeout"
        assert lock._connection.execute(text(f"select {limits}")).scalar_one() == 0
        lock.release()
    finally:
        server.sql("set global idle_transaction_timeout = 0, global idle_write_transaction_timeout = 0")


@pytest.mark.parametrize("kind", ["postgresql"])
async def test_a_lock_that_is_cut_again_and_again_is_said_once(address, often, caplog, monkeypatch):
    gateway, cuts = SingletonLock(address), []

    def cut():
        cuts.append(None)
        raise StoreError("the lock was cut")

    monkeypatch.setattr(gateway._lock, "ping", cut)
    hold = await holding(gateway)
    await until(lambda: len(cuts) > 2)
    assert caplog.text.count("the lock was cut") == 1
    hold.cancel()
    await gateway.release()


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
async def test_a_gateway_that_another_replaced_while_it_was_cut_off_ends(address, server, often):
    gateway = SingletonLock(address)
    hold = await holding(gateway)
    gateway._lock._connection.connection.driver_connection.close()
    other = {"run": "other", "host": "elsewhere", "process": 7, "since": 0}
    run_once_async = asyncio.to_thread(
        run_once,
        address,
        lambda c: c.execute(
            bridge.update().where(bridge.c.name == "gateway").values(value=json.dumps(other))
        ),
    )
    await run_once_async
    with pytest.raises(FatalError, match="another gateway: process 7 on elsewhere, since 1970-01-01"):
        await asyncio.wait_for(hold, START)
    await gateway.release()


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
async def test_a_server_that_does_not_run_is_named_with_what_to_check(kind):
    address = read_address(f"{kind}://fleet@127.0.0.1:1/fleet")
    with pytest.raises(StoreError) as caught:
        async with no_gateway(address, "robot-bridge database upgrade"):
            pass
    assert str(caught.value).startswith(f"database {kind}://fleet@127.0.0.1:1/fleet: ")
    assert "check that the server runs" in str(caught.value)


def test_gateways_of_a_fleet_look_at_a_new_database_at_the_same_moment(new_database):
    """Whoever comes second waits for the rows of the first one, and has them, too."""
    url = new_database("postgresql")
    address = read_address(url)
    waits = """select count(*) from pg_stat_activity
        where datname = current_database() and wait_event_type = 'Lock'"""
    engine, _ = open_engine(address)
    with engine.begin() as first, ThreadPoolExecutor(1) as thread:
        fact(first, singleton_lock.RUN, "{}")
        second = thread.submit(check_no_sole_gateway, address)
        # In one transaction it would see again and again what it saw at first.
        watching = open_engine(address)[0].execution_options(isolation_level="AUTOCOMMIT")
        with watching.connect() as onlooker:
            wait_until(lambda: onlooker.scalar(text(waits)) or second.done())
        assert not second.done()
        first.commit()
        second.result(60)


@pytest.fixture
def own_account(new_database, kind, request):
    """A database with a robot on SQL, as a gateway's own account connects to it."""
    url = new_database.another(kind)
    robot = {"name": "bot", "magic": 1, "link": "sql", "received_at": 1.0, "ended_in_order": 0}
    run_once(read_address(url), lambda c: c.execute(insert(metadata.tables["robots"]).values(**robot)))
    admin = request.getfixturevalue(f"{kind}_server").admin_url(url)
    name = f"gw{secrets.token_hex(4)}"
    return read_address(add_accounts(read_address(url), read_address(admin), [], name)[name])


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
async def test_a_gateways_own_account_may_do_what_an_older_state_needs(own_account, tmp_path, caplog):
    database = Database(own_account)
    try:
        await database.run(requests.add, "bot", Abort())
        await MessageNote(database, tmp_path).check()
        (file,) = tmp_path.iterdir()
        note = json.loads(file.read_text())
        assert note["newest_message"] == 1
        file.write_text(json.dumps({**note, "newest_message": 100}))
        await MessageNote(database, tmp_path).check()
        assert "the newest message that it knows is 1, and 100 was given out" in caplog.text
        told = await database.read(lambda c: [row.op for row in requests.read_answers(c, "bot")])
        assert told == ["Abort", "Start"]
    finally:
        await database.close()


async def test_a_state_folder_that_cannot_be_written_keeps_no_gateway_from_its_work(
    address, tmp_path, caplog
):
    database = Database(address)
    try:
        await database.run(requests.add, "bot", Abort())
        await MessageNote(database, tmp_path / "gone").check()
        assert "cannot be written: No such file or directory" in caplog.text
        assert "may not be noticed at the next start" in caplog.text
        caplog.clear()
        # Nothing is known of what was given out, and nothing is changed.
        await MessageNote(database, tmp_path).check()
        assert "counts as another one" not in caplog.text
    finally:
        await database.close()


@pytest.fixture
def file_address(new_database):
    return read_address(new_database("sqlite"))


@pytest.fixture
async def noting(file_address):
    """A database that has given out one message."""
    database = Database(file_address)
    await database.run(requests.add, "bot", Abort())
    yield database
    await database.close()


def given_out(folder, newest, **other):
    """Have what is noted in a folder say that more messages were given out."""
    (file,) = folder.iterdir()
    file.write_text(json.dumps({**json.loads(file.read_text()), "newest_message": newest, **other}))
    return file


@pytest.mark.parametrize("names", [("a", "b"), ("a", None), (None, "b")])
async def test_what_another_gateway_of_this_computer_has_noted_counts_too(noting, tmp_path, caplog, names):
    await MessageNote(noting, tmp_path, names[0]).check()
    given_out(tmp_path, 100)
    await MessageNote(noting, tmp_path, names[1]).check()
    assert "the newest message that it knows is 1, and 100 was given out" in caplog.text


async def test_what_is_noted_of_another_database_does_not(noting, tmp_path, caplog):
    await MessageNote(noting, tmp_path).check()
    given_out(tmp_path, 100, database="another")
    await MessageNote(noting, tmp_path).check()
    assert "counts as another one" not in caplog.text


async def test_of_two_gateways_that_find_an_older_state_at_one_moment_one_makes_it_another_database(
    noting, tmp_path, caplog, monkeypatch
):
    first, second = MessageNote(noting, tmp_path, "a"), MessageNote(noting, tmp_path, "b")
    await first.check()
    given_out(tmp_path, 100)
    renew = second._renew

    async def renew_after_the_other(*counts):
        await first.check()
        await renew(*counts)

    monkeypatch.setattr(second, "_renew", renew_after_the_other)
    await second.check()
    assert caplog.text.count("counts as another one") == 1
    assert second._id == first._id == await noting.run(database_id)


async def test_a_gateway_that_ends_notes_nothing_of_a_database_that_is_another_one_by_then(noting, tmp_path):
    note = MessageNote(noting, tmp_path)
    await note.check()
    (file,) = tmp_path.iterdir()
    await noting.run(requests.add, "bot", Abort())
    await note.close(10.0)
    assert json.loads(file.read_text())["newest_message"] == 2
    await noting.run(renew_id, await noting.run(database_id))
    await noting.run(requests.add, "bot", Abort())
    await note.close(10.0)
    assert json.loads(file.read_text())["newest_message"] == 2
