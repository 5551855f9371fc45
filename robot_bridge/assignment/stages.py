"""One stage of a job: targets that are added to the days that robots have had so far."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from .days import Day, Days, Trip
from .improving import improved
from .loaded_by_pyvrp import loaded_days_by_pyvrp
from .pyvrp_search import Clock
from .savings import TripLimits, saving_pairs, trips_by_savings
from .scheduling import BALANCED, LEAST_DISTANCE, Aim, Score, scheduled
from .trips_by_pyvrp import trips_by_pyvrp

_SLACK = 1.05
"""By how much trips may be longer than an even share of the work."""
_FIRST_SHARE = 0.05
"""Of the time: until when the first plan is made better before PyVRP works on its trips."""
_LAST_SHARE = {BALANCED: 0.85, LEAST_DISTANCE: 0.97}
"""Of the time: until when PyVRP may work. It shortens trips; to share them out evenly is left to do then."""


@dataclass(frozen=True)
class Answer:
    """The days, the targets that no robot has the battery for, and whether PyVRP's trips are in them."""

    plan: list[Day]
    left: Trip
    score: Score
    by_pyvrp: bool = False

    @property
    def rank(self) -> tuple[int, Score]:
        """What is compared, the lesser the better."""
        return len(self.left), self.score


@dataclass(frozen=True)
class Effort:
    """The seconds a stage may take, whether PyVRP works on it, and who is told which share is over."""

    seconds: float
    use_pyvrp: bool
    progress: Callable[[float], None]
    seed: int = 0


def solved_stage(
    days: Days, targets: Sequence[int], start: Sequence[Day], aim: Aim, effort: Effort
) -> Answer:
    """Return the days that serve ``targets`` after what is in ``start``."""
    begun = time.perf_counter()

    def over(share: float) -> bool:
        passed = (time.perf_counter() - begun) / max(effort.seconds, 1e-3)
        effort.progress(min(passed, 1.0))
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
        second: Answer | None = _with_trips(
            days, trips_by_pyvrp(days, trips, limits, clock, effort.seed), begin, aim
        )
    else:
        plan = first.plan if _all_on_board(first.plan, start) else begin
        made = loaded_days_by_pyvrp(days, start, plan, aim, clock, effort.seed)
        second = Answer(made, [], _score(days, made, aim), by_pyvrp=True)
    if second is None:
        return _improved(days, first, targets, aim, lambda: over(1.0))
    second = _improved(days, second, targets, aim, lambda: over(1.0))
    return min(first, second, key=lambda answer: answer.rank)


def _clock_of_pyvrp(effort: Effort, aim: Aim, seconds_left: float) -> Clock:
    """Return the clock of what PyVRP does: it leaves time for small changes."""
    begin, end = _FIRST_SHARE, _LAST_SHARE[aim.objective]
    seconds = seconds_left - effort.seconds * (1.0 - end)
    return Clock(seconds, lambda share: effort.progress(begin + (end - begin) * share))


def _all_on_board(plan: Sequence[Day], start: Sequence[Day]) -> bool:
    """Whether ``plan`` adds to ``start`` only what is placed before any visit to a store."""
    return all(day[1:] == before[1:] for day, before in zip(plan, start, strict=True))


def _on_board(days: Days, targets: Sequence[int], start: Sequence[Day]) -> list[Day]:
    """Return the days with the cones that are aboard from the start given to the nearest targets.

    Of all robots the one goes next that has the shortest way to a target.
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


def _next_on_board(days: Days, robot: int, day: Day, left: set[int]) -> tuple[float, int] | None:
    """Return the nearest place of ``left`` that ``robot`` can serve next with what is aboard, and how far."""
    away = days.metres[day[0][-1] if day[0] else robot]
    for place in sorted(left, key=lambda one: (away[one], one)):
        longer = [[*day[0], place]]
        if days.fits(robot, longer[0], True) and days.cost(robot, longer).metres < math.inf:
            return away[place], place
    return None


def _first(days: Days, targets: list[int], start: list[Day], aim: Aim) -> tuple[Answer, TripLimits]:
    pairs = saving_pairs(days, targets)
    best: tuple[Answer, TripLimits] | None = None
    for limits in _limits(days, targets, aim):
        answer = _assigned(days, trips_by_savings(days, targets, pairs, limits), start, aim)
        if best is None or answer.rank < best[0].rank:
            best = answer, limits
    assert best is not None
    return best


def _limits(days: Days, targets: list[int], aim: Aim) -> list[TripLimits]:
    """Return what trips may be bounded by; long trips are few, short ones can be shared out evenly."""
    robots = days.job.robots
    heaviest = max((days.demand[place] for place in targets), default=1)
    rooms = sorted({robot.capacity for robot in robots if robot.capacity >= heaviest})
    speed = sorted(robot.speed for robot in robots)[len(robots) // 2]
    longest = max(robot.range_m for robot in robots)
    made = [TripLimits(room, longest, math.inf, speed) for room in rooms]
    if math.isfinite(longest):
        made += [replace(limits, range_m=longest / 2) for limits in made]
    work = sum(days.demand[place] for place in targets)
    if aim.objective != BALANCED or work > 4 * len(robots) * rooms[-1]:
        return made
    alone = [days.trip_metres([place]) / speed + days.service[place] for place in targets]
    share = sum(alone) / len(robots)
    shares = {max(share * _SLACK / parts, max(alone, default=0.0)) for parts in (1, 2, 3, 4, 6)}
    return made + [replace(one, seconds=each) for one in made for each in sorted(shares)]


def _assigned(days: Days, trips: Sequence[Trip], start: Sequence[Day], aim: Aim) -> Answer:
    plan, left = scheduled(days, trips, start, aim)
    if left:
        plan, left = scheduled(days, [[place] for trip in left for place in trip], plan, aim)
    return Answer(plan, [place for trip in left for place in trip], _score(days, plan, aim))


def _improved(
    days: Days, answer: Answer, targets: Sequence[int], aim: Aim, stop: Callable[[], bool]
) -> Answer:
    movable = set(targets) - set(answer.left)
    plan = improved(days, answer.plan, movable, aim, stop)
    if not answer.left:
        return replace(answer, plan=plan, score=_score(days, plan, aim))
    return _assigned(days, [[place] for place in answer.left], plan, aim)


def _trips(plan: Sequence[Day], targets: set[int]) -> list[Trip]:
    """Return the trips of ``plan``, of each what serves ``targets``."""
    trips = [[place for place in trip if place in targets] for day in plan for trip in day]
    return [trip for trip in trips if trip]


def _with_trips(days: Days, trips: list[Trip] | None, start: list[Day], aim: Aim) -> Answer | None:
    """Return PyVRP's answer for ``trips`` after ``start``; None where some robot's battery is too short."""
    if trips is None:
        return None
    answer = replace(_assigned(days, trips, start, aim), by_pyvrp=True)
    return None if answer.left else answer


def _score(days: Days, plan: Sequence[Day], aim: Aim) -> Score:
    return aim.score([days.cost(robot, day) for robot, day in enumerate(plan)])
