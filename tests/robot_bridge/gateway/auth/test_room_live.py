"""Room for operators: no number of robots or of silent connections from their own address keeps them out."""

from __future__ import annotations

import contextlib
import socket
import struct
import threading
from itertools import chain

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_sockets import open_sockets
from tests.support.patience import START

# A place is a newcomer's for as long as so many silent ones take to come: a client that is held up between
# its connect and its request must not lose it to a flood.
LIMITS = """
[limits]
robots = 6
desks = 5
desks_per_account = 2
per_address = 4
pending_per_address = 200
"""


@pytest.fixture(scope="module")
def open_gateway(start_bridge, limited_site):
    return start_bridge(limited_site(LIMITS))


@pytest.fixture(scope="module")
def gateway_with_accounts(start_bridge, limited_site, accounts_of):
    bridge = start_bridge(limited_site(LIMITS))
    return bridge, accounts_of(bridge).operator("Ada", "operator")


@pytest.fixture(scope="module")
def alone(open_gateway, gateway_with_accounts):
    """How many sockets each gateway has open that nobody is connected to."""
    return {one: open_sockets(one) for one in (open_gateway, gateway_with_accounts[0])}


@pytest.fixture
def bridge(open_gateway, alone):
    yield open_gateway
    _hang_up(open_gateway, alone)


@pytest.fixture
def guarded(gateway_with_accounts, alone):
    """A gateway with accounts, and what an operator connects with there."""
    yield gateway_with_accounts
    _hang_up(gateway_with_accounts[0], alone)


def _hang_up(bridge, alone):
    """Return when the gateway has noticed it: the next test needs all places."""
    bridge.hang_up()
    bridge._wires.clear()
    wait_until(lambda: open_sockets(bridge) <= alone[bridge])


@contextlib.contextmanager
def silent_flood(port, threads=2):
    """Open connections that say nothing, one after the other, as fast as the gateway takes them."""
    over, kept = threading.Event(), [[] for _ in range(threads)]

    def open_some(mine):
        while not over.is_set():
            with contextlib.suppress(OSError):
                mine.append(socket.create_connection(("127.0.0.1", port), 5))
            while len(mine) > 200:
                mine.pop(0).close()

    working = [threading.Thread(target=open_some, args=(mine,)) for mine in kept]
    for thread in working:
        thread.start()
    try:
        wait_until(lambda: all(len(mine) >= 150 for mine in kept))
        yield
    finally:
        over.set()
        for thread in working:
            thread.join()
        for one in chain(*kept):
            one.close()


def last_heard(silent):
    """Wait until a desk's connection is closed, past what all desks hear; return code and reason."""
    with pytest.raises(ConnectionClosed) as caught:
        while silent.recv(START):
            pass
    return caught.value.rcvd.code, caught.value.rcvd.reason


def test_robots_of_an_address_leave_room_for_its_desks(bridge, refused):
    robots = [bridge.robot(f"r{n}") for n in range(4)]
    status, text = refused(lambda: bridge.robot("r5"))
    assert (status, text) == (503, "127.0.0.1 has 4 robots open, and gets no more; close some.\n")
    desks = [bridge.desk() for _ in range(4)]
    assert desks[-1].ask("emergency_stop", {"command": "stop-in-a-crowd"})["in_force"]
    assert not desks[-1].ask("clear_emergency_stop", {"reason": "tried"})["in_force"]
    assert len(robots) == len(desks) == 4


def test_silent_connections_make_room_for_desks_as_they_come(bridge):
    with silent_flood(bridge.port):
        for _ in range(4):
            assert bridge.desk().ask("get_positions")
        # On a busy machine the first ones may have been given up before there are so many.
        text = "127.0.0.1 has more than 200 connections that have not said what they want"
        wait_until(lambda: text in bridge.output(), what=text)


def test_silent_connections_make_room_for_the_desk_of_an_account(guarded):
    bridge, ada = guarded
    with silent_flood(bridge.port):
        assert bridge.desk(**ada).ask("get_positions")
        assert bridge.desk(**ada).ask("get_positions")


def test_desks_that_say_nothing_make_room_the_oldest_first(bridge):
    silent = [connect(f"{bridge.address}/desk") for _ in range(4)]
    for place in range(2):
        newcomer = bridge.desk()
        assert last_heard(silent[place]) == (
            1013,
            "it said nothing, and others need its place",
        )
        assert newcomer.connection.ping().wait(START)
    for one in silent[2:]:
        assert one.ping().wait(START)
        one.close()


def test_silent_desks_of_an_account_make_room_for_one_that_speaks(guarded):
    bridge, ada = guarded
    silent = [connect(f"{bridge.address}/desk", **ada) for _ in range(2)]
    assert bridge.desk(**ada).ask("get_positions")
    assert last_heard(silent[0])[0] == 1013
    silent[1].close()


def test_who_breaks_off_while_it_is_let_in_keeps_no_place(bridge):
    for _ in range(12):
        # The accounts are read once more for a token that nobody knows: meanwhile it hangs up.
        raw = socket.create_connection(("127.0.0.1", bridge.port), 5)
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        raw.sendall(
            b"GET /desk HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
            b"Authorization: Bearer nobody\r\n\r\n"
        )
        raw.close()
    said = bridge.output().count("need its place")
    desks = [bridge.desk() for _ in range(4)]
    assert all(desk.ask("get_positions") for desk in desks)
    assert bridge.output().count("need its place") == said
