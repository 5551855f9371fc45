"""Course and speed over ground, for robots whose GPS says only where they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from .messages import SendGPS, SendPos
from .messages.bounds import SPEED

LEAST_MOVE = 0.5
"""metres below which a move tells no course; more where the robot says that its fixes are worse."""
STANDS_AFTER = 2.0
"""seconds without such a move after which the robot counts as standing."""
_SHORTEST = 0.01
"""seconds between two fixes that are told apart, so that a speed is always finite."""

Source = Literal["course", "last", "unknown"]


@dataclass
class GroundTrack:
    """One robot's last fix that told a course: x, y in metres, seconds, theta in radians, v in m/s."""

    x: float
    y: float
    at: float
    theta: float | None = None
    v: float = 0.0

    def follow(self, x: float, y: float, at: float, accuracy: float | None) -> None:
        """Take in a fix: what moved less than it may be wrong by has not been seen to move."""
        move = math.hypot(x - self.x, y - self.y)
        if move > max(LEAST_MOVE, accuracy or 0.0):
            self.v = move / max(at - self.at, _SHORTEST)
            self.theta = math.atan2(y - self.y, x - self.x)
            self.x, self.y, self.at = x, y, at
        elif at - self.at > STANDS_AFTER:
            self.v = 0.0


class GroundTracks:
    """Makes poses of GPS fixes. What a fix leaves open is told from where the robot was before."""

    def __init__(self) -> None:
        self._tracks: dict[str, GroundTrack] = {}

    def pose(
        self,
        robot: str,
        fix: SendGPS,
        place: tuple[float, float],
        theta: float | None,
        last: SendPos | None,
        now: float,
    ) -> SendPos:
        """Return ``fix`` as a pose at ``place``, metres in the site frame.

        ``theta`` is the heading it came with, in the site frame. Without one theta is the course over ground,
        else that of the ``last`` pose, else 0, and ``theta_from`` says which. ``v`` is that of the fix, else
        the speed over ground. ``now`` is the gateway's time, for fixes without one of their own.
        """
        x, y = place
        at = next(time for time in (fix.fix_t, fix.t, now) if time is not None)
        # Until two fixes tell how fast it is it goes as it did: one that drove has not been seen to stand.
        track = self._tracks.setdefault(robot, GroundTrack(x, y, at, v=0.0 if last is None else last.v))
        if at < track.at:
            # A clock that was set back tells no speed; the track begins anew.
            track = self._tracks[robot] = GroundTrack(x, y, at, track.theta)
        track.follow(x, y, at, fix.accuracy)
        turned, source = (theta, None) if theta is not None else _direction(track, last)
        return SendPos(
            x=round(x, 4),
            y=round(y, 4),
            theta=round(turned, 5),
            v=round(min(track.v, SPEED[1]), 3) if fix.v is None else fix.v,
            t=fix.t,
            battery=fix.battery,
            status=fix.status,
            fix_t=fix.fix_t,
            accuracy=fix.accuracy,
            altitude=fix.altitude,
            theta_from=source,
        )


def _direction(track: GroundTrack, last: SendPos | None) -> tuple[float, Source]:
    if track.v > 0 and track.theta is not None:
        return track.theta, "course"
    if last is not None and last.theta_from != "unknown":
        return last.theta, "last"
    return 0.0, "unknown"
