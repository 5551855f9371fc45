"""Positions across gateways: told when they change, and all of them when somebody may have missed them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import msgspec
import pytest

from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.messages.safety import FenceAlarm, Geofence
from robot_bridge.gateway.cluster import robot_relay
from robot_bridge.gateway.cluster.bus import EVERYBODY, LARGEST_NOTIFICATION
from robot_bridge.gateway.cluster.messages import (
    LARGEST,
    LONGEST_NAME,
    Codec,
    Exchange,
    FencedRobot,
    PositionBatch,
    Wake,
)
from robot_bridge.gateway.cluster.robot_relay import (
    DETAIL_ALL_AGAIN_S,
    FENCE_OLD_S,
    NAMES_AGAIN_S,
    POSITION_ALL_S,
    DetailRelay,
    FenceRelay,
    PositionRelay,
)
from robot_bridge.gateway.model.events import EventBus, FenceJudged, FenceJudgedElsewhere
from robot_bridge.gateway.model.robots import Robots

CODEC = Codec(b"k" * 32)


class Bus:
    connected = True

    def __init__(self):
        self.sent = []

    def publish(self, _subject, content):
        self.sent.append(CODEC.decode(content))
        return self.connected


class Place:
    """A gateway with a robot, at a time that stands still."""

    def __init__(self, name="b"):
        self.bus, self.robots, self.names = Bus(), Robots(), {}
        # The second one carries what is urgent alone.
        self.exchange = Exchange(name, b"k" * 32, [self.bus, Bus()])
        self.now = 1000.0
        membership = SimpleNamespace(database_time=lambda: self.now, clock_offset=0.0)
        self.relay = PositionRelay(self.robots, membership, self.exchange)
        self.details = DetailRelay(self.robots, membership, self.exchange)
        self.robots.ready("r1", 1, "yard", 1000.0)
        self.robots.observe("r1", SendPos(1.0, 2.0, 0.0, 0.0), "yard", 1000.0)

    def tick(self):
        """Return what goes out by the next tick: names of robots, and what others are asked for."""
        self.bus.sent.clear()
        self.relay.send_changes()
        told = []
        for batch in [one for one in self.bus.sent if isinstance(one, PositionBatch)]:
            ids = batch.robots().tolist()
            self.names.update(zip(ids, batch.names, strict=False))
            told += [self.names[id] for id in ids]
        return told, [one.what for one in self.bus.sent if isinstance(one, Wake)]

    async def detailed(self):
        """Return the names of the robots whose details go out next."""
        self.bus.sent.clear()
        await self.details.send_changes()
        return [robot.name for one in self.bus.sent for robot in one.robots]


@pytest.fixture
def place():
    place = Place()
    place.tick()
    assert place.tick() == ([], [])
    return place


def test_what_moved_is_told(place):
    place.robots.observe("r1", SendPos(1.5, 2.0, 0.0, 0.0), "yard", 1000.0)
    assert place.tick() == (["r1"], [])


def test_a_gateway_whose_bus_is_back_tells_of_all_its_robots_and_asks_others_for_theirs(place):
    place.bus.connected = False
    assert place.tick() == ([], [])
    place.bus.connected = True
    assert place.tick() == (["r1"], ["positions"])
    assert place.tick() == ([], [])


def test_a_gateway_that_asks_is_told_of_all_robots(place):
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("a", "positions")))
    assert place.tick() == (["r1"], [])
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("a", "site")))
    assert place.tick() == ([], [])


async def test_details_are_told_when_they_have_changed_and_when_somebody_asks(place):
    place.robots.ready("r2", 1, "yard", 1000.0)
    place.robots.let_go("r2", "a")
    assert await place.detailed() == ["r1"]
    place.robots.observe("r1", SendPos(1.5, 2.0, 0.0, 0.0), "yard", 1000.0)
    assert await place.detailed() == []
    place.robots.observe("r1", SendPos(1.5, 2.0, 0.0, 0.0, battery=0.5), "yard", 1000.0)
    assert await place.detailed() == ["r1"]
    place.now += DETAIL_ALL_AGAIN_S
    for _ in range(2):
        place.exchange.receive(EVERYBODY, CODEC.encode(Wake("a", "positions")))
    assert await place.detailed() == ["r1"]
    # Gateways that start together all ask: who asks a moment later is told a little later.
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("c", "positions")))
    assert await place.detailed() == []
    place.now += DETAIL_ALL_AGAIN_S
    assert await place.detailed() == ["r1"]
    assert await place.detailed() == []
    place.bus.connected = False
    assert await place.detailed() == []
    place.bus.connected = True
    assert await place.detailed() == ["r1"]


@pytest.mark.parametrize(("measured", "told"), [(0.149, 0), (0.051, 0), (0.151, 1), (0.049, 1), (0.01, 1)])
async def test_a_latency_is_told_again_once_it_is_another_one(place, measured, told):
    for latency, expected in ((0.1, 1), (measured, told)):
        place.robots.measured("r1", latency)
        place.robots.observe("r1", SendPos(2.0, 2.0, 0.0, 0.0), "yard", 1000.0)
        assert len(await place.detailed()) == expected


def test_a_latency_that_is_measured_again_is_no_change(place):
    place.robots.measured("r1", 0.1)
    seen = place.robots.revision
    place.robots.measured("r1", 0.1)
    assert place.robots.revision == seen and place.robots.own_described(seen) == []
    place.robots.measured("r1", 0.2)
    assert [robot.name for robot in place.robots.own_described(seen)] == ["r1"]


async def test_a_latency_that_creeps_is_told_in_the_end(place):
    heard = []
    for step in range(100):
        place.robots.measured("r1", 0.1 + step / 1000)
        place.robots.observe("r1", SendPos(2.0, 2.0, 0.0, 0.0), "yard", 1000.0)
        await place.detailed()
        heard += [robot.latency for one in place.bus.sent for robot in one.robots]
    assert heard == [0.1, 0.15]


def test_a_robot_of_another_gateway_is_told_by_that_alone(place):
    place.robots.let_go("r1", "a")
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("a", "positions")))
    assert place.tick() == ([], [])


def test_robots_are_named_once_and_all_of_them_to_who_asks(place):
    def named():
        return [name for one in place.bus.sent if isinstance(one, PositionBatch) for name in one.names]

    place.robots.observe("r1", SendPos(1.5, 2.0, 0.0, 0.0), "yard", 1000.0)
    place.robots.ready("r2", 1, "yard", 1000.0)
    place.robots.ready("r0", 1, "yard", 1000.0)
    assert place.tick() == (["r2", "r0", "r1"], []) and named() == ["r2", "r0"]
    place.robots.observe("r2", SendPos(1.5, 2.0, 0.0, 0.0), "yard", 1000.0)
    assert place.tick() == (["r2"], []) and named() == []
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("a", "positions")))
    assert place.tick() == (["r1", "r2", "r0"], []) and named() == ["r1", "r2", "r0"]
    place.now += POSITION_ALL_S
    assert place.tick() == (["r1", "r2", "r0"], []) and named() == [], "who misses a name asks for it"


def test_a_gateway_that_runs_out_of_numbers_begins_anew(place, monkeypatch):
    monkeypatch.setattr(robot_relay, "MOST_IDS", 2)
    run = place.relay._run
    for name in ("r2", "r3"):
        place.robots.ready(name, 1, "yard", 1000.0)
        place.robots.remove("r1")
    place.tick()
    batches = [one for one in place.bus.sent if isinstance(one, PositionBatch)]
    assert [one.run for one in batches] == [run + 1]
    assert sorted(batches[0].names) == ["r2", "r3"] and batches[0].robots().tolist() == [0, 1]


@pytest.fixture
def here():
    """Gateway c, and what it asks others for."""
    here = Place("c")
    here.tick()
    here.bus.sent.clear()
    return here


def hand_over(place, here):
    for one in place.bus.sent:
        if isinstance(one, PositionBatch):
            here.exchange.receive("positions", CODEC.encode(one))
    here.relay.apply_received()
    return [one.what for one in here.bus.sent if isinstance(one, Wake)]


def test_who_did_not_hear_the_names_asks_for_them_once_in_a_while(place, here):
    place.robots.observe("r1", SendPos(1.5, 2.0, 0.0, 0.0), "yard", 1000.0)
    place.tick()
    for _ in range(3):
        assert hand_over(place, here) == ["positions"]
    assert here.robots.names() == ["r1"] and here.robots.gateway_of("r1") is None
    here.robots.remove("r1")
    place.now = here.now = 1000.0 + NAMES_AGAIN_S
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("c", "positions")))
    place.tick()
    hand_over(place, here)
    assert here.robots.gateway_of("r1") == "b" and here.robots.pose("r1").x == 1.5
    place.robots.observe("r1", SendPos(2.5, 2.0, 0.0, 0.0), "yard", 1000.0)
    place.tick()
    hand_over(place, here)
    assert here.robots.pose("r1").x == 2.5


ALARM = FenceAlarm("r1", "keepout", "Basin", 1000.5, 1.0, 2.0, "abort", "failed", "no database", False)


class Fences:
    """A gateway whose clock is ``offset`` seconds behind the database's, and what it hears of others."""

    def __init__(self, name, offset, largest=LARGEST):
        self.bus, self.events, self.heard = Bus(), EventBus(), []
        self.exchange = Exchange(name, b"k" * 32, [self.bus])
        self.now = 2000.0
        membership = SimpleNamespace(database_time=lambda: self.now, clock_offset=offset)
        self.relay = FenceRelay(membership, self.exchange, self.events, largest=largest)
        self.events.subscribe(FenceJudgedElsewhere, self.heard.append)

    def judged(self, report):
        self.events.publish(FenceJudged(report))
        return self.bus.sent.pop()

    def hear(self, message):
        self.exchange.receive(EVERYBODY, CODEC.encode(message))
        return self.heard


def test_what_the_geofence_found_is_told_in_the_time_of_whoever_hears_it():
    here, there = Fences("a", 100.0), Fences("b", -50.0)
    found = Geofence(1900.0, [ALARM], 4, 9, 9, ["r2"], 5, "areas\nbroken")
    (judged,) = there.hear(here.judged(found))
    assert judged.gateway == "a"
    assert judged.report == Geofence(
        2050.0, [replace(ALARM, since=1150.5)], 4, 0, 0, ["r2"], 5, "areas broken"
    )


def test_a_report_that_waited_somewhere_counts_for_nothing():
    here, there = Fences("a", 0.0), Fences("b", 0.0)
    message = here.judged(Geofence(2000.0))
    there.now += FENCE_OLD_S + 1
    assert there.hear(message) == []


def test_alarms_that_do_not_fit_into_a_notification_are_counted():
    here = Fences("a", 0.0, LARGEST_NOTIFICATION)
    alarms = [replace(ALARM, robot=f"robot-{k:03}", name="B" * 300) for k in range(300)]
    message = here.judged(Geofence(2000.0, alarms, 7))
    assert len(CODEC.encode(message)) <= LARGEST_NOTIFICATION
    assert 10 < len(message.alarms) < 300 and message.more == 307 - len(message.alarms)
    assert message.alarms[0].robot == "robot-000" and len(message.alarms[0].name) == LONGEST_NAME


@pytest.mark.parametrize("where", [float("nan"), float("inf")])
def test_an_alarm_that_is_nowhere_is_no_message(where):
    here, there = Fences("a", 0.0), Fences("b", 0.0)
    assert there.hear(here.judged(Geofence(2000.0, [replace(ALARM, x=1.0)])))
    message = msgspec.structs.replace(here.judged(Geofence(2000.0)), alarms=[])
    broken = msgspec.structs.replace(message, alarms=[FencedRobot(*vars(replace(ALARM, x=where)).values())])
    there.exchange.receive(EVERYBODY, CODEC.encode(broken))
    assert len(there.heard) == 1


def test_positions_that_cannot_be_applied_keep_no_others_back(place, here, monkeypatch, caplog):
    here.robots.remove("r1")
    observe, failed = here.robots.observe_elsewhere, []

    def observe_or_fail(report):
        if not failed:
            failed.append(report)
            raise ValueError("a fault")
        return observe(report)

    monkeypatch.setattr(here.robots, "observe_elsewhere", observe_or_fail)
    for x in (1.5, 2.5):
        place.robots.observe("r1", SendPos(x, 2.0, 0.0, 0.0), "yard", 1000.0)
        place.exchange.receive(EVERYBODY, CODEC.encode(Wake("c", "positions")))
        place.tick()
        for one in place.bus.sent:
            if isinstance(one, PositionBatch):
                here.exchange.receive("positions", CODEC.encode(one))
    here.relay.apply_received()
    assert here.robots.pose("r1").x == 2.5 and "applying positions of gateway b" in caplog.text
