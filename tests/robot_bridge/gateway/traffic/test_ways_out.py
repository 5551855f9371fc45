"""What two robots in each other's way can do: told without doing it, and true when it is done."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.roads import GetWaysOut, ResolveConflict


async def ways_out(yard, robot="r1", other="r2"):
    found = await yard.fleet.roads.traffic.ways_out(GetWaysOut(robot, other))
    assert (found.robot, found.other) == (robot, other)
    return {(way.robot, way.how): way for way in found.ways}


async def conflicts(yard):
    return (await yard.fleet.roads.traffic.conflicts()).conflicts


@pytest.fixture
async def meeting(roads):
    """r1 drives along the road at y = 8, on which r3 stands."""
    await roads.drive("one", [(20.0, 8.0), (100.0, 8.0)])
    await roads.ready("r3")
    await roads.acknowledge_all("r3")
    await roads.at(60.0, 8.0, robot="r3")
    return roads


async def test_a_robot_that_passes_a_standing_one_too_near_is_foretold_with_the_clearance(meeting):
    await meeting.at(60.0, 8.7, robot="r3")
    (found,) = await conflicts(meeting)
    assert (found.robot, found.other, found.kind, found.metres) == ("r1", "r3", "standing", 0.7)
    # Two circles round 0.5 m by 0.8 m, and the margin of 0.3 m.
    assert found.clearance == pytest.approx(math.hypot(0.5, 0.8) + 0.3, abs=0.01)
    assert found.begins > meeting.now
    await meeting.at(60.0, 9.3, robot="r3")
    assert await conflicts(meeting) == []


async def test_a_standing_robot_goes_aside_and_nothing_is_sent_before_somebody_says_so(meeting):
    ways = await ways_out(meeting, "r1", "r3")
    aside = ways["r3", "aside"]
    assert aside.possible
    assert aside.points[0] == (60.0, 8.0)
    x, y = aside.points[1]
    # Beside the way of r1 by the clearance, and no further than it has to be.
    assert 1.24 <= abs(y - 8.0) < 1.8 and abs(x - 60.0) < 1.0
    assert meeting.site.site.surface_index.at(x, y) >= 0
    assert await meeting.acknowledge_all("r3") == []
    await meeting.send("aside", "SetPath", "r3", points=aside.points)
    await meeting.acknowledge_all("r3")
    assert await conflicts(meeting) == []
    assert not ways["r1", "aside"].possible
    assert "has a task" in ways["r1", "aside"].text


async def test_what_cannot_give_way_says_why_and_is_refused_so(meeting):
    ways = await ways_out(meeting, "r1", "r3")
    standing = ways["r3", "give way"]
    assert not standing.possible
    with pytest.raises(RefusedError) as refused:
        await meeting.fleet.roads.traffic.resolve(ResolveConflict("r3", "r1"), "Ada")
    assert str(refused.value) == standing.text


async def test_a_robot_that_stands_in_the_way_is_to_be_sent_aside_and_not_to_give_way(meeting):
    way = (await ways_out(meeting, "r1", "r3"))["r1", "give way"]
    assert "Send r3 aside, stop r1, or draw a route" in way.text and "Let r3" not in way.text


async def test_what_can_give_way_does_what_was_said(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.drive("two", [(119.0, 8.0), (20.0, 8.0)], robot="r2")
    way = (await ways_out(roads))["r1", "give way"]
    assert way.possible and way.text.startswith("r1 takes another way and arrives about 9 s later")
    assert (await roads.states())["one"] == "acknowledged"
    resolved = await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    assert resolved.became == "another way"


async def test_the_place_aside_is_free_of_keepouts_obstacles_and_other_robots(meeting):
    first = (await ways_out(meeting, "r1", "r3"))["r3", "aside"].points[1]
    # Somebody else stands there by now.
    await meeting.ready("r4")
    await meeting.acknowledge_all("r4")
    await meeting.at(*first, robot="r4")
    second = (await ways_out(meeting, "r1", "r3"))["r3", "aside"].points[1]
    assert math.dist(first, second) >= math.hypot(0.5, 0.8) + 0.3
    fences = meeting.site.site.fences
    for areas in (fences.keepouts, fences.obstacles):
        assert areas.near(np.array([second]), 0.47).shape[1] == 0


async def test_a_robot_that_others_reach_first_cannot_go_aside(meeting):
    await meeting.at(58.0, 8.0, v=1.0)
    aside = (await ways_out(meeting, "r1", "r3"))["r3", "aside"]
    assert not aside.possible
    assert "stop r1" in aside.text


async def test_a_robot_that_is_not_heard_cannot_go_aside(meeting):
    meeting.now += 60
    meeting.fleet.age()
    ways = await ways_out(meeting, "r1", "r3")
    assert not any(way.possible for way in ways.values())
    assert "not known where r3 is now" in ways["r3", "aside"].text


async def test_robots_that_are_not_known_are_named(meeting):
    ways = await ways_out(meeting, "r1", "r9")
    assert [way.possible for way in ways.values()] == [False] * 4
    assert "'r9'" in ways["r9", "give way"].text
