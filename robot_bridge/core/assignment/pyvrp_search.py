"""Vehicle routing by PyVRP: trips from stores, and days of robots that are loaded at the start."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ..errors import AssignmentCancelledError, MissingSolverError
from .job import Floats
from .local_search import TripLimits
from .schedules import BALANCED, Schedule, ScheduleEvaluator, StageObjective, Trip

# --- The solver PyVRP (Wouda, Lan and Kool, 2024), with settings for a few seconds
# It computes with integers: decimetres and tenths of a second.

UNIT = 0.1
"""Metres or seconds per integer unit."""
NO_WAY = 10**8
"""Decimetres or tenths of a second for a missing way."""
_NEIGHBOURS = 20
_MOST_CHANGES = 15
"""Most targets removed from a plan per step before repair; fewer allow more steps."""
_ATTEMPTS = 4
_LEAST_PATIENCE, _PATIENCE = 500, 150
"""Steps without improvement after which the search ends: a base, plus more per target."""
_HISTORY = 50
"""Length of the acceptance history in steps; restarts, not a long memory, lead out of dead ends."""
_BEYOND = np.iinfo(np.int64).max
"""PyVRP's cost of an infeasible plan."""
_STEPS_BETWEEN_PENALTIES = 100
"""Steps between adjustments of penalties, so that about two thirds of the plans are feasible."""


def load_pyvrp() -> Any:
    """Return the module.

    :raises MissingSolverError: if it is not installed.
    """
    try:
        import pyvrp
    except ImportError as error:
        raise MissingSolverError(
            f"The method 'pyvrp' needs the package pyvrp, which does not load here ({error}): install it "
            "with 'pip install \"pyvrp>=0.14,<0.15\"', or choose the method 'preview'."
        ) from error
    return pyvrp


Progress = Callable[[float], bool]
"""Receives the finished share of the work, 0 to 1; returns whether to continue."""


class SearchProgress:
    """Progress of a search: its shares are mapped to those from ``begin`` to ``end`` of the whole."""

    def __init__(self, goes_on: Progress, begin: float = 0.0, end: float = 1.0) -> None:
        self._progress, self._begin, self._end = goes_on, begin, end

    def report(self, share: float) -> None:
        """Report that ``share`` of the search is over; raises AssignmentCancelledError if it must end."""
        if not self._progress(self._begin + (self._end - self._begin) * share):
            raise AssignmentCancelledError("The assignment was cancelled.")

    def part(self, begin: float, end: float) -> SearchProgress:
        """Return the progress of a part, from ``begin`` to ``end`` of this."""
        length = self._end - self._begin
        return SearchProgress(self._progress, self._begin + length * begin, self._begin + length * end)


class SearchClock:
    """Measures the elapsed share of ``seconds`` and reports it to ``progress``, which may end the work."""

    def __init__(self, seconds: float, progress: SearchProgress) -> None:
        self._seconds = max(seconds, 1e-3)
        self._begun, self._progress = time.perf_counter(), progress

    @property
    def share(self) -> float:
        """Return the elapsed share of the time, and report it."""
        share = min((time.perf_counter() - self._begun) / self._seconds, 1.0)
        self._progress.report(share)
        return share

    @property
    def over(self) -> bool:
        """Whether the time is over."""
        return self.share >= 1.0


class RoutingProblem:
    """A problem for PyVRP: its ``data``, and the largest ``penalty`` per unit over a limit.

    Violating a limit need not cost more than repairing it; if it costs far more, as by PyVRP's default, only
    feasible plans are tried, and few of them lead to better ones.
    """

    def __init__(self, data: Any, penalty: float) -> None:
        self.data, self.penalty = data, max(penalty, 1.0)


def best_of_attempts(problem: RoutingProblem, start: Any, clock: SearchClock, seed: int) -> Any | None:
    """Return the shortest solution found from ``start``; None if none is within the limits.

    It ends early after long without improvement.
    """
    patience = _LEAST_PATIENCE + _PATIENCE * problem.data.num_clients
    best: Any = None
    # A good start may lead to a dead end: later attempts begin anywhere.
    for attempt in range(_ATTEMPTS):
        found = _solved(problem, None if attempt else start, _Patient(clock, patience), seed + attempt)
        if found.is_feasible() and (best is None or found.distance() < best.distance()):
            best = found
        if clock.over:
            break
    return best


def any_within(problem: RoutingProblem, start: Any, clock: SearchClock, steps: int, seed: int) -> Any | None:
    """Return some solution within the limits, near ``start``; None if ``steps`` find none."""
    found = _solved(problem, start, _UntilWithin(clock, steps), seed)
    return found if found.is_feasible() else None


def _solved(problem: RoutingProblem, start: Any | None, stop: Callable[[int], bool], seed: int) -> Any:
    pyvrp = load_pyvrp()
    with warnings.catch_warnings():
        # Infeasible limits simply yield no plan.
        warnings.simplefilter("ignore", pyvrp.exceptions.PenaltyBoundWarning)
        return pyvrp.solve(
            problem.data,
            stop,
            seed,
            collect_stats=False,
            params=_params(pyvrp, problem.penalty),
            initial_solution=start,
        ).best


class _Patient:
    """Stopping criterion: the time is over, or there was no improvement for long."""

    def __init__(self, clock: SearchClock, patience: int) -> None:
        self._clock, self._patience = clock, patience
        self._best, self._since = -1, 0

    def __call__(self, best_cost: int) -> bool:
        self._since = self._since + 1 if best_cost == self._best else 0
        self._best = best_cost
        return self._clock.over or self._since > self._patience


class _UntilWithin:
    """Stopping criterion: a feasible plan is found, the time is over, or the steps are done."""

    def __init__(self, clock: SearchClock, steps: int) -> None:
        self._clock, self._left = clock, steps

    def __call__(self, best_cost: int) -> bool:
        self._left -= 1
        return self._left < 0 or best_cost < _BEYOND or self._clock.over


def _params(pyvrp: Any, penalty: float) -> Any:
    from pyvrp.IteratedLocalSearch import IteratedLocalSearchParams
    from pyvrp.search import NeighbourhoodParams, PerturbationParams

    return pyvrp.SolveParams(
        ils=IteratedLocalSearchParams(history_length=_HISTORY, exhaustive_on_best=False),
        penalty=pyvrp.PenaltyParams(solutions_between_updates=_STEPS_BETWEEN_PENALTIES, max_penalty=penalty),
        # On one-way roads nearness depends on the direction.
        neighbourhood=NeighbourhoodParams(num_neighbours=_NEIGHBOURS, symmetric_proximity=False),
        perturbation=PerturbationParams(max_perturbations=_MOST_CHANGES),
    )


def whole(values: Floats) -> np.ndarray[Any, Any]:
    """Return metres or seconds as PyVRP counts them."""
    finite = np.isfinite(values)
    return np.where(finite, np.rint(np.where(finite, values, 0.0) / UNIT), NO_WAY).astype(np.int64)


# --- Trips by PyVRP, from a store and back, improved from good ones ---
# Where there are several stores, a trip begins and ends at the nearest one.


def trips_by_pyvrp(
    days: ScheduleEvaluator, trips: Sequence[Trip], limits: TripLimits, clock: SearchClock, seed: int = 0
) -> list[Trip] | None:
    """Return trips as good as the time of ``clock`` allows, starting from ``trips``.

    None if none within the limits are found.

    :raises MissingSolverError: where PyVRP is not installed.
    """
    pyvrp = load_pyvrp()
    targets = [place for trip in trips for place in trip]
    number = {place: k for k, place in enumerate(targets)}
    problem = _problem(pyvrp, days, targets, limits, len(trips))
    start = pyvrp.Solution(problem.data, [[number[place] for place in trip] for trip in trips])
    best = best_of_attempts(problem, start, clock, seed)
    if best is None:
        return None
    return [[targets[activity.idx] for activity in route if activity.is_client()] for route in best.routes()]


def _problem(
    pyvrp: Any, days: ScheduleEvaluator, targets: list[int], limits: TripLimits, trips: int
) -> RoutingProblem:
    """Return the problem; location 0 is the nearest store."""
    places = days.job.places
    middle = places[targets].mean(axis=0).tolist()
    metres = np.zeros((len(targets) + 1, len(targets) + 1))
    metres[0, 1:] = [days.from_store[place] for place in targets]
    metres[1:, 0] = [days.to_store[place] for place in targets]
    metres[1:, 1:] = [[days.metres[a][b] for b in targets] for a in targets]
    np.fill_diagonal(metres, 0.0)
    bounds: dict[str, int] = {}
    if math.isfinite(limits.range_m):
        bounds["max_distance"] = math.floor(limits.range_m / UNIT)
    if math.isfinite(limits.seconds):
        bounds["shift_duration"] = math.floor(limits.seconds / UNIT)
    vehicles = pyvrp.VehicleType(trips + math.ceil(len(targets) / 4) + 1, [limits.capacity], 0, 0, **bounds)
    data = pyvrp.ProblemData(
        [pyvrp.Location(*middle), *(pyvrp.Location(*places[place].tolist()) for place in targets)],
        [_client(pyvrp, days, k, place) for k, place in enumerate(targets, 1)],
        [pyvrp.Depot(0)],
        [vehicles],
        [whole(metres)],
        [whole(metres / limits.speed)],
    )
    # A target beyond one trip's limits needs at most a trip of its own, to the farthest target.
    rounds = metres[0, 1:] + metres[1:, 0]
    return RoutingProblem(data, rounds[np.isfinite(rounds)].max(initial=0.0) / UNIT)


def _client(pyvrp: Any, days: ScheduleEvaluator, location: int, place: int) -> Any:
    what = "delivery" if days.places_cone[place] else "pickup"
    service = math.ceil(days.service[place] / UNIT)
    return pyvrp.Client(location, service_duration=service, **{what: [days.demand[place]]})


# --- Days by PyVRP for robots that carry all their cones, and so need no store on their way
# Each robot is a vehicle of its own: from its place, with its remaining cones, to where its day ends.

_STEPS = 1000
"""Steps within which a plan that ends earlier must be found, or is taken not to exist."""
_FIRST_STEP, _LAST_STEP = 0.04, 0.001
"""Share of the last robot's end by which a plan must end earlier, at first and at least."""
_TRIES = 0.7
"""Share of the time for finding plans that end earlier; the rest is for shortening ways."""


def loaded_days_by_pyvrp(
    days: ScheduleEvaluator,
    before: Sequence[Schedule],
    plan: Sequence[Schedule],
    aim: StageObjective,
    clock: SearchClock,
    seed: int = 0,
) -> list[Schedule]:
    """Return days as good as the time of ``clock`` allows, found from ``plan``.

    ``before`` are the days without the targets to share out, ``plan`` those with them: each target follows
    the content of ``before`` on the first trip of some robot.

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
        # Rounded to PyVRP's units, not even these need be within the bound.
        return fleet.days_of(rows)
    return fleet.days_of(fleet.rows_of(found))


def _ended_early(fleet: _Fleet, rows: list[Trip], clock: SearchClock, seed: int) -> list[Trip]:
    """Return the rows found whose last robot ends earliest.

    PyVRP minimises a sum, not a maximum. So it is run repeatedly for any plan that ends by an earlier time:
    much earlier after each success, less so after each failure.
    """
    end, step = fleet.end(rows), _FIRST_STEP
    while step >= _LAST_STEP and clock.share < _TRIES:
        problem = fleet.problem(end * (1.0 - step))
        found = any_within(problem, fleet.solution(problem, rows), clock, _STEPS, seed)
        # Rounded to PyVRP's units, a plan may keep to the bound and in fact end no earlier.
        if found is not None and fleet.end(fleet.rows_of(found)) < end:
            rows, step = fleet.rows_of(found), min(2 * step, 0.5)
            end = fleet.end(rows)
        else:
            step /= 2
    return rows


@dataclass(frozen=True)
class _Vehicle:
    """A robot with ``room`` unplaced cones aboard, at place ``at`` from ``ready_s``."""

    robot: int
    at: int
    room: int
    speed: float
    range_m: float
    ready_s: float


class _Fleet:
    """The robots with cones aboard as PyVRP's vehicles, and the targets that they share.

    Its locations are where the vehicles begin, where they end, and the targets. The way home of a robot
    without targets does not count; in the last stage it was driven before, or never is.
    """

    def __init__(
        self,
        days: ScheduleEvaluator,
        before: Sequence[Schedule],
        plan: Sequence[Schedule],
        aim: StageObjective,
    ) -> None:
        self._days, self._before, self._aim = days, before, aim
        self._vehicles = [one for robot, day in enumerate(before) if (one := _vehicle(days, robot, day))]
        self._targets = [place for row in self.rows(plan) for place in row]
        self._number = {place: k for k, place in enumerate(self._targets)}
        self._metres, self._home_s = self._ways()

    def rows(self, plan: Sequence[Schedule]) -> list[Trip]:
        """Return for each vehicle the targets that its robot gained in ``plan``."""
        return [plan[one.robot][0][len(self._before[one.robot][0]) :] for one in self._vehicles]

    def rows_of(self, solution: Any) -> list[Trip]:
        """Return the targets of each vehicle in ``solution``."""
        rows: list[Trip] = [[] for _ in self._vehicles]
        for route in solution.routes():
            row = [self._targets[activity.idx] for activity in route if activity.is_client()]
            rows[route.vehicle_type()] = row
        return rows

    def days_of(self, rows: Sequence[Trip]) -> list[Schedule]:
        """Return the robots' whole days with ``rows`` appended to their earlier ones."""
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

    def solution(self, problem: RoutingProblem, rows: Sequence[Trip]) -> Any:
        """Return ``rows`` as a solution of ``problem``."""
        pyvrp = load_pyvrp()
        routes = [
            pyvrp.Route(problem.data, [self._number[place] for place in row], vehicle)
            for vehicle, row in enumerate(rows)
            if row
        ]
        return pyvrp.Solution(problem.data, routes)

    def problem(self, bound_s: float) -> RoutingProblem:
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
        return RoutingProblem(data, 2.0 * np.max(self._metres[np.isfinite(self._metres)], initial=0.0) / UNIT)

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
        """Return the seconds between all locations; ways home count only if they do for the objective."""
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


def _vehicle(days: ScheduleEvaluator, robot: int, day: Schedule) -> _Vehicle | None:
    """Return the vehicle of ``robot`` after ``day``; None if nothing is aboard for other targets."""
    one = days.job.robots[robot]
    # Collecting uses up none of the cones aboard.
    room = one.aboard - sum(days.demand[place] for place in day[0] if days.places_cone[place])
    if len(day) > 1 or room < 1:
        return None
    way = [robot, *day[0]]
    metres = sum(days.metres[a][b] for a, b in pairwise(way))
    return _Vehicle(robot, way[-1], room, one.speed, one.range_m - metres, days.cost(robot, day).served_s)
