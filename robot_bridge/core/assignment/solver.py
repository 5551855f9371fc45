"""Solver: assignment of targets to robots and trips, stage by stage, by PyVRP or as a preview."""

from __future__ import annotations

import importlib.util
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from ..errors import JobError, UnservedError, counted, listed_names
from . import pyvrp_search, schedules
from .job import AssignmentJob, CancellableTravel, Travel
from .local_search import TripLimits, improved, saving_pairs, trips_by_savings
from .plan import ConePlan
from .schedules import Schedule, ScheduleEvaluator, Score, StageObjective, Trip

# --- One stage of a job: targets added to the robots' days so far ---

_SLACK = 1.05
"""By how much trips may be longer than an even share of the work."""
_FIRST_SHARE = 0.05
"""Share of the time for improving the first plan before PyVRP works on its trips."""
_LAST_SHARE = {schedules.BALANCED: 0.85, schedules.LEAST_DISTANCE: 0.97}
"""Share of the time until which PyVRP may work. It shortens trips; the rest is for sharing them out
evenly."""


@dataclass(frozen=True)
class StageSolution:
    """The days, the targets that no robot has the battery for, and whether PyVRP's trips are in them."""

    plan: list[Schedule]
    left: Trip
    score: Score
    by_pyvrp: bool = False

    @property
    def rank(self) -> tuple[int, Score]:
        """The value to compare; smaller is better."""
        return len(self.left), self.score


@dataclass(frozen=True)
class Effort:
    """Seconds of a stage, whether PyVRP works on it, and the receiver of progress."""

    seconds: float
    use_pyvrp: bool
    progress: pyvrp_search.SearchProgress
    seed: int = 0


def solved_stage(
    days: ScheduleEvaluator,
    targets: Sequence[int],
    start: Sequence[Schedule],
    aim: StageObjective,
    effort: Effort,
) -> StageSolution:
    """Return the days that serve ``targets`` after what is in ``start``."""
    begun = time.perf_counter()

    def over(share: float) -> bool:
        passed = (time.perf_counter() - begun) / max(effort.seconds, 1e-3)
        effort.progress.report(min(passed, 1.0))
        return passed >= share

    begin = _on_board(days, targets, start)
    served = {place for day in begin for trip in day for place in trip}
    others = [place for place in targets if place not in served]
    first, limits = _first(days, others, begin, aim)
    share = _FIRST_SHARE if effort.use_pyvrp else 1.0
    over(share)
    first = _improved(days, first, targets, aim, lambda: over(share))
    if not effort.use_pyvrp or first.left or not targets:
        return first
    clock = _clock_of_pyvrp(effort, aim, effort.seconds - (time.perf_counter() - begun))
    if others:
        trips = _trips(first.plan, set(others))
        second: StageSolution | None = _with_trips(
            days, pyvrp_search.trips_by_pyvrp(days, trips, limits, clock, effort.seed), begin, aim
        )
    else:
        plan = first.plan if _all_on_board(first.plan, start) else begin
        made = pyvrp_search.loaded_days_by_pyvrp(days, start, plan, aim, clock, effort.seed)
        second = StageSolution(made, [], _score(days, made, aim), by_pyvrp=True)
    if second is None:
        return _improved(days, first, targets, aim, lambda: over(1.0))
    second = _improved(days, second, targets, aim, lambda: over(1.0))
    return min(first, second, key=lambda answer: answer.rank)


def _clock_of_pyvrp(effort: Effort, aim: StageObjective, seconds_left: float) -> pyvrp_search.SearchClock:
    """Return the clock for PyVRP: it leaves time for small changes."""
    begin, end = _FIRST_SHARE, _LAST_SHARE[aim.objective]
    seconds = seconds_left - effort.seconds * (1.0 - end)
    return pyvrp_search.SearchClock(seconds, effort.progress.part(begin, end))


def _all_on_board(plan: Sequence[Schedule], start: Sequence[Schedule]) -> bool:
    """Whether ``plan`` adds to ``start`` only what is placed before any visit to a store."""
    return all(day[1:] == before[1:] for day, before in zip(plan, start, strict=True))


def _on_board(days: ScheduleEvaluator, targets: Sequence[int], start: Sequence[Schedule]) -> list[Schedule]:
    """Return the days in which cones aboard from the start go to the nearest targets.

    The robot with the shortest way to a target goes next.
    """
    plan = [[list(trip) for trip in day] for day in start]
    left = {place for place in targets if days.places_cone[place]}
    loaded = [robot for robot, one in enumerate(days.job.robots) if one.aboard and len(plan[robot]) == 1]
    ways = {robot: _next_on_board(days, robot, plan[robot], left) for robot in loaded}
    while found := {robot: way for robot, way in ways.items() if way is not None}:
        robot = min(found, key=found.__getitem__)
        _, place = found[robot]
        plan[robot][0].append(place)
        left.remove(place)
        for other, (_, its) in found.items():
            if its == place:
                ways[other] = _next_on_board(days, other, plan[other], left)
    return plan


def _next_on_board(
    days: ScheduleEvaluator, robot: int, day: Schedule, left: set[int]
) -> tuple[float, int] | None:
    """Return the nearest place of ``left`` that ``robot`` can serve next with what is aboard, and how far."""
    away = days.metres[day[0][-1] if day[0] else robot]
    for place in sorted(left, key=lambda one: (away[one], one)):
        longer = [[*day[0], place]]
        if days.fits(robot, longer[0], True) and days.cost(robot, longer).metres < math.inf:
            return away[place], place
    return None


def _first(
    days: ScheduleEvaluator, targets: list[int], start: list[Schedule], aim: StageObjective
) -> tuple[StageSolution, TripLimits]:
    pairs = saving_pairs(days, targets)
    best: tuple[StageSolution, TripLimits] | None = None
    for limits in _limits(days, targets, aim):
        answer = _assigned(days, trips_by_savings(days, targets, pairs, limits), start, aim)
        if best is None or answer.rank < best[0].rank:
            best = answer, limits
    assert best is not None
    return best


def _limits(days: ScheduleEvaluator, targets: list[int], aim: StageObjective) -> list[TripLimits]:
    """Return candidate limits of trips; long trips are few, short ones can be shared out evenly."""
    robots = days.job.robots
    heaviest = max((days.demand[place] for place in targets), default=1)
    rooms = sorted({robot.capacity for robot in robots if robot.capacity >= heaviest})
    speed = sorted(robot.speed for robot in robots)[len(robots) // 2]
    longest = max(robot.range_m for robot in robots)
    made = [TripLimits(room, longest, math.inf, speed) for room in rooms]
    if math.isfinite(longest):
        made += [replace(limits, range_m=longest / 2) for limits in made]
    work = sum(days.demand[place] for place in targets)
    if aim.objective != schedules.BALANCED or work > 4 * len(robots) * rooms[-1]:
        return made
    alone = [days.trip_metres([place]) / speed + days.service[place] for place in targets]
    share = sum(alone) / len(robots)
    shares = {max(share * _SLACK / parts, max(alone, default=0.0)) for parts in (1, 2, 3, 4, 6)}
    return made + [replace(one, seconds=each) for one in made for each in sorted(shares)]


def _assigned(
    days: ScheduleEvaluator, trips: Sequence[Trip], start: Sequence[Schedule], aim: StageObjective
) -> StageSolution:
    plan, left = schedules.scheduled(days, trips, start, aim)
    if left:
        plan, left = schedules.scheduled(days, [[place] for trip in left for place in trip], plan, aim)
    return StageSolution(plan, [place for trip in left for place in trip], _score(days, plan, aim))


def _improved(
    days: ScheduleEvaluator,
    answer: StageSolution,
    targets: Sequence[int],
    aim: StageObjective,
    stop: Callable[[], bool],
) -> StageSolution:
    movable = set(targets) - set(answer.left)
    plan = improved(days, answer.plan, movable, aim, stop)
    if not answer.left:
        return replace(answer, plan=plan, score=_score(days, plan, aim))
    return _assigned(days, [[place] for place in answer.left], plan, aim)


def _trips(plan: Sequence[Schedule], targets: set[int]) -> list[Trip]:
    """Return the trips of ``plan``, reduced to those of ``targets``."""
    trips = [[place for place in trip if place in targets] for day in plan for trip in day]
    return [trip for trip in trips if trip]


def _with_trips(
    days: ScheduleEvaluator, trips: list[Trip] | None, start: list[Schedule], aim: StageObjective
) -> StageSolution | None:
    """Return PyVRP's answer for ``trips`` after ``start``; None where some robot's battery is too short."""
    if trips is None:
        return None
    answer = replace(_assigned(days, trips, start, aim), by_pyvrp=True)
    return None if answer.left else answer


def _score(days: ScheduleEvaluator, plan: Sequence[Schedule], aim: StageObjective) -> Score:
    return aim.score([days.cost(robot, day) for robot, day in enumerate(plan)])


# --- Assignment stage by stage, by PyVRP or as a quick preview ---

AUTOMATIC, PYVRP, PREVIEW = "automatic", "pyvrp", "preview"
PREVIEW_KEPT = f"{PYVRP}, which found nothing better than the preview"
"""The method of a plan that PyVRP could not improve."""
METHODS = (AUTOMATIC, PYVRP, PREVIEW)


@dataclass(frozen=True)
class Objective:
    """The objective to minimise, by which method, and how many seconds it may take.

    :raises JobError: when one of them is invalid.
    """

    objective: str = schedules.BALANCED
    method: str = AUTOMATIC
    time_limit_s: float = 10.0
    seed: int = 0

    def __post_init__(self) -> None:
        for what, value, choices in (
            ("objective", self.objective, schedules.OBJECTIVES),
            ("method", self.method, METHODS),
        ):
            if value not in choices:
                raise JobError(f"There is no {what} {value!r}: choose of {', '.join(choices)}.")
        if not (math.isfinite(self.time_limit_s) and self.time_limit_s > 0):
            raise JobError(f"The time limit is {self.time_limit_s:g} s: give seconds above 0.")


def assign(
    job: AssignmentJob,
    travel: Travel,
    objective: Objective | None = None,
    progress: pyvrp_search.Progress | None = None,
) -> ConePlan:
    """Return the plan by which the robots of ``job`` serve all its targets.

    :raises UnservedError: naming targets that no robot can reach or has the battery for; MissingSolverError
        when PyVRP is requested but not installed; CancelledError when ``progress`` returns false.
    """
    objective = objective or Objective()
    use_pyvrp = _use_pyvrp(objective.method)
    days = ScheduleEvaluator(job, travel.metres)
    _refuse_unreachable(days)
    progress = progress or (lambda share: True)
    plan, improved_by_pyvrp = _solved(days, objective, use_pyvrp, progress)
    method = PREVIEW
    if use_pyvrp:
        method = PYVRP if improved_by_pyvrp else PREVIEW_KEPT
    return schedules.plan_of(
        days, CancellableTravel(travel, lambda: progress(1.0)), plan, objective.objective, method
    )


def _use_pyvrp(method: str) -> bool:
    if method == PYVRP:
        pyvrp_search.load_pyvrp()
    return method == PYVRP or (method == AUTOMATIC and importlib.util.find_spec("pyvrp") is not None)


def _solved(
    days: ScheduleEvaluator, objective: Objective, use_pyvrp: bool, progress: pyvrp_search.Progress
) -> tuple[list[Schedule], bool]:
    job = days.job
    plan: list[Schedule] = [[[]] for _ in job.robots]
    done, by_pyvrp = 0, False
    for stage in job.stages:
        targets = [place for place in _places(job) if job.target(place).stage == stage]
        before, part = done / len(job.targets), len(targets) / len(job.targets)
        aim = StageObjective(objective.objective, last=stage == job.stages[-1])
        tell = pyvrp_search.SearchProgress(progress, before, before + part)
        effort = Effort(objective.time_limit_s * part, use_pyvrp, tell, objective.seed)
        answer = solved_stage(days, targets, plan, aim, effort)
        if answer.left:
            _refuse(job, answer.left)
        plan, by_pyvrp = answer.plan, by_pyvrp or answer.by_pyvrp
        done += len(targets)
        _close_stage(days, plan, stage)
    return plan, by_pyvrp


def _places(job: AssignmentJob) -> range:
    return range(job.first_target, len(job.places))


def _close_stage(days: ScheduleEvaluator, plan: Sequence[Schedule], stage: int) -> None:
    """Let targets of later stages wait until all targets in ``plan`` are done."""
    end = max(days.cost(robot, day).served_s for robot, day in enumerate(plan) if any(day))
    for later in days.job.stages:
        if later > stage:
            days.gates[later] = end


def _refuse_unreachable(days: ScheduleEvaluator) -> None:
    for reason, what_to_do, reachable in (
        ("no way leads from any robot to", "check roads, closed roads and one-way roads", _has_way),
        ("no robot has the battery for", "charge the robots, or place a store nearer", _has_battery),
    ):
        bad = [place for place in _places(days.job) if not reachable(days, place)]
        if bad:
            raise UnservedError(
                f"{counted(len(bad), 'cone')} cannot be served; {reason} {_named(days.job, bad)}: "
                f"{what_to_do}, or leave the cones out.",
                tuple(days.job.target(place).id for place in bad),
            )


def _alone(days: ScheduleEvaluator, place: int) -> list[tuple[int, Schedule]]:
    """Return the days of robots that could serve ``place`` if it were the only target."""
    robots = range(len(days.job.robots))
    on_board: list[tuple[int, Schedule]] = [
        (one, [[place]]) for one in robots if days.fits(one, [place], True)
    ]
    if not days.job.stores:
        return on_board
    return on_board + [(one, [[], [place]]) for one in robots if days.fits(one, [place], False)]


def _has_way(days: ScheduleEvaluator, place: int) -> bool:
    return any(_metres(days, robot, day) < math.inf for robot, day in _alone(days, place))


def _has_battery(days: ScheduleEvaluator, place: int) -> bool:
    return any(days.cost(robot, day).metres < math.inf for robot, day in _alone(days, place))


def _metres(days: ScheduleEvaluator, robot: int, day: Schedule) -> float:
    tour = [robot, *days.tour(robot, day)]
    return sum(days.metres[a][b] for a, b in pairwise(tour))


def _refuse(job: AssignmentJob, left: Sequence[int]) -> None:
    raise UnservedError(
        f"The robots' batteries do not suffice for all {len(job.targets)} cones; left over are "
        f"{_named(job, left)}: charge the robots, give more of them, or leave cones out.",
        tuple(job.target(place).id for place in left),
    )


def _named(job: AssignmentJob, places: Sequence[int]) -> str:
    return listed_names([job.target(place).id for place in places])
