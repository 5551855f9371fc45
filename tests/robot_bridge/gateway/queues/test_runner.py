"""The runner of queues in a busy fleet: each queue is looked at, and no robot holds up another."""

from __future__ import annotations

import asyncio
import contextlib
import threading

import pytest

from robot_bridge.core.messages.queues import SetQueue
from robot_bridge.gateway.queues import runner
from tests.support.bridge.queue_line import PLACES, Line, task
from tests.support.patience import until


@pytest.fixture
async def line(two, monkeypatch):
    """The queues of r1 and r2, run as in a gateway."""
    monkeypatch.setattr(runner, "LOOK_INTERVAL", 0.1)
    for robot in ("r1", "r2"):
        await two.at(20.0, 40.0, robot=robot)
    yield Line(two)


@contextlib.asynccontextmanager
async def running(*works):
    tasks = [asyncio.create_task(work) for work in works]
    try:
        yield
    finally:
        for running in tasks:
            running.cancel()
        await asyncio.wait(tasks)


async def tasks(line, robot, *given):
    """Give a robot tasks; the gateway alone does what follows."""
    await line.queues.set(SetQueue(robot, (await line.report(robot)).revision, list(given)), "Ada")


async def reach(line, robot, place):
    """Let a robot take on what waits for it and stand at its end."""
    await until(lambda: "SetPosEnd" in line.yard.waiting(robot))
    await line.yard.acknowledge_all(robot)
    await line.yard.at(*place, robot=robot)


async def test_a_queue_is_looked_at_however_much_is_heard_of_others(line):
    driving = line.yard.fleet.driving

    async def chatter():
        while True:
            driving.schedule("r2")
            await asyncio.sleep(0.01)

    await tasks(line, "r2", task("b"))
    await tasks(line, "r1", task("a", after=["task-000b"]))
    async with running(driving.run(), chatter()):
        await reach(line, "r2", PLACES["b"])
        await until(lambda: line.yard.waiting("r1") == ["SetPosEnd"])


async def test_a_robot_whose_way_is_long_to_find_holds_up_no_other(line, monkeypatch):
    driving, found, begun = line.yard.fleet.driving, threading.Event(), []
    crossed = driving._site.keepouts_crossed

    def crossed_late(paths):
        if paths[0][-1] == PLACES["a"]:
            begun.append(paths)
            assert found.wait(60)
        return crossed(paths)

    monkeypatch.setattr(driving._site, "keepouts_crossed", crossed_late)
    async with running(driving.run()):
        await tasks(line, "r1", task("a"))
        await until(lambda: begun)
        await tasks(line, "r2", task("b"), task("c"))
        await reach(line, "r2", PLACES["b"])
        await reach(line, "r2", PLACES["c"])
        assert line.yard.waiting("r1") == []
        found.set()
        await until(lambda: line.yard.waiting("r1") == ["SetPosEnd"])


async def test_a_queue_that_is_scheduled_while_it_is_processed_is_processed_once_more_and_once_only(
    line, monkeypatch
):
    monkeypatch.setattr(runner, "LOOK_INTERVAL", 3600.0)
    driving, released, settled = line.yard.fleet.driving, asyncio.Event(), []

    async def settle(queue):
        settled.append(queue.robot)
        await released.wait()

    monkeypatch.setattr(driving._settling, "settle", settle)
    async with running(driving.run()):
        driving.schedule("r1")
        await until(lambda: settled == ["r1"])
        for _ in range(5):
            driving.schedule("r1")
            await until(lambda: not driving._event.is_set())
        driving.schedule("r2")
        await until(lambda: settled == ["r1", "r2"])
        names = [work.get_coro().__qualname__ for work in asyncio.all_tasks()]
        assert names.count("QueueRunner._advance") == 2
        released.set()
        await until(lambda: settled == ["r1", "r2", "r1"])
