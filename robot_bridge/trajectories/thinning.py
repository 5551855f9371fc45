"""Which of a robot's positions are worth storing; no I/O."""

from __future__ import annotations

import math

from ..command_life.arrival import standing
from ..messages import SendPos
from ..sites.settings import TrajectorySettings
from ..store.trajectories import Fix


class Thinning:
    """Keeps what a robot's track needs: where it moved or turned, where it came to stand, and a sign of life.

    The last position of each robot that was not worth it is remembered, so that a robot that falls silent
    is found where it was last.
    """

    def __init__(self) -> None:
        self._kept: dict[str, Fix] = {}
        self._passed: dict[str, Fix] = {}

    def keeps(self, fix: Fix, settings: TrajectorySettings) -> bool:
        """Tell whether ``fix`` is to be stored; fixes of a robot come in the order of their time."""
        last = self._kept.get(fix.robot)
        if last is None or _worth_it(last, fix, settings):
            self._kept[fix.robot] = fix
            self._passed.pop(fix.robot, None)
            return True
        self._passed[fix.robot] = fix
        return False

    def silent(self, before: float = math.inf) -> list[Fix]:
        """Return, once, the last fixes passed over of robots that said nothing since ``before``."""
        found = [fix for fix in self._passed.values() if fix.received_at < before]
        for fix in found:
            self._kept[fix.robot] = self._passed.pop(fix.robot)
        return found


def _worth_it(last: Fix, fix: Fix, settings: TrajectorySettings) -> bool:
    elapsed = fix.received_at - last.received_at
    # A clock that was set back must not end the recording until it has caught up.
    if elapsed >= settings.max_interval_s or elapsed < 0:
        return True
    if elapsed < settings.min_interval_s:
        return False
    return _moved(last.pose, fix.pose, settings) or (standing(fix.pose) and not standing(last.pose))


def _moved(last: SendPos, pose: SendPos, settings: TrajectorySettings) -> bool:
    if math.hypot(pose.x - last.x, pose.y - last.y) >= settings.min_distance_m:
        return True
    turn = abs(math.remainder(pose.theta - last.theta, math.tau))
    return turn >= math.radians(settings.min_turn_deg)
