"""Requests of robots that another gateway has, as the one that has them begins with them; on PostgreSQL."""

from __future__ import annotations

import asyncio
from dataclasses import fields
from types import SimpleNamespace

from sqlalchemy import text

from robot_bridge.core.messages.base import DESK_REQUESTS, Role
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.queues import TakeOver
from robot_bridge.gateway.cluster import request_relay
from robot_bridge.gateway.cluster.messages import Exchange
from robot_bridge.gateway.cluster.request_relay import RequestRelay
from robot_bridge.gateway.model.robots import Robots
from robot_bridge.gateway.storage.database import Database, read_address
from robot_bridge.gateway.storage.repositories import gateways
from robot_bridge.gateway.storage.repositories.gateways import Member, NewRequest
from tests.support.patience import BUSY

HAS_OWNER = text("insert into robot_owners (robot, gw, run, fence) values ('r1', 'a', 'run', 1)")


class Handlers:
    """What answers requests of robots of this gateway."""

    def __init__(self):
        self.asked = []

    async def answer(self, request, _operator):
        self.asked.append(request.command)
        return {}


async def test_aborts_of_a_large_fleet_wait_for_no_look(fleet_url, monkeypatch):
    monkeypatch.setattr(request_relay, "MOST_AT_ONCE", 10)
    monkeypatch.setattr(request_relay, "LOOK_S", 3600.0)
    database = Database(read_address(fleet_url))
    await database.open()
    await database.run(lambda connection: connection.execute(HAS_OWNER))
    ids = [f"abort-{number:04}" for number in range(35)]
    requests = [NewRequest.of("r1", AbortTask(id, "r1", None, None)) for id in ids]
    await database.run(gateways.add_requests, requests, "Ada", "b")
    handlers, fleet = Handlers(), SimpleNamespace(me=Member("a", "run"), name="a")
    relay = RequestRelay(handlers, Robots(), fleet, Exchange("a", b"k" * 32, []), database)
    running = asyncio.create_task(relay.run())
    try:
        async with asyncio.timeout(10 * BUSY):
            while len(handlers.asked) < len(ids):
                await asyncio.sleep(0.005)
    finally:
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
        await database.close()
    assert sorted(handlers.asked) == ids


def test_what_is_asked_of_one_robot_is_done_by_the_gateway_that_has_it():
    """A question may be answered by any gateway, and TakeOver is: it writes the queues of several robots."""
    of_a_robot = {
        request
        for request in DESK_REQUESTS.values()
        if request.least_role is not Role.VIEWER and "robot" in [one.name for one in fields(request)]
    }
    missing = of_a_robot - set(request_relay.RELAYED) - {TakeOver}
    assert not missing, f"{sorted(one.method for one in missing)}: add them to RELAYED of request_relay.py"
