"""PyVRP at work, a solver for vehicle routing (Wouda, Lan and Kool, 2024), with settings for a few seconds.

It counts in whole numbers: decimetres and tenths of a second.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from .errors import MissingSolverError
from .job import Floats

UNIT = 0.1
"""Metres or seconds of a whole number."""
NO_WAY = 10**8
"""Decimetres or tenths of a second of a way that there is not."""
_NEIGHBOURS = 20
_MOST_CHANGES = 15
"""How many targets a step takes out of a plan at most before it is made good again; fewer make more steps."""
_ATTEMPTS = 4
_LEAST_PATIENCE, _PATIENCE = 500, 150
"""Steps without anything better after which few targets are taken to be solved, and more for each of them."""
_HISTORY = 50
"""How many steps back a plan may be as bad as; attempts, not a long memory, lead out of dead ends."""
_BEYOND = np.iinfo(np.int64).max
"""What PyVRP says that a plan costs that is over a limit."""
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


class Clock:
    """Knows how much of ``seconds`` is over, and tells it; ``progress`` may raise to end the work."""

    def __init__(self, seconds: float, progress: Callable[[float], None]) -> None:
        self._seconds = max(seconds, 1e-3)
        self._begun, self._progress = time.perf_counter(), progress

    @property
    def share(self) -> float:
        """Return the share of the time that is over, and tell it."""
        share = min((time.perf_counter() - self._begun) / self._seconds, 1.0)
        self._progress(share)
        return share

    @property
    def over(self) -> bool:
        """Whether the time is over."""
        return self.share >= 1.0


class Problem:
    """What PyVRP is to solve: its ``data``, and the ``penalty`` that being over a limit by one costs at most.

    To be over a limit need not cost more than what leads out of it; where it costs far more, as by PyVRP's
    default, only plans within the limits are tried, and few of them lead on to better ones.
    """

    def __init__(self, data: Any, penalty: float) -> None:
        self.data, self.penalty = data, max(penalty, 1.0)


def best_of_attempts(problem: Problem, start: Any, clock: Clock, seed: int) -> Any | None:
    """Return the shortest solution that is found from ``start``; None where none is within the limits.

    It ends early where nothing better turns up for long.
    """
    patience = _LEAST_PATIENCE + _PATIENCE * problem.data.num_clients
    best: Any = None
    # What was found from a good start may be a dead end: others begin anywhere.
    for attempt in range(_ATTEMPTS):
        found = _solved(problem, None if attempt else start, _Patient(clock, patience), seed + attempt)
        if found.is_feasible() and (best is None or found.distance() < best.distance()):
            best = found
        if clock.over:
            break
    return best


def any_within(problem: Problem, start: Any, clock: Clock, steps: int, seed: int) -> Any | None:
    """Return some solution within the limits, near ``start``; None where ``steps`` find none."""
    found = _solved(problem, start, _UntilWithin(clock, steps), seed)
    return found if found.is_feasible() else None


def _solved(problem: Problem, start: Any | None, stop: Callable[[int], bool], seed: int) -> Any:
    pyvrp = load_pyvrp()
    with warnings.catch_warnings():
        # Limits that no plan keeps to are known by there being no plan.
        warnings.simplefilter("ignore", pyvrp.exceptions.PenaltyBoundWarning)
        return pyvrp.solve(
            problem.data,
            stop,
            seed,
            collect_stats=False,
            params=_params(pyvrp, problem.penalty),
            initial_solution=start,
        ).best


class _Patient:
    """Says when to end: the time is over, or for long nothing better has turned up."""

    def __init__(self, clock: Clock, patience: int) -> None:
        self._clock, self._patience = clock, patience
        self._best, self._since = -1, 0

    def __call__(self, best_cost: int) -> bool:
        self._since = self._since + 1 if best_cost == self._best else 0
        self._best = best_cost
        return self._clock.over or self._since > self._patience


class _UntilWithin:
    """Says when to end: something keeps to the limits, the time is over, or the steps are done."""

    def __init__(self, clock: Clock, steps: int) -> None:
        self._clock, self._left = clock, steps

    def __call__(self, best_cost: int) -> bool:
        self._left -= 1
        return self._left < 0 or best_cost < _BEYOND or self._clock.over


def _params(pyvrp: Any, penalty: float) -> Any:
    from pyvrp.IteratedLocalSearch import IteratedLocalSearchParams
    from pyvrp.search import NeighbourhoodParams, PerturbationParams

    return pyvrp.SolveParams(
        ils=IteratedLocalSearchParams(history_length=_HISTORY, exhaustive_on_best=False),
        penalty=pyvrp.PenaltyParams(solutions_between_updates=_STEPS_BETWEEN_PENALTIES, max_penalty=penalty),
        # On one-way roads what is near one way is not near the other.
        neighbourhood=NeighbourhoodParams(num_neighbours=_NEIGHBOURS, symmetric_proximity=False),
        perturbation=PerturbationParams(max_perturbations=_MOST_CHANGES),
    )


def whole(values: Floats) -> np.ndarray[Any, Any]:
    """Return metres or seconds as PyVRP counts them."""
    finite = np.isfinite(values)
    return np.where(finite, np.rint(np.where(finite, values, 0.0) / UNIT), NO_WAY).astype(np.int64)
