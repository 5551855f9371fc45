"""What a robot said of its commands is dealt with in its order, whatever a part of it waits for."""

from __future__ import annotations

import asyncio

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.commands import persistence
from robot_bridge.gateway.commands.persistence import RobotSequences


def at(x):
    return SendPos(float(x), 0.0, 0.0, 0.0)


class Judge:
    """Notes what is judged; what is at 5 is done, and storing that waits for ``free``."""

    def __init__(self):
        self.order, self.lost, self.free = [], [], asyncio.Event()

    def evaluate_arrival(self, robot, pose):
        self.order.append((robot, pose.x))
        return self._store(robot) if pose.x == 5.0 else None

    async def _store(self, robot):
        await self.free.wait()
        self.order.append((robot, "stored"))

    def lose_sight(self, robot):
        self.lost.append(robot)


@pytest.fixture
def judge():
    return Judge()


@pytest.fixture
def sequences(judge):
    return RobotSequences(judge)


async def idle():
    for _ in range(10):
        await asyncio.sleep(0)


def storing(judge, what, free=None, error=None):
    async def work():
        if free is not None:
            await free.wait()
        judge.order.append(what)
        if error is not None:
            raise error
        return what

    return work()


async def test_positions_and_acknowledgements_of_one_robot_keep_their_order_and_no_other_waits(
    sequences, judge
):
    free = asyncio.Event()
    assert not sequences.add_position("r1", at(0)), "nothing is being done: it is judged at once"
    first = sequences.add("r1", storing(judge, "first", free))
    assert sequences.add_position("r1", at(1))
    second = sequences.add("r1", storing(judge, "second"))
    assert sequences.add_position("r1", at(2))
    assert not sequences.add_position("r2", at(0))
    assert await sequences.add("r2", storing(judge, "other")) == "other"
    await idle()
    assert judge.order == ["other"]
    free.set()
    assert (await first, await second) == ("first", "second")
    await idle()
    assert judge.order == ["other", "first", ("r1", 1.0), "second", ("r1", 2.0)]
    assert not sequences.add_position("r1", at(3))


async def test_what_came_while_an_arrival_was_stored_comes_behind_it(sequences, judge):
    sequences.add("r1", storing(judge, "first"))
    for x in (5, 6):
        assert sequences.add_position("r1", at(x))
    await idle()
    assert judge.order == ["first", ("r1", 5.0)] and sequences.add_position("r1", at(7))
    judge.free.set()
    await idle()
    assert judge.order[2:] == [("r1", "stored"), ("r1", 6.0), ("r1", 7.0)]


@pytest.mark.parametrize("error", [StoreError("away"), RuntimeError("a fault")])
async def test_what_goes_wrong_is_told_to_who_waits_for_it_and_keeps_nothing_else(
    sequences, judge, monkeypatch, error
):
    def fail(_robot, pose):
        judge.order.append(pose.x)
        raise error

    monkeypatch.setattr(judge, "evaluate_arrival", fail)
    first = sequences.add("r1", storing(judge, "first", error=error))
    assert sequences.add_position("r1", at(1))
    second = sequences.add("r1", storing(judge, "second"))
    with pytest.raises(type(error)):
        await first
    assert await second == "second" and judge.order == ["first", 1.0, "second"]


async def test_what_nobody_waits_for_any_more_is_done_all_the_same(sequences, judge):
    free = asyncio.Event()
    waiting = [asyncio.ensure_future(sequences.add("r1", storing(judge, n, free))) for n in range(2)]
    await idle()
    for one in waiting:
        one.cancel()
    free.set()
    assert await sequences.add("r1", storing(judge, "last")) == "last"
    assert judge.order == [0, 1, "last"]


async def test_of_too_many_positions_the_oldest_are_left_out_and_the_robot_was_not_seen(
    sequences, judge, monkeypatch
):
    monkeypatch.setattr(persistence, "MOST_WAITING", 5)
    free = asyncio.Event()
    sequences.add("r1", storing(judge, "first", free))
    await idle()
    sequences.add("r1", storing(judge, "second"))
    for x in range(10, 20):
        assert sequences.add_position("r1", at(x))
    assert judge.lost == ["r1"] * 6
    free.set()
    await idle()
    assert judge.order == ["first", "second", *(("r1", float(x)) for x in range(16, 20))]


async def test_positions_that_cannot_be_judged_fill_no_log(sequences, judge, caplog, monkeypatch):
    """A robot that stands where it should says so ten times a second; each is tried."""

    def locked(robot, pose):
        return storing(judge, (robot, pose.x), error=StoreError("commands is locked"))

    monkeypatch.setattr(judge, "evaluate_arrival", locked)
    free = asyncio.Event()
    for robot in ("r1", "r2"):
        sequences.add(robot, storing(judge, robot, free))
        for x in range(5):
            assert sequences.add_position(robot, at(x))
    free.set()
    await idle()
    assert len(judge.order) == 12
    assert [record.getMessage() for record in caplog.records] == ["robot 'r1': commands is locked"]
