"""Which gateway robots and desks connect to next, what is an address for them, and what they pass over."""

from __future__ import annotations

import asyncio
import socket

import pytest
from websockets.asyncio.client import connect

from robot_bridge.core.messages.administration import Gateways
from robot_bridge.core.messages.base import LONGEST_ADDRESS, MOST_GATEWAYS
from robot_bridge.core.messages.robots import OpAck, Start
from robot_bridge.core.reconnection import DESK_PACE, ROBOT_PACE, SPREAD, GatewayAddresses, connection_failure
from robot_bridge.protocol.codec import decode_answer

A, B, C = (f"ws://{name}:8765/robot" for name in ("127.0.0.1", "south.example.org", "[::1]"))


@pytest.fixture
def addresses():
    addresses = GatewayAddresses(A)
    addresses.learn([A, B, C])
    addresses.answered()
    return addresses


def tries(addresses, count):
    """Return the addresses that are tried one after the other, and the waits before each."""
    found = []
    for _ in range(count):
        wait = addresses.next_wait()
        found.append((addresses.current, wait))
    return [one for one, _ in found], [wait for _, wait in found]


def is_about(wait, seconds):
    return (1 - SPREAD) * seconds <= wait <= (1 + SPREAD) * seconds


def test_its_own_is_tried_once_more_and_then_the_others_in_turn(addresses):
    tried, waits = tries(addresses, 7)
    assert tried[0] == A
    assert sorted(tried[1:3]) == sorted((B, C))
    assert tried == [*tried[:3], *tried[:3], A]
    assert is_about(waits[0], ROBOT_PACE.first_wait) and is_about(waits[3], 2 * ROBOT_PACE.first_wait)
    assert all(is_about(wait, ROBOT_PACE.between) for wait in (*waits[1:3], *waits[4:6]))


def test_from_one_that_says_that_it_ends_it_goes_to_another_at_once(addresses):
    addresses.next_wait(ends=True)
    assert addresses.current != A
    there = addresses.current
    addresses.answered()
    addresses.next_wait()
    assert addresses.current == there


def test_one_alone_is_tried_again_and_again_ever_later():
    addresses = GatewayAddresses(A)
    tried, waits = tries(addresses, 8)
    assert set(tried) == {A}
    assert all(
        is_about(wait, min(ROBOT_PACE.first_wait * 2**n, ROBOT_PACE.longest_wait))
        for n, wait in enumerate(waits)
    )


def test_the_robots_of_one_gateway_are_spread_over_all_others():
    first = set()
    for _ in range(60):
        addresses = GatewayAddresses(A)
        addresses.learn([A, B, C])
        addresses.next_wait(ends=True)
        first.add(addresses.current)
    assert first == {B, C}


def test_what_is_told_later_takes_the_place_of_what_was_told_but_not_of_what_was_given(addresses):
    addresses.learn([B])
    assert sorted(addresses.known) == sorted((A, B))
    addresses.learn(None)
    addresses.learn([])
    addresses.learn("ws://x/robot")
    addresses.learn([7, {"url": B}])
    assert sorted(addresses.known) == sorted((A, B))


def test_the_name_by_which_a_gateway_tells_itself_is_tried_last():
    addresses = GatewayAddresses("ws://localhost:9000/robot")
    addresses.learn([A, B, C])
    assert addresses.known[-1] == A


def test_who_came_with_tls_goes_nowhere_without():
    addresses = GatewayAddresses("wss://north.example.org/robot")
    addresses.learn(["ws://south.example.org/robot", "wss://east.example.org/robot"])
    assert addresses.known == ["wss://north.example.org/robot", "wss://east.example.org/robot"]


@pytest.mark.parametrize(
    ("given", "has_token", "known"),
    [
        ("wss://north.example.org/desk", True, ["wss://south.example.org/desk"]),
        ("wss://north.example.org/desk", False, ["wss://south.example.org/desk"]),
        ("ws://127.0.0.1:8765/desk", True, ["ws://[::1]:8766/desk", "ws://localhost:8767/desk"]),
        ("ws://127.0.0.1:8765/desk", False, None),
        ("ws://10.0.0.1/desk", False, None),
    ],
)
def test_a_token_goes_nowhere_that_is_less_safe(given, has_token, known):
    told = [
        "ws://[::1]:8766/desk",
        "ws://localhost:8767/desk",
        "ws://south.example.org/desk",
        "wss://south.example.org/desk",
    ]
    addresses = GatewayAddresses(given, DESK_PACE, has_token=has_token)
    addresses.learn(told)
    assert sorted(addresses.known) == sorted([given, *(told if known is None else known)])


@pytest.fixture
def desk():
    """A desk at the gateway that was given."""
    addresses = GatewayAddresses(A, DESK_PACE)
    addresses.learn([A, B, C])
    addresses.answered()
    return addresses


def test_a_desk_tries_the_given_gateway_first_and_then_the_others_soon(desk):
    tried, waits = tries(desk, 4)
    others = tried[1:3]
    assert tried == [A, *others, A] and sorted(others) == sorted((B, C))
    assert sum(waits[:3]) < 0.6 < 0.25 + sum(waits[:4])
    # Lost at another gateway, the given one is tried first again.
    desk.next_wait()
    desk.answered()
    assert desk.current == others[0]
    assert tries(desk, 2)[0] == [A, others[0]]


def test_a_desk_does_not_stay_where_a_gateway_ends(desk):
    desk.next_wait(ends=True)
    assert desk.current != A
    desk.answered()
    desk.next_wait(ends=True)
    assert desk.current == A


def test_a_gateway_that_takes_no_connection_costs_a_desk_two_seconds_and_a_slow_one_is_waited_for(desk):
    spent = 0.0
    for _ in range(2):
        spent += desk.next_wait() + (desk.patience if desk.current == A else 0.0)
    assert desk.current != A and spent < 2.2
    tries(desk, 3)
    assert desk.patience == 2 * DESK_PACE.of_several
    tries(desk, 5)
    assert desk.patience == DESK_PACE.alone == GatewayAddresses(A, DESK_PACE).patience


def test_who_refuses_is_passed_over_until_another_has_answered(desk):
    desk.refused()
    tried, _ = tries(desk, 4)
    assert tried == [*tried[:2], *tried[:2]] and A not in tried
    assert not desk.all_refuse
    desk.answered()
    assert tries(desk, 1)[0] == [A]


def test_where_all_refuse_there_is_none_left_to_try(desk):
    for left in (2, 1, 0):
        assert not desk.all_refuse
        desk.refused()
        assert desk.all_refuse is (left == 0)
        desk.next_wait()


def test_a_desk_forgets_what_another_fleet_told(desk):
    desk.forget()
    assert desk.known == [A]


@pytest.mark.parametrize("op", ["Start", "OpAck"])
@pytest.mark.parametrize(
    "wrong",
    [
        "http://x:1/robot",
        "ws://",
        "ws:///robot",
        "ws://x:0/robot",
        "ws://x:99999/robot",
        "ws://[::1/robot",
        "ws://me:secret@x/robot",
        "ws://x/robot?robot=r2",
        "ws://x/ro bot",
        "ws://x/robot\n",
        "ws://x/" + LONGEST_ADDRESS * "r",
    ],
)
def test_what_is_no_address_is_passed_over_and_no_robot_is_lost_for_it(op, wrong):
    assert decode_answer(op, {"gateways": [wrong, B, B, 30 * " "]}).gateways == [B]
    assert decode_answer(op, {"gateways": [wrong]}).gateways is None


def test_only_so_many_are_taken():
    many = [f"ws://gateway-{n}.example.org:8765/robot" for n in range(10_000)]
    for message in (Start(gateways=many), OpAck(gateways=many), Gateways("north", many)):
        assert message.gateways == many[:MOST_GATEWAYS]
    addresses = GatewayAddresses(A)
    for begin in range(0, 1000, 100):
        addresses.learn(many[begin:])
    assert len(addresses.known) <= MOST_GATEWAYS + 2


def failure_at(url):
    async def fail():
        try:
            async with connect(url):
                return None
        except OSError as error:
            return connection_failure(error)

    return asyncio.run(fail())


def test_a_failure_to_connect_says_what_to_do():
    with socket.socket() as free:
        # Bound, and nobody listens: no other program takes the port meanwhile.
        free.bind(("127.0.0.1", 0))
        refused = "nothing listens there; start it, or correct the address"
        assert failure_at(f"ws://127.0.0.1:{free.getsockname()[1]}") == refused
    of_several = OSError("Multiple exceptions: [Errno 111] Connect call failed ('::1', 1), [Errno 111] ...")
    assert connection_failure(of_several) == refused
    assert failure_at("ws://nowhere.invalid") == (
        "that host is not known to this network; correct the address"
    )
    assert connection_failure(OSError("something else")) == "something else"
