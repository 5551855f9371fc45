"""When something is an alarm and when it is none any more: rules on columns, one row for each robot.

Each rule answers twice: of whom it is true beyond doubt, and of whom it is over beyond doubt. Between the
two nothing changes, so that a value that trembles about its threshold makes one alarm and not hundreds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import RobotState
from ...wire.sightings import STATES
from ..close_pairs import Ints, close_pairs
from .thresholds import AlarmKind, Thresholds

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Verdict = tuple[Bools, Bools]
"""(n,) true: begins; (n,) true: ends."""

FRESH = STATES.index(RobotState.FRESH)
LOST = STATES.index(RobotState.LOST)
OFFLINE = STATES.index(RobotState.OFFLINE)
STANDS = 0.05
"""m/s below which a robot stands."""
DRIVES = 0.2
"""m/s above which it drives."""


@dataclass(frozen=True)
class Situation:
    """All robots at one moment, n rows that keep their places.

    ``xy`` (n, 2) metres in the site frame, ``v`` (n,) metres a second, ``battery`` (n,) part of a full one,
    ``accuracy`` (n,) metres, each NaN where not known; ``state`` (n,) index into :data:`STATES`;
    ``stopped`` (n,) whether it said that it stops; ``driving`` (n,) whether it accepted a task that is not
    finished and nobody has it wait; ``only_seen`` (n,) whether it takes no commands, as phones do;
    ``off_road`` (n,) whether it is further than the margin from every road surface, and ``on_road`` whether
    it is on one, both None where no surfaces are known. ``bounds`` is x_min, y_min, x_max, y_max.
    """

    names: list[str]
    xy: Floats
    v: Floats
    battery: Floats
    accuracy: Floats
    state: npt.NDArray[np.intp]
    stopped: Bools
    driving: Bools
    only_seen: Bools
    bounds: tuple[float, float, float, float]
    off_road: Bools | None = None
    on_road: Bools | None = None


def lost(now: Situation, limits: Thresholds) -> Verdict:
    """Nothing is heard of a robot any more; over when it speaks again or went offline in good order."""
    return now.state == LOST, (now.state == FRESH) | (now.state == OFFLINE)


def unsure(now: Situation, limits: Thresholds) -> Verdict:
    """A robot says that it does not know its place; over when it does, or says no more of it, or is offline.

    A margin as large as the limit would never end: then half the limit is well enough.
    """
    surely = max(limits.unsure - limits.unsure_margin, limits.unsure / 2)
    fresh = now.state == FRESH
    known = (now.accuracy < surely) | np.isnan(now.accuracy)
    return fresh & (now.accuracy >= limits.unsure), (fresh & known) | (now.state == OFFLINE)


def low_battery(now: Situation, limits: Thresholds) -> Verdict:
    """A battery is low; over when it has clearly been charged."""
    charged = min(1.0, limits.low_battery + limits.battery_margin)
    return now.battery < limits.low_battery, now.battery >= charged


def stopped(now: Situation, limits: Thresholds) -> Verdict:
    """A robot stands although it accepted a task; over when it drives, or has nothing to do any more."""
    stands = now.stopped | (now.v < STANDS)
    return now.driving & (now.state == FRESH) & stands, ~now.driving | (~now.stopped & (now.v > DRIVES))


def outside_site(now: Situation, limits: Thresholds) -> Verdict:
    """A robot has left the site's bounds; over when it is within them."""
    x_min, y_min, x_max, y_max = now.bounds
    x, y = now.xy.T
    # Negative inside, positive outside; a robot without a place is neither.
    beyond = np.maximum.reduce([x_min - x, x - x_max, y_min - y, y - y_max])
    return beyond > limits.outside_margin, beyond <= 0.0


def off_road(now: Situation, limits: Thresholds) -> Verdict:
    """A robot has left every road surface; over when it is on one."""
    if now.off_road is None or now.on_road is None:
        nobody = np.zeros(len(now.names), dtype=bool)
        return nobody, ~nobody
    return now.off_road, now.on_road


RULES: dict[AlarmKind, Callable[[Situation, Thresholds], Verdict]] = {
    AlarmKind.LOST: lost,
    AlarmKind.UNSURE: unsure,
    AlarmKind.LOW_BATTERY: low_battery,
    AlarmKind.STOPPED: stopped,
    AlarmKind.OUTSIDE_SITE: outside_site,
    AlarmKind.OFF_ROAD: off_road,
}
"""The rules about one robot; :func:`too_close` is about two."""


def too_close(now: Situation, limits: Thresholds) -> tuple[Ints, Ints, Floats]:
    """Return pairs i < j of robots that are near, and how far apart they are.

    That is all pairs nearer than an alarm takes to end; two that are both offline are parked, not near. The
    gateway tells who is near of what is only seen.
    """
    placed = np.flatnonzero(np.isfinite(now.xy).all(axis=1) & ~now.only_seen)
    one, other, apart = close_pairs(now.xy[placed], limits.too_close + limits.close_margin)
    one, other = placed[one], placed[other]
    counts = (now.state[one] != OFFLINE) | (now.state[other] != OFFLINE)
    return one[counts], other[counts], apart[counts]
