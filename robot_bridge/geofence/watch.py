"""The geofence at work: judges where robots are, tells operators, and stops robots if the site says so."""

from __future__ import annotations

import asyncio
import logging
import time
import uuid
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from ..commanding.orders import Orders
from ..emergency.stops import EmergencyStops
from ..errors import BridgeError, RefusedError
from ..messages import AbortTask, MessageError, PauseRobot, RobotState, to_json
from ..messages.geofence import FenceAlarm, Geofence
from ..queueing.pausing import RobotPauses
from ..robots import Robot, Robots
from ..served_site import ServedSite
from ..sites.fences import Fences
from ..sites.frame import Points
from .stays import Clearances, Stay, Stays, find, finite_rows

log = logging.getLogger(__name__)

OPERATOR = "geofence"
"""Who stands in the log as the one who stopped a robot."""
TOLD_EVERY_S = 1.0
TOLD_UNCHANGED_EVERY_S = 3.0
"""Operators who have connected since then hear of it, and that somebody watches at all."""
RETRY_AFTER_S = 1.0
MOST_ALARMS = 300
MOST_NAMES = 20
_LONGEST_NAME = 100


class AuditNote(Protocol):
    """What writes into the audit log (see :meth:`.access.journal.Journal.note`)."""

    def __call__(
        self, who: str, action: str, *, done: bool = ..., subject: str | None = ..., detail: str | None = ...
    ) -> None:
        """Note that ``who`` did ``action``, or tried to."""


class GeofenceWatch:
    """Judges some times a second the newest position of each robot that has moved, and no other.

    Each robot is stopped by a task of its own: one that takes long, or fails, holds up no other.
    """

    def __init__(
        self,
        site: ServedSite,
        robots: Robots,
        orders: Orders,
        pauses: RobotPauses,
        emergency: EmergencyStops,
        clock: Callable[[], float],
        announce: Callable[[str, str, dict[str, Any]], None],
        note: AuditNote | None = None,
    ) -> None:
        self._site = site
        self._robots = robots
        self._orders = orders
        self._pauses = pauses
        self._emergency = emergency
        self._clock = clock
        self._announce = announce
        self._note = note
        self._stays = Stays()
        self._fenced: Fences | None = None
        self._fault: str | None = None
        self._seen = -1
        """The revision of the robots that were judged."""
        self._acting: set[asyncio.Task[None]] = set()
        self._told: tuple[float, Geofence | None] = (-TOLD_UNCHANGED_EVERY_S, None)

    async def watch(self) -> None:
        """Judge the robots that have moved since the last call, act on what that shows, and tell of it."""
        fault = None
        try:
            await self._judge(await self._fences())
        except Exception as error:
            # Again and again it would end the gateway, and every stop with it.
            if self._fault is None:
                log.exception("keepouts and obstacles of site %s cannot be watched", self._site.site.id)
            fault = f"the site's areas cannot be used: {error}"
        self._fault = fault
        self._tell()

    def report(self) -> Geofence:
        """Return what operators are told."""
        now = self._clock()
        stays = sorted(self._stays, key=lambda stay: -stay.since)
        unjudged = self._unjudged(now)
        fenced = self._fenced
        return Geofence(
            t=now,
            alarms=[self._alarm(stay) for stay in stays[:MOST_ALARMS]],
            more=max(len(stays) - MOST_ALARMS, 0),
            keepouts=0 if fenced is None else len(fenced.keepouts),
            obstacles=0 if fenced is None else len(fenced.obstacles) + len(fenced.observed),
            unjudged=unjudged[:MOST_NAMES],
            unjudged_more=max(len(unjudged) - MOST_NAMES, 0),
            fault=self._fault,
        )

    async def settle(self) -> None:
        """Wait until every stop that was begun is done or has failed once."""
        await asyncio.gather(*self._acting, return_exceptions=True)

    async def _fences(self) -> Fences:
        """Return what robots must not be in; what has changed of that is made beside all other work."""
        fences = await asyncio.to_thread(self._site.fences)
        if fences is not self._fenced:
            # With other objects alone the publication's areas are the same, and so are the stays in them.
            if self._fenced is None or fences.keepouts is not self._fenced.keepouts:
                self._stays.begin_publication()
            self._fenced, self._seen = fences, -1
        return fences

    async def _judge(self, fences: Fences) -> None:
        gone = [stay.robot for stay in self._stays if stay.robot not in self._robots]
        if gone:
            self._stays.forget(gone)
        seen = self._robots.revision
        names, places = _placed(self._robots.changed(self._seen))
        settings = self._site.settings
        clearances = Clearances.of(settings.geofence, settings.routes.radius_m)
        found = await asyncio.to_thread(find, names, places, fences, clearances)
        changes = self._stays.update(found, settings.geofence, self._clock())
        self._seen = seen
        for stay in changes.ended:
            log.info("robot %s is no longer %s", stay.robot, _where(stay))
        for stay in changes.entered:
            self._begin(stay)

    def _begin(self, stay: Stay) -> None:
        x, y = stay.place
        log.warning("robot %s is %s at (%.2f, %.2f)", stay.robot, _where(stay), x, y)
        if stay.action == "none":
            return
        stay.outcome = "asked"
        acting = asyncio.create_task(self._act(stay), name=f"geofence: {stay.action} {stay.robot}")
        self._acting.add(acting)
        acting.add_done_callback(self._acting.discard)

    async def _act(self, stay: Stay) -> None:
        """Stop the robot; tried again for as long as it is there, under the same id."""
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
            # It has been told to stop already, and nothing sends it on before that is cleared.
            stay.outcome = "stopped"
            return
        reason = _where(stay)
        if stay.action == "pause":
            try:
                await self._pauses.pause(PauseRobot(stay.robot, reason), OPERATOR)
                stay.outcome = "paused"
                return
            except (RefusedError, MessageError) as error:
                # What cannot be kept for later is given up: the robot has to stand.
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

    def _tell(self) -> None:
        told_at, told = self._told
        waited = time.monotonic() - told_at
        if waited < TOLD_EVERY_S and told is not None and len(self._stays) == len(told.alarms) + told.more:
            return
        report = self.report()
        changed = told is None or _without_time(report) != _without_time(told)
        if changed or waited >= TOLD_UNCHANGED_EVERY_S:
            self._told = time.monotonic(), report
            self._announce("geofence", "geofence", to_json(report))

    def _alarm(self, stay: Stay) -> FenceAlarm:
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
            self._robots.is_placed(stay.robot),
        )

    def _unjudged(self, now: float) -> list[str]:
        """Return the robots that may be anywhere; those that have gone offline stand where they were."""
        known = (self._robots.get(name) for name in self._robots.names())
        lost_after = self._site.settings.liveness.lost_after_s
        return [
            one.name
            for one in known
            if one.state is not RobotState.OFFLINE and not _is_seen(one, now, lost_after)
        ]


def _is_seen(robot: Robot, now: float, lost_after: float) -> bool:
    fresh = robot.state is RobotState.FRESH and robot.located and robot.pose_at is not None
    return fresh and now - (robot.pose_at or 0.0) < lost_after


def _placed(robots: list[Robot]) -> tuple[list[str], Points]:
    """Return the names and places, (n, 2), of those that have said where they are since they connected."""
    placed = [(one.name, one.pose) for one in robots if one.located and one.pose is not None]
    places = np.array([(pose.x, pose.y) for _, pose in placed], dtype=np.float64).reshape(-1, 2)
    names = [name for name, _ in placed]
    rows = finite_rows(places)
    return [name for name, row in zip(names, rows.tolist(), strict=True) if row], places[rows]


def _where(stay: Stay) -> str:
    name = "".join(letter if letter.isprintable() else "?" for letter in stay.name)[:_LONGEST_NAME]
    return f"in the keepout '{name}'" if stay.kind == "keepout" else f"at the obstacle '{name}'"


def _without_time(report: Geofence) -> dict[str, Any]:
    values: dict[str, Any] = {**vars(report), "t": 0.0}
    return values
