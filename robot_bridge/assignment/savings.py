"""Trips by savings (Clarke and Wright, 1964): what two trips save when they become one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .days import Days, Trip

Pairs = list[tuple[int, int]]


@dataclass(frozen=True)
class TripLimits:
    """What bounds each trip: room, metres, and seconds at ``speed`` with what is done at the targets."""

    capacity: int
    range_m: float = math.inf
    seconds: float = math.inf
    speed: float = 1.0

    def allow(self, days: Days, trip: Sequence[int]) -> bool:
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

    def duration(self, days: Days, trip: Sequence[int], metres: float) -> float:
        """Return the seconds that ``trip`` takes."""
        return metres / self.speed + sum(days.service[place] for place in trip)


def trips_by_savings(days: Days, targets: Sequence[int], pairs: Pairs, limits: TripLimits) -> list[Trip]:
    """Return trips that serve every one of ``targets``; each begins and ends at the nearest store.

    ``pairs`` is what :func:`saving_pairs` returns. A target that is beyond the limits on its own has a trip
    of its own.
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


def saving_pairs(days: Days, targets: Sequence[int]) -> Pairs:
    """Return the pairs that save metres when the second follows the first, the best first."""
    some = np.array(targets, dtype=np.int64)
    metres = np.array([[days.metres[a][b] for b in targets] for a in targets]).reshape(len(some), len(some))
    back, out = (np.array(column)[some] for column in (days.to_store, days.from_store))
    saved = back[:, None] + out[None, :] - metres
    np.fill_diagonal(saved, 0.0)
    saved[~np.isfinite(saved)] = 0.0
    # On a one-way loop all that follow one another save the same: the nearest come first.
    order = np.lexsort([metres.ravel(), -np.round(saved, 3).ravel()])[: int((saved > 0).sum())]
    first, second = np.unravel_index(order, saved.shape)
    return list(zip(some[first].tolist(), some[second].tolist(), strict=True))


def _joined(days: Days, one: Trip, other: Trip, a: int, b: int) -> Trip | None:
    """Return the trip in which ``b`` follows ``a``; None where they are not at ends that can meet."""
    if a == one[-1] and b == other[0]:
        return one + other
    if a == one[0] and b == other[0]:
        joined = one[::-1] + other
    elif a == one[-1] and b == other[-1]:
        joined = one + other[::-1]
    else:
        return None
    # On one-way roads a trip that is turned may be longer.
    apart = days.trip_metres(one) + days.trip_metres(other)
    return joined if days.trip_metres(joined) < apart else None
