"""Leases and ownership as one gateway knows of them; no I/O.

A gateway lives in the database for :data:`LEASE_S` after each renewal, by the database's clock. By its own
steady clock it counts on that for :data:`TRUST_S` after it *asked* for the renewal, which was earlier: so it
stops commanding robots at least a second before another gateway may claim them. No clock of day is compared
with another.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence

from ...core.clock import Clock
from ...core.errors import BridgeError
from ..storage.repositories.gateways import Claimed, Member

LEASE_S, TRUST_S, RENEW_S = 5.0, 4.0, 1.0
"""seconds that a renewal is valid for in the database, that a gateway counts on it, and between two."""
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")


def check_gateway_name(name: str) -> str:
    """Return ``name``; raises BridgeError for one that no gateway can have."""
    if not _NAME.fullmatch(name):
        raise BridgeError(
            f"gateway name {name!r:.60} cannot be; use up to 32 letters, digits, _ and -, such as gateway-1"
        )
    return name


class LeaseTrust:
    """Until when a gateway may count on its lease, by its own steady clock, which counts sleep."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._asked_at = -math.inf

    def renewed(self, asked_at: float) -> None:
        """Note that a renewal succeeded that was asked for at ``asked_at``, on the steady clock."""
        self._asked_at = max(self._asked_at, asked_at)

    def lost(self) -> None:
        """Count on nothing any more, until the next renewal."""
        self._asked_at = -math.inf

    @property
    def holds(self) -> bool:
        """Whether the lease can still be counted on."""
        return self._clock.steady() - self._asked_at < TRUST_S


class OwnedRobots:
    """The robots that a gateway has, with their fences."""

    def __init__(self) -> None:
        self._fences: dict[str, int] = {}

    def __contains__(self, robot: str) -> bool:
        return robot in self._fences

    def __len__(self) -> int:
        return len(self._fences)

    def fence(self, robot: str) -> int | None:
        """Return the fence under which this gateway has a robot, None where it has not."""
        return self._fences.get(robot)

    def claimed(self, me: Member, claims: Mapping[str, Claimed]) -> set[str]:
        """Take over robots that were claimed; return those of which nothing is known here any more.

        What was known of the others still holds: nobody else has had them since.
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
        """Take over robots that nobody had."""
        self._fences.update(fences)

    def compare(self, stored: Mapping[str, int]) -> tuple[set[str], set[str]]:
        """Return which robots are lost and which are new, by what is ``stored`` of this gateway.

        A robot whose fence is another is both: somebody has had it in between.
        """
        lost = {robot for robot, fence in self._fences.items() if stored.get(robot) != fence}
        return lost, {robot for robot, fence in stored.items() if self._fences.get(robot) != fence}

    def forget(self, robots: Iterable[str]) -> None:
        """Have these robots no more."""
        for robot in robots:
            self._fences.pop(robot, None)

    def matching(self, stored: Mapping[str, int]) -> set[str]:
        """Return those robots in ``stored`` whose fence is the one under which this gateway has them."""
        return {robot for robot, fence in stored.items() if self._fences.get(robot) == fence}


def leads(me: Member, members: Sequence[Member]) -> bool:
    """Tell whether a gateway does what is to be done once per database: the oldest that lives does."""
    alive = [member for member in members if member.alive]
    return bool(alive) and min(alive, key=lambda member: member.since).run == me.run
