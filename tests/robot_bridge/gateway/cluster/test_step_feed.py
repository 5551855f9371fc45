"""Steps of commands of robots at other gateways, told to the operators of this one."""

from __future__ import annotations

import asyncio
from collections import Counter

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.robots import Abort, SetPosEnd
from robot_bridge.gateway.cluster import feeds
from robot_bridge.gateway.cluster.feeds import StepFeed
from robot_bridge.gateway.cluster.followers import ChangeNumbers
from robot_bridge.gateway.cluster.messages import Exchange
from robot_bridge.gateway.commands.active_command import CommandOrder
from robot_bridge.gateway.model.events import RobotLeft
from robot_bridge.gateway.storage.repositories import commands
from tests.support.patience import BUSY, until


class Alone:
    """A fleet of one gateway."""

    def others(self):
        return []

    def database_time(self):
        return 0.0


class Unreliable:
    """A database that cannot be reached as ``work`` is read for the first time."""

    def __init__(self, database, work):
        self._database, self._work = database, work

    async def read(self, work, *arguments):
        if work is self._work:
            self._work = None
            raise StoreError("the database is away")
        return await self._database.read(work, *arguments)


class Turns:
    """An operator's session that counts what it hears in each turn of the loop."""

    def __init__(self, keys=None):
        self.turn, self.heard, self._keys = 0, Counter(), [] if keys is None else keys

    def notify(self, method, key, params):
        self.heard[self.turn] += 1
        self._keys.append(key)

    async def count(self):
        while True:
            self.turn += 1
            await asyncio.sleep(0)


def step_feed(two, database=None):
    fleet, exchange = two.fleet, Exchange("a", b"k" * 32, [])
    numbers = ChangeNumbers(exchange, Alone())
    return StepFeed(fleet.robots, fleet.listeners, fleet.events, exchange, numbers, database or two.database)


async def send_away(two):
    """Send r1 somewhere; return the command's id."""
    order = CommandOrder("drive-0001", "r1", SetPosEnd(2.0, 3.0), "Ada", None)
    await two.fleet.emergency._commands.issue([order])
    return order.command


async def abort(two, times):
    """Issue Aborts of r1, which is at another gateway from then on."""
    for number in range(times):
        order = CommandOrder(f"abort-{number:04}", "r1", Abort(), "Ada", None)
        await two.fleet.emergency._commands.issue([order])
    two.fleet.robots.let_go("r1", "south")


async def test_hundreds_of_steps_leave_others_their_turns(two, monkeypatch):
    monkeypatch.setattr(feeds, "PIECE", 10)
    fleet, feed = two.fleet, step_feed(two)
    await feed.follow()
    await abort(two, 40)
    turns = Turns()
    fleet.listeners.add(turns)
    counting = asyncio.create_task(turns.count())
    await feed.follow()
    counting.cancel()
    assert sum(turns.heard.values()) == 40
    assert max(turns.heard.values()) <= 10


async def test_more_steps_than_are_read_at_once_wait_for_no_other_change(two, monkeypatch):
    monkeypatch.setattr(commands, "STEP_MARGIN", 2)
    feed = step_feed(two)
    await feed.follow()
    await abort(two, 100)
    monkeypatch.setattr(commands, "STEPS_AT_ONCE", 10)
    turns = Turns()
    two.fleet.listeners.add(turns)
    following = asyncio.create_task(feed.run())
    try:
        async with asyncio.timeout(10 * BUSY):
            while sum(turns.heard.values()) < 100:
                await asyncio.sleep(0.01)
    finally:
        following.cancel()
        await asyncio.gather(following, return_exceptions=True)


async def test_what_a_robot_does_that_went_elsewhere_is_learnt_though_the_database_was_away(two):
    feed = step_feed(two, Unreliable(two.database, commands.still_open))
    await feed.follow()
    command = await send_away(two)
    await feed.follow()
    two.fleet.robots.let_go("r1", "south")
    two.fleet.robots.assign("r1", None)
    two.fleet.events.publish(RobotLeft("r1", "south"))
    with pytest.raises(StoreError):
        await feed.follow()
    await feed.follow()
    assert two.fleet.robots.get("r1").command == command


async def test_a_first_look_that_fails_is_made_again(two):
    command = await send_away(two)
    two.fleet.robots.let_go("r1", "south")
    two.fleet.robots.assign("r1", None)
    feed = step_feed(two, Unreliable(two.database, commands.steps_after))
    with pytest.raises(StoreError):
        await feed.follow()
    turns = Turns()
    two.fleet.listeners.add(turns)
    await feed.follow()
    assert two.fleet.robots.get("r1").command == command
    assert not turns.heard


async def test_a_step_of_a_robot_that_is_met_a_moment_later_is_heard_then(two):
    """It connected to another gateway for the first time, and was commanded at once."""
    feed, robots, heard = step_feed(two), two.fleet.robots, []
    await feed.follow()
    await send_away(two)
    known = robots.get("r1")
    robots.remove("r1")
    two.fleet.listeners.add(Turns(heard))
    following = asyncio.create_task(feed.run())
    await asyncio.sleep(0.1)
    assert not heard
    robots.restore(known, known.received_at)
    robots.let_go("r1", "south")
    await until(lambda: heard)
    following.cancel()
    await asyncio.gather(following, return_exceptions=True)
    assert heard == ["drive-0001"] and robots.get("r1").command == "drive-0001"


async def test_steps_of_robots_that_are_never_met_are_forgotten(two, monkeypatch):
    monkeypatch.setattr(feeds, "MET_WITHIN_S", 0.0)
    feed = step_feed(two)
    await feed.follow()
    await send_away(two)
    two.fleet.robots.remove("r1")
    await feed.follow()
    assert feed._unmet == {} and feed._meeting is None
