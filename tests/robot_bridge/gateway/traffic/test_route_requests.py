"""Ways that operators ask for: what they say of themselves, and what they keep away from."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.roads import GetRoute
from tests.support.bridge.road_places import highest


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
    assert highest(roads.fleet.roads.planner.path(*there).points) == pytest.approx(22.0, abs=0.5)
    broad = replace(wide, version=3, routes=replace(wide.routes, robot_width_m=50.0))
    own_site.take_over(replace(site, centrelines=tuple(lines), settings=broad))
    await roads.fleet.site_changed()
    with pytest.raises(RefusedError, match="wide, narrower than 50 m"):
        roads.fleet.roads.planner.path(*there)
