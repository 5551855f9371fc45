"""Robots on a site whose map is too large to be made, or to be sent, while they wait."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from dataclasses import replace

import numpy as np
import pytest

from robot_bridge.core.messages.commands import SendMap
from robot_bridge.core.messages.robots import Ready, SetMap
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.robotmap.model import PART_OF
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.settings_tables import MapSettings
from robot_bridge.core.sites.site import Site
from robot_bridge.gateway.fleet.robot_outboxes import RequestOutcome, finish_and_read
from robot_bridge.gateway.site.site_maps import AT_ONCE, SiteMaps
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import requests
from tests.support.bridge.yard import Yard

HOUSE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]])
SIDE = 40
"""houses along each side of a site of 20 m each."""
FAR = (700.0, 700.0)


def city(**maps) -> Site:
    rows = [
        OutlineRow(
            HOUSE + np.array([20.0 * x + 5, 20.0 * y + 5]), 1, 6.0, "house", f"houses:{1 + x + SIDE * y}"
        )
        for y in range(SIDE)
        for x in range(SIDE)
    ]
    bounds = SiteBounds(0.0, 0.0, 20.0 * SIDE, 20.0 * SIDE)
    settings = SiteSettings("city", "City", 1, "EPSG:32633", (430000.0, 5100000.0), bounds)
    site = Site(replace(settings, maps=MapSettings(**maps)), Outlines.from_rows(rows), (), (), ())
    assert site.segment_count > AT_ONCE
    return site


@pytest.fixture
def start(sqlite_url):
    """Start a fleet on a city whose ``[maps]`` are given: ``async with start(...) as yard``."""

    @contextlib.asynccontextmanager
    async def started(maps):
        yard = Yard(maps, sqlite_url)
        await yard.start()
        running = asyncio.create_task(yard.fleet.maps.run())
        try:
            yield yard
        finally:
            running.cancel()
            await asyncio.gather(running, return_exceptions=True)
            await yard.database.close()
            yard.client.close()

    return started


async def maps_of(yard, count):
    """Return the maps that wait for the robot, as soon as there are so many of them."""
    async with asyncio.timeout(60):
        while len(rows := await yard.fleet.outboxes.outbox("r1", 0)) < count:
            await asyncio.sleep(0.01)
    whole = yard.fleet.maps.whole_or_around
    return [decode(row.payload or await whole("r1")) for row in rows if row.op == "SetMap"]


async def quiet(yard):
    """Wait until all that was to follow has followed."""
    while not yard.fleet.outboxes.parts.empty():
        await asyncio.sleep(0.01)
    for _ in range(3):
        await asyncio.sleep(0.01)


def holds(robot_map, place):
    return robot_map.border.holds(*place)


async def test_a_robot_waits_for_no_map_and_has_the_whole_one_when_it_is_made(start, monkeypatch):
    maps, made = SiteMaps(city()), threading.Event()
    whole_map = maps.whole_map
    monkeypatch.setattr(maps, "whole_map", lambda: (made.wait(60), whole_map())[1])
    async with start(maps) as yard:
        async with asyncio.timeout(30):
            await yard.ready()
            (part,) = await maps_of(yard, 1)
            assert part.meta[PART_OF] == "0.00,0.00,800.00,800.00"
            assert 0 < len(part.obstacles) < SIDE**2
            await yard.acknowledge_all()
            made.set()
            (whole,) = await maps_of(yard, 1)
    assert len(whole.obstacles) == SIDE**2
    assert PART_OF not in whole.meta
    assert tuple(whole.border) == (0.0, 0.0, 800.0, 800.0)


async def test_a_map_that_goes_wrong_keeps_no_other_robots_from_following(start, monkeypatch, caplog):
    maps, made = SiteMaps(city()), threading.Event()
    whole_map = maps.whole_map
    monkeypatch.setattr(maps, "whole_map", lambda: (made.wait(60), whole_map())[1])
    async with start(maps) as yard:
        follow = yard.fleet.maps._follow

        async def failing_for_r2(robot):
            if robot == "r2":
                raise ZeroDivisionError("nobody foresaw it")
            await follow(robot)

        monkeypatch.setattr(yard.fleet.maps, "_follow", failing_for_r2)
        for robot in ("r2", "r1"):
            await yard.ready(robot)
        await yard.acknowledge_all()
        made.set()
        (whole,) = await maps_of(yard, 1)
    assert len(whole.obstacles) == SIDE**2
    assert "the map for robot 'r2': internal error" in caplog.text


async def test_the_whole_map_that_is_made_already_is_sent_at_once(start):
    maps = SiteMaps(city())
    maps.whole_map()
    async with start(maps) as yard:
        await yard.ready()
        (whole,) = await maps_of(yard, 1)
        await quiet(yard)
        assert len(await maps_of(yard, 1)) == 1
    assert len(whole.obstacles) == SIDE**2


async def test_a_whole_map_that_takes_long_to_be_stored_follows_a_window(start, monkeypatch):
    maps = SiteMaps(city())
    monkeypatch.setattr("robot_bridge.gateway.site.site_maps.STORED_AT_ONCE", len(maps.whole_map()) - 1)
    async with start(maps) as yard:
        await yard.ready()
        await yard.deliver()
        *part, whole = await maps_of(yard, 1)
        while len(whole.obstacles) < SIDE**2:
            part, (*_, whole) = [whole], await maps_of(yard, 1)
    assert all(one.meta[PART_OF] for one in part)


async def test_the_whole_map_is_stored_for_those_alone_who_read_rows_themselves(start, monkeypatch):
    maps = SiteMaps(city())
    monkeypatch.setattr("robot_bridge.gateway.site.site_maps.STORED_AT_ONCE", len(maps.whole_map()) - 1)
    sizes = "select length(payload) from sa where robot = ? and op = 'SetMap' order by id"
    async with start(maps) as yard:
        await yard.ready()
        await yard.send("a")
        await yard.fleet.maps.send_requested(SendMap("r1"))
        await yard.send("b")
        assert yard.sql(sizes, "r1")[-1] == (None,)
        yard.ask("r1", Ready(1))
        yard.now += 60
        while await yard.link.poll():
            pass
        stored = [size for (size,) in yard.sql(sizes, "r1")]
        assert len(stored) > 1 and all(stored)
        await yard.fleet.maps.send_requested(SendMap("r1"))
        assert (len(maps.whole_map()),) in yard.sql(sizes, "r1")


async def test_an_answer_goes_out_without_being_read_unless_more_was_written_meanwhile(start, monkeypatch):
    async with start(SiteMaps(city(largest_whole_bytes=0))) as yard:
        await yard.ready()
        await yard.acknowledge_all()
        boxes, database, looked = yard.fleet.outboxes, yard.database, []
        read, run = database.read, database.run

        async def counted(work, *arguments):
            looked.append(work)
            return await read(work, *arguments)

        async def overtaken(work, *arguments):
            done = await run(work, *arguments)
            if work is finish_and_read:
                await yard.send("b")
            return done

        async def ask():
            answer = RequestOutcome("r1", answer=SetMap(b"a map"))
            await boxes.finish([answer], [], acks=False, reader=("r1", 0, 0))

        monkeypatch.setattr(database, "read", counted)
        # The id of what a robot was sent must not come again after a power cut.
        monkeypatch.delattr(Database, "write_relaxed")
        await ask()
        assert [row.op for row in await boxes.outbox("r1", 0, 0)] == ["SetMap"]
        assert not looked
        (row,) = await boxes.outbox("r1", 0, 0)
        assert row.payload == b"a map" and looked == [requests.read_outbox]

        await ask()
        assert await boxes.outbox("r1", 1000) == []
        await ask()
        await yard.send("a")
        assert [row.op for row in await boxes.outbox("r1", 0, 0)] == ["SetMap", "SetPosEnd"]
        monkeypatch.setattr(database, "run", overtaken)
        await ask()
        stored = yard.sql("select id from sa where robot = 'r1' order by id")
        assert [(row.id,) for row in await boxes.outbox("r1", 0, 0)] == stored


async def test_a_site_beyond_its_limit_is_never_sent_whole(start):
    size = len(SiteMaps(city()).whole_map())
    assert SiteMaps(city(largest_whole_bytes=size)).whole_map() is not None
    too_large = SiteMaps(city(largest_whole_bytes=size - 1))
    assert too_large.whole_map() is None
    async with start(too_large) as yard:
        await yard.ready()
        await yard.acknowledge_all()
        await yard.at(*FAR)
        await yard.fleet.maps.send_requested(SendMap("r1"))
        (part,) = await maps_of(yard, 1)
    assert holds(part, FAR) and part.meta[PART_OF]


async def test_a_robot_whose_place_was_not_known_is_sent_what_is_around_it_once_it_is(start):
    async with start(SiteMaps(city(largest_whole_bytes=0, window_m=100.0))) as yard:
        await yard.ready()
        (middle,) = await maps_of(yard, 1)
        assert holds(middle, (400.0, 400.0)) and not holds(middle, FAR)
        await yard.acknowledge_all()
        await quiet(yard)
        await yard.at(*FAR)
        (around,) = await maps_of(yard, 1)
        assert holds(around, FAR)
        await yard.acknowledge_all()
        await yard.at(640.0, 640.0)
        await quiet(yard)
        assert not yard.waiting()


async def test_a_robot_that_is_where_it_was_known_to_be_is_sent_one_map(start):
    async with start(SiteMaps(city(largest_whole_bytes=0, window_m=100.0))) as yard:
        await yard.ready()
        await yard.acknowledge_all()
        await yard.at(*FAR)
        await maps_of(yard, 1)
        await yard.acknowledge_all()
        yard.now += 5
        await yard.ready(magic=2)
        (around,) = await maps_of(yard, 1)
        assert holds(around, FAR)
        await yard.acknowledge_all()
        await quiet(yard)
        await yard.at(*FAR)
        await quiet(yard)
        assert not yard.waiting()


async def test_a_robot_that_was_told_where_it_stands_is_sent_what_is_around_that(start):
    async with start(SiteMaps(city(largest_whole_bytes=0, window_m=100.0))) as yard:
        await yard.ready()
        await yard.acknowledge_all()
        await yard.send("a", "SetPosIni", x=FAR[0], y=FAR[1])
        await yard.acknowledge_all()
        yard.now += 5
        await yard.ready(magic=2)
        (around, *_) = await maps_of(yard, 1)
        assert holds(around, FAR)


def test_a_window_is_smaller_where_much_stands():
    site = city()
    assert site.map_near(*FAR, 200.0, 10**6).border.area == 200.0**2
    few = site.map_near(*FAR, 200.0, 400)
    assert few.border.area < 200.0**2
    assert 0 < few.segment_count <= 400
    beside = site.map_near(-500.0, 900.0, 100.0, AT_ONCE)
    assert tuple(beside.border) == (-50.0, 750.0, 50.0, 850.0)
