"""Nearness of people and vehicles that are only seen to robots, now and predicted."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Container, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...core.clock import Clock
from ...core.messages.base import to_json
from ...core.messages.robots import SendPos
from ...core.messages.safety import Nearness, NearnessAlarm, RobotState
from ..model.events import Listeners
from ..model.robots import Robot, Robots
from ..site.places import ServedSite
from ..traffic.conflicts import Movement, OtherMovements
from ..traffic.robot_paths import TrafficSnapshot
from ..traffic.service import TrafficControl
from .link_supervision import LinkWatch

# --- People and vehicles near a robot now, or soon if both keep their motion; no I/O ---

MARGIN_M = 1.0
"""Metres beyond the limit at which nearness ends: positions of phones are off by metres."""
Pair = tuple[str, str]
"""Names of the person or vehicle that is seen, and of the robot."""


class Meeting(NamedTuple):
    """A pair that is near, or will be in ``seconds``, with ``metres`` between them then, about ``place``."""

    seen: str
    robot: str
    metres: float
    seconds: float
    place: tuple[float, float]

    @property
    def pair(self) -> Pair:
        """Both names."""
        return self.seen, self.robot


class NearnessLimits(NamedTuple):
    """Metres between the centres of a near pair, and seconds of prediction."""

    metres: float
    within_s: float


class Mover(NamedTuple):
    """A robot, person or vehicle at ``place``, metres, with ``velocity``, m/s, both in the site frame."""

    name: str
    place: tuple[float, float]
    velocity: tuple[float, float]

    def straight_on(self, now: float, seconds: float) -> Movement:
        """Return the movement with the present velocity for ``seconds``, and standing then."""
        begin = np.array(self.place, dtype=np.float64)
        points = np.stack([begin, begin + np.array(self.velocity, dtype=np.float64) * seconds])
        return Movement(self.name, points, np.array([now, now + seconds]), 0.0)


def find_meetings(
    people: Sequence[Movement],
    robots: Sequence[Movement],
    limits: NearnessLimits,
    now: float,
    near: Container[Pair] = (),
) -> list[Meeting]:
    """Return the pairs that are near now, and those that will be soon, the soonest first.

    All radii are 0. Pairs in ``near`` were near before, and are so up to a margin beyond the limit.
    """
    if not people or not robots:
        return []
    found = {one.pair: one for one in _near_now(people, robots, limits.metres, now, near)}
    surroundings = OtherMovements(robots, limits.metres, now)
    for person in people:
        for conflict in surroundings.conflicts(person):
            robot = conflict.other if conflict.robot == person.robot else conflict.robot
            seconds = conflict.begins - now
            if seconds <= limits.within_s and (person.robot, robot) not in found:
                x, y = person.at([conflict.begins])[0].tolist()
                meeting = Meeting(person.robot, robot, limits.metres, seconds, (x, y))
                found[meeting.pair] = meeting
    return sorted(found.values(), key=lambda one: (one.seconds, one.metres, one.pair))


def _near_now(
    people: Sequence[Movement],
    robots: Sequence[Movement],
    metres: float,
    now: float,
    near: Container[Pair],
) -> list[Meeting]:
    here, there = (np.concatenate([one.at([now]) for one in some]) for some in (people, robots))
    apart = np.hypot(*(here[:, None, :] - there[None, :, :]).T).T
    found = []
    for i, j in np.argwhere(apart <= metres + MARGIN_M).tolist():
        pair, distance = (people[i].robot, robots[j].robot), float(apart[i, j])
        if distance <= metres or pair in near:
            x, y = here[i].tolist()
            found.append(Meeting(*pair, distance, 0.0, (x, y)))
    return found


# --- Watch: people and vehicles that are only seen are compared with robots, and operators notified

log = logging.getLogger(__name__)

REPORT_EVERY_S = 1.0
MOST_ALARMS = 300
SLOWEST_MS = 0.3
"""m/s below which a mover counts as standing: receivers at rest report some decimetres a second."""
FASTEST_MS = 40.0
"""m/s assumed at most in the selection of those who can meet at all."""
REPLAY = "replay"
"""Kind of links with robots of a recording, which cannot be near to anybody."""
CONNECTED = (RobotState.FRESH, RobotState.STALE)


class NearnessWatch:
    """Compares all that is only seen with all robots, several times a second; it stops no robot.

    Every operator is notified through ``listeners``.
    """

    def __init__(
        self,
        robots: Robots,
        links: LinkWatch,
        traffic: TrafficControl,
        site: ServedSite,
        clock: Clock,
        listeners: Listeners,
    ) -> None:
        self._robots = robots
        self._links = links
        self._traffic = traffic
        self._site = site
        self._clock = clock
        self._listeners = listeners
        self._since: dict[Pair, tuple[bool, float]] = {}
        """For each pair whether it is near now, and since when this or the prediction holds."""
        self._found: list[Meeting] = []
        self._fault: str | None = None
        self._last_report: tuple[float, bool] = (-math.inf, False)
        """Time of the last notification, and whether it had any pairs."""

    async def watch(self) -> None:
        """Judge the present positions, and notify operators."""
        now, limits = self._clock.time(), self._site.settings.nearness
        try:
            found = await self._meetings(now, NearnessLimits(limits.metres, limits.within_s))
        except Exception as error:
            if self._fault is None:
                log.exception("people and trackers near robots cannot be watched")
            self._fault, found = f"it cannot be judged: {error}", []
        else:
            self._fault = None
        self._record(found)
        self._notify()

    def report(self) -> Nearness:
        """Return the report for operators."""
        limits, now = self._site.settings.nearness, self._clock.time()
        alarms = [
            NearnessAlarm(
                one.seen,
                one.robot,
                round(one.metres, 1),
                round(one.seconds, 1),
                round(one.place[0], 2),
                round(one.place[1], 2),
                self._since[one.pair][1],
            )
            for one in self._found[:MOST_ALARMS]
        ]
        more = max(len(self._found) - MOST_ALARMS, 0)
        return Nearness(now, limits.metres, limits.within_s, alarms, more, self._fault)

    async def _meetings(self, now: float, limits: NearnessLimits) -> list[Meeting]:
        if limits.metres <= 0:
            return []
        seen = [one for one in self._robots.only_seen() if self._is_seen(one)]
        people = [_mover(one, one.pose) for one in seen if one.located and one.pose]
        if not people:
            return []
        located = [(one, one.pose) for one in self._robots.changed(-1) if one.located and one.pose]
        reach = limits.metres + MARGIN_M + limits.within_s * 2 * FASTEST_MS
        tasked = [
            _mover(robot, pose)
            for robot, pose in located
            if robot.abilities != "" and robot.state is not RobotState.OFFLINE
        ]
        robots = _within(tasked, people, reach)
        near = {pair for pair, (is_near, _) in self._since.items() if is_near}
        situation = self._traffic.situation({one.name for one in robots})
        return await asyncio.to_thread(_judged, people, robots, situation, limits, near)

    def _is_seen(self, robot: Robot) -> bool:
        """Return whether a robot is only seen and has a known position now: one that is lost has none."""
        replayed = self._links.kind_of(robot.link) == REPLAY
        return robot.state in CONNECTED and not replayed

    def _record(self, found: list[Meeting]) -> None:
        now = self._clock.time()
        since = {}
        for one in found:
            is_near = one.seconds == 0.0
            was_near, began = self._since.get(one.pair, (not is_near, now))
            since[one.pair] = is_near, began if was_near is is_near else now
            if is_near and not (was_near and one.pair in self._since):
                log.warning("%s is %.1f m from robot %s", one.seen, one.metres, one.robot)
        self._since, self._found = since, found

    def _notify(self) -> None:
        reported_at, was_near = self._last_report
        something = bool(self._found or self._fault)
        if something is not was_near or (something and time.monotonic() - reported_at >= REPORT_EVERY_S):
            self._last_report = time.monotonic(), something
            self._listeners.announce("nearness", "nearness", to_json(self.report()))


def _mover(robot: Robot, pose: SendPos) -> Mover:
    # One without a known heading counts as standing.
    goes = abs(pose.v) >= SLOWEST_MS and pose.theta_from != "unknown"
    velocity = (pose.v * math.cos(pose.theta), pose.v * math.sin(pose.theta)) if goes else (0.0, 0.0)
    return Mover(robot.name, (pose.x, pose.y), velocity)


def _within(robots: list[Mover], people: list[Mover], reach: float) -> list[Mover]:
    """Return the robots that any of ``people`` could come near to."""
    if not robots:
        return []
    here, there = (np.array([one.place for one in some]) for some in (robots, people))
    apart = np.hypot(*(here[:, None, :] - there[None, :, :]).T).T
    return [robots[row] for row in np.flatnonzero((apart <= reach).any(axis=1)).tolist()]


def _judged(
    people: list[Mover],
    robots: list[Mover],
    situation: TrafficSnapshot,
    limits: NearnessLimits,
    near: set[Pair],
) -> list[Meeting]:
    """Return the near pairs; robots continue along their paths where known, all else straight on."""
    now, seconds = situation.now, limits.within_s
    on_ways = situation.movements()
    moving = [
        replace(on_ways[one.name], radius=0.0)
        if one.name in situation.on_the_way
        else one.straight_on(now, seconds)
        for one in robots
    ]
    return find_meetings([one.straight_on(now, seconds) for one in people], moving, limits, now, near)
