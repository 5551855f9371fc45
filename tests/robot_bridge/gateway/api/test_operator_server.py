"""News that a desk is told: the newest of each, in the order in which they came; no socket."""

from __future__ import annotations

import asyncio
import json
from types import SimpleNamespace

from robot_bridge.gateway.api.operator_server import OperatorSession
from robot_bridge.gateway.model.events import Listeners


class Connection:
    """A desk's connection that says nothing, until it is ``hung_up``."""

    identity = SimpleNamespace(name="Ada")
    address = "127.0.0.1"

    def __init__(self):
        self.sent = asyncio.Queue()
        self.hung_up = asyncio.Event()

    async def send(self, frame, text=None):
        await self.sent.put(json.loads(frame))

    async def __aiter__(self):
        await self.hung_up.wait()
        return
        yield


async def test_news_that_cannot_be_told_keep_back_none_that_come_after_them(caplog):
    fleet, connection = SimpleNamespace(listeners=Listeners()), Connection()
    session = OperatorSession(fleet, connection, gate=None, handlers=None)
    running = asyncio.create_task(session.run())
    await asyncio.sleep(0)
    fleet.listeners.announce("command", "one", {"what": object()})
    fleet.listeners.announce("emergency", "emergency", {"in_force": True})
    assert (await asyncio.wait_for(connection.sent.get(), 20))["method"] == "emergency"
    fleet.listeners.announce("command", "two", {"state": "queued"})
    assert (await asyncio.wait_for(connection.sent.get(), 20))["params"] == {"state": "queued"}
    assert "news of command failed; what comes after it is done all the same" in caplog.text
    connection.hung_up.set()
    await running
