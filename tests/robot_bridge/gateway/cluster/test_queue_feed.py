"""Queues of robots at other gateways, told to the operators of this one; on a real PostgreSQL."""

from __future__ import annotations

import asyncio
import contextlib
import math

import pytest
from sqlalchemy import text

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.queues import QueueTask
from robot_bridge.gateway.cluster import feeds, followers
from robot_bridge.gateway.cluster.feeds import QueueFeed
from robot_bridge.gateway.cluster.followers import ChangeNumbers
from robot_bridge.gateway.cluster.messages import Exchange
from robot_bridge.gateway.model.events import EventBus, Listeners, QueueReported
from robot_bridge.gateway.model.robots import Robot, Robots
from robot_bridge.gateway.model.task_queue import Queue, QueuedTask
from robot_bridge.gateway.storage.database import Database, read_address
from robot_bridge.gateway.storage.repositories import queues
from tests.support.patience import BUSY, until

HAS_OWNER = text("insert into robot_owners (robot, gw, run, fence) values ('r1', 'south', 'run', 1)")


class Alone:
    """A fleet in which no other gateway says what it has changed."""

    def others(self):
        return []

    def database_time(self):
        return 0.0


class Place:
    """Gateway a with an operator, and r1 at another gateway; ``away`` are reads that fail once each."""

    def __init__(self, database):
        self.database, self.away, self.reads, self.heard = database, [], 0, []
        self.robots, listeners, events = Robots(), Listeners(), EventBus()
        self.robots.restore(Robot("r1", 1, "south", 0.0, gateway="south"), 0.0)
        exchange = Exchange("a", b"k" * 32, [])
        self.numbers = ChangeNumbers(exchange, Alone())
        self.feed = QueueFeed(self.robots, None, listeners, events, exchange, self.numbers, self)
        listeners.add(self)

    def notify(self, method, key, params):
        self.heard.append((method, key, len(params["tasks"])))

    async def read(self, work, *arguments):
        if work in self.away:
            self.away.remove(work)
            raise StoreError("the database is away")
        found = await self.database.read(work, *arguments)
        self.reads += work is queues.versions_elsewhere
        return found

    async def until(self, condition):
        async with asyncio.timeout(10 * BUSY):
            while not condition():
                await asyncio.sleep(0.005)


@pytest.fixture
async def place(fleet_url, monkeypatch):
    monkeypatch.setattr(feeds, "LOOK_S", 0.02)
    monkeypatch.setattr(followers, "ANYWAY_S", math.inf)
    database = Database(read_address(fleet_url))
    await database.open()
    await database.run(lambda connection: connection.execute(HAS_OWNER))
    await database.run(queues.save, Queue("r1"), Queue("r1").with_tasks([], edited=True))
    yield Place(database)
    await database.close()


@contextlib.asynccontextmanager
async def running(feed):
    task = asyncio.create_task(feed.run())
    try:
        yield task
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


async def test_what_a_failed_look_would_have_found_waits_for_no_other_change(place):
    async with running(place.feed) as following:
        await place.until(lambda: place.reads == 1)
        before = (await place.database.read(queues.load, ["r1"]))["r1"]
        task = QueuedTask(QueueTask("task-0001", 1.0, 2.0), "Ada", 1790000000.0)
        await place.database.run(queues.save, before, before.with_tasks([task], edited=True))
        place.away = [queues.versions_elsewhere]
        place.numbers.add_change("queues")
        with pytest.raises(StoreError):
            await following
    async with running(place.feed):
        await place.until(lambda: place.heard == [("queue", "r1", 1)])


class NoDatabase:
    """One that holds nothing."""

    async def read(self, _work, *_arguments):
        return {}


class FailingBus:
    """One whose first message fails."""

    connected, sent = True, 0

    def publish(self, _subject, _content):
        self.sent += 1
        return 1 / (self.sent - 1)


async def test_a_queue_that_cannot_be_named_to_the_others_keeps_back_no_later_one(caplog):
    bus, events = FailingBus(), EventBus()
    exchange = Exchange("a", b"k" * 32, [bus])
    numbers = ChangeNumbers(exchange, Alone())
    feed = QueueFeed(Robots(), None, Listeners(), events, exchange, numbers, NoDatabase())
    async with running(feed):
        for number in (1, 2):
            events.publish(QueueReported(f"r{number}"))
            await until(lambda number=number: bus.sent == number)
    assert "naming changed queues to other gateways failed" in caplog.text
