"""How likely a scan is from a pose: the beam model and the likelihood field (Thrun, Burgard, Fox:
Probabilistic Robotics, sections 6.3 and 6.4)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .ray_casting import RayCaster
from .settings import FilterSettings, LaserSettings
from .world import Walls

AGREES = 3.0
"""standard deviations within which a beam is where the map has something."""
FIELD_CELL = 0.1
"""metres: a side of a cell of the likelihood field."""
FIELD_SIGMAS = 4.0
"""What is farther from all walls than so many standard deviations is nowhere near one."""
LARGEST_FIELD = 40_000_000
"""cells; a larger map has larger cells."""


def usable_beams(ranges: NDArray[Any]) -> NDArray[Any]:
    """Return which beams of a scan say something, (K,) int64: all that have a reading."""
    return np.flatnonzero(ranges >= 0)


class BeamModel:
    """Each beam is at what the map has there, cut short before it, without an echo, or anything at all."""

    def __init__(
        self, walls: Walls, laser: LaserSettings, settings: FilterSettings, compiled: bool | None = None
    ) -> None:
        self._caster = RayCaster(walls.a, walls.b, laser.reach, compiled)
        self._reach = laser.reach
        self._settings = settings

    def log_likelihood(
        self, poses: NDArray[Any], bearings: NDArray[Any], ranges: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the mean over all beams of the logarithm of their likelihood (1/m), for each pose: (N,).

        And the share of the beams that are where the map has something, or nothing: (N,).
        """
        expected = self._caster.cast(poses, bearings)
        measured = np.minimum(ranges, self._reach)
        agreement = (np.abs(expected - measured) < AGREES * self._settings.sigma).mean(axis=1)
        likelihood = beam_likelihood(expected, measured, self._reach, self._settings)
        np.log(likelihood, out=likelihood)
        return likelihood.mean(axis=1), agreement


def beam_likelihood(
    expected: NDArray[Any], measured: NDArray[Any], reach: float, settings: FilterSettings
) -> NDArray[Any]:
    """Return the likelihood (1/m) of ``measured``, (B,), where the map has ``expected``, (N, B): (N, B).

    The parts: a normal distribution about what is expected; an even one from 0 to there, for what is in the
    way; without an echo; an even one from 0 to ``reach``. A beam without an echo, and one that none is
    expected of, is ``reach`` long.
    """
    sigma = settings.sigma
    whole = settings.hit + settings.short + settings.far + settings.random
    likelihood: NDArray[Any] = measured - expected
    short = likelihood < 0
    likelihood /= sigma
    np.square(likelihood, out=likelihood)
    likelihood *= -0.5
    np.exp(likelihood, out=likelihood)
    likelihood *= settings.hit / (sigma * math.sqrt(2 * math.pi))
    likelihood += settings.random / reach
    likelihood += settings.short * short / np.maximum(expected, sigma)
    # Without an echo: a point mass, told as a density over one standard deviation.
    likelihood += (settings.far / sigma) * (measured >= reach)
    likelihood /= whole
    return likelihood


class FieldModel:
    """How near to a wall each beam ends; rough, quick, and smooth enough to search a whole map with."""

    def __init__(self, walls: Walls, laser: LaserSettings, settings: FilterSettings) -> None:
        self._settings = settings
        self._reach = laser.reach
        self._far = FIELD_SIGMAS * settings.sigma
        ends = np.concatenate([walls.a, walls.b, np.zeros((0 if len(walls) else 1, 2))])
        self._low = ends.min(axis=0) - self._far
        size = ends.max(axis=0) + self._far - self._low
        self._cell = max(FIELD_CELL, math.sqrt(size[0] * size[1] / LARGEST_FIELD))
        shape = np.ceil(size / self._cell).astype(np.int64) + 1
        nearest = np.full(shape, self._far, dtype=np.float32)
        for a, b in zip(walls.a, walls.b, strict=True):
            self._draw(nearest, a, b)
        near = settings.hit * np.exp(-0.5 * np.square(nearest / settings.sigma))
        near /= settings.sigma * math.sqrt(2 * math.pi)
        near += (settings.random + settings.short) / self._reach
        near /= settings.hit + settings.short + settings.far + settings.random
        self._log = np.log(near)
        at = settings.hit * math.exp(-0.5 * AGREES**2) / (settings.sigma * math.sqrt(2 * math.pi))
        at += (settings.random + settings.short) / self._reach
        self._agrees = math.log(at / (settings.hit + settings.short + settings.far + settings.random))

    def log_likelihood(
        self, poses: NDArray[Any], bearings: NDArray[Any], ranges: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the mean over all beams with an echo of the logarithm of their likelihood, for each pose.

        And the share of them that end near a wall. Without an echo any pose is as good as another.
        """
        echo = ranges < self._reach
        if not echo.any():
            return np.zeros(len(poses)), np.ones(len(poses))
        angle = poses[:, 2:] + bearings[echo]
        shape = self._log.shape
        column = (poses[:, :1] - self._low[0] + ranges[echo] * np.cos(angle)) / self._cell
        row = (poses[:, 1:2] - self._low[1] + ranges[echo] * np.sin(angle)) / self._cell
        # The outermost cells are far from all walls, as is what lies beyond them.
        place = np.clip(column, 0, shape[0] - 1).astype(np.int64) * shape[1]
        place += np.clip(row, 0, shape[1] - 1).astype(np.int64)
        logs = self._log.ravel()[place]
        return logs.mean(axis=1, dtype=np.float64), (logs > self._agrees).mean(axis=1)

    def _draw(self, nearest: NDArray[Any], a: NDArray[Any], b: NDArray[Any]) -> None:
        """Bring down the distance of the cells around a segment."""
        pieces = max(1, math.ceil(math.dist(a, b) / 5.0))
        for part in range(pieces):
            # In pieces: the box around a long slanting wall is mostly empty.
            begin, end = a + (b - a) * (part / pieces), a + (b - a) * ((part + 1) / pieces)
            low = np.floor((np.minimum(begin, end) - self._far - self._low) / self._cell).astype(np.int64)
            high = np.ceil((np.maximum(begin, end) + self._far - self._low) / self._cell).astype(np.int64) + 1
            low = np.maximum(low, 0)
            box = nearest[low[0] : high[0], low[1] : high[1]]
            x = self._low[0] + (low[0] + 0.5 + np.arange(box.shape[0])[:, None]) * self._cell - begin[0]
            y = self._low[1] + (low[1] + 0.5 + np.arange(box.shape[1])) * self._cell - begin[1]
            along = end - begin
            square = max(float(along @ along), 1e-12)
            at = np.clip((x * along[0] + y * along[1]) / square, 0.0, 1.0)
            np.minimum(box, np.hypot(x - at * along[0], y - at * along[1]), out=box)
