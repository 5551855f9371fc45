"""The bus on NATS: connected or not, what is sent over it, and servers that fail or refuse."""

from __future__ import annotations

import asyncio
import socket
import threading
from types import SimpleNamespace
from urllib.parse import urlsplit

import pytest
from sqlalchemy import make_url

from robot_bridge.core.errors import BridgeError
from robot_bridge.gateway.cluster import nats_bus
from robot_bridge.gateway.cluster.bus import EVERYBODY, STOP, own_subject
from robot_bridge.gateway.cluster.cluster import ClusterSettings
from robot_bridge.gateway.cluster.messages import LARGEST, Exchange
from robot_bridge.gateway.cluster.nats_bus import NatsBus, disconnection
from robot_bridge.gateway.cluster.nats_servers import NatsServers, check_server, ping
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
    assert caplog.text.count("robot-bridge is connected again") == 1
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


@pytest.mark.parametrize("answer", [1, 2])
@pytest.mark.parametrize("turns", range(6))
async def test_a_bus_that_is_ended_as_the_server_answers_ends(nats, answer, turns):
    """However many turns of the loop lie between: a gateway may be ended when it has just begun."""
    answers = 0

    async def forward(reader, writer, is_server):
        nonlocal answers
        while content := await reader.read(4096):
            writer.write(content)
            answers += is_server
            if is_server and answers == answer:
                for _ in range(turns):
                    await asyncio.sleep(0)
                running.cancel()

    async def relay(reader, writer):
        of_server = await asyncio.open_connection("127.0.0.1", urlsplit(nats.url).port)
        both = forward(reader, of_server[1], False), forward(of_server[0], writer, True)
        await asyncio.gather(*both, return_exceptions=True)

    async with await asyncio.start_server(relay, "127.0.0.1", 0) as listening:
        url = f"nats://127.0.0.1:{listening.sockets[0].getsockname()[1]}"
        running = asyncio.create_task(NatsBus([url], "a", "fleet.f9").run(lambda *_: None))
        async with asyncio.timeout(20 * BUSY):
            await asyncio.gather(running, return_exceptions=True)
        assert running.cancelled()


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
        with pytest.raises(BridgeError, match=r"[Aa]uthorization.*--bus-password-file"):
            await NatsBus([url], "a", "fleet.f", "wrong").check()


@pytest.mark.usefixtures("nats")
@pytest.mark.parametrize("what", ["publish", "subscribe"])
async def test_an_account_that_may_do_all_but_stop_is_named(tmp_path, what):
    """Each gateway would start, and nobody would hear of it before the first emergency stop."""
    from tests.support.nats_server import NatsServer

    may = {"publish": '"fleet.>"', "subscribe": '"fleet.>"', what: '{allow: "fleet.>", deny: "fleet.*.stop"}'}
    permissions = ", ".join(f"{key}: {value}" for key, value in may.items())
    user = f'{{user: "gw", password: "secret", permissions: {{{permissions}}}}}'
    with NatsServer(tmp_path, f"authorization: {{users: [{user}]}}") as server:
        url = server.url.replace("//", "//gw@")
        with pytest.raises(
            BridgeError, match=r"[Pp]ermissions [Vv]iolation.*fleet\.f\.stop.*has to be allowed"
        ):
            await NatsBus([url], "a", "fleet.f", "secret").check()


@pytest.mark.usefixtures("nats")
async def test_rights_that_are_taken_away_later_are_named_with_what_to_do(tmp_path, caplog):
    from tests.support.nats_server import NatsServer

    config = 'authorization: {{users: [{{user: "gw", password: "secret", permissions: {{publish: "{}"}}}}]}}'
    with NatsServer(tmp_path, config.format("fleet.>")) as server:
        bus = NatsBus([server.url.replace("//", "//gw@")], "a", "fleet.f", "secret")
        await bus.check()
        task = asyncio.create_task(bus.run(lambda *_: None))
        await until(lambda: bus.connected)
        server.reconfigure(config.format("other.>"))
        allowed = "has to be allowed to publish and to subscribe to fleet.f.>"

        def is_said():
            bus.publish(EVERYBODY, b"a wake")
            return allowed in caplog.text

        await until(is_said)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


async def test_who_asks_whether_it_may_speak_is_taken_for_no_other_fleet(nats, caplog):
    """A second gateway of one name asks on what the first one hears."""
    exchange = Exchange("a", b"key", [NatsBus([nats.url], "a", "fleet.f7")])
    task = asyncio.create_task(exchange.run())
    await until(lambda: exchange.connected)
    await NatsBus([nats.url], "a", "fleet.f7").check()
    stranger = NatsBus([nats.url], "b", "fleet.f7")
    other = asyncio.create_task(stranger.run(lambda *_: None))
    await until(lambda: stranger.connected)
    stranger.publish(own_subject("a"), b"from elsewhere")
    await until(lambda: "not signed by this fleet" in caplog.text)
    # Of that one alone.
    assert caplog.text.count("not signed by this fleet") == 1
    for one in (task, other):
        one.cancel()
    await asyncio.gather(task, other, return_exceptions=True)


@pytest.mark.usefixtures("nats")
async def test_over_tls_an_authority_of_ones_own_is_asked_for_and_taken(tmp_path, monkeypatch):
    from robot_bridge.gateway.auth import certificates
    from tests.support.nats_server import NatsServer

    files = certificates.create(tmp_path / "tls", ["localhost"], [])
    tls = f'tls: {{cert_file: "{files.certificate}", key_file: "{files.key}"}}'
    with NatsServer(tmp_path, tls) as server:
        bus = NatsBus([f"tls://localhost:{server.port}"], "a", "fleet.f")
        with pytest.raises(BridgeError, match=r"CERTIFICATE_VERIFY_FAILED.*SSL_CERT_FILE"):
            await bus.check()
        monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "tls" / "ca.pem"))
        await bus.check()


async def test_whoever_is_asked_for_tls_and_has_none_is_sent_nothing():
    """Also no password: it may be anybody who answers in the server's place."""
    said = []

    async def pose_as_server(reader, writer):
        writer.write(b'INFO {"server_id": "x", "version": "2.11.0", "max_payload": 1048576}\r\n')
        said.append(await reader.read(1000))
        writer.close()

    async with await asyncio.start_server(pose_as_server, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        bus = NatsBus([f"tls://gw@127.0.0.1:{port}"], "a", "fleet.f", "secret")
        with pytest.raises(BridgeError, match=r"does not ask for TLS.*or write nats://"):
            await bus.check()
        await until(lambda: said)
    assert said == [b""]


async def test_a_server_that_is_too_old_is_refused_with_the_reason():
    async def answer(reader, writer):
        writer.write(b'INFO {"server_id": "x", "version": "2.9.10", "max_payload": 1048576}\r\n')
        while b"PING" not in await reader.readline():
            pass
        writer.write(b"PONG\r\n")
        await reader.read()
        writer.close()

    async with await asyncio.start_server(answer, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        old = rf"at 127.0.0.1:{port} NATS 2\.9\.10 lets one reader.*install 2\.10\.26 or newer"
        with pytest.raises(BridgeError, match=f"^bus 127.0.0.1:{port}: {old}"):
            await NatsBus([f"nats://127.0.0.1:{port}"], "a", "fleet.f").check()


def test_the_oldest_server_is_taken():
    for minor, patch in ((10, 26), (11, 0)):
        version = SimpleNamespace(major=2, minor=minor, patch=patch)
        url = urlsplit("nats://here:1")
        check_server(
            SimpleNamespace(connected_server_version=version, connected_url=url, max_payload=LARGEST)
        )


@pytest.mark.usefixtures("nats")
async def test_a_server_that_takes_no_large_messages_is_refused(tmp_path):
    """With many robots each message of positions would end the connection."""
    from tests.support.nats_server import NatsServer

    with (
        NatsServer(tmp_path, f"max_payload: {LARGEST - 1}") as server,
        pytest.raises(BridgeError, match=rf"NATS takes messages of {LARGEST - 1} bytes.*set max_payload"),
    ):
        await NatsBus([server.url], "a", "fleet.f").check()


@pytest.mark.parametrize("bus", ["postgresql", "none", "nats://n1:4222", "nats://gw@n1:4222,nats://n2:4222"])
def test_a_password_of_no_account_is_refused(bus):
    database = make_url("postgresql://x@localhost/y")
    with pytest.raises(BridgeError, match=r"nats://ACCOUNT@HOST:PORT, or leave the file out"):
        ClusterSettings("a", bus, "secret").check(database)
    ClusterSettings("a", "nats://gw@n1:4222,tls://gw@n2", "secret").check(database)
    ClusterSettings("a", bus).check(database)


class Connection:
    """A connection to NATS by which ``coming`` messages come between two looks, and which answers or not."""

    def __init__(self, coming, *, answers):
        self.is_connected, self.asked = True, 0
        self._looks, self._coming, self._answers = 0, coming, answers

    @property
    def stats(self):
        self._looks += 1
        return {"in_msgs": self._looks * self._coming}

    async def _send_ping(self, answered):
        self.asked += 1
        if self._answers:
            answered.set_result(True)


@pytest.fixture
def looks(monkeypatch):
    monkeypatch.setattr(nats_bus, "CONNECTED_LOOK_S", 0.001)
    monkeypatch.setattr(nats_bus, "PONG_S", 0.1)


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


async def test_a_late_answer_that_nobody_waits_for_does_not_make_a_connection_deaf(nats, caplog):
    client = await NatsServers([nats.url]).connect("test", None)
    nats.freeze()
    try:
        with pytest.raises(TimeoutError):
            await ping(client, 0.1)
    finally:
        nats.wake()
    await ping(client, BUSY * 5)
    given_up = asyncio.create_task(ping(client, BUSY * 5))
    await asyncio.sleep(0)
    given_up.cancel()
    await ping(client, BUSY * 5)
    assert not client._reading_task.done() and not caplog.records
    await client.close()


async def test_a_client_that_reads_no_more_is_connected_again(nats):
    """As where it stumbles over what it reads; it calls itself connected."""
    heard = []
    bus = NatsBus([nats.url], "a", "fleet.f8")
    task = asyncio.create_task(bus.run(lambda *message: heard.append(message)))
    await until(lambda: bus.connected)
    deaf = bus._connection.client
    deaf._reading_task.cancel()
    await until(lambda: bus._connection.client not in (None, deaf))
    bus.publish(EVERYBODY, b"a wake")
    await until(lambda: heard == [(EVERYBODY, b"a wake")])
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


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
