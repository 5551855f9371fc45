"""Closed roads and robots in each other's way: a fleet on the roads of the sample site, its database real."""

from __future__ import annotations

import asyncio
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from robot_bridge.errors import RefusedError, StoreError
from robot_bridge.messages import (
    AbortTask,
    CloseRoad,
    EmergencyStop,
    GetPath,
    GetQueue,
    GetRoute,
    MessageError,
    PauseQueue,
    QueueState,
    QueueTask,
    ResolveConflict,
    ResumeQueue,
    SetQueue,
    TaskKind,
)
from robot_bridge.store import closures as stored_closures

SOUTH = (60.0, 8.0)
"""A place on the road from (16, 8) to (120, 8); round it lead the roads by (44, 22) and (92, 22)."""
END = (190.0, 84.0)


def highest(points, low=16.0, high=120.0):
    return max(y for x, y in points if low < x < high)


async def test_a_closed_road_is_driven_round_until_it_is_opened_whoever_restarts(each):
    there = (10.0, 8.0), (126.0, 8.0)
    assert highest((await each.way(*there)).points) == pytest.approx(8.0, abs=0.01)
    closed = await each.close_road(*SOUTH, reason="tree on the road")
    assert (closed.closure.edges, closed.closure.closed_by, closed.closure.reason) == (
        1,
        "Ada",
        "tree on the road",
    )
    assert closed.closure.line[0] == (16.0, 8.0)
    assert each.news["closures"]["closures"][0]["closure"] == "closure-1"
    assert highest((await each.way(*there)).points) == pytest.approx(22.0, abs=0.5)
    await each.restart()
    assert highest((await each.way(*there)).points) == pytest.approx(22.0, abs=0.5)
    opened = await each.open_road()
    assert (opened.opened_by, opened.opened_at) == ("Bob", each.now)
    assert each.news["closures"] == {"closures": []}
    assert highest((await each.way(*there)).points) == pytest.approx(8.0, abs=0.01)
    await each.restart()
    assert each.fleet.closures.report().closures == []


async def test_the_same_again_changes_nothing_and_what_was_never_closed_is_refused(roads):
    first = await roads.close_road(*SOUTH)
    roads.now += 5
    assert (await roads.close_road(*SOUTH)).closure == first.closure
    opened = await roads.open_road()
    roads.now += 5
    assert await roads.open_road() == opened
    with pytest.raises(RefusedError, match="no road was closed as 'closure-9'"):
        await roads.open_road("closure-9")
    with pytest.raises(RefusedError, match=r"no road of site .* is within 20 m of \(100.00, 150.00\)"):
        await roads.close_road(100.0, 150.0, "closure-2")
    with pytest.raises(MessageError, match="seconds is -1"):
        CloseRoad("closure-3", 0.0, 0.0, seconds=-1)


async def test_a_road_closed_for_a_time_opens_by_itself(roads):
    await roads.close_road(*SOUTH, seconds=60.0)
    roads.now += 59
    await roads.fleet.watch_roads()
    assert len(roads.fleet.closures.report().closures) == 1
    roads.now += 1
    await roads.fleet.watch_roads()
    assert roads.fleet.closures.report().closures == []
    assert highest((await roads.way((10.0, 8.0), (126.0, 8.0))).points) < 8.1


async def test_a_closed_road_stays_closed_in_a_new_publication_and_one_that_is_gone_is_said(roads, own_site):
    await roads.close_road(*SOUTH)
    site = own_site.site
    split = [line for line in site.centrelines if not (line.points[0] == (16.0, 8.0)).all()]
    (whole,) = [line for line in site.centrelines if (line.points[0] == (16.0, 8.0)).all()]
    middle, (first, last) = (70.0, 8.0), whole.points
    halves = [replace(whole, points=np.array(ends)) for ends in ((first, middle), (middle, last))]
    settings = replace(site.settings, version=2)
    own_site.take_over(replace(site, centrelines=(*split, *halves), settings=settings))
    await roads.fleet.site_changed()
    (report,) = roads.fleet.closures.report().closures
    assert report.edges == 2
    assert highest((await roads.way((10.0, 8.0), (126.0, 8.0))).points) > 20
    own_site.take_over(replace(site, centrelines=tuple(split), settings=settings))
    await roads.fleet.site_changed()
    (report,) = roads.news["closures"]["closures"]
    assert report["edges"] == 0


async def test_a_robot_on_its_way_along_a_road_that_is_closed_gets_another_way(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.drive("two", [(44.0, 44.0), (90.0, 44.0)], robot="r2")
    closed = await roads.close_road(*SOUTH, reason="tree")
    (robot,) = closed.robots
    assert (robot.robot, robot.became) == ("r1", "another way")
    assert roads.news["replanned"]["robot"] == "r1"
    points = await roads.new_path()
    assert points[0] == [10.0, 8.0]
    assert points[-1] == [126.0, 8.0]
    assert highest(points) == pytest.approx(22.0, abs=0.5)
    states = await roads.states()
    assert (states["one"], states["two"]) == ("superseded", "acknowledged")
    assert [row.op for row in await roads.deliver("r2") if row.op == "SetPath"] == []


async def test_a_robot_that_is_past_the_road_is_left_alone(roads):
    await roads.drive("one", [(16.0, 8.0), (120.0, 8.0), (126.0, 8.0)])
    for x in range(18, 123, 4):
        await roads.at(float(x), 8.0, v=1.0)
    await roads.at(123.0, 8.0, v=1.0)
    assert (await roads.close_road(*SOUTH)).robots == []
    assert (await roads.states())["one"] == "acknowledged"


async def test_a_robot_that_asked_for_its_way_is_told_another_and_keeps_its_task(roads):
    await roads.ready()
    await roads.at(10.0, 8.0)
    await roads.send("cone", x=126.0, y=8.0, cone=True)
    await roads.take()
    outcome = await roads.fleet.receive("r1", "websocket", GetPath(), 7)
    assert highest(outcome.answer.points) == pytest.approx(8.0, abs=0.01)
    await roads.fleet.finish([outcome], [], acks=False)
    await roads.take()
    closed = await roads.close_road(*SOUTH)
    assert [robot.became for robot in closed.robots] == ["another way"]
    assert highest(await roads.new_path()) == pytest.approx(22.0, abs=0.5)
    assert (await roads.states())["cone"] == "acknowledged"
    # It is known which way it is on now: closing that concerns it again.
    again = await roads.close_road(70.0, 22.0, "closure-2")
    assert [robot.robot for robot in again.robots] == ["r1"]


async def test_a_robot_that_stands_on_the_closed_road_or_has_no_other_way_is_stopped(roads):
    await roads.drive("one", [(60.0, 8.0), (126.0, 8.0)])
    await roads.drive("two", [(170.0, 84.0), (198.0, 84.0)], robot="r2")
    (robot,) = (await roads.close_road(*SOUTH)).robots
    assert (robot.robot, robot.became) == ("r1", "stopped")
    assert "is on a road that an operator closed" in robot.text
    assert await roads.take() == ["Abort"]
    assert (await roads.states())["one"] == "aborted"
    (robot,) = (await roads.close_road(195.0, 84.0, "closure-2")).robots
    assert (robot.robot, robot.became) == ("r2", "stopped")


async def test_by_the_sites_settings_operators_are_only_told(roads, own_site):
    settings = own_site.site.settings
    routes = replace(settings.routes, no_way="tell")
    own_site.take_over(replace(own_site.site, settings=replace(settings, routes=routes)))
    await roads.drive("one", [(60.0, 8.0), (126.0, 8.0)])
    (robot,) = (await roads.close_road(*SOUTH)).robots
    assert robot.became == "told only"
    assert (await roads.states())["one"] == "acknowledged"


async def test_nobody_is_sent_along_or_onto_a_closed_road(roads):
    await roads.ready()
    await roads.at(10.0, 8.0)
    await roads.close_road(*SOUTH, reason="tree")
    for op, params in (
        ("SetPath", {"points": [(10.0, 8.0), (60.0, 8.0), (126.0, 8.0)]}),
        ("SetPath", {"points": [(60.0, 20.0), (60.0, 9.0)]}),
        ("SetPosEnd", {"x": 60.0, "y": 9.0}),
    ):
        with pytest.raises(RefusedError, match=r"a road that Ada closed at .* \(tree\); choose another way"):
            await roads.send(f"x{op}", op, **params)
    await roads.send("across", "SetPath", points=[(60.0, 20.0), (60.0, 2.0)])
    with pytest.raises(RefusedError, match="is on a road that an operator closed"):
        await roads.way((10.0, 8.0), (60.0, 8.0))


async def test_while_an_emergency_stop_is_in_force_nobody_is_sent_another_way(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.fleet.emergency.stop(EmergencyStop("emergency-1"), "Ada")
    closed = await roads.close_road(*SOUTH)
    assert [robot.became for robot in closed.robots] == ["failed"]
    assert "an emergency stop is in force" in closed.robots[0].text


async def test_a_route_says_its_length_surfaces_and_what_finds_it(roads):
    there = await roads.way((41.0, 44.0), (100.0, 45.0))
    assert there.metres == pytest.approx(59.0, abs=0.5)
    assert {one.surface: round(one.metres) for one in there.surfaces} == {"slippery": 51, "asphalt": 8}
    assert there.points[0] == (41.0, 44.0)
    assert there.points[-1] == (100.0, 45.0)
    assert (there.off_goal, there.note) == (1.0, "")
    round_it = await roads.way((20.0, 44.0), (110.0, 44.0), surfaces=["asphalt"])
    assert [one.surface for one in round_it.surfaces] == ["asphalt"]
    straight = await roads.way((10.0, 150.0), (100.0, 158.0))
    assert straight.points == [(10.0, 150.0), (100.0, 158.0)]
    assert straight.note.startswith("the way is a straight line")


async def test_roads_on_which_others_drive_are_avoided_when_that_is_asked_for(roads):
    await roads.drive("one", [(30.0, 8.0), (110.0, 8.0)], robot="r2")
    there = (10.0, 8.0), (126.0, 8.0)
    assert highest((await roads.way(*there)).points) < 8.1
    assert highest((await roads.way(*there, avoid_reserved=True)).points) > 20
    await roads.ready("r3")
    await roads.at(10.0, 8.0, robot="r3")
    mine = await roads.route(GetRoute(126.0, 8.0, robot="r3", avoid_reserved=True))
    assert highest(mine.points) > 20
    with pytest.raises(RefusedError, match="robot 'r9' is not known"):
        await roads.route(GetRoute(1.0, 1.0, robot="r9"))


async def test_a_conflict_is_told_with_place_and_time(roads):
    await roads.drive("one", [(20.0, 8.0), (100.0, 8.0)])
    await roads.drive("two", [(100.0, 8.0), (20.0, 8.0)], robot="r2")
    await roads.fleet.watch_roads()
    (found,) = roads.news["conflicts"]["conflicts"]
    assert (found["robot"], found["other"], found["kind"]) == ("r1", "r2", "head-on")
    assert (found["x"], found["y"]) == (60.0, 8.0)
    assert found["nearest_at"] == pytest.approx(roads.now + 40)
    await roads.at(20.0, 8.0)
    await roads.fleet.orders.abort_all("Ada")
    await roads.take("r1")
    await roads.take("r2")
    await asyncio.sleep(0.3)
    await roads.fleet.watch_roads()
    assert roads.news["conflicts"]["conflicts"] == []


async def test_a_head_on_conflict_is_resolved_by_another_way(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.drive("two", [(119.0, 8.0), (20.0, 8.0)], robot="r2")
    with pytest.raises(RefusedError, match="r1 cannot give way to r2: waiting does not resolve it"):
        await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert (await roads.states())["one"] == "acknowledged"
    resolved = await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    assert (resolved.became, resolved.delay) == ("another way", pytest.approx(8.6, abs=0.3))
    assert highest(await roads.new_path()) == pytest.approx(22.0, abs=0.5)
    assert (await roads.fleet.traffic.conflicts()).conflicts == []
    states = await roads.states()
    assert (states["one"], states["two"]) == ("superseded", "acknowledged")


async def test_a_robot_waits_for_another_at_a_crossing_and_is_sent_on(each):
    # They meet where the road from the south joins the ring at (44, 22).
    await each.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await each.drive("two", [(13.0, 22.0), (60.0, 22.0), (60.0, 40.0)], robot="r2")
    assert len((await each.fleet.traffic.conflicts()).conflicts) == 1
    resolved = await each.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert (resolved.robot, resolved.became) == ("r1", "waits")
    (hold,) = (await each.fleet.traffic.conflicts()).waiting
    assert (hold.robot, hold.other, hold.by) == ("r1", "r2", "Ada")
    assert (await each.fleet.traffic.conflicts()).conflicts == []
    points = await each.new_path()
    assert points[-1] == [hold.x, hold.y]
    await each.take()
    assert (await each.states())["one"] == "superseded"
    await each.restart()
    each.now += 10
    await each.at(hold.x, hold.y, v=0.0)
    await each.at(24.0, 22.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    assert await each.take() == []
    each.now = hold.until + 1
    # The other is late: the one that waits is not sent on by the clock alone.
    there = 44.0 - math.dist((hold.x, hold.y), (44.0, 22.0))
    await each.at(there, 22.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    assert await each.take() == []
    for x in range(44, 61, 4):
        await each.at(float(x), 22.0, v=1.0, robot="r2")
    await each.at(60.0, 26.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    rest = await each.new_path()
    assert rest[0] == [hold.x, hold.y]
    assert rest[-1] == [90.0, 22.0]
    assert (await each.fleet.traffic.conflicts()).waiting == []


async def test_a_robot_with_a_target_waits_in_the_same_way_and_keeps_its_task(roads):
    await roads.ready()
    await roads.at(16.0, 8.0, v=1.0)
    await roads.send("cone", x=92.0, y=22.0, cone=True)
    await roads.take()
    outcome = await roads.fleet.receive("r1", "websocket", GetPath(), 7)
    await roads.fleet.finish([outcome], [], acks=False)
    await roads.take()
    metres = math.dist((16, 8), (44, 22)) + 1
    await roads.drive("two", [(44.0 - metres, 22.0), (60.0, 22.0), (60.0, 40.0)], robot="r2")
    resolved = await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert resolved.command == "command-cone"
    (hold,) = (await roads.fleet.traffic.conflicts()).waiting
    assert (await roads.new_path())[-1] == [hold.x, hold.y]
    await roads.take()
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
    await roads.drive("two", [(13.0, 22.0), (60.0, 22.0), (60.0, 40.0)], robot="r2")
    await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    await roads.send("other", x=20.0, y=8.0)
    await roads.fleet.watch_roads()
    assert (await roads.fleet.traffic.conflicts()).waiting == []


async def test_who_cannot_give_way_says_why_and_nothing_changes(roads):
    await roads.drive("one", [(20.0, 8.0), (40.0, 8.0)])
    await roads.ready("r2")
    await roads.at(60.0, 8.0, robot="r2")
    with pytest.raises(RefusedError, match="not in each other's way now; nothing was done"):
        await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    await roads.drive("longer", [(20.0, 8.0), (100.0, 8.0)])
    with pytest.raises(RefusedError, match="r2 has no task or waits already"):
        await roads.fleet.traffic.resolve(ResolveConflict("r2", "r1"), "Ada")
    before = await roads.states()
    with pytest.raises(RefusedError, match="r1 cannot give way to r2: neither waiting nor another way"):
        await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    assert await roads.states() == before


async def wait_at_the_crossing(roads):
    """Let r1 stand where it waits for r2, the first part of its way driven; return how it waits."""
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (60.0, 22.0), (60.0, 40.0)], robot="r2")
    await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.traffic.conflicts()).waiting
    await roads.take()
    for share in (0.25, 0.5, 0.75, 1.0):
        await roads.at(16.0 + share * (hold.x - 16.0), 8.0 + share * (hold.y - 8.0), v=1.0 - share)
    assert roads.fleet.ways.of("r1") is None
    return hold


async def test_a_robot_that_is_aborted_while_it_waits_is_sent_on_by_nobody(each):
    hold = await wait_at_the_crossing(each)
    await each.fleet.orders.abort(AbortTask("command-abort", "r1"), "Ada")
    assert await each.take() == ["Abort"]
    await each.at(hold.x, hold.y)
    assert (await each.states())["abort"] == "reached"
    assert each.sql("select robot from holds") == []
    await each.restart()
    await each.at(60.0, 40.0, robot="r2")
    each.now = hold.until + 10
    await each.at(hold.x, hold.y)
    await each.fleet.watch_roads()
    assert await each.take() == []


async def test_who_waits_is_stored_with_what_sends_it_there_or_nothing_is(roads, monkeypatch):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (60.0, 22.0), (60.0, 40.0)], robot="r2")

    def full(_connection, _row):
        raise StoreError("the disk is full")

    monkeypatch.setattr(stored_closures, "hold", full)
    before = await roads.states()
    with pytest.raises(StoreError, match="the disk is full"):
        await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert await roads.states() == before
    assert await roads.take() == []
    assert (await roads.fleet.traffic.conflicts()).waiting == []


async def test_a_robot_that_is_to_stop_is_led_nowhere_when_its_road_is_closed(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.fleet.orders.abort(AbortTask("command-abort", "r1"), "Ada")
    (robot,) = (await roads.close_road(*SOUTH)).robots
    assert (robot.became, "told otherwise in the meantime" in robot.text) == ("failed", True)
    assert await roads.take() == ["Abort"]


async def test_a_robot_with_a_target_that_is_to_stop_is_led_nowhere_either(roads):
    await roads.ready()
    await roads.at(10.0, 8.0)
    await roads.send("cone", x=126.0, y=8.0, cone=True)
    await roads.take()
    await roads.fleet.orders.abort(AbortTask("command-abort", "r1"), "Ada")
    assert [one.became for one in (await roads.close_road(*SOUTH)).robots] == ["failed"]
    assert await roads.take() == ["Abort"]


async def test_the_task_of_a_queue_goes_on_by_another_way_when_its_road_is_closed(each):
    await each.ready()
    await each.take()
    await each.at(10.0, 8.0, v=1.0)
    tasks = [
        QueueTask("task-0001", 126.0, 8.0, path=[(10.0, 8.0), (126.0, 8.0)]),
        QueueTask("task-0002", 126.0, 12.0),
    ]
    await each.fleet.queues.set(SetQueue("r1", 0, tasks), "Ada")
    await each.fleet.driving.advance()
    assert await each.take() == ["SetPath"]
    (robot,) = (await each.close_road(*SOUTH, reason="tree")).robots
    assert (robot.robot, robot.became) == ("r1", "another way")
    points = await each.new_path()
    assert highest(points) == pytest.approx(22.0, abs=0.5)
    await each.take()
    (queue,) = await each.fleet.queues.read(GetQueue("r1"))
    assert queue.state is QueueState.RUNNING
    assert [one.task for one in queue.tasks] == ["task-0001", "task-0002"]
    assert queue.tasks[0].command == robot.command
    for x, y in points:
        await each.at(x, y, v=1.0)
    await each.at(126.0, 8.0)
    await each.fleet.driving.advance()
    assert await each.take() == ["SetPosEnd"]


async def set_off_with_a_queue(roads, **cone):
    """Let r1 drive the path of its first task, towards the crossing that r2 comes to as well."""
    await roads.ready()
    await roads.take()
    await roads.at(4.0, 2.0, v=1.0)
    path = [(4.0, 2.0), (16.0, 8.0), (44.0, 22.0), (90.0, 22.0)]
    tasks = [QueueTask("task-0001", 90.0, 22.0, path=path, **cone), QueueTask("task-0002", 92.0, 22.0)]
    await roads.fleet.queues.set(SetQueue("r1", 0, tasks), "Ada")
    await roads.fleet.driving.advance()
    assert await roads.take() == ["SetPath"]
    for x in (8.0, 12.0, 16.0):
        await roads.at(x, x / 2, v=1.0)
    await roads.drive("two", [(13.0, 22.0), (60.0, 22.0), (60.0, 40.0)], robot="r2")


async def queue_of(roads):
    (queue,) = await roads.fleet.queues.read(GetQueue("r1", paths=True))
    return queue


async def drive_to(roads, points):
    for x, y in points:
        await roads.at(x, y, v=1.0)
    await roads.at(*points[-1])
    await roads.fleet.driving.advance()


async def test_the_path_of_a_queue_waits_for_another_robot_and_goes_on_as_the_same_task(each):
    await set_off_with_a_queue(each)
    resolved = await each.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert (resolved.robot, resolved.became) == ("r1", "waits")
    (hold,) = (await each.fleet.traffic.conflicts()).waiting
    assert (await each.fleet.traffic.conflicts()).conflicts == []
    queue = await queue_of(each)
    assert [(one.state.value, one.label, one.reason) for one in queue.tasks] == [
        ("current", "waits for r2", None),
        ("waiting", None, "waits for r2"),
        ("waiting", None, None),
    ]
    assert (queue.tasks[0].command, queue.tasks[1].task) == (resolved.command, "task-0001")
    first = await each.new_path()
    assert first[-1] == [hold.x, hold.y] == [queue.tasks[0].x, queue.tasks[0].y]
    await each.take()
    await drive_to(each, first)
    # It stands there, and neither the queue nor a restart sends it on before the other has passed.
    await each.restart()
    each.now = hold.until + 1
    await each.at(hold.x, hold.y)
    there = 44.0 - math.dist((hold.x, hold.y), (44.0, 22.0))
    await each.at(there, 22.0, v=1.0, robot="r2")
    each.fleet.driving.look_at_all()
    await each.fleet.driving.advance()
    await each.fleet.watch_roads()
    await each.fleet.driving.advance()
    assert await each.take() == []
    assert (await queue_of(each)).state is QueueState.RUNNING
    for x in range(44, 61, 4):
        await each.at(float(x), 22.0, v=1.0, robot="r2")
    await each.at(60.0, 26.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    await each.fleet.driving.advance()
    rest = await each.new_path()
    assert (rest[0], rest[-1]) == ([hold.x, hold.y], [90.0, 22.0])
    await each.take()
    assert each.sql("select robot from holds") == []
    await drive_to(each, rest)
    queue = await queue_of(each)
    assert [one.task for one in queue.tasks] == ["task-0002"]
    assert [one.state.value for one in queue.ended] == ["done", "done"]


async def test_a_cone_whose_robot_waited_is_put_down_where_it_belongs(roads, own_site):
    settings = own_site.site.settings
    cones = replace(settings.cones, offset_ahead_m=0.4)
    own_site.take_over(replace(own_site.site, settings=replace(settings, cones=cones)))
    await set_off_with_a_queue(roads, kind=TaskKind.PLACE, theta=0.0, cone="C1")
    await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.traffic.conflicts()).waiting
    first = await roads.new_path()
    await roads.take()
    await drive_to(roads, first)
    assert (await queue_of(roads)).tasks[0].path[-1] == (90.0, 22.0)
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.fleet.watch_roads()
    await roads.fleet.driving.advance()
    rest = await roads.new_path()
    assert rest[-1] == [pytest.approx(89.6, abs=0.01), 22.0]
    await roads.take()
    await drive_to(roads, rest)
    (row,) = [row for row in await roads.deliver() if row.op == "SetPosEnd"]
    assert json.loads(row.params)["cone"] is True
    await roads.take()
    await roads.at(89.6, 22.0)
    await roads.fleet.driving.advance()
    assert (await queue_of(roads)).ended[0].deviation == pytest.approx(0.0, abs=0.01)


async def test_a_queue_that_is_changed_while_its_robot_waits_does_what_it_was_changed_to(roads):
    await set_off_with_a_queue(roads)
    await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.traffic.conflicts()).waiting
    first = await roads.new_path()
    await roads.take()
    await drive_to(roads, first)
    revision = (await queue_of(roads)).revision
    await roads.fleet.queues.set(SetQueue("r1", revision, [QueueTask("task-0009", 30.0, 10.0)]), "Ada")
    await roads.fleet.driving.advance()
    assert await roads.take() == ["SetPosEnd"]
    assert (await roads.fleet.traffic.conflicts()).waiting == []
    roads.now = hold.until + 60
    await roads.at(60.0, 40.0, robot="r2")
    await roads.fleet.watch_roads()
    assert await roads.take() == []


async def test_a_queue_that_is_paused_while_its_robot_waits_stays_paused(roads):
    await set_off_with_a_queue(roads)
    await roads.fleet.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.traffic.conflicts()).waiting
    first = await roads.new_path()
    await roads.take()
    await drive_to(roads, first)
    await roads.fleet.queues.pause(PauseQueue("r1"), "Ada")
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.fleet.watch_roads()
    await roads.fleet.driving.advance()
    assert await roads.take() == []
    assert (await roads.fleet.traffic.conflicts()).waiting == []
    await roads.fleet.queues.resume(ResumeQueue("r1", (await queue_of(roads)).revision), "Ada")
    await roads.fleet.driving.advance()
    assert (await roads.new_path())[-1] == [90.0, 22.0]


async def test_a_way_is_as_wide_as_the_robots(roads, own_site):
    there = (10.0, 8.0), (126.0, 8.0)
    site = own_site.site
    lines = [
        replace(line, width_m=1.0) if (line.points[0] == (16.0, 8.0)).all() else line
        for line in site.centrelines
    ]
    wide = replace(site.settings, version=2, routes=replace(site.settings.routes, robot_width_m=1.2))
    own_site.take_over(replace(site, centrelines=tuple(lines), settings=wide))
    await roads.fleet.site_changed()
    assert highest((await roads.way(*there)).points) == pytest.approx(22.0, abs=0.5)
    assert highest(roads.fleet.roads.path(*there).points) == pytest.approx(22.0, abs=0.5)
    broad = replace(wide, version=3, routes=replace(wide.routes, robot_width_m=50.0))
    own_site.take_over(replace(site, centrelines=tuple(lines), settings=broad))
    await roads.fleet.site_changed()
    with pytest.raises(RefusedError, match="roads nearer that may not be used: narrower than 50 m"):
        roads.fleet.roads.path(*there)
