"""Scan matching: likelihood of a scan from a pose, resampling of particles, search on a whole map."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.robotmap.model import RobotMap
from .ray_casting import RayCaster
from .settings import FilterSettings, LaserSettings, RecoverySettings, ReferenceRobotError
from .world import Walls, inside_solids

# The models of a scan are those of Thrun, Burgard, Fox: Probabilistic Robotics, sections 6.3 and 6.4.


def usable_beams(ranges: NDArray[Any]) -> NDArray[Any]:
    """Return the informative beams of a scan, (K,) int64: all that have a reading."""
    return np.flatnonzero(ranges >= 0)


class BeamModel:
    """Mixture per beam: hit on the map's obstacle, shorter, without an echo, or random."""

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

        Also returned: the share of the beams that agree with the map: (N,).
        """
        expected = self._caster.cast(poses, bearings)
        measured = np.minimum(ranges, self._reach)
        agreement = (np.abs(expected - measured) < self._settings.agrees * self._settings.sigma).mean(axis=1)
        likelihood = beam_likelihood(expected, measured, self._reach, self._settings)
        np.log(likelihood, out=likelihood)
        return likelihood.mean(axis=1), agreement


def beam_likelihood(
    expected: NDArray[Any], measured: NDArray[Any], reach: float, settings: FilterSettings
) -> NDArray[Any]:
    """Return the likelihood (1/m) of ``measured``, (B,), where the map has ``expected``, (N, B): (N, B).

    The parts: a normal distribution about the expected range; a uniform one from 0 to there, for things in
    the way; no echo; a uniform one from 0 to ``reach``. A beam without an echo, measured or expected, is
    ``reach`` long.
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
    # Without an echo: a point mass, written as a density over one standard deviation.
    likelihood += (settings.far / sigma) * (measured >= reach)
    likelihood /= whole
    return likelihood


class FieldModel:
    """Likelihood by the distance of beam ends from walls; rough, quick, and smooth enough to search a whole
    map."""

    def __init__(self, walls: Walls, laser: LaserSettings, settings: FilterSettings) -> None:
        self._settings = settings
        self._reach = laser.reach
        self._far = settings.field_sigmas * settings.sigma
        ends = np.concatenate([walls.a, walls.b, np.zeros((0 if len(walls) else 1, 2))])
        self._low = ends.min(axis=0) - self._far
        size = ends.max(axis=0) + self._far - self._low
        self._cell = max(settings.field_cell, math.sqrt(size[0] * size[1] / settings.field_cells))
        shape = np.ceil(size / self._cell).astype(np.int64) + 1
        nearest = np.full(shape, self._far, dtype=np.float32)
        for a, b in zip(walls.a, walls.b, strict=True):
            self._draw(nearest, a, b)
        near = settings.hit * np.exp(-0.5 * np.square(nearest / settings.sigma))
        near /= settings.sigma * math.sqrt(2 * math.pi)
        near += (settings.random + settings.short) / self._reach
        near /= settings.hit + settings.short + settings.far + settings.random
        self._log = np.log(near)
        at = settings.hit * math.exp(-0.5 * settings.agrees**2) / (settings.sigma * math.sqrt(2 * math.pi))
        at += (settings.random + settings.short) / self._reach
        self._agrees = math.log(at / (settings.hit + settings.short + settings.far + settings.random))

    def log_likelihood(
        self, poses: NDArray[Any], bearings: NDArray[Any], ranges: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the mean over all beams with an echo of the logarithm of their likelihood, for each pose.

        Also returned: the share of them that end near a wall. Beams without an echo do not distinguish poses.
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
        """Lower the distances of the cells around a segment."""
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


_QUANTILE = 2.3263
"""of the normal distribution at 99 %."""


def low_variance(weights: NDArray[Any], count: int, rng: np.random.Generator) -> NDArray[Any]:
    """Return the rows of ``count`` particles drawn by ``weights``, (N,), of sum 1: (count,) int64.

    One random number serves all: a particle of weight w is drawn ⌊w·count⌋ or ⌈w·count⌉ times, w·count on
    average.
    """
    places = (rng.random() + np.arange(count)) / count
    reached = np.cumsum(weights)
    return np.minimum(np.searchsorted(reached / reached[-1], places, side="right"), len(weights) - 1)


def in_groups(
    weights: NDArray[Any],
    group: NDArray[Any],
    count: int,
    rng: np.random.Generator,
    settings: RecoverySettings,
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the rows of about ``count`` particles drawn in each group by itself, and their weights of sum 1.

    ``group``, (N,) int64, is the group of each. A group keeps its weight, and has ``group_least`` particles
    at least: of similar places none dies out by chance, and the evidence of scans accumulates. Groups of less
    weight than ``group_share`` are left out, and all but the ``most_groups`` heaviest.
    """
    _, number = np.unique(group, return_inverse=True)
    total = np.bincount(number, weights=weights) / weights.sum()
    kept = np.argsort(-total)[: settings.most_groups]
    kept = kept[total[kept] >= min(settings.group_share, total.max())]
    rows, drawn = [], []
    for one in kept:
        members = np.flatnonzero(number == one)
        enough = max(settings.group_least, round(float(total[one]) * count))
        own = weights[members] / weights[members].sum()
        rows.append(members[low_variance(own, enough, rng)])
        drawn.append(np.full(enough, total[one] / enough))
    all_weights = np.concatenate(drawn)
    return np.concatenate(rows), all_weights / all_weights.sum()


def bins_of(poses: NDArray[Any], size: float, turn: float) -> NDArray[Any]:
    """Return a number for each of ``poses``, (N, 3), the same for those in one bin: (N,) int64.

    Bins are ``size`` metres wide and deep, and ``turn`` radians of the heading, a part of the whole turn.
    """
    placed = np.column_stack([poses[:, :2], np.mod(poses[:, 2], 2 * math.pi)])
    row = np.floor(placed / (size, size, turn)).astype(np.int64)
    row -= row.min(axis=0)
    spans = row.max(axis=0) + 1
    number: NDArray[Any] = (row[:, 0] * spans[1] + row[:, 1]) * spans[2] + row[:, 2]
    return number


def occupied_bins(poses: NDArray[Any], settings: FilterSettings) -> int:
    """Return the number of bins of place and heading occupied by ``poses``, (N, 3)."""
    turn = 2 * math.pi / max(1, round(360 / settings.bin_turn_deg))
    return len(np.unique(bins_of(poses, settings.bin_size, turn)))


def particles_for(bins: int, settings: FilterSettings) -> int:
    """Return the sufficient number of particles for ``bins`` occupied bins, between ``least`` and ``most``.

    So that with 99 % the Kullback-Leibler distance to the true distribution is below ``kld_error``
    (Wilson-Hilferty approximation of the chi-square quantile).
    """
    if bins <= 1:
        return settings.least
    part = 2 / (9 * (bins - 1))
    enough = (bins - 1) / (2 * settings.kld_error) * (1 - part + math.sqrt(part) * _QUANTILE) ** 3
    return int(min(max(math.ceil(enough), settings.least), settings.most))


AT_ONCE = 4_000
"""poses: few enough for their arrays to stay in the processor's cache."""
_PER_BIN = 20
"""candidate poses per kept one: as many may be in one bin."""


class PlaceSearch:
    """Finds poses on ``robot_map`` at which a scan fits, by likelihood fields of its ``walls``.

    They are drawn by ``model``, the one of the filter: a field ignores that walls hide others.
    """

    def __init__(
        self,
        robot_map: RobotMap,
        walls: Walls,
        laser: LaserSettings,
        settings: FilterSettings,
        model: BeamModel | FieldModel,
    ) -> None:
        self._map = robot_map
        self._model = model
        self._settings = settings.search
        self._worth = settings.beams_of_worth
        self._wide = FieldModel(
            walls, laser, msgspec.structs.replace(settings, sigma=settings.search.wide_sigma)
        )
        self._narrow = FieldModel(walls, laser, settings)

    def likely(
        self,
        count: int,
        looked_at: int,
        bearings: NDArray[Any],
        ranges: NDArray[Any],
        rng: np.random.Generator,
        near: tuple[float, float, float] | None = None,
    ) -> NDArray[Any]:
        """Return ``count`` poses, (count, 3), of ``looked_at`` random ones, by the fit of a scan.

        ``bearings`` and ``ranges``, (B,), are of beams with a reading. ``near`` is x, y and a standard
        deviation, metres: poses are sampled around there, else all over the map.
        """
        settings = self._settings
        poses = self.free(looked_at, rng, near)
        few = _spread(len(ranges), settings.few_beams)
        parts = np.array_split(poses, 1 + looked_at // AT_ONCE)
        fit = np.concatenate(
            [self._wide.log_likelihood(part, bearings[few], ranges[few])[0] for part in parts]
        )
        best = poses[self._best_apart(poses, fit)]
        more = _spread(len(ranges), settings.more_beams)
        tries, kept = settings.tries, len(best)
        metres = radians = 0.0
        for metres, degrees in zip(settings.rounds_m, settings.rounds_deg, strict=True):
            radians = math.radians(degrees)
            around = np.repeat(best[:, None], tries, axis=1)
            around[:, 1:] += rng.normal(0, (metres, metres, radians), (kept, tries - 1, 3))
            fit, _ = self._narrow.log_likelihood(around.reshape(-1, 3), bearings[more], ranges[more])
            best = around[np.arange(kept), fit.reshape(kept, tries).argmax(axis=1)]
        fit, _ = self._model.log_likelihood(best, bearings, ranges)
        weights = np.exp((fit - fit.max()) * min(self._worth, len(ranges)))
        found = best[low_variance(weights / weights.sum(), count, rng)]
        spread: NDArray[Any] = found + rng.normal(0, (metres / 2, metres / 2, radians / 2), found.shape)
        return spread

    def _best_apart(self, poses: NDArray[Any], fit: NDArray[Any]) -> NDArray[Any]:
        """Return the rows of the poses that fit best, no two of them in one bin.

        Otherwise a façade that fits a little better would take all of them, and the robot's place none.
        """
        settings = self._settings
        most = min(settings.kept * _PER_BIN, len(poses))
        rows = np.argpartition(-fit, most - 1)[:most]
        rows = rows[np.argsort(-fit[rows])]
        bins = bins_of(poses[rows], settings.apart_m, math.radians(settings.apart_deg))
        _, first = np.unique(bins, return_index=True)
        found: NDArray[Any] = rows[np.sort(first)[: settings.kept]]
        return found

    def free(
        self, count: int, rng: np.random.Generator, near: tuple[float, float, float] | None = None
    ) -> NDArray[Any]:
        """Return poses all over the map, or around a place, outside solid obstacles, (count, 3).

        :raises ReferenceRobotError: when there is hardly any free space.
        """
        border = self._map.border
        low, high = np.array([border.x_min, border.y_min]), np.array([border.x_max, border.y_max])
        found = np.empty((0, 3))
        for _ in range(100):
            places = rng.uniform(low, high, (count, 2))
            if near is not None:
                places = rng.normal(near[:2], near[2], (count, 2))
            places = places[((places >= low) & (places <= high)).all(axis=1)]
            places = places[~inside_solids(self._map, places)]
            poses = np.column_stack([places, rng.uniform(-np.pi, np.pi, len(places))])
            found = np.concatenate([found, poses])
            if len(found) >= count:
                return found[:count]
        raise ReferenceRobotError(
            f"map {self._map.meta.get('id', 'without id')}: hardly any of it is free"
            + ("" if near is None else f" around GPS position ({near[0]:.1f}, {near[1]:.1f})")
            + "; ask for a map of where the robot is"
        )


def _spread(count: int, most: int) -> NDArray[Any]:
    """Return which of ``count`` beams to use, at most ``most``, spread over the scan."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))
