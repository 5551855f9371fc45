"""The tasks of a queue go on, as the same tasks, when roads close and others are in the way."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

from robot_bridge.core.messages.queues import (
    GetQueue,
    PauseQueue,
    QueueState,
    QueueTask,
    ResumeQueue,
    SetQueue,
    TaskKind,
)
from robot_bridge.core.messages.roads import ResolveConflict
from tests.support.bridge.road_places import SOUTH, highest


async def set_off_with_a_queue(roads, **cone):
    """Let r1 drive the path of its first task, towards the crossing that r2 comes to as well."""
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(4.0, 2.0, v=1.0)
    path = [(4.0, 2.0), (16.0, 8.0), (44.0, 22.0), (90.0, 22.0)]
    tasks = [QueueTask("task-0001", 90.0, 22.0, path=path, **cone), QueueTask("task-0002", 92.0, 22.0)]
    await roads.fleet.queues.set(SetQueue("r1", 0, tasks), "Ada")
    await roads.fleet.driving.advance()
    assert await roads.acknowledge_all() == ["SetPath"]
    for x in (8.0, 12.0, 16.0):
        await roads.at(x, x / 2, v=1.0)
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")


async def queue_of(roads):
    (queue,) = (await roads.fleet.queues.read(GetQueue("r1", paths=True))).queues
    return queue


async def drive_to(roads, points):
    for x, y in points:
        await roads.at(x, y, v=1.0)
    await roads.at(*points[-1])
    await roads.fleet.driving.advance()


async def test_the_task_of_a_queue_goes_on_by_another_way_when_its_road_is_closed(each):
    await each.ready()
    await each.acknowledge_all()
    await each.at(10.0, 8.0, v=1.0)
    tasks = [
        QueueTask("task-0001", 126.0, 8.0, path=[(10.0, 8.0), (126.0, 8.0)]),
        QueueTask("task-0002", 126.0, 12.0),
    ]
    await each.fleet.queues.set(SetQueue("r1", 0, tasks), "Ada")
    await each.fleet.driving.advance()
    assert await each.acknowledge_all() == ["SetPath"]
    (robot,) = (await each.close_road(*SOUTH, reason="tree")).robots
    assert (robot.robot, robot.became) == ("r1", "another way")
    points = await each.new_path()
    assert highest(points) == pytest.approx(22.0, abs=0.5)
    await each.acknowledge_all()
    (queue,) = (await each.fleet.queues.read(GetQueue("r1"))).queues
    assert queue.state is QueueState.RUNNING
    assert [one.task for one in queue.tasks] == ["task-0001", "task-0002"]
    assert queue.tasks[0].command == robot.command
    for x, y in points:
        await each.at(x, y, v=1.0)
    await each.at(126.0, 8.0)
    await each.fleet.driving.advance()
    # The next has no path of its own: the gateway finds one.
    assert await each.acknowledge_all() == ["SetPath"]


async def test_the_path_of_a_queue_waits_for_another_robot_and_goes_on_as_the_same_task(each):
    await set_off_with_a_queue(each)
    resolved = await each.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    assert (resolved.robot, resolved.became) == ("r1", "waits")
    (hold,) = (await each.fleet.roads.traffic.conflicts()).waiting
    assert (await each.fleet.roads.traffic.conflicts()).conflicts == []
    queue = await queue_of(each)
    assert [(one.state.value, one.label, one.reason) for one in queue.tasks] == [
        ("current", "waits for r2", None),
        ("waiting", None, "waits for r2"),
        ("waiting", None, None),
    ]
    assert (queue.tasks[0].command, queue.tasks[1].task) == (resolved.command, "task-0001")
    first = await each.new_path()
    assert first[-1] == [hold.x, hold.y] == [queue.tasks[0].x, queue.tasks[0].y]
    await each.acknowledge_all()
    await drive_to(each, first)
    # It stands there, and neither the queue nor a restart sends it on before the other has passed.
    await each.restart()
    each.now = hold.until + 1
    await each.at(hold.x, hold.y)
    there = 44.0 - math.dist((hold.x, hold.y), (44.0, 22.0))
    await each.at(there, 22.0, v=1.0, robot="r2")
    each.fleet.driving.schedule_all()
    await each.fleet.driving.advance()
    await each.fleet.watch_roads()
    await each.fleet.driving.advance()
    assert await each.acknowledge_all() == []
    assert (await queue_of(each)).state is QueueState.RUNNING
    for x in range(44, 61, 4):
        await each.at(float(x), 22.0, v=1.0, robot="r2")
    await each.at(60.0, 26.0, v=1.0, robot="r2")
    await each.fleet.watch_roads()
    await each.fleet.driving.advance()
    rest = await each.new_path()
    assert (rest[0], rest[-1]) == ([hold.x, hold.y], [90.0, 22.0])
    await each.acknowledge_all()
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
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    first = await roads.new_path()
    await roads.acknowledge_all()
    await drive_to(roads, first)
    assert (await queue_of(roads)).tasks[0].path[-1] == (90.0, 22.0)
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.fleet.watch_roads()
    await roads.fleet.driving.advance()
    rest = await roads.new_path()
    assert rest[-1] == [pytest.approx(89.6, abs=0.01), 22.0]
    await roads.acknowledge_all()
    await drive_to(roads, rest)
    (row,) = [row for row in await roads.deliver() if row.op == "SetPosEnd"]
    assert json.loads(row.params)["cone"] is True
    await roads.acknowledge_all()
    await roads.at(89.6, 22.0)
    await roads.fleet.driving.advance()
    assert (await queue_of(roads)).ended[0].deviation == pytest.approx(0.0, abs=0.01)


async def test_a_queue_that_is_changed_while_its_robot_waits_does_what_it_was_changed_to(roads):
    await set_off_with_a_queue(roads)
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    first = await roads.new_path()
    await roads.acknowledge_all()
    await drive_to(roads, first)
    revision = (await queue_of(roads)).revision
    await roads.fleet.queues.set(SetQueue("r1", revision, [QueueTask("task-0009", 30.0, 10.0)]), "Ada")
    await roads.fleet.driving.advance()
    assert await roads.acknowledge_all() == ["SetPath"]
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == []
    roads.now = hold.until + 60
    await roads.at(60.0, 40.0, robot="r2")
    await roads.fleet.watch_roads()
    assert await roads.acknowledge_all() == []


async def test_a_queue_that_is_paused_while_its_robot_waits_stays_paused(roads):
    await set_off_with_a_queue(roads)
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    first = await roads.new_path()
    await roads.acknowledge_all()
    await drive_to(roads, first)
    await roads.fleet.queues.pause(PauseQueue("r1"), "Ada")
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.fleet.watch_roads()
    await roads.fleet.driving.advance()
    assert await roads.acknowledge_all() == []
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == []
    await roads.fleet.queues.resume(ResumeQueue("r1", (await queue_of(roads)).revision), "Ada")
    await roads.fleet.driving.advance()
    assert (await roads.new_path())[-1] == [90.0, 22.0]
