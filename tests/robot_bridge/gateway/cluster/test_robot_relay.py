"""Positions across gateways: told when they change, and all of them when somebody may have missed them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.cluster.bus import EVERYBODY
from robot_bridge.gateway.cluster.messages import Codec, Exchange, PositionBatch, Wake
from robot_bridge.gateway.cluster.robot_relay import DETAIL_ALL_AGAIN_S, DetailRelay, PositionRelay
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
    """Gateway b with a robot, at a time that stands still."""

    def __init__(self):
        self.bus, self.robots = Bus(), Robots()
        # The second one carries what is urgent alone.
        self.exchange = Exchange("b", b"k" * 32, [self.bus, Bus()])
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
        named = [name for one in self.bus.sent if isinstance(one, PositionBatch) for name in one.names]
        return named, [one.what for one in self.bus.sent if isinstance(one, Wake)]

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


@pytest.mark.parametrize(("measured", "told"), [(0.124, 0), (0.076, 0), (0.126, 1), (0.074, 1), (0.01, 1)])
async def test_a_latency_is_told_again_once_it_is_another_one(place, measured, told):
    for latency, expected in ((0.1, 1), (measured, told)):
        place.robots.measured("r1", latency)
        place.robots.observe("r1", SendPos(2.0, 2.0, 0.0, 0.0), "yard", 1000.0)
        assert len(await place.detailed()) == expected


async def test_a_latency_that_creeps_is_told_in_the_end(place):
    heard = []
    for step in range(100):
        place.robots.measured("r1", 0.1 + step / 1000)
        place.robots.observe("r1", SendPos(2.0, 2.0, 0.0, 0.0), "yard", 1000.0)
        await place.detailed()
        heard += [robot.latency for one in place.bus.sent for robot in one.robots]
    assert heard == [0.1, 0.126, 0.158, 0.198]


def test_a_robot_of_another_gateway_is_told_by_that_alone(place):
    place.robots.let_go("r1", "a")
    place.exchange.receive(EVERYBODY, CODEC.encode(Wake("a", "positions")))
    assert place.tick() == ([], [])
