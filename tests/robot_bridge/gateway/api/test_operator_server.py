"""News that a desk is told: the newest of each, in the order in which they came; no socket."""

from __future__ import annotations

import asyncio
import json
from contextlib import asynccontextmanager
from types import SimpleNamespace

from robot_bridge.core.messages.base import Role
from robot_bridge.gateway.api.operator_server import OperatorSession
from robot_bridge.gateway.model.events import Listeners


class Connection:
    """A desk's connection that says nothing, until it is ``hung_up``."""

    identity = SimpleNamespace(name="Ada")
    address = "127.0.0.1"
    is_idle = True

    def __init__(self):
        self.sent = asyncio.Queue()
        self.hung_up = asyncio.Event()

    async def send(self, frame, text=None):
        await self.sent.put(json.loads(frame))

    async def send_together(self, frames):
        for frame in frames:
            await self.send(frame)

    def write_at_once(self, frame):
        self.sent.put_nowait(json.loads(frame))
        return True

    def handle_at_once(self, handler):
        self.handler = handler

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


@asynccontextmanager
async def desk_of(yard, role):
    """Yield the connection of a desk at the gateway of a yard."""
    connection = Connection()
    session = OperatorSession(yard.fleet, connection, SimpleNamespace(role=lambda _: role), handlers=None)
    running = asyncio.create_task(session.run())
    await asyncio.sleep(0)
    yield connection
    connection.hung_up.set()
    await running


def stop_call(**params):
    return json.dumps({"jsonrpc": "2.0", "id": 1, "method": "emergency_stop", "params": params}).encode()


async def test_a_stop_begins_when_its_bytes_are_there(two):
    """Without a turn of the loop; the request is answered in its turn all the same."""
    async with desk_of(two, Role.OPERATOR) as connection:
        for params in ({"command": "stop-number-1", "reason": "smoke"}, {"command": "stop-number-1"}):
            assert not connection.handler(stop_call(**params))
        news = connection.sent.get_nowait()
        assert (news["method"], news["params"]["in_force"]) == ("emergency", True)
        assert connection.sent.empty()
        report = two.fleet.emergency.report()
        assert (report.stop, report.by, report.reason) == ("stop-number-1", "Ada", "smoke")


async def test_a_stop_without_an_id_is_begun_in_its_turn(two):
    """Whoever decodes it gives it one: begun here as well it would be two stops."""
    async with desk_of(two, Role.OPERATOR) as connection:
        assert not connection.handler(stop_call(reason="smoke"))
        assert not two.fleet.emergency.in_force


async def test_a_stop_that_cannot_count_the_robots_is_told_to_them_all_the_same(two, monkeypatch):
    told = []
    two.fleet.emergency.reach(told.append)
    monkeypatch.setattr(two.fleet.robots, "commanded", lambda: 1 / 0)
    async with desk_of(two, Role.OPERATOR) as connection:
        connection.handler(stop_call(command="stop-number-1"))
        assert told == ["emergency-stop-number-1"]


async def test_who_may_not_stop_robots_begins_no_stop(two, caplog):
    async with desk_of(two, Role.VIEWER) as connection:
        assert not connection.handler(stop_call(command="stop-number-1"))
        for nonsense in (b'{"method": "emergency_stop"', b'"emergency_stop"', b"[emergency_stop]"):
            assert not connection.handler(nonsense)
        assert not two.fleet.emergency.in_force and connection.sent.empty()
    assert not caplog.records


async def test_news_of_a_stop_are_sent_at_once_and_behind_none_that_are_older():
    fleet, connection = SimpleNamespace(listeners=Listeners()), Connection()
    session = OperatorSession(fleet, connection, gate=None, handlers=None)
    running = asyncio.create_task(session.run())
    await asyncio.sleep(0)
    for number in (1, 2):
        # What was written before the first has not gone out yet.
        connection.is_idle = number == 2
        fleet.listeners.announce("command", "one", {"number": number})
        fleet.listeners.announce("emergency", "emergency", {"number": number})
    # Without a turn of the loop.
    first = connection.sent.get_nowait()
    assert (first["method"], first["params"]) == ("emergency", {"number": 2}) and connection.sent.empty()
    second = await asyncio.wait_for(connection.sent.get(), 20)
    assert (second["method"], second["params"]) == ("command", {"number": 2})
    await asyncio.sleep(0.01)
    assert connection.sent.empty()
    connection.hung_up.set()
    await running
