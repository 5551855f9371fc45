"""By which way a robot comes to a target: no robot drives straight through a keepout unnoticed.

The sample site's keepout *Water basin* lies around (66, 32), between (60, 22) and (70.26, 42.57).
"""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.commands import GetCommands, Send, SetPositions, TargetPosition
from robot_bridge.core.messages.positions import GetPositions
from robot_bridge.core.messages.queues import GetQueue, PauseRobot, QueueState, QueueTask, SetQueue, TaskKind
from robot_bridge.core.messages.records import GetPlacements
from robot_bridge.core.messages.roads import CloseRoad, ResolveConflict
from robot_bridge.core.messages.robots import GetPath, GetPosEnd, SetPath, SetPosEnd

START, GOAL = (60.0, 22.0), (70.26, 42.57)
CROSSES = (
    r"does not ask for its path, and the straight way that it drives from \(60\.00, 22\.00\) to "
    r"\(70\.26, 42\.57\) leads through the keepout 'Water basin': choose a place or way outside it, or send "
    "it with an override"
)

TO_PATH = (
    r"the straight way from where the robot is, \(60\.00, 22\.00\), to the first point of its path, "
    r"\(70\.26, 42\.57\), leads through the keepout 'Water basin': choose a place or way outside it, or send "
    "it with an override"
)


def cone_at(place, override=None):
    params = {"x": place[0], "y": place[1], "cone": True}
    return Send("command-cone", "r1", "SetPosEnd", params, override=override)


async def stand(yard, place=START, **declared):
    await yard.ready(**declared)
    await yard.acknowledge_all()
    await yard.at(*place)


async def queue_of(yard):
    (queue,) = (await yard.fleet.queues.read(GetQueue("r1", paths=True, ended=5))).queues
    return queue


async def give(yard, *tasks):
    revision = (await queue_of(yard)).revision
    await yard.fleet.queues.set(SetQueue("r1", revision, list(tasks)), "Ada")
    await yard.fleet.driving.advance()


async def sent(yard):
    """Return the messages that wait for r1, which takes them on."""
    rows = await yard.deliver()
    for row in rows:
        await yard.ack(row.id)
    return [(row.op, json.loads(row.params)) for row in rows]


async def drive(yard, points):
    for x, y in points:
        await yard.at(x, y, v=1.0)
    await yard.at(*points[-1])
    await yard.fleet.driving.advance()


async def test_a_robot_that_does_not_ask_is_sent_to_no_target_straight_through_a_keepout(roads):
    await stand(roads)
    with pytest.raises(RefusedError, match=CROSSES):
        await roads.fleet.orders.send(cone_at(GOAL), "Ada")
    with pytest.raises(RefusedError, match=CROSSES):
        await roads.fleet.orders.set_positions(SetPositions([TargetPosition("r1", *GOAL)]), "Ada")
    assert await roads.states() == {}
    report = await roads.fleet.orders.send(cone_at(GOAL, override="drained"), "Ada")
    assert report.steps[0].reason == "override: drained"


async def test_so_it_is_from_where_it_was_last_after_a_restart_and_without_roads(yard):
    await stand(yard)
    await yard.fleet.save()
    await yard.restart()
    with pytest.raises(RefusedError, match=CROSSES):
        await yard.fleet.orders.send(cone_at(GOAL), "Ada")


@pytest.mark.parametrize("declared", [{}, {"asks_path": True, "path_cones": True}])
async def test_no_robot_drives_straight_through_a_keepout_to_where_its_path_begins(roads, declared):
    await stand(roads, **declared)
    beyond = Send("command-path", "r1", "SetPath", {"points": [GOAL, (90.0, 50.0)]})
    with pytest.raises(RefusedError, match=TO_PATH):
        await roads.fleet.orders.send(beyond, "Ada")
    assert await roads.states() == {}
    report = await roads.fleet.orders.send(replace(beyond, override="drained"), "Ada")
    assert report.steps[0].reason == "override: drained"
    # Out of the keepout it may drive, and round it to the same path.
    await roads.at(66.0, 32.0)
    await roads.fleet.orders.send(replace(beyond, command="command-out"), "Ada")
    await roads.at(*GOAL)
    await roads.fleet.orders.send(replace(beyond, command="command-here"), "Ada")


async def test_beside_the_keepout_out_of_it_and_into_it_a_straight_way_is_no_matter(roads):
    await stand(roads, (40.0, 40.0))
    assert (await roads.fleet.orders.send(cone_at(GOAL), "Ada")).state.value == "queued"
    await roads.at(66.0, 32.0)
    await roads.send("out", x=40.0, y=32.0)
    await roads.at(*START)
    into = {"x": 66.0, "y": 32.0}
    await roads.fleet.orders.send(Send("command-into", "r1", "SetPosEnd", into, override="drained"), "Ada")


async def test_a_robot_that_asks_is_answered_the_way_that_was_shown(roads):
    await stand(roads, asks_path=True)
    shown = await roads.way(START, GOAL)
    await roads.fleet.orders.send(cone_at(GOAL), "Ada")
    outcome = await roads.fleet.receive("r1", "websocket", GetPath(), 9)
    assert outcome.answer == SetPath(shown.points)
    assert len(shown.points) > 20


async def test_what_robots_declare_is_told_and_forgotten_when_they_declare_nothing(roads):
    for declared, told in (
        ({}, None),
        ({"asks_path": True}, "asks"),
        ({"path_cones": True}, "cones"),
        ({"asks_path": True, "path_cones": True}, "asks and cones"),
        ({"asks_path": False}, None),
    ):
        await roads.ready(**declared)
        assert [report.paths for report in roads.fleet.reports()] == [told]
        (row,) = (await roads.fleet.views.now(GetPositions())).values["robots"]
        assert row.paths == told


async def test_what_robots_declare_counts_across_a_restart(yard):
    declared = {"r1": {"asks_path": True}, "r2": {"path_cones": True}, "r3": {}}
    for robot, what in declared.items():
        await yard.ready(robot, **what)
    await yard.at(*START)
    await yard.fleet.save()
    await yard.restart()
    assert {report.robot: report.paths for report in yard.fleet.reports()} == {
        "r1": "asks",
        "r2": "cones",
        "r3": None,
    }
    # It asks for its way: no straight one through the keepout is held against it.
    assert (await yard.fleet.orders.send(cone_at(GOAL), "Ada")).state.value == "queued"


async def test_a_declaration_that_cannot_be_read_any_more_counts_as_none(yard, caplog):
    await yard.ready(asks_path=True)
    await yard.fleet.save()
    yard.sql("update robots set paths = 'flies'")
    await yard.restart()
    assert [report.paths for report in yard.fleet.reports()] == [None]
    assert "what robot r1 declared of paths cannot be read in the database" in caplog.text


async def test_a_path_with_a_cone_is_followed_to_its_end(roads):
    await stand(roads, path_cones=True)
    points = (await roads.way(START, GOAL)).points
    await roads.send("way", "SetPath", points=points, cone=True)
    ((op, params),) = await sent(roads)
    assert (op, params["cone"], params["points"]) == ("SetPath", True, [list(point) for point in points])
    end = (await roads.fleet.receive("r1", "websocket", GetPosEnd(), 8)).answer
    assert end == SetPosEnd(*GOAL, cone=True)
    left = (await roads.fleet.receive("r1", "websocket", GetPath(), 9)).answer
    assert (left.cone, left.points[-1]) == (True, GOAL)
    await drive(roads, points)
    assert await roads.states() == {"way": "reached"}
    (report,) = (await roads.fleet.orders.newest(GetCommands("r1", 1))).commands
    assert report.deviation == 0.0


async def test_a_path_with_a_cone_is_refused_for_a_robot_that_would_not_place_it(roads):
    await stand(roads, asks_path=True)
    for what in ("cone", "collect"):
        with pytest.raises(RefusedError, match=r"'r1' has not declared in Ready .* take it for a SetPosEnd"):
            await roads.send("way", "SetPath", points=[START, (40.0, 22.0)], **{what: True})
    await roads.send("way", "SetPath", points=[START, (40.0, 22.0)])


async def test_led_round_a_closed_road_it_has_its_cone_still(roads):
    await stand(roads, (10.0, 8.0), path_cones=True)
    await roads.send("way", "SetPath", points=[(10.0, 8.0), (126.0, 8.0)], cone=True)
    await sent(roads)
    (robot,) = (await roads.fleet.roads.closures.close(CloseRoad("closure-1", 70.0, 8.0), "Ada")).robots
    assert robot.became == "another way"
    ((op, params),) = await sent(roads)
    assert (op, params["cone"], params["points"][-1]) == ("SetPath", True, [126.0, 8.0])


async def test_one_that_waits_for_another_has_its_cone_when_it_goes_on(roads):
    await roads.ready(path_cones=True)
    await roads.acknowledge_all()
    await roads.at(16.0, 8.0, v=1.0)
    await roads.send("way", "SetPath", points=[(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)], cone=True)
    await sent(roads)
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    ((_, first),) = await sent(roads)
    assert "cone" not in first
    await drive(roads, [tuple(point) for point in first["points"]])
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.at(hold.x, hold.y)
    await roads.at(60.0, 40.0, robot="r2")
    await roads.fleet.watch_roads()
    ((_, rest),) = await sent(roads)
    assert (rest["cone"], rest["points"][-1]) == (True, [90.0, 22.0])


async def test_paused_it_is_kept_as_a_task_that_places_the_cone(roads):
    await stand(roads, path_cones=True)
    points = (await roads.way(START, GOAL)).points
    await roads.send("way", "SetPath", points=points, cone=True)
    await sent(roads)
    queue = await roads.fleet.pauses.pause(PauseRobot("r1"), "Ada")
    (task,) = queue.tasks
    assert (task.kind, (task.x, task.y)) == (TaskKind.PLACE, GOAL)


@pytest.mark.parametrize("kind", [TaskKind.PLACE, TaskKind.DRIVE])
async def test_a_task_without_a_path_is_driven_by_the_road_and_its_cone_is_placed(roads, kind):
    await stand(roads, path_cones=True)
    shown = (await roads.way(START, GOAL)).points
    await give(roads, QueueTask("task-0001", *GOAL, kind=kind))
    ((op, params),) = await sent(roads)
    assert (op, params.get("cone")) == ("SetPath", True if kind is TaskKind.PLACE else None)
    assert params["points"] == [list(point) for point in shown]
    await drive(roads, shown)
    assert [one.state.value for one in (await queue_of(roads)).ended] == ["done"]
    placed = await roads.database.run(_placed)
    assert [(one.x, one.y) for one in placed] == ([GOAL] if kind is TaskKind.PLACE else [])


def _placed(connection):
    from robot_bridge.gateway.storage.repositories import records as placements

    return placements.newest_placed_cones(connection, GetPlacements())


async def test_one_that_does_not_take_cones_with_a_path_is_not_sent_straight_through_a_keepout(roads):
    await stand(roads)
    await give(roads, QueueTask("task-0001", *GOAL, kind=TaskKind.PLACE))
    queue = await queue_of(roads)
    assert (await sent(roads), queue.state) == ([], QueueState.PAUSED)
    assert queue.reason.endswith("leads through the keepout 'Water basin'; give the task a path around it")


async def test_nor_is_any_without_roads(yard):
    await stand(yard, path_cones=True)
    await give(yard, QueueTask("task-0001", *GOAL))
    assert (await queue_of(yard)).state is QueueState.PAUSED


async def test_one_that_asks_for_its_path_is_sent_the_target_of_its_task(roads):
    await stand(roads, asks_path=True, path_cones=True)
    await give(roads, QueueTask("task-0001", *GOAL, kind=TaskKind.PLACE))
    ((op, params),) = await sent(roads)
    assert (op, params["cone"]) == ("SetPosEnd", True)


async def test_a_task_waits_for_its_way_until_the_robot_has_said_where_it_is(roads):
    await roads.ready(path_cones=True)
    await roads.acknowledge_all()
    await give(roads, QueueTask("task-0001", *GOAL))
    assert await sent(roads) == []
    assert (await queue_of(roads)).tasks[0].reason == "waits for the robot to say where it is"
    await roads.at(*START)
    roads.fleet.driving.schedule_all()
    await roads.fleet.driving.advance()
    assert [op for op, _ in await sent(roads)] == ["SetPath"]
