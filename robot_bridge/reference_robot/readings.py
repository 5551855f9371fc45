"""What a robot's sensors say between two scans, and what in it cannot be right."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .sensors import Motion

LONGEST_PAUSE = 2.0
"""seconds between two readings, beyond which nobody knows what the robot did meanwhile."""
LEAST_JUMP = 0.3
"""metres and radians that a motion may be beyond what the body can do: the noise of its sensors."""


@dataclass(frozen=True, eq=False)
class Reading:
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
    """What the body can do at most: m/s and rad/s."""

    speed: float
    turn_rate: float


def motion_fault(reading: Reading, before: float | None, reach: BodyReach) -> str | None:
    """Return what is wrong with the time and the motion of a reading, None where nothing is.

    ``before`` is the time of the one before, None for the first.
    """
    passed = 0.0 if before is None else reading.t - before
    if not math.isfinite(reading.t) or (before is not None and not 0 < passed <= LONGEST_PAUSE):
        return f"the sensors' clock jumped by {passed:+.2f} s; set it, or let the robot start anew"
    far, turned = abs(reading.motion.distance), abs(reading.motion.turn)
    if not (far <= reach.speed * passed + LEAST_JUMP and turned <= reach.turn_rate * passed + LEAST_JUMP):
        return (
            f"the odometry jumped by {reading.motion.distance:.2f} m and {reading.motion.turn:.2f} rad in "
            f"{passed:.2f} s; check the wheels' encoders and the gyroscope"
        )
    return None


def scan_fault(reading: Reading, beams: int) -> str | None:
    """Return what is wrong with the scan of a reading, None where nothing is."""
    if reading.ranges.shape != (beams,):
        return f"the laser gives {reading.ranges.size} ranges and not {beams}; see the laser's settings"
    if not (reading.ranges >= 0).any():
        return "no beam of the laser has a reading; check its power and its window"
    return None


def without_negatives(ranges: NDArray[Any]) -> NDArray[Any]:
    """Return ``ranges`` with NaN where a range cannot be."""
    return np.where(ranges >= 0, ranges, np.nan)
