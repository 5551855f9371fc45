"""The thread that hears stops on NATS: a turn of the loop for each, and no harm whatever befalls it."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import threading
import time
from types import SimpleNamespace
from urllib.parse import urlsplit

import pytest
from nats.aio.transport import TcpTransport

from robot_bridge.gateway.cluster import nats_bus, nats_servers
from robot_bridge.gateway.cluster.bus import EVERYBODY, MOST_WAITING, STOP
from robot_bridge.gateway.cluster.messages import MOST_NAMED, Codec, Exchange, StopCall, StopSeen
from robot_bridge.gateway.cluster.nats_bus import LARGEST_STOP, NatsBus, StopListener
from robot_bridge.gateway.cluster.nats_servers import NatsServers
from tests.support.nats_server import NatsServer
from tests.support.patience import BUSY, until

PREFIX = "fleet.t"
CONNECTED = SimpleNamespace(connected=True)
"""The connection for all messages."""


def threads():
    return [one for one in threading.enumerate() if one.name == "stops from NATS"]


def until_in_place(condition):
    """Wait without a turn of the loop."""
    end = time.monotonic() + 10 * BUSY
    while not condition():
        assert time.monotonic() < end
        # The thread under test needs the interpreter; the loop must have no turn.
        time.sleep(0.005)


def publish(url, *contents, subject=STOP):
    """Publish from elsewhere without a turn of the loop; return when the server has all of it."""
    with socket.create_connection(("127.0.0.1", urlsplit(url).port), timeout=10 * BUSY) as other:
        other.sendall(b'CONNECT {"verbose": false}\r\n')
        for content in contents:
            other.sendall(
                b"PUB %s.%s %d\r\n%s\r\n" % (PREFIX.encode(), subject.encode(), len(content), content)
            )
        other.sendall(b"PING\r\n")
        said = b""
        while b"PONG" not in said:
            said += other.recv(4096)


def listener_on(url, main=CONNECTED):
    return StopListener(NatsServers([url]), PREFIX, main)


@contextlib.asynccontextmanager
async def listening(url):
    """A thread that listens, and what it has heard."""
    heard = []
    listener = listener_on(url)
    async with listener.listening(lambda *message: heard.append(message)):
        await until(lambda: listener._connection.connected)
        yield listener, heard
    await until(lambda: not threads())


@contextlib.asynccontextmanager
async def running(bus, receive):
    task = asyncio.create_task(bus.run(receive))
    try:
        await until(lambda: bus.connected)
        yield task
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


def asked_of_loop(monkeypatch):
    """Return what other threads ask the running loop for, from now on, as soon as it is among its turns."""
    loop, asked = asyncio.get_running_loop(), []

    def ask(*call, _ask=loop.call_soon_threadsafe, **how):
        handle = _ask(*call, **how)
        asked.append(call)
        return handle

    monkeypatch.setattr(loop, "call_soon_threadsafe", ask)
    return asked


# --- what it is for ---------------------------------------------------------------------------------------


async def test_a_stop_takes_one_turn_of_the_loop(nats, monkeypatch):
    """Over the connection for all messages it takes three, each of which may come after those of robots."""
    heard = []
    bus = NatsBus([nats.url], "b", PREFIX)
    async with running(bus, lambda *message: heard.append(message)):
        await until(lambda: bus._stops._connection.connected)
        asked = asked_of_loop(monkeypatch)
        publish(nats.url, b"a stop")
        # The loop stands still meanwhile.
        until_in_place(lambda: asked)
        assert not heard
        await asyncio.sleep(0)
        assert heard == [(STOP, b"a stop")]
        # As it was without the thread, in case that hears nothing.
        await until(lambda: heard == 2 * [(STOP, b"a stop")])


async def test_it_is_connected_once_the_server_has_its_subscription(nats, monkeypatch):
    """nats-py writes the ping of ``flush`` before what still waits to be written: its answer says nothing."""
    written = bytearray()

    class Recorded(TcpTransport):
        def write(self, payload):
            written.extend(payload)
            super().write(payload)

        def writelines(self, payload):
            written.extend(b"".join(payload))
            super().writelines(payload)

    monkeypatch.setattr("nats.aio.client.TcpTransport", Recorded)
    async with listening(nats.url):
        assert b"SUB " in written and written.rindex(b"PING") > written.rindex(b"SUB ")


async def test_it_hears_stops_alone(nats):
    async with listening(nats.url) as (_, heard):
        publish(nats.url, b"a wake", subject=EVERYBODY)
        publish(nats.url, b"a stop")
        await until(lambda: heard)
        assert heard == [(STOP, b"a stop")]


async def test_a_gateway_takes_a_stop_in_once_that_comes_by_both_ways(nats):
    heard, came = [], []
    here, there = (Exchange(name, b"k" * 32, [NatsBus([nats.url], name, PREFIX)]) for name in ("a", "b"))
    there.subscribe(StopCall, heard.append)
    call = StopCall("a", "stop-1", 1000.0, "Ada")

    def receive(subject, content):
        came.append(subject)
        there.receive(subject, content)

    bus = there._buses[0]
    async with running(here._buses[0], here.receive), running(bus, receive):
        await until(lambda: bus._stops._connection.connected)
        assert here.send(STOP, call)
        await until(lambda: len(came) == 2)
        assert heard == [call]
        # One who has not answered is called again, and hears that again.
        assert here.send(STOP, call)
        await until(lambda: len(came) == 4)
        assert heard == [call, call]


# --- what may befall it -----------------------------------------------------------------------------------


@pytest.fixture
def attempts(monkeypatch):
    """How often a connection was tried, which is at short intervals."""
    made = []

    async def connect(self, *how, _connect=NatsServers.connect, **options):
        made.append(self)
        return await _connect(self, *how, **options)

    monkeypatch.setattr(NatsServers, "connect", connect)
    monkeypatch.setattr(nats_bus, "RETRY_S", 0.01)
    return made


async def test_it_hears_again_when_the_server_is_back_and_says_once_why_it_did_not(nats, attempts, caplog):
    async with listening(nats.url) as (listener, heard):
        nats.kill()
        await until(lambda: not listener._connection.connected)
        before = len(attempts)
        await until(lambda: len(attempts) > before + 10)
        said = [one for one in caplog.messages if "some milliseconds later" in one]
        assert said and len(said) == len(set(said))
        nats.start()
        await until(lambda: listener._connection.connected)
        publish(nats.url, b"a stop")
        await until(lambda: heard == [(STOP, b"a stop")])


async def test_it_notices_a_server_that_stands_still(nats):
    async with listening(nats.url) as (listener, heard):
        nats.freeze()
        try:
            await until(lambda: not listener._connection.connected)
        finally:
            nats.kill()
            nats.start()
        await until(lambda: listener._connection.connected)
        publish(nats.url, b"a stop")
        await until(lambda: heard == [(STOP, b"a stop")])


@pytest.mark.parametrize("fault", [asyncio.CancelledError, MemoryError, RuntimeError])
async def test_it_goes_on_whatever_the_client_stumbles_over(nats, attempts, monkeypatch, fault):
    async def fail_once(*how, _disconnection=nats_bus.disconnection):
        if len(attempts) == 1:
            raise fault("of the client")
        await _disconnection(*how)

    monkeypatch.setattr(nats_bus, "disconnection", fail_once)
    async with listening(nats.url) as (listener, heard):
        await until(lambda: len(attempts) == 2 and listener._connection.connected)
        publish(nats.url, b"a stop")
        # A first connection that is not closed yet may hear it as well.
        await until(lambda: (STOP, b"a stop") in heard)


async def test_it_leaves_the_last_connection_of_an_account_to_all_messages(tmp_path, attempts, caplog):
    heard, later = [], "stops of other gateways come some milliseconds later"
    with NatsServer(tmp_path, "max_connections: 1") as server:
        bus = NatsBus([server.url], "b", PREFIX)
        async with running(bus, lambda *message: heard.append(message)):
            await until(lambda: len(attempts) > 5)
            assert bus.connected and not bus._stops._connection.connected
            assert bus.publish(STOP, b"a stop")
            await until(lambda: heard == [(STOP, b"a stop")])
            await until(lambda: any(later in one for one in caplog.messages))
    assert len(caplog.messages) == len(set(caplog.messages))
    # The other one may have been there first, for a moment.
    assert all(later in one or "connecting again until it works" in one for one in caplog.messages)


async def test_a_stop_that_cannot_be_taken_in_keeps_none_after_it(nats, caplog):
    heard = []

    def receive(_subject, content):
        heard.append(content)
        if content == b"bad":
            raise ZeroDivisionError

    listener = listener_on(nats.url)
    async with listener.listening(receive):
        await until(lambda: listener._connection.connected)
        publish(nats.url, b"bad", b"good")
        until_in_place(lambda: len(listener._waiting) == 2)
        await until(lambda: heard == [b"bad", b"good"])
    assert "a stop that a thread heard" in caplog.text


async def test_without_room_for_a_thread_all_else_goes_on(nats, monkeypatch, caplog):
    def start(_thread):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", start)
    bus, heard = NatsBus([nats.url], "b", PREFIX), []
    async with running(bus, lambda *message: heard.append(message)):
        assert bus.publish(STOP, b"a stop")
        await until(lambda: heard == [(STOP, b"a stop")])
    assert "no thread hears stops: can't start new thread" in caplog.text


# --- a flood ----------------------------------------------------------------------------------------------


async def test_what_waits_for_the_loop_is_bounded_and_asked_for_once(nats, monkeypatch):
    async with listening(nats.url) as (listener, heard):
        asked = asked_of_loop(monkeypatch)
        contents = [str(number).encode() for number in range(4 * MOST_WAITING)]
        publish(nats.url, *contents)
        until_in_place(lambda: listener._waiting and listener._waiting[-1] == contents[-1])
        assert len(asked) == 1
        await asyncio.sleep(0)
        assert [content for _, content in heard] == contents[-MOST_WAITING:]
        # And so again.
        publish(nats.url, b"a stop")
        await until(lambda: heard[-1] == (STOP, b"a stop"))


async def test_what_is_too_long_for_a_stop_is_not_handed_over(nats):
    async with listening(nats.url) as (_, heard):
        publish(nats.url, bytes(LARGEST_STOP + 1), bytes(LARGEST_STOP))
        await until(lambda: heard)
        assert [len(content) for _, content in heard] == [LARGEST_STOP]


def test_no_message_of_a_stop_is_too_long():
    names, most = MOST_NAMED * [63 * "r"], 10_000_000
    call = StopCall(32 * "g", 64 * "i", 1e9 + 0.1, 200 * "\U0001f6d1", 600 * "\U0001f6d1", (1 << 63) - 1)
    numbers = 64 * "i", most, most, most
    seen = StopSeen(32 * "g", *numbers, names, names, (1 << 63) - 1, names, most, names, most)
    for message in (call, seen):
        content = Codec(b"k").encode(message)
        assert Codec(b"k").decode(content) == message and len(content) <= LARGEST_STOP


# --- the end ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("how", ["connected", "frozen", "killed"])
async def test_the_thread_ends_with_the_bus(nats, how):
    bus = NatsBus([nats.url], "b", PREFIX)
    try:
        async with running(bus, lambda *_: None) as task:
            await until(lambda: bus._stops._connection.connected)
            assert len(threads()) == 1
            if how != "connected":
                nats.freeze()
            if how == "killed":
                nats.kill()
            task.cancel()
            await until(task.done)
            await until(lambda: not threads())
    finally:
        if how != "connected":
            nats.kill()
            nats.start()


async def test_it_ends_while_a_server_says_nothing(monkeypatch):
    """And no other attempt is made."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        silent.settimeout(10 * BUSY)
        url = f"nats://127.0.0.1:{silent.getsockname()[1]}"
        monkeypatch.setattr(nats_servers, "CONNECT_S", 1000.0)
        async with listener_on(url).listening(lambda *_: None):
            connection, _ = await asyncio.to_thread(silent.accept)
        await until(lambda: not threads())
        connection.close()


async def test_a_thread_that_hangs_keeps_no_gateway_from_its_end(nats, monkeypatch):
    goes_on, began = threading.Event(), threading.Event()

    def hang(*_):
        began.set()
        goes_on.wait()
        raise RuntimeError("it hung")

    monkeypatch.setattr(nats_bus, "disconnection", hang)
    monkeypatch.setattr(nats_bus, "END_S", 0.05)
    listener = listener_on(nats.url)
    try:
        async with asyncio.timeout(10 * BUSY), listener.listening(lambda *_: None):
            await until(began.is_set)
        assert threads()
    finally:
        goes_on.set()
    await until(lambda: not threads())


def test_it_ends_when_the_loop_of_the_gateway_has(nats):
    loop = asyncio.new_event_loop()
    listener, ended = listener_on(nats.url), asyncio.Event()
    assert listener._start(loop, ended) is not None
    until_in_place(lambda: listener._connection.connected)
    loop.close()
    publish(nats.url, b"a stop")
    until_in_place(lambda: not threads())
