"""Schedules of robots: trips, their cost, their assignment to robots, timetable of a plan."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .job import PLACE, TO_START, TO_STORE, AssignmentJob, Floats, Travel
from .plan import HOME, STORE, ConePlan, Path, PlannedTrip, PlanStop, RobotPlan

# --- The days of robots: targets of each trip, and their cost ---
# A day is a list of trips, a trip a list of the places of targets. Trip 0 uses the cones aboard at the start,
# and may be empty; a visit to a store precedes every other one.

Trip = list[int]
Schedule = list[Trip]


@dataclass(frozen=True)
class ScheduleCost:
    """Metres of a day, and the seconds at which its last target is done and at which the robot is home."""

    metres: float
    served_s: float
    home_s: float


class ScheduleEvaluator:
    """Measures days of the robots of ``job``; ``metres`` is (n, n) between its places.

    ``gates`` holds, by stage, the second before which none of its targets may be begun.
    """

    def __init__(self, job: AssignmentJob, metres: Floats) -> None:
        self.job = job
        self.gates: dict[int, float] = {}
        self.metres: list[list[float]] = metres.tolist()
        count, begin = len(job.places), job.first_target
        self.demand = [0] * begin + [target.demand for target in job.targets]
        self.places_cone = [False] * begin + [target.kind == PLACE for target in job.targets]
        self.service = [0.0] * begin + [target.service_s for target in job.targets]
        self.service[job.first_store : begin] = [store.service_s for store in job.stores]
        self.stage = [0] * begin + [target.stage for target in job.targets]
        stores = slice(job.first_store, begin)
        none = np.full(count, np.inf if not job.stores else 0.0)
        self.from_store: list[float] = (metres[stores].min(axis=0) if job.stores else none).tolist()
        self.to_store: list[float] = (metres[:, stores].min(axis=1) if job.stores else none).tolist()
        self._nearest = metres[:, stores].argmin(axis=1).tolist() if job.stores else []
        self._between: dict[tuple[int, int], int] = {}

    def fits(self, robot: int, trip: Sequence[int], first: bool) -> bool:
        """Whether ``robot`` has the room, and on its ``first`` trip the cones, for ``trip``."""
        one = self.job.robots[robot]
        need = sum(self.demand[place] for place in trip if self.places_cone[place])
        if first and need > one.aboard:
            return False
        load = one.aboard + one.collected if first else need
        for place in trip:
            if load > one.capacity:
                return False
            load += -self.demand[place] if self.places_cone[place] else self.demand[place]
        return load <= one.capacity

    def store_between(self, before: int, after: int) -> int:
        """Return the store with the shortest detour from ``before`` to ``after``."""
        pair = before, after
        if pair not in self._between:
            stores = range(self.job.first_store, self.job.first_target)
            self._between[pair] = min(stores, key=lambda s: self.metres[before][s] + self.metres[s][after])
        return self._between[pair]

    def tour(self, robot: int, day: Schedule) -> list[int]:
        """Return the places where the robot stops, one after another, with stores and where it ends."""
        tour: list[int] = list(day[0])
        for trip in day[1:]:
            if trip:
                tour += [self.store_between(tour[-1] if tour else robot, trip[0]), *trip]
        return tour + self._end(robot, day, tour)

    def _end(self, robot: int, day: Schedule, tour: list[int]) -> list[int]:
        collected = any(not self.places_cone[place] for place in self._last_trip(day))
        waiting = self.job.robots[robot].collected > 0 and not any(day[1:])
        if collected or waiting or (tour and self.job.finish == TO_STORE):
            home = [self.job.first_store + self._nearest[tour[-1] if tour else robot]]
        else:
            home = []
        return [*home, robot] if tour and self.job.finish == TO_START else home

    @staticmethod
    def _last_trip(day: Schedule) -> Trip:
        return next((trip for trip in reversed(day) if trip), [])

    def home_from(self, robot: int, place: int) -> tuple[float, float]:
        """Return the metres and seconds from the target at ``place``, the robot's last, to its day's end."""
        way = self.tour(robot, [[place]])
        metres = sum(self.metres[a][b] for a, b in pairwise(way))
        service = sum(self.service[one] for one in way[1:])
        return metres, metres / self.job.robots[robot].speed + service

    def cost(self, robot: int, day: Schedule) -> ScheduleCost:
        """Return the cost of ``day``; infinite metres if there is no way or too little battery."""
        one = self.job.robots[robot]
        tour = self.tour(robot, day)
        metres, clock, served, at = 0.0, one.ready_s, one.ready_s, robot
        begin, pace = self.job.first_target, 1.0 / one.speed
        for place in tour:
            leg = self.metres[at][place]
            metres += leg
            clock += leg * pace
            if place >= begin:
                gate = self.gates.get(self.stage[place], 0.0)
                clock = served = max(clock, gate) + self.service[place]
            else:
                clock += self.service[place]
            at = place
        if metres > one.range_m:
            metres = math.inf
        return ScheduleCost(metres, served, clock)

    def trip_metres(self, trip: Sequence[int]) -> float:
        """Return the metres of ``trip`` from the nearest store and back to the nearest one."""
        if not trip:
            return 0.0
        total, at = self.from_store[trip[0]], trip[0]
        for place in trip[1:]:
            total += self.metres[at][place]
            at = place
        return total + self.to_store[at]


# --- Assignment of trips to robots: longest trips first, each to the robot that suits the objective best

BALANCED, LEAST_DISTANCE = "balanced", "distance"
OBJECTIVES = (BALANCED, LEAST_DISTANCE)

Score = tuple[float, float]


@dataclass(frozen=True)
class StageObjective:
    """The objective to minimise; ``last`` says that robots' ways home count, as in the last stage."""

    objective: str = BALANCED
    last: bool = True

    def end(self, cost: ScheduleCost) -> float:
        """Return the seconds of one robot's day that count."""
        return cost.home_s if self.last else cost.served_s

    def score(self, costs: Sequence[ScheduleCost]) -> Score:
        """Return the value to compare; smaller is better."""
        latest = max(self.end(cost) for cost in costs)
        metres = sum(cost.metres for cost in costs)
        if math.isinf(metres):
            return math.inf, math.inf
        return (latest, metres) if self.objective == BALANCED else (metres, latest)


def scheduled(
    days: ScheduleEvaluator, trips: Sequence[Trip], start: Sequence[Schedule], aim: StageObjective
) -> tuple[list[Schedule], list[Trip]]:
    """Return ``start`` with ``trips`` driven by some robot, and those that no robot has the battery for."""
    plan = [[list(trip) for trip in day] for day in start]
    costs = [days.cost(robot, day) for robot, day in enumerate(plan)]
    left: list[Trip] = []
    for trip in sorted(trips, key=lambda one: -_length(days, one)):
        best: tuple[Score, int, Schedule, ScheduleCost] | None = None
        for robot, day in enumerate(plan):
            for longer in _with(days, robot, day, trip):
                cost = days.cost(robot, longer)
                score = aim.score([*costs[:robot], cost, *costs[robot + 1 :]])
                if score[0] < math.inf and (best is None or (score, robot) < best[:2]):
                    best = score, robot, longer, cost
        if best is None:
            left.append(trip)
            continue
        _, robot, plan[robot], costs[robot] = best
    return plan, left


def _with(days: ScheduleEvaluator, robot: int, day: Schedule, trip: Trip) -> list[Schedule]:
    """Return the days with ``trip`` appended: with the cones aboard, and after a visit to a store."""
    choices = []
    if days.fits(robot, day[-1] + trip, first=len(day) == 1):
        choices.append([*day[:-1], day[-1] + trip])
    if days.job.stores and days.fits(robot, trip, first=False):
        choices.append([*day, list(trip)])
    return choices


def _length(days: ScheduleEvaluator, trip: Trip) -> float:
    return days.trip_metres(trip) + sum(days.service[place] for place in trip)


# --- From days to a plan: loads, times and paths of every stop ---


def plan_of(
    days: ScheduleEvaluator, travel: Travel, plan: Sequence[Schedule], objective: str, method: str
) -> ConePlan:
    """Return the plan in which each robot has its day of ``plan``; ``days`` knows when stages may begin."""
    job = days.job
    robots = tuple(
        RobotPlan(one, _Clock(days, travel, robot).trips(day))
        for robot, (one, day) in enumerate(zip(job.robots, plan, strict=True))
    )
    return ConePlan(robots, job.targets, job.stores, job.finish, objective, method, travel.name)


class _Clock:
    """Follows one robot through its day."""

    def __init__(self, days: ScheduleEvaluator, travel: Travel, robot: int) -> None:
        one = days.job.robots[robot]
        self._days, self._travel, self._robot = days, travel, robot
        self._at, self._time = robot, one.ready_s
        self._aboard, self._collected = one.aboard, one.collected

    def trips(self, day: Schedule) -> tuple[PlannedTrip, ...]:
        rows = _trips_of_tour(self._days, self._days.tour(self._robot, day))
        return tuple(
            PlannedTrip(number, tuple(self._stop(place, self._need(row, k)) for k, place in enumerate(row)))
            for number, row in enumerate(rows, 1)
        )

    def _need(self, row: Trip, k: int) -> int:
        """Return the room of the cones that are placed after stop ``k``."""
        return sum(self._days.demand[place] for place in row[k + 1 :] if self._days.places_cone[place])

    def _stop(self, place: int, need: int) -> PlanStop:
        days, job = self._days, self._days.job
        metres = days.metres[self._at][place]
        arrival = self._time + metres / job.robots[self._robot].speed
        begin = arrival
        kind, name, theta, loaded, unloaded = HOME, job.robots[self._robot].id, 0.0, 0, 0
        if place >= job.first_target:
            target = job.target(place)
            kind, name, theta = target.kind, target.id, target.theta
            begin = max(arrival, days.gates.get(target.stage, 0.0))
            self._serve(place)
        elif place >= job.first_store:
            kind, name = STORE, job.stores[place - job.first_store].id
            loaded, unloaded = max(need - self._aboard, 0), self._collected + max(self._aboard - need, 0)
            self._aboard, self._collected = need, 0
        path = _rounded(self._travel.path(self._at, place))
        x, y = days.job.places[place].tolist()
        self._at, self._time = place, begin + days.service[place]
        return PlanStop(
            kind, name, x, y, theta, metres, arrival, begin, self._time,
            loaded, unloaded, self._aboard, self._collected, path,
        )  # fmt: skip

    def _serve(self, place: int) -> None:
        if self._days.places_cone[place]:
            self._aboard -= self._days.demand[place]
        else:
            self._collected += self._days.demand[place]


def _trips_of_tour(days: ScheduleEvaluator, tour: Sequence[int]) -> list[Trip]:
    """Return the stops of each trip; stops after the last target belong to the last trip."""
    begin = days.job.first_target
    last = max((k for k, place in enumerate(tour) if place >= begin), default=-1)
    rows: list[Trip] = []
    for k, place in enumerate(tour):
        if not rows or (place < begin and k < last):
            rows.append([])
        rows[-1].append(place)
    return rows


def _rounded(points: Floats) -> Path:
    return tuple((round(x, 3), round(y, 3)) for x, y in points.tolist())
