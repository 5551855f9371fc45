"""Localisation concurrent with driving: nothing waits for the filter."""

from __future__ import annotations

import logging
import math
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...core.robotmap.model import RobotMap
from ..body import before_border
from . import sensors
from .particle_filter import ParticleFilter
from .segments import distances
from .settings import FilterSettings, LaserSettings, ReferenceRobotError
from .world import Walls, walls_of

log = logging.getLogger(__name__)

_FRAME = ("crs", "origin", "rotation")


@dataclass(frozen=True)
class Estimate:
    """The filter's belief after reading ``number``; ``accuracy`` is a standard deviation in metres."""

    number: int
    pose: sensors.TruePose
    accuracy: float
    lost: bool
    agreement: float
    particles: int = 0
    sees_nothing: bool = False


@dataclass(frozen=True)
class InitialBelief:
    """The robot's pose estimate at power-on; ``deviation`` in metres and radians."""

    pose: sensors.TruePose
    deviation: tuple[float, float] = (0.1, 0.05)
    unknown: bool = False


@dataclass(frozen=True)
class LocaliserSettings:
    """Settings of laser, filter and body; ``fix_noise`` is the GPS receiver's, metres."""

    laser: LaserSettings
    filter: FilterSettings
    reach: sensors.BodyReach
    fix_noise: float = 1.5
    compiled: bool | None = field(default=None)


class Localiser:
    """Passes readings to a particle filter that works on ``executor``, one after the other.

    :attr:`pose` is the newest belief, updated by the motion measured since. :attr:`trouble` is why the robot
        must not drive by it. Call all methods from one thread.
    """

    def __init__(
        self, settings: LocaliserSettings, start: InitialBelief, rng: np.random.Generator, executor: Executor
    ) -> None:
        self._settings = settings
        self._standing = settings.filter.standing
        self._start: InitialBelief | None = start
        self._rng = rng
        self._executor = executor
        self._filter: ParticleFilter | None = None
        """Accessed only by work on the executor."""
        self._quiet_scans = 0
        self._expected: sensors.TruePose | None = None
        """The pose by the wheels since it last knew its place; also accessed only on the executor."""
        self._fixed: tuple[float, float] | None = None
        self._fixed_for = 0.0
        """Metres driven since the newest GPS position."""
        self._walls: Walls | None = None
        self._work: Future[Estimate] | None = None
        self._work_t = 0.0
        self._next_map: RobotMap | None = None
        """The map that the filter uses from its next reading on."""
        self._tried: tuple[RobotMap | None, InitialBelief | None] = None, None
        self._owed: list[sensors.Motion] = []
        """Motions that the filter does not have yet, because it was busy."""
        self._number = 0
        self._since: list[tuple[int, sensors.Motion]] = []
        """Motions by the number of their reading that the newest estimate does not include."""
        self._estimate = Estimate(0, start.pose, start.deviation[0], True, 0.0)
        self._fault: str | None = None
        self._failure: str | None = None
        self._missed = False
        self._last_t: float | None = None
        self._done_t: float | None = None
        self._worst = 0.0
        self.map: RobotMap | None = None

    @property
    def pose(self) -> sensors.TruePose:
        """The robot's pose estimate as of the newest reading."""
        pose = self._estimate.pose
        for _, motion in self._since:
            pose = sensors.moved(pose, motion)
        return pose

    @property
    def lost(self) -> bool:
        """Whether the robot does not know its place."""
        return self._estimate.lost

    @property
    def accuracy(self) -> float:
        """The standard deviation of the position in metres; for a lost robot the worst so far."""
        return max(self._estimate.accuracy, self._worst)

    @property
    def agreement(self) -> float:
        """The share of the newest scan's beams that match the map."""
        return self._estimate.agreement

    @property
    def particles(self) -> int:
        """How many particles there are."""
        return self._estimate.particles

    @property
    def trouble(self) -> str | None:
        """Why the robot must not drive, None when it knows where it is."""
        self._collect()
        if self.map is None:
            return "it has no map yet"
        if self._failure is not None:
            return self._failure
        if self._fault is not None:
            return self._fault
        if self._is_late():
            late = self._standing.late
            return f"the filter is more than {late:g} s behind the sensors; give it more processor time"
        if self._estimate.sees_nothing:
            return "nothing of its map is within the reach of its laser; lead it to where something is"
        if self._estimate.lost:
            fits = 100 * self._estimate.agreement
            return (
                f"it does not know its place ({fits:.0f} % of its scan fits the map); tell it where it is "
                "by a start position, or wait"
            )
        x, y, _ = self.pose
        if before_border(self.map, x, y) < self._standing.border:
            return "it is at the border of its map, and was not sent the next one yet"
        return None

    def use_map(self, robot_map: RobotMap) -> None:
        """Switch to another map, or begin with the first one.

        :raises ReferenceRobotError: for a map of another frame, one that does not hold the robot's place, and
            one without anything that the laser can see; the old one is kept.
        """
        self._check(robot_map)
        self.map = robot_map
        self._next_map = robot_map

    def place(self, start: InitialBelief) -> None:
        """Set the estimate to ``start``, regardless of the filter's belief."""
        self._start = start
        self._estimate = Estimate(self._number, start.pose, start.deviation[0], True, 0.0)
        self._since, self._owed, self._worst = [], [], 0.0

    def observe(self, reading: sensors.SensorReading) -> None:
        """Pass a reading to the filter, now or, while it is busy, with the next one."""
        self._collect()
        before, self._last_t = self._last_t, reading.t
        if self._done_t is None:
            self._done_t = reading.t
        fault = sensors.motion_fault(reading, before, self._settings.reach, self._standing)
        if fault is not None:
            # The motion meanwhile is unknown: the filter doubts its place.
            self._fault, self._missed, self._done_t = fault, True, reading.t
            return
        self._number += 1
        self._since.append((self._number, reading.motion))
        self._owed.append(reading.motion)
        self._fault = sensors.scan_fault(reading, self._settings.laser.beams)
        if self._fault is not None or self.map is None:
            self._done_t = reading.t
            return
        if self._work is None:
            self._begin_work(reading)

    def _begin_work(self, reading: sensors.SensorReading) -> None:
        motions, missed = self._owed, self._missed
        self._tried = self._next_map, self._start
        self._next_map, self._owed, self._start, self._missed = None, [], None, False
        self._work_t = reading.t
        self._work = self._executor.submit(self._update, self._number, *self._tried, motions, reading, missed)
        self._collect()

    def _collect(self) -> None:
        """Apply the filter's result, if there is one."""
        work = self._work
        if work is None or not work.done():
            return
        self._work, self._done_t = None, self._work_t
        error = work.exception()
        if error is not None:
            log.error("localisation: %s", error, exc_info=error)
            self._failure, self._missed = f"localisation failed: {error}", True
            robot_map, start = self._tried
            self._next_map, self._start = self._next_map or robot_map, self._start or start
            return
        self._failure = None
        if self._start is not None:
            # The place was set meanwhile.
            return
        estimate = self._estimate = work.result()
        worst = max(self._worst, estimate.accuracy, self._standing.lost_accuracy)
        self._worst = worst if estimate.lost else 0.0
        self._since = [(number, motion) for number, motion in self._since if number > estimate.number]

    def _is_late(self) -> bool:
        if self._last_t is None or self._done_t is None:
            return False
        return self._last_t - self._done_t > self._standing.late

    def _check(self, robot_map: RobotMap) -> None:
        known = self.map
        name = robot_map.meta.get("id", "without id")
        for key in _FRAME if known is not None else ():
            assert known is not None
            here, there = known.meta.get(key), robot_map.meta.get(key)
            if here != there:
                raise ReferenceRobotError(
                    f"map {name}: its {key} is {there}, that of the robot's map {here}: it is "
                    "of another site; the robot keeps the map that it has"
                )
        if not len(walls_of(robot_map).higher_than(self._settings.laser.height)):
            raise ReferenceRobotError(
                f"map {name}: nothing on it is higher than the laser, {self._settings.laser.height} m; "
                "ask for a larger map, or one of this place"
            )
        x, y, _ = self.pose
        unknown = self._start is not None and self._start.unknown
        if not unknown and not (known is not None and self.lost) and not robot_map.border.holds(x, y):
            raise ReferenceRobotError(
                f"map {name}: the robot takes itself to be at ({x:.1f}, {y:.1f}), which is not on it; "
                "ask for the map around there"
            )

    # The following methods run on the executor.

    def _update(
        self,
        number: int,
        robot_map: RobotMap | None,
        start: InitialBelief | None,
        motions: list[sensors.Motion],
        reading: sensors.SensorReading,
        missed: bool,
    ) -> Estimate:
        if robot_map is not None:
            self._exchange_map(robot_map)
        tracking = self._filter
        assert tracking is not None
        ranges = sensors.without_negatives(reading.ranges)
        if start is not None:
            self._begin(tracking, start, motions, ranges)
        else:
            self._follow(tracking, motions, ranges, missed)
        if reading.fix is not None:
            self._fixed, self._fixed_for = reading.fix, 0.0
            tracking.observe_fix(*reading.fix, self._settings.fix_noise)
        belief = tracking.belief
        if not belief.lost:
            self._expected = belief.pose
        accuracy = max(belief.accuracy, belief.spread) if belief.lost else belief.accuracy
        count = len(tracking.particles)
        nothing = self._fixed is None and self._sees_nothing(belief.pose, ranges)
        return Estimate(number, belief.pose, accuracy, belief.lost, belief.agreement, count, nothing)

    def _sees_nothing(self, pose: sensors.TruePose, ranges: Any) -> bool:
        """Return whether neither the scan nor the map has anything there: then places cannot be
        distinguished."""
        reach = self._settings.laser.reach
        if np.count_nonzero(ranges < reach) > self._standing.few_echoes or self._walls is None:
            return False
        return bool(distances(np.array(pose[:2]), self._walls.a, self._walls.b).min() > reach)

    def _begin(
        self, tracking: ParticleFilter, start: InitialBelief, motions: list[sensors.Motion], ranges: Any
    ) -> None:
        self._quiet_scans, self._fixed = 0, None
        if start.unknown:
            self._expected = None
            tracking.search(ranges)
            return
        self._expected = start.pose
        tracking.place(start.pose, start.deviation)
        for motion in motions:
            tracking.move(motion)
        tracking.observe(ranges)

    def _follow(
        self, tracking: ParticleFilter, motions: list[sensors.Motion], ranges: Any, missed: bool
    ) -> None:
        standing = self._standing
        for motion in motions:
            tracking.move(motion)
            if self._expected is not None:
                self._expected = sensors.moved(self._expected, motion)
        if missed:
            tracking.doubt()
        if any(abs(m.distance) > standing.still_m or abs(m.turn) > standing.still_rad for m in motions):
            self._quiet_scans = 0
            self._fixed_for += sum(abs(motion.distance) for motion in motions)
            self._fixed = self._fixed if self._fixed_for < self._settings.filter.gps.lasts else None
            tracking.observe(ranges)
            return
        self._quiet_scans += 1
        lost = tracking.belief.lost
        if lost or self._quiet_scans % standing.scans == 0:
            tracking.jitter(standing.jitter_m, standing.jitter_rad)
            tracking.observe(ranges)
        if lost and self._is_expected(tracking.belief.pose):
            tracking.settle(standing.scan_worth)

    def _is_expected(self, pose: sensors.TruePose) -> bool:
        places = (self._expected, self._fixed)
        within = self._standing.expected
        return any(one is not None and math.dist(pose[:2], one[:2]) < within for one in places)

    def _exchange_map(self, robot_map: RobotMap) -> None:
        self._walls = walls_of(robot_map).higher_than(self._settings.laser.height)
        if self._filter is not None:
            self._filter.use_map(robot_map)
            return
        settings = self._settings
        self._filter = ParticleFilter(
            robot_map, settings.laser, settings.filter, self._rng, settings.compiled
        )
