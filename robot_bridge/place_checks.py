"""Whether a robot may be where it says that it is: not far from its site, nor in a leap from where it was."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from .messages.bounds import SPEED
from .robots import Near, Robot
from .sites.settings import Bounds, SiteSettings

BELIEVED_AFTER = 3.0
"""seconds of places beside one another, and of none where the robot was, after which a leap is believed: it
was carried, or its localisation found itself."""
NO_FIX = (
    "SendGPS: lat and lon are both 0, as receivers say without a fix; the robot keeps its last place. Send "
    "Alive until there is a fix"
)

Place = tuple[float, float]


@dataclass
class Leap:
    """Where a robot says to be since ``since`` without being believed, last at ``at``; gateway's seconds."""

    place: Place
    since: float
    at: float


class PlaceChecks:
    """Judges the places that robots say; it keeps for each robot the leap that is not believed yet."""

    def __init__(self, settings: Callable[[], SiteSettings]) -> None:
        self._settings = settings
        self._leaps: dict[str, Leap] = {}

    def fault(self, robot: Robot, place: Place, now: float) -> str | None:
        """Return why the robot is not at ``place``, metres in the site frame, None where it may be there."""
        settings = self._settings()
        limits = settings.limits
        beyond = distance_beyond(place, settings.bounds)
        if beyond > limits.place_within_m:
            return (
                f"({place[0]:.2f}, {place[1]:.2f}) is {beyond / 1000:.1f} km outside site {settings.id}, "
                f"and at most {limits.place_within_m / 1000:g} km are believed (place_within_m in its "
                "settings); the robot keeps its last place. Correct its position, or the frame that it is in"
            )
        if robot.pose is None or robot.pose_at is None or not robot.located:
            self._leaps.pop(robot.name, None)
            return None
        here = robot.pose.x, robot.pose.y
        if math.dist(here, place) <= _reach(limits.leap_m, robot.pose_at, now):
            self._leaps.pop(robot.name, None)
            return None
        return self._leap(robot, here, place, now, limits.leap_m)

    def near(self) -> Near:
        """Return where the place of a robot that is believed needs no second look."""
        settings = self._settings()
        bounds, limits = settings.bounds, settings.limits
        within = limits.place_within_m
        return Near(
            bounds.x_min - within,
            bounds.y_min - within,
            bounds.x_max + within,
            bounds.y_max + within,
            limits.leap_m / math.sqrt(2),
        )

    def _leap(self, robot: Robot, here: Place, place: Place, now: float, leap_m: float) -> str | None:
        leap = self._leaps.get(robot.name)
        if leap is None or math.dist(leap.place, place) > _reach(leap_m, leap.at, now):
            leap = self._leaps[robot.name] = Leap(place, now, now)
        leap.place, leap.at = place, now
        if now - leap.since >= BELIEVED_AFTER:
            del self._leaps[robot.name]
            return None
        return (
            f"({place[0]:.2f}, {place[1]:.2f}) is {math.dist(here, place):.0f} m from where it was a moment "
            f"ago, more than {leap_m:g} m (leap_m in the site's settings); it is believed when it goes on "
            f"from there for {BELIEVED_AFTER:g} s"
        )


def distance_beyond(place: Place, bounds: Bounds) -> float:
    """Return how many metres (x, y) lies outside ``bounds``, 0 or less inside; the larger of x and y."""
    x, y = place
    return max(bounds.x_min - x, x - bounds.x_max, bounds.y_min - y, y - bounds.y_max)


def _reach(leap_m: float, since: float, now: float) -> float:
    return leap_m + SPEED[1] * max(now - since, 0.0)
