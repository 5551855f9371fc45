"""Emergency stops across gateways: over the bus with an answer of each, and by a look each second."""

from __future__ import annotations

import asyncio
import logging
import uuid
from collections.abc import Sequence
from typing import Any, Protocol

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import StoreError
from ...core.messages.safety import StoppedGateways
from ..monitoring import wait_at_most
from ..storage.database import Database
from ..storage.repositories import emergency_stops
from ..storage.repositories.emergency_stops import StopRow
from .bus import STOP
from .membership import Membership
from .messages import Exchange, StopCall, StopSeen, Wake

log = logging.getLogger(__name__)

LOOK_S = 1.0
"""seconds between two looks into the database, and between two calls over the bus to who has not answered."""
TELL_S = 0.1
"""seconds for which changes of what robots answered wait for one another before others are told."""
CUT_OFF_S = 5.0
"""seconds without the database and without any other gateway after which a gateway counts as cut off."""
COUNTS_HOLD_S = 3.0
"""seconds of silence after which what a gateway said of its robots is not counted any more; it beats each."""
MOST_NAMES = 50
LONGEST_NAMES = 1200
"""bytes of the names of each kind in a message to other gateways: a notification of PostgreSQL has few."""
_NAMED_ONE_BY_ONE = ("waiting", "refused", "moving", "unheard")
_COUNTED_BEYOND = ("moving", "unheard")
"""kinds of robots of which an EmergencyReport says how many it does not name."""


class LocalStops(Protocol):
    """The emergency stops of this gateway."""

    @property
    def in_force(self) -> bool:
        """Whether robots must not be sent anywhere."""

    @property
    def current(self) -> StopRow | None:
        """The stop in force, or the one that was cleared last."""

    def local_counts(self) -> dict[str, Any]:
        """Return what the robots of this gateway said."""

    def announce(self) -> None:
        """Tell every operator how things stand."""

    def stop_elsewhere(self, stop: StopRow) -> None:
        """Put a stop in force that was made at another gateway."""

    @property
    def known_ids(self) -> Sequence[str]:
        """The ids of the stops that are in force here, and of the one that was last."""

    def learn(self, stop: StopRow) -> None:
        """Take in how a stop is stored."""


class EmergencyStopRelay:
    """Tells other gateways of stops made here, and learns of those made there.

    What an operator's stop does for its own robots waits for nothing of this.
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
        """what each other gateway said of the stop in force."""
        self._asked: dict[str, str] = {}
        """the stop that each other gateway called for last: where several are in force it may be another one
        than that of the report here."""
        self._named: list[str] = []
        """the other gateways that were to answer when operators were told last of those."""
        self._changed = asyncio.Event()
        self._look_now = asyncio.Event()
        self._looked_at = clock.steady()
        self._has_company = False
        """whether there were other gateways when the database was reached last."""
        self._stops_when_cut_off = stops_when_cut_off
        exchange.subscribe(StopCall, self._called)
        exchange.subscribe(StopSeen, self._answered)
        exchange.subscribe(Wake, self._woken)

    # --- as a fleet.emergency_stop.StopRelay ----------------------------------------------------------------

    def announce(self, stop: StopRow) -> None:
        """Tell all others of a stop."""
        self._seen.clear()
        self._exchange.send(
            STOP, StopCall(self._exchange.gateway, stop.id, stop.at, stop.by[:200], stop.reason)
        )
        self._changed.set()

    def note_change(self) -> None:
        """Note that the robots of this gateway have answered."""
        self._changed.set()

    def add_counts(self, counts: dict[str, Any], stop: str) -> dict[str, Any]:
        """Return ``counts`` of a stop with those of the other gateways."""
        others = self._others()
        # The robots of one that is gone are counted by whoever has them now.
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

    # --- what goes on -------------------------------------------------------------------------------------

    async def run(self) -> None:
        """Look, and tell others what the robots answered, until cancelled."""
        tasks = [asyncio.create_task(work()) for work in (self._look_again, self._tell, self._call_again)]
        try:
            await asyncio.gather(*tasks)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def read_stored(self) -> None:
        """Learn from the database of stops, and of their end; raises StoreError."""
        current, after = self._stops.current, 0.0
        if current is not None:
            after = current.at if current.cleared_at is None else current.cleared_at
        found = await self._lease.read(emergency_stops.changed, self._stops.known_ids, after)
        self._looked_at = self._clock.steady()
        self._has_company = bool(self._membership.others())
        # Ends last: another stop in force must hold by then.
        for stop in sorted(found, key=lambda stop: stop.cleared_at or 0.0):
            self._stops.learn(stop)

    def is_cut_off(self) -> bool:
        """Tell whether this gateway reaches neither the database nor any other gateway, and had others."""
        silent = self._clock.steady() - self._looked_at
        return self._has_company and silent > CUT_OFF_S and not self._exchange.heard()

    async def _look_again(self) -> None:
        while True:
            self._look_now.clear()
            try:
                await self.read_stored()
            except StoreError as error:
                log.debug("emergency stops cannot be looked up: %s", error)
                await self._stop_if_cut_off()
            await wait_at_most(self._look_now, LOOK_S)

    async def _stop_if_cut_off(self) -> None:
        if not (self._stops_when_cut_off and self.is_cut_off()) or self._stops.in_force:
            return
        log.error(
            "neither the database nor any other gateway has been reached for %g s: all robots stop", CUT_OFF_S
        )
        reason = "cut off from the database and from every other gateway"
        by, at = f"gateway {self._exchange.gateway}", self._membership.database_time()
        self._stops.stop_elsewhere(StopRow(f"cut-off-{uuid.uuid4()}", at, by, reason))

    async def _tell(self) -> None:
        while True:
            await self._changed.wait()
            await asyncio.sleep(TELL_S)
            self._changed.clear()
            self._answer()

    async def _call_again(self) -> None:
        while True:
            await asyncio.sleep(LOOK_S)
            stop = self._stops.current
            if stop is None or not self._stops.in_force:
                continue
            others = self._others()
            silent = self._seen.keys() - self._exchange.heard(COUNTS_HOLD_S)
            for name in silent:
                # What its robots did when it was heard last is not what they do now: it is called again.
                del self._seen[name]
            if silent or others != self._named:
                # Nobody is to watch for one that is gone.
                self._named = others
                self._stops.announce()
            if any(name not in self._seen or self._seen[name].id != stop.id for name in others):
                self._exchange.send(
                    STOP, StopCall(self._exchange.gateway, stop.id, stop.at, stop.by[:200], stop.reason)
                )

    def _answer(self) -> None:
        stop = self._stops.current
        if stop is None or not self._stops.in_force:
            # It was cleared, which only the database can tell the others.
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
        """Return the other gateways that are to answer: those that live, and those that are heard.

        One whose lease has just run out is among them: its robots may drive, and count as nobody's until
        another gateway has claimed them. Without it all would seem stopped for that moment. So is one that is
        heard without a lease: it may be cut off from the database, and have robots still.
        """
        entered = *self._membership.others(), *self._membership.just_lost()
        return sorted({*entered, *self._exchange.heard(), *self._exchange.heard_without_lease()})

    # --- what comes in ------------------------------------------------------------------------------------

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
