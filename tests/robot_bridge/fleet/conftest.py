"""A fleet on a real database of each kind and the real sample site, with a clock that the test turns."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from database_client import DatabaseClient

sys.path.insert(0, str(Path(__file__).parent))

from queue_line import Line

from robot_bridge.errors import UncertainError
from robot_bridge.fleet import Fleet
from robot_bridge.links.sql import SqlLink
from robot_bridge.messages import (
    CloseRoad,
    GetRoute,
    OpAck,
    OpenRoad,
    Ready,
    ResolveConflict,
    Send,
    SendPos,
    to_json,
)
from robot_bridge.road_traffic.road_planning import RoadPlanner
from robot_bridge.road_traffic.road_requests import route
from robot_bridge.site_maps import SiteMaps
from robot_bridge.sites.publication import read_site
from robot_bridge.store.database import Database


class Yard:
    """One gateway's fleet without its sockets; ``restart`` puts another in its place on the same database."""

    def __init__(self, site: SiteMaps, url: str):
        self.site, self.url, self.now = site, url, 1000.0
        self.client = DatabaseClient(url)
        self.sql = self.client.sql
        self.told = []
        self.database = self.fleet = self.link = None

    async def start(self):
        self.database = Database(self.url)
        await self.database.open()
        self.fleet = Fleet(self.site, self.database, clock=lambda: self.now)
        self.fleet.listeners.add(self)
        await self.fleet.start()
        self.link = SqlLink(self.fleet, self.database)

    async def restart(self):
        await self.database.close()
        self.told.clear()
        await self.start()

    def notify(self, method, key, params):
        if method == "command":
            self.told.append((key, params["state"]))

    # --- a robot over the WebSocket link, which tells the fleet what it delivered ---------------------------

    async def ready(self, robot="r1", magic=1, link="websocket"):
        outcome = await self.fleet.receive(robot, link, Ready(magic), 1)
        await self.fleet.mailboxes.finish([outcome], [], acks=False)

    async def deliver(self, robot="r1"):
        """Hand the robot its outbox; return the rows."""
        rows = await self.fleet.mailboxes.outbox(robot, 0)
        await self.fleet.mailboxes.delivered([row.id for row in rows])
        return rows

    async def ack(self, id, robot="r1", **how):
        await self.fleet.receive(robot, "websocket", OpAck(id=id, **how), None)

    async def take(self, robot="r1"):
        """Let the robot take on all that waits for it; return the operation codes."""
        rows = await self.deliver(robot)
        for row in rows:
            await self.ack(row.id, robot)
        return [row.op for row in rows]

    async def at(self, x, y, v=0.0, robot="r1", link="websocket"):
        await self.fleet.receive(robot, link, SendPos(x, y, 0.0, v), None)

    # --- an operator ---------------------------------------------------------------------------------------

    async def send(self, id, op="SetPosEnd", robot="r1", **params):
        if op == "SetPosEnd":
            params = {"x": 50.0, "y": 40.0, **params}
        return await self.fleet.orders.send(Send(f"command-{id}", robot, op, params), "Ada")

    async def states(self):
        """The state of every command as it is stored, oldest first, by the id's end."""
        return {c.command.removeprefix("command-"): c.state.value for c in await self._stored()}

    async def steps(self, id):
        (found,) = [c for c in await self._stored() if c.command == f"command-{id}"]
        return [step.state.value for step in found.steps]

    async def reason(self, id):
        (found,) = [c for c in await self._stored() if c.command == f"command-{id}"]
        return found.steps[-1].reason

    async def _stored(self):
        return list(reversed(await self.fleet.commands(None, 1000)))

    # --- the database as any other program sees it ---------------------------------------------------------

    def ask(self, robot, request):
        """Write a request as a robot does."""
        values = robot, type(request).__name__, json.dumps(to_json(request))
        self.sql("insert into rr (robot, op, params) values (?, ?, ?)", *values)

    def waiting(self, robot="r1"):
        return [op for (op,) in self.sql("select op from sa where robot = ? order by id", robot)]


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
        await yard.take(robot)
        await yard.at(20.0, 40.0, robot=robot)
    return Line(yard)


class RoadYard(Yard):
    """A yard whose paths follow the roads; it keeps the newest news of each kind."""

    async def start(self):
        self.news = {}
        self.database = Database(self.url)
        await self.database.open()
        planner = RoadPlanner(lambda: self.site.site)
        self.fleet = Fleet(self.site, self.database, clock=lambda: self.now, planner=planner)
        self.fleet.listeners.add(self)
        await self.fleet.start()
        self.link = SqlLink(self.fleet, self.database)

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
        return await route(self.fleet.roads.planner, self.fleet.robots, self.fleet.roads.ways, request)

    async def drive(self, id, points, robot="r1"):
        """Send a robot, which has plugged in at the first point, along ``points``; it takes that on."""
        if robot not in self.fleet.robots:
            await self.ready(robot)
        await self.at(*points[0], v=1.0, robot=robot)
        await self.send(id, "SetPath", robot, points=points)
        await self.take(robot)

    async def wait_at_the_crossing(self):
        """Let r1 stand where it waits for r2, the first part of its way driven; return how it waits."""
        await self.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
        await self.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
        await self.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
        (hold,) = (await self.fleet.roads.traffic.conflicts()).waiting
        await self.take()
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
