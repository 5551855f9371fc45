"""Queues that an earlier gateway left are taken up with what ended in them, many robots at a time."""

from __future__ import annotations

import pytest
from sqlalchemy import insert

from robot_bridge.core.messages.queues import QueueState, QueueTask, TaskState
from robot_bridge.gateway.model.events import EventBus, Listeners, QueueChanged
from robot_bridge.gateway.model.robots import Robot, Robots
from robot_bridge.gateway.model.task_queue import REPORTED_ENDED, Queue, QueuedTask
from robot_bridge.gateway.queues import registry
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import queues
from robot_bridge.gateway.storage.schema import queues as queue_rows
from tests.support.databases.database_maker import KINDS

NAMES = [f"r{number}" for number in range(7)]


class CountedDatabase(Database):
    """A database that counts its transactions."""

    transactions = 0

    async def run(self, work, *arguments):
        self.transactions += 1
        return await super().run(work, *arguments)


@pytest.fixture(params=KINDS)
def url(request, new_database):
    """A database with the tables and nothing in them."""
    return new_database(request.param)


@pytest.fixture
async def database(url):
    opened = CountedDatabase(url)
    yield opened
    await opened.close()


def ended(robot, number):
    """Several end at one time, not all in one way."""
    state = TaskState.SKIPPED if number % 3 == 0 else TaskState.DONE
    task = QueueTask(f"{robot}-task-{number}", 1.0, number / 3)
    return QueuedTask(task, "Ada", 1.0, state, number, ended_at=100.0 + number // 4)


def waiting(robot):
    return QueuedTask(QueueTask(f"{robot}-waiting", 1.0, 2.0), "Ada", 1.0, place=99)


def write(connection):
    """Give each robot another number of tasks that ended, from none to more than are reported."""
    for number, robot in enumerate(NAMES):
        row = {"robot": robot, "revision": 1, "state": QueueState.RUNNING.value}
        connection.execute(insert(queue_rows), row)
        before = Queue(robot, 1, QueueState.RUNNING)
        tasks = [ended(robot, k) for k in range(number * (REPORTED_ENDED // 2))]
        queues.save(connection, before, Queue(robot, 1, QueueState.RUNNING, (waiting(robot),)), tasks)


@pytest.fixture
async def restored(database, monkeypatch):
    """The registry of a gateway that has begun with these queues, and the robots that it told of."""
    monkeypatch.setattr(registry, "RESTORED_AT_ONCE", 4)
    await database.run(write)
    robots, events, changed = Robots(), EventBus(), []
    for name in NAMES:
        robots.restore(Robot(name, 1, "websocket", 1.0), 2.0)
    events.subscribe(QueueChanged, lambda change: changed.append(change.robot))
    book = registry.QueueRegistry(database, robots, Listeners(), events)
    database.transactions = 0
    await book.restore()
    return book, changed


async def test_each_queue_has_its_open_tasks_and_the_newest_that_ended(restored):
    book, changed = restored
    assert changed == NAMES
    for number, robot in enumerate(NAMES):
        report = book.announce(robot)
        assert [task.task for task in report.tasks] == [f"{robot}-waiting"]
        newest = range(number * (REPORTED_ENDED // 2))[::-1][:REPORTED_ENDED]
        assert [task.task for task in report.ended] == [f"{robot}-task-{k}" for k in newest]


@pytest.mark.usefixtures("restored")
async def test_they_are_read_in_pieces_and_not_robot_by_robot(database):
    # The queues with their open tasks, and two pieces of four robots.
    assert database.transactions == 3
