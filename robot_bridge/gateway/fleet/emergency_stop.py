"""Emergency stop: every robot is stopped before anything else; the answers of robots are counted."""

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
from ...core.messages.robots import MOTIONS, Abort
from ...core.messages.safety import ClearEmergencyStop, EmergencyReport, EmergencyStop
from ..commands.active_command import CommandOrder
from ..commands.service import CommandService
from ..model.arrival import StopAnswers
from ..model.events import EventBus, Listeners, StopBegun, handles
from ..model.robots import Robots
from ..storage.database import Database
from ..storage.repositories import commands, emergency_stops
from ..storage.repositories.emergency_stops import StopRow
from .emergency_persistence import StopJournal, StopWriter, orders_of

# --- Emergency stop: every robot is sent the stop before anything else is done, and no motion until a
# supervisor clears it.
#
# Safety comes before bookkeeping: a stop is in force the moment it is requested, is written to a journal file
# on this computer (a few milliseconds) and sent over every open connection; it is stored as soon as the
# database can be written. Reports show that a stop is not stored yet. Robots on SQL are reached only by the
# database, so the stop is sent to them when it can be written again.

log = logging.getLogger(__name__)

STORED_WITHIN = 1.0
"""seconds for which an operator waits for the stop to be stored; it is in force before that."""
NOTED_WITHIN = 0.02
"""seconds for which this gateway blocks until a stop is in the journal, before it is sent to operators and
robots. A disk that hangs must delay neither; a turn of the event loop may take longer with thousands of
robots."""
MOST_FIRST = 20
"""largest number of operators to be notified of a stop before the robots: that takes a millisecond."""
ANSWERS_TOGETHER = 0.05
"""seconds for which answers of robots are collected before operators are notified: to count thousands at
each answer of one of them would leave no time to receive from the robots."""
REPEATED_S = 1.0
"""seconds after which a stop in force is reported to operators again: silence shows a broken link."""
AHEAD_S = 1.0
"""seconds by which a time may lie in the future: the offset of the database's clock is not exact."""
DOUBTED_S = 60.0
"""seconds after the end of a stop within which a robot with a motion of unknown age is aborted."""
NAME_PREFIX = "emergency-"
"""Prefix of the id of the call that sends a stop directly to a robot: a text, unlike the ids of SA."""


class StopRelay(Protocol):
    """Relays stops to other gateways, and keeps their counts. No method waits."""

    def announce(self, stop: StopRow) -> None:
        """Send a stop to all other gateways."""

    def note_change(self) -> None:
        """Record that :meth:`EmergencyStops.local_counts` has changed."""

    def add_counts(self, counts: dict[str, Any], stop: str) -> dict[str, Any]:
        """Return ``counts`` of a stop with those of the other gateways added, as in an EmergencyReport."""


class EmergencyStops:
    """The stop in force, if any, and the answers of the robots to it.

    Every operator is notified through ``listeners``. The stop in force, and those not stored yet, are written
    to ``journal``, if given.
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
        """the stops in force, by id: operators of several gateways may make some at the same time."""
        self._unstored: list[StopRow] = []
        self._unlisted: list[StopRow] = []
        """stops that the database refuses as data: they are in the journal only, and not stored again."""
        self._writer = StopWriter(commands, database)
        self._seen: set[str] = set()
        self._tally = StopAnswers()
        self._writing = asyncio.Lock()
        self._storing: asyncio.Future[None] | None = None
        self._answers_due: asyncio.TimerHandle | None = None
        self._announced_at = -math.inf
        self._observed = -1
        """revision of the robots up to which their standstill was checked."""

    def reach(self, link: Callable[[str], None]) -> None:
        """Call ``link`` with the id of the call at every stop; it sends the stop to each of its robots."""
        self._links.append(link)

    def relay_by(self, relay: StopRelay) -> None:
        """Send each stop that is made here to other gateways by ``relay``."""
        self._relays.append(relay)

    @property
    def known_ids(self) -> list[str]:
        """The ids of the stops in force, and of the last one."""
        return [*self._in_force, *([] if self._stop is None else [self._stop.id])]

    @property
    def in_force(self) -> bool:
        """Whether a stop is in force, so that no motion may be sent."""
        return self._stop is not None and self._stop.cleared_at is None

    @property
    def call_id(self) -> str | None:
        """The id of the call that sends the stop to a connecting robot, None without a stop in force."""
        return f"{NAME_PREFIX}{self._stop.id}" if self._stop is not None and self.in_force else None

    def report(self) -> EmergencyReport:
        """Return the state of the emergency stop, with the counts of robots."""
        stop = self._stop
        if stop is None:
            return EmergencyReport()
        counts = self.local_counts()
        for relay in self._relays:
            counts = relay.add_counts(counts, stop.id)
        # Robots of a gateway that has not answered are counted, too: they may be driving.
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
        """Return the counts of the answers of this gateway's robots, as in an EmergencyReport."""
        return self._tally.counts()

    def watch(self) -> None:
        """Check whether stopped robots stand; must be called several times a second.

        Only robots that changed since the last call are checked, and none while no stop is in force.
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
        """Restore the stop that an earlier gateway left in force, stored or not, and the robots' answers.

        Raises StoreError when it cannot be read whether there is one.
        """
        self._stop, in_force, self._seen, aborts = await self._database.run(_load)
        self._in_force = {stop.id: stop for stop in reversed(in_force)}
        self._count_again()
        for report in aborts:
            self._tally.note_step(report)
        if self._stop is not None and self.in_force:
            # That gateway may have died before all Aborts were stored.
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
            self._write_journal()

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
        """Stop every robot; a request repeated under the same id is the same stop, until that is cleared.

        Returns when the stop is stored, or after a second if the database does not answer or cannot be
        written: it is in force all the same.
        """
        self.begin(request, operator)
        storing = asyncio.ensure_future(self._store_and_log())
        await asyncio.wait({storing}, timeout=STORED_WITHIN)
        return self.report()

    def begin(self, request: EmergencyStop, operator: str) -> None:
        """Put a stop in force and send it to all, within this turn of the loop; :meth:`stop` stores it.

        Under the id of a stop that was cleared it is another one, with an id derived from that: a button may
        send the same id each time.
        """
        id = request.command
        while id in self._seen and id not in self._in_force:
            id = str(uuid.uuid5(uuid.NAMESPACE_OID, id))
        if id not in self._seen:
            self._begin(StopRow(id, self._clock.time(), _name(operator), request.line))

    def stop_elsewhere(self, stop: StopRow) -> None:
        """Put a stop in force that was made at another gateway, and send it to the robots here.

        It is stored from here as well: the other gateway may die before it does so.
        """
        # It may be received by several ways at the same time.
        if stop.id not in self._seen:
            self._begin(stop, is_own=False)
            self._storing = asyncio.ensure_future(self._store_and_log())

    def learn(self, stop: StopRow) -> None:
        """Apply a stop as stored: put in force a new one, end the one in force that was cleared.

        A stop that is not stored yet stays in force, whatever others have cleared. For one that was over
        before this gateway knew of it, the robots here are aborted as well.
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
        self._write_journal()
        self.announce()

    def take_over(self, robots: Sequence[str], newest: StopRow | None) -> None:
        """Count robots that another gateway had; those that were sent no Abort yet are owed one.

        That gateway may have died before it stored their Aborts, and the stop may be over: ``newest`` is the
        stop that was stored last, read after these robots.
        """
        stop = self._stop
        if stop is None or not self.in_force:
            # One may have been cleared since ``newest`` was read.
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
        """Clear the stop. Raises RefusedError, and StoreError when this cannot be stored."""
        # The request cannot mean a stop that comes while this waits.
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
                self._write_journal()
                log.warning("emergency stop of %s cleared by %s%s", stop.by, supervisor, _because(reason))
        self.announce()
        return self.report()

    async def store(self) -> None:
        """Store the stops and Aborts not stored yet; raises StoreError when the database is unavailable."""
        if self._unstored or self._writer.is_owing:
            async with self._writing:
                await self._store()

    async def ready(self, robot: str) -> None:
        """Send an Abort to a robot that has just said Ready, unless one is on its way already."""
        stop = self._stop
        if stop is None or not self.in_force:
            return
        self._tally.note_sent(robot)
        if not self._commands.awaits_stop(robot):
            order = CommandOrder(str(uuid.uuid4()), robot, Abort(emergency=True), stop.by, stop.reason)
            await self._commands.issue([order])
        self._announce_answers()

    def answered(self, robot: str, call_id: str, refused: bool) -> None:
        """Record the answer of a robot to the direct call."""
        if call_id == self.call_id and self._tally.answer(robot, refused=refused):
            self._announce_answers()

    def forget(self, robot: str) -> None:
        """Stop waiting for a removed robot."""
        self._writer.forget(robot)
        if self._tally.forget(robot) and self.in_force:
            self._announce_answers()

    def note_step(self, report: CommandReport) -> None:
        """Record a step of the Abort that was sent to a robot."""
        if self.in_force and self._tally.note_step(report):
            self._announce_answers()

    def _put_in_force(self, stop: StopRow) -> None:
        self._seen.add(stop.id)
        self._stop = self._in_force[stop.id] = stop
        self._unstored.append(stop)
        with log_and_continue(log, "counting the robots that are sent an emergency stop"):
            self._count_again()

    def _count_again(self) -> None:
        self._observed = -1
        self._tally.begin(self._robots.commanded())

    def _abort_overdue(self, stop: StopRow | None, robots: Iterable[str]) -> None:
        """Abort robots that drive since before a stop that is over: its Aborts were not stored.

        A stop cleared in the future comes from a wrong clock: it is unknown what was before it.
        """
        now = self._clock.time()
        if stop is None or stop.cleared_at is None or stop.cleared_at > now + AHEAD_S:
            return
        # The age of a motion from the future, by a wrong clock of its gateway, is unknown.
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
        writing = None
        # If one of these steps fails, the next ones are done all the same.
        with log_and_continue(log, "noting an emergency stop"):
            # The disk works while the stop is sent to other gateways.
            writing = self._write_journal()
        for relay in self._relays if is_own else ():
            with log_and_continue(log, "telling other gateways of an emergency stop"):
                relay.announce(stop)
        with log_and_continue(log, "waiting for the note of an emergency stop"):
            # A stop from elsewhere is written to the journal and stored there as well.
            if writing is not None and is_own:
                futures.wait([writing], NOTED_WITHIN)
        operators_first = False
        with log_and_continue(log, "telling operators of an emergency stop"):
            # After the journal: operators must not see a stop in force that dies with this gateway.
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

    def _write_journal(self) -> futures.Future[bool] | None:
        """Write the stop in force, and those that are not stored, to the journal.

        The one in force stays there for as long as it is: an older state of the database may be restored.
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
            robots, readers = self._robots.commanded(), self._robots.readers()
            try:
                if not await self._writer.write(stop, robots, readers):
                    self._unlisted.append(stop)
            except StoreError:
                for pressed_again in self._unstored[1:]:
                    await self._writer.add_bare(pressed_again, readers)
                raise
            self._unstored.remove(stop)
            with log_and_continue(log, "noting that an emergency stop is stored"):
                self._write_journal()
            self.announce()
        await self._writer.write_owed()

    def _announce_answers(self) -> None:
        """Announce the answers of robots, together with those that follow shortly."""
        if self._answers_due is None:
            loop = asyncio.get_running_loop()
            self._answers_due = loop.call_later(ANSWERS_TOGETHER, self.announce)

    def announce(self) -> None:
        """Send the state of the stop to every operator and to other gateways."""
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
    """Return the name of an operator as stored, in a form that no database refuses."""
    return one_line(operator, LONGEST_OPERATOR).strip() or "an operator"


def _clock(at: float) -> str:
    return time.strftime("%H:%M:%S UTC", time.gmtime(at))


def _because(reason: str | None) -> str:
    return f" ({reason})" if reason else ""
