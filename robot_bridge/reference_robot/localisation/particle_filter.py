"""Where the robot is, by what its wheels, gyroscope and laser say, on the map that it has.

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
from .scan_matching import (
    BeamModel,
    FieldModel,
    PlaceSearch,
    bins_of,
    in_groups,
    low_variance,
    occupied_bins,
    particles_for,
    usable_beams,
)
from .sensors import Motion, TruePose, bearings_of, moved
from .settings import FilterSettings, LaserSettings, ReferenceRobotError
from .world import walls_of

SEARCHED = 85.0, 1_500_000
"""poses for each m² are compared when the robot may be anywhere, and the most of them on a large map."""
LOOKED_AT = 12.0, 200_000
"""the same at each look for other places while the robot is lost."""
AROUND = 6_000
"""poses are compared when a GPS position tells where to look."""
SETTLED = 15.0
"""metres to drive after a search, or after scan and map did not agree, until the robot is no longer lost.

All of them at one place, moved on by the wheels: driving does not count while the particles are in several,
and begins again when another place comes to fit better. Until then other places are looked for as well: one
may fit by chance.
"""
MOST_OF_THEM = 0.8
"""of the particles' weight is near the belief of a robot that is not lost."""
DOUBT = 0.1
"""Of the particles, the share that is put at such places."""
LOOK_EVERY = 1.0, 10
"""metres or scans, whichever comes first, between two looks for other places."""
FIX_LASTS = 10.0
"""metres of driving after which a GPS position says nothing any more of where to look."""
FIX_WRONG = 1e-3
"""The likelihood of any position, however far away, beside that of a right one, which is 1."""
FIX_FAR, FIX_OFTEN = 4.0, (2, 3)
"""Standard deviations from the belief, and how many of the newest positions: the belief is wrong.

Not all in a row: a belief that drives the same alley the other way comes by the robot's true place.
"""
WORTH_WHILE_LOST = 0.25
"""Of a scan's worth, while places are compared: in each of them the same walls are wrong scan after scan."""
GROUP = 4.0, math.pi / 4
"""metres and radians: while it is lost, places in as large bins are resampled apart."""
APART = (2.0, math.radians(30))
"""metres and radians from the middle of the belief within which particles count for it."""


@dataclass(frozen=True, eq=False)
class Belief:
    """Where the robot takes itself to be.

    ``covariance`` is (3, 3) of x, y and theta, m² and rad²; ``share`` of the particles' weight is near
    ``pose``; ``lost`` says that the robot does not know its place, or not
    for sure yet; ``agreement`` is the share of the last scan's beams that are where the map has something;
    ``spread`` is how far all particles are from ``pose``, metres (root mean square).
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
        return math.sqrt(max(float(np.linalg.eigvalsh(self.covariance[:2, :2])[-1]), 0.0))


class ParticleFilter:
    """Tracks the robot on ``robot_map``; ``rng`` is all its randomness.

    ``compiled`` is as in :class:`.RayCaster`.

    Call :meth:`place` or :meth:`search` first, then :meth:`move` and :meth:`observe` by turns.
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
        self._unsettled = 0.0
        """metres to drive until the place counts as found."""
        self._since_look = (math.inf, 0)
        self._fix: tuple[float, float, float] | None = None
        self._since_fix = 0.0
        self._against: deque[bool] = deque(maxlen=FIX_OFTEN[1])
        """Which of the newest GPS positions are far from the belief."""
        self._place: TruePose | None = None
        """The one place that the particles have been at while it counts as lost, moved on by the wheels."""

    def use_map(self, robot_map: RobotMap) -> None:
        """Go on with another map of the same frame.

        :raises ReferenceRobotError: for one with nothing to see.
        """
        walls = walls_of(robot_map).higher_than(self._laser.height)
        if not len(walls):
            raise ReferenceRobotError(
                f"map {robot_map.meta.get('id', 'without id')}: nothing on it is higher than the laser, "
                f"{self._laser.height} m; ask for a larger map, or one of this place"
            )
        self._map = robot_map
        self._model: BeamModel | FieldModel
        if self._settings.model == "beam":
            self._model = BeamModel(walls, self._laser, self._settings, self._compiled)
        else:
            self._model = FieldModel(walls, self._laser, self._settings)
        self._search: PlaceSearch | None = None

    def place(self, pose: TruePose, deviation: tuple[float, float]) -> None:
        """Begin at ``pose``, known to ``deviation`` metres and radians (standard deviations)."""
        metres, radians = deviation
        spread = self._rng.normal(0, (metres, metres, radians), (self._settings.most, 3))
        poses = np.asarray(pose) + spread
        self._begin(poses[: particles_for(occupied_bins(poses, self._settings), self._settings)])

    def search(self, ranges: NDArray[Any]) -> None:
        """Begin where a first scan, (B,), fits, anywhere on the map: global localisation.

        :raises ReferenceRobotError: for a scan that says nothing.
        """
        used = self._used(ranges)
        if not len(used):
            raise ReferenceRobotError("scan: no beam has a reading; the robot cannot look for its place")
        self._begin(self._likely(self._settings.most, SEARCHED, ranges, used))
        self._unsettled = SETTLED

    def move(self, motion: Motion) -> None:
        """Move all particles as the odometry says, each a little otherwise."""
        settings, rng, count = self._settings, self._rng, len(self.particles)
        far = abs(motion.distance)
        if self._place is not None:
            self._unsettled = max(0.0, self._unsettled - far)
            self._place = moved(self._place, motion)
        self._since_fix += far
        self._since_look = self._since_look[0] + far, self._since_look[1]
        drift = math.radians(settings.drift_deg)
        distance = rng.normal(motion.distance, settings.distance_noise * far + 1e-9, count)
        turn_noise = math.hypot(settings.turn_noise * motion.turn, drift * math.sqrt(far)) + 1e-9
        turn = rng.normal(motion.turn, turn_noise, count)
        side = rng.normal(0, settings.slip * far + 1e-9, count)
        x, y, theta = self.particles.T
        middle = theta + turn / 2
        cos, sin = np.cos(middle), np.sin(middle)
        self.particles = np.column_stack(
            [x + distance * cos - side * sin, y + distance * sin + side * cos, theta + turn]
        )

    def jitter(self, metres: float, radians: float) -> None:
        """Spread all particles a little (standard deviations), as moving does."""
        spread = self._rng.normal(0, (metres, metres, radians), self.particles.shape)
        self.particles = self.particles + spread

    def doubt(self) -> None:
        """Count the place as not known for sure: something was missed that may have changed it."""
        self._unsettled = SETTLED

    def settle(self, metres: float) -> None:
        """Count as much as ``metres`` of driving towards a place that is known for sure."""
        self._unsettled = max(0.0, self._unsettled - metres)

    def observe(self, ranges: NDArray[Any]) -> None:
        """Weigh all particles by a scan, (B,) metres: NaN without reading, infinite without echo.

        :raises ReferenceRobotError: for a scan of another number of beams; one without any reading says
            nothing and changes nothing.
        """
        used = self._used(ranges)
        if not len(used):
            return
        fit, agreement = self._model.log_likelihood(self.particles, self._bearings[used], ranges[used])
        average = float(self.weights @ agreement)
        worth = min(self._settings.beams_of_worth, len(used)) * (WORTH_WHILE_LOST if self._unsettled else 1.0)
        logs = np.log(np.maximum(self.weights, 1e-300)) + worth * fit
        weights = np.exp(logs - logs.max())
        self.weights = weights / weights.sum()
        self._agreement = float(self.weights @ agreement)
        self._fast += self._settings.fast * (average - self._fast) if self._fast else average
        if not self._unsettled:
            # What is usual is not known before the place is.
            self._slow += self._settings.slow * (average - self._slow) if self._slow else self._fast
        if self._fast < self._settings.least_agreement:
            self._unsettled = SETTLED
        self._resample(ranges, used)
        self._compare_places()

    def observe_fix(self, x: float, y: float, deviation: float) -> None:
        """Weigh all particles by a GPS position, metres, of which ``deviation`` is the standard deviation.

        Several in a row that are far away show that the belief is wrong.
        """
        self._fix, self._since_fix = (x, y, deviation), 0.0
        squares = np.square(self.particles[:, :2] - (x, y)).sum(axis=1) / deviation**2
        weights = self.weights * (np.exp(-0.5 * squares) + FIX_WRONG)
        self.weights = weights / weights.sum()
        believed_x, believed_y, _ = self.belief.pose
        away = math.hypot(believed_x - x, believed_y - y)
        self._against.append(away > FIX_FAR * deviation)
        if sum(self._against) >= FIX_OFTEN[0]:
            self._unsettled = SETTLED

    @property
    def belief(self) -> Belief:
        """Where the robot most likely is."""
        near = self._together()
        weights = self.weights[near]
        share = float(weights.sum())
        weights = weights / share
        poses = self.particles[near]
        theta = math.atan2(weights @ np.sin(poses[:, 2]), weights @ np.cos(poses[:, 2]))
        place = weights @ poses[:, :2]
        off = np.column_stack([poses[:, :2] - place, _wrapped(poses[:, 2] - theta)])
        covariance = (weights[:, None] * off).T @ off
        lost = self._unsettled > 0 or share < MOST_OF_THEM
        apart = self.particles[:, :2] - place
        spread = math.sqrt(float(self.weights @ np.square(apart).sum(axis=1)))
        pose = float(place[0]), float(place[1]), theta
        return Belief(pose, covariance, share, lost, self._agreement, spread)

    def _compare_places(self) -> None:
        """Begin to count again when the robot that is lost is most likely at another place than before."""
        if not self._unsettled:
            self._place = None
            return
        belief = self.belief
        before, self._place = self._place, belief.pose if belief.share >= MOST_OF_THEM else None
        if self._place is not None and (before is None or math.dist(before[:2], self._place[:2]) > APART[0]):
            self._unsettled = SETTLED

    def _used(self, ranges: NDArray[Any]) -> NDArray[Any]:
        if ranges.shape != self._bearings.shape:
            raise ReferenceRobotError(
                f"scan: {ranges.shape} ranges for {len(self._bearings)} beams; see the laser's settings"
            )
        return usable_beams(ranges)

    def _begin(self, particles: NDArray[Any]) -> None:
        self.particles = particles
        self.weights = np.full(len(particles), 1 / len(particles))
        self._slow = self._fast = 0.0
        self._unsettled, self._place = 0.0, None
        self._against.clear()

    def _together(self) -> NDArray[Any]:
        """Return the particles around the heaviest place: those of its cell, then those near their mean."""
        _, row = np.unique(bins_of(self.particles, APART[0], math.pi / 4), return_inverse=True)
        near = np.flatnonzero(row == np.bincount(row, weights=self.weights).argmax())
        for _ in range(3):
            weights = self.weights[near]
            place = weights @ self.particles[near, :2] / weights.sum()
            theta = math.atan2(
                weights @ np.sin(self.particles[near, 2]), weights @ np.cos(self.particles[near, 2])
            )
            away = np.hypot(*(self.particles[:, :2] - place).T)
            turned = np.abs(_wrapped(self.particles[:, 2] - theta))
            found = np.flatnonzero((away < APART[0]) & (turned < APART[1]))
            if len(found) and self.weights[found].sum() > 0:
                near = found
        return near

    def _resample(self, ranges: NDArray[Any], used: NDArray[Any]) -> None:
        settings, rng = self._settings, self._rng
        lost = max(0.0, 1 - self._fast / (settings.recover * self._slow)) if self._slow else 0.0
        if lost:
            self._unsettled = SETTLED
        metres, scans = self._since_look
        self._since_look = metres, scans + 1
        looks = self._unsettled > 0 and (metres >= LOOK_EVERY[0] or scans >= LOOK_EVERY[1])
        crowd = 1 / float(self.weights @ self.weights)
        if not looks and crowd > len(self.weights) / 2:
            return
        drawn = self.particles[low_variance(self.weights, len(self.weights), rng)]
        count = particles_for(occupied_bins(drawn, settings), settings)
        new = int(rng.binomial(count, max(lost, DOUBT))) if looks else 0
        if self._unsettled:
            group = bins_of(self.particles, GROUP[0], GROUP[1])
            rows, weights = in_groups(self.weights, group, count - new, rng)
        else:
            rows = low_variance(self.weights, count - new, rng)
            weights = np.full(len(rows), 1 / len(rows))
        particles = self.particles[rows]
        if new:
            self._since_look = 0.0, 0
            particles = np.concatenate([particles, self._likely(new, LOOKED_AT, ranges, used)])
            share = new / count
            weights = np.concatenate([weights * (1 - share), np.full(new, share / new)])
        self.particles = particles
        self.weights = weights

    @property
    def _near(self) -> tuple[float, float, float] | None:
        """The newest GPS position, x, y and deviation, where it still says where to look."""
        return self._fix if self._since_fix <= FIX_LASTS else None

    def _likely(
        self, count: int, looked_at: tuple[float, int], ranges: NDArray[Any], used: NDArray[Any]
    ) -> NDArray[Any]:
        """Return poses where the scan fits, (count, 3)."""
        if self._search is None:
            walls = walls_of(self._map).higher_than(self._laser.height)
            self._search = PlaceSearch(self._map, walls, self._laser, self._settings)
        near = self._near
        if near is not None:
            near = near[0], near[1], near[2] + self._since_fix
        per_area, most = looked_at
        poses = AROUND if near is not None else int(min(per_area * self._map.border.area, most))
        return self._search.likely(count, max(poses, 1), self._bearings[used], ranges[used], self._rng, near)


def _wrapped(angle: NDArray[Any]) -> NDArray[Any]:
    wrapped: NDArray[Any] = (angle + np.pi) % (2 * np.pi) - np.pi
    return wrapped
