"""Checks of reported positions: plausibility, late ones, their age, and the course over ground."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, Protocol

from ...core.messages.base import SPEED
from ...core.messages.robots import SendGPS, SendPos
from ...core.sites.frame import SiteBounds
from ...core.sites.settings import SettingsSource, SiteSettings

# --- Plausibility of a reported position: not far from the site, and no leap from the last one

BELIEVED_AFTER = 3.0
"""seconds of consecutive positions near one another, and none near the last believed one, after which a leap
is believed: the robot was carried, or its localisation recovered."""
NO_FIX = (
    "SendGPS: lat and lon are both 0, as receivers say without a fix; the robot keeps its last place. Send "
    "Alive until there is a fix"
)

Place = tuple[float, float]

STANDING_SPEED = 0.05
"""m/s below which a robot counts as standing."""


@dataclass
class Leap:
    """A position reported since ``since`` and not believed, last at ``at``; gateway's seconds."""

    place: Place
    since: float
    at: float


class AcceptedArea(NamedTuple):
    """Area in which a position needs no further checks: within limits of the site frame, and at most ``step``
    along each axis from where the robot was a moment ago; metres.
    """

    x_min: float
    y_min: float
    x_max: float
    y_max: float
    step: float


class PlacedRobot(Protocol):
    """Required data of a robot: its newest pose, the time of that, and whether it is of this run."""

    name: str
    pose: SendPos | None
    pose_at: float | None
    located: bool


class PlaceChecks:
    """Checks the positions that robots report; keeps for each robot the leap that is not believed yet."""

    def __init__(self, site: SettingsSource) -> None:
        self._site = site
        self._leaps: dict[str, Leap] = {}
        self._near_by: SiteSettings | None = None
        self._near = AcceptedArea(math.inf, math.inf, -math.inf, -math.inf, 0.0)

    def fault(self, robot: PlacedRobot, place: Place, now: float) -> str | None:
        """Return why the robot cannot be at ``place``, metres in the site frame, None if it can."""
        settings = self._site.settings
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

    def near(self) -> AcceptedArea:
        """Return the area in which a believed robot's position needs no further checks."""
        settings = self._site.settings
        if settings is not self._near_by:
            bounds, limits = settings.bounds, settings.limits
            within = limits.place_within_m
            self._near_by = settings
            self._near = AcceptedArea(
                bounds.x_min - within,
                bounds.y_min - within,
                bounds.x_max + within,
                bounds.y_max + within,
                limits.leap_m / math.sqrt(2),
            )
        return self._near

    def _leap(self, robot: PlacedRobot, here: Place, place: Place, now: float, leap_m: float) -> str | None:
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


def distance_beyond(place: Place, bounds: SiteBounds) -> float:
    """Return the metres by which (x, y) lies outside ``bounds``, 0 or less inside; the larger of x and y."""
    x, y = place
    return max(bounds.x_min - x, x - bounds.x_max, bounds.y_min - y, y - bounds.y_max)


def _reach(leap_m: float, since: float, now: float) -> float:
    return leap_m + SPEED[1] * max(now - since, 0.0)


# --- Late poses of a robot as a sign that its clock was set back ---

CLOCK_SET_BACK_AFTER = 3.0
"""seconds of nothing but late poses, on the link of the newest one and at the pace of a clock, after which
the robot's clock must have been set back: within one link messages do not overtake each other."""
LONGEST_DELAY = 30.0
"""seconds of nothing but late poses after which they count whatever their pace and link: no link holds
messages back for longer, and a robot must not stand still on the map for ever."""
PACE = (0.5, 1.5)
"""seconds of the robot's clock for each second of the gateway's that are plausible for a clock; messages
held back and then sent all at once come faster."""


@dataclass
class LatePoses:
    """Late poses since the last one that counted; ``paced_*`` is where their pace is measured from."""

    since: float
    paced_since: float
    paced_stamp: float

    def show_set_back(self, stamp: float, now: float, *, same_link: bool) -> bool:
        """Return whether poses have been late for so long that the robot's clock must have been set back.

        ``stamp`` is that of a further pose, by the robot's clock; ``same_link`` whether it came on the link
        of the newest pose. ``now`` is the gateway's clock, seconds.
        """
        if now - self.since >= LONGEST_DELAY:
            return True
        elapsed = now - self.paced_since
        if elapsed < CLOCK_SET_BACK_AFTER:
            return False
        if PACE[0] * elapsed <= stamp - self.paced_stamp <= PACE[1] * elapsed:
            return same_link
        self.paced_since, self.paced_stamp = now, stamp
        return False


# --- Age of a stamped position, independent of the offset of the robot's clock ---

TIME_OF_DAY = 1e9
"""seconds since 1970, in 2001: an earlier stamp is no time of day. It may be simulated time, which passes
faster or slower, so it gives the order of positions and not their age."""
DRIFT = 1e-3
"""seconds that a robot's clock may lose in a second: ten times the drift of the worst quartz."""


@dataclass(slots=True)
class StampAge:
    """Age of positions in excess of the least delayed one, by stamps of one clock that may be wrong.

    ``least`` is the smallest difference seen between the gateway's clock and the stamps, at time ``at``; both
    seconds.
    """

    least: float = math.inf
    at: float = 0.0

    def measure(self, stamp: float, now: float) -> float:
        """Return the seconds for which a position with ``stamp`` was under way, or the fix was repeated."""
        if stamp < TIME_OF_DAY:
            return 0.0
        behind = now - stamp
        least = self.least + DRIFT * (now - self.at)
        self.at = now
        if behind <= least:
            self.least = behind
            return 0.0
        self.least = least
        return behind - least

    def forget(self) -> None:
        """Measure from the next stamp on: one of the two clocks was set."""
        self.least = math.inf


# --- Order of poses of a robot: by the time of the fix, else by the robot's clock, else by arrival


@dataclass
class PoseOrder:
    """The stamps of a robot's newest pose, by its own clocks, and the link that it came on."""

    fix_t: float | None = None
    t: float | None = None
    link: str = ""
    delay: float = 0.0
    """seconds by which the newest pose was older than when it came in, 0 where it has no stamp."""
    _late: LatePoses | None = None
    _by_fix: StampAge = field(default_factory=StampAge)
    _by_t: StampAge = field(default_factory=StampAge)

    def admit(self, fix_t: float | None, t: float | None, link: str, now: float) -> bool:
        """Return whether a pose with these stamps counts, and record it as the newest if so.

        ``now`` is the gateway's clock, seconds. A pose is late when its fix is older than that of the newest,
        or as old and sent earlier; where one of the two has no fix time, when it was sent earlier. A pose
        without any stamp counts as it comes, and a late one where the robot's clock must have been set back.
        """
        if fix_t is not None or (t is not None and self.t is not None and t < self.t):
            stamp = self._late_by(fix_t, t)
            if stamp is not None:
                if not self._set_back(stamp, link, now):
                    return False
                self.clock_was_set()
        if fix_t is not None:
            self.delay = self._by_fix.measure(fix_t, now)
        else:
            self.delay = 0.0 if t is None else self._by_t.measure(t, now)
        self.fix_t = self.fix_t if fix_t is None else fix_t
        self.t = self.t if t is None else t
        self.link = link
        self._late = None
        return True

    def restarted(self) -> None:
        """Forget the robot's own clock: a robot that restarted may count from zero."""
        self.t = self._late = None
        self.clock_was_set()

    def clock_was_set(self) -> None:
        """Forget the offsets of the robot's clocks from the gateway's: one of them was set."""
        self._by_fix.forget()
        self._by_t.forget()

    def _late_by(self, fix_t: float | None, t: float | None) -> float | None:
        """Return the stamp by which a pose is late, or None for one that is not."""
        if fix_t is not None and self.fix_t is not None and fix_t != self.fix_t:
            return fix_t if fix_t < self.fix_t else None
        return t if t is not None and self.t is not None and t < self.t else None

    def _set_back(self, stamp: float, link: str, now: float) -> bool:
        if self._late is None or now < self._late.since:
            self._late = LatePoses(now, now, stamp)
            return False
        return self._late.show_set_back(stamp, now, same_link=link == self.link)


# --- Course and speed over ground, for robots whose GPS reports only positions ---

LEAST_MOVE = 0.5
"""metres below which a move gives no course; more where the robot reports less accurate fixes."""
STANDS_AFTER = 2.0
"""seconds without such a move after which the robot counts as standing."""
_SHORTEST = 0.01
"""least seconds assumed between two fixes, so that a speed is always finite."""

Source = Literal["course", "last", "unknown"]


@dataclass
class GroundTrack:
    """One robot's last fix that gave a course: x, y in metres, seconds, theta in radians, v in m/s."""

    x: float
    y: float
    at: float
    theta: float | None = None
    v: float = 0.0

    def follow(self, x: float, y: float, at: float, accuracy: float | None) -> None:
        """Apply a fix: a move smaller than the accuracy of the fix is not counted as a move."""
        move = math.hypot(x - self.x, y - self.y)
        if move > max(LEAST_MOVE, accuracy or 0.0):
            self.v = move / max(at - self.at, _SHORTEST)
            self.theta = math.atan2(y - self.y, x - self.x)
            self.x, self.y, self.at = x, y, at
        elif at - self.at > STANDS_AFTER:
            self.v = 0.0


class GroundTracks:
    """Makes poses of GPS fixes. Missing fields are derived from the robot's earlier positions."""

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
        # Until two fixes give its speed it keeps the last one: a robot that drove was not seen to stand.
        track = self._tracks.setdefault(robot, GroundTrack(x, y, at, v=0.0 if last is None else last.v))
        if at < track.at:
            # A clock that was set back gives no speed; the track begins again.
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
