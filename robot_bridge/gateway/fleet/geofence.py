"""Geofence: judges robots' positions, notifies operators, and stops robots if the site demands it."""

from __future__ import annotations

import asyncio
import logging
import time
import uuid
from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from typing import Protocol

import numpy as np

from ...core.clock import Clock
from ...core.errors import BridgeError, RefusedError
from ...core.messages.base import MessageError, to_json
from ...core.messages.commands import AbortTask
from ...core.messages.queues import PauseRobot
from ...core.messages.safety import FenceAlarm, Geofence
from ...core.sites.fences import Fences
from ...core.sites.frame import Points
from ..cluster.messages import MOST_ALARMS, MOST_UNJUDGED
from ..cluster.robot_relay import ReportsElsewhere, join_reports
from ..commands.requests import CommandRequests
from ..model.events import (
    EventBus,
    FenceJudged,
    FenceJudgedElsewhere,
    Listeners,
    RobotClaimed,
    RobotLeft,
)
from ..model.fence_stays import DONE, Clearances, FoundStays, Stay, Stays, find_stays, finite_places
from ..model.robot_columns import DOUBTED, FRESH, LOCATED, OFFLINE, POSE_AT, RobotPlaces, X, Y
from ..model.robots import Robots
from ..monitoring import BackgroundTasks
from ..queues.requests import PauseService
from ..site.places import ServedSite
from .emergency_stop import EmergencyStops

log = logging.getLogger(__name__)

OPERATOR = "geofence"
"""Name in the log for the one who stopped a robot."""
REPORT_EVERY_S = 1.0
UNCHANGED_EVERY_S = 3.0
"""Interval of repetition, for operators who connected since then, and as a sign that the watch runs."""
RETRY_AFTER_S = 1.0
_LONGEST_NAME = 100


class AuditNote(Protocol):
    """Writes into the audit log (see :meth:`.AuditJournal.note`)."""

    def __call__(
        self, who: str, action: str, *, done: bool = ..., subject: str | None = ..., detail: str | None = ...
    ) -> None:
        """Record that ``who`` did ``action``, or tried to."""


class _Passed:
    """The report sent last; one is due when it has changed, and after :data:`UNCHANGED_EVERY_S`."""

    def __init__(self) -> None:
        self._report: Geofence | None = None
        self._at = -UNCHANGED_EVERY_S

    def is_due(self, report: Geofence) -> bool:
        """Return whether ``report`` must be sent, and record it as the last one if so."""
        now, report = time.monotonic(), replace(report, t=0.0)
        if now - self._at < UNCHANGED_EVERY_S and self._report == report:
            return False
        self._report, self._at = report, now
        return True


class GeofenceWatch:
    """Judges the newest position of each robot that has moved, several times a second.

    Robots of other gateways are judged by those, and here where they report nothing. Each robot is stopped
    by a task of its own: one that takes long, or fails, delays no other.
    """

    def __init__(
        self,
        site: ServedSite,
        robots: Robots,
        orders: CommandRequests,
        pauses: PauseService,
        emergency: EmergencyStops,
        clock: Clock,
        listeners: Listeners,
        events: EventBus,
        note: AuditNote | None = None,
    ) -> None:
        self._site = site
        self._robots = robots
        self._orders = orders
        self._pauses = pauses
        self._emergency = emergency
        self._clock = clock
        self._listeners = listeners
        self._events = events
        self._note = note
        self._stays = Stays()
        self._fenced: Fences | None = None
        self._fault: str | None = None
        self._seen = -1
        """The revision of the robots up to which they were judged."""
        self._elsewhere = ReportsElsewhere()
        self._left: frozenset[str] = frozenset()
        """The gateways that judge their robots themselves."""
        self._judged: set[str] = set()
        """Robots of this gateway that have been judged since they were claimed here."""
        self._acting = BackgroundTasks()
        self._reported_at, self._reported = -REPORT_EVERY_S, 0
        """Time of the last report, and its number of stays."""
        self._to_operators, self._to_gateways = _Passed(), _Passed()
        events.subscribe(FenceJudgedElsewhere, self._handle_elsewhere)
        events.subscribe(RobotClaimed, self._handle_claimed)
        events.subscribe(RobotLeft, self._handle_left)

    async def watch(self) -> None:
        """Judge the robots that have moved since the last call, act on the result, and report it."""
        fault = None
        try:
            await self._judge(await self._fences())
        except Exception as error:
            # Raised, it would recur and end the gateway, and every stop with it.
            if self._fault is None:
                log.exception("keepouts and obstacles of site %s cannot be watched", self._site.site.id)
            fault = f"the site's areas cannot be used: {error}"
        self._fault = fault
        self._notify()

    def report(self) -> Geofence:
        """Return the report for operators."""
        return self._join(self._own())

    def _own(self) -> Geofence:
        """Return the report on the robots of this gateway."""
        gateway_of = self._robots.gateway_of
        stays = [stay for stay in self._stays if gateway_of(stay.robot) is None]
        return self._report(stays, self._robots.own_places())

    def _join(self, own: Geofence) -> Geofence:
        """Return the report on all robots."""
        gateway_of, reports = self._robots.gateway_of, self._elsewhere.at(self._clock.steady())
        stays = [stay for stay in self._stays if gateway_of(stay.robot) is not None]
        found = [self._report(stays, self._robots.places_elsewhere(without=self._left))]
        for gateway, report in reports.items():
            # A robot that has left that gateway since is judged by the gateway that has it now.
            alarms = [alarm for alarm in report.alarms if gateway_of(alarm.robot) == gateway]
            fault = None if report.fault is None else f"gateway {gateway}: {report.fault}"
            found.append(replace(report, alarms=alarms, fault=fault))
        return join_reports(own, found)

    def _report(self, stays: Sequence[Stay], places: RobotPlaces) -> Geofence:
        now, fenced = self._clock.time(), self._fenced
        newest = sorted(stays, key=lambda stay: -stay.since)[:MOST_ALARMS]
        unjudged = self._unjudged(places, now)
        return Geofence(
            t=now,
            alarms=[_alarm(stay, is_placed=self._robots.is_placed(stay.robot)) for stay in newest],
            more=len(stays) - len(newest),
            keepouts=0 if fenced is None else len(fenced.keepouts),
            obstacles=0 if fenced is None else len(fenced.obstacles) + len(fenced.observed),
            unjudged=unjudged[:MOST_UNJUDGED],
            unjudged_more=max(len(unjudged) - MOST_UNJUDGED, 0),
            fault=self._fault,
        )

    async def _fences(self) -> Fences:
        """Return the areas that robots must not be in; changed ones are made in a thread."""
        fences = self._site.fences_at_hand()
        if fences is None:
            fences = await asyncio.to_thread(self._site.fences)
        if fences is not self._fenced:
            # If only observed objects changed, the publication's areas and the stays in them are the same.
            if self._fenced is None or fences.keepouts is not self._fenced.keepouts:
                self._stays.begin_publication()
            self._fenced, self._seen = fences, -1
        return fences

    async def _judge(self, fences: Fences) -> None:
        left = frozenset(self._elsewhere.at(self._clock.steady()))
        if left != self._left:
            self._left, self._seen = left, -1
        self._stays.forget({stay.robot for stay in self._stays if not self._is_judged(stay.robot)})
        seen = self._robots.revision
        if seen == self._seen and not len(self._stays):
            return
        names, places = _placed(self._robots, self._seen, left)
        settings = self._site.settings
        found = FoundStays(set(), {}, {}, set())
        if names:
            clearances = Clearances.of(settings.geofence, settings.routes.radius_m)
            found = await asyncio.to_thread(find_stays, names, places, fences, clearances)
        changes = self._stays.update(found, settings.geofence, self._clock.time())
        self._seen = seen
        for stay in changes.ended:
            log.info("robot %s is no longer %s", stay.robot, _where(stay))
        for stay in changes.entered:
            log.warning("robot %s is %s at (%.2f, %.2f)", stay.robot, _where(stay), *stay.place)
        gateway_of = self._robots.gateway_of
        for stay in self._stays:
            # Robots of another gateway are stopped by it; those that came from there since are stopped here.
            if _is_open(stay) and gateway_of(stay.robot) is None and not self._was_stopped_elsewhere(stay):
                self._stop_by_task(stay)
        own = [name for name in names if gateway_of(name) is None]
        self._judged.update(own)
        self._elsewhere.drop_alarms(own)

    def _is_judged(self, robot: str) -> bool:
        return robot in self._robots and self._robots.gateway_of(robot) not in self._left

    def _was_stopped_elsewhere(self, stay: Stay) -> bool:
        """Return whether the robot came to this gateway inside the area and was stopped at its former one. It
        may be on its way out, and the stay continues with the data from there."""
        if stay.robot in self._judged:
            return False
        known = self._elsewhere.alarm(stay.robot, stay.kind, stay.name, self._clock.steady())
        if known is None or known.outcome not in DONE:
            return False
        stay.since, stay.outcome, stay.reason = known.since, known.outcome, known.reason
        return True

    def _stop_by_task(self, stay: Stay) -> None:
        stay.outcome = "asked"
        self._acting.start(self._act(stay), f"geofence: {stay.action} {stay.robot}")

    async def _act(self, stay: Stay) -> None:
        """Stop the robot; retried for as long as the stay lasts, under the same id."""
        command = str(uuid.uuid4())
        while True:
            try:
                await self._stop(stay, command)
            except Exception as error:
                if not isinstance(error, (BridgeError, MessageError)):
                    log.exception("robot %s, %s, could not be stopped", stay.robot, _where(stay))
                if stay.outcome != "failed":
                    self._write(stay, done=False, detail=str(error))
                stay.outcome, stay.reason = "failed", str(error)
                await asyncio.sleep(RETRY_AFTER_S)
                if not self._stays.holds(stay):
                    return
                continue
            stay.reason = None
            self._write(stay, done=True, detail=_where(stay))
            return

    async def _stop(self, stay: Stay, command: str) -> None:
        if self._emergency.in_force:
            # It was sent a stop already, and no motion is sent before that is cleared.
            stay.outcome = "stopped"
            return
        reason = _where(stay)
        if stay.action == "pause":
            try:
                await self._pauses.pause(PauseRobot(stay.robot, reason), OPERATOR)
                stay.outcome = "paused"
                return
            except (RefusedError, MessageError) as error:
                # A task that cannot be paused is aborted: the robot must stand.
                log.warning("robot %s cannot be paused and is aborted: %s", stay.robot, error)
        await self._orders.abort(AbortTask(command, stay.robot, reason=reason), OPERATOR)
        stay.outcome = "aborted"

    def _write(self, stay: Stay, *, done: bool, detail: str) -> None:
        level = logging.WARNING if done else logging.ERROR
        log.log(
            level,
            "robot %s, %s: %s %s",
            stay.robot,
            _where(stay),
            stay.action,
            stay.outcome if done else detail,
        )
        if self._note is not None:
            self._note(OPERATOR, stay.action, done=done, subject=stay.robot, detail=detail)

    def _notify(self) -> None:
        now = time.monotonic()
        if now - self._reported_at < REPORT_EVERY_S and len(self._stays) == self._reported:
            return
        self._reported_at, self._reported = now, len(self._stays)
        own = self._own()
        if self._to_gateways.is_due(own):
            self._events.publish(FenceJudged(own))
        report = self._join(own)
        if self._to_operators.is_due(report):
            self._listeners.announce("geofence", "geofence", to_json(report))

    def _handle_claimed(self, claimed: RobotClaimed) -> None:
        self._elsewhere.keep_alarms(claimed.robot, self._clock.steady())

    def _handle_left(self, left: RobotLeft) -> None:
        self._judged.discard(left.robot)
        self._elsewhere.drop_alarms([left.robot])

    def _handle_elsewhere(self, judged: FenceJudgedElsewhere) -> None:
        self._elsewhere.add_report(judged.gateway, judged.report, self._clock.steady())

    def _unjudged(self, places: RobotPlaces, now: float) -> list[str]:
        """Return the robots of unknown position; those that have gone offline stand where they were."""
        lost_after = self._site.settings.liveness.lost_after_s
        is_recent = now - places.table[POSE_AT] < lost_after
        seen = (places.states == FRESH) & ((places.flags & (LOCATED | DOUBTED)) == LOCATED) & is_recent
        rows = np.flatnonzero((places.states != OFFLINE) & ~seen)
        return sorted(places.names[row] for row in rows.tolist())


def _is_open(stay: Stay) -> bool:
    """Return whether the action on a stay is due and not begun yet."""
    return stay.action != "none" and stay.outcome == "none"


def _alarm(stay: Stay, *, is_placed: bool) -> FenceAlarm:
    return FenceAlarm(
        stay.robot,
        stay.kind,
        stay.name,
        round(stay.since, 1),
        round(stay.place[0], 2),
        round(stay.place[1], 2),
        stay.action,
        stay.outcome,
        stay.reason,
        is_placed,
    )


def _placed(robots: Robots, since: int, without: AbstractSet[str]) -> tuple[list[str], Points]:
    """Return the names and positions, (n, 2), of robots that changed after revision ``since`` and have
    reported a position since they connected, without those of the gateways ``without``."""
    found = robots.places(since, without)
    places = found.table[[X, Y]].T
    places[(found.flags & LOCATED) == 0] = np.nan
    rows = finite_places(places)
    return [found.names[row] for row in np.flatnonzero(rows).tolist()], places[rows]


def _where(stay: Stay) -> str:
    name = "".join(letter if letter.isprintable() else "?" for letter in stay.name)[:_LONGEST_NAME]
    return f"in the keepout '{name}'" if stay.kind == "keepout" else f"at the obstacle '{name}'"
