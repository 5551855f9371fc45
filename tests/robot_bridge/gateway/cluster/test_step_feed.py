"""Steps of commands of robots at other gateways, told to the operators of this one."""

from __future__ import annotations

import asyncio
from collections import Counter

from robot_bridge.core.messages.robots import Abort
from robot_bridge.gateway.cluster import feeds
from robot_bridge.gateway.cluster.feeds import StepFeed
from robot_bridge.gateway.cluster.followers import ChangeNumbers
from robot_bridge.gateway.cluster.messages import Exchange
from robot_bridge.gateway.commands.active_command import CommandOrder


class Alone:
    """A fleet of one gateway."""

    def others(self):
        return []

    def database_time(self):
        return 0.0


class Turns:
    """An operator's session that counts what it hears in each turn of the loop."""

    def __init__(self):
        self.turn, self.heard = 0, Counter()

    def notify(self, method, key, params):
        self.heard[self.turn] += 1

    async def count(self):
        while True:
            self.turn += 1
            await asyncio.sleep(0)


async def test_hundreds_of_steps_leave_others_their_turns(two, monkeypatch):
    monkeypatch.setattr(feeds, "PIECE", 10)
    fleet = two.fleet
    exchange = Exchange("a", b"k" * 32, [])
    numbers = ChangeNumbers(exchange, Alone())
    feed = StepFeed(fleet.robots, fleet.listeners, fleet.events, exchange, numbers, two.database)
    await feed.follow()
    for number in range(40):
        await fleet.emergency._book.issue([CommandOrder(f"abort-{number:04}", "r1", Abort(), "Ada", None)])
    fleet.robots.let_go("r1", "south")
    turns = Turns()
    fleet.listeners.add(turns)
    counting = asyncio.create_task(turns.count())
    await feed.follow()
    counting.cancel()
    assert sum(turns.heard.values()) == 40
    assert max(turns.heard.values()) <= 10
