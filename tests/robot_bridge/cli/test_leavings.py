"""What connections leave behind in a gateway goes, though Python looks at old objects rarely."""

from __future__ import annotations

import asyncio
import gc

import pytest
from websockets.asyncio.client import connect

from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.core.sites.settings_tables import LimitSettings, LinkOptions
from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway import app
from robot_bridge.gateway import monitoring as tasks
from robot_bridge.gateway.api.metrics_and_queries import SiteQueries
from robot_bridge.gateway.auth.authorisation import AuthGate
from robot_bridge.gateway.auth.client_connection import ClientConnection
from robot_bridge.gateway.field.page import FieldPage
from robot_bridge.gateway.fleet.link_supervision import LinkProcesses
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.model.events import RequestHandlers
from robot_bridge.gateway.site.site_maps import SiteMaps
from robot_bridge.gateway.storage.database import Database

COMINGS = 12


@pytest.fixture
async def running(sample_site, tmp_path):
    """A gateway that serves the sample site, and its port."""
    database = Database(f"sqlite:///{tmp_path}/fleet.db")
    await database.open()
    gate = AuthGate(database, LimitSettings(), may_be_open=True)
    maps = SiteMaps(read_site(sample_site))
    links = LinkProcesses(LinkOptions(), sample_site)
    handlers = RequestHandlers()
    queries = SiteQueries(maps, handlers)
    made = app.Gateway(Fleet(maps, database), gate, links, handlers, FieldPage(maps), queries)
    server = await made.serve("127.0.0.1", 0)
    yield made, server.sockets[0].getsockname()[1]
    server.close()
    await server.wait_closed()
    await database.close()


@pytest.fixture
def no_looks():
    """Python looks for garbage only when it is told to, and there is none to begin with."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


async def test_of_robots_that_come_and_go_nothing_is_left(running, no_looks, monkeypatch):
    monkeypatch.setattr(app, "GARBAGE_INTERVAL", 0.05)
    monkeypatch.setattr(tasks, "MOST_GONE", COMINGS)
    made, port = running
    before = connections()
    for number in range(COMINGS):
        async with connect(f"ws://127.0.0.1:{port}/robot?robot=r{number}") as robot:
            await robot.recv()
    assert connections() > before, "they hold themselves: this tests nothing otherwise"
    clearing = asyncio.create_task(made.works(f"ws://127.0.0.1:{port}")["garbage"]())
    async with asyncio.timeout(60):
        while connections() > before:
            await asyncio.sleep(0.05)
    clearing.cancel()


async def test_python_looks_for_nothing_while_robots_are_stopped(running):
    fleet = running[0]._fleet
    looks = []
    fleet.emergency.reach(lambda _call: looks.append(gc.isenabled()))
    try:
        await fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
        assert looks == [False]
    finally:
        gc.enable()


def connections() -> int:
    return sum(isinstance(one, ClientConnection) for one in gc.get_objects())
