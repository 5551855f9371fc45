"""A connection on a real server: what goes past its queue, in which order, and what never does."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
from functools import partial

import pytest
from websockets.asyncio.client import connect
from websockets.asyncio.server import serve
from websockets.exceptions import ConnectionClosed
from websockets.protocol import State

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.sites.settings_tables import LimitSettings
from robot_bridge.gateway.auth import client_connection
from robot_bridge.gateway.auth.accounts import TokenKind
from robot_bridge.gateway.auth.client_connection import ClientConnection, Identity, RateLimit
from robot_bridge.protocol import jsonrpc
from tests.support.patience import BUSY, until


class OpenDoor:
    """A door that lets everybody in."""

    limits = LimitSettings()

    def arrived(self, _visitor):
        return True

    def left(self, _visitor):
        pass


class Host:
    """Notes what came which way; a message that begins with "p" may go past the queue."""

    def __init__(self):
        self.came = []
        self.goes_on = asyncio.Event()

    async def let_in(self, visitor, _request):
        visitor.let_in(Identity(TokenKind.ROBOT, "r", None, "s"), 10_000)

    async def serve(self, visitor):
        self.visitor = visitor
        visitor.handle_at_once(self._at_once)
        async for message in visitor:
            if message == "wait":
                await asyncio.wait_for(self.goes_on.wait(), BUSY * 5)
            self.came.append(("queued", message))

    def _at_once(self, message):
        if not message.startswith(b"p"):
            return False
        self.came.append(("at once", message.decode()))
        return True

    async def until(self, number):
        async with asyncio.timeout(BUSY * 10):
            while len(self.came) < number:
                await asyncio.sleep(0.005)


async def arrived(client):
    """Wait until all that the client has sent is at the host: pings are answered as they come in."""
    await (await client.ping())


@pytest.fixture
async def host():
    return Host()


@contextlib.asynccontextmanager
async def connected(host, ping_interval, ping_timeout):
    options = {"create_connection": partial(ClientConnection, OpenDoor()), "compression": None}
    options |= {"ping_interval": ping_interval, "ping_timeout": ping_timeout}
    async with serve(host.serve, "127.0.0.1", 0, process_request=host.let_in, **options) as server:
        port = server.sockets[0].getsockname()[1]
        async with connect(f"ws://127.0.0.1:{port}", compression=None, max_size=None) as wire:
            await (await wire.ping())
            yield wire
            # One that reads nothing would be waited for.
            wire.transport.abort()


@pytest.fixture
async def client(host):
    """A client that is never pinged: one that stops reading is not cut off for that."""
    async with connected(host, None, None) as wire:
        yield wire


async def test_who_answers_pings_is_measured_and_stays(host):
    async with connected(host, 0.05, BUSY * 0.5):
        await until(lambda: host.visitor.round_trip is not None, 5.0)
        assert 0 < host.visitor.round_trip < 10
        host.visitor.round_trip = None
        # An unanswered ping would have ended it by then.
        await asyncio.sleep(BUSY * 0.5 + 0.2)
        await until(lambda: host.visitor.round_trip is not None, 5.0)
        assert not host.visitor.is_gone


async def test_who_answers_no_ping_is_cut_off(host):
    async with connected(host, 0.05, 0.5) as client:
        client.transport.pause_reading()
        await until(lambda: host.visitor.is_gone, 5.0)


async def test_positions_go_past_the_queue(host, client):
    for number in range(20):
        await client.send(f"p{number}")
    await host.until(20)
    assert host.came == [("at once", f"p{number}") for number in range(20)]


async def test_answers_beyond_the_limit_of_messages_come_and_too_many_of_them_end_the_connection(
    host, monkeypatch
):
    monkeypatch.setattr(OpenDoor, "limits", LimitSettings(robot_messages_per_s=1.0, robot_burst=5))
    # Time stands: a machine that stands still for a second allows no further message.
    monkeypatch.setattr(client_connection, "RateLimit", partial(RateLimit, clock=ManualClock()))
    answer = json.dumps({"jsonrpc": "2.0", "id": 7, "result": {}})
    async with connected(host, None, None) as client:
        for number in range(8):
            await client.send(f"x{number}")
        await client.send(answer)
        await host.until(6)
        assert host.came == [("queued", f"x{number}") for number in range(5)] + [("queued", answer)]
        for _ in range(10):
            await client.send(answer)
        async with asyncio.timeout(BUSY * 5):
            await client.wait_closed()
        assert client.close_code == 1008
        assert host.came.count(("queued", answer)) == 5


async def test_nothing_goes_past_a_message_that_waits(host, client):
    for message in ("wait", "stop"):
        await client.send(message)
    await arrived(client)  # so that the next comes in pieces of its own
    await client.send("p1")
    await arrived(client)
    assert host.came == []
    host.goes_on.set()
    await host.until(3)
    assert host.came == [("queued", "wait"), ("queued", "stop"), ("queued", "p1")]
    await client.send("p2")
    await host.until(4)
    assert host.came[-1] == ("at once", "p2")


async def test_a_message_in_fragments_is_queued_and_the_next_goes_past_again(host, client):
    await client.send(["p", "1"])
    await host.until(1)
    await client.send("p2")
    await host.until(2)
    assert [text for _, text in host.came] == ["p1", "p2"]
    assert host.came[0][0] == "queued"


async def test_a_message_amid_the_fragments_of_another_is_a_breach_of_the_protocol(host, client):
    client.protocol.send_text(b"half", fin=False)
    client.send_data()
    await arrived(client)  # so that the next comes in pieces of its own
    client.transport.write(b"\x81\x82" + bytes(4) + b"p1")
    with pytest.raises(ConnectionClosed) as caught:
        await asyncio.wait_for(client.recv(), 10)
    assert caught.value.rcvd.code == 1002
    assert host.came == []


async def test_too_many_messages_are_refused_whichever_way_they_go(host, client):
    burst = OpenDoor.limits.robot_burst
    with pytest.raises(ConnectionClosed) as caught:
        for _ in range(5 * burst):
            await client.send("p")
        await client.recv()
    assert caught.value.rcvd.code == 1008
    assert len(host.came) < 2 * burst


async def test_a_stop_is_accepted_until_the_client_closes_and_nothing_else(host, client, monkeypatch):
    monkeypatch.setattr(client_connection, "CLOSE_WITHIN", BUSY * 10)
    await until(lambda: hasattr(host, "visitor"))
    host.visitor.accept_stops(lambda _: False, lambda call: call.method == "stop")
    client.transport.pause_reading()  # It does not hear of the close.
    for _ in range(5 * OpenDoor.limits.robot_burst):
        await client.send("p")
    await until(lambda: host.visitor.protocol.state is not State.OPEN)
    before = len(host.came)
    # As after a pause in which the limit has room again.
    host.visitor._messages = client_connection.RateLimit(1000.0, 1000.0)
    for text in ("p", jsonrpc.call("stop", {}, 1)):
        await client.send(text)
    await host.until(before + 1)
    assert [json.loads(text)["method"] for _, text in host.came[before:]] == ["stop"]


async def long_message(goes_on):
    """Yield the pieces of a long message, all but the first once ``goes_on`` is set."""
    yield "x" * 30_000
    await goes_on.wait()
    for _ in range(100):
        yield "x" * 30_000


async def test_a_stop_cuts_the_connection_of_a_client_that_is_slow_with_a_long_message(host, client, caplog):
    client.transport.pause_reading()
    host.goes_on.set()
    sending = asyncio.create_task(host.visitor.send(long_message(host.goes_on)))
    await until(lambda: host.visitor.transport.get_write_buffer_size() > 0)
    await host.visitor.cut_if_busy()
    with pytest.raises(ConnectionClosed):
        await sending
    assert "robot r from 127.0.0.1 is cut off: a stop would wait" in caplog.text


async def test_a_stop_waits_for_a_long_message_that_only_the_gateway_is_slow_with(host, client, monkeypatch):
    monkeypatch.setattr(client_connection, "STOP_PATIENCE_S", 0.01)
    sending = asyncio.create_task(host.visitor.send(long_message(host.goes_on)))
    await until(lambda: host.visitor.send_in_progress is not None)
    looks, waiting = [], host.visitor.transport.get_write_buffer_size
    host.visitor.transport.get_write_buffer_size = lambda: looks.append(1) or waiting()
    cutting = asyncio.create_task(host.visitor.cut_if_busy())
    await until(lambda: len(looks) >= 3)
    assert not cutting.done()
    # On a busy machine the client may be slow with the rest.
    monkeypatch.setattr(client_connection, "STOP_PATIENCE_S", 60.0)
    looks.clear()
    await until(lambda: looks)
    host.goes_on.set()
    assert len(await client.recv()) == 101 * 30_000
    await asyncio.gather(sending, cutting)
    assert not host.visitor.is_gone


async def test_little_waits_in_the_system_for_a_client_that_is_slow(host, client):
    client.transport.pause_reading()
    sent = 0
    while host.visitor.transport.get_write_buffer_size() == 0:
        host.visitor.write_at_once("x" * 1000)
        sent += 1000
    # What the client has received already is on its way no more.
    received = client.transport.get_extra_info("socket").getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
    assert sent < received + 2 * client_connection.UNSENT_BYTES


def read_nothing(host, client):
    """Have the client stop reading, and send it more than lies between."""
    client.transport.pause_reading()
    host.visitor.write_at_once("x" * 8_000_000)
    assert host.visitor.paused


async def test_who_leaves_too_many_answers_unread_is_cut_off(host, client, monkeypatch):
    monkeypatch.setattr(client_connection, "MOST_UNREAD", 100_000)
    read_nothing(host, client)
    before = host.visitor.transport.get_write_buffer_size()
    for _ in range(100):
        host.visitor.send_without_wait("x" * 1000)
    assert host.visitor.transport.get_write_buffer_size() < before + 110_000
    assert not host.visitor.transport.is_closing()
    host.visitor.send_without_wait("x" * 1000)
    assert host.visitor.transport.is_closing()


async def test_what_was_read_counts_no_more(host, client, monkeypatch):
    monkeypatch.setattr(client_connection, "MOST_UNREAD", 100_000)
    for _ in range(2):
        read_nothing(host, client)
        for _ in range(60):
            host.visitor.send_without_wait("y" * 1000)
        reading = asyncio.create_task(read_to_the_end(client))
        client.transport.resume_reading()
        await until(lambda: not host.visitor.paused)
        host.visitor.send_without_wait("end")
        await reading
    assert not host.visitor.transport.is_closing()


async def read_to_the_end(client):
    while await client.recv() != "end":
        pass


async def test_answers_during_a_long_message_are_held_in_their_order_and_not_without_end(host, client):
    sending = asyncio.create_task(host.visitor.send(long_message(host.goes_on)))
    await until(lambda: host.visitor.send_in_progress is not None)
    answers = [str(number) for number in range(client_connection.MOST_HELD)]
    for answer in answers[:-1]:
        host.visitor.send_without_wait(answer)
    # Before those that wait have their turn.
    sending.add_done_callback(lambda _: host.visitor.send_without_wait(answers[-1]))
    host.goes_on.set()
    assert len(await client.recv()) == 101 * 30_000
    assert [await client.recv() for _ in answers] == answers
    host.goes_on.clear()
    sending = asyncio.create_task(host.visitor.send(long_message(host.goes_on)))
    await until(lambda: host.visitor.send_in_progress is not None)
    for _ in range(client_connection.MOST_HELD + 1):
        host.visitor.send_without_wait("x")
    host.goes_on.set()
    with pytest.raises(ConnectionClosed):
        await sending
    assert host.visitor.is_gone


async def test_a_refusal_that_nobody_reads_keeps_back_no_later_message(host, client):
    burst = OpenDoor.limits.robot_burst
    read_nothing(host, client)
    call = '{"jsonrpc": "2.0", "id": 1, "method": "Alive"}'
    for _ in range(burst + 10):
        await client.send(call)
    await until(lambda: len(host.came) >= burst)
    await client.send("after")
    await until(lambda: host.visitor.short_cut.on_the_long_way == 0)
    assert host.visitor.paused and not host.visitor.is_gone
