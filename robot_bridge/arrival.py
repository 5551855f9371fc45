"""Has a robot done what it was told? Judged from its poses, not from its word."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .messages import Abort, SendPos, SetPath, SetPosEnd
from .polyline import Polyline

STANDING_SPEED = 0.05
"""m/s below which a robot counts as standing."""
HEADING_TOLERANCE = 0.15
"""radians; only where the target gives a heading."""
CORRIDOR = 2.0
"""metres a robot may be off its path and still be seen to advance along it."""
LOOK_AHEAD = 5.0
"""metres of path searched ahead of the place reached last, so that a loop is not cut short."""
LOOK_AHEAD_TIME = 2.0
"""seconds of driving added to it: a fast robot is far ahead by its next pose."""


def standing(pose: SendPos) -> bool:
    """Tell whether the robot stands."""
    return abs(pose.v) <= STANDING_SPEED


@dataclass
class TargetArrival:
    """Judges SetPosEnd: the robot stands within ``tolerance`` metres of the target."""

    target: SetPosEnd
    tolerance: float

    def deviation(self, pose: SendPos) -> float | None:
        """Return metres between robot and target once it has arrived, else None."""
        distance = math.hypot(pose.x - self.target.x, pose.y - self.target.y)
        if distance > self.tolerance or not standing(pose):
            return None
        if self.target.theta is not None and _turn(pose.theta, self.target.theta) > HEADING_TOLERANCE:
            return None
        return distance


class PathArrival:
    """Judges SetPath: the robot followed the path and stands within ``tolerance`` metres of its end.

    A path may end where it began, so standing at the end counts only after the whole of it was driven.
    With ``under_way`` the first pose may be anywhere along the path; where the path passes a place twice,
    the later time counts, since a robot may have come to its end unseen. After poses were missed the robot
    is looked for on all of the path that is left.
    """

    def __init__(self, path: SetPath, tolerance: float, *, under_way: bool = False) -> None:
        self._line = Polyline(path.points)
        self._tolerance = tolerance
        self._seek = under_way
        self._last: SendPos | None = None
        self.driven = 0.0

    def deviation(self, pose: SendPos) -> float | None:
        """Return metres between robot and end of path once it has arrived, else None."""
        self._follow(pose)
        end_x, end_y = self._line.end
        distance = math.hypot(pose.x - end_x, pose.y - end_y)
        at_end = self.driven >= self._line.length - self._tolerance
        return distance if at_end and distance <= self._tolerance and standing(pose) else None

    def _follow(self, pose: SendPos) -> None:
        station, off = self._line.feet(pose.x, pose.y)
        near = (off <= CORRIDOR) & (station > self.driven) & (station <= self.driven + self._reach(pose))
        if self._seek and (off <= CORRIDOR).any():
            self._seek = False
            self.driven = float(station[off <= off.min() + self._tolerance].max())
        elif near.any():
            self.driven = float(station[near][np.argmin(off[near])])

    def _reach(self, pose: SendPos) -> float:
        """Return how many metres of path ahead the robot may be since its last pose."""
        last, self._last = self._last or pose, pose
        reach = LOOK_AHEAD + LOOK_AHEAD_TIME * max(abs(pose.v), abs(last.v))
        missed = math.hypot(pose.x - last.x, pose.y - last.y) > reach
        return math.inf if missed else reach


class AbortArrival:
    """Judges Abort: the robot stands."""

    def deviation(self, pose: SendPos) -> float | None:
        """Return 0.0 once the robot stands, else None."""
        return 0.0 if standing(pose) else None


Arrival = TargetArrival | PathArrival | AbortArrival


def judge(command: SetPosEnd | SetPath | Abort, tolerance: float, *, under_way: bool = False) -> Arrival:
    """Return the judge of a command; ``tolerance`` is metres, ``under_way`` if the robot may be driving."""
    if isinstance(command, SetPosEnd):
        return TargetArrival(command, tolerance)
    if isinstance(command, SetPath):
        return PathArrival(command, tolerance, under_way=under_way)
    return AbortArrival()


def _turn(a: float, b: float) -> float:
    return abs(math.remainder(a - b, math.tau))
