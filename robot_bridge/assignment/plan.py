"""The plan: which robot does what, where, when, and along which path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .job import COLLECT, PLACE, Robot, Store, Target

STORE, HOME = "store", "home"
KINDS = (PLACE, COLLECT, STORE, HOME)
"""What a robot does: place a cone, collect one, load and unload at a store, or end where it began."""

Path = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Stop:
    """A place where a robot stops; ``id`` is that of the cone, the store, or, at home, the robot.

    ``path`` leads there from the stop before, (x, y) in metres in the site frame, ``metres`` long on the
    ground. The robot arrives, begins what is to be done, and has done it, in seconds from the plan's begin.
    ``aboard`` cones to place and ``collected`` ones are on it afterwards.
    """

    kind: str
    id: str
    x: float
    y: float
    theta: float
    metres: float
    arrival_s: float
    begin_s: float
    end_s: float
    loaded: int
    unloaded: int
    aboard: int
    collected: int
    path: Path

    @property
    def is_target(self) -> bool:
        """Whether a cone is placed or collected here."""
        return self.kind in (PLACE, COLLECT)


@dataclass(frozen=True)
class PlannedTrip:
    """Stops from a visit to a store until the next; the first trip may begin with what is aboard."""

    number: int
    stops: tuple[Stop, ...]

    @property
    def targets(self) -> tuple[str, ...]:
        """The ids of the cones."""
        return tuple(stop.id for stop in self.stops if stop.is_target)


@dataclass(frozen=True)
class RobotPlan:
    """The trips of ``robot`` from the state that it is in; ``done`` are the stops before that.

    A ``lost`` robot has no trips.
    """

    robot: Robot
    trips: tuple[PlannedTrip, ...]
    done: tuple[Stop, ...] = ()
    lost: bool = False

    @property
    def stops(self) -> tuple[Stop, ...]:
        """The stops to come."""
        return tuple(stop for trip in self.trips for stop in trip.stops)

    @property
    def metres(self) -> float:
        """Metres to drive."""
        return sum(stop.metres for stop in self.stops)

    @property
    def end_s(self) -> float:
        """When the robot has done all that it is to do."""
        stops = self.stops
        return stops[-1].end_s if stops else self.robot.ready_s


@dataclass(frozen=True)
class LeftOut:
    """A target that nobody serves, and why."""

    target: Target
    reason: str


@dataclass(frozen=True)
class Plan:
    """What every robot is to do. ``targets`` are those to come and those that are done.

    ``finish`` is where robots go at the end, ``method`` found the plan, ``travel`` says what its ways follow,
    and ``crs`` names the CRS of its coordinates, nothing where they are those of the site frame.
    """

    robots: tuple[RobotPlan, ...]
    targets: tuple[Target, ...]
    stores: tuple[Store, ...]
    finish: str
    objective: str
    method: str
    travel: str
    left_out: tuple[LeftOut, ...] = ()
    crs: str = ""

    @property
    def metres(self) -> float:
        """Metres to drive, of all robots."""
        return sum(one.metres for one in self.robots)

    @property
    def end_s(self) -> float:
        """When the last robot has done all that it is to do."""
        return max((one.end_s for one in self.robots if not one.lost), default=0.0)

    @property
    def served_s(self) -> float:
        """When the last cone is placed or collected."""
        return max((stop.end_s for _, stop in self.all_stops() if stop.is_target), default=0.0)

    @property
    def done(self) -> frozenset[str]:
        """The ids of the cones that are placed or collected already."""
        return frozenset(stop.id for one in self.robots for stop in one.done if stop.is_target)

    def robot(self, name: str) -> RobotPlan | None:
        """Return the plan of robot ``name``."""
        return next((one for one in self.robots if one.robot.id == name), None)

    def all_stops(self) -> Iterator[tuple[RobotPlan, Stop]]:
        """Yield every stop to come with the robot that makes it."""
        for one in self.robots:
            for stop in one.stops:
                yield one, stop
