"""Ownership: claims of robots and of their names, and the fence for writes about robots."""

from __future__ import annotations

import asyncio
import logging
import math
import uuid
from collections.abc import Collection, Iterable, Mapping
from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple, Protocol

from sqlalchemy import Connection

from ...core.errors import StoreError, listed_names
from ...core.logs import log_and_continue
from ...core.messages.base import DeskRequest
from ..monitoring import BackgroundTasks
from ..storage.database import Database, to_its_end
from ..storage.repositories import gateways
from ..storage.repositories import robots as stored_robots
from ..storage.repositories.gateways import Claimed, Owner
from ..storage.repositories.robots import FencedError
from .bus import own_subject
from .membership import Membership, OwnedRobots
from .messages import Exchange, NameAnswer, NameQuery

log = logging.getLogger(__name__)

BATCH_S, BATCH = 0.02, 500
"""seconds for which claims are collected, and how many are made at once: fleets connect together."""

ALL_S = 300.0
"""seconds after which the owners of all robots are read, not only the changed ones."""


class OwnerChanges(NamedTuple):
    """Robots taken over by another gateway, and those found to be this one's; ``gateways`` has new owners.

    Robots in ``gone`` are no longer stored: they are new, or were removed.
    """

    lost: set[str]
    new: set[str]
    gone: set[str]
    gateways: dict[str, str]


class Ownership:
    """The robots owned by this gateway: a :class:`.OwnerFence` for writes about them, and claims.

    All of it uses the connection by which robots are written: knowledge here follows the order of storage.
    """

    def __init__(self, membership: Membership, database: Database) -> None:
        self._membership = membership
        self._database = database
        self._robots = OwnedRobots()
        self._waiting: dict[str, asyncio.Future[bool]] = {}
        self._being_claimed: frozenset[str] = frozenset()
        self._claiming: asyncio.Task[None] | None = None
        self._mark: str | None = None
        self._owners: dict[str, Owner] = {}
        """the owner of each robot at the read of :attr:`_mark`."""
        self._mine: dict[str, int] = {}
        """those of them owned by this run of this gateway, with their fences."""
        self._unstored: set[str] = set()
        self._changed: set[str] = set()
        """robots whose change of owner was not followed yet."""
        self._run = ""
        self._read_all_at = -math.inf

    # --- the fence --------------------------------------------------------------------------------------

    def owns(self, robot: str) -> bool:
        """Return whether this gateway owns the robot, as far as it knows."""
        return robot in self._robots

    def may_command(self, robot: str) -> bool:
        """Return whether the robot may be set in motion now: this gateway owns it, and may trust that."""
        return robot in self._robots and self._membership.trust.holds

    def check(self, connection: Connection, robots: Collection[str]) -> None:
        """Raise FencedError unless this gateway owns all ``robots``, and will until the transaction ends."""
        if lost := self.lost(connection, robots):
            raise FencedError(
                f"{listed_names(sorted(lost))}: connected to another gateway by now, or to none; ask "
                "again in a moment"
            )

    def lost(self, connection: Connection, robots: Collection[str]) -> AbstractSet[str]:
        """Return those of ``robots`` not owned by this gateway; the others stay its own until the commit."""
        fences = self._robots.fences(robots)
        lost = gateways.lost(connection, self._membership.me, fences) if fences else set()
        return lost.union(robot for robot in robots if robot not in fences)

    def missing(self, connection: Connection, stored: AbstractSet[str]) -> set[str]:
        """Return those of its robots ``stored`` that were removed from the database."""
        if gateways.present(connection, self._membership.me) == len(stored):
            return set()
        return set(stored).difference(stored_robots.names(connection))

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Have the owner of a robot do a request once this transaction is committed.

        That is the owner by then: the current one may have died. The answer is not collected.
        """
        gateways.add_requests(
            connection, [gateways.NewRequest.of(robot, request)], operator, self._membership.name
        )

    # --- claims -----------------------------------------------------------------------------------------

    async def claim(self, robot: str) -> bool:
        """Claim a robot from any owner; return whether its stored state must be read first.

        Claims that come together are made together. Raises StoreError.
        """
        waiting = self._waiting.get(robot)
        if waiting is None:
            waiting = self._waiting[robot] = asyncio.get_running_loop().create_future()
            if self._claiming is None or self._claiming.done():
                self._claiming = asyncio.create_task(self._claim_together())
        return await asyncio.shield(waiting)

    async def claim_left(self) -> list[str]:
        """Claim the robots that no living gateway owns, if this one leads; return them. Raises StoreError."""
        if not self._membership.leads:
            return []
        spared = self._membership.spared_runs()
        got = await self._database.run(gateways.claim_left, self._membership.me, spared)
        self._robots.gained(got)
        if got:
            log.warning("%d robots had no gateway, and have this one now", len(got))
        return sorted(got)

    def forget(self, robots: Iterable[str]) -> None:
        """Treat these robots as without owner until the next :meth:`refresh`."""
        self._robots.forget(robots)

    async def refresh(self) -> OwnerChanges:
        """Return the changes of owners in the database; raises StoreError.

        Lost robots have no owner here from then on. Changes are returned again until :meth:`note_followed`.
        """
        await self._read_owners()
        lost, new = self._robots.compare(self._mine)
        self._robots.forget(lost)
        # Claims of uncertain outcome; the waiting claimer takes up its robots itself.
        new -= self._being_claimed
        self._robots.gained({robot: self._mine[robot] for robot in new})
        changed = [robot for robot in self._changed | lost if robot in self._owners]
        owners = {robot: self._owners[robot].gw for robot in changed}
        return OwnerChanges(lost, new, set(self._unstored), owners)

    def had_elsewhere(self, robots: Iterable[str]) -> dict[str, str]:
        """Return those of ``robots`` that another gateway owned at the last read, with its name.

        Robots claimed by this one since are not included.
        """
        others = self._robots.others(robots) - self._being_claimed
        owners = {robot: self._owners[robot].gw for robot in others if robot in self._owners}
        return {robot: gateway for robot, gateway in owners.items() if gateway != self._membership.name}

    def note_followed(self) -> None:
        """Record that the last result of :meth:`refresh` is known everywhere in this gateway."""
        self._changed.clear()

    async def _read_owners(self) -> None:
        """Read the changed owners, and all at intervals."""
        now = asyncio.get_running_loop().time()
        if now - self._read_all_at >= ALL_S or self._run != self._membership.me.run:
            self._mark = None
        found = await self._database.read(gateways.owners_since, self._mark)
        if self._mark is not None:
            # The read includes those that are not stored, whether changed or not.
            stored = self._unstored.difference(found.owners)
            self._record_owners({robot: self._owners[robot]._replace(stored=True) for robot in stored})
            self._record_owners(found.owners)
            if len(self._owners) != found.total:
                self._mark = None
                found = await self._database.read(gateways.owners_since, None)
        if self._mark is None:
            self._read_all_at = now
            self._record_all(found.owners)
        self._mark = found.mark

    def _record_all(self, owners: Mapping[str, Owner]) -> None:
        """Record the owners of all robots; those that are as before are not followed again.

        With 100 000 robots that would occupy the loop for 0.2 s, and a stop would wait.
        """
        before, me = self._owners, self._membership.me
        self._run = me.run
        self._owners = dict(owners)
        self._mine = {
            robot: fence for robot, (gw, run, fence, _) in owners.items() if run == me.run and gw == me.gw
        }
        self._unstored = {robot for robot, owner in owners.items() if not owner.stored}
        self._changed.update([robot for robot, owner in owners.items() if before.get(robot) != owner])

    def _record_owners(self, owners: Mapping[str, Owner]) -> None:
        me = self._membership.me
        self._owners.update(owners)
        self._changed.update(owners)
        for robot, owner in owners.items():
            if (owner.gw, owner.run) == (me.gw, self._run):
                self._mine[robot] = owner.fence
            else:
                self._mine.pop(robot, None)
            if owner.stored:
                self._unstored.discard(robot)
            else:
                self._unstored.add(robot)

    async def _claim_together(self) -> None:
        await asyncio.sleep(BATCH_S)
        while self._waiting:
            some = dict(list(self._waiting.items())[:BATCH])
            for robot in some:
                del self._waiting[robot]
            self._being_claimed = frozenset(some)
            try:
                claims: dict[str, Claimed] = await to_its_end(
                    self._database.run(gateways.claim, self._membership.me, sorted(some))
                )
            except Exception as error:
                _fail(some.values(), error)
                continue
            finally:
                self._being_claimed = frozenset()
            unknown = self._robots.claimed(self._membership.me, claims)
            for robot, waiting in some.items():
                if not waiting.done():
                    waiting.set_result(robot in unknown)


def _fail(waiting: Iterable[asyncio.Future[bool]], error: Exception) -> None:
    for one in waiting:
        if not one.done():
            one.set_exception(error if isinstance(error, StoreError) else StoreError(str(error)))
            # The waiting task may be gone.
            one.exception()


# --- Names: asking the owning gateway whether another robot runs under a name ---

ANSWER_WITHIN_S = 1.5
"""seconds that a Ready waits for another gateway, which may need one to ping its robot."""


class NameHolder(Protocol):
    """The robots that say Ready to this gateway."""

    async def refusal(self, robot: str, magic: int) -> str | None:
        """Return why a Ready with ``magic`` is refused (another robot of that name is here), or None."""


class NameClaims:
    """Asks other gateways about a robot's name, and answers them by ``holder``."""

    def __init__(self, exchange: Exchange, holder: NameHolder) -> None:
        self._exchange = exchange
        self._holder = holder
        self._asked: dict[str, asyncio.Future[str | None]] = {}
        self._answering = BackgroundTasks()
        exchange.subscribe(NameQuery, self._begin_answer)
        exchange.subscribe(NameAnswer, self._answered)

    async def refusal(self, robot: str, magic: int, gateway: str) -> str | None:
        """Return why ``gateway``, which owns ``robot``, denies its name to a Ready with ``magic``.

        One that does not answer denies nothing: its robots must be able to continue here.
        """
        id = uuid.uuid4().hex
        asked = self._asked[id] = asyncio.get_running_loop().create_future()
        try:
            if not self._exchange.send(
                own_subject(gateway), NameQuery(self._exchange.gateway, id, robot, magic)
            ):
                return None
            async with asyncio.timeout(ANSWER_WITHIN_S):
                refusal = await asked
        except TimeoutError:
            log.warning("gateway %s does not say whether another robot runs there as %r", gateway, robot)
            return None
        finally:
            del self._asked[id]
        return None if refusal is None else f"at gateway {gateway} {refusal}"

    def _begin_answer(self, query: NameQuery) -> None:
        self._answering.start(self._answer(query))

    async def _answer(self, query: NameQuery) -> None:
        with log_and_continue(log, f"answering gateway {query.gw} about robot {query.robot!r}"):
            refusal = await self._holder.refusal(query.robot, query.magic)
            answer = NameAnswer(self._exchange.gateway, query.id, refusal)
            self._exchange.send(own_subject(query.gw), answer)

    def _answered(self, answer: NameAnswer) -> None:
        asked = self._asked.get(answer.id)
        if asked is not None and not asked.done():
            asked.set_result(answer.refusal)
