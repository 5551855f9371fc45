"""Cones that robots put down and collect as tasks of their queues, and the paths that lead there."""

from __future__ import annotations

import math

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.queues import MakeCurrent, QueueTask, TaskKind
from robot_bridge.core.messages.records import CollectLayout
from robot_bridge.core.messages.robots import SendPos, SetPath
from robot_bridge.gateway.storage.repositories import queues, records
from tests.support.bridge.queue_line import LANE, PLACES, drive, place, placed, task


async def test_a_cone_is_driven_to_along_its_path_and_put_down_where_the_robot_stood(line):
    await line.set(task("a", "place", path=LANE, cone="c7", layout="slalom", label="7"), task("b"))
    assert await drive(line, LANE, (50.0, 40.1)) == ["SetPath"]
    assert await line.states() == {"a": "current", "b": "waiting"}
    await line.yard.restart()
    await line.advance()
    assert await line.reach(50.0, 40.1) == ["SetPosEnd"]
    (cone,) = await placed(line, layout="slalom")
    assert (cone.cone, cone.label, cone.robot, cone.collected_at) == ("c7", "7", "r1", None)
    assert (cone.planned_x, cone.planned_y, cone.x, cone.y) == (50.0, 40.0, 50.0, 40.1)
    assert cone.deviation == pytest.approx(0.1)
    assert await line.states() == {"a": "done", "b": "current"}
    assert (await line.report()).ended[0].deviation == pytest.approx(0.1)


async def test_the_robot_is_told_to_put_the_cone_down_only_at_the_end(line):
    await line.set(task("a", "place", path=LANE))
    await drive(line, LANE, LANE[-1])
    await line.yard.acknowledge_all()
    commands = await line.yard._stored()
    assert [(c.op, c.params.get("cone")) for c in commands] == [("SetPath", None), ("SetPosEnd", True)]


async def test_a_path_that_was_broken_off_goes_on_from_where_the_robot_stands(line):
    await line.set(task("a", path=LANE, theta=0.0))
    await line.yard.acknowledge_all()
    for x in (25.0, 30.0, 35.0):
        await line.yard.at(x, 40.0 + (x - 20) / 20, v=1.0)
    await line.yard.fleet.save()
    await line.yard.fleet.orders.abort(AbortTask("abort-0001", robot="r1"), "Ada")
    await line.reach(35.0, 40.9)
    await line.resume()
    (again,) = [c for c in await line.yard._stored() if c.op == "SetPath"][1:]
    assert again.params["points"] == [[35.0, 40.9], [40.0, 41.0], [50.0, 40.0]]
    assert again.params["theta"] == 0.0


async def test_a_robot_far_off_its_path_is_not_sent_across_the_country(line):
    await line.yard.at(20.0, 60.0)
    await line.set(task("a", "place", path=LANE), task("b"))
    report = await line.report()
    assert await line.sent() == []
    assert report.state.value == "paused"
    assert report.reason.startswith("the robot stands 20.0 m off what is left of the path; drive it there")


async def test_a_robot_drives_a_path_from_its_beginning_or_not_at_all(line):
    await line.yard.at(40.0, 41.0)
    await line.set(task("a", path=LANE))
    assert "stands 20.0 m from where the path begins" in (await line.report()).reason


async def test_what_is_collected_is_marked_and_not_collected_twice(line):
    await place(line, cone="c1", layout="slalom")
    await place(line, id="b", at=(60.05, 40.0), cone="c2", layout="slalom")
    await place(line, id="c", at=(60.0, 50.0), cone="c1", layout="circle")
    found = await line.queues.collecting(CollectLayout("slalom"))
    assert [(one.cone, one.x, one.y, one.kind.value) for one in found.tasks] == [
        ("c1", 50.0, 40.1, "collect"),
        ("c2", 60.05, 40.0, "collect"),
    ]
    await line.set(found.tasks[0])
    assert (await line.queues.collecting(CollectLayout("slalom"))).in_queues == 1
    again = QueueTask("task-again", 50.0, 40.1, kind=TaskKind.COLLECT, placement=found.tasks[0].placement)
    with pytest.raises(RefusedError, match="already; leave it out"):
        await line.set(again, robot="r2")
    (row,) = await line.yard.deliver()
    assert '"collect": true' in row.params
    await line.reach(50.0, 40.1)
    first, second = sorted(await placed(line, layout="slalom"), key=lambda one: one.placement)
    assert (first.collected_by, second.collected_by) == ("r1", None)
    with pytest.raises(RefusedError, match="does not stand"):
        await line.set(again, robot="r2")
    assert [one.cone for one in (await line.queues.collecting(CollectLayout())).tasks] == ["c2", "c1"]


async def test_a_cone_that_stands_ahead_of_its_robot_is_measured_there(line, monkeypatch):
    monkeypatch.setattr(type(line.yard.site.settings.cones), "offset", (0.5, 0.0))
    with pytest.raises(RefusedError, match="has no theta"):
        await line.set(task("a", "place"))
    await line.set(task("a", "place", theta=0.0, path=LANE))
    await drive(line, LANE[:2], (49.5, 40.05))
    (command,) = [c for c in await line.yard._stored() if c.op == "SetPosEnd"]
    assert (command.params["x"], command.params["y"]) == (49.5, 40.0)
    await line.yard.acknowledge_all()
    await line.yard.fleet.receive("r1", "websocket", SendPos(49.5, 40.1, 0.1, 0.0), None)
    await line.advance()
    (cone,) = await placed(line)
    assert (cone.x, cone.y) == pytest.approx((49.5 + 0.5 * math.cos(0.1), 40.1 + 0.5 * math.sin(0.1)))
    assert cone.deviation == pytest.approx(math.dist((cone.x, cone.y), PLACES["a"]))
    assert (await line.report()).ended[0].deviation == cone.deviation


async def test_what_has_ended_is_forgotten_in_time_and_what_stands_or_waits_is_not(line):
    await place(line, cone="c1")
    await place(line, id="b", at=(60.0, 40.0), cone="c2")
    (first, _) = (await line.queues.collecting(CollectLayout())).tasks
    await line.set(first)
    await line.reach(50.0, 40.1)
    await line.set(task("c"), task("d"))
    forget = line.yard.database.run
    assert [await forget(kind.forget, line.yard.now, 100) for kind in (queues, records)] == [0, 0]
    assert [await forget(kind.forget, line.yard.now + 1, 2) for kind in (queues, records)] == [2, 1]
    assert await forget(queues.forget, line.yard.now + 1, 2) == 1
    await line.yard.restart()
    assert await line.states() == {"c": "current", "d": "waiting"}
    assert [one.cone for one in await placed(line)] == ["c2"]


async def test_a_robot_is_sent_round_a_closed_road_without_its_queue_pausing(line):
    await line.set(task("a", "place", path=LANE), task("b"))
    await line.yard.acknowledge_all()
    way = [(20.0, 40.0), (35.0, 45.0), (50.0, 40.0)]
    report = await line.yard.fleet.driving.redirect("r1", SetPath(way), "gateway", "road closed")
    await line.advance()
    assert report.params["points"] == [list(point) for point in way] or report.params["points"] == way
    assert await drive(line, way, (50.0, 40.0)) == ["SetPath"]
    await line.reach(50.0, 40.0)
    assert await line.states() == {"a": "done", "b": "current"}
    assert await line.yard.fleet.driving.redirect("r2", SetPath(way), "gateway") is None


async def test_a_cone_that_was_put_down_just_when_its_task_was_given_back_is_not_put_down_again(line):
    await line.set(task("a", "place"), task("b"))
    await line.yard.acknowledge_all()
    revision = (await line.report()).revision
    await line.queues.make_current(MakeCurrent("r1", revision, "task-000b"), "Ada")
    await line.yard.at(*PLACES["a"])
    await line.advance()
    assert await line.states() == {"b": "current", "a": "waiting"}
    await line.reach(*PLACES["b"])
    assert await line.states() == {"a": "done", "b": "done"}
    assert await line.sent() == [PLACES["a"], PLACES["b"]]
    (cone,) = await placed(line)
    assert (cone.task, cone.x, cone.y) == ("task-000a", *PLACES["a"])
