"""What the log of a gateway says of the others of its fleet, and of its own clock; on a real PostgreSQL."""

from __future__ import annotations

import asyncio
import os
import re
import socket
from types import SimpleNamespace

import pytest

from robot_bridge.core.clock import Clock
from robot_bridge.core.errors import BridgeError
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.cluster.cluster import lease_database
from robot_bridge.gateway.cluster.membership import CLAIMED_S, LEASE_S, OFF_AGAIN_S, RENEW_S, Membership
from robot_bridge.gateway.cluster.messages import Exchange
from robot_bridge.gateway.cluster.ownership import Ownership
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.storage.database import read_address
from robot_bridge.gateway.storage.repositories import gateways


class ClockOff(Clock):
    """A clock that was set wrong by some seconds; ``later`` is what its steady time is ahead."""

    def __init__(self, seconds):
        self._seconds, self.later = seconds, 0.0

    def time(self):
        return super().time() + self._seconds

    def steady(self):
        return super().steady() + self.later


@pytest.fixture
async def lease(fleet_url):
    database = lease_database(read_address(fleet_url))
    await database.open()
    yield database
    await database.close()


@pytest.fixture
def clock():
    return ClockOff(0.0)


@pytest.fixture
async def own(lease, clock):
    own = Membership("own", lease, clock)
    await own.join()
    yield own
    await own.leave()


async def enter(lease, name, version, lease_s=60.0):
    """Enter another gateway into the fleet."""
    other = Membership(name, lease).me._replace(version=version, host="north.example.org", process=4711)
    assert await lease.run(gateways.join, other, lease_s)
    return other


async def test_one_that_ended_and_one_that_stands_still_are_told_apart(own, lease, clock, caplog):
    while not own.trust.is_unbroken:
        clock.later += RENEW_S
        await own.renew()
    ended, silent = await enter(lease, "ended", own.me.version), await enter(lease, "silent", own.me.version)
    await own.renew()
    assert "gateway silent serves this fleet, too" in caplog.text
    await lease.run(gateways.leave, ended)
    # As it is once the lease has run out.
    assert await lease.run(gateways.renew, silent, -1.0)
    await own.renew()
    assert "gateway ended has ended; its robots connect to the others" in caplog.text
    assert "for 5 s; unless it does, another one has its robots in 3 s at most" in caplog.text
    assert "see whether process 4711 on north.example.org runs" in caplog.text
    assert own.others() == [] and own.just_lost() == ["silent"]
    assert await lease.run(gateways.join, silent, -1.0 - CLAIMED_S)
    await own.renew()
    assert own.just_lost() == []
    await lease.run(gateways.leave, silent)


async def test_one_that_died_while_the_database_was_away_is_missed_until_its_robots_are_claimed(
    own, lease, clock
):
    """Nobody claims them at once then: all gateways seem dead to the first one that is back."""
    died = await enter(lease, "died", own.me.version)
    await own.renew()
    clock.later = 60.0
    assert await lease.run(gateways.renew, died, -60.0)
    await own.renew()
    assert died.run in own.spared_runs()
    assert own.others() == [] and own.just_lost() == ["died"]
    clock.later += LEASE_S + CLAIMED_S
    assert own.just_lost() == []
    await lease.run(gateways.leave, died)


async def test_a_version_that_differs_is_named_at_both_and_once(own, lease, caplog):
    other = await enter(lease, "newer", "99.0")
    await own.renew()
    await own.renew()
    said = f"gateway newer is version 99.0, this one (own) is {own.me.version}; let versions differ no longer"
    assert caplog.text.count(said) == 1
    # It is started again under the same name, as an upgrade does, within a second.
    await lease.run(gateways.leave, other)
    other = await enter(lease, "newer", "99.1")
    await own.renew()
    assert "gateway newer is version 99.1" in caplog.text
    late = Membership("late", lease)
    await late.join()
    assert f"gateway newer is version 99.1, this one (late) is {own.me.version}" in caplog.text
    await late.leave()
    await lease.run(gateways.leave, other)


@pytest.mark.parametrize("seconds", [-300.0, 300.0])
async def test_a_clock_that_is_minutes_off_is_named_once_a_minute_and_keeps_no_lease_from_holding(
    lease, site_maps, caplog, seconds
):
    clock = ClockOff(seconds)
    off = Membership("off", lease, clock)
    await off.join()
    said = r"the clock of this computer is (299|300)\.\d s off the database's"
    await off.renew()
    assert len(re.findall(said, caplog.text)) == 1 and "let NTP set all clocks" in caplog.text
    clock.later = OFF_AGAIN_S
    await off.renew()
    assert len(re.findall(said, caplog.text)) == 2
    assert off.trust.holds and off.leads
    assert abs(off.database_time() - (clock.time() - seconds)) < 30
    # Stops are made and cleared by the clock that all gateways know.
    ownership, exchange = Ownership(off, lease), Exchange("off", b"key", [])
    cluster = SimpleNamespace(membership=off, ownership=ownership, exchange=exchange)
    fleet = Fleet(site_maps, lease, clock, cluster=cluster)
    fleet.emergency.begin(EmergencyStop("stop-number-off"), "Ada")
    assert abs(fleet.emergency.current.at - (clock.time() - seconds)) < 30
    await off.leave()


async def test_whoever_runs_under_the_name_is_named_with_its_place(own, lease):
    with pytest.raises(
        BridgeError, match=rf"named 'own' serves this fleet: process {os.getpid()} on"
    ) as caught:
        await keep_renewing(own, Membership("own", lease).join())
    assert socket.gethostname() in str(caught.value) and "--gateway-name" in str(caught.value)


async def test_the_name_of_one_that_was_killed_is_free_once_its_lease_ends(lease, clock, monkeypatch):
    """A busy computer is slow to open its first connections; by that no lease was renewed."""
    await enter(lease, "killed", "", 0.6)
    read = lease.read

    async def read_late(*work):
        monkeypatch.setattr(lease, "read", read)
        clock.later += RENEW_S
        return await read(*work)

    monkeypatch.setattr(lease, "read", read_late)
    started = Membership("killed", lease, clock)
    await started.join()
    assert started.trust.holds
    await started.leave()


async def keep_renewing(own, work):
    holding = asyncio.create_task(own.hold())
    try:
        return await work
    finally:
        holding.cancel()


async def test_one_that_is_heard_and_never_read_serves_another_database(own, lease, clock):
    other = await enter(lease, "other", own.me.version)
    await own.renew()
    assert not own.is_stranger(own.me.run) and not own.is_stranger(other.run)
    # It may have joined a moment ago.
    assert not own.is_stranger("of a copy")
    later = await enter(lease, "later", own.me.version)
    assert not own.is_stranger(later.run)
    clock.later += LEASE_S
    # Nothing was read since: who knows.
    assert not own.is_stranger("of a copy")
    await own.renew()
    assert own.is_stranger("of a copy") and not own.is_stranger(later.run)
    # It does so still while this one's database is away.
    own.trust.lost()
    assert own.is_stranger("of a copy") and not own.is_stranger("of another copy")
    await own.renew()
    # One that another process took the name of was of this fleet.
    await lease.run(gateways.leave, other)
    await own.renew()
    assert not own.is_stranger(other.run)
    # Those of the first database are entered in a copy, and never lived there.
    first = await enter(lease, "first", own.me.version, -1.0)
    await own.renew()
    assert own.has_read(other.run) and not own.has_read(first.run)
    assert [run for run in (own.me.run, other.run, first.run) if own.is_without_lease(run)] == [first.run]
    await lease.run(gateways.leave, first)
    await lease.run(gateways.leave, later)
