"""Trips by PyVRP, from a store and back, found from good ones.

Where there are several stores, a trip begins and ends at the nearest one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .days import Days, Trip
from .pyvrp_search import UNIT, Clock, Problem, best_of_attempts, load_pyvrp, whole
from .savings import TripLimits


def trips_by_pyvrp(
    days: Days, trips: Sequence[Trip], limits: TripLimits, clock: Clock, seed: int = 0
) -> list[Trip] | None:
    """Return trips as good as the time of ``clock`` allows, found from ``trips``.

    None where none within the limits are found.

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


def _problem(pyvrp: Any, days: Days, targets: list[int], limits: TripLimits, trips: int) -> Problem:
    """Return the problem; location 0 is whichever store is nearest."""
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
    # What is too much for one trip needs at most one of its own, to the farthest target.
    rounds = metres[0, 1:] + metres[1:, 0]
    return Problem(data, rounds[np.isfinite(rounds)].max(initial=0.0) / UNIT)


def _client(pyvrp: Any, days: Days, location: int, place: int) -> Any:
    what = "delivery" if days.places_cone[place] else "pickup"
    service = math.ceil(days.service[place] / UNIT)
    return pyvrp.Client(location, service_duration=service, **{what: [days.demand[place]]})
