"""How far it is from place to place, and the path that a robot drives."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np

from .errors import CancelledError
from .job import Floats, Job

STRAIGHT = "straight lines"


class Travel(Protocol):
    """Ways between the places of a job."""

    name: str
    """What the ways follow, as people are told."""
    metres: Floats
    """(n, n) from row to column; infinity where no way leads."""

    def path(self, start: int, goal: int) -> Floats:
        """Return the points, (m, 2) with m ≥ 2, from place ``start`` to place ``goal``."""


class StraightTravel:
    """Ways as the crow flies: of a job without roads. Points are at most ``spacing`` metres apart."""

    name = STRAIGHT

    def __init__(self, job: Job, spacing: float = 0.5) -> None:
        self._places = job.places
        self._spacing = spacing
        x, y = self._places.T
        self.metres: Floats = np.hypot(x[:, None] - x, y[:, None] - y)

    def path(self, start: int, goal: int) -> Floats:
        """Return the line between the two places."""
        return straight(self._places[start], self._places[goal], self._spacing)


class CancellableTravel:
    """The ways of ``inner``; its paths raise CancelledError once ``go_on()`` says no."""

    def __init__(self, inner: Travel, go_on: Callable[[], bool]) -> None:
        self._inner, self._go_on = inner, go_on
        self.name, self.metres = inner.name, inner.metres

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place."""
        if not self._go_on():
            raise CancelledError("The assignment was cancelled.")
        return self._inner.path(start, goal)


def straight(a: Floats, b: Floats, spacing: float) -> Floats:
    """Return the points from ``a`` to ``b`` at most ``spacing`` metres apart, at least two."""
    count = max(math.ceil(math.hypot(*(b - a)) / spacing - 1e-9), 1)
    points: Floats = a + (b - a) * (np.arange(count + 1) / count)[:, None]
    return points
