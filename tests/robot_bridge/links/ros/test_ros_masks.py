"""Keepout and speed masks of the site's own areas, on the grid of its map."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from robot_bridge.core.messages.links import SiteArea, SiteAreas, SiteRoad
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.exporters.nav2 import RasterGrid, speed_mask
from robot_bridge.core.robotmap.model import Border, RobotMap
from robot_bridge.core.sites.frame import SiteFrame
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.base.frames import FrameSettings, LinkFrame
from robot_bridge.links.ros.messages import Outgoing
from robot_bridge.links.ros.site_maps import KEEPOUT, SPEED, Masks, road_areas

pytest.importorskip("rosbags", reason="rosbags is not installed; run make setup")

from robot_bridge.links.ros2.interfaces import Interfaces

TYPES = Interfaces("kilted")
MAP = encode(RobotMap(Border(0.0, 0.0, 20.0, 10.0), (), {"version": "3"}))
YARD = SiteArea("yard", [[(2.0, 2.0), (6.0, 2.0), (6.0, 5.0), (2.0, 5.0), (2.0, 2.0)]])
ROAD = SiteRoad([(0.0, 8.0), (10.0, 8.0), (10.0, 0.0)], 1.0, 2.5)


class Link:
    """The gateway, which knows the site's areas; it answers when ``answers`` is set."""

    def __init__(self, *keepouts, roads=(), refusal=None):
        self.known, self.refusal = SiteAreas(3, list(keepouts), list(roads)), refusal
        self.asked, self.answers = [], asyncio.Event()
        self.answers.set()

    async def areas(self, box):
        self.asked.append(box)
        await self.answers.wait()
        if self.refusal is not None:
            raise CommandRefusedError(self.refusal)
        return self.known


def masks_of(link, resolution=0.5):
    site = SiteFrame("EPSG:32633", (500_000.0, 5_193_480.0), 0.0)
    frame = LinkFrame(FrameSettings(origin=(100.0, 0.0)), site)
    return Masks(TYPES.encode, Outgoing(TYPES, frame, "map"), resolution, link)


def grid_of(data):
    grid = TYPES.decode("nav_msgs/msg/OccupancyGrid", data)
    return grid, np.asarray(grid.data).reshape(grid.info.height, grid.info.width)


async def test_keepouts_are_occupied_and_all_else_is_free():
    made = await masks_of(link := Link(YARD)).of(MAP)
    grid, cells = grid_of(made.keepout)
    assert link.asked == [(0.0, 0.0, 20.0, 10.0)]
    assert (grid.header.frame_id, grid.info.width, grid.info.height) == ("map", 40, 20)
    # The robots' (0, 0) is at x = 100 of the site.
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == pytest.approx((-100.0, 0.0))
    assert cells[6, 8] == 100 and cells[6, 2] == 0 and set(np.unique(cells)) == {0, 100}


async def test_roads_limit_the_speed_to_theirs():
    made = await masks_of(Link(roads=[ROAD])).of(MAP)
    _, cells = grid_of(made.speed)
    on_road = {cells[16, 4], cells[16, 19], cells[4, 20]}
    assert {value * made.multiplier for value in on_road} == {2.5}
    assert cells[10, 4] == 0


async def test_a_site_without_areas_has_empty_masks():
    made = await masks_of(Link()).of(MAP)
    assert not grid_of(made.keepout)[1].any() and not grid_of(made.speed)[1].any()


async def test_robots_with_the_same_map_share_the_masks():
    masks = masks_of(link := Link(YARD))
    assert await masks.of(MAP) is await masks.of(bytes(MAP))
    assert len(link.asked) == 1


async def test_masks_of_the_maps_that_were_used_last_are_kept_and_of_no_others():
    first, second, third = (
        encode(RobotMap(Border(0.0, 0.0, width, 10.0), (), {"version": "3"})) for width in (20.0, 30.0, 40.0)
    )
    masks = masks_of(link := Link(YARD))
    for one in (first, second, third, third, second):
        await masks.of(one)
    assert len(link.asked) == 3
    await masks.of(first)
    assert len(link.asked) == 4


async def test_a_map_of_more_cells_than_a_robot_has_room_for_is_refused():
    wide = encode(RobotMap(Border(0.0, 0.0, 4001.0, 4001.0), (), {"version": "3"}))
    with pytest.raises(CommandRefusedError, match=r"the masks cannot be made: .*cells"):
        await masks_of(link := Link(YARD), resolution=1.0).of(wide)
    assert link.asked == []


async def test_what_cannot_be_made_is_named_and_tried_again_with_the_next_map():
    masks = masks_of(link := Link(refusal="keepouts and roads have 600000 points"))
    with pytest.raises(CommandRefusedError, match="600000 points"):
        await masks.of(MAP)
    link.refusal, link.known = None, SiteAreas(3, [SiteArea("line", [[(0.0, 0.0), (1.0, 0.0)]])], [])
    with pytest.raises(CommandRefusedError, match="the masks cannot be made: line: ring 1"):
        await masks.of(MAP)
    link.known = SiteAreas(4, [YARD], [])
    assert grid_of((await masks.of(MAP)).keepout)[1].any()


def test_a_mask_is_announced_with_its_topic():
    masks = masks_of(Link())
    made = [
        TYPES.decode("nav2_msgs/msg/CostmapFilterInfo", masks.info(kind, f"/r1/{kind}", multiplier))
        for kind, multiplier in ((KEEPOUT, 1.0), (SPEED, 0.05))
    ]
    told = [(one.type, one.filter_mask_topic, one.base, round(one.multiplier, 3)) for one in made]
    assert told == [(0, "/r1/0", 0.0, 1.0), (2, "/r1/2", 0.0, 0.05)]


def test_a_road_is_as_wide_as_it_is_also_at_its_corners():
    grid = RasterGrid(0.0, 0.0, 0.1, 200, 100)
    cells = speed_mask(grid, road_areas([ROAD])).cells > 0
    across = np.flatnonzero(cells[:, 50]) * 0.1
    assert across[-1] - across[0] == pytest.approx(1.0, abs=0.15)
    assert cells[80, 100] and cells[83, 102] and not cells[84, 106]


def test_a_point_that_is_told_twice_is_no_leg():
    (corner,) = road_areas([SiteRoad([(1.0, 1.0), (1.0, 1.0)], 2.0, 1.0)])[:1]
    assert np.isfinite(corner.rings[0]).all()
