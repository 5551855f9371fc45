"""The buses between gateways: what is sent arrives, and what is not of the fleet counts for nothing."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
from base64 import b64decode
from types import SimpleNamespace
from urllib.parse import urlsplit

import numpy as np
import psycopg
import pytest

from robot_bridge.core.errors import BridgeError
from robot_bridge.gateway.cluster import bus
from robot_bridge.gateway.cluster.bus import (
    CHANNEL,
    EVERYBODY,
    LARGEST_NOTIFICATION,
    MOST_WAITING,
    POSITIONS,
    STOP,
    NatsBus,
    NotifyBus,
    OutgoingMessages,
    check_version,
    own_subject,
)
from robot_bridge.gateway.cluster.messages import (
    LARGEST,
    MOST_ROBOTS,
    NAME_BYTES,
    PLACE_BYTES,
    Beat,
    BusMessageError,
    Codec,
    DetailBatch,
    Exchange,
    PositionBatch,
    RobotDetails,
    StopCall,
    StopSeen,
    Wake,
    detail_batches,
    position_batches,
)
from robot_bridge.gateway.storage.database import read_address
from tests.support.faults.proxy import Proxy
from tests.support.patience import BUSY

KEY = b"k" * 32
CALL = StopCall("a", "stop-1", 1000.0, "Ada", "a child on the road")


async def until(condition, seconds=10.0):
    async with asyncio.timeout(BUSY * seconds):
        while not condition():
            await asyncio.sleep(0.005)


def positions(**other):
    whole = {"ids": b"\0\0\0\0", "names": ["r1"], "numbers": 24 * b"\0", "flags": b"\0"}
    return PositionBatch("a", 1.0, 1, **{**whole, **other})


# --- messages ---------------------------------------------------------------------------------------------


def test_a_message_comes_out_as_it_went_in():
    codec = Codec(KEY)
    for message in (CALL, Beat("a"), Wake("a", "steps"), StopSeen("a", "stop-1", 5, 3, 2, ["r1"], [])):
        assert codec.decode(codec.encode(message)) == message
    numbers = np.arange(12, dtype="<f4")
    ids = np.array([7, 8], dtype="<u4").tobytes()
    batch = PositionBatch("a", 1000.0, 1, ids, ["r1", "r2"], numbers.tobytes(), b"\0\1")
    assert codec.decode(codec.encode(batch)).table().tolist() == numbers.reshape(2, 6).tolist()


@pytest.mark.parametrize(
    ("spoilt", "why"),
    [
        (lambda data: data[:-1], "not signed by this fleet"),
        (lambda data: b"", "not signed by this fleet"),
        (lambda data: Codec(b"another").encode(CALL), "not signed by this fleet"),
        (lambda data: bytes(LARGEST + 1), "are the most"),
        (lambda data: signed(b"\x02" + data[17:]), "another version"),
        (lambda data: signed(b"\x01garbage"), "cannot be read"),
        (lambda data: Codec(KEY).encode(Wake("a", "nonsense")), "cannot be read"),
        (lambda data: Codec(KEY).encode(Beat("a" * 33)), "cannot be read"),
        (lambda data: Codec(KEY).encode(positions(numbers=b"")), "numbers of others"),
        (lambda data: Codec(KEY).encode(positions(ids=b"\0")), "numbers of others"),
        (lambda data: Codec(KEY).encode(positions(names=["r1", "r2"])), "numbers of others"),
        (lambda data: Codec(KEY).encode(positions(ids=b"\0\0\0\1")), "a number of 1000000 or more"),
        (lambda data: details(RobotDetails("r1", battery=1.5)), "cannot be read"),
        (lambda data: details(RobotDetails("r1", status=257 * "a")), "cannot be read"),
        (lambda data: details(RobotDetails("r1", paths="by air")), "cannot be read"),
    ],
)
def test_what_is_no_message_of_the_fleet_is_refused(spoilt, why):
    with pytest.raises(BusMessageError, match=why):
        Codec(KEY).decode(spoilt(Codec(KEY).encode(CALL)))


def details(*robots):
    return Codec(KEY).encode(DetailBatch("a", 1.0, list(robots)))


def test_details_of_many_robots_fit_into_messages():
    long = [
        RobotDetails(f"robot-{n}", 0.5, 256 * "ű", 256 * "ő", 0.001, "asks", 128 * "a") for n in range(50)
    ]
    lists = list(detail_batches(long, LARGEST_NOTIFICATION))
    assert [one for some in lists for one in some] == long
    assert all(len(details(*some)) <= LARGEST_NOTIFICATION for some in lists)
    assert len(list(detail_batches(long, LARGEST))) == 1


@pytest.mark.parametrize("largest", [LARGEST, LARGEST_NOTIFICATION])
@pytest.mark.parametrize("letters", [1, 63])
def test_positions_of_any_number_of_robots_fit_into_messages(largest, letters):
    ids = np.arange(24_000, dtype="<u4")
    names = [str(number).rjust(letters, "r") for number in range(12_000)]
    table = np.arange(6 * len(ids), dtype="<f4").reshape(-1, 6)
    flags = bytes(number % 8 for number in range(len(ids)))
    codec = Codec(KEY)
    whole = PositionBatch("a", 1e9 + 0.1, (1 << 62) + 1, ids.tobytes(), names, table.tobytes(), flags)
    sent = [codec.encode(one) for one in position_batches(whole, largest)]
    assert all(len(one) <= largest for one in sent)
    # None is much smaller than it may be, or has more robots.
    needed = sum(map(len, names)) + NAME_BYTES * len(names) + PLACE_BYTES * len(ids)
    assert len(sent) <= 1.1 * needed / largest + len(ids) / MOST_ROBOTS + 1
    heard = [codec.decode(one) for one in sent]
    assert [name for one in heard for name in one.names] == names
    assert np.array_equal(np.concatenate([one.robots() for one in heard]), ids)
    assert np.array_equal(np.concatenate([one.table() for one in heard]), table)
    assert b"".join(one.flags for one in heard) == flags


def signed(content):
    codec = Codec(KEY)
    return codec._signature(content) + content


async def test_a_stop_is_sent_before_what_waits_and_nothing_grows_without_end():
    outgoing = OutgoingMessages()
    for number in range(2 * MOST_WAITING):
        outgoing.add(POSITIONS, str(number).encode())
    outgoing.add(STOP, b"stop")
    assert await outgoing.next() == (STOP, b"stop")
    assert await outgoing.next() == (POSITIONS, str(MOST_WAITING).encode())


class Recorder:
    """A bus that only keeps what it is given."""

    def __init__(self, connected=True):
        self.connected, self.sent = connected, []

    def publish(self, subject, content):
        if self.connected:
            self.sent.append((subject, content))
        return self.connected


def test_stops_and_wakes_go_over_every_bus_and_positions_over_the_first():
    first, second = Recorder(), Recorder()
    exchange = Exchange("a", KEY, [first, second])
    assert exchange.send(STOP, CALL)
    exchange.wake("owners", "b")
    exchange.send(POSITIONS, PositionBatch("a", 1.0, 1, b"", [], b"", b""))
    assert [subject for subject, _ in first.sent] == [STOP, "wake.b", POSITIONS]
    assert [subject for subject, _ in second.sent] == [STOP, "wake.b"]
    assert not Exchange("a", KEY, [Recorder(connected=False)]).send(STOP, CALL)


def test_one_that_fails_to_take_a_message_in_keeps_it_from_no_other(caplog):
    heard = []
    exchange = Exchange("b", KEY, [])
    exchange.subscribe(StopCall, lambda call: 1 / 0)
    exchange.subscribe(StopCall, heard.append)
    exchange.receive(STOP, Codec(KEY).encode(CALL))
    assert heard == [CALL] and exchange.heard() == ["a"]
    exchange.receive(STOP, Codec(b"other").encode(CALL))
    assert "not signed by this fleet" in caplog.text


def test_a_stop_counts_only_under_the_subject_that_is_read_by_itself():
    heard = []
    exchange = Exchange("b", KEY, [])
    exchange.subscribe(StopCall, heard.append)
    exchange.receive(POSITIONS, Codec(KEY).encode(CALL))
    assert heard == []


# --- real servers -----------------------------------------------------------------------------------------


@pytest.fixture(params=["postgresql", "nats"])
def make_bus(request):
    """Make the bus of a gateway: ``make_bus(name)``."""
    if request.param == "nats":
        url = request.getfixturevalue("nats").url
        return lambda name: NatsBus([url], name, "fleet.f1")
    address = read_address(request.getfixturevalue("fleet_url"))
    return lambda name: NotifyBus(address, name)


@pytest.fixture
async def pair(make_bus):
    """Two buses that are connected, and what the second has heard."""
    heard = []
    one, other = make_bus("a"), make_bus("b")
    tasks = [
        asyncio.create_task(one.run(lambda *_: None)),
        asyncio.create_task(other.run(lambda *message: heard.append(message))),
    ]
    await until(lambda: one.connected and other.connected)
    yield one, heard
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def test_each_hears_what_is_for_all_and_what_is_for_itself(pair):
    one, heard = pair
    for subject in (STOP, EVERYBODY, POSITIONS, own_subject("b"), own_subject("c")):
        assert one.publish(subject, subject.encode())
    await until(lambda: len(heard) >= 4)
    assert {subject for subject, _ in heard} == {STOP, EVERYBODY, POSITIONS, "wake.b"}
    assert all(content.decode() == subject for subject, content in heard)


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


async def test_a_stop_is_notified_of_while_the_loop_has_no_turn(fleet_url):
    address = read_address(fleet_url)
    bus, heard = NotifyBus(address, "a"), []
    task = asyncio.create_task(bus.run(lambda *message: heard.append(message)))
    await until(lambda: bus.connected)
    url = address.set(drivername="postgresql").render_as_string(False)
    with psycopg.connect(url, autocommit=True) as other:
        other.execute(f'listen "{CHANNEL}.{STOP}"')
        assert bus.publish(STOP, b"a stop")
        # The loop stands still meanwhile.
        (notification,) = other.notifies(timeout=10 * BUSY, stop_after=1)
        assert b64decode(notification.payload) == b"a stop"
    await until(lambda: heard == [(STOP, b"a stop")])
    # Without that connection it goes out in its turn.
    bus._stopping.close()
    assert bus.publish(STOP, b"another")
    await until(lambda: heard[1:] == [(STOP, b"another")])
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


async def test_a_bus_ends_while_the_server_hangs(postgresql_server, fleet_url):
    bus = NotifyBus(read_address(fleet_url), "a")
    task = asyncio.create_task(bus.run(lambda *_: None))
    await until(lambda: bus.connected)
    pid = bus._stopping.info.backend_pid
    os.kill(pid, signal.SIGSTOP)
    try:
        assert bus.publish(STOP, b"a stop")
        await asyncio.sleep(0.1)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        await asyncio.wait_for(asyncio.to_thread(bus._thread.shutdown), 20 * BUSY)
    finally:
        os.kill(pid, signal.SIGCONT)


async def test_a_stop_that_cannot_be_written_at_once_is_sent_in_its_turn(nats, monkeypatch):
    heard = []
    bus = NatsBus([nats.url], "a", "fleet.f6")
    task = asyncio.create_task(bus.run(lambda *message: heard.append(message)))
    await until(lambda: bus.connected)
    for fails in ("_transport", "publish"):
        heard.clear()
        with monkeypatch.context() as patch:
            patch.setattr(bus._client, fails, Fails(), raising=True)
            assert bus.publish(STOP, b"a stop")
        await until(lambda: heard)
        assert heard == [(STOP, b"a stop")]
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
    assert heard == [(STOP, b"new")]
    assert "connecting again until it works" in caplog.text
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


async def test_it_is_connected_only_when_the_server_knows_what_it_listens_to(nats):
    heard, connected = [], []
    with Proxy(nats.port) as proxy:

        class Delayed(NatsBus):
            async def _connect(self, *how, **options):
                client = await super()._connect(*how, **options)
                if not connected:
                    proxy.stall()
                connected.append(client)
                return client

        one, other = (
            NatsBus([nats.url], "a", "fleet.f3"),
            Delayed([f"nats://127.0.0.1:{proxy.port}"], "b", "fleet.f3"),
        )
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
            await until(lambda: heard == [(STOP, b"a stop")])
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
        first = bus._client

        def fail(*_):
            raise RuntimeError("the handler is closed")

        if how == "it says nothing of it":
            # As it is left where its own task fails as it closes the connection.
            first._reading_task.cancel()
            first._process_disconnect()
        else:
            monkeypatch.setattr(first, "publish", fail)
            bus.publish(STOP, b"lost")
        await until(lambda: bus.connected and bus._client is not first)
        bus.publish(STOP, b"a stop")
        await until(lambda: heard == [b"a stop"])
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
    monkeypatch.setattr(bus, "CONNECTED_LOOK_S", 0.001)


async def test_a_connection_by_which_nothing_comes_is_asked_and_lost_when_it_does_not_answer(looks):
    connection = Connection(0, answers=False)
    async with asyncio.timeout(BUSY * 10):
        await bus.disconnection(connection, asyncio.Event())
    assert connection.asked == 1


@pytest.mark.parametrize(("coming", "answers"), [(0, True), (1, False)])
async def test_one_that_answers_or_by_which_messages_come_is_not_lost(looks, coming, answers):
    connection, lost = Connection(coming, answers=answers), asyncio.Event()
    waiting = asyncio.create_task(bus.disconnection(connection, lost))
    await until(lambda: connection._looks > 10 * bus.QUIET_LOOKS)
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
