"""Reported positions: which are believed, what late ones tell, and the course where none is reported."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, Protocol

from ...core.messages.base import SPEED
from ...core.messages.robots import SendGPS, SendPos
from ...core.sites.frame import SiteBounds
from ...core.sites.settings import SettingsSource, SiteSettings

# --- Whether a robot may be where it says that it is: not far from its site, nor in a leap from where it was

BELIEVED_AFTER = 3.0
"""seconds of places beside one another, and of none where the robot was, after which a leap is believed: it
was carried, or its localisation found itself."""
NO_FIX = (
    "SendGPS: lat and lon are both 0, as receivers say without a fix; the robot keeps its last place. Send "
    "Alive until there is a fix"
)

Place = tuple[float, float]

STANDING_SPEED = 0.05
"""m/s below which a robot counts as standing."""


@dataclass
class Leap:
    """Where a robot says to be since ``since`` without being believed, last at ``at``; gateway's seconds."""

    place: Place
    since: float
    at: float


class AcceptedArea(NamedTuple):
    """Where a place needs no second look: within limits of the site frame, and a ``step`` along each axis
    from where the robot was a moment ago; metres.
    """

    x_min: float
    y_min: float
    x_max: float
    y_max: float
    step: float


class PlacedRobot(Protocol):
    """What has to be known of a robot: its newest pose, when that came, and whether it is of this run."""

    name: str
    pose: SendPos | None
    pose_at: float | None
    located: bool


class PlaceChecks:
    """Judges the places that robots say; it keeps for each robot the leap that is not believed yet."""

    def __init__(self, site: SettingsSource) -> None:
        self._site = site
        self._leaps: dict[str, Leap] = {}
        self._near_by: SiteSettings | None = None
        self._near = AcceptedArea(math.inf, math.inf, -math.inf, -math.inf, 0.0)

    def fault(self, robot: PlacedRobot, place: Place, now: float) -> str | None:
        """Return why the robot is not at ``place``, metres in the site frame, None where it may be there."""
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
        """Return where the place of a robot that is believed needs no second look."""
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
    """Return how many metres (x, y) lies outside ``bounds``, 0 or less inside; the larger of x and y."""
    x, y = place
    return max(bounds.x_min - x, x - bounds.x_max, bounds.y_min - y, y - bounds.y_max)


def _reach(leap_m: float, since: float, now: float) -> float:
    return leap_m + SPEED[1] * max(now - since, 0.0)


# --- Late poses of a robot: whether they tell that its clock was set back ---

CLOCK_SET_BACK_AFTER = 3.0
"""seconds of nothing but late poses, on the link of the newest one and at the pace of a clock, after which
the robot's clock must have been set back: within one link messages do not overtake each other."""
LONGEST_DELAY = 30.0
"""seconds of nothing but late poses after which they count whatever their pace and link: no link holds
messages back for longer, and a robot must not stand still on the map for ever."""
PACE = (0.5, 1.5)
"""seconds of the robot's clock for each second of the gateway's that still pass for a clock; what was kept
back and is now sent in one go comes faster."""


@dataclass
class LatePoses:
    """Late poses since the last one that counted; ``paced_*`` is where their pace is measured from."""

    since: float
    paced_since: float
    paced_stamp: float

    def show_set_back(self, stamp: float, now: float, *, same_link: bool) -> bool:
        """Tell whether poses have been late for so long that it must be the robot's clock.

        ``stamp`` is that of one more, by the robot's clock; ``same_link`` whether it came on the link of the
        newest pose. ``now`` is the gateway's clock, seconds.
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


# --- How old a position is that a robot gives a time, whatever its clock says ---

TIME_OF_DAY = 1e9
"""seconds since 1970, in 2001: a stamp before is no time of day. It may be simulated time, which passes
faster or slower, so it tells the order of positions and not their age."""
DRIFT = 1e-3
"""seconds that a robot's clock may lose in a second: ten times what the worst quartz does."""


@dataclass(slots=True)
class StampAge:
    """How much older positions are than the timeliest one was, by stamps of one clock that may be wrong.

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


# --- Which pose of a robot is newest: by the time of its fix, else by the robot's clock, else as they come


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
        """Tell whether a pose with these stamps counts, and take it for the newest if so.

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
        """Forget the robot's own clock: a robot that started again may count from nought."""
        self.t = self._late = None
        self.clock_was_set()

    def clock_was_set(self) -> None:
        """Forget how the robot's clocks and the gateway's differ: one of them was set."""
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


# --- Course and speed over ground, for robots whose GPS says only where they are ---

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
            # A clock that was set back tells no speed; the track begins again.
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
