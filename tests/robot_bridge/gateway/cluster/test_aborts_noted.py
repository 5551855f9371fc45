"""Aborts that one gateway could not store are noted at the others, until one has stored them."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import msgspec
import pytest

from robot_bridge.core.messages.commands import ABORT_VALID_S
from robot_bridge.core.messages.robots import Abort
from robot_bridge.gateway.cluster import stop_relay
from robot_bridge.gateway.cluster.bus import EVERYBODY, LARGEST_NOTIFICATION
from robot_bridge.gateway.cluster.messages import (
    MOST_ABORTS,
    AbortsNoted,
    AbortsSettled,
    BusMessageError,
    Codec,
    Exchange,
    NotedAbort,
    Wake,
)
from robot_bridge.gateway.cluster.stop_relay import AGAIN_S, ASKED_S, AT_ONCE
from robot_bridge.gateway.commands.active_command import CommandOrder, KeptAbort, UnstoredAborts
from robot_bridge.gateway.fleet.emergency_persistence import AbortJournal
from robot_bridge.gateway.fleet.registration import FleetAborts

KEY = b"k" * 32
OFFSET = 7.0
"""seconds by which the database's clock is ahead of those of the gateways."""


class Fleet:
    """The gateways of a fleet, by name, on one bus; ``now`` is the database's time."""

    def __init__(self, folder, names="abc"):
        self.now, self.folder, self.cut, self.journals = 1.8e9, folder, set(), []
        self.gateways = {name: Gateway(name, self) for name in names}

    def deliver(self, sender, subject, content):
        if sender in self.cut:
            return False
        for name, gateway in self.gateways.items():
            if name not in {sender, *self.cut}:
                gateway.exchange.receive(subject, content)
        return True


class Gateway:
    """What a gateway has of others' Aborts; ``has`` are its robots."""

    def __init__(self, name, fleet):
        self.has, self.sent, self._name, self._fleet = set(), [], name, fleet
        member = SimpleNamespace(clock_offset=OFFSET, database_time=lambda: fleet.now)
        self.exchange = Exchange(name, KEY, [self])
        self.file = fleet.folder / f"{name}.aborts"
        fleet.journals.append(AbortJournal(self.file, "db-1"))
        self.aborts = FleetAborts(fleet.journals[-1], self.exchange, member)
        self.kept = UnstoredAborts(self.aborts)
        self.aborts.serve(self)

    def publish(self, subject, content):
        self.sent.append(Codec(KEY).decode(content))
        return self._fleet.deliver(self._name, subject, content)

    def keep_left(self, left):
        self.kept.keep_left(one for one in left if one.order.robot in self.has)

    def discard_aborts(self, ids):
        self.kept.discard_settled(ids)

    def get(self, robot):
        """Have a robot, as one that says Ready here."""
        self.has.add(robot)
        self.kept.keep_left_for([robot])

    def abort(self, robot, id="abort-0001", **how):
        """Send a robot of this gateway an Abort that cannot be stored."""
        self.has.add(robot)
        order = CommandOrder(id, robot, Abort(), "Ada", "smoke", **how)
        self.kept.keep([order])
        return order

    def store(self):
        """Store what is kept, as once the database is back."""
        for one in self.kept.of(self.kept.robots()):
            self.kept.discard(one.order)
        self.kept.write_notes()

    def in_file(self):
        """Return what the file has for the next gateway of this name, once all is written."""
        self.aborts._write_journal().result()
        return AbortJournal(self.file, "db-1").read(self._fleet.now)

    @property
    def ids(self):
        return [one.order.command for one in self.kept.of(self.kept.robots())]

    @property
    def noted(self):
        return [abort.command for abort in self.aborts._relay.noted]


@pytest.fixture
def fleet(tmp_path, monkeypatch):
    fleet = Fleet(tmp_path)
    monkeypatch.setattr("time.time", lambda: fleet.now - OFFSET)
    yield fleet
    for journal in fleet.journals:
        journal._thread.shutdown()


@pytest.fixture
def abc(fleet):
    return fleet.gateways.values()


def test_the_gateway_that_gets_the_robot_has_it_as_it_was_asked_for(fleet, abc):
    a, b, c = abc
    order = a.abort("r1", expires_in=60.0, aborts="target-01", of_pause=True)
    assert b.ids == c.ids == []
    b.get("r1")
    assert b.kept.of(["r1"]) == [KeptAbort(order, fleet.now - OFFSET, is_left=True)]
    assert b.in_file() == [KeptAbort(order, fleet.now, is_left=True)]


def test_the_file_has_the_database_s_time_and_is_as_right_after_the_computer_s_clock_was_set(
    fleet, abc, monkeypatch
):
    a, *_ = abc
    a.abort("r1")
    asked_at = fleet.now
    a.in_file()
    fleet.now += ABORT_VALID_S - 60.0
    monkeypatch.setattr("time.time", lambda: fleet.now + 3600.0)
    a = fleet.gateways["a"] = Gateway("a", fleet)
    a.kept.restore({"r1"}.__contains__)
    assert [abort.at for abort in a.aborts._relay.noted] == [asked_at]


def test_a_gateway_that_has_the_robot_when_it_hears_of_it_has_it_at_once(abc):
    a, b, _ = abc
    b.has.add("r1")
    a.abort("r1")
    assert b.ids == ["abort-0001"]


def test_a_pause_that_succeeds_at_whichever_gateway_ends_what_failed_ones_have_left(abc):
    a, b, c = abc
    b.has.add("r1")
    a.abort("r1", of_pause=True)
    a.abort("r2", "abort-0002", of_pause=True)
    a.abort("r1", "abort-0003", aborts="target-01")
    c.aborts.withdraw_pauses(["r1"])
    assert [gateway.noted for gateway in abc] == [["abort-0002", "abort-0003"]] * 3
    assert b.ids == ["abort-0003"]
    # Or at the one that has the robot.
    a.abort("r1", "abort-0004", of_pause=True)
    with b.kept.replacing_failed_pauses("r1"):
        assert b.ids == ["abort-0003"]
    b.kept.write_notes()
    assert [gateway.noted for gateway in abc] == [["abort-0002", "abort-0003"]] * 3


def test_who_noted_it_by_a_clock_that_is_ahead_forgets_it_too(fleet, abc, monkeypatch):
    a, b, _ = abc
    monkeypatch.setattr("time.time", lambda: fleet.now + 3600.0)
    a.abort("r1")
    b.get("r1")
    b.store()
    assert [gateway.noted for gateway in abc] == [[], [], []]


def test_once_one_has_stored_it_nobody_keeps_it_or_takes_it_in_again(fleet, abc):
    a, b, c = abc
    a.abort("r1")
    b.get("r1")
    b.store()
    for gateway in abc:
        assert gateway.ids == gateway.noted == gateway.in_file() == []
        gateway.get("r1")
        assert gateway.ids == []
    # A gateway that was cut off from the bus meanwhile says it once more, and is told.
    late = NotedAbort("abort-0001", "r1", "Ada", fleet.now)
    c.aborts._relay._noted["abort-0001"] = late
    c.exchange.send(EVERYBODY, AbortsNoted("c", [late]))
    assert [gateway.noted for gateway in abc] == [[], [], []]


def test_one_that_is_asked_for_again_later_is_another_one(fleet, abc):
    """Its id is one that was refused before."""
    a, b, _ = abc
    a.kept.discard(a.abort("r1"))
    a.kept.write_notes()
    assert b.noted == []
    fleet.now += 1.0
    a.abort("r1")
    assert b.noted == ["abort-0001"]


def test_what_the_bus_did_not_take_is_sent_once_it_does(fleet, abc):
    a, b, _ = abc
    fleet.cut = {"a"}
    a.abort("r1")
    a.store()
    a.abort("r2", "abort-0002")
    assert b.noted == []
    fleet.cut = set()
    a.aborts._relay.send_changes()
    assert b.noted == ["abort-0002"]
    a.sent.clear()
    a.aborts._relay.send_changes()
    assert a.sent == []


def test_a_gateway_that_comes_is_sent_what_is_known_by_whoever_knows_it(fleet, abc):
    a, b, _ = abc
    a.abort("r1")
    fleet.cut, fleet.gateways["d"] = {"a"}, Gateway("d", fleet)
    d, before = fleet.gateways["d"], fleet.now
    d.exchange.wake("positions")
    b.aborts._relay.send_changes()
    assert d.noted == [] and fleet.now == before, "asked for by many, it is sent once"
    fleet.now += ASKED_S
    d.exchange.wake("positions")
    b.aborts._relay.send_changes()
    assert d.noted == ["abort-0001"]
    assert Wake("d", "positions") in d.sent


async def run_once(gateway, monkeypatch):
    """Let the work of a gateway do what it does once a second."""

    async def sleep(_seconds):
        if sleep.is_over:
            raise StopAsyncIteration
        sleep.is_over = True

    sleep.is_over = False
    monkeypatch.setattr(stop_relay, "asyncio", SimpleNamespace(sleep=sleep))
    with pytest.raises((StopAsyncIteration, RuntimeError)):
        await gateway.aborts.run()


async def test_all_is_sent_again_and_dropped_after_a_day(fleet, abc, monkeypatch, caplog):
    a, b, _ = abc
    a.abort("r1")
    b.aborts._relay._noted.clear()
    fleet.now += AGAIN_S
    await run_once(a, monkeypatch)
    assert b.noted == ["abort-0001"]
    fleet.now += ABORT_VALID_S
    await run_once(b, monkeypatch)
    assert b.noted == [] and "Abort abort-0001 of robot 'r1' is dropped: it is too old" in caplog.text
    a.in_file()
    await run_once(a, monkeypatch)
    a.aborts._journal._thread.submit(int).result()
    assert a.ids == a.noted == [] and not a.file.exists()


def test_what_another_gateway_notes_is_bounded_and_what_this_one_asked_for_is_not(abc, monkeypatch, caplog):
    a, b, _ = abc
    monkeypatch.setattr(stop_relay, "MOST_NOTED", 2)
    for number in range(4):
        a.abort(f"r{number}", f"abort-000{number}")
    assert len(a.noted) == 4 and b.noted == ["abort-0000", "abort-0001"]
    warning = "more than 2 Aborts are not stored: further ones of gateway a are not noted here"
    assert sum(warning in text for text in caplog.messages) == 2, "two are left out at each of two gateways"
    b.abort("r9", "abort-0009")
    assert b.noted == ["abort-0000", "abort-0001", "abort-0009"]


@pytest.mark.parametrize("cut", [set(), {"a"}], ids=["bus", "no bus"])
def test_what_is_remembered_of_stored_ones_is_bounded(fleet, abc, monkeypatch, cut):
    a, *_ = abc
    fleet.cut = cut
    monkeypatch.setattr(stop_relay, "MOST_SETTLED", 2)
    for number in range(4):
        a.abort("r1", f"abort-000{number}")
        a.store()
    assert list(a.aborts._relay._settled) == ["abort-0002", "abort-0003"]
    assert list(a.aborts._relay._unsaid) == (["abort-0002", "abort-0003"] if cut else [])


def test_the_aborts_of_a_whole_fleet_are_sent_in_messages_that_each_bus_takes(abc):
    a, b, _ = abc
    ids = [f"abort-{number:04}" for number in range(1500)]
    a.has.update(f"robot-{id}" for id in ids)
    a.kept.keep(CommandOrder(id, f"robot-{id}", Abort(), "A" * 300, "x\ny" * 300) for id in ids)
    # A bus drops the oldest of too many.
    assert len(a.sent) == AT_ONCE
    while len(b.noted) < len(ids):
        before = len(b.noted)
        a.aborts._relay.send_changes()
        assert len(b.noted) > before
    assert b.noted == ids
    assert max(len(Codec(KEY).encode(one)) for one in a.sent) <= LARGEST_NOTIFICATION


def test_what_is_heard_while_the_file_is_written_is_written_at_once_afterwards(abc, monkeypatch):
    a, b, _ = abc
    written, write = [], b.aborts._journal._write_text
    monkeypatch.setattr(b.aborts._journal, "_write_text", lambda text: (written.append(text), write(text)))
    disk = threading.Event()
    b.aborts._journal._thread.submit(disk.wait, 60.0)
    for number in range(5):
        a.abort(f"r{number}", f"abort-000{number}")
    a.kept.discard_settled({"abort-0003"})
    a.kept.write_notes()
    disk.set()
    ids = ["abort-0000", "abort-0001", "abort-0002", "abort-0004"]
    assert [one.order.command for one in b.in_file()] == ids
    # One more is what in_file has written, if it came too late for the first one.
    assert len(written) <= 2


def test_those_of_a_whole_fleet_are_forgotten_everywhere_once_they_are_stored(abc):
    a, b, _ = abc
    ids = [f"abort-{number:04}" for number in range(1500)]
    b.has.update(f"robot-{id}" for id in ids)
    a.kept.keep(CommandOrder(id, f"robot-{id}", Abort(), "Ada") for id in ids)
    assert b.ids == b.noted == ids
    a.store()
    assert [gateway.ids for gateway in abc] == [gateway.noted for gateway in abc] == [[], [], []]


def test_the_file_of_a_gateway_that_comes_back_is_for_whoever_has_the_robots(fleet, abc):
    """Nobody heard of its Abort: the bus was away, too."""
    a, b, _ = abc
    fleet.cut = {"a"}
    order = a.abort("r1")
    assert [one.order for one in a.in_file()] == [order]
    b.has.add("r1")
    fleet.cut = set()
    a = fleet.gateways["a"] = Gateway("a", fleet)
    a.kept.restore({"r1"}.__contains__)
    assert (a.kept.robots(), a.noted) == ([], ["abort-0001"])
    assert [one.order for one in b.kept.of(["r1"])] == [order]
    b.store()
    assert a.noted == a.in_file() == []


@pytest.mark.parametrize(
    "wrong", [{"robot": "no name"}, {"command": "short"}, {"aborts": "short"}, {"at": float("nan")}]
)
def test_an_abort_that_cannot_be_is_refused_where_messages_are_decoded(wrong):
    good = NotedAbort("abort-0001", "r1", "Ada", 1000.0)
    codec = Codec(KEY)
    assert codec.decode(codec.encode(AbortsNoted("a", [good]))) == AbortsNoted("a", [good])
    bad = codec.encode(AbortsNoted("a", [good, msgspec.structs.replace(good, **wrong)]))
    with pytest.raises(BusMessageError):
        codec.decode(bad)


@pytest.mark.parametrize(
    "message",
    [
        AbortsNoted("a", [NotedAbort("abort-0001", "r1", "Ada", 1000.0)] * (MOST_ABORTS + 1)),
        AbortsSettled("a", {f"abort-{number:04}": 1.0 for number in range(MOST_ABORTS + 1)}),
    ],
)
def test_so_are_more_than_a_message_has(message):
    codec = Codec(KEY)
    with pytest.raises(BusMessageError):
        codec.decode(codec.encode(message))


def test_a_message_of_a_newer_version_ends_nothing(abc, caplog):
    """What gateways of an earlier version do with these, while the fleet is upgraded."""
    _, b, _ = abc
    newer = msgspec.defstruct("Newer", [("gw", str)], tag="newer", array_like=True)
    b.exchange.receive(EVERYBODY, Codec(KEY).encode(newer("a")))
    assert "a message that cannot be read" in caplog.text
    assert caplog.records[-1].levelname == "WARNING"
