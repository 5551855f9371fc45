"""Changes of plans: what may be tried around one target."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .days import Day, Trip

Slot = tuple[int, int]
"""Robot, and number of the trip in its day."""
TripChange = dict[Slot, Trip]
"""Trips that become others; a trip that is not there yet has the next number of the day."""
DayChange = dict[int, Day]
"""Days, by robot, that become others."""

_LONGEST = 3
"""How many targets in a row are moved together at most."""


def nearest_targets(metres: Sequence[Sequence[float]], targets: Sequence[int], count: int) -> dict[int, Trip]:
    """Return for each of ``targets`` the ``count`` nearest others, whichever way is shorter."""
    some = np.array(targets)
    away = np.array([[metres[a][b] for b in targets] for a in targets]).reshape(len(some), len(some))
    away = np.minimum(away, away.T)
    np.fill_diagonal(away, np.inf)
    order = np.argsort(away, axis=1, kind="stable")[:, : min(count, len(some) - 1)]
    return {target: some[row].tolist() for target, row in zip(targets, order, strict=True)}


def moves_beside(plan: Sequence[Day], a: Slot, at: int, b: Slot, beside: int) -> Iterator[TripChange]:
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


def moves_elsewhere(plan: Sequence[Day], a: Slot, at: int) -> Iterator[TripChange]:
    """Yield the changes that give the target a trip of its own, or the first place of an empty one."""
    robot, number = a
    trip = plan[robot][number]
    rest = trip[:at] + trip[at + 1 :]
    for other, day in enumerate(plan):
        yield {a: rest, (other, len(day)): [trip[at]]}
        if not day[0] and a != (other, 0):
            yield {a: rest, (other, 0): [trip[at]]}


def moves_of_trips(plan: Sequence[Day], a: Slot, first_free: Sequence[int]) -> Iterator[DayChange]:
    """Yield the changes that drive trip ``a`` at another time, by another robot, or in exchange for another.

    Trips of robot ``r`` may come in from number ``first_free[r]`` on.
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
