"""Two gateways never command one robot, whatever is killed, frozen, late or lost.

The machine plays with the real statements on a real PostgreSQL, whose clock it turns, and with the real
leases and fences. What it makes up are processes, sockets and robots.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from sqlalchemy import text
from sqlalchemy.exc import OperationalError

from robot_bridge.core.clock import ManualClock
from robot_bridge.gateway.cluster.membership import (
    LEASE_S,
    RENEW_S,
    TRUST_S,
    LeaseTrust,
    Membership,
    OwnedRobots,
    leads,
    spared_runs,
)
from robot_bridge.gateway.cluster.ownership import Ownership
from robot_bridge.gateway.storage.database import Database, open_engine, read_address
from robot_bridge.gateway.storage.repositories import gateways
from robot_bridge.gateway.storage.repositories.gateways import Member, NoMemberError
from robot_bridge.gateway.storage.repositories.robots import CHECK_VALID_S

NAMES, ROBOTS = ("a", "b", "c"), ("r1", "r2")
RUNS = itertools.count(1)
KEYS = (*NAMES, "old a", "old b", "old c")
"""Processes: those of a name that stood still when another took it are old."""


@dataclass
class Process:
    """A gateway: what it has in its memory, and messages that it checked and has not sent yet."""

    me: Member
    trust: LeaseTrust
    robots: OwnedRobots = field(default_factory=OwnedRobots)
    members: list[Member] = field(default_factory=list)
    checked: list[tuple[str, int, float]] = field(default_factory=list)
    """robot, fence, and when."""
    frozen: bool = False


class Fleet(RuleBasedStateMachine):
    """Three gateways and two robots on one database."""

    engine = None

    def __init__(self):
        super().__init__()
        self.connection = self.engine.connect()
        for table in ("gateways", "robot_owners"):
            self.connection.execute(text(f"delete from {table}"))
        self.connection.commit()
        self.now = 1000.0
        self.clock = ManualClock(uptime=0.0)
        self.processes: dict[str, Process] = {}
        self.connected: dict[str, str] = {}
        """the gateway at the other end of each robot's newest connection."""
        self.claimed_at: dict[str, float] = {}
        """when each robot was claimed last."""

    def teardown(self):
        self.connection.close()

    def run(self, work, *arguments):
        with self.connection.begin():
            return work(self.connection, *arguments)

    def alive(self, name):
        process = self.processes.get(name)
        return None if process is None or process.frozen else process

    # --- processes ------------------------------------------------------------------------------------------

    @rule(name=st.sampled_from(NAMES))
    def start(self, name):
        """One of its name that is alive is in the way as long as its lease lasts."""
        old = self.processes.get(name)
        if old is not None and not old.frozen:
            return
        if old is not None:
            self.processes[f"old {name}"] = self.processes.pop(name)
            self.connected = {r: f"old {name}" if gw == name else gw for r, gw in self.connected.items()}
        me = Member(name, f"run-{next(RUNS)}", "1", "here", 1)
        if self.run(gateways.join, me, LEASE_S, self.now):
            process = Process(me, LeaseTrust(self.clock))
            process.trust.renewed(self.clock.steady())
            process.members = self.run(gateways.members, self.now)
            self.processes[name] = process

    @rule(name=st.sampled_from(KEYS))
    def kill(self, name):
        self.processes.pop(name, None)
        self.connected = {robot: gw for robot, gw in self.connected.items() if gw != name}

    @rule(name=st.sampled_from(KEYS))
    def freeze(self, name):
        if process := self.processes.get(name):
            process.frozen = True

    @rule(name=st.sampled_from(KEYS))
    def wake(self, name):
        if process := self.processes.get(name):
            process.frozen = False

    @rule(seconds=st.sampled_from([0.3, 1.0, 3.0, 4.5, 6.0, 60.0]))
    def pass_time(self, seconds):
        self.now += seconds
        self.clock.advance(seconds)

    @rule(name=st.sampled_from(KEYS), late=st.sampled_from([0.0, 0.0, 0.5, 2.0]))
    def renew(self, name, late):
        """The answer comes ``late``; while it waits nothing else happens to this gateway."""
        if (process := self.alive(name)) is None:
            return
        asked_at = self.clock.steady()
        renewed = self.run(gateways.renew, process.me, LEASE_S, self.now) or self.run(
            gateways.join, process.me, LEASE_S, self.now
        )
        self.now += late
        self.clock.advance(late)
        if not renewed:
            self.kill(name)  # another process has its name: it ends
            return
        process.trust.renewed(asked_at)
        process.members = self.run(gateways.members, self.now)

    @rule(name=st.sampled_from(KEYS))
    def leave(self, name):
        if process := self.alive(name):
            process.trust.lost()
            self.run(gateways.leave, process.me)
            self.kill(name)

    # --- robots -----------------------------------------------------------------------------------------

    @rule(robot=st.sampled_from(ROBOTS), name=st.sampled_from(NAMES))
    def connect(self, robot, name):
        """A robot connects and says Ready; the one that is frozen hears of it when it wakes."""
        if self.processes.get(name) is None:
            return
        self.connected[robot] = name
        if process := self.alive(name):
            self._claim(process, robot)

    @rule(robot=st.sampled_from(ROBOTS), name=st.sampled_from(KEYS))
    def claim_late(self, robot, name):
        """A Ready that waited in a gateway's memory, however old it is."""
        if process := self.alive(name):
            self._claim(process, robot)

    def _claim(self, process, robot):
        try:
            claims = self.run(gateways.claim, process.me, [robot], self.now)
        except NoMemberError:
            return
        for name, claim in claims.items():
            if claim.before is None or claim.before.fence != claim.fence:
                self.claimed_at[name] = self.now
        process.robots.claimed(process.me, claims)

    @rule(name=st.sampled_from(KEYS))
    def claim_left(self, name):
        process = self.alive(name)
        if process is None or not process.trust.holds or not leads(process.me, process.members):
            return
        try:
            spared = spared_runs(process.members, process.trust)
            left = self.run(gateways.claim_left, process.me, spared, self.now)
            self.claimed_at.update(dict.fromkeys(left, self.now))
            process.robots.gained(left)
        except NoMemberError:
            return

    @rule(name=st.sampled_from(KEYS))
    def look(self, name):
        """Wakes may be lost: a look comes whenever it comes."""
        if process := self.alive(name):
            me, owners = process.me, self.run(gateways.owners_since, None).owners
            stored = {
                robot: owner.fence
                for robot, owner in owners.items()
                if (owner.gw, owner.run) == (me.gw, me.run)
            }
            lost, new = process.robots.compare(stored)
            process.robots.forget(lost)
            process.robots.gained({robot: stored[robot] for robot in new})

    # --- commands ---------------------------------------------------------------------------------------

    def passes(self, process, robot):
        """Whether the robot passes the fence of a gateway."""
        fences = process.robots.fences([robot])
        return bool(fences) and not self.run(gateways.lost, process.me, fences)

    @rule(name=st.sampled_from(KEYS), robot=st.sampled_from(ROBOTS))
    def check(self, name, robot):
        """What is noted as delivered before it is sent: a fenced transaction."""
        if (process := self.alive(name)) and self.passes(process, robot):
            fence = process.robots.fences([robot])[robot]
            process.checked.append((robot, fence, self.clock.steady()))

    @rule(name=st.sampled_from(KEYS))
    def send(self, name):
        """What was checked is sent: at once, or after a sleep of any length."""
        process = self.alive(name)
        if process is None or not process.checked:
            return
        robot, fence, at = process.checked.pop()
        is_valid = self.clock.steady() - at < CHECK_VALID_S
        if is_valid and robot in process.robots and process.trust.holds and self.connected.get(robot) == name:
            owner = self.run(gateways.owners_since, None).owners[robot]
            # As long as that takes, a message may be on its way that was right when it was checked.
            on_its_way = self.now - self.claimed_at[robot] < CHECK_VALID_S
            assert owner.fence == fence or on_its_way, (robot, name, owner)

    @precondition(lambda self: self.processes)
    @invariant()
    def one_fence_one_owner(self):
        """No two gateways would pass the fence of one robot."""
        for robot in ROBOTS:
            passing = [name for name, process in self.processes.items() if self.passes(process, robot)]
            assert len(passing) <= 1, (robot, passing)

    @invariant()
    def who_trusts_its_lease_has_one(self):
        """By the database's clock, too: whoever may command is not about to be replaced."""
        living = {m.gw: m for m in self.run(gateways.members, self.now)}
        for name, process in self.processes.items():
            if process.trust.holds:
                member = living.get(process.me.gw)
                assert member is not None and member.run == process.me.run, name
                assert member.left > 0, name

    @invariant()
    def one_leads(self):
        leading = [n for n, p in self.processes.items() if p.trust.holds and leads(p.me, p.members)]
        assert len(leading) <= 1, leading


@pytest.fixture
def engine(fleet_url):
    engine, _ = open_engine(read_address(fleet_url))
    return engine


def test_no_two_gateways_command_one_robot(engine):
    machine = type("OnPostgreSql", (Fleet,), {"engine": engine})
    run_state_machine_as_test(
        machine,
        settings=settings(
            max_examples=6, stateful_step_count=25, deadline=None, suppress_health_check=list(HealthCheck)
        ),
    )


def test_a_gateway_stops_counting_on_its_lease_a_second_before_it_runs_out():
    assert LEASE_S - TRUST_S >= 1.0
    clock = ManualClock(uptime=0.0)
    trust = LeaseTrust(clock)
    assert not trust.holds
    trust.renewed(0.0)
    clock.advance(TRUST_S - 0.1)
    assert trust.holds
    clock.advance(0.2)
    assert not trust.holds


@pytest.mark.parametrize("seconds", [0.01, 0.7, 1.2])
def test_a_slow_database_keeps_no_lease_from_counting_as_unbroken(seconds):
    """A renewal is followed by a look at the others and a rest."""
    clock = ManualClock(uptime=0.0)
    trust = LeaseTrust(clock)
    for _ in range(9):
        asked_at = clock.steady()
        clock.advance(seconds)
        trust.renewed(asked_at)
        clock.advance(seconds + RENEW_S)
    assert trust.is_unbroken
    clock.advance(LEASE_S)
    trust.renewed(clock.steady())
    assert not trust.is_unbroken


def test_a_gateway_of_the_version_before_is_a_member_without_an_address(engine):
    """While a fleet is upgraded both serve it: what that writes names no address."""
    old, new = Member("old", "run-1"), Member("new", "run-2", address="ws://127.0.0.1:8765")
    join = "insert into gateways (gw, run, version, host, process, since, lease_until) values "
    with engine.begin() as connection:
        connection.execute(text("delete from gateways"))
        connection.execute(text(f"{join} (:gw, :run, '', '', 0, 1, 100)"), {"gw": old.gw, "run": old.run})
        assert gateways.join(connection, new, LEASE_S, 50.0)
        assert [one.address for one in gateways.members(connection, 50.0)] == [None, new.address]
        # Where it is reached may be known only after it has joined.
        assert gateways.renew(connection, new._replace(address="ws://10.0.0.2:1"), LEASE_S, 51.0)
        assert gateways.members(connection, 51.0)[1].address == "ws://10.0.0.2:1"
        # One that starts again and does not listen yet is where it was.
        assert gateways.renew(connection, new._replace(address=None), LEASE_S, 52.0)
        assert gateways.join(connection, Member("new", "run-2"), LEASE_S, 53.0)
        assert gateways.members(connection, 53.0)[1].address == "ws://10.0.0.2:1"


def test_a_gateway_that_does_not_come_back_is_struck_off(engine):
    with engine.begin() as connection:
        connection.execute(text("delete from gateways"))
        for name, now in (("gone", 0.0), ("dead", 90.0), ("alive", 100.0)):
            assert gateways.join(connection, Member(name, f"run-{name}"), LEASE_S, now)
        assert gateways.strike_gone(connection, 50.0, 102.0) == ["gone"]
        assert [one.gw for one in gateways.members(connection, 102.0)] == ["dead", "alive"]
        assert gateways.strike_gone(connection, 50.0, 102.0) == []


def test_a_change_is_read_whenever_it_is_committed(engine):
    """A transaction that begins before another and ends after it is not passed over."""
    stored = "insert into robots (name, magic, link, received_at, ended_in_order) values (:r, 1, 'sql', 0, 0)"
    change = text("update robot_owners set gw = :gw where robot = :robot")
    robots = ("o1", "o2", "o3")
    with engine.begin() as setup:
        setup.execute(text("delete from robot_owners"))
        for robot in robots:
            setup.execute(text(stored), {"r": robot})
            setup.execute(text("insert into robot_owners values (:r, 'a', 'run', 1)"), {"r": robot})

    def read(mark):
        with engine.begin() as connection:
            return gateways.owners_since(connection, mark)

    first = read(None)
    assert {*first.owners} == {*robots} and all(owner.stored for owner in first.owners.values())
    with engine.connect() as slow:
        slow.execute(change, {"gw": "b", "robot": "o1"})
        with engine.begin() as quick:
            quick.execute(change, {"gw": "b", "robot": "o2"})
        second = read(first.mark)
        assert {*second.owners} == {"o2"} and second.total == 3
        slow.commit()
    third = read(second.mark)
    assert third.owners["o1"].gw == "b" and "o3" not in third.owners
    assert not read(read(third.mark).mark).owners
    with engine.begin() as connection:
        connection.execute(text("delete from robots where name = 'o3'"))
    assert not read(third.mark).owners["o3"].stored
    with engine.begin() as connection:
        connection.execute(text("delete from robots"))


@pytest.mark.parametrize("few", [0, 100])
def test_a_fence_holds_until_the_commit_and_not_under_an_older_number(engine, monkeypatch, few):
    monkeypatch.setattr(gateways, "FEW", few)
    a, b = Member("a", "run-a"), Member("b", "run-b")
    owner = text("insert into robot_owners values (:robot, 'a', 'run-a', :fence)")
    with engine.begin() as connection:
        connection.execute(text("delete from robot_owners"))
        for robot, fence in (("r1", 1), ("r2", 3)):
            connection.execute(owner, {"robot": robot, "fence": fence})
    change = text("update robot_owners set gw = 'b', run = 'run-b', fence = 9 where robot = :robot")
    with engine.connect() as writing, engine.connect() as claiming:
        # r2 was another gateway's in between, and r3 is nobody's.
        assert gateways.lost(writing, a, {"r1": 1, "r2": 1, "r3": 1}) == {"r2", "r3"}
        assert gateways.lost(claiming, b, {"r1": 1}) == {"r1"}
        claiming.execute(text("set local lock_timeout = '50ms'"))
        with pytest.raises(OperationalError, match="lock timeout"):
            claiming.execute(change, {"robot": "r1"})
        claiming.rollback()
        writing.commit()
        claiming.execute(change, {"robot": "r1"})
        claiming.commit()
        assert gateways.lost(writing, a, {"r1": 1}) == {"r1"}


@pytest.fixture
def fleet(engine):
    machine = type("OnPostgreSql", (Fleet,), {"engine": engine})()
    yield machine
    machine.teardown()


def went_elsewhere(fleet):
    """Robot r1 went from a, which was about to send it somewhere and has not looked since, to b."""
    fleet.start("a")
    fleet.start("b")
    fleet.connect("r1", "a")
    fleet.check("a", "r1")
    fleet.connect("r1", "b")


def owners(fleet):
    return {robot: owner.gw for robot, owner in fleet.run(gateways.owners_since, None).owners.items()}


def renew_for(fleet, seconds, *names):
    """Renew the leases of gateways each second, and have each claim what is left if that is its task."""
    for _ in range(round(seconds)):
        for name in names:
            fleet.renew(name, 0.0)
            fleet.claim_left(name)
        fleet.pass_time(1.0)


@pytest.mark.parametrize("away", [4.2, 6.0, 600.0])
def test_robots_stay_where_they_are_while_nobody_reaches_the_database(fleet, away):
    """The first one that reaches it again takes no robots of those that come a moment later."""
    for name, robot in (("b", "r1"), ("a", "r2")):
        fleet.start(name)
        fleet.connect(robot, name)
    fleet.renew("b", 0.0)
    renew_for(fleet, 6, "b", "a")
    fleet.renew("a", 0.0)
    fleet.pass_time(0.9)
    fleet.renew("b", 0.0)
    fleet.pass_time(away)
    for _ in range(3):
        fleet.renew("b", 0.0)
        fleet.claim_left("b")
        fleet.pass_time(1.0)
    assert owners(fleet) == {"r1": "b", "r2": "a"}
    renew_for(fleet, 8, "b", "a")
    assert owners(fleet) == {"r1": "b", "r2": "a"}
    # One that does not come back has its robots claimed.
    fleet.kill("a")
    renew_for(fleet, 8, "b")
    assert owners(fleet) == {"r1": "b", "r2": "b"}


def test_robots_are_not_claimed_by_a_look_from_before_the_database_stood_still(fleet):
    """A statement may wait for seconds in the server, and leases run out meanwhile."""
    fleet.start("b")
    fleet.start("a")
    fleet.connect("r2", "a")
    renew_for(fleet, 6, "b", "a")
    process = fleet.processes["b"]
    spared = spared_runs(process.members, process.trust)
    fleet.pass_time(6.0)
    fleet.renew("b", 0.0)
    assert not fleet.run(gateways.claim_left, process.me, spared, fleet.now)
    assert fleet.run(gateways.claim_left, process.me, [], fleet.now)


async def test_a_gateway_that_has_just_come_claims_no_robots_of_one_that_may_be_back(fleet, fleet_url):
    fleet.run(gateways.join, Member("a", "run-a"), -1.0)
    fleet.connection.execute(text("insert into robot_owners values ('r1', 'a', 'run-a', 1)"))
    fleet.connection.commit()
    database, clock = Database(fleet_url), ManualClock(uptime=100.0)
    membership = Membership("b", database, clock)
    ownership = Ownership(membership, database)
    try:
        await membership.join()
        assert membership.leads and not await ownership.claim_left()
        for _ in range(5):
            clock.advance(RENEW_S)
            await membership.renew()
        assert await ownership.claim_left() == ["r1"]
    finally:
        await database.close()


def test_robots_of_a_gateway_that_left_are_claimed_at_once(fleet):
    fleet.start("a")
    fleet.connect("r1", "a")
    fleet.leave("a")
    fleet.start("b")
    fleet.claim_left("b")
    assert owners(fleet) == {"r1": "b"}


def test_the_machine_finds_a_fence_that_is_open(fleet, monkeypatch):
    went_elsewhere(fleet)
    fleet.one_fence_one_owner()
    monkeypatch.setattr(gateways, "lost", lambda connection, me, fences: set())
    with pytest.raises(AssertionError):
        fleet.one_fence_one_owner()


def test_the_machine_finds_what_is_sent_long_after_it_was_checked(fleet, monkeypatch):
    went_elsewhere(fleet)
    fleet.connected["r1"] = "a"  # the robot came back, and its Ready has not been read yet
    fleet.pass_time(3.0)
    for name in ("a", "b"):
        fleet.renew(name, 0.0)
    fleet.send("a")
    process = fleet.processes["a"]
    process.checked.append(("r1", 1, fleet.clock.steady()))  # as if it were checked just now
    with pytest.raises(AssertionError):
        fleet.send("a")


def test_the_machine_finds_a_lease_that_is_counted_on_for_too_long(fleet, monkeypatch):
    fleet.start("a")
    fleet.pass_time(4.5)
    fleet.start("b")
    fleet.who_trusts_its_lease_has_one()
    fleet.pass_time(1.0)
    fleet.renew("b", 0.0)
    fleet.one_leads()
    monkeypatch.setattr(LeaseTrust, "holds", property(lambda self: True))
    for found in (fleet.who_trusts_its_lease_has_one, fleet.one_leads):
        with pytest.raises(AssertionError):
            found()
