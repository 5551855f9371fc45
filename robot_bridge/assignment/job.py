"""What is to be done: targets, the robots that may do it, and the stores where cones are kept."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .errors import JobError, MissingStoreError

Floats = NDArray[np.float64]

PLACE, COLLECT = "place", "collect"
TO_STORE, TO_START, STAY = "store", "start", "stay"
FINISHES = (TO_STORE, TO_START, STAY)
"""Where a robot goes after its last target: the nearest store, where it started, or nowhere."""


@dataclass(frozen=True)
class Target:
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
class Robot:
    """A robot as it is when the plan begins.

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
class Job:
    """Targets, robots and stores; checked when it is made.

    Its places are numbered: robots' starts first, then stores, then targets.

    :raises JobError: naming what cannot be planned for.
    """

    targets: tuple[Target, ...]
    robots: tuple[Robot, ...]
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
        everything: list[Robot | Store | Target] = [*self.robots, *self.stores, *self.targets]
        return np.array([(one.x, one.y) for one in everything], dtype=np.float64).reshape(-1, 2)

    @cached_property
    def stages(self) -> list[int]:
        """The stages that there are, in their order."""
        return sorted({target.stage for target in self.targets})

    @cached_property
    def place_of(self) -> dict[str, int]:
        """The number of each target's place by its id."""
        return {target.id: self.first_target + k for k, target in enumerate(self.targets)}

    def target(self, place: int) -> Target:
        """Return the target at ``place``."""
        return self.targets[place - self.first_target]

    def name(self, place: int) -> str:
        """Return what ``place`` is, as people are told."""
        if place < self.first_store:
            return f"the start of robot {self.robots[place].id}"
        if place < self.first_target:
            return f"store {self.stores[place - self.first_store].id}"
        return f"cone {self.target(place).id}"


def _check(job: Job) -> None:
    if not job.robots:
        raise JobError("There is no robot: give at least one.")
    if job.finish not in FINISHES:
        raise JobError(f"Finish {job.finish!r} is none: choose of {', '.join(FINISHES)}.")
    groups: tuple[tuple[str, Sequence[Target | Robot | Store]], ...] = (
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


def _needs_store(job: Job) -> bool:
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


def _check_robot(robot: Robot) -> None:
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


def _check_target(target: Target, room: int) -> None:
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
        wanted = f"a number of {least:g} or more" if math.isfinite(least) else "a number"
        raise JobError(f"The {field} of {what} {name} is {value:g}: give {wanted}.")


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names)
