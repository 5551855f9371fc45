"""Preview heuristics: savings (Clarke and Wright, 1964) and local search."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .schedules import BALANCED, Schedule, ScheduleEvaluator, Score, StageObjective, Trip

# --- Trips by savings (Clarke and Wright, 1964): metres saved by joining two trips ---

Pairs = list[tuple[int, int]]


@dataclass(frozen=True)
class TripLimits:
    """Limits of each trip: room, metres, and seconds at ``speed`` including service times."""

    capacity: int
    range_m: float = math.inf
    seconds: float = math.inf
    speed: float = 1.0

    def allow(self, days: ScheduleEvaluator, trip: Sequence[int]) -> bool:
        """Whether ``trip``, from a store and back to one, keeps within the limits."""
        load = sum(days.demand[place] for place in trip if days.places_cone[place])
        for place in trip:
            if load > self.capacity:
                return False
            load += -days.demand[place] if days.places_cone[place] else days.demand[place]
        if load > self.capacity:
            return False
        if math.isinf(self.range_m) and math.isinf(self.seconds):
            return True
        metres = days.trip_metres(trip)
        return metres <= self.range_m and self.duration(days, trip, metres) <= self.seconds

    def duration(self, days: ScheduleEvaluator, trip: Sequence[int], metres: float) -> float:
        """Return the seconds that ``trip`` takes."""
        return metres / self.speed + sum(days.service[place] for place in trip)


def trips_by_savings(
    days: ScheduleEvaluator, targets: Sequence[int], pairs: Pairs, limits: TripLimits
) -> list[Trip]:
    """Return trips that serve every one of ``targets``; each begins and ends at the nearest store.

    ``pairs`` is what :func:`saving_pairs` returns. A target that exceeds the limits alone has a trip of its
    own.
    """
    trip_of: dict[int, Trip] = {target: [target] for target in targets}
    for a, b in pairs:
        one, other = trip_of[a], trip_of[b]
        if one is other:
            continue
        joined = _joined(days, one, other, a, b)
        if joined is not None and limits.allow(days, joined):
            for target in joined:
                trip_of[target] = joined
    kept = {id(trip): trip for trip in trip_of.values()}
    return list(kept.values())


def saving_pairs(days: ScheduleEvaluator, targets: Sequence[int]) -> Pairs:
    """Return the pairs that save metres when the second follows the first, the best first."""
    some = np.array(targets, dtype=np.int64)
    metres = np.array([[days.metres[a][b] for b in targets] for a in targets]).reshape(len(some), len(some))
    back, out = (np.array(column)[some] for column in (days.to_store, days.from_store))
    saved = back[:, None] + out[None, :] - metres
    np.fill_diagonal(saved, 0.0)
    saved[~np.isfinite(saved)] = 0.0
    # On a one-way loop all successive pairs save the same: the nearest come first.
    order = np.lexsort([metres.ravel(), -np.round(saved, 3).ravel()])[: int((saved > 0).sum())]
    first, second = np.unravel_index(order, saved.shape)
    return list(zip(some[first].tolist(), some[second].tolist(), strict=True))


def _joined(days: ScheduleEvaluator, one: Trip, other: Trip, a: int, b: int) -> Trip | None:
    """Return the trip in which ``b`` follows ``a``; None if they are not at ends that can be joined."""
    if a == one[-1] and b == other[0]:
        return one + other
    if a == one[0] and b == other[0]:
        joined = one[::-1] + other
    elif a == one[-1] and b == other[-1]:
        joined = one + other[::-1]
    else:
        return None
    # On one-way roads a reversed trip may be longer.
    apart = days.trip_metres(one) + days.trip_metres(other)
    return joined if days.trip_metres(joined) < apart else None


# --- Changes of plans: candidate moves around one target ---

Slot = tuple[int, int]
"""Robot, and number of the trip in its day."""
TripChange = dict[Slot, Trip]
"""New contents of trips; a new trip has the next number of the day."""
DayChange = dict[int, Schedule]
"""New days, by robot."""

_LONGEST = 3
"""Most targets in a row that are moved together."""


def nearest_targets(metres: Sequence[Sequence[float]], targets: Sequence[int], count: int) -> dict[int, Trip]:
    """Return for each of ``targets`` the ``count`` nearest others, whichever way is shorter."""
    some = np.array(targets)
    away = np.array([[metres[a][b] for b in targets] for a in targets]).reshape(len(some), len(some))
    away = np.minimum(away, away.T)
    np.fill_diagonal(away, np.inf)
    order = np.argsort(away, axis=1, kind="stable")[:, : min(count, len(some) - 1)]
    return {target: some[row].tolist() for target, row in zip(targets, order, strict=True)}


def moves_beside(plan: Sequence[Schedule], a: Slot, at: int, b: Slot, beside: int) -> Iterator[TripChange]:
    """Yield the changes that bring the target at place ``at`` of trip ``a`` beside that of trip ``b``."""
    one, other = plan[a[0]][a[1]], plan[b[0]][b[1]]
    if a == b:
        yield from ({a: trip} for trip in _within(one, at, beside))
        return
    for length in range(1, min(_LONGEST, len(one) - at) + 1):
        row, rest = one[at : at + length], one[:at] + one[at + length :]
        for where in (beside, beside + 1):
            yield {a: rest, b: other[:where] + row + other[where:]}
            if length > 1:
                yield {a: rest, b: other[:where] + row[::-1] + other[where:]}
    yield {
        a: [*one[:at], other[beside], *one[at + 1 :]],
        b: [*other[:beside], one[at], *other[beside + 1 :]],
    }
    yield {a: one[: at + 1] + other[beside:], b: other[:beside] + one[at + 1 :]}
    yield {a: one[: at + 1] + other[beside::-1], b: one[:at:-1] + other[beside + 1 :]}


def _within(trip: Trip, at: int, beside: int) -> Iterator[Trip]:
    low, high = sorted((at, beside))
    yield trip[:low] + trip[low : high + 1][::-1] + trip[high + 1 :]
    yield trip[: low + 1] + trip[low + 1 : high + 1][::-1] + trip[high + 1 :]
    for length in range(1, min(_LONGEST, len(trip) - at) + 1):
        row, rest = trip[at : at + length], trip[:at] + trip[at + length :]
        if at <= beside < at + length:
            continue
        where = beside if beside < at else beside - length
        for place in (where, where + 1):
            yield rest[:place] + row + rest[place:]


def moves_elsewhere(plan: Sequence[Schedule], a: Slot, at: int) -> Iterator[TripChange]:
    """Yield the changes that give the target a trip of its own, or the first place of an empty one."""
    robot, number = a
    trip = plan[robot][number]
    rest = trip[:at] + trip[at + 1 :]
    for other, day in enumerate(plan):
        yield {a: rest, (other, len(day)): [trip[at]]}
        if not day[0] and a != (other, 0):
            yield {a: rest, (other, 0): [trip[at]]}


def moves_of_trips(plan: Sequence[Schedule], a: Slot, first_free: Sequence[int]) -> Iterator[DayChange]:
    """Yield the changes that drive trip ``a`` at another time, by another robot, or in exchange for another.

    Trips of robot ``r`` may be inserted from number ``first_free[r]`` on.
    """
    robot, number = a
    trip, day = plan[robot][number], plan[robot]
    rest = day[:number] + day[number + 1 :]
    for other, its in enumerate(plan):
        without = rest if other == robot else its
        for place in {first_free[other], len(without)}:
            changed = [*without[:place], trip, *without[place:]]
            yield {other: changed} if other == robot else {robot: rest, other: changed}
        for k in range(first_free[other], len(its)):
            if other != robot:
                yield {
                    robot: [*day[:number], its[k], *day[number + 1 :]],
                    other: [*its[:k], trip, *its[k + 1 :]],
                }


# --- Improvement of plans by small changes, each measured on the whole days of the robots concerned

_NEAREST = 12
_LEAST_GAIN = 1e-6


def improved(
    days: ScheduleEvaluator,
    plan: Sequence[Schedule],
    movable: Iterable[int],
    aim: StageObjective,
    stop: Callable[[], bool],
) -> list[Schedule]:
    """Return ``plan`` improved by changes of ``movable`` targets until ``stop()`` returns true."""
    search = _Search(days, plan, sorted(movable), aim)
    search.run(stop)
    return search.plan


class _Search:
    """Applies every change that improves the score; ends when none does."""

    def __init__(
        self, days: ScheduleEvaluator, plan: Sequence[Schedule], movable: list[int], aim: StageObjective
    ) -> None:
        self._days, self._aim, self._movable = days, aim, movable
        self.plan: list[Schedule] = [[list(trip) for trip in day] for day in plan]
        self._costs = [days.cost(robot, day) for robot, day in enumerate(self.plan)]
        self._score: Score = aim.score(self._costs)
        self._near = nearest_targets(days.metres, movable, _NEAREST)
        self._fixed = self._fixed_rows(set(movable))
        self._at: dict[int, tuple[Slot, int]] = {}
        for robot in range(len(self.plan)):
            self._find(robot)

    def _fixed_rows(self, movable: set[int]) -> list[tuple[int, Trip]]:
        """Return for each robot the last trip with fixed targets, and these targets."""
        fixed = []
        for day in self.plan:
            stay = [[place for place in trip if place not in movable] for trip in day]
            last = max((number for number, trip in enumerate(stay) if trip), default=0)
            fixed.append((last, stay[last]))
        return fixed

    def _find(self, robot: int) -> None:
        for number, trip in enumerate(self.plan[robot]):
            for at, place in enumerate(trip):
                self._at[place] = (robot, number), at

    def run(self, stop: Callable[[], bool]) -> None:
        """Loop over all targets until a whole round changes nothing."""
        better = True
        while better:
            better = False
            for target in self._movable:
                if stop():
                    return
                while self._step(target):
                    better = True

    def _step(self, target: int) -> bool:
        slot, at = self._at[target]
        for other in self._near[target]:
            its_slot, its_at = self._at[other]
            for change in moves_beside(self.plan, slot, at, its_slot, its_at):
                if self._apply_trips(change):
                    return True
        if any(self._apply_trips(change) for change in moves_elsewhere(self.plan, slot, at)):
            return True
        if at > 0 or slot[1] <= self._fixed[slot[0]][0]:
            return False
        free = [last + 1 for last, _ in self._fixed]
        return any(self._apply_days(change) for change in moves_of_trips(self.plan, slot, free))

    def _apply_trips(self, change: TripChange) -> bool:
        if not self._worth(change) or not all(self._allowed(*one) for one in change.items()):
            return False
        days: DayChange = {}
        for (robot, number), trip in change.items():
            day = days.setdefault(robot, list(self.plan[robot]))
            if number == len(day):
                day.append(trip)
            else:
                day[number] = trip
        return self._apply(days)

    def _worth(self, change: TripChange) -> bool:
        """Whether ``change`` can improve anything, by the lengths of its trips alone."""
        if self._aim.objective == BALANCED:
            latest = max(range(len(self._costs)), key=lambda one: self._aim.end(self._costs[one]))
            if any(robot == latest for robot, _ in change):
                return True
        before = sum(self._length(slot, self._trip(slot)) for slot in change)
        return sum(self._length(slot, trip) for slot, trip in change.items()) < before - _LEAST_GAIN

    def _trip(self, slot: Slot) -> Trip:
        day = self.plan[slot[0]]
        return day[slot[1]] if slot[1] < len(day) else []

    def _length(self, slot: Slot, trip: Trip) -> float:
        if not trip:
            return 0.0
        if not self._days.job.stores:
            return self._days.cost(slot[0], [trip]).metres
        metres = self._days.trip_metres(trip)
        if slot[1] > 0:
            return metres
        return metres - self._days.from_store[trip[0]] + self._days.metres[slot[0]][trip[0]]

    def _allowed(self, slot: Slot, trip: Trip) -> bool:
        robot, number = slot
        last, stay = self._fixed[robot]
        if number < last or (number == last and trip[: len(stay)] != stay):
            return False
        if number > 0 and not self._days.job.stores:
            return False
        return self._days.fits(robot, trip, first=number == 0)

    def _apply_days(self, change: DayChange) -> bool:
        fit = all(
            self._days.fits(robot, trip, first=False) for robot, day in change.items() for trip in day[1:]
        )
        return fit and self._apply(change)

    def _apply(self, change: DayChange) -> bool:
        change = {robot: [*day[:1], *(trip for trip in day[1:] if trip)] for robot, day in change.items()}
        costs = list(self._costs)
        for robot, day in change.items():
            costs[robot] = self._days.cost(robot, day)
        score = self._aim.score(costs)
        if not _better(score, self._score):
            return False
        self._costs, self._score = costs, score
        for robot, day in change.items():
            self.plan[robot] = day
            self._find(robot)
        return True


def _better(score: Score, than: Score) -> bool:
    if score[0] < than[0] - _LEAST_GAIN:
        return True
    return score[0] <= than[0] and score[1] < than[1] - _LEAST_GAIN
