"""Trips by PyVRP, a solver for vehicle routing (Wouda, Lan and Kool, 2024), which starts from good ones.

It counts in decimetres and tenths of a second. Where there are several stores, a trip begins and ends at the
nearest one.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .days import Days, Trip
from .errors import MissingSolverError
from .savings import TripLimits

_UNIT = 0.1
_NO_WAY = 10**8
"""Decimetres or tenths of a second of a way that there is not."""
_NEIGHBOURS = 20
_MOST_CHANGES = 15
"""How many targets a step takes out of a plan at most before it is made good again; fewer make more steps."""
_ATTEMPTS = 4
_LEAST_PATIENCE, _PATIENCE = 500, 150
"""Steps without anything better after which few targets are taken to be solved, and more for each of them."""
_HISTORY = 50
"""How many steps back a plan may be as bad as; attempts, not a long memory, lead out of dead ends."""
_STEPS_BETWEEN_PENALTIES = 100
"""Steps after which what is over the limits costs more or less, so that about two thirds keep to them."""


def load_pyvrp() -> Any:
    """Return the module.

    :raises MissingSolverError: where it is not installed.
    """
    try:
        import pyvrp
    except ImportError as error:
        raise MissingSolverError(
            f"The method 'pyvrp' needs the package pyvrp, which does not load here ({error}): install it "
            "with 'pip install \"pyvrp>=0.14,<0.15\"', or choose the method 'preview'."
        ) from error
    return pyvrp


def trips_by_pyvrp(
    days: Days,
    trips: Sequence[Trip],
    limits: TripLimits,
    seconds: float,
    progress: Callable[[float], None],
    seed: int = 0,
) -> list[Trip] | None:
    """Return trips as good as ``seconds`` allow, found from ``trips``; None where none within the limits are.

    It ends early where nothing better turns up for long. ``progress`` is told which share of the time is
    over, and may raise to end it.

    :raises MissingSolverError: where PyVRP is not installed.
    """
    pyvrp = load_pyvrp()
    targets = [place for trip in trips for place in trip]
    number = {place: k for k, place in enumerate(targets)}
    data = _data(pyvrp, days, targets, limits, len(trips))
    clock = _Clock(seconds, progress)
    start = pyvrp.Solution(data, [[number[place] for place in trip] for trip in trips])
    best: Any = None
    # What was found from good trips may be a dead end: others begin anywhere.
    for attempt in range(_ATTEMPTS):
        found = _solved(pyvrp, data, None if attempt else start, clock, len(targets), seed + attempt)
        if found.is_feasible() and (best is None or found.distance() < best.distance()):
            best = found
        if clock.over:
            break
    if best is None:
        return None
    return [[targets[activity.idx] for activity in route if activity.is_client()] for route in best.routes()]


def _solved(pyvrp: Any, data: Any, start: Any, clock: _Clock, targets: int, seed: int) -> Any:
    patience = _LEAST_PATIENCE + _PATIENCE * targets
    with warnings.catch_warnings():
        # Limits that no trips keep to are known by there being no trips.
        warnings.simplefilter("ignore", pyvrp.exceptions.PenaltyBoundWarning)
        return pyvrp.solve(
            data,
            _Stop(clock, patience),
            seed,
            collect_stats=False,
            params=_params(pyvrp, data),
            initial_solution=start,
        ).best


class _Clock:
    """Knows how much of the time is over, and tells it."""

    def __init__(self, seconds: float, progress: Callable[[float], None]) -> None:
        self._seconds = max(seconds, 1e-3)
        self._begun, self._progress = time.perf_counter(), progress

    @property
    def over(self) -> bool:
        """Whether the time is over."""
        share = (time.perf_counter() - self._begun) / self._seconds
        self._progress(min(share, 1.0))
        return share >= 1.0


class _Stop:
    """Says when to end: the time is over, or for long nothing better has turned up."""

    def __init__(self, clock: _Clock, patience: int) -> None:
        self._clock, self._patience = clock, patience
        self._best, self._since = -1, 0

    def __call__(self, best_cost: int) -> bool:
        self._since = self._since + 1 if best_cost == self._best else 0
        self._best = best_cost
        return self._clock.over or self._since > self._patience


def _params(pyvrp: Any, data: Any) -> Any:
    from pyvrp.IteratedLocalSearch import IteratedLocalSearchParams
    from pyvrp.search import NeighbourhoodParams, PerturbationParams

    return pyvrp.SolveParams(
        ils=IteratedLocalSearchParams(history_length=_HISTORY, exhaustive_on_best=False),
        penalty=pyvrp.PenaltyParams(
            solutions_between_updates=_STEPS_BETWEEN_PENALTIES, max_penalty=_longest_round(data)
        ),
        # On one-way roads what is near one way is not near the other.
        neighbourhood=NeighbourhoodParams(num_neighbours=_NEIGHBOURS, symmetric_proximity=False),
        perturbation=PerturbationParams(max_perturbations=_MOST_CHANGES),
    )


def _longest_round(data: Any) -> float:
    """Return the decimetres of the longest way from the store to a target and back, as far as ways lead.

    To be over a limit need not cost more than a trip of its own; where it costs far more, as by PyVRP's
    default, only plans within the limits are tried, and few of them lead on to better ones.
    """
    metres = data.distance_matrix(0)
    rounds = metres[0, 1:] + metres[1:, 0]
    return float(max(rounds[rounds < _NO_WAY].max(initial=0), 1))


def _data(pyvrp: Any, days: Days, targets: list[int], limits: TripLimits, trips: int) -> Any:
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
        bounds["max_distance"] = math.floor(limits.range_m / _UNIT)
    if math.isfinite(limits.seconds):
        bounds["shift_duration"] = math.floor(limits.seconds / _UNIT)
    vehicles = pyvrp.VehicleType(trips + math.ceil(len(targets) / 4) + 1, [limits.capacity], 0, 0, **bounds)
    return pyvrp.ProblemData(
        [pyvrp.Location(*middle), *(pyvrp.Location(*places[place].tolist()) for place in targets)],
        [_client(pyvrp, days, k, place) for k, place in enumerate(targets, 1)],
        [pyvrp.Depot(0)],
        [vehicles],
        [_whole(metres)],
        [_whole(metres / limits.speed)],
    )


def _client(pyvrp: Any, days: Days, location: int, place: int) -> Any:
    what = "delivery" if days.places_cone[place] else "pickup"
    service = math.ceil(days.service[place] / _UNIT)
    return pyvrp.Client(location, service_duration=service, **{what: [days.demand[place]]})


def _whole(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    finite = np.isfinite(values)
    return np.where(finite, np.rint(np.where(finite, values, 0.0) / _UNIT), _NO_WAY).astype(np.int64)
