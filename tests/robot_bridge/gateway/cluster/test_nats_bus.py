"""The bus on NATS: connected or not, what is sent over it, and servers that fail or refuse."""

from __future__ import annotations

import asyncio
import socket
import threading
from types import SimpleNamespace
from urllib.parse import urlsplit

import pytest

from robot_bridge.core.errors import BridgeError
from robot_bridge.gateway.cluster import nats_bus
from robot_bridge.gateway.cluster.bus import EVERYBODY, STOP
from robot_bridge.gateway.cluster.nats_bus import NatsBus, check_version, disconnection
from tests.support.faults.proxy import Proxy
from tests.support.patience import BUSY, until


def read_until(connection, wanted):
    """Read what a server sends until it has said what is wanted."""
    content = b""
    while wanted not in content:
        content += connection.recv(4096)
    return content


async def test_a_stop_is_on_its_way_before_the_loop_has_a_turn(nats):
    """Thousands of robots may have theirs before."""
    bus = NatsBus([nats.url], "a", "fleet.f5")
    task = asyncio.create_task(bus.run(lambda *_: None))
    await until(lambda: bus.connected)
    with socket.create_connection(("127.0.0.1", urlsplit(nats.url).port), timeout=10 * BUSY) as other:
        other.sendall(b'CONNECT {"verbose": false}\r\nSUB fleet.f5.> 1\r\nPING\r\n')
        read_until(other, b"PONG")
        assert bus.publish(STOP, b"a stop") and bus.publish(EVERYBODY, b"a wake")
        # The loop stands still meanwhile.
        assert b"a wake" not in read_until(other, b"a stop")
        await until(lambda: not bus._outgoing._others)
        read_until(other, b"a wake")
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


async def test_a_stop_that_cannot_be_written_at_once_is_sent_in_its_turn(nats, monkeypatch):
    heard = []
    bus = NatsBus([nats.url], "a", "fleet.f6")
    task = asyncio.create_task(bus.run(lambda *message: heard.append(message)))
    await until(lambda: bus.connected)
    for fails in ("_transport", "publish"):
        with monkeypatch.context() as patch:
            patch.setattr(bus._connection.client, fails, Fails(), raising=True)
            assert bus.publish(STOP, fails.encode())
        await until(lambda fails=fails: (STOP, fails.encode()) in heard)
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


class Fails:
    """A part of the client that is not what it was."""

    def writelines(self, _lines):
        raise AttributeError("writelines")

    async def __call__(self, *_arguments):
        raise AttributeError("publish")


async def test_what_is_said_while_the_server_is_away_is_not_sent_when_it_is_back(nats, caplog):
    heard = []
    bus = NatsBus([nats.url], "a", "fleet.f2")
    task = asyncio.create_task(bus.run(lambda *message: heard.append(message)))
    await until(lambda: bus.connected)
    nats.kill()
    await until(lambda: not bus.connected)
    assert not bus.publish(STOP, b"old")
    nats.start()
    await until(lambda: bus.connected)
    assert bus.publish(STOP, b"new")
    await until(lambda: heard)
    assert set(heard) == {(STOP, b"new")}
    assert "connecting again until it works" in caplog.text
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


async def test_it_is_connected_only_when_the_server_knows_what_it_listens_to(nats, monkeypatch):
    heard, connected = [], []
    with Proxy(nats.port) as proxy:
        one = NatsBus([nats.url], "a", "fleet.f3")
        other = NatsBus([f"nats://127.0.0.1:{proxy.port}"], "b", "fleet.f3")
        connect = other._servers.connect

        async def connect_and_stall(*how, **options):
            client = await connect(*how, **options)
            if threading.current_thread() is threading.main_thread():
                if not connected:
                    proxy.stall()
                connected.append(client)
            return client

        monkeypatch.setattr(other._servers, "connect", connect_and_stall)
        tasks = [
            asyncio.create_task(one.run(lambda *_: None)),
            asyncio.create_task(other.run(lambda *message: heard.append(message))),
        ]
        try:
            await until(lambda: one.connected and connected)
            await asyncio.sleep(0.5)
            assert not other.connected
            proxy.forward()
            await until(lambda: other.connected)
            assert one.publish(STOP, b"a stop")
            await until(lambda: (STOP, b"a stop") in heard)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)


@pytest.mark.parametrize("how", ["it says nothing of it", "what is sent fails"])
async def test_a_client_that_fails_is_taken_for_lost_and_another_one_connects(nats, monkeypatch, how):
    heard = []
    bus = NatsBus([nats.url], "a", "test-lost")
    running = asyncio.create_task(bus.run(lambda subject, content: heard.append(content)))
    try:
        await until(lambda: bus.connected)
        first = bus._connection.client

        def fail(*_):
            raise RuntimeError("the handler is closed")

        if how == "it says nothing of it":
            # As it is left where its own task fails as it closes the connection.
            first._reading_task.cancel()
            first._process_disconnect()
        else:
            monkeypatch.setattr(first, "publish", fail)
            bus.publish(STOP, b"lost")
        await until(lambda: bus.connected and bus._connection.client is not first)
        bus.publish(STOP, b"a stop")
        await until(lambda: b"a stop" in heard)
        assert b"lost" not in heard
    finally:
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)


async def test_a_server_that_is_not_there_is_named():
    with pytest.raises(BridgeError, match=r"^bus 127.0.0.1:1: .*check that NATS runs there"):
        await NatsBus(["nats://127.0.0.1:1"], "a", "fleet.f").check()


@pytest.mark.usefixtures("nats")
async def test_an_account_that_may_not_speak_is_named(tmp_path):
    from tests.support.nats_server import NatsServer

    may = 'permissions: {publish: "other.>", subscribe: "fleet.>"}'
    config = f'authorization: {{users: [{{user: "gw", password: "secret", {may}}}]}}'
    with NatsServer(tmp_path, config) as server:
        url = server.url.replace("//", "//gw@")
        with pytest.raises(BridgeError, match=r"[Pp]ermissions [Vv]iolation.*to publish and to subscribe"):
            await NatsBus([url], "a", "fleet.f", "secret").check()
        with pytest.raises(BridgeError, match=r"[Aa]uthorization"):
            await NatsBus([url], "a", "fleet.f", "wrong").check()


def test_a_server_that_is_too_old_is_refused_with_the_reason():
    check_version("here", SimpleNamespace(major=2, minor=10, patch=26))
    check_version("here", SimpleNamespace(major=2, minor=11, patch=0))
    with pytest.raises(BridgeError, match=r"NATS 2\.9\.10 lets one reader.*install 2\.10\.26 or newer"):
        check_version("here", SimpleNamespace(major=2, minor=9, patch=10))


class Connection:
    """A connection to NATS by which ``coming`` messages come between two looks, and which answers or not."""

    def __init__(self, coming, *, answers):
        self.is_connected, self.asked = True, 0
        self._looks, self._coming, self._answers = 0, coming, answers

    @property
    def stats(self):
        self._looks += 1
        return {"in_msgs": self._looks * self._coming}

    async def flush(self, _seconds):
        self.asked += 1
        if not self._answers:
            raise TimeoutError


@pytest.fixture
def looks(monkeypatch):
    monkeypatch.setattr(nats_bus, "CONNECTED_LOOK_S", 0.001)


async def test_a_connection_by_which_nothing_comes_is_asked_and_lost_when_it_does_not_answer(looks):
    connection = Connection(0, answers=False)
    async with asyncio.timeout(BUSY * 10):
        await disconnection(connection, asyncio.Event())
    assert connection.asked == 1


@pytest.mark.parametrize(("coming", "answers"), [(0, True), (1, False)])
async def test_one_that_answers_or_by_which_messages_come_is_not_lost(looks, coming, answers):
    connection, lost = Connection(coming, answers=answers), asyncio.Event()
    waiting = asyncio.create_task(disconnection(connection, lost))
    await until(lambda: connection._looks > 10 * nats_bus.QUIET_LOOKS)
    assert not waiting.done() and (connection.asked > 0) is answers
    lost.set()
    await waiting


async def test_a_server_that_stands_still_is_noticed(nats):
    one = NatsBus([nats.url], "a", "fleet.f4")
    task = asyncio.create_task(one.run(lambda *_: None))
    await until(lambda: one.connected)
    nats.freeze()
    try:
        await until(lambda: not one.connected)
    finally:
        nats.kill()
        nats.start()
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
