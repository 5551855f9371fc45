"""Geofence: robots in keepouts and at obstacles, found with hysteresis, reported, stopped."""

from __future__ import annotations

import asyncio
import logging
import time
import uuid
from collections.abc import Collection, Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.clock import Clock
from ...core.errors import BridgeError, RefusedError
from ...core.messages.base import MessageError, to_json
from ...core.messages.commands import AbortTask
from ...core.messages.queues import PauseRobot
from ...core.messages.safety import FenceAlarm, FenceKind, Geofence, StopAction, StopOutcome
from ...core.sites.fences import FencedAreas, Fences
from ...core.sites.frame import Points
from ...core.sites.settings_tables import GeofenceSettings
from ..cluster.messages import MOST_ALARMS, MOST_UNJUDGED
from ..cluster.robot_relay import ReportsElsewhere, join_reports
from ..commands.requests import CommandRequests
from ..model.events import EventBus, FenceJudged, FenceJudgedElsewhere, Listeners, RobotLeft
from ..model.robot_columns import FRESH, LOCATED, OFFLINE, POSE_AT, RobotPlaces, X, Y
from ..model.robots import Robots
from ..queues.requests import PauseService
from ..site.places import ServedSite
from .emergency_stop import EmergencyStops

# --- Which robots are in which keepouts and at which obstacles, with hysteresis; no I/O ---

MARGIN_M = 0.5
"""Metres beyond the clearance at which a robot has left: positions tremble by some decimetres."""
LEFT_AFTER_S = 2.0
"""Seconds for which it has to be that far away before it counts as left."""
Place = tuple[float, float]
"""x, y in metres, site frame."""
DONE: Collection[StopOutcome] = ("paused", "aborted", "stopped")
"""Outcomes of robots that have been stopped."""


class StayKey(NamedTuple):
    """A robot in one area; ``area`` is its id among those of its kind."""

    robot: str
    kind: FenceKind
    area: int


@dataclass
class Stay:
    """One entry of a robot into an area, at ``place`` and time ``since``, until it has left.

    ``action`` is what has to be done about it, once; ``outcome`` and ``reason`` say what came of that.
    """

    robot: str
    kind: FenceKind
    name: str
    since: float
    place: Place
    action: StopAction
    outcome: StopOutcome = "none"
    reason: str | None = None


class Clearances(NamedTuple):
    """Metres from a robot's middle to an area within which it is in it, or at it."""

    keepout: float
    obstacle: float

    @classmethod
    def of(cls, settings: GeofenceSettings, radius: float) -> Clearances:
        """Return the clearances that a site sets, for robots of ``radius`` metres."""
        obstacle = settings.obstacle_clearance_m
        return cls(settings.keepout_clearance_m, radius if obstacle is None else obstacle)


class FoundStays(NamedTuple):
    """Robots that were ``judged``; those ``inside`` an area, with the areas and its number among them, and
    ``places`` of those, and those still ``near`` one."""

    judged: AbstractSet[str]
    places: dict[str, Place]
    inside: dict[StayKey, tuple[FencedAreas, int]]
    near: set[StayKey]


class StayChanges(NamedTuple):
    """What one look changed."""

    entered: list[Stay]
    ended: list[Stay]


class Stays:
    """The stays of all robots in the areas of one publication.

    A stay begins when a robot comes within the clearance, and ends when it has been :data:`MARGIN_M` further
    away for :data:`LEFT_AFTER_S`. In between it is the same stay, whatever the robot does: it is acted upon
    once, so that an operator can drive a stopped robot out again.
    """

    def __init__(self) -> None:
        self._stays: dict[StayKey, Stay] = {}
        self._outside_since: dict[StayKey, float] = {}
        self._earlier: dict[tuple[str, FenceKind, str], Stay] = {}

    def __iter__(self) -> Iterator[Stay]:
        return iter(self._stays.values())

    def __len__(self) -> int:
        return len(self._stays)

    def begin_publication(self) -> None:
        """Expect other areas from the next look on, at which every robot has to be judged.

        A robot that is then in an area of the same kind and name goes on with the stay that it had.
        """
        self._earlier.update({(stay.robot, stay.kind, stay.name): stay for stay in self})
        self._stays.clear()
        self._outside_since.clear()

    def update(self, found: FoundStays, settings: GeofenceSettings, now: float) -> StayChanges:
        """Take in what was found of some robots; the others are where they were."""
        entered = []
        # All names before any stay: one that began, and of which nobody hears, would never be acted upon.
        new = sorted(found.inside.keys() - self._stays.keys())
        names = {key: areas.name(area) for key in new for areas, area in [found.inside[key]]}
        for key, name in names.items():
            stay = self._begin(key, name, found.places[key.robot], settings, now)
            if stay is not None:
                entered.append(stay)
        self._note_outside(found, now)
        ended = [*self._end_outside(now), *self._earlier.values()]
        self._earlier.clear()
        return StayChanges(entered, ended)

    def forget(self, robots: Iterable[str]) -> list[Stay]:
        """End the stays of robots that nobody judges here any more, and return them."""
        gone = set(robots)
        keys = [key for key in self._stays if key.robot in gone]
        for key in keys:
            self._outside_since.pop(key, None)
        return [self._stays.pop(key) for key in keys]

    def holds(self, stay: Stay) -> bool:
        """Tell whether a stay goes on."""
        return any(one is stay for one in self)

    def _begin(
        self, key: StayKey, name: str, place: Place, settings: GeofenceSettings, now: float
    ) -> Stay | None:
        """Begin a stay and return it, None where it is one that goes on in a new publication."""
        known = self._earlier.pop((key.robot, key.kind, name), None)
        if known is not None:
            self._stays[key] = known
            return None
        action = settings.in_keepout if key.kind == "keepout" else settings.at_obstacle
        stay = Stay(key.robot, key.kind, name, now, place, action)
        self._stays[key] = stay
        return stay

    def _note_outside(self, found: FoundStays, now: float) -> None:
        for key in self._stays:
            if key in found.near:
                self._outside_since.pop(key, None)
            elif key.robot in found.judged:
                self._outside_since.setdefault(key, now)

    def _end_outside(self, now: float) -> list[Stay]:
        # A clock that was set back must not keep an alarm for as long as it was set back.
        over = [key for key, since in self._outside_since.items() if not 0 <= now - since < LEFT_AFTER_S]
        for key in over:
            del self._outside_since[key]
        return [self._stays.pop(key) for key in over]


def find_stays(robots: Sequence[str], places: Points, fences: Fences, clearances: Clearances) -> FoundStays:
    """Return in which areas ``robots`` at ``places``, (n, 2) metres in the site frame, are; in any thread."""
    inside: dict[StayKey, tuple[FencedAreas, int]] = {}
    near: set[StayKey] = set()
    at: dict[str, Place] = {}
    kinds: tuple[tuple[FenceKind, FencedAreas, float], ...] = (
        ("keepout", fences.keepouts, clearances.keepout),
        ("obstacle", fences.obstacles, clearances.obstacle),
        ("obstacle", fences.observed, clearances.obstacle),
    )
    for kind, areas, metres in kinds:
        pairs = areas.near(places, metres + MARGIN_M)
        if not pairs.size:
            continue
        is_inside = areas.are_near(places, pairs, metres).tolist()
        for (row, area), inside_it in zip(pairs.T.tolist(), is_inside, strict=True):
            key = StayKey(robots[row], kind, areas.id(area))
            near.add(key)
            if inside_it:
                inside[key] = areas, area
                x, y = places[row].tolist()
                at[key.robot] = x, y
    return FoundStays(set(robots), at, inside, near)


def finite_places(places: Points) -> NDArray[np.bool_]:
    """Tell which of ``places``, (n, 2), are places: numbers, all of them finite."""
    rows: NDArray[np.bool_] = np.isfinite(places).all(axis=1)
    return rows


# --- The geofence at work: judges where robots are, tells operators, and stops robots if the site says so

log = logging.getLogger(__name__)

OPERATOR = "geofence"
"""Who stands in the log as the one who stopped a robot."""
REPORT_EVERY_S = 1.0
UNCHANGED_EVERY_S = 3.0
"""Operators who have connected since then hear of it, and that somebody watches at all."""
RETRY_AFTER_S = 1.0
_LONGEST_NAME = 100


class AuditNote(Protocol):
    """What writes into the audit log (see :meth:`.access.journal.Journal.note`)."""

    def __call__(
        self, who: str, action: str, *, done: bool = ..., subject: str | None = ..., detail: str | None = ...
    ) -> None:
        """Note that ``who`` did ``action``, or tried to."""


class _Passed:
    """A report as it was passed on last: again when it has changed, and after :data:`UNCHANGED_EVERY_S`."""

    def __init__(self) -> None:
        self._report: Geofence | None = None
        self._at = -UNCHANGED_EVERY_S

    def is_due(self, report: Geofence) -> bool:
        """Tell whether ``report`` has to be passed on; it is the last one then."""
        now, report = time.monotonic(), replace(report, t=0.0)
        if now - self._at < UNCHANGED_EVERY_S and self._report == report:
            return False
        self._report, self._at = report, now
        return True


class GeofenceWatch:
    """Judges some times a second the newest position of each robot that has moved, and no other.

    Robots of other gateways are judged by those, and here where they report nothing. Each robot is stopped
    by a task of its own: one that takes long, or fails, holds up no other.
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
        """The revision of the robots that were judged."""
        self._elsewhere = ReportsElsewhere()
        self._left: frozenset[str] = frozenset()
        """The gateways that judge their robots themselves."""
        self._judged: set[str] = set()
        """The robots that were judged here since they came from another gateway."""
        self._acting: set[asyncio.Task[None]] = set()
        self._reported_at, self._reported = -REPORT_EVERY_S, 0
        """When a report was made last, and of how many stays."""
        self._to_operators, self._to_gateways = _Passed(), _Passed()
        events.subscribe(FenceJudgedElsewhere, self._note_elsewhere)
        events.subscribe(RobotLeft, lambda left: self._judged.discard(left.robot))

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
        return self._join(self._own())

    def _own(self) -> Geofence:
        """Return what was found of the robots of this gateway."""
        gateway_of = self._robots.gateway_of
        stays = [stay for stay in self._stays if gateway_of(stay.robot) is None]
        return self._report(stays, self._robots.own_places())

    def _join(self, own: Geofence) -> Geofence:
        """Return what was found of all robots."""
        gateway_of, reports = self._robots.gateway_of, self._elsewhere.at(self._clock.steady())
        stays = [stay for stay in self._stays if gateway_of(stay.robot) is not None]
        found = [self._report(stays, self._robots.places_elsewhere(without=self._left))]
        for gateway, report in reports.items():
            # A robot that has gone from there since is judged by the gateway that has it now.
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
        left = frozenset(self._elsewhere.at(self._clock.steady()))
        if left != self._left:
            self._left, self._seen = left, -1
        self._stays.forget({stay.robot for stay in self._stays if not self._is_judged(stay.robot)})
        seen = self._robots.revision
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
            self._begin(stay)
        self._judged.update(names)
        for stay in self._stays:
            # What another gateway has, that one stops; what has come from there since is stopped here.
            if _is_open(stay) and self._robots.gateway_of(stay.robot) is None:
                self._stop_by_task(stay)

    def _is_judged(self, robot: str) -> bool:
        return robot in self._robots and self._robots.gateway_of(robot) not in self._left

    def _begin(self, stay: Stay) -> None:
        x, y = stay.place
        log.warning("robot %s is %s at (%.2f, %.2f)", stay.robot, _where(stay), x, y)
        if stay.robot in self._judged:
            return
        known = self._elsewhere.alarm(stay.robot, stay.kind, stay.name)
        if known is not None and known.outcome in DONE:
            # It came here inside the area, was stopped where it comes from, and may be on its way out.
            stay.since, stay.outcome, stay.reason = known.since, known.outcome, known.reason

    def _stop_by_task(self, stay: Stay) -> None:
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

    def _note_elsewhere(self, judged: FenceJudgedElsewhere) -> None:
        self._elsewhere.add_report(judged.gateway, judged.report, self._clock.steady())

    def _unjudged(self, places: RobotPlaces, now: float) -> list[str]:
        """Return the robots that may be anywhere; those that have gone offline stand where they were."""
        lost_after = self._site.settings.liveness.lost_after_s
        is_recent = now - places.table[POSE_AT] < lost_after
        seen = (places.states == FRESH) & ((places.flags & LOCATED) > 0) & is_recent
        rows = np.flatnonzero((places.states != OFFLINE) & ~seen)
        return sorted(places.names[row] for row in rows.tolist())


def _is_open(stay: Stay) -> bool:
    """Tell whether something has to be done about a stay that nobody has begun yet."""
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
    """Return the names and places, (n, 2), of those that changed after revision ``since`` and have said where
    they are since they connected, without the robots of some gateways."""
    found = robots.places(since, without)
    places = found.table[[X, Y]].T
    places[(found.flags & LOCATED) == 0] = np.nan
    rows = finite_places(places)
    return [found.names[row] for row in np.flatnonzero(rows).tolist()], places[rows]


def _where(stay: Stay) -> str:
    name = "".join(letter if letter.isprintable() else "?" for letter in stay.name)[:_LONGEST_NAME]
    return f"in the keepout '{name}'" if stay.kind == "keepout" else f"at the obstacle '{name}'"
