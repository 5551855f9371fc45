"""Days made into a plan: loads, times and paths of every stop."""

from __future__ import annotations

from collections.abc import Sequence

from .days import Day, Days, Trip
from .job import Floats
from .plan import HOME, STORE, Path, Plan, PlannedTrip, RobotPlan, Stop
from .travel import Travel


def plan_of(days: Days, travel: Travel, plan: Sequence[Day], objective: str, method: str) -> Plan:
    """Return the plan in which each robot has its day of ``plan``; ``days`` knows when stages may begin."""
    job = days.job
    robots = tuple(
        RobotPlan(one, _Clock(days, travel, robot).trips(day))
        for robot, (one, day) in enumerate(zip(job.robots, plan, strict=True))
    )
    return Plan(robots, job.targets, job.stores, job.finish, objective, method, travel.name)


class _Clock:
    """Follows one robot through its day."""

    def __init__(self, days: Days, travel: Travel, robot: int) -> None:
        one = days.job.robots[robot]
        self._days, self._travel, self._robot = days, travel, robot
        self._at, self._time = robot, one.ready_s
        self._aboard, self._collected = one.aboard, one.collected

    def trips(self, day: Day) -> tuple[PlannedTrip, ...]:
        rows = _trips_of_tour(self._days, self._days.tour(self._robot, day))
        return tuple(
            PlannedTrip(number, tuple(self._stop(place, self._need(row, k)) for k, place in enumerate(row)))
            for number, row in enumerate(rows, 1)
        )

    def _need(self, row: Trip, k: int) -> int:
        """Return the room of the cones that are placed after stop ``k``."""
        return sum(self._days.demand[place] for place in row[k + 1 :] if self._days.places_cone[place])

    def _stop(self, place: int, need: int) -> Stop:
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
        return Stop(
            kind, name, x, y, theta, metres, arrival, begin, self._time,
            loaded, unloaded, self._aboard, self._collected, path,
        )  # fmt: skip

    def _serve(self, place: int) -> None:
        if self._days.places_cone[place]:
            self._aboard -= self._days.demand[place]
        else:
            self._collected += self._days.demand[place]


def _trips_of_tour(days: Days, tour: Sequence[int]) -> list[Trip]:
    """Return the stops of each trip; what comes after the last target belongs to the last trip."""
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
