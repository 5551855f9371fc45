"""Robots in each other's way: one of them waits or goes another way, and goes on."""

from __future__ import annotations

import asyncio
import math

import pytest

from robot_bridge.core.clock import ClockWatch
from robot_bridge.core.errors import RefusedError, StoreError
from robot_bridge.core.messages.commands import AbortAll, AbortTask
from robot_bridge.core.messages.roads import ResolveConflict
from robot_bridge.core.messages.robots import GetPath
from robot_bridge.gateway.storage.repositories import closures as stored_closures
from tests.support.bridge.road_places import highest


async def test_a_conflict_is_told_with_place_and_time(roads):
    await roads.drive("one", [(20.0, 8.0), (100.0, 8.0)])
    await roads.drive("two", [(100.0, 8.0), (20.0, 8.0)], robot="r2")
    await roads.fleet.watch_roads()
    (found,) = roads.news["conflicts"]["conflicts"]
    assert (found["robot"], found["other"], found["kind"]) == ("r1", "r2", "head-on")
    assert (found["x"], found["y"]) == (60.0, 8.0)
    assert found["nearest_at"] == pytest.approx(roads.now + 40)
    await roads.at(20.0, 8.0)
    await roads.fleet.orders.abort_all(AbortAll(), "Ada")
    await roads.acknowledge_all("r1")
    await roads.acknowledge_all("r2")
    await asyncio.sleep(0.3)
    await roads.fleet.watch_roads()
    assert roads.news["conflicts"]["conflicts"] == []


async def test_a_head_on_conflict_is_resolved_by_another_way(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.drive("two", [(119.0, 8.0), (20.0, 8.0)], robot="r2")
    with pytest.raises(RefusedError, match="r1 cannot give way to r2: waiting does not resolve it"):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert (await roads.states())["one"] == "acknowledged"
    resolved = await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    assert (resolved.became, resolved.delay) == ("another way", pytest.approx(8.6, abs=0.3))
    assert highest(await roads.new_path()) == pytest.approx(22.0, abs=0.5)
    assert (await roads.fleet.roads.traffic.conflicts()).conflicts == []
    states = await roads.states()
    assert (states["one"], states["two"]) == ("superseded", "acknowledged")


async def test_a_robot_that_waits_does_so_no_longer_when_the_clock_is_set_back(roads):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    watch = ClockWatch(roads.clock)
    roads.clock.wall -= 365 * 86400.0
    roads.fleet.clock_was_set(watch.measure_step())
    (moved,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    assert hold.until - moved.until == 365 * 86400.0


async def test_a_robot_waits_for_another_at_a_crossing_and_is_sent_on(each):
    # They meet where the road from the south joins the ring at (44, 22).
    await each.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await each.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    assert len((await each.fleet.roads.traffic.conflicts()).conflicts) == 1
    resolved = await each.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert (resolved.robot, resolved.became) == ("r1", "waits")
    (hold,) = (await each.fleet.roads.traffic.conflicts()).waiting
    assert (hold.robot, hold.other, hold.by) == ("r1", "r2", "Ada")
    assert (await each.fleet.roads.traffic.conflicts()).conflicts == []
    points = await each.new_path()
    assert points[-1] == [hold.x, hold.y]
    await each.acknowledge_all()
    assert (await each.states())["one"] == "superseded"
    await each.restart()
    each.now += 10
    await each.at(hold.x, hold.y, v=0.0)
    await each.at(24.0, 22.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    assert await each.acknowledge_all() == []
    each.now = hold.until + 1
    # The other is late: the one that waits is not sent on by the clock alone.
    there = 44.0 - math.dist((hold.x, hold.y), (44.0, 22.0))
    await each.at(there, 22.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    assert await each.acknowledge_all() == []
    for x in range(44, 61, 4):
        await each.at(float(x), 22.0, v=1.0, robot="r2")
    await each.at(60.0, 26.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    rest = await each.new_path()
    assert rest[0] == [hold.x, hold.y]
    assert rest[-1] == [90.0, 22.0]
    assert (await each.fleet.roads.traffic.conflicts()).waiting == []


async def test_a_robot_with_a_target_waits_in_the_same_way_and_keeps_its_task(roads):
    await roads.ready()
    await roads.at(16.0, 8.0, v=1.0)
    await roads.send("cone", x=92.0, y=22.0, cone=True)
    await roads.acknowledge_all()
    outcome = await roads.fleet.receive("r1", "websocket", GetPath(), 7)
    await roads.fleet.outboxes.finish([outcome], [], acks=False)
    await roads.acknowledge_all()
    metres = math.dist((16, 8), (44, 22)) + 1
    await roads.drive("two", [(44.0 - metres, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    resolved = await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert resolved.command == "command-cone"
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    assert (await roads.new_path())[-1] == [hold.x, hold.y]
    await roads.acknowledge_all()
    with pytest.raises(RefusedError, match="GetPath: robot 'r1' waits for 'r2'"):
        await roads.fleet.receive("r1", "websocket", GetPath(), 8)
    await roads.at(hold.x, hold.y)
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.fleet.watch_roads()
    assert (await roads.new_path())[-1] == [92.0, 22.0]
    assert (await roads.states())["cone"] == "acknowledged"


async def test_a_robot_that_waits_and_is_told_otherwise_waits_no_longer(roads):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    await roads.send("other", x=20.0, y=8.0)
    await roads.fleet.watch_roads()
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == []


async def test_who_cannot_give_way_says_why_and_nothing_changes(roads):
    await roads.drive("one", [(20.0, 8.0), (40.0, 8.0)])
    await roads.ready("r2")
    await roads.at(60.0, 8.0, robot="r2")
    with pytest.raises(RefusedError, match="not in each other's way now; nothing was done"):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    await roads.drive("longer", [(20.0, 8.0), (100.0, 8.0)])
    with pytest.raises(RefusedError, match="r2 has no task or waits already"):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r2", "r1"), "Ada")
    before = await roads.states()
    with pytest.raises(RefusedError, match="r1 cannot give way to r2: neither waiting nor another way"):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    assert await roads.states() == before


async def test_a_robot_that_is_aborted_while_it_waits_is_sent_on_by_nobody(each):
    hold = await each.wait_at_the_crossing()
    await each.fleet.orders.abort(AbortTask("command-abort", "r1"), "Ada")
    assert await each.acknowledge_all() == ["Abort"]
    await each.at(hold.x, hold.y)
    assert (await each.states())["abort"] == "reached"
    assert each.sql("select robot from holds") == []
    await each.restart()
    await each.at(60.0, 40.0, robot="r2")
    each.now = hold.until + 10
    await each.at(hold.x, hold.y)
    await each.fleet.watch_roads()
    assert await each.acknowledge_all() == []


async def test_who_waits_is_stored_with_what_sends_it_there_or_nothing_is(roads, monkeypatch):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")

    def full(_connection, row):
        raise StoreError("the disk is full")

    monkeypatch.setattr(stored_closures, "hold", full)
    before = await roads.states()
    with pytest.raises(StoreError, match="the disk is full"):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert await roads.states() == before
    assert await roads.acknowledge_all() == []
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == []


async def test_a_robot_that_comes_while_the_waiting_ones_are_read_is_known_with_the_next_look(
    roads, monkeypatch
):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    waiting, run = roads.fleet.roads.waiting, roads.database.run
    (row,) = waiting.rows().values()

    async def read_too_early(work, *arguments):
        rows = await run(work, *arguments)
        if work is stored_closures.held:
            monkeypatch.undo()
            # Another gateway had r1 then, and it comes here now.
            waiting.doubt()
            return []
        return rows

    monkeypatch.setattr(roads.database, "run", read_too_early)
    waiting.doubt()
    await waiting.catch_up()
    assert waiting.rows() == {}
    await waiting.catch_up()
    assert waiting.rows() == {"r1": row}
