"""Which robot drives which trip: longest trips first, each to the robot that suits the objective best."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .days import Cost, Day, Days, Trip

BALANCED, LEAST_DISTANCE = "balanced", "distance"
OBJECTIVES = (BALANCED, LEAST_DISTANCE)

Score = tuple[float, float]


@dataclass(frozen=True)
class Aim:
    """What is to be least; ``last`` says that the robots' way home counts, as it does in the last stage."""

    objective: str = BALANCED
    last: bool = True

    def end(self, cost: Cost) -> float:
        """Return the seconds that count of one robot's day."""
        return cost.home_s if self.last else cost.served_s

    def score(self, costs: Sequence[Cost]) -> Score:
        """Return what is compared, the lesser the better."""
        latest = max(self.end(cost) for cost in costs)
        metres = sum(cost.metres for cost in costs)
        if math.isinf(metres):
            return math.inf, math.inf
        return (latest, metres) if self.objective == BALANCED else (metres, latest)


def scheduled(
    days: Days, trips: Sequence[Trip], start: Sequence[Day], aim: Aim
) -> tuple[list[Day], list[Trip]]:
    """Return ``start`` with ``trips`` driven by some robot, and those that no robot has the battery for."""
    plan = [[list(trip) for trip in day] for day in start]
    costs = [days.cost(robot, day) for robot, day in enumerate(plan)]
    left: list[Trip] = []
    for trip in sorted(trips, key=lambda one: -_length(days, one)):
        best: tuple[Score, int, Day, Cost] | None = None
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


def _with(days: Days, robot: int, day: Day, trip: Trip) -> list[Day]:
    """Return the days in which ``trip`` follows: on what is aboard, and after a visit to a store."""
    choices = []
    if days.fits(robot, day[-1] + trip, first=len(day) == 1):
        choices.append([*day[:-1], day[-1] + trip])
    if days.job.stores and days.fits(robot, trip, first=False):
        choices.append([*day, list(trip)])
    return choices


def _length(days: Days, trip: Trip) -> float:
    return days.trip_metres(trip) + sum(days.service[place] for place in trip)
