"""Plans made better by small changes, each measured on the whole day of the robots that it concerns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from .days import Day, Days, Trip
from .neighbours import (
    DayChange,
    Slot,
    TripChange,
    moves_beside,
    moves_elsewhere,
    moves_of_trips,
    nearest_targets,
)
from .scheduling import BALANCED, Aim, Score

_NEAREST = 12
_LEAST_GAIN = 1e-6


def improved(
    days: Days, plan: Sequence[Day], movable: Iterable[int], aim: Aim, stop: Callable[[], bool]
) -> list[Day]:
    """Return ``plan`` as good as changes of ``movable`` targets make it until ``stop()`` says so."""
    search = _Search(days, plan, sorted(movable), aim)
    search.run(stop)
    return search.plan


class _Search:
    """Takes every change that makes the score better; ends where none does."""

    def __init__(self, days: Days, plan: Sequence[Day], movable: list[int], aim: Aim) -> None:
        self._days, self._aim, self._movable = days, aim, movable
        self.plan: list[Day] = [[list(trip) for trip in day] for day in plan]
        self._costs = [days.cost(robot, day) for robot, day in enumerate(self.plan)]
        self._score: Score = aim.score(self._costs)
        self._near = nearest_targets(days.metres, movable, _NEAREST)
        self._fixed = self._fixed_rows(set(movable))
        self._at: dict[int, tuple[Slot, int]] = {}
        for robot in range(len(self.plan)):
            self._find(robot)

    def _fixed_rows(self, movable: set[int]) -> list[tuple[int, Trip]]:
        """Return for each robot the last trip with targets that stay, and these."""
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
        """Go round all targets until a whole round changes nothing."""
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
                if self._take_trips(change):
                    return True
        if any(self._take_trips(change) for change in moves_elsewhere(self.plan, slot, at)):
            return True
        if at > 0 or slot[1] <= self._fixed[slot[0]][0]:
            return False
        free = [last + 1 for last, _ in self._fixed]
        return any(self._take_days(change) for change in moves_of_trips(self.plan, slot, free))

    def _take_trips(self, change: TripChange) -> bool:
        if not self._worth(change) or not all(self._allowed(*one) for one in change.items()):
            return False
        days: DayChange = {}
        for (robot, number), trip in change.items():
            day = days.setdefault(robot, list(self.plan[robot]))
            if number == len(day):
                day.append(trip)
            else:
                day[number] = trip
        return self._take(days)

    def _worth(self, change: TripChange) -> bool:
        """Whether ``change`` can make anything better, by the lengths of its trips alone."""
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

    def _take_days(self, change: DayChange) -> bool:
        fit = all(
            self._days.fits(robot, trip, first=False) for robot, day in change.items() for trip in day[1:]
        )
        return fit and self._take(change)

    def _take(self, change: DayChange) -> bool:
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
