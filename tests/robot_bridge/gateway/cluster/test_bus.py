"""The buses between gateways: what is sent arrives, and what is not of the fleet counts for nothing."""

from __future__ import annotations

import asyncio
import os
import signal
from base64 import b64decode
from types import SimpleNamespace

import msgspec
import numpy as np
import psycopg
import pytest

from robot_bridge.core import logs
from robot_bridge.core.logs import IN_FULL, WINDOW
from robot_bridge.gateway.cluster import messages
from robot_bridge.gateway.cluster.bus import (
    CHANNEL,
    EVERYBODY,
    LARGEST_NOTIFICATION,
    MOST_WAITING,
    POSITIONS,
    STOP,
    NoBus,
    NotifyBus,
    OutgoingMessages,
    own_subject,
)
from robot_bridge.gateway.cluster.messages import (
    FORM,
    LARGEST,
    MOST_NUMBERED,
    MOST_ROBOTS,
    NAME_BYTES,
    PLACE_BYTES,
    SIGNATURE,
    AbortCall,
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
    batches,
    position_batches,
)
from robot_bridge.gateway.cluster.nats_bus import NatsBus
from robot_bridge.gateway.storage.database import read_address
from tests.support.patience import BUSY, until
from tests.support.processes import freeze

KEY = b"k" * 32
CALL = StopCall("a", "stop-1", 1000.0, "Ada", "a child on the road")


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
    lists = list(batches(long, LARGEST_NOTIFICATION))
    assert [one for some in lists for one in some] == long
    assert all(len(details(*some)) <= LARGEST_NOTIFICATION for some in lists)
    assert len(list(batches(long, LARGEST))) == 1


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


def test_a_fleet_without_a_bus_has_none_that_is_not_connected():
    """Whoever watches over it would be alarmed for ever."""
    exchange = Exchange("a", b"key", [NoBus()])
    assert exchange.connections() == {} and not exchange.connected


def test_one_that_fails_to_take_a_message_in_keeps_it_from_no_other(caplog):
    heard = []
    exchange = Exchange("b", KEY, [])
    exchange.subscribe(StopCall, lambda call: 1 / 0)
    exchange.subscribe(StopCall, heard.append)
    exchange.receive(STOP, Codec(KEY).encode(CALL))
    assert heard == [CALL] and exchange.heard() == ["a"]
    exchange.receive(STOP, Codec(b"other").encode(CALL))
    assert "not signed by this fleet" in caplog.text


def test_each_stop_and_each_answer_is_another_message_and_a_copy_of_one_is_none():
    """It comes by several ways; what is sent again is to be answered again."""
    heard, sender, exchange = [], Recorder(), Exchange("b", KEY, [])
    exchange.subscribe(StopCall, heard.append)
    exchange.subscribe(StopSeen, heard.append)
    said = [CALL, StopSeen("a", "stop-1", 5, 3, 2), StopSeen("a", "stop-1", 5, 4, 2)]
    said += said[:2]
    for message in said:
        Exchange("a", KEY, [sender]).send(STOP, message)
    by_one_way = [content for _, content in sender.sent]
    for content in by_one_way:
        exchange.receive(STOP, content)
    assert heard == said
    for content in by_one_way:
        exchange.receive(STOP, content)
    assert heard == said


def test_what_is_known_of_copies_is_bounded():
    heard, sender, exchange = [], Recorder(), Exchange("b", KEY, [])
    exchange.subscribe(StopCall, heard.append)
    other = Exchange("a", KEY, [sender])
    for _ in range(MOST_NUMBERED + 1):
        other.send(STOP, CALL)
    for _, content in sender.sent:
        exchange.receive(STOP, content)
    exchange.receive(STOP, sender.sent[-1][1])
    assert len(heard) == MOST_NUMBERED + 1 and len(exchange._known) == MOST_NUMBERED


def test_an_earlier_version_numbers_nothing_and_is_heard_each_time():
    heard, exchange = [], Exchange("b", KEY, [])
    exchange.subscribe(StopCall, heard.append)
    fields = msgspec.msgpack.decode(Codec(KEY).encode(CALL)[SIGNATURE + 1 :])
    assert fields[-2:] == [0, ""]
    content = signed(FORM + msgspec.msgpack.encode(fields[:-2]))
    for _ in range(2):
        exchange.receive(STOP, content)
    assert heard == [CALL, CALL]


class Members:
    """A fleet in which gateways that say ``run`` are not, others are."""

    def __init__(self, run):
        self.me = SimpleNamespace(run=run)

    def is_stranger(self, run):
        return run in ("of a copy", "without a lease")

    def is_without_lease(self, run):
        return run == "without a lease"

    def has_read(self, run):
        return run == "of another"


KINDS = (StopCall, StopSeen, Beat, AbortCall, PositionBatch)


@pytest.mark.parametrize(
    ("name", "run", "counts", "heard"),
    [
        ("a", "of another", KINDS, ["a"]),
        # Whether its robots are this fleet's is not known before it was read, or found to serve a copy.
        ("a", "not read", (StopCall, Beat, AbortCall, PositionBatch), []),
        # Of this one's own name: a copy's, or a process that stood still while this one came in its place.
        ("b", "not read", (StopCall, AbortCall), []),
        ("b", "of another", (StopCall, AbortCall), []),
        ("b", "own", (), []),
        # It is cut off from the database, or this one's is a copy of its: it may have robots.
        ("a", "without a lease", (StopCall, AbortCall), []),
    ],
)
def test_who_sent_a_message_is_known_by_the_run_and_stops_count_whoever_it_was(name, run, counts, heard):
    sender, exchange, taken = Recorder(), Exchange("b", KEY, [], Members("own")), []
    for kind in KINDS:
        exchange.subscribe(kind, lambda message: taken.append(type(message)))
    there = Exchange(name, KEY, [sender], Members(run))
    for message in (
        CALL,
        StopSeen(name, "stop-1", 5, 3, 2),
        Beat(name),
        AbortCall(name, "r1", "1"),
        positions(),
    ):
        there.send(STOP, msgspec.structs.replace(message, gw=name))
    for subject, content in sender.sent:
        exchange.receive(subject, content)
    assert (tuple(taken), exchange.heard()) == (tuple(kind for kind in KINDS if kind in counts), heard)
    assert exchange.heard_without_lease() == (["a"] if run == "without a lease" else [])


@pytest.mark.parametrize("name", ["a", "b"])
def test_of_a_copy_of_the_database_stops_alone_count_and_the_log_is_not_flooded(name, caplog):
    """A gateway there may have this one's own name, or that of another one."""
    sender, exchange, heard = Recorder(), Exchange("b", KEY, [], Members("own")), []
    for kind in (StopCall, StopSeen, Beat, AbortCall, PositionBatch):
        exchange.subscribe(kind, heard.append)
    said = [Beat(name), StopSeen(name, "stop-1", 5, 3, 2), positions(), CALL]
    said = [msgspec.structs.replace(message, gw=name) for message in said]
    there = Exchange(name, KEY, [sender], Members("of a copy"))
    for _ in range(100):
        for message in said:
            there.send(STOP, message)
    for subject, content in sender.sent:
        exchange.receive(subject, content)
    assert [type(message) for message in heard] == 100 * [StopCall] and exchange.heard() == []
    assert caplog.text.count(f"gateway {name} serves a copy of this fleet's database") == IN_FULL
    exchange._repeated._runs[("bus", "of the fleet:", STOP)].began -= WINDOW
    exchange._repeated.summarise()
    assert f"{400 - IN_FULL} more such lines" in caplog.text


async def test_lines_of_the_bus_that_were_left_out_are_counted_in_the_log(caplog, monkeypatch):
    monkeypatch.setattr(messages, "COUNT_S", 0.01)
    monkeypatch.setattr(logs, "WINDOW", 0.0)
    exchange = Exchange("b", KEY, [])
    for _ in range(IN_FULL + 2):
        exchange.receive(STOP, b"of another fleet")
    running = asyncio.create_task(exchange.run())
    await until(lambda: "stop: 2 more such lines" in caplog.text)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)


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
    await until(lambda: {subject for subject, _ in heard} == {STOP, EVERYBODY, POSITIONS, "wake.b"})
    assert all(content.decode() == subject for subject, content in heard)


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
    # Without that connection it goes out in its turn. Its thread may still wait for the server's answer.
    bus._thread.submit(bus._stopping.close).result()
    assert bus.publish(STOP, b"another")
    await until(lambda: heard[1:] == [(STOP, b"another")])
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


async def test_an_administrators_limit_of_idle_sessions_does_not_cut_the_bus(fleet_url):
    """It listens all day; a stop that is made while it connects again comes by the database, later."""
    address = read_address(fleet_url)
    owner = psycopg.connect(fleet_url, autocommit=True)
    with owner:
        owner.execute(f'alter database "{address.database}" set idle_session_timeout = 10000')
        bus = NotifyBus(address, "a")
        listening, stopping = await bus._connect(), await asyncio.to_thread(bus._connect_for_stops)
        found = [
            (await (await listening.execute("show idle_session_timeout")).fetchone())[0],
            stopping.execute("show idle_session_timeout").fetchone()[0],
        ]
        await listening.close()
        stopping.close()
        owner.execute(f'alter database "{address.database}" reset idle_session_timeout')
    assert found == ["0", "0"]


async def test_a_bus_ends_while_the_server_hangs(postgresql_server, fleet_url):
    bus = NotifyBus(read_address(fleet_url), "a")
    task = asyncio.create_task(bus.run(lambda *_: None))
    await until(lambda: bus.connected)
    pid = bus._stopping.info.backend_pid
    freeze(pid)
    try:
        assert bus.publish(STOP, b"a stop")
        await asyncio.sleep(0.1)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        await asyncio.wait_for(asyncio.to_thread(bus._thread.shutdown), 20 * BUSY)
    finally:
        os.kill(pid, signal.SIGCONT)


async def test_a_stop_of_before_an_outage_is_not_sent_after_it(fleet_url, monkeypatch):
    """A robot that it was about may have been sent on since."""
    monkeypatch.setattr("robot_bridge.gateway.cluster.bus.RETRY_S", 0.01)
    address = read_address(fleet_url)
    bus, heard = NotifyBus(address, "a"), []
    task = asyncio.create_task(bus.run(lambda *message: heard.append(message)))
    await until(lambda: bus.connected)
    lost, pid = bus._stopping, bus._stopping.info.backend_pid
    freeze(pid)
    try:
        for number in range(3):
            assert bus.publish(STOP, f"before, {number}".encode())
        with psycopg.connect(fleet_url, autocommit=True) as owner:
            owner.execute("select pg_terminate_backend(pid) from pg_stat_activity where query like 'listen%'")
        await until(lambda: bus.connected and bus._stopping is not lost)
        # Its thread is through with them, and the loop with what that has left.
        await asyncio.wrap_future(bus._thread.submit(int))
        assert bus.publish(STOP, b"after")
        await until(lambda: (STOP, b"after") in heard)
        assert heard == [(STOP, b"after")]
    finally:
        os.kill(pid, signal.SIGCONT)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
