"""A gateway on PostgreSQL is notified of new rows while it dozes, and never begins to doze over one."""

from __future__ import annotations

import asyncio
import time

import psycopg
import pytest
from sqlalchemy import delete, insert, make_url, text

from robot_bridge.gateway.storage import wakeups
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.schema import rr, sa
from tests.support.patience import BUSY

pytestmark = pytest.mark.parametrize("kind", ["postgresql"], indirect=True)


@pytest.fixture
async def gateway(url):
    database = Database(url)
    await database.open()
    yield database
    await database.close()


@pytest.fixture
async def robot(url):
    database = Database(url)
    yield database
    await database.close()


@pytest.fixture
async def wakeup(gateway):
    wakeup = gateway.wakeup("rr")
    # The first time it is notified at once, since nobody listened before.
    assert await wakeup.enable_notifications()
    await wakeup.wait(found=False)
    yield wakeup
    await wakeup.close()


@pytest.fixture
def notified(url):
    """Return how many notifications came since the last call: all before one of this connection's own."""
    parts = make_url(url)
    where = {"host": parts.host, "port": parts.port, "user": parts.username, "password": parts.password}
    with psycopg.connect(**where, dbname=parts.database, autocommit=True) as connection:
        came = []
        connection.add_notify_handler(lambda one: came.append(one.channel))
        connection.execute("listen rr")
        connection.execute("listen last")

        def count():
            connection.execute("notify last")
            while "last" not in came:
                connection.execute("select 1")
            before, came[:] = came.index("last"), []
            return before

        yield count


def ask(connection):
    connection.execute(insert(rr).values(robot="r1", op="Alive"))


async def test_only_a_gateway_that_dozes_is_notified_of_a_request(wakeup, robot, notified):
    await robot.run(ask)
    assert notified() == 0
    assert await wakeup.enable_notifications()
    await robot.run(ask)
    assert notified() == 1
    await wakeup.wait(found=False)
    await robot.run(ask)
    assert notified() == 0


async def test_a_gateway_that_dozes_is_notified_that_a_command_was_read_and_of_nothing_else_that_was(
    wakeup, robot, notified
):
    for op in ("Abort", "OpAck"):
        await robot.run(lambda connection, op=op: connection.execute(insert(sa).values(robot="r1", op=op)))
    assert await wakeup.enable_notifications()
    await robot.run(lambda connection: connection.execute(delete(sa).where(sa.c.op == "OpAck")))
    assert notified() == 0
    await robot.run(lambda connection: connection.execute(delete(sa).where(sa.c.op == "Abort")))
    assert notified() == 1


async def test_a_gateway_wakes_at_once_and_sees_what_it_was_notified_of(wakeup, robot):
    took = []
    for _ in range(5):
        assert await wakeup.enable_notifications()
        waiting = asyncio.ensure_future(wakeup.wait(found=False))
        await asyncio.sleep(0.1)
        began = time.monotonic()
        await robot.run(ask)
        await waiting
        took.append(time.monotonic() - began)
    assert min(took) < 0.8  # else it is the second after which it looks unasked


async def test_a_gateway_that_looked_unasked_dozes_on(wakeup, robot, notified, monkeypatch):
    monkeypatch.setattr(wakeups, "FALLBACK_S", 0.01)
    for _ in range(3):
        assert await wakeup.enable_notifications()
        await wakeup.wait(found=False)
    await robot.run(ask)
    assert notified() == 1


async def test_a_gateway_that_has_another_connection_begins_to_doze_again(gateway, wakeup, robot, notified):
    assert await wakeup.enable_notifications()
    await robot.run(
        lambda connection: connection.execute(
            text("select pg_terminate_backend(pid) from pg_locks where locktype = 'advisory'")
        )
    )
    await gateway.run(lambda connection: connection.execute(text("select 1")).all())
    assert await wakeup.enable_notifications()
    await robot.run(ask)
    assert notified() == 1


async def test_no_gateway_begins_to_doze_while_somebody_writes_who_thinks_it_is_awake(
    wakeup, robot, notified
):
    written, go = asyncio.Event(), asyncio.Event()
    loop = asyncio.get_running_loop()

    def write(connection):
        ask(connection)
        loop.call_soon_threadsafe(written.set)
        asyncio.run_coroutine_threadsafe(go.wait(), loop).result(20)

    writing = asyncio.ensure_future(robot.run(write))
    await written.wait()
    assert not await wakeup.enable_notifications()
    go.set()
    await writing
    assert notified() == 0
    assert await wakeup.enable_notifications()


async def test_a_gateway_that_found_something_as_it_began_to_doze_is_awake_again(wakeup, robot, notified):
    assert await wakeup.enable_notifications()
    assert await wakeup.enable_notifications()
    await wakeup.wait(found=True)
    await robot.run(ask)
    assert notified() == 0


async def test_what_a_gateway_was_to_be_notified_of_is_over_with_its_connection(
    gateway, wakeup, robot, notified
):
    assert await wakeup.enable_notifications()
    await gateway.close()
    # The server notices the end of a connection in its own time.
    until = time.monotonic() + 10 * BUSY
    await robot.run(ask)
    while notified() > 0:
        assert time.monotonic() < until
        await robot.run(ask)
