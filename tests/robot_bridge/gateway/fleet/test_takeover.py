"""Robots of a gateway that died say Ready all at once, and what is stored of them is read in a few pieces."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.queues import PauseRobot
from robot_bridge.gateway.cluster import ownership as owning
from robot_bridge.gateway.cluster.ownership import OwnerChanges
from robot_bridge.gateway.fleet import registration
from robot_bridge.gateway.fleet.registration import StoredState, Takeover
from robot_bridge.gateway.model.events import EventBus, RobotLeft
from robot_bridge.gateway.model.robots import Robots
from robot_bridge.gateway.storage.repositories.gateways import Claimed, Member, Owner, OwnersRead

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

    def had_elsewhere(self, _robots):
        return {}


@pytest.fixture
def ownership():
    return Ownership()


@pytest.fixture
def takeover(ownership, monkeypatch):
    """A takeover that notes what it reads together; ``faults`` by robot are raised then."""
    woken: list[tuple[str, str]] = []
    robots = SimpleNamespace(gateway_of=lambda robot: None if robot == "r1" else "b")
    exchange = SimpleNamespace(wake=lambda what, gateway: woken.append((what, gateway)))
    takeover = Takeover(ownership, exchange, robots, *[None] * 6, EventBus())
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


async def test_an_abort_left_for_a_robot_that_was_removed_ends_when_another_comes_by_its_name():
    """One with open commands is there, and stored in a moment."""
    ended, known = [], Robots()
    known.ready("new", 1, "websocket", 0.0)
    stored = StoredState(
        [], [SimpleNamespace(report=SimpleNamespace(robot="sent on"))], [], None, {"stopped"}
    )

    async def run(_work, _names, _since):
        return stored

    names, stopped = ("drop", "adopt", "keep_left_for", "begin", "take_over"), []
    ignored = SimpleNamespace(
        **dict.fromkeys(names, lambda *_of: None), end_left_for=ended.extend, note_stop=stopped.extend
    )
    rest = ignored, ignored, ignored, ignored, SimpleNamespace(run=run), ManualClock()
    await Takeover(None, None, known, *rest, EventBus())._read(["new", "sent on"])
    assert ended == ["new"] and "new" not in known
    assert stopped == ["stopped"]


async def test_robots_that_were_stopped_lately_are_known_when_they_are_taken_over(two):
    """A motion may still come that was asked before, at the gateway that had them."""
    began = two.clock.time()
    await two.ready("r3")
    assert (await two.database.run(registration._load, ["r1", "r2", "r3"], began)).stopped == set()
    await two.fleet.orders.abort(AbortTask("abort-0001", "r1"), "Ada")
    await two.fleet.pauses.pause(PauseRobot("r2"), "Ada")
    assert (await two.database.run(registration._load, ["r1", "r2", "r3"], began)).stopped == {"r1", "r2"}
    assert (await two.database.run(registration._load, ["r2"], began)).stopped == {"r2"}
    assert (await two.database.run(registration._load, ["r1", "r2"], began + 1.0)).stopped == set()


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

    ownership.refresh, ownership.note_followed = refresh, lambda: None
    await takeover.follow()
    assert {robot: known.gateway_of(robot) for robot in owners} == owners
    assert woken == [("positions", "b"), ("positions", "c")]
    await takeover.follow()
    assert len(woken) == 2


async def test_gateways_are_asked_where_robots_are_though_others_could_not_be_taken_up_meanwhile(ownership):
    woken, known = [], Robots()
    exchange = SimpleNamespace(wake=lambda what, gateway: woken.append((what, gateway)))
    known.ready("r1", 1, "websocket", 0.0)
    ignored, held = SimpleNamespace(drop=lambda _robots: None), SimpleNamespace(forget=lambda _robot: None)
    faults = [StoreError("away")]

    async def run(_work, names, _since):
        raise faults.pop()

    database = SimpleNamespace(run=run)
    takeover = Takeover(
        ownership, exchange, known, ignored, ignored, held, ignored, database, ManualClock(), EventBus()
    )
    found = [OwnerChanges({"r1"}, {"r9"}, set(), {"r1": "b"}), OwnerChanges(set(), set(), set(), {"r1": "b"})]

    async def refresh():
        return found.pop(0)

    ownership.refresh, ownership.note_followed = refresh, lambda: None
    with pytest.raises(StoreError):
        await takeover.follow()
    await takeover.follow()
    assert woken == [("positions", "b")] and ownership.forgotten == ["r9"]


async def test_a_robot_that_was_lost_while_it_was_let_in_here_is_dropped_by_the_next_look(ownership):
    known, left, woken = Robots(), [], []
    for robot in ("mine", "astray"):
        known.ready(robot, 1, "websocket", 0.0)
    exchange = SimpleNamespace(gateway="a", wake=lambda what, gateway: woken.append((what, gateway)))
    ignored, held = SimpleNamespace(drop=lambda _robots: None), SimpleNamespace(forget=lambda _robot: None)
    events = EventBus()
    events.subscribe(RobotLeft, left.append)
    takeover = Takeover(ownership, exchange, known, ignored, ignored, held, ignored, None, None, events)

    async def refresh():
        return OwnerChanges(set(), set(), set(), {})

    ownership.refresh, ownership.note_followed = refresh, lambda: None
    ownership.had_elsewhere = lambda robots: {robot: "b" for robot in robots if robot == "astray"}
    await takeover.follow()
    assert left == [RobotLeft("astray", "b")] and woken == [("positions", "b")]
    assert [known.gateway_of(robot) for robot in ("mine", "astray")] == [None, "b"]


class OwnersTable:
    """The owners as the database has them; a read returns all, or those that have changed.

    What is ``run`` on it are claims: they are made at once, and ``answering`` lets who asked know of them.
    """

    def __init__(self):
        self.owners, self.changed, self.read_all = {}, set(), 0
        self.answering = asyncio.Event()

    async def run(self, _work, me, robots):
        before = {robot: self.owners.get(robot) for robot in robots}
        self.write(**{robot: Owner(me.gw, me.run, 7) for robot in robots})
        await self.answering.wait()
        return {robot: Claimed(7, before[robot]) for robot in robots}

    def write(self, **owners):
        self.owners.update(owners)
        self.changed.update(owners)

    async def read(self, _work, since):
        self.read_all += since is None
        found = {
            robot: owner
            for robot, owner in self.owners.items()
            if since is None or robot in self.changed or not owner.stored
        }
        self.changed.clear()
        return OwnersRead("mark", len(self.owners), found)


@pytest.fixture
def table():
    return OwnersTable()


@pytest.fixture
def owned(table):
    me = Member("a", "run 1", 0.0, True)
    return owning.Ownership(SimpleNamespace(me=me, name="a"), table)


def here(fence, run="run 1", *, stored=True):
    return Owner("a", run, fence, stored)


def elsewhere(fence, gateway="b"):
    return Owner(gateway, "run 9", fence)


async def followed(owned):
    changes = await owned.refresh()
    owned.note_followed()
    return changes


async def test_owners_that_have_changed_are_told_until_they_are_followed(owned, table):
    table.write(r1=here(1), r2=elsewhere(4))
    for _ in range(2):
        changes = await owned.refresh()
        assert changes.gateways == {"r1": "a", "r2": "b"}
    assert await owned.refresh() == (set(), set(), set(), {"r1": "a", "r2": "b"}) and owned.owns("r1")
    owned.note_followed()
    assert await owned.refresh() == (set(), set(), set(), {})
    table.write(r1=elsewhere(2, "c"), r2=here(5))
    assert await owned.refresh() == ({"r1"}, {"r2"}, set(), {"r1": "c", "r2": "a"})
    assert (owned.owns("r1"), owned.owns("r2"), table.read_all) == (False, True, 1)


async def test_a_robot_that_is_let_go_here_alone_turns_out_to_be_this_ones_again(owned, table):
    table.write(r1=here(1))
    assert (await followed(owned)).new == {"r1"}
    owned.forget(["r1"])
    assert (await followed(owned)).new == {"r1"}


async def test_a_robot_whose_claim_is_under_way_is_taken_up_by_who_waits_for_that_alone(owned, table):
    table.write(r1=elsewhere(1))
    await followed(owned)
    claim = asyncio.create_task(owned.claim("r1"))
    while table.owners["r1"] != here(7):
        await asyncio.sleep(0.001)
    assert (await followed(owned)).new == set() and not owned.owns("r1")
    table.answering.set()
    assert await claim and owned.owns("r1")
    assert (await followed(owned)).new == set()


async def test_robots_that_another_gateway_has_are_named_unless_they_are_claimed_here(owned, table):
    names = ["mine", "theirs", "claimed", "new"]
    table.write(mine=here(1), theirs=elsewhere(2), claimed=elsewhere(3))
    await followed(owned)
    assert owned.had_elsewhere(names) == {"theirs": "b", "claimed": "b"}
    claim = asyncio.create_task(owned.claim("claimed"))
    while table.owners["claimed"] != here(7):
        await asyncio.sleep(0.001)
    assert owned.had_elsewhere(names) == {"theirs": "b"}
    table.answering.set()
    assert await claim
    assert owned.had_elsewhere(names) == {"theirs": "b"}, "what was read before says otherwise"


async def test_robots_that_are_not_stored_are_named_each_time(owned, table):
    table.write(r1=here(1, stored=False), r2=elsewhere(1))
    assert (await followed(owned)).gone == {"r1"}
    assert (await followed(owned)).gone == {"r1"}
    table.write(r1=here(1))
    assert (await followed(owned)).gone == set()


async def test_all_are_read_when_one_is_missing_and_once_in_a_while(owned, table, monkeypatch):
    table.write(r1=here(1), r2=elsewhere(1))
    await followed(owned)
    del table.owners["r1"]
    assert (await followed(owned)).lost == {"r1"} and table.read_all == 2
    await followed(owned)
    assert table.read_all == 2
    monkeypatch.setattr(owning, "ALL_S", 0.0)
    assert (await followed(owned)).gateways == {} and table.read_all == 3, "r2 is where it was"
    table.owners["r2"] = elsewhere(2)._replace(gw="c")
    assert (await followed(owned)).gateways == {"r2": "c"}


async def test_another_run_of_this_gateway_has_none_of_the_robots_of_the_one_before(owned, table):
    table.write(r1=here(1))
    await followed(owned)
    owned._membership.me = Member("a", "run 2", 0.0, True)
    assert (await followed(owned)).lost == {"r1"}
    table.write(r1=here(2, "run 2"))
    assert (await followed(owned)).new == {"r1"}
