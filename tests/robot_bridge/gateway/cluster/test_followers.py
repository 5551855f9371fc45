"""When a gateway looks in the database for what others have changed."""

from __future__ import annotations

import asyncio

import pytest

from robot_bridge.gateway.cluster import followers
from robot_bridge.gateway.cluster.followers import ChangeNumbers, Follower, LookSchedule
from robot_bridge.gateway.cluster.messages import Beat, Codec, Exchange
from tests.support.patience import BUSY

KEY = b"k" * 32


class Fleet:
    """Gateways whose buses hand on what each says to all others, unless it is ``lost``."""

    def __init__(self):
        self.now, self.lost, self.living = 1000.0, False, ["a", "b"]
        self.lost_messages = 0
        self.places = {}

    def add(self, name):
        self.places[name] = Place(self, name)
        return self.places[name]

    def beat(self):
        for place in list(self.places.values()):
            place.numbers.send_beat()


class Place:
    """A gateway: bus, membership and numbers."""

    connected = True

    def __init__(self, fleet, name):
        self.fleet, self.name = fleet, name
        self.exchange = Exchange(name, KEY, [self])
        self.numbers = ChangeNumbers(self.exchange, self)

    def others(self):
        return [name for name in self.fleet.living if name != self.name]

    def database_time(self):
        return self.fleet.now

    def publish(self, subject, content):
        self.fleet.lost_messages += self.fleet.lost
        for place in self.fleet.places.values():
            if not self.fleet.lost and place is not self:
                place.exchange.receive(subject, content)
        return True

    def hear(self, beat):
        self.exchange.receive("all", Codec(KEY).encode(beat))


@pytest.fixture
def fleet():
    fleet = Fleet()
    fleet.add("a")
    fleet.add("b")
    fleet.beat()
    return fleet


@pytest.fixture
async def schedule(fleet):
    schedule = LookSchedule("steps", fleet.places["a"].numbers)
    schedule.begin_look()
    return schedule


async def test_nobody_looks_where_nothing_has_changed(fleet, schedule):
    assert not schedule.is_due
    fleet.now += 1.0
    fleet.beat()
    assert not schedule.is_due


async def test_a_change_is_looked_up_whose_wake_was_lost(fleet, schedule):
    fleet.places["b"].numbers.add_change("steps")
    fleet.beat()
    assert schedule.is_due
    schedule.begin_look()
    assert not schedule.is_due


async def test_changes_of_another_kind_are_none(fleet, schedule):
    fleet.places["b"].numbers.add_change("plans")
    fleet.beat()
    assert not schedule.is_due


async def test_what_this_gateway_changed_is_looked_up_as_well(fleet, schedule):
    fleet.places["a"].numbers.add_change("steps")
    assert schedule.is_due


async def test_a_change_while_the_database_is_read_is_looked_up_next(fleet, schedule):
    schedule.begin_look()
    fleet.places["b"].numbers.add_change("steps")
    fleet.beat()
    assert schedule.is_due


async def test_a_gateway_that_is_silent_may_change_anything(fleet, schedule):
    fleet.lost = True
    fleet.now += followers.BEAT_HOLDS_S + 0.1
    fleet.beat()
    assert schedule.is_due
    schedule.begin_look()
    assert schedule.is_due


async def test_what_an_old_beat_says_counts_no_more(fleet, schedule):
    fleet.now += 60.0
    fleet.places["a"].hear(Beat("b", 1000.0, {}))
    assert schedule.is_due


async def test_a_gateway_that_says_nothing_of_changes_is_looked_up_each_time(fleet, schedule):
    """One of an earlier version."""
    fleet.places["a"].hear(Beat("b", fleet.now))
    assert schedule.is_due
    schedule.begin_look()
    assert schedule.is_due


async def test_a_gateway_that_comes_or_goes_is_a_reason_to_look(fleet, schedule):
    fleet.living = ["a", "b", "c"]
    assert schedule.is_due
    fleet.add("c")
    fleet.beat()
    assert schedule.is_due
    schedule.begin_look()
    assert not schedule.is_due
    fleet.living = ["a", "c"]
    assert schedule.is_due


async def test_a_gateway_that_starts_again_begins_with_other_numbers(fleet, schedule):
    fleet.places["b"].numbers.add_change("steps")
    fleet.beat()
    schedule.begin_look()
    fleet.add("b").numbers.add_change("steps")
    fleet.beat()
    assert schedule.is_due


async def test_somebody_looks_anyway_once_in_a_while(schedule, monkeypatch):
    assert not schedule.is_due
    monkeypatch.setattr(followers, "ANYWAY_S", 0.0)
    assert schedule.is_due


class Followed:
    """What is followed; it counts the looks."""

    def __init__(self):
        self.looks, self.goes_on = 0, False

    async def follow(self):
        self.looks += 1


async def until(condition):
    async with asyncio.timeout(10 * BUSY):
        while not condition():
            await asyncio.sleep(0.005)


async def test_a_follower_looks_when_it_is_woken_and_for_a_lost_wake(fleet, monkeypatch):
    monkeypatch.setattr(followers, "LOOK_S", 0.02)
    here, there = Followed(), Followed()
    a, b = fleet.places["a"], fleet.places["b"]
    first, second = (
        Follower("steps", one, place.exchange, place.numbers) for one, place in ((here, a), (there, b))
    )
    async with asyncio.TaskGroup() as group:
        tasks = [group.create_task(one.run()) for one in (first, second)]
        await until(lambda: here.looks == there.looks == 1)
        second.note_change()
        # The wake.
        await until(lambda: here.looks == 2)
        fleet.lost = True
        second.note_change()
        await until(lambda: fleet.lost_messages)
        fleet.lost = False
        fleet.beat()
        await until(lambda: here.looks == 3)
        first.wake()
        await until(lambda: here.looks == 4)
        for task in tasks:
            task.cancel()


async def test_what_goes_on_by_itself_is_looked_at_each_second(fleet, monkeypatch):
    monkeypatch.setattr(followers, "LOOK_S", 0.02)
    followed, place = Followed(), fleet.places["a"]
    task = asyncio.create_task(Follower("plans", followed, place.exchange, place.numbers).run())
    await until(lambda: followed.looks == 1)
    followed.goes_on = True
    await until(lambda: followed.looks == 3)
    task.cancel()


async def test_a_wake_that_fails_prevents_no_later_one(fleet, caplog):
    followed, place = Followed(), fleet.places["a"]
    wakes, follower = [], Follower("plans", followed, place.exchange, place.numbers)

    def publish(_subject, _content):
        wakes.append(len(wakes))
        return 1 / len(wakes[1:])

    place.publish = publish
    task = asyncio.create_task(follower.run())
    for number in (1, 2):
        follower.note_change()
        await until(lambda number=number: len(wakes) == number)
    task.cancel()
    assert "waking other gateways for plans failed" in caplog.text
