"""The days of robots: which targets on which trip, and what that costs.

A day is a list of trips, a trip a list of the places of targets. Trip 0 is done with what is aboard at the
start, and may be empty; a visit to a store comes before every other one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .job import PLACE, TO_START, TO_STORE, Floats, Job

Trip = list[int]
Day = list[Trip]


@dataclass(frozen=True)
class Cost:
    """Metres of a day, and the seconds at which its last target is done and at which the robot is home."""

    metres: float
    served_s: float
    home_s: float


class Days:
    """Measures days of the robots of ``job``; ``metres`` is (n, n) between its places.

    ``gates`` holds, by stage, the second before which none of its targets may be begun.
    """

    def __init__(self, job: Job, metres: Floats) -> None:
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
        """Return the store that is the least way round from ``before`` to ``after``."""
        pair = before, after
        if pair not in self._between:
            stores = range(self.job.first_store, self.job.first_target)
            self._between[pair] = min(stores, key=lambda s: self.metres[before][s] + self.metres[s][after])
        return self._between[pair]

    def tour(self, robot: int, day: Day) -> list[int]:
        """Return the places where the robot stops, one after another, with stores and where it ends."""
        tour: list[int] = list(day[0])
        for trip in day[1:]:
            if trip:
                tour += [self.store_between(tour[-1] if tour else robot, trip[0]), *trip]
        return tour + self._end(robot, day, tour)

    def _end(self, robot: int, day: Day, tour: list[int]) -> list[int]:
        collected = any(not self.places_cone[place] for place in self._last_trip(day))
        waiting = self.job.robots[robot].collected > 0 and not any(day[1:])
        if collected or waiting or (tour and self.job.finish == TO_STORE):
            home = [self.job.first_store + self._nearest[tour[-1] if tour else robot]]
        else:
            home = []
        return [*home, robot] if tour and self.job.finish == TO_START else home

    @staticmethod
    def _last_trip(day: Day) -> Trip:
        return next((trip for trip in reversed(day) if trip), [])

    def home_from(self, robot: int, place: int) -> tuple[float, float]:
        """Return the metres and seconds from the target at ``place``, the robot's last, to its day's end."""
        way = self.tour(robot, [[place]])
        metres = sum(self.metres[a][b] for a, b in pairwise(way))
        service = sum(self.service[one] for one in way[1:])
        return metres, metres / self.job.robots[robot].speed + service

    def cost(self, robot: int, day: Day) -> Cost:
        """Return what ``day`` costs; infinite metres where there is no way or not enough battery."""
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
        return Cost(metres, served, clock)

    def trip_metres(self, trip: Sequence[int]) -> float:
        """Return the metres of ``trip`` from the nearest store and back to the nearest one."""
        if not trip:
            return 0.0
        total, at = self.from_store[trip[0]], trip[0]
        for place in trip[1:]:
            total += self.metres[at][place]
            at = place
        return total + self.to_store[at]
