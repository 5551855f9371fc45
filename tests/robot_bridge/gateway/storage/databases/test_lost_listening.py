"""Whoever listens for new rows hears every client that comes while the database ends its sessions."""

from __future__ import annotations

import asyncio
import contextlib
import socket
from pathlib import Path

import pytest
import uvloop

from robot_bridge.gateway.storage import wakeups
from robot_bridge.gateway.storage.database import Database
from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.database_client import DatabaseClient
from tests.support.patience import BUSY, until

LISTENERS, SERVERS, CLIENTS = 20, 10, 40
LISTENING = "pid from pg_stat_activity where query like 'listen%' and datname = current_database()"
WITHIN = 10.0
"""seconds of an idle machine until the last client has its answer; one that is not heard never has."""
LOOPS = {"uvloop": uvloop.new_event_loop, "asyncio": asyncio.new_event_loop}


async def answer(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    writer.write(await reader.read(1))
    writer.close()


def end_sessions(client: DatabaseClient) -> None:
    """End the listeners' sessions; return when the server has closed its sides of their sockets."""
    backends = client.sql(f"select pg_terminate_backend(pid), {LISTENING}")
    assert len(backends) == LISTENERS
    wait_until(lambda: not any(Path(f"/proc/{pid}").exists() for _, pid in backends))


async def answers_while_sessions_end(url: str) -> list[bytes]:
    """End the sessions of many listeners while many clients come; return what each client was answered."""
    async with contextlib.AsyncExitStack() as stack:
        database, client = Database(url), stack.enter_context(contextlib.closing(DatabaseClient(url)))
        stack.push_async_callback(database.close)
        servers = [await asyncio.start_server(answer, "127.0.0.1", 0) for _ in range(SERVERS)]
        for server in servers:
            stack.callback(server.close)
        for _ in range(LISTENERS):
            wakeup = database.wakeup("sa_r1")
            stack.push_async_callback(wakeup.close)
            await wakeup.wait(found=False)
        await until(lambda: len(client.sql(f"select {LISTENING}")) == LISTENERS)
        # Made before, so that none of them takes a number that a lost connection had.
        sockets = [stack.enter_context(socket.socket()) for _ in range(CLIENTS)]
        # In the loop's own thread: it finds the lost connections and the clients at the same time.
        end_sessions(client)
        for number, one in enumerate(sockets):
            one.connect(servers[number % SERVERS].sockets[0].getsockname())
            one.send(b"!")
            one.settimeout(BUSY * WITHIN)
        return await asyncio.to_thread(lambda: [one.recv(1) for one in sockets])


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
@pytest.mark.parametrize("loop", LOOPS)
def test_whoever_comes_while_sessions_end_is_heard(url, loop: str) -> None:
    with asyncio.Runner(loop_factory=LOOPS[loop]) as runner:
        assert runner.run(answers_while_sessions_end(url)) == [b"!"] * CLIENTS


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
async def test_an_administrators_limit_of_idle_sessions_ends_no_connection_of_a_gateway(url):
    """Else its listener would be cut every few seconds, and robots be heard once a second."""
    database, client = Database(url), DatabaseClient(url)
    client.sql(f'alter database "{database.url.database}" set idle_session_timeout = 10000')
    wakeup = database.wakeup("sa_r1")
    try:
        with await asyncio.to_thread(wakeup._connect) as listener:
            limits = [
                listener.execute("show idle_session_timeout").fetchone()[0],
                await database.read(lambda one: one.exec_driver_sql("show idle_session_timeout").scalar()),
            ]
    finally:
        client.sql(f'alter database "{database.url.database}" reset idle_session_timeout')
        client.close()
        await database.close()
    assert limits == ["0", "0"]


async def test_a_listener_that_is_cut_again_and_again_is_said_once(monkeypatch, caplog):
    monkeypatch.setattr(wakeups, "RETRY_AFTER_S", 0.0)
    monkeypatch.setattr(wakeups, "FALLBACK_S", 0.0)
    wakeup, tried = Database("postgresql://fleet@127.0.0.1:1/fleet").wakeup("sa_r1"), []

    def refused():
        tried.append(None)
        raise OSError("no connection is left" if len(tried) < 4 else "the server is gone")

    monkeypatch.setattr(wakeup, "_connect", refused)
    await wakeup.wait(found=False)
    await until(lambda: len(tried) > 8)
    await wakeup.close()
    assert [record.getMessage().rpartition(": ")[2] for record in caplog.records] == [
        "no connection is left",
        "the server is gone",
    ]
