"""Has a robot done what it was told? Judged from its poses, not from its word."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..messages import Command, SendPos, SetPath, SetPosEnd, SetPosIni
from ..polyline import Polyline

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
STRIDE = 0.2
"""metres between the poses that are looked for on a path, which takes longer than all else about a pose."""


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
    ``driven`` is the metres of path that the robot is known to have driven. With ``under_way`` its first pose
    may be anywhere on what is left, since it may have driven on unseen; where that passes a place twice, the
    sooner place counts: a robot that stands blocked at the beginning of a loop has not come to its end. Where
    it is not known how far the robot came (``driven`` is None), the later counts. After poses were missed the
    robot is looked for on all of the path that is left. So is one that is beyond the beginning and
    far from where it was when the path was given to it (``handed``): it may acknowledge it long after it set
    off, where its link broke.
    """

    def __init__(
        self,
        path: SetPath,
        tolerance: float,
        *,
        driven: float | None = 0.0,
        under_way: bool = False,
        handed: SendPos | None = None,
    ) -> None:
        self.line = Polyline(path.points)
        self._tolerance = tolerance
        self._theta = path.theta
        self._seek = under_way
        self._handed = handed
        self._sooner = driven is not None
        self._last: SendPos | None = None
        self.driven = driven or 0.0

    def deviation(self, pose: SendPos) -> float | None:
        """Return metres between robot and end of path once it has arrived, else None."""
        end_x, end_y = self.line.end
        distance = math.hypot(pose.x - end_x, pose.y - end_y)
        stands_there = distance <= self._tolerance and standing(pose)
        if stands_there or self._moved(pose):
            self._follow(pose)
        if not stands_there or self.driven < self.line.length - self._tolerance:
            return None
        turned = self._theta is not None and _turn(pose.theta, self._theta) > HEADING_TOLERANCE
        return None if turned else distance

    def _moved(self, pose: SendPos) -> bool:
        """Tell whether the robot is far enough from where it was followed last to be looked for again."""
        last = self._last
        return last is None or _apart(pose, last) >= STRIDE

    def _follow(self, pose: SendPos) -> None:
        station, off = self.line.feet(pose.x, pose.y)
        if self._handed is not None:
            at_beginning = ((off <= CORRIDOR) & (station <= LOOK_AHEAD)).any()
            self._seek |= _apart(pose, self._handed) > LOOK_AHEAD and not at_beginning
            self._handed = None
        if self._seek and (off <= CORRIDOR).any():
            self._seek, self._last = False, pose
            self.driven = max(self.driven, self._found(station, off))
            return
        near = (off <= CORRIDOR) & (station > self.driven) & (station <= self.driven + self._reach(pose))
        if near.any():
            self.driven = float(station[near][np.argmin(off[near])])

    def _found(self, station: NDArray[Any], off: NDArray[Any]) -> float:
        """Return the station of a robot that was not seen for a while, on what is left of the path."""
        left = station >= self.driven - self._tolerance
        if not (off[left] <= CORRIDOR).any():
            return self.driven
        best = station[left][off[left] <= off[left].min() + self._tolerance]
        return float(best.min() if self._sooner else best.max())

    def _reach(self, pose: SendPos) -> float:
        """Return how many metres of path ahead the robot may be since its last pose."""
        last, self._last = self._last or pose, pose
        reach = LOOK_AHEAD + LOOK_AHEAD_TIME * max(abs(pose.v), abs(last.v))
        moved = _apart(pose, last)
        # Round a corner the path is longer than the way as the crow flies.
        return math.inf if moved > reach else max(reach, LOOK_AHEAD + 2 * moved)


@dataclass
class BeginArrival:
    """Judges SetPosIni: the robot takes itself to be there, standing or not."""

    begin: SetPosIni
    tolerance: float

    def deviation(self, pose: SendPos) -> float | None:
        """Return metres between robot and beginning once its pose is that, else None."""
        distance = math.hypot(pose.x - self.begin.x, pose.y - self.begin.y)
        turned = self.begin.theta is not None and _turn(pose.theta, self.begin.theta) > HEADING_TOLERANCE
        return None if turned or distance > self.tolerance else distance


class AbortArrival:
    """Judges Abort: the robot stands."""

    def deviation(self, pose: SendPos) -> float | None:
        """Return 0.0 once the robot stands, else None."""
        return 0.0 if standing(pose) else None


Arrival = TargetArrival | PathArrival | BeginArrival | AbortArrival


def judge(
    command: Command,
    tolerance: float,
    *,
    driven: float | None = 0.0,
    under_way: bool = False,
    handed: SendPos | None = None,
) -> Arrival:
    """Return the judge of a command; ``tolerance`` is metres, ``under_way`` if the robot may be driving.

    ``driven`` is metres of a path that it is known to have driven, None if that is not known; ``handed`` is
    where it was when the command was given to it.
    """
    if isinstance(command, SetPosEnd):
        return TargetArrival(command, tolerance)
    if isinstance(command, SetPath):
        return PathArrival(command, tolerance, driven=driven, under_way=under_way, handed=handed)
    if isinstance(command, SetPosIni):
        return BeginArrival(command, tolerance)
    return AbortArrival()


def _apart(a: SendPos, b: SendPos) -> float:
    return math.hypot(a.x - b.x, a.y - b.y)


def _turn(a: float, b: float) -> float:
    return abs(math.remainder(a - b, math.tau))
