"""Closed roads: nobody is sent along one, and whoever is on the way there is led round it, or stopped."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.roads import CloseRoad
from robot_bridge.core.messages.robots import GetPath
from robot_bridge.core.messages.safety import EmergencyStop
from tests.support.bridge.road_places import SOUTH, highest


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
    assert each.fleet.roads.closures.report().closures == []


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
    assert len(roads.fleet.roads.closures.report().closures) == 1
    roads.now += 1
    await roads.fleet.watch_roads()
    assert roads.fleet.roads.closures.report().closures == []
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
    (report,) = roads.fleet.roads.closures.report().closures
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
    await roads.acknowledge_all()
    outcome = await roads.fleet.receive("r1", "websocket", GetPath(), 7)
    assert highest(outcome.answer.points) == pytest.approx(8.0, abs=0.01)
    await roads.fleet.outboxes.finish([outcome], [], acks=False)
    await roads.acknowledge_all()
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
    assert await roads.acknowledge_all() == ["Abort"]
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


async def test_a_robot_that_is_to_stop_is_led_nowhere_when_its_road_is_closed(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.fleet.orders.abort(AbortTask("command-abort", "r1"), "Ada")
    (robot,) = (await roads.close_road(*SOUTH)).robots
    assert (robot.became, "has another command by now" in robot.text) == ("failed", True)
    assert await roads.acknowledge_all() == ["Abort"]


async def test_a_robot_with_a_target_that_is_to_stop_is_led_nowhere_either(roads):
    await roads.ready()
    await roads.at(10.0, 8.0)
    await roads.send("cone", x=126.0, y=8.0, cone=True)
    await roads.acknowledge_all()
    await roads.fleet.orders.abort(AbortTask("command-abort", "r1"), "Ada")
    assert [one.became for one in (await roads.close_road(*SOUTH)).robots] == ["failed"]
    assert await roads.acknowledge_all() == ["Abort"]
