"""A fleet on a real database of each kind and the real sample site, with a clock that the test turns."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.errors import UncertainError
from robot_bridge.core.messages.roads import CloseRoad, GetRoute, OpenRoad, ResolveConflict
from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway.api.robot_sql import SqlInterface
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.site.site_maps import SiteMaps
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.traffic.road_planning import RoadPlanner, route_for_operator
from tests.support.bridge.queue_line import Line
from tests.support.bridge.yard import Yard, yard_of_two


@pytest.fixture(scope="session")
def site_maps(sample_site) -> SiteMaps:
    return SiteMaps(read_site(sample_site))


@pytest.fixture
def lose(monkeypatch):
    """Let the next transaction raise ``error``, of ``work`` or of anything: ``lose(yard, work, done)``."""

    def lose(yard, work, done, error=UncertainError):
        run = yard.database.run

        async def lost(asked, *arguments):
            if work not in (None, asked):
                return await run(asked, *arguments)
            monkeypatch.setattr(yard.database, "run", run)
            if done:
                await run(asked, *arguments)
            raise error("the connection was lost during the commit")

        monkeypatch.setattr(yard.database, "run", lost)

    return lose


@pytest.fixture(params=["sqlite", "postgresql", "mariadb"])
def database_url(request, new_database) -> str:
    """An empty database of each kind, with the tables."""
    return new_database(request.param)


@pytest.fixture
async def yard(site_maps, database_url):
    yard = Yard(site_maps, database_url)
    await yard.start()
    yield yard
    await yard.database.close()
    yard.client.close()


@pytest.fixture
async def line(yard):
    """A yard whose robot r1 stands at (20, 40)."""
    for robot in ("r1", "r2"):
        await yard.ready(robot)
        await yard.acknowledge_all(robot)
        await yard.at(20.0, 40.0, robot=robot)
    return Line(yard)


class RoadYard(Yard):
    """A yard whose paths follow the roads; it keeps the newest news of each kind."""

    async def start(self):
        self.news = {}
        self.database = Database(self.url)
        await self.database.open()
        planner = RoadPlanner(self.site)
        self.fleet = Fleet(self.site, self.database, clock=self.clock, planner=planner)
        self.fleet.listeners.add(self)
        await self.fleet.start()
        self.link = SqlInterface(self.fleet, self.database)

    def notify(self, method, key, params):
        super().notify(method, key, params)
        self.news[method] = params

    async def close_road(self, x, y, id="closure-1", **how):
        return await self.fleet.roads.closures.close(CloseRoad(id, x, y, **how), "Ada")

    async def open_road(self, id="closure-1"):
        return await self.fleet.roads.closures.open(OpenRoad(id), "Bob")

    async def way(self, start, goal, **how):
        return await self.route(GetRoute(*goal, start=start, **how))

    async def route(self, request):
        return await route_for_operator(
            self.fleet.roads.planner, self.fleet.robots, self.fleet.roads.ways, request
        )

    async def drive(self, id, points, robot="r1"):
        """Send a robot, which has plugged in at the first point, along ``points``; it takes that on."""
        if robot not in self.fleet.robots:
            await self.ready(robot)
        await self.at(*points[0], v=1.0, robot=robot)
        await self.send(id, "SetPath", robot, points=points)
        await self.acknowledge_all(robot)

    async def wait_at_the_crossing(self):
        """Let r1 stand where it waits for r2, the first part of its way driven; return how it waits."""
        await self.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
        await self.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
        await self.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
        (hold,) = (await self.fleet.roads.traffic.conflicts()).waiting
        await self.acknowledge_all()
        for share in (0.25, 0.5, 0.75, 1.0):
            await self.at(16.0 + share * (hold.x - 16.0), 8.0 + share * (hold.y - 8.0), v=1.0 - share)
        assert self.fleet.roads.ways.of("r1") is None
        return hold

    async def new_path(self, robot="r1"):
        """Return the newest path that waits for the robot."""
        rows = [row for row in await self.deliver(robot) if row.op == "SetPath"]
        return json.loads(rows[-1].params)["points"]


@pytest.fixture
def own_site(site_maps):
    return SiteMaps(site_maps.site)


@pytest.fixture
def sqlite_url(new_database) -> str:
    """An empty SQLite database with the tables."""
    return new_database("sqlite")


@pytest.fixture
async def two(site_maps, sqlite_url):
    """A yard on SQLite whose robots r1 and r2 have taken their maps."""
    async with yard_of_two(site_maps, sqlite_url) as yard:
        yield yard


@pytest.fixture
async def roads(own_site, sqlite_url):
    yard = RoadYard(own_site, sqlite_url)
    await yard.start()
    yield yard
    await yard.database.close()
    yard.client.close()


@pytest.fixture
async def each(own_site, database_url):
    """A yard with roads, on each kind of database."""
    yard = RoadYard(own_site, database_url)
    await yard.start()
    yield yard
    await yard.database.close()
    yard.client.close()
