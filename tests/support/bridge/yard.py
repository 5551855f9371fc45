"""One gateway's fleet on a real database, with a clock that the test turns."""

from __future__ import annotations

import json
from contextlib import asynccontextmanager

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.base import to_json
from robot_bridge.core.messages.commands import GetCommands, Send
from robot_bridge.core.messages.robots import OpAck, Ready, SendPos
from robot_bridge.gateway.api.robot_sql import SqlInterface
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.site.site_maps import SiteMaps
from robot_bridge.gateway.storage.database import Database
from tests.support.databases.database_client import DatabaseClient


class Yard:
    """One gateway's fleet without its sockets; ``restart`` puts another in its place on the same database."""

    def __init__(self, site: SiteMaps, url: str):
        self.site, self.url, self.clock = site, url, ManualClock(wall=1000.0)
        self.client = DatabaseClient(url)
        self.sql = self.client.sql
        self.reported = []
        self.database = self.fleet = self.link = None

    @property
    def now(self):
        """The time that the fleet goes by, which a test lets pass; ``clock.wall`` is for one that is set."""
        return self.clock.wall

    @now.setter
    def now(self, wall):
        self.clock.advance(wall - self.clock.wall)

    async def start(self):
        self.database = Database(self.url)
        await self.database.open()
        self.fleet = Fleet(self.site, self.database, clock=self.clock)
        self.fleet.listeners.add(self)
        await self.fleet.start()
        self.link = SqlInterface(self.fleet, self.database)

    async def restart(self):
        await self.database.close()
        self.reported.clear()
        await self.start()

    def notify(self, method, key, params):
        if method == "command":
            self.reported.append((key, params["state"]))

    # --- a robot over the WebSocket link, which tells the fleet what it delivered ---------------------------

    async def ready(self, robot="r1", magic=1, link="websocket", **declared):
        outcome = await self.fleet.receive(robot, link, Ready(magic, **declared), 1)
        await self.fleet.outboxes.finish([outcome], [], acks=False)

    async def deliver(self, robot="r1"):
        """Hand the robot its outbox; return the rows."""
        rows = await self.fleet.outboxes.outbox(robot, 0)
        await self.fleet.outboxes.delivered([row.id for row in rows])
        return rows

    async def ack(self, id, robot="r1", **how):
        await self.fleet.receive(robot, "websocket", OpAck(id=id, **how), None)

    async def acknowledge_all(self, robot="r1"):
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
        return list(reversed((await self.fleet.orders.newest(GetCommands(None, 1000))).commands))

    # --- the database as any other program sees it ---------------------------------------------------------

    def ask(self, robot, request):
        """Write a request as a robot does."""
        values = robot, type(request).__name__, json.dumps(to_json(request))
        self.sql("insert into rr (robot, op, params) values (?, ?, ?)", *values)

    def waiting(self, robot="r1"):
        return [op for (op,) in self.sql("select op from sa where robot = ? order by id", robot)]


@asynccontextmanager
async def yard_of_two(site_maps, url):
    """A yard whose robots r1 and r2 have taken their maps."""
    yard = Yard(site_maps, url)
    await yard.start()
    for robot in ("r1", "r2"):
        await yard.ready(robot)
        await yard.acknowledge_all(robot)
    yield yard
    await yard.database.close()
    yard.client.close()
