"""Emergency stops across gateways, over the bus and by polling each second; Aborts that are not stored."""

from __future__ import annotations

import asyncio
import itertools
import logging
import uuid
from collections.abc import Collection, Iterable, Sequence
from typing import Any, Protocol

from msgspec.structs import replace

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import StoreError, listed_names
from ...core.messages.base import LONGEST_OPERATOR, one_line
from ...core.messages.commands import ABORT_VALID_S
from ...core.messages.safety import LONGEST_REASON, StoppedGateways
from ..monitoring import until_tick, wait_at_most
from ..storage.database import Database
from ..storage.repositories import emergency_stops
from ..storage.repositories.emergency_stops import StopRow
from .bus import EVERYBODY, LARGEST_NOTIFICATION, STOP
from .membership import Membership
from .messages import (
    MOST_ABORTS,
    AbortsNoted,
    AbortsSettled,
    Exchange,
    NotedAbort,
    StopCall,
    StopSeen,
    Wake,
    batches,
)

log = logging.getLogger(__name__)

LOOK_S = 1.0
"""seconds between database checks, and between calls over the bus to gateways that have not answered."""
TELL_S = 0.1
"""seconds for which robots' answers are collected before others are notified."""
CUT_OFF_S = 5.0
"""seconds without the database and without any other gateway after which a gateway counts as cut off."""
COUNTS_HOLD_S = 3.0
"""seconds of silence after which a gateway's robots are no longer counted; it beats each second."""
MOST_NAMES = 50
LONGEST_NAMES = 1200
"""bytes of the names of each kind in a message to other gateways: a notification of PostgreSQL has few."""
_NAMED_ONE_BY_ONE = ("waiting", "refused", "moving", "unheard")
_COUNTED_BEYOND = ("moving", "unheard")
"""kinds of robots for which an EmergencyReport counts those not named."""


class LocalStops(Protocol):
    """The emergency stops of this gateway."""

    @property
    def in_force(self) -> bool:
        """Whether robots must not be set in motion."""

    @property
    def current(self) -> StopRow | None:
        """The stop in force, or the last cleared one."""

    def local_counts(self) -> dict[str, Any]:
        """Return the counts of answers of this gateway's robots."""

    def announce(self) -> None:
        """Send every operator the current state."""

    def stop_elsewhere(self, stop: StopRow) -> None:
        """Put a stop of another gateway in force."""

    @property
    def known_ids(self) -> Sequence[str]:
        """The ids of the stops in force here, and of the last one."""

    def learn(self, stop: StopRow) -> None:
        """Apply a stop as stored."""


class EmergencyStopRelay:
    """Sends stops made here to other gateways, and receives theirs.

    An operator's stop of this gateway's own robots waits for none of this.
    """

    def __init__(
        self,
        stops: LocalStops,
        membership: Membership,
        exchange: Exchange,
        lease: Database,
        clock: Clock = SYSTEM_CLOCK,
        *,
        stops_when_cut_off: bool = True,
    ) -> None:
        self._stops = stops
        self._membership = membership
        self._exchange = exchange
        self._lease = lease
        self._clock = clock
        self._seen: dict[str, StopSeen] = {}
        """the last answer of each other gateway to the stop in force."""
        self._asked: dict[str, str] = {}
        """the stop that each other gateway called for last: of several in force it may differ from the one
        reported here."""
        self._named: list[str] = []
        """the gateways due to answer, as last reported to operators."""
        self._changed = asyncio.Event()
        self._look_now = asyncio.Event()
        self._looked_at = clock.steady()
        self._has_company = False
        """whether there were other gateways at the last contact with the database."""
        self._stops_when_cut_off = stops_when_cut_off
        exchange.subscribe(StopCall, self._called)
        exchange.subscribe(StopSeen, self._answered)
        exchange.subscribe(Wake, self._woken)

    # --- as a fleet.emergency_stop.StopRelay ----------------------------------------------------------------

    def announce(self, stop: StopRow) -> None:
        """Send a stop to all others."""
        self._seen.clear()
        self._exchange.send(
            STOP, StopCall(self._exchange.gateway, stop.id, stop.at, stop.by[:200], stop.reason)
        )
        self._changed.set()

    def note_change(self) -> None:
        """Record that robots of this gateway have answered."""
        self._changed.set()

    def add_counts(self, counts: dict[str, Any], stop: str) -> dict[str, Any]:
        """Return ``counts`` of a stop with those of the other gateways."""
        others = self._others()
        # Robots of a gateway that is gone are counted by their present owner.
        seen = {name: one for name, one in self._seen.items() if one.id == stop and name in others}
        sums = {
            name: counts[name] + sum(getattr(one, name) for one in seen.values())
            for name in ("robots", "acknowledged", "standing", *(f"{name}_more" for name in _COUNTED_BEYOND))
        }
        names = {
            name: sorted({*counts[name], *(robot for one in seen.values() for robot in getattr(one, name))})
            for name in _NAMED_ONE_BY_ONE
        }
        for name in _COUNTED_BEYOND:
            sums[f"{name}_more"] += max(0, len(names[name]) - MOST_NAMES)
        names = {name: robots[:MOST_NAMES] for name, robots in names.items()}
        missing = [name for name in others if name not in seen]
        return {**sums, **names, "gateways": StoppedGateways(1 + len(seen), 1 + len(others), missing)}

    # --- background work ---

    async def run(self) -> None:
        """Poll the database, and send robots' answers to others, until cancelled."""
        tasks = [asyncio.create_task(work()) for work in (self._poll, self._send_answers, self._call_again)]
        try:
            await asyncio.gather(*tasks)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def read_stored(self) -> None:
        """Read stops, and their ends, from the database; raises StoreError."""
        current, after = self._stops.current, 0.0
        if current is not None:
            after = current.at if current.cleared_at is None else current.cleared_at
        found = await self._lease.read(emergency_stops.changed, self._stops.known_ids, after)
        self._looked_at = self._clock.steady()
        self._has_company = bool(self._membership.others())
        # Cleared stops last: another stop in force must be in place by then.
        for stop in sorted(found, key=lambda stop: stop.cleared_at or 0.0):
            self._stops.learn(stop)

    def is_cut_off(self) -> bool:
        """Return whether this gateway, one of several, reaches neither the database nor another gateway."""
        silent = self._clock.steady() - self._looked_at
        return self._has_company and silent > CUT_OFF_S and not self._exchange.heard()

    async def _poll(self) -> None:
        while True:
            self._look_now.clear()
            try:
                await self.read_stored()
            except StoreError as error:
                log.debug("emergency stops cannot be looked up: %s", error)
                await self._stop_if_cut_off()
            await wait_at_most(self._look_now, until_tick(LOOK_S))

    async def _stop_if_cut_off(self) -> None:
        if not (self._stops_when_cut_off and self.is_cut_off()) or self._stops.in_force:
            return
        log.error(
            "neither the database nor any other gateway has been reached for %g s: all robots stop", CUT_OFF_S
        )
        reason = "cut off from the database and from every other gateway"
        by, at = f"gateway {self._exchange.gateway}", self._membership.database_time()
        self._stops.stop_elsewhere(StopRow(f"cut-off-{uuid.uuid4()}", at, by, reason))

    async def _send_answers(self) -> None:
        while True:
            await self._changed.wait()
            await asyncio.sleep(TELL_S)
            self._changed.clear()
            self._answer()

    async def _call_again(self) -> None:
        while True:
            await asyncio.sleep(until_tick(LOOK_S))
            stop = self._stops.current
            if stop is None or not self._stops.in_force:
                continue
            others = self._others()
            silent = self._seen.keys() - self._exchange.heard(COUNTS_HOLD_S)
            for name in silent:
                # Its robots' last known state is outdated: it is called again.
                del self._seen[name]
            if silent or others != self._named:
                # Operators must not wait for one that is gone.
                self._named = others
                self._stops.announce()
            if any(name not in self._seen or self._seen[name].id != stop.id for name in others):
                self._exchange.send(
                    STOP, StopCall(self._exchange.gateway, stop.id, stop.at, stop.by[:200], stop.reason)
                )

    def _answer(self) -> None:
        stop = self._stops.current
        if stop is None or not self._stops.in_force:
            # It was cleared, which others learn only from the database.
            self._asked.clear()
            self._exchange.wake("stops")
            return
        counts = self._stops.local_counts()
        named = {name: _fitting(counts[name]) for name in _NAMED_ONE_BY_ONE}
        said = {**counts, **named}
        for name in _COUNTED_BEYOND:
            said[f"{name}_more"] += len(counts[name]) - len(named[name])
        for id in {stop.id, *self._asked.values()}:
            self._exchange.send(STOP, StopSeen(self._exchange.gateway, id, **said))

    def _others(self) -> list[str]:
        """Return the other gateways that must answer: the living ones, and those that are heard.

        One whose lease has just expired is included: its robots may drive, and have no owner until another
        gateway has claimed them. Without it all would seem stopped for that moment. So is one heard without a
        lease: it may be cut off from the database, and still have robots.
        """
        entered = *self._membership.others(), *self._membership.just_lost()
        return sorted({*entered, *self._exchange.heard(), *self._exchange.heard_without_lease()})

    # --- incoming messages ---

    def _called(self, call: StopCall) -> None:
        self._stops.stop_elsewhere(StopRow(call.id, call.at, call.by, call.reason))
        self._asked[call.gw] = call.id
        self._answer()

    def _answered(self, seen: StopSeen) -> None:
        stop = self._stops.current
        if stop is not None and seen.id == stop.id:
            is_new = self._seen.get(seen.gw) != seen
            self._seen[seen.gw] = seen
            if is_new:
                self._stops.announce()

    def _woken(self, wake: Wake) -> None:
        if wake.what == "stops":
            self._look_now.set()


def _fitting(names: Sequence[str]) -> list[str]:
    """Return the first of ``names``, as many as fit into a message to another gateway."""
    found, left = [], LONGEST_NAMES
    for name in names[:MOST_NAMES]:
        left -= len(name.encode()) + 2
        if left < 0:
            break
        found.append(name)
    return found


# --- Aborts that were sent and could not be stored: noted at every gateway, for the one that gets the robot

MOST_NOTED = 10_000
"""Aborts of other gateways noted here; of further ones only those who sent them know."""
MOST_SETTLED = 10_000
"""ids of Aborts remembered as stored or void, the newest."""
TICK_S = 1.0
"""seconds between attempts to send what the bus did not take."""
AGAIN_S = 60.0
"""seconds after which all is sent again: a message may have been lost."""
ASKED_S = 5.0
"""minimum seconds between that and a request for it: gateways of a fleet start together."""
AT_ONCE = 32
"""messages at once: a bus drops the oldest of more than 256."""


class AbortKeeper(Protocol):
    """The commands of this gateway, and the notes on its computer."""

    def keep(self, aborts: Sequence[NotedAbort]) -> None:
        """Note Aborts of other gateways, and store those of robots of this one."""

    def discard(self, ids: Collection[str]) -> None:
        """Keep these Aborts no longer: they are stored, or void."""


class AbortRelay:
    """The Aborts that any gateway of the fleet could not store, until one has stored them or found them void.

    Which are due is found out by the gateway that has the robot, and said to all. Lost messages come again.
    """

    def __init__(self, exchange: Exchange, membership: Membership, keeper: AbortKeeper) -> None:
        self._exchange = exchange
        self._membership = membership
        self._keeper = keeper
        self._noted: dict[str, NotedAbort] = {}
        self._settled: dict[str, float] = {}
        """the times when Aborts were stored, or found void, the oldest first."""
        self._unsent: dict[str, None] = {}
        self._unsaid: dict[str, None] = {}
        """settled ones that were not sent to others yet."""
        self._is_full = False
        self._sent_all_at = membership.database_time()
        exchange.subscribe(AbortsNoted, self._hear)
        exchange.subscribe(AbortsSettled, self._forget)
        exchange.subscribe(Wake, self._woken)

    @property
    def noted(self) -> list[NotedAbort]:
        """The Aborts that are not stored, as far as is known."""
        return list(self._noted.values())

    def knows(self, id: str) -> bool:
        """Return whether an Abort is noted."""
        return id in self._noted

    def left_for(self, robots: Iterable[str]) -> list[NotedAbort]:
        """Return the noted Aborts of ``robots``."""
        of = set(robots) if self._noted else set()
        return [abort for abort in self._noted.values() if abort.robot in of]

    def note_aborts(self, aborts: Iterable[NotedAbort]) -> None:
        """Note Aborts here, and at the other gateways."""
        for abort in aborts:
            if abort.command not in self._noted:
                reason = None if abort.reason is None else one_line(abort.reason, LONGEST_REASON)
                self._noted[abort.command] = replace(abort, by=abort.by[:LONGEST_OPERATOR], reason=reason)
                self._unsent[abort.command] = None
        self.send_changes()

    def settle(self, ids: Iterable[str]) -> None:
        """Forget Aborts, and have the other gateways forget them: they are stored, or void."""
        now = self._membership.database_time()
        for abort in [abort for id in ids if (abort := self._drop(id)) is not None]:
            # The clock of who noted it may be ahead.
            self._remember(abort.command, max(now, abort.at))
            self._unsaid[abort.command] = None
        if self._unsaid:
            self.send_changes()

    async def run(self) -> None:
        """Send what the bus did not take, and drop what is too old, until cancelled."""
        while True:
            await asyncio.sleep(until_tick(TICK_S))
            now = self._membership.database_time()
            old = [abort for abort in self._noted.values() if now - abort.at > ABORT_VALID_S]
            for abort in old:
                log.warning("Abort %s of robot %r is dropped: it is too old", abort.command, abort.robot)
                self._drop(abort.command)
            if old:
                self._keeper.discard([abort.command for abort in old])
            self._is_full &= len(self._noted) >= MOST_NOTED
            if now - self._sent_all_at >= AGAIN_S:
                self._send_all(now)
            self.send_changes()

    def send_changes(self) -> None:
        """Send what other gateways do not know yet, some of it at a time."""
        unsent = (abort for id in list(self._unsent) if (abort := self._noted.get(id)) is not None)
        for some in itertools.islice(batches(unsent, LARGEST_NOTIFICATION, MOST_ABORTS), AT_ONCE):
            if not self._exchange.send(EVERYBODY, AbortsNoted(self._exchange.gateway, some)):
                return
            for abort in some:
                self._unsent.pop(abort.command, None)
        unsaid = list(self._unsaid)
        for ids in itertools.islice(batches(unsaid, LARGEST_NOTIFICATION // 2, MOST_ABORTS), AT_ONCE):
            settled = {id: self._settled[id] for id in ids}
            if not self._exchange.send(EVERYBODY, AbortsSettled(self._exchange.gateway, settled)):
                return
            for id in ids:
                self._unsaid.pop(id, None)

    def _send_all(self, now: float) -> None:
        self._sent_all_at = now
        self._unsent = dict.fromkeys(self._noted)

    def _drop(self, id: str) -> NotedAbort | None:
        self._unsent.pop(id, None)
        return self._noted.pop(id, None)

    def _remember(self, id: str, at: float) -> None:
        self._settled.pop(id, None)
        self._settled[id] = at
        if len(self._settled) > MOST_SETTLED:
            oldest = next(iter(self._settled))
            del self._settled[oldest]
            self._unsaid.pop(oldest, None)

    def _hear(self, message: AbortsNoted) -> None:
        new = []
        for abort in message.aborts:
            if abort.at <= self._settled.get(abort.command, -1.0):
                self._unsaid[abort.command] = None
            elif abort.command not in self._noted:
                if len(self._noted) >= MOST_NOTED:
                    self._warn_of_too_many(message.gw)
                    continue
                self._noted[abort.command] = abort
                new.append(abort)
        if new:
            robots = listed_names(sorted({abort.robot for abort in new}))
            log.warning("gateway %s could not store Aborts of %s; they are noted here", message.gw, robots)
            self._keeper.keep(new)
        if self._unsaid:
            self.send_changes()

    def _warn_of_too_many(self, gateway: str) -> None:
        if not self._is_full:
            log.warning(
                "more than %d Aborts are not stored: further ones of gateway %s are not noted here, and "
                "stored by that one alone; see why the database does not take them",
                MOST_NOTED,
                gateway,
            )
        self._is_full = True

    def _forget(self, message: AbortsSettled) -> None:
        ids = [id for id, at in message.commands.items() if (known := self._noted.get(id)) and known.at <= at]
        for id in ids:
            self._drop(id)
            self._remember(id, message.commands[id])
        if ids:
            self._keeper.discard(ids)

    def _woken(self, wake: Wake) -> None:
        # A gateway that comes, or whose bus is back, asks so for all that is known.
        now = self._membership.database_time()
        if wake.what == "positions" and now - self._sent_all_at >= ASKED_S:
            self._send_all(now)
