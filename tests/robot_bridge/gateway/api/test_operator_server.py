"""News that a desk is told: the newest of each, in the order in which they came. Nothing delays a stop."""

from __future__ import annotations

import asyncio
import json
from contextlib import asynccontextmanager
from functools import partial
from types import SimpleNamespace

import pytest
from websockets.asyncio.client import connect
from websockets.asyncio.server import serve
from websockets.frames import Frame, Opcode

from robot_bridge.core.messages.base import Role
from robot_bridge.core.sites.settings_tables import LimitSettings
from robot_bridge.gateway.api import operator_server
from robot_bridge.gateway.api.operator_server import OperatorSession
from robot_bridge.gateway.auth.accounts import TokenKind
from robot_bridge.gateway.auth.client_connection import ClientConnection, Identity
from robot_bridge.gateway.model.events import Listeners
from tests.support.patience import until


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

    def accept_stops(self, handler, _never_refused):
        self.handler = handler

    async def __aiter__(self):
        await self.hung_up.wait()
        return
        yield


async def test_an_unforeseen_error_of_what_sends_ends_the_connection(caplog):
    fleet, connection = SimpleNamespace(listeners=Listeners()), Connection()
    connection.send_together = None
    connection.transport = SimpleNamespace(abort=connection.hung_up.set)
    session = OperatorSession(fleet, connection, gate=None, handlers=None)
    session.notify("command", "one", {"state": "queued"})
    async with asyncio.timeout(20):
        await session.run()
    assert "sending news to desk of Ada failed; the connection is ended" in caplog.text
    assert "not callable" in caplog.text


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


# --- on a real connection -----------------------------------------------------------------------------------


class Desk:
    """A desk on a socket at the gateway of a yard; ``begun`` are its requests that were begun."""

    def __init__(self, yard, role=Role.OPERATOR, **limits):
        self.yard, self.role, self.begun = yard, role, []
        self.answered = 0
        self.limits = LimitSettings(stuck_s=600.0, **limits)

    @asynccontextmanager
    async def connected(self):
        options = {"create_connection": partial(ClientConnection, self), "compression": None}
        async with serve(self._serve, "127.0.0.1", 0, process_request=self._let_in, **options) as server:
            port = server.sockets[0].getsockname()[1]
            async with connect(f"ws://127.0.0.1:{port}", compression=None) as self.wire:
                await (await self.wire.ping())
                reading = asyncio.create_task(self._read())
                yield self
                reading.cancel()
                # One that reads nothing would be waited for.
                self.wire.transport.abort()

    def ask(self, *calls):
        """Send requests in one piece."""
        for method, params in calls:
            text = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})
            self.wire.protocol.send_text(text.encode())
        self.wire.send_data()

    async def _read(self):
        async for text in self.wire:
            self.answered += '"id":1' in str(text)

    def read_nothing(self):
        """Stop reading, and have the gateway send more than lies between."""
        self.wire.transport.pause_reading()
        self.connection.write_at_once("x" * 8_000_000)
        assert self.connection.paused

    def arrived(self, connection):
        self.connection = connection

    def left(self, _connection):
        pass

    async def answer(self, request, _operator):
        self.begun.append(request.method)
        return {}

    async def _let_in(self, connection, _request):
        connection.let_in(Identity(TokenKind.OPERATOR, "Ada", None, "s"), 100_000)

    async def _serve(self, connection):
        journal = SimpleNamespace(note=lambda *_arguments, **_more: None)
        gate = SimpleNamespace(role=lambda _: self.role, journal=journal)
        await OperatorSession(self.yard.fleet, connection, gate, self).run()


PAN = ("subscribe", {"rate": 1.0})
STOP = ("emergency_stop", {"command": "stop-number-1"})
STOPS = [STOP, ("abort", {"command": "abort-01", "robot": "r1"})]
STOPS += [("send", {"command": "command-1", "robot": "r1", "op": "Abort"})]


@pytest.mark.parametrize("before", [PAN, ("no_such", {}), ("resume_queue", {"robot": "r1", "revision": 0})])
@pytest.mark.parametrize("stop", STOPS, ids=lambda stop: stop[0])
async def test_a_stop_is_begun_while_the_desk_reads_no_answer(two, stop, before):
    async with Desk(two).connected() as desk:
        desk.read_nothing()
        # A pause overtakes what resumes, which is answered as well.
        desk.ask(before, before, ("pause_robot", {"robot": "r1"}), stop)
        await until(lambda: stop[0] in desk.begun)
        assert desk.connection.paused


async def test_a_stop_is_begun_as_its_bytes_arrive_while_the_desk_pans_on_a_slow_line(two):
    async with Desk(two).connected() as desk:
        desk.read_nothing()
        desk.ask(PAN)
        await until(lambda: two.fleet.counters.desk["subscribe"])
        assert desk.connection.short_cut.on_the_long_way == 0
        desk.ask(STOP)
        await until(lambda: two.fleet.emergency.in_force)
        assert desk.connection.paused


# --- beyond the rate limit ----------------------------------------------------------------------------------

FEW = {"desk_messages_per_s": 0.01, "desk_burst": 3}
BEYOND = [PAN] * 6
"""Three are done and three refused; the next one ends the connection."""


@pytest.mark.parametrize("stop", [*STOPS, ("abort_all", {}), ("pause_robot", {"robot": "r1"})])
async def test_a_stop_is_begun_however_much_its_desk_has_sent_before(two, stop):
    async with Desk(two, **FEW).connected() as desk:
        desk.ask(*BEYOND)
        # In a piece of its own, and again behind what ends the connection.
        await until(lambda: desk.answered == 6)
        desk.ask(stop)
        await until(lambda: desk.begun == [stop[0]])
        assert not desk.connection.is_gone
        desk.ask(PAN, stop)
        await until(lambda: desk.connection.is_gone)
        assert desk.begun == [stop[0]] * 2
        assert desk.wire.close_code == 1008


async def test_a_stop_beyond_the_limit_begins_as_its_bytes_arrive(two):
    async with Desk(two, **FEW).connected() as desk:
        desk.ask(*BEYOND)
        await until(lambda: desk.answered == 6)
        data = Frame(Opcode.TEXT, stop_call(**STOP[1])).serialize(mask=True)
        desk.connection.data_received(data)
        # Without a turn of the loop.
        assert two.fleet.emergency.in_force


async def test_aborts_beyond_the_limit_are_so_many_and_emergency_stops_without_limit(two, monkeypatch):
    monkeypatch.setattr(operator_server, "STOPS_PER_S", 0.01)
    monkeypatch.setattr(operator_server, "MOST_STOPPING", 4)
    async with Desk(two, **FEW).connected() as desk:
        desk.ask(*BEYOND)
        await until(lambda: desk.answered == 6)
        for number in range(10):
            desk.ask(STOP)
            await until(lambda number=number: len(desk.begun) == number + 1)
        desk.ask(*[STOPS[1]] * 5)
        await until(lambda: desk.connection.is_gone)
        assert desk.begun == ["emergency_stop"] * 10 + ["abort"] * 4


@pytest.mark.parametrize("stop", STOPS, ids=lambda stop: stop[0])
async def test_who_may_not_stop_robots_is_refused_beyond_the_limit(two, stop):
    async with Desk(two, Role.VIEWER, **FEW).connected() as desk:
        desk.ask(*BEYOND, stop)
        await until(lambda: desk.connection.is_gone)
        assert desk.wire.close_code == 1008 and desk.begun == []


async def test_what_stops_no_robot_is_refused_beyond_the_limit_whatever_it_holds(two):
    async with Desk(two, **FEW).connected() as desk:
        desk.ask(*BEYOND, ("send", {"command": "command-1", "robot": "r1", "op": "emergency_stop"}))
        await until(lambda: desk.connection.is_gone)
        assert desk.wire.close_code == 1008 and desk.begun == []
