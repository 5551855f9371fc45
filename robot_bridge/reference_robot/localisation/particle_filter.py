"""Particle filter: the robot's pose on its map, by wheels, gyroscope and laser.

Monte Carlo localisation with a number of particles by KLD sampling and augmented recovery (Thrun, Burgard,
Fox: Probabilistic Robotics, chapter 8).
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.robotmap.model import RobotMap
from . import scan_matching
from .sensors import Motion, TruePose, bearings_of, moved
from .settings import FilterSettings, LaserSettings, ReferenceRobotError
from .world import walls_of


@dataclass(frozen=True, eq=False)
class Belief:
    """The robot's pose estimate.

    ``covariance`` is (3, 3) of x, y and theta, m² and rad²: the particles' own, plus the effect of systematic
    errors of the wheels; ``share`` of the particles' weight is near ``pose``; ``lost`` says that the robot
    does not know its place, not for sure yet, or not well enough; ``agreement`` is the share of the last
    scan's beams that match the map; ``spread`` is the distance of all particles from ``pose``, metres (root
    mean square).
    """

    pose: TruePose
    covariance: NDArray[Any]
    share: float
    lost: bool
    agreement: float
    spread: float

    @property
    def accuracy(self) -> float:
        """The standard deviation of the position along the axis on which it is largest, metres."""
        return _largest_deviation(self.covariance)


class ParticleFilter:
    """Tracks the robot on ``robot_map``; ``rng`` is its only source of randomness.

    ``compiled`` is as in :class:`.RayCaster`.

    Call :meth:`place` or :meth:`search` first, then :meth:`move` and :meth:`observe` alternately.
    """

    def __init__(
        self,
        robot_map: RobotMap,
        laser: LaserSettings,
        settings: FilterSettings,
        rng: np.random.Generator,
        compiled: bool | None = None,
    ) -> None:
        self._settings = settings
        self._compiled = compiled
        self._laser = laser
        self._rng = rng
        self._bearings = bearings_of(laser)
        self.use_map(robot_map)
        self.particles = np.zeros((1, 3))
        """(N, 3): x, y in metres and theta in radians."""
        self.weights = np.ones(1)
        """(N,), of sum 1."""
        self._slow = self._fast = 0.0
        self._agreement = 0.0
        self._since_scan = math.inf
        """Metres driven, and radians turned, since a scan was weighed."""
        self._by_scale: NDArray[Any] = np.zeros(2)
        """Error of the belief in metres per unit error of the wheels' scale, (2,)."""
        self._unsettled = 0.0
        """metres to drive until the place counts as found."""
        self._since_search = (math.inf, 0)
        self._fix: tuple[float, float, float] | None = None
        self._since_fix = 0.0
        self._against: deque[bool] = deque(maxlen=settings.gps.of)
        """Whether each of the newest GPS positions is far from the belief."""
        self._rival = False
        """Whether another place had weight left at the lost robot's last search for places."""
        self._place: TruePose | None = None
        """The one place that the particles have been at while it counts as lost, moved on by the wheels."""

    def use_map(self, robot_map: RobotMap) -> None:
        """Switch to another map of the same frame.

        :raises ReferenceRobotError: for one without visible obstacles.
        """
        walls = walls_of(robot_map).higher_than(self._laser.height)
        if not len(walls):
            raise ReferenceRobotError(
                f"map {robot_map.meta.get('id', 'without id')}: nothing on it is higher than the laser, "
                f"{self._laser.height} m; ask for a larger map, or one of this place"
            )
        self._map = robot_map
        self._model: scan_matching.BeamModel | scan_matching.FieldModel
        if self._settings.model == "beam":
            self._model = scan_matching.BeamModel(walls, self._laser, self._settings, self._compiled)
        else:
            self._model = scan_matching.FieldModel(walls, self._laser, self._settings)
        self._search: scan_matching.PlaceSearch | None = None

    def place(self, pose: TruePose, deviation: tuple[float, float]) -> None:
        """Begin at ``pose``, known to ``deviation`` metres and radians (standard deviations)."""
        metres, radians = deviation
        spread = self._rng.normal(0, (metres, metres, radians), (self._settings.most, 3))
        poses = np.asarray(pose) + spread
        self._begin(
            poses[
                : scan_matching.particles_for(
                    scan_matching.occupied_bins(poses, self._settings), self._settings
                )
            ]
        )

    def search(self, ranges: NDArray[Any]) -> None:
        """Begin where a first scan, (B,), fits, anywhere on the map: global localisation.

        :raises ReferenceRobotError: for a scan without information.
        """
        used = self._used(ranges)
        if not len(used):
            raise ReferenceRobotError("scan: no beam has a reading; the robot cannot look for its place")
        search = self._settings.search
        self._begin(self._likely(self._settings.most, (search.per_area, search.most), ranges, used))
        self._unsettled = self._settings.recovery.settled

    def move(self, motion: Motion) -> None:
        """Move all particles by the odometry, each with its own noise."""
        settings, rng, count = self._settings, self._rng, len(self.particles)
        far = abs(motion.distance)
        root = math.sqrt(far)
        if self._place is not None:
            self._unsettled = max(0.0, self._unsettled - far)
            self._place = moved(self._place, motion)
        self._since_fix += far
        # A turn of a radian changes the view as much as a metre of driving.
        self._since_scan += far + abs(motion.turn)
        self._since_search = self._since_search[0] + far, self._since_search[1]
        drift = math.radians(settings.drift_deg)
        distance = rng.normal(motion.distance, settings.distance_noise * root + 1e-9, count)
        turn_noise = math.hypot(settings.turn_noise * motion.turn, drift * root) + 1e-9
        turn = rng.normal(motion.turn, turn_noise, count)
        side = rng.normal(0, settings.slip * root + 1e-9, count)
        x, y, theta = self.particles.T
        middle = theta + turn / 2
        cos, sin = np.cos(middle), np.sin(middle)
        self._by_scale = self._by_scale + motion.distance * np.array([self.weights @ cos, self.weights @ sin])
        self.particles = np.column_stack(
            [x + distance * cos - side * sin, y + distance * sin + side * cos, theta + turn]
        )

    def jitter(self, metres: float, radians: float) -> None:
        """Spread all particles a little (standard deviations), as moving does."""
        self._since_scan += self._settings.standing.scan_worth
        spread = self._rng.normal(0, (metres, metres, radians), self.particles.shape)
        self.particles = self.particles + spread

    def doubt(self) -> None:
        """Count the place as uncertain: missed readings may have changed it."""
        self._unsettled = self._settings.recovery.settled

    def settle(self, metres: float) -> None:
        """Count ``metres`` of driving towards a certain place."""
        if self._place is not None:
            self._unsettled = max(0.0, self._unsettled - metres)

    def observe(self, ranges: NDArray[Any]) -> None:
        """Weigh all particles by a scan, (B,) metres: NaN without reading, infinite without echo.

        :raises ReferenceRobotError: for a scan of another number of beams; one without any reading changes
            nothing.
        """
        used = self._used(ranges)
        if not len(used):
            return
        fit, agreement = self._model.log_likelihood(self.particles, self._bearings[used], ranges[used])
        average = float(self.weights @ agreement)
        worth = min(self._settings.beams_of_worth, len(used)) * self._scan_worth()
        logs = np.log(np.maximum(self.weights, 1e-300)) + worth * fit
        self._weigh(np.exp(logs - logs.max()))
        self._agreement = float(self.weights @ agreement)
        self._fast += self._settings.fast * (average - self._fast) if self._fast else average
        if not self._unsettled:
            # The usual agreement is unknown before the place is known.
            self._slow += self._settings.slow * (average - self._slow) if self._slow else self._fast
        if self._fast < self._settings.least_agreement:
            self._unsettled = self._settings.recovery.settled
        self._resample(ranges, used)
        self._compare_places()

    def observe_fix(self, x: float, y: float, deviation: float) -> None:
        """Weigh all particles by a GPS position, metres, of which ``deviation`` is the standard deviation.

        Several distant ones show that the belief is wrong.

        :raises ReferenceRobotError: for one that is not finite.
        """
        if not (math.isfinite(x) and math.isfinite(y)):
            raise ReferenceRobotError(f"GPS position ({x}, {y}) is not finite; check the receiver")
        self._fix, self._since_fix = (x, y, deviation), 0.0
        squares = np.square(self.particles[:, :2] - (x, y)).sum(axis=1) / deviation**2
        self._weigh(self.weights * (np.exp(-0.5 * squares) + self._settings.gps.wrong))
        believed_x, believed_y, _ = self.belief.pose
        away = math.hypot(believed_x - x, believed_y - y)
        self._against.append(away > self._settings.gps.far * deviation)
        if sum(self._against) >= self._settings.gps.against:
            self._unsettled = self._settings.recovery.settled

    @property
    def belief(self) -> Belief:
        """The most likely pose of the robot."""
        near = self._together()
        weights = self.weights[near]
        share = float(weights.sum())
        weights = weights / share
        poses = self.particles[near]
        theta = math.atan2(weights @ np.sin(poses[:, 2]), weights @ np.cos(poses[:, 2]))
        place = weights @ poses[:, :2]
        off = np.column_stack([poses[:, :2] - place, _wrapped(poses[:, 2] - theta)])
        covariance = (weights[:, None] * off).T @ off
        by_scale = self._settings.wheel_scale * self._by_scale
        covariance[:2, :2] += np.outer(by_scale, by_scale)
        lost = self._unsettled > 0 or not share >= self._settings.recovery.share
        lost = lost or _largest_deviation(covariance) >= self._settings.standing.lost_accuracy
        apart = self.particles[:, :2] - place
        spread = math.sqrt(float(self.weights @ np.square(apart).sum(axis=1)))
        pose = float(place[0]), float(place[1]), theta
        return Belief(pose, covariance, share, lost, self._agreement, spread)

    def _scan_worth(self) -> float:
        """Return the share of a scan's weight that counts: scans of the same walls have the same errors."""
        far, self._since_scan = self._since_scan, 0.0
        if self._unsettled:
            return self._settings.recovery.scan_worth
        return min(1.0, far / self._settings.same_walls)

    def _weigh(self, weights: NDArray[Any]) -> None:
        """Set the particles' weights, (N,), of any sum.

        The closer together the particles then are, the smaller is the remaining effect of the wheels' scale:
        the gain of a Schmidt-Kalman filter, which considers an error without estimating it.
        """
        before = self._place_covariance()
        self.weights = weights / weights.sum()
        if self._unsettled:
            # Its place is found by scans, not by wheels.
            self._by_scale = np.zeros(2)
            return
        self._by_scale = self._place_covariance() @ np.linalg.solve(before, self._by_scale)

    def _place_covariance(self) -> NDArray[Any]:
        off = self.particles[:, :2] - self.weights @ self.particles[:, :2]
        # A millimetre, so that particles in one place have an inverse.
        covariance: NDArray[Any] = (self.weights[:, None] * off).T @ off + 1e-6 * np.eye(2)
        return covariance

    def _compare_places(self) -> None:
        """Restart the count when a lost robot's most likely place has changed."""
        if not self._unsettled:
            self._place = None
            return
        belief = self.belief
        recovery = self._settings.recovery
        alone = belief.share >= recovery.share and not self._rival
        before, self._place = self._place, belief.pose if alone else None
        if self._place is None:
            return
        if before is None or math.dist(before[:2], self._place[:2]) > recovery.place_m:
            self._unsettled = recovery.settled

    def _used(self, ranges: NDArray[Any]) -> NDArray[Any]:
        if ranges.shape != self._bearings.shape:
            raise ReferenceRobotError(
                f"scan: {ranges.shape} ranges for {len(self._bearings)} beams; see the laser's settings"
            )
        return scan_matching.usable_beams(ranges)

    def _begin(self, particles: NDArray[Any]) -> None:
        self.particles = particles
        self.weights = np.full(len(particles), 1 / len(particles))
        self._slow = self._fast = 0.0
        self._since_scan, self._by_scale = math.inf, np.zeros(2)
        self._unsettled, self._place, self._rival = 0.0, None, False
        self._against.clear()

    def _together(self) -> NDArray[Any]:
        """Return the particles around the heaviest place: those of its cell, then those near their mean."""
        recovery = self._settings.recovery
        bins = scan_matching.bins_of(self.particles, recovery.place_m, math.radians(recovery.group_deg))
        _, row = np.unique(bins, return_inverse=True)
        near = np.flatnonzero(row == np.bincount(row, weights=self.weights).argmax())
        for _ in range(3):
            weights = self.weights[near]
            place = weights @ self.particles[near, :2] / weights.sum()
            theta = math.atan2(
                weights @ np.sin(self.particles[near, 2]), weights @ np.cos(self.particles[near, 2])
            )
            away = np.hypot(*(self.particles[:, :2] - place).T)
            turned = np.abs(_wrapped(self.particles[:, 2] - theta))
            found = np.flatnonzero((away < recovery.place_m) & (turned < math.radians(recovery.place_deg)))
            if len(found) and self.weights[found].sum() > 0:
                near = found
        return near

    def _resample(self, ranges: NDArray[Any], used: NDArray[Any]) -> None:
        settings, rng, recovery = self._settings, self._rng, self._settings.recovery
        lost = max(0.0, 1 - self._fast / (settings.recover * self._slow)) if self._slow else 0.0
        if lost:
            self._unsettled = recovery.settled
        metres, scans = self._since_search
        self._since_search = metres, scans + 1
        due = metres >= recovery.look_every_m or scans >= recovery.look_every_scans
        looks = self._unsettled > 0 and due
        crowd = 1 / float(self.weights @ self.weights)
        if not looks and crowd > len(self.weights) / 2:
            return
        if looks:
            self._rival = self.belief.share < 1 - recovery.rival
        drawn = self.particles[scan_matching.low_variance(self.weights, len(self.weights), rng)]
        count = scan_matching.particles_for(scan_matching.occupied_bins(drawn, settings), settings)
        new = int(rng.binomial(count, max(lost, recovery.new_particles))) if looks else 0
        if self._unsettled:
            group = scan_matching.bins_of(self.particles, recovery.group_m, math.radians(recovery.group_deg))
            rows, weights = scan_matching.in_groups(self.weights, group, count - new, rng, recovery)
        else:
            rows = scan_matching.low_variance(self.weights, count - new, rng)
            weights = np.full(len(rows), 1 / len(rows))
        particles = self.particles[rows]
        if new:
            self._since_search = 0.0, 0
            again = settings.search.again_per_area, settings.search.again_most
            particles = np.concatenate([particles, self._likely(new, again, ranges, used)])
            share = new / count
            weights = np.concatenate([weights * (1 - share), np.full(new, share / new)])
        self.particles = particles
        self.weights = weights

    @property
    def _near(self) -> tuple[float, float, float] | None:
        """The newest GPS position, x, y and deviation, if still valid for searching."""
        return self._fix if self._since_fix <= self._settings.gps.lasts else None

    def _likely(
        self, count: int, looked_at: tuple[float, int], ranges: NDArray[Any], used: NDArray[Any]
    ) -> NDArray[Any]:
        """Return poses where the scan fits, (count, 3)."""
        if self._search is None:
            walls = walls_of(self._map).higher_than(self._laser.height)
            self._search = scan_matching.PlaceSearch(
                self._map, walls, self._laser, self._settings, self._model
            )
        near = self._near
        if near is not None:
            near = near[0], near[1], near[2] + self._since_fix
        per_area, most = looked_at
        poses = int(min(per_area * self._map.border.area, most))
        if near is not None:
            poses = self._settings.search.near_fix
        return self._search.likely(count, max(poses, 1), self._bearings[used], ranges[used], self._rng, near)


def _wrapped(angle: NDArray[Any]) -> NDArray[Any]:
    wrapped: NDArray[Any] = (angle + np.pi) % (2 * np.pi) - np.pi
    return wrapped


def _largest_deviation(covariance: NDArray[Any]) -> float:
    return math.sqrt(max(float(np.linalg.eigvalsh(covariance[:2, :2])[-1]), 0.0))
