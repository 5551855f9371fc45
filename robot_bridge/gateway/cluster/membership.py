"""Membership: a gateway joins the fleet, renews its lease each second, and knows which others live.

A gateway lives in the database for :data:`LEASE_S` after each renewal, by the database's clock. By its own
steady clock it trusts that for :data:`TRUST_S` after it *requested* the renewal, which was earlier: so it
stops commanding robots at least a second before another gateway may claim them. No wall clocks are compared.
"""

from __future__ import annotations

import asyncio
import logging
import math
import os
import re
import socket
import uuid
from collections.abc import Iterable, Mapping, Sequence

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import BridgeError, FatalError, StoreError
from ..monitoring import gateway_version, until_tick
from ..storage.database import Database
from ..storage.repositories import gateways
from ..storage.repositories.gateways import Claimed, Member, MembersRead
from ..storage.singleton_lock import check_no_sole_gateway

log = logging.getLogger(__name__)

# --- Leases and ownership as known to one gateway; no I/O ---

LEASE_S, TRUST_S, RENEW_S = 5.0, 4.0, 1.0
"""seconds that a renewal is valid in the database, that a gateway trusts it, and between renewals."""
BREAK_S = LEASE_S - 1.5 * RENEW_S
"""seconds between two renewals of a gateway in which the leases of others may have run out as well."""
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")


def check_gateway_name(name: str) -> str:
    """Return ``name``; raises BridgeError for an invalid name."""
    if not _NAME.fullmatch(name):
        raise BridgeError(
            f"gateway name {name!r:.60} cannot be; use up to 32 letters, digits, _ and -, such as gateway-1"
        )
    return name


class LeaseTrust:
    """How long a gateway may trust its lease, by its own steady clock, which counts sleep."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._asked_at = -math.inf
        self._succeeded_at = -math.inf
        self._unbroken_since = math.inf

    def renewed(self, asked_at: float) -> None:
        """Record that a renewal requested at ``asked_at``, on the steady clock, succeeded."""
        now = self._clock.steady()
        if now - self._succeeded_at > BREAK_S:
            self._unbroken_since = now
        self._succeeded_at = now
        self._asked_at = max(self._asked_at, asked_at)

    def lost(self) -> None:
        """Trust nothing until the next renewal."""
        self._asked_at = -math.inf

    @property
    def holds(self) -> bool:
        """Whether the lease can still be trusted."""
        return self._clock.steady() - self._asked_at < TRUST_S

    @property
    def is_unbroken(self) -> bool:
        """Whether it has been renewed for so long that others had time to renew theirs."""
        return self._clock.steady() - self._unbroken_since >= LEASE_S


class OwnedRobots:
    """The robots that a gateway has, with their fences."""

    def __init__(self) -> None:
        self._fences: dict[str, int] = {}

    def __contains__(self, robot: str) -> bool:
        return robot in self._fences

    def __len__(self) -> int:
        return len(self._fences)

    def claimed(self, me: Member, claims: Mapping[str, Claimed]) -> set[str]:
        """Take over claimed robots; return those whose known state is out of date.

        The known state of the others is still valid: nobody else has owned them since.
        """
        unknown = {
            robot
            for robot, claim in claims.items()
            if claim.before is None
            or (claim.before.gw, claim.before.run) != (me.gw, me.run)
            or claim.before.fence != self._fences.get(robot)
        }
        self._fences.update({robot: claim.fence for robot, claim in claims.items()})
        return unknown

    def gained(self, fences: Mapping[str, int]) -> None:
        """Take over robots that had no owner."""
        self._fences.update(fences)

    def compare(self, stored: Mapping[str, int]) -> tuple[set[str], set[str]]:
        """Return the lost and the new robots, by the ``stored`` ones of this gateway.

        A robot with another fence is both: another gateway has owned it in between.
        """
        if self._fences == stored:
            # The usual case; it takes a tenth of the time of what follows.
            return set(), set()
        lost = {robot for robot, fence in self._fences.items() if stored.get(robot) != fence}
        return lost, {robot for robot, fence in stored.items() if self._fences.get(robot) != fence}

    def others(self, robots: Iterable[str]) -> set[str]:
        """Return those of ``robots`` that this gateway does not own."""
        return set(robots).difference(self._fences)

    def forget(self, robots: Iterable[str]) -> None:
        """Remove these robots."""
        for robot in robots:
            self._fences.pop(robot, None)

    def fences(self, robots: Iterable[str]) -> dict[str, int]:
        """Return the fences of those of ``robots`` that this gateway owns."""
        fences = self._fences
        return {robot: fence for robot in robots if (fence := fences.get(robot)) is not None}


def leads(me: Member, members: Sequence[Member]) -> bool:
    """Return whether a gateway does the tasks done once per database: the oldest living one does."""
    alive = [member for member in members if member.alive]
    return bool(alive) and min(alive, key=lambda member: member.since).run == me.run


def spared_runs(members: Sequence[Member], trust: LeaseTrust) -> list[str]:
    """Return the runs of gateways whose robots must not be claimed, whatever their leases are by now.

    When the database was away for longer than a lease, all gateways seem dead to the first one that reaches
    it again, yet still own their robots.
    """
    return [member.run for member in members if member.alive or not trust.is_unbroken]


# --- The gateway in the database ---

LEASE_PATIENCE_S = 2.0
"""seconds that a renewal may take: the next one must have its turn while the lease still holds."""
CLAIMED_S = 3 * RENEW_S
"""seconds after the end of a lease by which another gateway owns the robots."""
CLOCK_TOLERANCE_S = 1.0
"""seconds that this computer's clock may differ from the database's before that is logged."""
OFF_AGAIN_S = 60.0
MOST_STRANGE = 100
"""limit of remembered runs that were heard but not read."""
GONE_S = 7 * 24 * 3600.0
"""seconds after the end of its lease until a gateway is removed: until then it may be restarted."""


class SharedClock(Clock):
    """The database's clock as a gateway knows it: times that gateways record by it are comparable."""

    def __init__(self, membership: Membership, clock: Clock) -> None:
        self._membership = membership
        self._clock = clock

    def time(self) -> float:
        """Return the seconds since the Unix epoch by the database's clock."""
        return self._membership.database_time()

    def steady(self) -> float:
        """Return the seconds of this computer's steady clock."""
        return self._clock.steady()


class Membership:
    """One gateway among those of a fleet.

    The lease has a connection of its own: other writes must not delay it. After
    :meth:`join` it is renewed by :meth:`renew`, to be called every :data:`.RENEW_S` seconds.
    """

    def __init__(self, name: str, lease: Database, clock: Clock = SYSTEM_CLOCK) -> None:
        self.me = Member(
            check_gateway_name(name), uuid.uuid4().hex, gateway_version(), socket.gethostname(), os.getpid()
        )
        self.trust = LeaseTrust(clock)
        self.members: Sequence[Member] = ()
        """all gateways, as read at the last renewal."""
        self.clock_offset = 0.0
        """seconds that the database's clock is ahead of this computer's."""
        self.shared_clock = SharedClock(self, clock)
        self._lease = lease
        self._clock = clock
        self._clock_said_at = -OFF_AGAIN_S
        self._missed_until: dict[str, float] = {}
        """until when (steady clock) gateways count as just lost that were missing when this one could renew
        its lease again."""
        self._runs = {self.me.run}
        """the runs of this fleet's gateways that were alive when read."""
        self._strange = dict[str, float]()
        """when unread runs were first heard, by the steady clock."""
        self._strangers = set[str]()
        """those of them that serve another database: they still do while this one is away."""
        self._other_versions = set[tuple[str, str]]()
        """the gateways of another version, and that version, as logged."""

    @property
    def name(self) -> str:
        """The name of this gateway."""
        return self.me.gw

    @property
    def leads(self) -> bool:
        """Whether this gateway does the tasks done once per database, and may trust that."""
        return self.trust.holds and leads(self.me, self.members)

    def spared_runs(self) -> list[str]:
        """Return the runs of gateways whose robots must not be claimed, whatever their leases are by now."""
        return spared_runs(self.members, self.trust)

    def others(self) -> list[str]:
        """Return the names of the other gateways that were alive at the last renewal."""
        return [member.gw for member in self.members if member.alive and member.gw != self.name]

    def just_lost(self) -> list[str]:
        """Return the gateways whose lease has expired so lately that their robots may have no owner yet.

        After a database outage nobody claims them for :data:`LEASE_S` after it is back.
        """
        now, until = self._clock.steady(), self._missed_until
        lost = [member for member in self.members if not member.alive and member.gw != self.name]
        return [one.gw for one in lost if one.left > -CLAIMED_S or now < until.get(one.gw, -math.inf)]

    def has_read(self, run: str) -> bool:
        """Return whether a gateway was read in the database of this fleet.

        One that joined a moment ago was not, nor was one that serves a copy of that database.
        """
        return run in self._runs

    def is_without_lease(self, run: str) -> bool:
        """Return whether a gateway is listed in the database and does not renew its lease there.

        It may be cut off from the database, or serve a copy of it, in which it is read as well.
        """
        return run not in self._runs and any(member.run == run for member in self.members)

    def is_stranger(self, run: str) -> bool:
        """Return whether a gateway heard with this fleet's key is none of it: its database is a copy.

        A gateway of this fleet is in the database before it sends: one not read after a while serves another.
        """
        if run in self._runs:
            return False
        if len(self._strange) >= MOST_STRANGE:
            self._strange.clear()
            self._strangers.clear()
        now = self._clock.steady()
        # The current members were read since.
        if now - self._strange.setdefault(run, now) >= LEASE_S and self.trust.holds:
            self._strangers.add(run)
        return run in self._strangers

    def database_time(self) -> float:
        """Return the time by the database's clock, which all gateways use."""
        return self._clock.time() + self.clock_offset

    def reached_at(self, address: str) -> None:
        """Record where robots reach this gateway, ``ws://host:port``; empty if unknown."""
        self.me = self.me._replace(address=address)

    def addresses(self) -> list[str]:
        """Return the known addresses of the fleet's gateways: this one, then the living ones.

        Those that did not end in good order come last: they may be back when a client tries them.
        """
        others = [member for member in self.members if member.gw != self.name]
        known = [self.me, *sorted(others, key=lambda member: (not member.alive, member.since, member.gw))]
        return [member.address for member in known if member.address]

    async def join(self) -> None:
        """Join the fleet; raises BridgeError if another gateway has this name, or the database alone.

        It waits until the lease of a killed namesake expires; one that renews it is alive.
        """
        latest_end = math.inf
        while True:
            asked_at = self._clock.steady()
            if await self._lease.run(gateways.join, self.me, LEASE_S):
                break
            read_at = self._clock.steady()
            other = await self._namesake()
            left = 0.0 if other is None else other.left
            # The lease was read after ``read_at`` and before now: a busy computer answers late.
            latest_end = min(latest_end, self._clock.steady() + left)
            if read_at + left > latest_end + RENEW_S / 2:
                raise BridgeError(self._name_is_taken(other))
            await asyncio.sleep(0.25)
        self.trust.renewed(asked_at)
        try:
            await asyncio.to_thread(check_no_sole_gateway, self._lease.url)
        except BaseException:
            await self.leave()
            raise
        await self.renew()

    async def renew(self) -> None:
        """Renew the lease and read which others live.

        :raises FatalError: when another process uses the name of this gateway.
        :raises StoreError: when the database cannot be used: the lease runs out, unless a later call
        succeeds.
        """
        asked_at = self._clock.steady()
        found = await self._renewed()
        if found is None:
            await self._lease.run(gateways.join, self.me, LEASE_S)
            asked_at = self._clock.steady()
            found = await self._renewed()
        if found is None:
            self.trust.lost()
            taken = self._name_is_taken(await self._namesake())
            raise FatalError(
                f"{taken}. It took the name while this one was cut off from the database; this one ends"
            )
        self.trust.renewed(asked_at)
        before = set(self.others())
        self.members = found.members
        # A copy also holds the rows of the original database's gateways, whose leases have expired there.
        self._runs.update(member.run for member in found.members if member.alive)
        self._compare_clocks(found)
        self._record_missed(before.difference(self.others()))
        self._name_changes(before, set(self.others()))
        self._compare_versions()

    async def _renewed(self) -> MembersRead | None:
        return await self._lease.run(gateways.renew_and_read, self.me, LEASE_S, self._clock)

    async def hold(self) -> None:
        """Renew the lease until cancelled; raises FatalError as :meth:`renew`."""
        said = ""
        while True:
            await asyncio.sleep(until_tick(RENEW_S))
            try:
                await self.renew()
                said = ""
            except FatalError:
                raise
            except StoreError as error:
                if str(error) != said:
                    log.error("%s; the lease of gateway %s is renewed as soon as it can be", error, self.name)
                said = str(error)
            except Exception:
                log.exception("the lease of gateway %s could not be renewed", self.name)

    async def leave(self) -> None:
        """Leave the fleet in good order: its robots can be claimed at once. Failures are ignored."""
        self.trust.lost()
        try:
            await self._lease.run(gateways.leave, self.me)
        except StoreError as error:
            log.warning("gateway %s could not take leave, and its lease has to run out: %s", self.name, error)

    async def strike_gone(self) -> None:
        """Remove the gateways that have been dead for a week; raises StoreError."""
        for name in await self._lease.run(gateways.strike_gone, GONE_S):
            log.warning("gateway %s has not lived for %d days, and is struck off", name, GONE_S // 86400)

    async def _namesake(self) -> Member | None:
        """Return the entered gateway of this name."""
        found = await self._lease.read(gateways.members)
        return next((member for member in found if member.gw == self.name), None)

    def _name_is_taken(self, other: Member | None) -> str:
        who = f": process {other.process} on {other.host}" if other is not None else ""
        return (
            f"database {self._lease.where}: another gateway named {self.name!r} serves this fleet{who}; give "
            "each gateway a name of its own with --gateway-name, or end that one first"
        )

    def _compare_versions(self) -> None:
        found = {(m.gw, m.version) for m in self.members if m.alive and m.version != self.me.version}
        for name, version in sorted(found - self._other_versions):
            log.warning(
                "gateway %s is version %s, this one (%s) is %s; let versions differ no longer than an "
                "upgrade takes",
                name,
                version,
                self.name,
                self.me.version,
            )
        self._other_versions = found

    def _compare_clocks(self, read: MembersRead) -> None:
        self.clock_offset = read.database - read.here
        now = self._clock.steady()
        if abs(self.clock_offset) > CLOCK_TOLERANCE_S and now - self._clock_said_at >= OFF_AGAIN_S:
            self._clock_said_at = now
            log.warning(
                "the clock of this computer is %.1f s off the database's; times of commands and positions of "
                "this gateway do not fit the others': let NTP set all clocks",
                abs(self.clock_offset),
            )

    def _record_missed(self, lost: Iterable[str]) -> None:
        if not self.trust.is_unbroken:
            until = self._clock.steady() + LEASE_S + CLAIMED_S
            self._missed_until.update(dict.fromkeys(lost, until))

    def _name_changes(self, before: set[str], after: set[str]) -> None:
        for name in sorted(after - before):
            log.warning("gateway %s serves this fleet, too", name)
        known = {member.gw: member for member in self.members}
        for name in sorted(before - after):
            if (member := known.get(name)) is None:
                log.warning("gateway %s has ended; its robots connect to the others", name)
                continue
            log.warning(
                "gateway %s has not renewed its lease for %g s; unless it does, another one has its robots "
                "in %g s at most: see whether process %d on %s runs, and reaches the database",
                name,
                LEASE_S,
                CLAIMED_S + (0.0 if self.trust.is_unbroken else LEASE_S),
                member.process,
                member.host,
            )
