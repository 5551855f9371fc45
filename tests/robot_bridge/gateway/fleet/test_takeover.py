"""Robots of a gateway that died say Ready all at once, and what is stored of them is read in a few pieces."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.gateway.cluster.ownership import OwnerChanges
from robot_bridge.gateway.fleet.registration import Takeover
from robot_bridge.gateway.model.events import EventBus
from robot_bridge.gateway.model.robots import Robots

ROBOTS = ["r1", "r2", "r3", "r4"]


class Ownership:
    """Gives this gateway all robots that are claimed together."""

    def __init__(self):
        self.given, self.forgotten = asyncio.Event(), []

    async def claim(self, _robot):
        await self.given.wait()
        return True

    def forget(self, robots):
        self.forgotten += robots


@pytest.fixture
def ownership():
    return Ownership()


@pytest.fixture
def takeover(ownership, monkeypatch):
    """A takeover that notes what it reads together; ``faults`` by robot are raised then."""
    woken: list[tuple[str, str]] = []
    robots = SimpleNamespace(gateway_of=lambda robot: None if robot == "r1" else "b")
    exchange = SimpleNamespace(wake=lambda what, gateway: woken.append((what, gateway)))
    takeover = Takeover(ownership, exchange, robots, *[None] * 7)
    takeover.read, takeover.faults, takeover.woken = [], {}, woken

    async def read(names):
        takeover.read.append(list(names))
        await asyncio.sleep(0)
        for name in names:
            if name in takeover.faults:
                raise takeover.faults[name]

    monkeypatch.setattr(takeover, "_read", read)
    return takeover


async def claim_all(takeover, ownership):
    """Return what came of the claims of all robots, which are given at one moment."""
    claims = [asyncio.ensure_future(takeover.claim(robot)) for robot in ROBOTS]
    await asyncio.sleep(0)
    ownership.given.set()
    return dict(zip(ROBOTS, await asyncio.gather(*claims, return_exceptions=True), strict=True))


async def test_robots_that_are_claimed_together_are_read_together_and_later_ones_after_them(
    takeover, ownership
):
    first = asyncio.create_task(claim_all(takeover, ownership))
    while not takeover.read:
        await asyncio.sleep(0)
    await takeover.claim("r5")
    assert await first == dict.fromkeys(ROBOTS)
    assert takeover.read == [ROBOTS, ["r5"]]
    assert takeover.woken == [("owners", "b")] * 2, "who had them drops them, told once for all"


async def test_what_cannot_be_read_of_one_robot_keeps_no_other_out(takeover, ownership):
    takeover.faults["r2"] = ValueError("nonsense")
    found = await claim_all(takeover, ownership)
    assert found == {**dict.fromkeys(ROBOTS), "r2": takeover.faults["r2"]}


async def test_with_the_database_away_none_is_in_and_nobody_asks_for_each_by_itself(takeover, ownership):
    takeover.faults["r2"] = StoreError("away")
    found = await claim_all(takeover, ownership)
    assert set(found.values()) == {takeover.faults["r2"]}
    assert (takeover.read, ownership.forgotten) == ([ROBOTS], ROBOTS)


async def test_who_does_not_wait_any_more_keeps_nobody_else_out(takeover, ownership):
    gone = asyncio.create_task(takeover.claim("r1"))
    others = asyncio.create_task(claim_all(takeover, ownership))
    await asyncio.sleep(0)
    gone.cancel()
    assert await others == dict.fromkeys(ROBOTS)


async def test_gateways_that_robots_went_to_are_asked_where_those_are(ownership):
    woken = []
    exchange = SimpleNamespace(wake=lambda what, gateway: woken.append((what, gateway)))
    known = Robots()
    for robot in ("r1", "r2", "r3"):
        known.ready(robot, 1, "websocket", 0.0)
    known.let_go("r2", "b")
    known.let_go("r3", "d")
    ignored, held = SimpleNamespace(drop=lambda _robots: None), SimpleNamespace(forget=lambda _robot: None)
    takeover = Takeover(ownership, exchange, known, ignored, ignored, held, ignored, None, None, EventBus())
    owners = {"r1": "b", "r2": "c", "r3": "d"}

    async def refresh():
        return OwnerChanges(
            {"r1"} if "r1" in {one.name for one in known.own()} else set(), set(), set(), owners
        )

    ownership.refresh = refresh
    await takeover.follow()
    assert {robot: known.gateway_of(robot) for robot in owners} == owners
    assert woken == [("positions", "b"), ("positions", "c")]
    await takeover.follow()
    assert len(woken) == 2
