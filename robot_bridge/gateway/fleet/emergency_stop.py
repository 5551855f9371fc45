"""Emergency stop: every robot stopped before anything else is done, and what each robot answers."""

from __future__ import annotations

import asyncio
import logging
import math
import time
import uuid
from collections.abc import Callable, Iterable, Sequence
from concurrent import futures
from typing import Any, Protocol

from sqlalchemy import Connection

from ...core.clock import Clock
from ...core.errors import RefusedError, StoreError, listed_names
from ...core.logs import log_and_continue
from ...core.messages.base import LONGEST_OPERATOR, one_line, to_json
from ...core.messages.commands import CommandReport
from ...core.messages.robots import Abort
from ...core.messages.safety import ClearEmergencyStop, EmergencyReport, EmergencyStop
from ..commands.active_command import CommandOrder
from ..commands.service import CommandService
from ..model.arrival import StopAnswers
from ..model.events import EventBus, Listeners, StopBegun, handles
from ..model.robots import Robots
from ..storage.database import Database
from ..storage.repositories import commands, emergency_stops
from ..storage.repositories.emergency_stops import StopRow
from .emergency_persistence import HELD_BACK, MOTIONS, StopJournal, StopWriter, orders_of

# --- The emergency stop: every robot is told to stop before anything else is done, and none is sent anywhere
# until a supervisor clears it.
#
# Safety comes before bookkeeping: a stop is in force the moment it is asked for, noted in a file of this
# computer (a few milliseconds) and on its way over every open connection; it is stored as soon as the
# database
# can be written. What is not stored yet says so. Robots on SQL are reached by nothing but the database, so
# they
# are told when it can be written again.

__all__ = ["HELD_BACK", "EmergencyStops"]

log = logging.getLogger(__name__)

STORED_WITHIN = 1.0
"""seconds for which an operator waits to hear whether the stop is stored; it is in force before that."""
NOTED_WITHIN = 0.02
"""seconds for which this gateway stands still until a stop is noted, before operators and robots hear of it.
A disk that hangs must keep neither waiting; a turn of the loop may take longer where thousands of robots have
theirs."""
MOST_FIRST = 20
"""operators who are notified of a stop before the robots: that takes a millisecond."""
ANSWERS_TOGETHER = 0.05
"""seconds for which answers of robots wait for one another before operators are told: to count thousands at
each answer of one of them would take all the time in which the robots are to be heard."""
REPEATED_S = 1.0
"""seconds after which a stop in force is reported to operators again: who hears nothing knows nothing."""
AHEAD_S = 1.0
"""seconds by which a time may lie in the future: what is known of the database's clock is not exact."""
DOUBTED_S = 60.0
"""seconds after the end of a stop in which a robot is aborted where nobody knows how old its motion is."""
NAME_PREFIX = "emergency-"
"""Begins the id of the call that tells a robot of a stop directly: a text, unlike the ids of SA."""


class StopRelay(Protocol):
    """Tells other gateways of stops, and knows what came of that there. Nothing of it waits."""

    def announce(self, stop: StopRow) -> None:
        """Tell all others of a stop."""

    def note_change(self) -> None:
        """Note that something has changed that :meth:`EmergencyStops.local_counts` tells."""

    def add_counts(self, counts: dict[str, Any], stop: str) -> dict[str, Any]:
        """Return ``counts`` of a stop with those of the other gateways, as an EmergencyReport has them."""


class EmergencyStops:
    """The stop in force, if one is, and what the robots say to it.

    Every operator hears of it through ``listeners``. The one in force, and what is not stored yet, are noted
    in ``journal``, where there is one.
    """

    def __init__(
        self,
        commands: CommandService,
        database: Database,
        clock: Clock,
        robots: Robots,
        listeners: Listeners,
        events: EventBus,
        journal: StopJournal | None = None,
    ) -> None:
        self._commands = commands
        self._database = database
        self._clock = clock
        self._robots = robots
        self._listeners = listeners
        self._events = events
        self._journal = journal
        self._links: list[Callable[[str], None]] = []
        self._relays: list[StopRelay] = []
        self._stop: StopRow | None = None
        self._in_force: dict[str, StopRow] = {}
        """the stops that are in force, by id: operators of several gateways may make some at a time."""
        self._unstored: list[StopRow] = []
        self._unlisted: list[StopRow] = []
        """what the database refuses as data: noted on the disk alone, and stored no more."""
        self._writer = StopWriter(commands, database)
        self._seen: set[str] = set()
        self._tally = StopAnswers()
        self._writing = asyncio.Lock()
        self._storing: asyncio.Future[None] | None = None
        self._answers_due: asyncio.TimerHandle | None = None
        self._announced_at = -math.inf
        self._observed = -1
        """the revision of the robots up to which it was looked whether they stand."""

    def reach(self, link: Callable[[str], None]) -> None:
        """Call ``link`` with the id of the call at every stop: it tells every robot at its other end."""
        self._links.append(link)

    def relay_by(self, relay: StopRelay) -> None:
        """Have ``relay`` tell other gateways of each stop that is made here."""
        self._relays.append(relay)

    @property
    def known_ids(self) -> list[str]:
        """The ids of the stops that are in force, and of the one that was last."""
        return [*self._in_force, *([] if self._stop is None else [self._stop.id])]

    @property
    def in_force(self) -> bool:
        """Whether robots must not be sent anywhere."""
        return self._stop is not None and self._stop.cleared_at is None

    @property
    def call_id(self) -> str | None:
        """The id of the call by which a robot that connects now is told, None when no stop is in force."""
        return f"{NAME_PREFIX}{self._stop.id}" if self._stop is not None and self.in_force else None

    def report(self) -> EmergencyReport:
        """Return how things stand."""
        stop = self._stop
        if stop is None:
            return EmergencyReport()
        counts = self.local_counts()
        for relay in self._relays:
            counts = relay.add_counts(counts, stop.id)
        # Robots of a gateway that has not answered are counted all the same: they may drive.
        counts["robots"] = max(counts["robots"], self._robots.count_commanded())
        return EmergencyReport(
            in_force=self.in_force,
            stop=stop.id,
            at=stop.at,
            by=stop.by,
            reason=stop.reason,
            stored=not self._unstored,
            cleared_at=stop.cleared_at,
            cleared_by=stop.cleared_by,
            clear_reason=stop.clear_reason,
            **counts,
        )

    @property
    def current(self) -> StopRow | None:
        """The stop in force, or the one that was cleared last."""
        return self._stop

    def local_counts(self) -> dict[str, Any]:
        """Return what the robots of this gateway said, as an EmergencyReport has it."""
        return self._tally.counts()

    def watch(self) -> None:
        """Look whether robots stand that were stopped: to be called several times a second.

        Only those are looked at that have changed since, and none while no stop is in force.
        """
        if not self.in_force:
            return
        since, self._observed = self._observed, self._robots.revision
        if self._tally.observe(self._robots.own_places(since), self._clock.steady()):
            if disobeying := self._tally.disobeying():
                log.error("%s: moves although it was seen to stand after a stop", listed_names(disobeying))
            self._announce_answers()
        elif self._clock.steady() - self._announced_at >= REPEATED_S:
            self.announce()

    async def restore(self) -> None:
        """Take up the stop that an earlier gateway left in force, stored or not, and what robots said to it.

        Raises StoreError when it cannot be known whether there is one.
        """
        self._stop, in_force, self._seen, aborts = await self._database.run(_load)
        self._in_force = {stop.id: stop for stop in reversed(in_force)}
        self._count_again()
        for report in aborts:
            self._tally.note_step(report)
        if self._stop is not None and self.in_force:
            # That gateway may have died before all of them were stored.
            reached = {report.robot for report in aborts}
            self._writer.owe(
                self._stop, [robot for robot in self._robots.commanded() if robot not in reached]
            )
        else:
            self._abort_overdue(self._stop, self._robots.commanded())
        noted = await asyncio.to_thread(self._journal.read) if self._journal else []
        for stop in noted:
            if stop.id not in self._seen:
                log.warning("emergency stop by %s%s, from before the restart", stop.by, _because(stop.reason))
                self._put_in_force(stop)
        await self._store_and_log()
        if noted or self.in_force:
            self._note()

    def check(self, message: object) -> None:
        """Raise RefusedError for a message that would make a robot drive while a stop is in force."""
        stop = self._stop
        if stop is not None and self.in_force and isinstance(message, MOTIONS):
            raise RefusedError(
                f"an emergency stop is in force since {_clock(stop.at)}, by {stop.by}"
                f"{_because(stop.reason)}: no robot is sent anywhere until a supervisor clears it"
            )

    @handles(EmergencyStop)
    async def stop(self, request: EmergencyStop, operator: str) -> EmergencyReport:
        """Stop every robot; asked again under the same id it is the same stop.

        Returns when the stop is stored, or after a second if the database does not answer or cannot be
        written: it is in force all the same.
        """
        self.begin(request, operator)
        storing = asyncio.ensure_future(self._store_and_log())
        await asyncio.wait({storing}, timeout=STORED_WITHIN)
        return self.report()

    def begin(self, request: EmergencyStop, operator: str) -> None:
        """Put a stop in force and tell everybody, without a turn of the loop; :meth:`stop` stores it."""
        if request.command not in self._seen:
            self._begin(StopRow(request.command, self._clock.time(), _name(operator), request.line))

    def stop_elsewhere(self, stop: StopRow) -> None:
        """Put a stop in force that was made at another gateway; the robots here are being told then.

        It is stored from here as well: the other gateway may not come to that.
        """
        # It may come over several ways at the same time.
        if stop.id not in self._seen:
            self._begin(stop, is_own=False)
            self._storing = asyncio.ensure_future(self._store_and_log())

    def learn(self, stop: StopRow) -> None:
        """Take in how a stop is stored: put in force one that is new, end the one in force that was cleared.

        What is not stored yet stays in force, whatever others have cleared. Of one that was over before this
        gateway knew of it, the robots here are aborted as well.
        """
        if stop.cleared_at is None:
            self.stop_elsewhere(stop)
            return
        is_new = stop.id not in self._seen
        self._seen.add(stop.id)
        if is_new and not self.in_force:
            self._stop = stop
            self._abort_overdue(stop, self._robots.commanded())
            self.announce()
            return
        if any(one.id == stop.id for one in self._unstored):
            return
        self._in_force.pop(stop.id, None)
        mine = self._stop
        if mine is None or mine.id != stop.id or not self.in_force:
            return
        log.warning(
            "emergency stop of %s cleared by %s%s", stop.by, stop.cleared_by, _because(stop.clear_reason)
        )
        self._stop = next(reversed(self._in_force.values()), stop)
        if not self.in_force:
            self._writer.end()
        self._note()
        self.announce()

    def take_over(self, robots: Sequence[str], newest: StopRow | None) -> None:
        """Count robots that another gateway had; those that were sent no Abort yet are owed one.

        That one may have died before it had stored theirs, and the stop may be over: ``newest`` is the stop
        that was stored last, from after these robots were read.
        """
        stop = self._stop
        if stop is None or not self.in_force:
            # One may have been cleared since that was read.
            over = [one for one in (stop, newest) if one is not None and one.cleared_at is not None]
            self._abort_overdue(max(over, key=lambda one: one.cleared_at or 0.0, default=None), robots)
            return
        for robot in robots:
            self._tally.note_sent(robot)
            if not self._commands.awaits_stop(robot):
                self._writer.owe(stop, [robot])
        self.announce()

    @handles(ClearEmergencyStop)
    async def clear(self, request: ClearEmergencyStop, supervisor: str) -> EmergencyReport:
        """Let robots be sent again. Raises RefusedError, and StoreError when that cannot be stored."""
        # Who asks cannot mean a stop that comes while this waits.
        seen, known = self._stop, frozenset(self._seen)
        async with self._writing:
            stop = self._stop
            if stop is None or not self.in_force:
                if stop is not None and request.stop == stop.id:
                    return self.report()
                raise RefusedError("no emergency stop is in force; there is nothing to clear")
            if request.stop not in (None, stop.id) or stop is not seen:
                raise RefusedError(
                    f"{stop.by} made another emergency stop at {_clock(stop.at)}{_because(stop.reason)}; "
                    "look at that one first, then clear it"
                )
            await self._store()
            at, supervisor, reason = self._clock.time(), _name(supervisor), request.reason or None
            unknown = await self._database.run(emergency_stops.clear, at, supervisor, reason, known)
            if unknown is not None:
                raise RefusedError(
                    f"{unknown.by} made another emergency stop at {_clock(unknown.at)}"
                    f"{_because(unknown.reason)}, at another gateway; look at that one first, then clear it"
                )
            for id in known:
                self._in_force.pop(id, None)
            if self._stop is stop:
                self._stop = stop._replace(cleared_at=at, cleared_by=supervisor, clear_reason=reason)
                self._writer.end()
                self._unlisted.clear()
                self._note()
                log.warning("emergency stop of %s cleared by %s%s", stop.by, supervisor, _because(reason))
        self.announce()
        return self.report()

    async def store(self) -> None:
        """Store the stops and Aborts that are not stored yet; raises StoreError when the database is away."""
        if self._unstored or self._writer.is_owing:
            async with self._writing:
                await self._store()

    async def ready(self, robot: str) -> None:
        """Tell a robot that has just said Ready to stop, unless it is being told already."""
        stop = self._stop
        if stop is None or not self.in_force:
            return
        self._tally.note_sent(robot)
        if not self._commands.awaits_stop(robot):
            order = CommandOrder(str(uuid.uuid4()), robot, Abort(emergency=True), stop.by, stop.reason)
            await self._commands.issue([order])
        self._announce_answers()

    def answered(self, robot: str, call_id: str, refused: bool) -> None:
        """Note what a robot answered to the call that told it directly."""
        if call_id == self.call_id and self._tally.answer(robot, refused=refused):
            self._announce_answers()

    def forget(self, robot: str) -> None:
        """Wait for a robot no more: it was removed."""
        self._writer.forget(robot)
        if self._tally.forget(robot) and self.in_force:
            self._announce_answers()

    def note_step(self, report: CommandReport) -> None:
        """Note what became of the Abort that a robot was sent."""
        if self.in_force and self._tally.note_step(report):
            self._announce_answers()

    def _put_in_force(self, stop: StopRow) -> None:
        self._seen.add(stop.id)
        self._stop = self._in_force[stop.id] = stop
        self._unstored.append(stop)
        with log_and_continue(log, "counting who is told of an emergency stop"):
            self._count_again()

    def _count_again(self) -> None:
        self._observed = -1
        self._tally.begin(self._robots.commanded())

    def _abort_overdue(self, stop: StopRow | None, robots: Iterable[str]) -> None:
        """Have robots aborted that drive since before a stop that is over: its Abort was stored for none.

        A stop that was cleared in the future is of a wrong clock: what was before it cannot be known.
        """
        now = self._clock.time()
        if stop is None or stop.cleared_at is None or stop.cleared_at > now + AHEAD_S:
            return
        # Of a motion from a time to come, by a wrong clock of its gateway, nobody knows how old it is.
        doubted_from = now + AHEAD_S if now - stop.cleared_at < DOUBTED_S else math.inf
        overdue = [r for r in robots if self._commands.drives_since(r, stop.cleared_at, doubted_from)]
        if overdue:
            log.warning(
                "%s: sent the Abort of the emergency stop by %s, which was over before that was stored",
                listed_names(overdue),
                stop.by,
            )
            self._commands.keep_aborts(orders_of(stop, overdue))

    def _begin(self, stop: StopRow, *, is_own: bool = True) -> None:
        self._events.publish(StopBegun(stop.id))
        self._put_in_force(stop)
        noting = None
        # Whatever goes wrong in one of these, what comes after it is done.
        with log_and_continue(log, "noting an emergency stop"):
            # The disk works while other gateways are told.
            noting = self._note()
        for relay in self._relays if is_own else ():
            with log_and_continue(log, "telling other gateways of an emergency stop"):
                relay.announce(stop)
        with log_and_continue(log, "waiting for the note of an emergency stop"):
            # One from elsewhere is noted and stored there as well.
            if noting is not None and is_own:
                futures.wait([noting], NOTED_WITHIN)
        operators_first = False
        with log_and_continue(log, "telling operators of an emergency stop"):
            # Behind the note: nobody sees a stop in force that dies with this gateway.
            if operators_first := len(self._listeners) <= MOST_FIRST:
                self.announce()
        for link in self._links:
            with log_and_continue(log, "sending an emergency stop over open connections"):
                link(f"{NAME_PREFIX}{stop.id}")
        log.warning("emergency stop by %s%s", stop.by, _because(stop.reason))
        with log_and_continue(log, "looking which robots move"):
            self.watch()
        if not operators_first:
            self.announce()

    def _note(self) -> futures.Future[None] | None:
        """Have the stop in force noted on the disk, and those that are not stored.

        The one in force is noted for as long as it is: the database may be set back to before it.
        """
        if self._journal is None:
            return None
        current = [self._stop] if self._stop is not None and self.in_force else []
        noted = {stop.id: stop for stop in (*self._unlisted, *self._unstored, *current)}
        return self._journal.write([*noted.values()])

    async def _store_and_log(self) -> None:
        try:
            await self.store()
        except StoreError as error:
            log.error("the emergency stop is in force and not stored yet: %s", error)
        except Exception:
            log.exception("the emergency stop is in force and not stored yet")

    async def _store(self) -> None:
        while self._unstored:
            stop = self._unstored[0]
            if not await self._writer.write(stop, self._robots.commanded()):
                self._unlisted.append(stop)
            self._unstored.remove(stop)
            with log_and_continue(log, "noting that an emergency stop is stored"):
                self._note()
            self.announce()
        await self._writer.write_owed()

    def _announce_answers(self) -> None:
        """Announce what robots answered, together with what others answer meanwhile."""
        if self._answers_due is None:
            loop = asyncio.get_running_loop()
            self._answers_due = loop.call_later(ANSWERS_TOGETHER, self.announce)

    def announce(self) -> None:
        """Tell every operator, and other gateways, how things stand."""
        self._announced_at = self._clock.steady()
        if self._answers_due is not None:
            self._answers_due.cancel()
            self._answers_due = None
        for relay in self._relays:
            with log_and_continue(log, "telling other gateways of an emergency stop"):
                relay.note_change()
        with log_and_continue(log, "announcing an emergency stop"):
            self._listeners.announce("emergency", "emergency", to_json(self.report()))


def _load(
    connection: Connection,
) -> tuple[StopRow | None, list[StopRow], set[str], list[CommandReport]]:
    stop = emergency_stops.newest(connection)
    aborts = [] if stop is None else commands.of_kind_since(connection, Abort.__name__, stop.at)
    return stop, emergency_stops.in_force(connection), emergency_stops.ids(connection), aborts


def _name(operator: str) -> str:
    """Return the name of an operator as it is stored: it must be refused by no database."""
    return one_line(operator, LONGEST_OPERATOR).strip() or "an operator"


def _clock(at: float) -> str:
    return time.strftime("%H:%M:%S UTC", time.gmtime(at))


def _because(reason: str | None) -> str:
    return f" ({reason})" if reason else ""
