"""Simulated sensors, and plausibility checks of readings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .ray_casting import RayCaster
from .settings import GpsSettings, GyroscopeSettings, LaserSettings, OdometrySettings, StandingSettings
from .world import Walls

TruePose = tuple[float, float, float]
"""x, y in metres and theta in radians."""


class Motion(NamedTuple):
    """The motion between two moments: metres forward and radians counter-clockwise."""

    distance: float
    turn: float


def motion_between(before: TruePose, after: TruePose) -> Motion:
    """Return the motion on an arc from one pose to another; backwards is negative."""
    turn = math.remainder(after[2] - before[2], math.tau)
    dx, dy = after[0] - before[0], after[1] - before[1]
    middle = before[2] + turn / 2
    return Motion(dx * math.cos(middle) + dy * math.sin(middle), turn)


def moved(pose: TruePose, motion: Motion) -> TruePose:
    """Return the pose after ``motion`` from ``pose``."""
    x, y, theta = pose
    middle = theta + motion.turn / 2
    return (
        x + motion.distance * math.cos(middle),
        y + motion.distance * math.sin(middle),
        math.remainder(theta + motion.turn, math.tau),
    )


def bearings_of(settings: LaserSettings) -> NDArray[Any]:
    """Return the direction of each beam, (B,) radians counter-clockwise from ahead.

    A field of a full turn has no duplicate beam.
    """
    field = math.radians(settings.field_deg)
    if settings.beams == 1:
        return np.zeros(1)
    whole = settings.field_deg == 360.0
    bearings: NDArray[Any] = -field / 2 + np.arange(settings.beams) * (
        field / (settings.beams - (0 if whole else 1))
    )
    return bearings


class SimulatedLaser:
    """Scans a world: NaN where there is no reading, infinite where nothing is within reach."""

    def __init__(self, walls: Walls, settings: LaserSettings, rng: np.random.Generator) -> None:
        self._settings = settings
        self._rng = rng
        seen = walls.higher_than(settings.height)
        self._caster = RayCaster(seen.a, seen.b, settings.reach)
        self.bearings = bearings_of(settings)

    def scan(self, pose: TruePose, nearer: NDArray[Any] | None = None) -> NDArray[Any]:
        """Return the range of each beam from ``pose``, (B,) metres; ``nearer``, (B,), are ranges to moving
        obstacles."""
        settings, rng = self._settings, self._rng
        ranges: NDArray[Any] = self._caster.cast(np.array([pose]), self.bearings)[0]
        if nearer is not None:
            ranges = np.minimum(ranges, nearer)
        cut = rng.random(len(ranges)) < settings.short
        nothing = (ranges >= settings.reach) & ~cut
        ranges = np.where(cut, ranges * rng.random(len(ranges)), ranges)
        ranges = np.maximum(ranges + rng.normal(0, settings.noise, len(ranges)), 0.0)
        ranges[nothing] = np.inf
        ranges[rng.random(len(ranges)) < settings.dropout] = np.nan
        return ranges


class SimulatedOdometry:
    """Wheels that slip: a scale and a drift for the whole run, and noise."""

    def __init__(self, settings: OdometrySettings, rng: np.random.Generator) -> None:
        self._settings = settings
        self._rng = rng
        self._scale = 1 + rng.normal(0, settings.scale)
        self._drift = math.radians(rng.normal(0, settings.drift_deg))

    def measure(self, motion: Motion) -> Motion:
        """Return the measurement of a true motion."""
        settings, rng = self._settings, self._rng
        far = abs(motion.distance)
        return Motion(
            motion.distance * self._scale + rng.normal(0, settings.noise * math.sqrt(far)),
            motion.turn + self._drift * far + rng.normal(0, settings.turn_noise * abs(motion.turn) + 1e-12),
        )


class SimulatedGyroscope:
    """A rate gyroscope with a bias."""

    def __init__(self, settings: GyroscopeSettings, rng: np.random.Generator) -> None:
        self._noise = math.radians(settings.noise_deg)
        self._rng = rng
        self._bias = math.radians(rng.normal(0, settings.bias_deg))

    def measure(self, turn: float, dt: float) -> float:
        """Return the measurement of a true ``turn``, radians, made in ``dt`` seconds."""
        return turn + self._bias * dt + self._rng.normal(0, self._noise * math.sqrt(dt))


class SimulatedGps:
    """A receiver that loses its fix between buildings."""

    HIGHEST = 60.0
    """metres: walls farther away than this are ignored."""

    def __init__(self, walls: Walls, settings: GpsSettings, rng: np.random.Generator) -> None:
        self._settings = settings
        self._rng = rng
        slope = math.tan(math.radians(settings.mask_deg))
        # Walls of one height class shade by the lower edge of the class.
        self._casters = []
        for low, high in ((2.0, 5.0), (5.0, 10.0), (10.0, 20.0), (20.0, np.inf)):
            some = (walls.height >= low) & (walls.height < high)
            reach = min(low / slope, self.HIGHEST) if slope > 0 else self.HIGHEST
            self._casters.append(RayCaster(walls.a[some], walls.b[some], reach))
        self._around = np.arange(settings.directions) * (2 * np.pi / settings.directions)

    def fix(self, pose: TruePose) -> tuple[float, float] | None:
        """Return x, y in metres, or None without a fix."""
        shaded = np.zeros(len(self._around), dtype=bool)
        for caster in self._casters:
            shaded |= caster.cast(np.array([[pose[0], pose[1], 0.0]]), self._around)[0] < caster.reach
        if 1 - shaded.mean() < self._settings.open_share:
            return None
        east, north = self._rng.normal(0, self._settings.noise, 2)
        return pose[0] + east, pose[1] + north


@dataclass(frozen=True, eq=False)
class SensorReading:
    """One scan, and the motion since the one before.

    ``t`` is seconds by the robot's own clock; ``ranges`` (B,) metres, NaN without a reading, infinite without
    an echo; ``fix`` a GPS position, x and y in metres in the site frame.
    """

    t: float
    motion: Motion
    ranges: NDArray[Any]
    fix: tuple[float, float] | None = None


@dataclass(frozen=True)
class BodyReach:
    """Limits of the body: m/s and rad/s."""

    speed: float
    turn_rate: float


def motion_fault(
    reading: SensorReading, before: float | None, reach: BodyReach, settings: StandingSettings
) -> str | None:
    """Return the fault in the time or the motion of a reading, None if there is none.

    ``before`` is the time of the one before, None for the first.
    """
    passed = 0.0 if before is None else reading.t - before
    if not math.isfinite(reading.t) or (before is not None and not 0 < passed <= settings.pause):
        return f"the sensors' clock jumped by {passed:+.2f} s; set it, or restart the robot"
    far, turned = abs(reading.motion.distance), abs(reading.motion.turn)
    if not (
        far <= reach.speed * passed + settings.jump and turned <= reach.turn_rate * passed + settings.jump
    ):
        return (
            f"the odometry jumped by {reading.motion.distance:.2f} m and {reading.motion.turn:.2f} rad in "
            f"{passed:.2f} s; check the wheels' encoders and the gyroscope"
        )
    return None


def scan_fault(reading: SensorReading, beams: int) -> str | None:
    """Return the fault in the scan or the GPS position of a reading, None if there is none."""
    if reading.ranges.shape != (beams,):
        return f"the laser gives {reading.ranges.size} ranges and not {beams}; see the laser's settings"
    if not (reading.ranges >= 0).any():
        return "no beam of the laser has a reading; check its power and its window"
    if reading.fix is not None and not all(math.isfinite(metres) for metres in reading.fix):
        return f"the GPS receiver gives the position {reading.fix}; check the receiver and its driver"
    return None


def without_negatives(ranges: NDArray[Any]) -> NDArray[Any]:
    """Return ``ranges`` with NaN for impossible values."""
    return np.where(ranges >= 0, ranges, np.nan)
