"""Job of an assignment: cones, robots, stores; travel between places, straight or along roads."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import AssignmentCancelledError, JobError, MissingStoreError, OffNetworkError
from ..roads.cost_matrix import road_matrix
from ..roads.path_smoothing import Driving, dense_path
from ..roads.routes import REACH, Restrictions, Router

# --- The job: targets, available robots, and the stores where cones are kept ---

Floats = NDArray[np.float64]

PLACE, COLLECT = "place", "collect"
TO_STORE, TO_START, STAY = "store", "start", "stay"
FINISHES = (TO_STORE, TO_START, STAY)
"""Where a robot goes after its last target: the nearest store, where it started, or nowhere."""


@dataclass(frozen=True)
class ConeTarget:
    """A cone to place or to collect at (x, y), metres in the site frame; ``theta`` is the cone's heading.

    Every target of a lower ``stage`` is done before one of a higher stage is begun. ``demand`` is the room
    that the cone takes on a robot, ``service_s`` the seconds that placing or collecting it takes.
    """

    id: str
    x: float
    y: float
    theta: float = 0.0
    stage: int = 0
    kind: str = PLACE
    demand: int = 1
    service_s: float = 10.0


@dataclass(frozen=True)
class Store:
    """A place where robots load and unload cones; each visit takes ``service_s`` seconds."""

    id: str
    x: float
    y: float
    service_s: float = 30.0


@dataclass(frozen=True)
class PlanRobot:
    """A robot at the beginning of the plan.

    It has room for ``capacity``, drives ``speed`` m/s, and has battery for ``range_m`` metres more. It
    carries ``aboard`` cones to place and ``collected`` ones to unload, and may start at ``ready_s`` seconds.
    """

    id: str
    x: float
    y: float
    capacity: int
    speed: float = 1.0
    range_m: float = math.inf
    aboard: int = 0
    collected: int = 0
    ready_s: float = 0.0


@dataclass(frozen=True)
class AssignmentJob:
    """Targets, robots and stores; checked when it is made.

    Its places are numbered: robots' starts first, then stores, then targets.

    :raises JobError: naming the invalid input.
    """

    targets: tuple[ConeTarget, ...]
    robots: tuple[PlanRobot, ...]
    stores: tuple[Store, ...]
    finish: str = TO_STORE

    def __post_init__(self) -> None:
        _check(self)

    @property
    def first_store(self) -> int:
        """The number of the first store's place."""
        return len(self.robots)

    @property
    def first_target(self) -> int:
        """The number of the first target's place."""
        return len(self.robots) + len(self.stores)

    @cached_property
    def places(self) -> Floats:
        """Every place, (n, 2) metres in the site frame."""
        everything: list[PlanRobot | Store | ConeTarget] = [*self.robots, *self.stores, *self.targets]
        return np.array([(one.x, one.y) for one in everything], dtype=np.float64).reshape(-1, 2)

    @cached_property
    def stages(self) -> list[int]:
        """The stages that there are, in their order."""
        return sorted({target.stage for target in self.targets})

    @cached_property
    def place_of(self) -> dict[str, int]:
        """The number of each target's place by its id."""
        return {target.id: self.first_target + k for k, target in enumerate(self.targets)}

    def target(self, place: int) -> ConeTarget:
        """Return the target at ``place``."""
        return self.targets[place - self.first_target]

    def name(self, place: int) -> str:
        """Return the name of ``place`` for messages."""
        if place < self.first_store:
            return f"the start of robot {self.robots[place].id}"
        if place < self.first_target:
            return f"store {self.stores[place - self.first_store].id}"
        return f"cone {self.target(place).id}"


def _check(job: AssignmentJob) -> None:
    if not job.robots:
        raise JobError("There is no robot: give at least one.")
    if job.finish not in FINISHES:
        raise JobError(f"Finish {job.finish!r} is none: choose of {', '.join(FINISHES)}.")
    groups: tuple[tuple[str, Sequence[ConeTarget | PlanRobot | Store]], ...] = (
        ("cone", job.targets),
        ("robot", job.robots),
        ("store", job.stores),
    )
    for what, ones in groups:
        _check_names(what, [one.id for one in ones])
        for one in ones:
            for name in ("x", "y"):
                _check_number(what, one.id, name, getattr(one, name), -math.inf)
    for store in job.stores:
        _check_number("store", store.id, "service_s", store.service_s, 0.0)
    for robot in job.robots:
        _check_robot(robot)
    for target in job.targets:
        _check_target(target, max(robot.capacity for robot in job.robots))
    if not job.stores and _needs_store(job):
        raise MissingStoreError("There is no store where robots load or unload cones: give at least one.")


def _needs_store(job: AssignmentJob) -> bool:
    placing = sum(target.demand for target in job.targets if target.kind == PLACE)
    collecting = any(target.kind == COLLECT for target in job.targets)
    homeward = job.finish == TO_STORE and bool(job.targets)
    unloading = any(robot.collected for robot in job.robots)
    return collecting or unloading or homeward or placing > sum(robot.aboard for robot in job.robots)


def _check_names(what: str, names: Sequence[str]) -> None:
    twice = sorted({name for name in names if names.count(name) > 1}) if len(set(names)) < len(names) else []
    if twice:
        raise JobError(f"More than one {what} has the id {_listed(twice)}: give each its own.")
    if any(not name for name in names):
        raise JobError(f"A {what} has no id: give each one.")


def _check_robot(robot: PlanRobot) -> None:
    for name, least in (("capacity", 1), ("aboard", 0), ("collected", 0), ("ready_s", 0.0)):
        _check_number("robot", robot.id, name, getattr(robot, name), least)
    _check_number("robot", robot.id, "speed", robot.speed, 1e-3)
    if math.isnan(robot.range_m) or robot.range_m < 0:
        raise JobError(f"Robot {robot.id} has a range of {robot.range_m:g} m: give metres of 0 or more.")
    if robot.aboard + robot.collected > robot.capacity:
        raise JobError(
            f"Robot {robot.id} carries {robot.aboard + robot.collected} and has room for {robot.capacity}: "
            "correct one of the two."
        )


def _check_target(target: ConeTarget, room: int) -> None:
    if target.kind not in (PLACE, COLLECT):
        raise JobError(f"Cone {target.id} is to be {target.kind!r}: write {PLACE} or {COLLECT}.")
    _check_number("cone", target.id, "theta", target.theta, -math.inf)
    _check_number("cone", target.id, "demand", target.demand, 1)
    _check_number("cone", target.id, "service_s", target.service_s, 0.0)
    if target.demand > room:
        raise JobError(
            f"Cone {target.id} takes room {target.demand}, and no robot has more than {room}: leave it out, "
            "or give a robot that carries it."
        )


def _check_number(what: str, name: str, field: str, value: float, least: float) -> None:
    if not (math.isfinite(value) and value >= least):
        expected = f"a number of {least:g} or more" if math.isfinite(least) else "a number"
        raise JobError(f"The {field} of {what} {name} is {value:g}: give {expected}.")


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names)


# --- Distances between places, and the paths that robots drive ---

STRAIGHT = "straight lines"


class Travel(Protocol):
    """Ways between the places of a job."""

    name: str
    """What the ways follow, for messages."""
    metres: Floats
    """(n, n) from row to column; infinity where no way leads."""

    def path(self, start: int, goal: int) -> Floats:
        """Return the points, (m, 2) with m ≥ 2, from place ``start`` to place ``goal``."""


class StraightTravel:
    """Ways as the crow flies: of a job without roads. Points are at most ``spacing`` metres apart."""

    name = STRAIGHT

    def __init__(self, job: AssignmentJob, spacing: float = 0.5) -> None:
        self._places = job.places
        self._spacing = spacing
        x, y = self._places.T
        self.metres: Floats = np.hypot(x[:, None] - x, y[:, None] - y)

    def path(self, start: int, goal: int) -> Floats:
        """Return the line between the two places."""
        return straight_path(self._places[start], self._places[goal], self._spacing)


class CancellableTravel:
    """The ways of ``inner``; its paths raise CancelledError once ``go_on()`` returns false."""

    def __init__(self, inner: Travel, go_on: Callable[[], bool]) -> None:
        self._inner, self._may_continue = inner, go_on
        self.name, self.metres = inner.name, inner.metres

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place."""
        if not self._may_continue():
            raise AssignmentCancelledError("The assignment was cancelled.")
        return self._inner.path(start, goal)


def straight_path(a: Floats, b: Floats, spacing: float) -> Floats:
    """Return the points from ``a`` to ``b`` at most ``spacing`` metres apart, at least two."""
    count = max(math.ceil(math.hypot(*(b - a)) / spacing - 1e-9), 1)
    points: Floats = a + (b - a) * (np.arange(count + 1) / count)[:, None]
    return points


# --- Ways along roads: distances, and the paths that robots drive on them ---


class RoadTravel:
    """The shortest ways on the roads of ``router`` that ``restrictions`` allow.

    From each place a straight line of at most ``reach`` metres leads to the nearest road. ``progress``
    receives the finished share of the distances, and may raise to end the work.

    :raises OffNetworkError: naming the places that are farther from every road.
    """

    def __init__(
        self,
        job: AssignmentJob,
        router: Router,
        driving: Driving | None = None,
        restrictions: Restrictions | None = None,
        reach: float = REACH,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        self._job, self._router = job, router
        self._driving, self._reach = driving or Driving(), reach
        self._restrictions = replace(restrictions or Restrictions(), fastest=False)
        places = [(float(x), float(y)) for x, y in job.places]
        found = road_matrix(router.network, places, self._restrictions, reach, router.closed, progress)
        far = np.flatnonzero(np.isinf(found.away)).tolist()
        if far:
            names = ", ".join(job.name(place) for place in far[:10]) + (
                " and others" if len(far) > 10 else ""
            )
            raise OffNetworkError(
                f"More than {reach:g} m from every road that may be used: {names}. Choose places nearer to a "
                "road, or allow a greater distance."
            )
        self.name = f"roads ({found.engine})"
        off = found.away
        self.metres: Floats = found.costs + off[:, None] + off[None, :]
        np.fill_diagonal(self.metres, 0.0)

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place: to the road, along it with rounded corners, and off it."""
        a, b = self._job.places[start], self._job.places[goal]
        if start == goal:
            return straight_path(a, b, self._driving.spacing)
        route = self._router.route(_place(a), _place(b), self._restrictions, self._reach)
        path = dense_path(route.points, route.widths, self._driving).points
        spacing = self._driving.spacing
        parts = [straight_path(a, path[0], spacing), path, straight_path(path[-1], b, spacing)]
        points = np.concatenate(parts)
        moves = np.hypot(*np.diff(points, axis=0).T) > 1e-6
        kept: Floats = points[np.concatenate([[True], moves])]
        return kept if len(kept) > 1 else straight_path(a, b, spacing)


def _place(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])
