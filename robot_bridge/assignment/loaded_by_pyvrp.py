"""Days by PyVRP of robots that have aboard what they place, so that they need no store on their way.

Each robot is a vehicle of its own: from where it is, with the cones that it has left, to where its day ends.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from .days import Day, Days, Trip
from .job import Floats
from .pyvrp_search import UNIT, Clock, Problem, any_within, best_of_attempts, load_pyvrp, whole
from .scheduling import BALANCED, Aim

_STEPS = 1000
"""Steps in which a plan that ends earlier has to turn up, or is taken not to be."""
_FIRST_STEP, _LAST_STEP = 0.04, 0.001
"""Of the last robot's end: by how much earlier a plan is asked for at first, and at least."""
_TRIES = 0.7
"""Of the time: until when plans that end earlier are looked for; what is left makes the ways shorter."""


def loaded_days_by_pyvrp(
    days: Days, before: Sequence[Day], plan: Sequence[Day], aim: Aim, clock: Clock, seed: int = 0
) -> list[Day]:
    """Return days as good as the time of ``clock`` allows, found from ``plan``.

    ``before`` are the days without what is to be shared out, ``plan`` those with it: each target follows, on
    the first trip of some robot, what is in ``before``.

    :raises MissingSolverError: where PyVRP is not installed.
    """
    fleet = _Fleet(days, before, plan, aim)
    rows, bound_s = fleet.rows(plan), math.inf
    if aim.objective == BALANCED:
        rows = _ended_early(fleet, rows, clock, seed)
        bound_s = fleet.end(rows)
    problem = fleet.problem(bound_s)
    found = best_of_attempts(problem, fleet.solution(problem, rows), clock, seed)
    if found is None:
        # Rounded to what PyVRP counts in, not even these need be within the bound.
        return fleet.days_of(rows)
    return fleet.days_of(fleet.rows_of(found))


def _ended_early(fleet: _Fleet, rows: list[Trip], clock: Clock, seed: int) -> list[Trip]:
    """Return rows whose last robot ends as early as that of any that were found.

    PyVRP makes a sum least, not the greatest of many. So it is asked again and again for any plan that ends
    by an earlier time: much earlier after each success, less so after each failure.
    """
    end, step = fleet.end(rows), _FIRST_STEP
    while step >= _LAST_STEP and clock.share < _TRIES:
        problem = fleet.problem(end * (1.0 - step))
        found = any_within(problem, fleet.solution(problem, rows), clock, _STEPS, seed)
        # Rounded to what PyVRP counts in, a plan may keep to the bound and in fact end no earlier.
        if found is not None and fleet.end(fleet.rows_of(found)) < end:
            rows, step = fleet.rows_of(found), min(2 * step, 0.5)
            end = fleet.end(rows)
        else:
            step /= 2
    return rows


@dataclass(frozen=True)
class _Vehicle:
    """A robot with ``room`` cones aboard that are not placed yet, as it is at place ``at`` at ``ready_s``."""

    robot: int
    at: int
    room: int
    speed: float
    range_m: float
    ready_s: float


class _Fleet:
    """The robots that have cones aboard as PyVRP's vehicles, and the targets that they share.

    Its locations are where the vehicles begin, where they end, and the targets. The way home of a robot that
    is given nothing does not count; in what is planned last it has been driven before, or is not at all.
    """

    def __init__(self, days: Days, before: Sequence[Day], plan: Sequence[Day], aim: Aim) -> None:
        self._days, self._before, self._aim = days, before, aim
        self._vehicles = [one for robot, day in enumerate(before) if (one := _vehicle(days, robot, day))]
        self._targets = [place for row in self.rows(plan) for place in row]
        self._number = {place: k for k, place in enumerate(self._targets)}
        self._metres, self._home_s = self._ways()

    def rows(self, plan: Sequence[Day]) -> list[Trip]:
        """Return for each vehicle what its robot has in ``plan`` and had not before."""
        return [plan[one.robot][0][len(self._before[one.robot][0]) :] for one in self._vehicles]

    def rows_of(self, solution: Any) -> list[Trip]:
        """Return what ``solution`` gives each vehicle."""
        rows: list[Trip] = [[] for _ in self._vehicles]
        for route in solution.routes():
            row = [self._targets[activity.idx] for activity in route if activity.is_client()]
            rows[route.vehicle_type()] = row
        return rows

    def days_of(self, rows: Sequence[Trip]) -> list[Day]:
        """Return the robots' whole days with ``rows`` after what they had before."""
        made = [[list(trip) for trip in day] for day in self._before]
        for one, row in zip(self._vehicles, rows, strict=True):
            made[one.robot][0] += row
        return made

    def end(self, rows: Sequence[Trip]) -> float:
        """Return the second at which the last vehicle ends."""
        costs = [
            self._days.cost(one.robot, [self._before[one.robot][0] + row])
            for one, row in zip(self._vehicles, rows, strict=True)
        ]
        return max(self._aim.end(cost) for cost in costs)

    def solution(self, problem: Problem, rows: Sequence[Trip]) -> Any:
        """Return ``rows`` as a solution of ``problem``."""
        pyvrp = load_pyvrp()
        routes = [
            pyvrp.Route(problem.data, [self._number[place] for place in row], vehicle)
            for vehicle, row in enumerate(rows)
            if row
        ]
        return pyvrp.Solution(problem.data, routes)

    def problem(self, bound_s: float) -> Problem:
        """Return the problem in which every vehicle ends by ``bound_s``."""
        pyvrp, places = load_pyvrp(), self._days.job.places
        begins = [pyvrp.Location(*places[one.at].tolist()) for one in self._vehicles]
        speeds = sorted({one.speed for one in self._vehicles})
        data = pyvrp.ProblemData(
            [*begins, *begins, *(pyvrp.Location(*places[place].tolist()) for place in self._targets)],
            [self._client(location, place) for location, place in enumerate(self._targets, 2 * len(begins))],
            [pyvrp.Depot(location) for location in range(2 * len(begins))],
            [self._vehicle_type(k, speeds.index(one.speed), bound_s) for k, one in enumerate(self._vehicles)],
            [whole(self._metres)] * len(speeds),
            [whole(self._seconds(speed)) for speed in speeds],
        )
        return Problem(data, 2.0 * np.max(self._metres[np.isfinite(self._metres)], initial=0.0) / UNIT)

    def _ways(self) -> tuple[Floats, Floats]:
        """Return the metres between all locations, and the seconds from all to where each vehicle ends."""
        days, count = self._days, len(self._vehicles)
        size = 2 * count + len(self._targets)
        away, targets = np.array(days.metres), self._targets
        metres, home_s = np.zeros((size, size)), np.zeros((size, count))
        metres[2 * count :, 2 * count :] = away[np.ix_(targets, targets)]
        np.fill_diagonal(metres, 0.0)
        metres[:count, 2 * count :] = away[np.ix_([one.at for one in self._vehicles], targets)]
        for k, one in enumerate(self._vehicles):
            homes = np.array([days.home_from(one.robot, place) for place in targets])
            metres[2 * count :, count + k], home_s[2 * count :, k] = homes.T
        return metres, home_s

    def _seconds(self, speed: float) -> Floats:
        """Return the seconds between all locations; ways home count only where they do for the aim."""
        count = len(self._vehicles)
        seconds: Floats = self._metres / speed
        seconds[:, count : 2 * count] = self._home_s if self._aim.last else 0.0
        return seconds

    def _client(self, location: int, place: int) -> Any:
        days = self._days
        return load_pyvrp().Client(
            location,
            delivery=[days.demand[place]],
            service_duration=math.ceil(days.service[place] / UNIT),
            tw_early=math.ceil(days.gates.get(days.stage[place], 0.0) / UNIT),
        )

    def _vehicle_type(self, number: int, profile: int, bound_s: float) -> Any:
        one = self._vehicles[number]
        bounds: dict[str, int] = {}
        if math.isfinite(one.range_m):
            bounds["max_distance"] = max(math.floor(one.range_m / UNIT), 0)
        if math.isfinite(bound_s):
            bounds["tw_late"] = max(math.floor(bound_s / UNIT), math.floor(one.ready_s / UNIT))
        return load_pyvrp().VehicleType(
            1,
            [one.room],
            number,
            len(self._vehicles) + number,
            tw_early=math.floor(one.ready_s / UNIT),
            profile=profile,
            **bounds,
        )


def _vehicle(days: Days, robot: int, day: Day) -> _Vehicle | None:
    """Return the vehicle that ``robot`` is after ``day``; None where nothing is aboard for other targets."""
    one = days.job.robots[robot]
    # What it collects takes none of what it has aboard to place.
    room = one.aboard - sum(days.demand[place] for place in day[0] if days.places_cone[place])
    if len(day) > 1 or room < 1:
        return None
    way = [robot, *day[0]]
    metres = sum(days.metres[a][b] for a, b in pairwise(way))
    return _Vehicle(robot, way[-1], room, one.speed, one.range_m - metres, days.cost(robot, day).served_s)
