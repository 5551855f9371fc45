"""Emergency stops across gateways: over the bus, answered by each, and by polling each second."""

from __future__ import annotations

import asyncio
import logging
import uuid
from collections.abc import Sequence
from typing import Any, Protocol

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import StoreError
from ...core.messages.safety import StoppedGateways
from ..monitoring import until_tick, wait_at_most
from ..storage.database import Database
from ..storage.repositories import emergency_stops
from ..storage.repositories.emergency_stops import StopRow
from .bus import STOP
from .membership import Membership
from .messages import Exchange, StopCall, StopSeen, Wake

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
