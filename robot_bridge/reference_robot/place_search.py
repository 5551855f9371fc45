"""Where on a whole map a scan fits: what the filter begins with when the robot may be anywhere."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..robotmap.model import RobotMap
from .errors import ReferenceRobotError
from .resampling import low_variance
from .scan_models import FieldModel
from .settings import FilterSettings, LaserSettings
from .world import Walls, inside_solids

WIDE_SIGMA = 0.5
"""metres: how near a place must be to be noticed at first."""
KEPT = 500
"""Places that are looked at more closely."""
TRIES = 16
"""around each of them, twice, the second time nearer."""
ROUNDS = ((0.3, math.radians(6)), (0.1, math.radians(2)))
"""metres and radians around them: standard deviations."""
FEW_BEAMS, MORE_BEAMS = 16, 40
"""of a scan are enough to notice a place, and to compare places."""
AT_ONCE = 4_000
"""poses: so few that their arrays stay in the processor's cache."""


class PlaceSearch:
    """Finds poses on ``robot_map`` at which a scan fits, by likelihood fields of its ``walls``."""

    def __init__(
        self, robot_map: RobotMap, walls: Walls, laser: LaserSettings, settings: FilterSettings
    ) -> None:
        self._map = robot_map
        self._worth = settings.beams_of_worth
        self._wide = FieldModel(walls, laser, msgspec.structs.replace(settings, sigma=WIDE_SIGMA))
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
        """Return ``count`` poses, (count, 3), of ``looked_at`` random ones, by how well a scan fits there.

        ``bearings`` and ``ranges``, (B,), are of beams with a reading. ``near`` is x, y and a standard
        deviation, metres: poses are looked at around there, else all over the map.
        """
        poses = self.free(looked_at, rng, near)
        few = _spread(len(ranges), FEW_BEAMS)
        parts = np.array_split(poses, 1 + looked_at // AT_ONCE)
        fit = np.concatenate(
            [self._wide.log_likelihood(part, bearings[few], ranges[few])[0] for part in parts]
        )
        more = _spread(len(ranges), MORE_BEAMS)
        bearings, ranges = bearings[more], ranges[more]
        kept = min(KEPT, looked_at)
        best = poses[np.argpartition(-fit, kept - 1)[:kept]]
        for metres, radians in ROUNDS:
            around = np.repeat(best[:, None], TRIES, axis=1)
            around[:, 1:] += rng.normal(0, (metres, metres, radians), (kept, TRIES - 1, 3))
            fit, _ = self._narrow.log_likelihood(around.reshape(-1, 3), bearings, ranges)
            fit = fit.reshape(kept, TRIES)
            best, fit = around[np.arange(kept), fit.argmax(axis=1)], fit.max(axis=1)
        weights = np.exp((fit - fit.max()) * min(self._worth, len(ranges)))
        found = best[low_variance(weights / weights.sum(), count, rng)]
        metres, radians = ROUNDS[-1]
        spread: NDArray[Any] = found + rng.normal(0, (metres / 2, metres / 2, radians / 2), found.shape)
        return spread

    def free(
        self, count: int, rng: np.random.Generator, near: tuple[float, float, float] | None = None
    ) -> NDArray[Any]:
        """Return poses all over the map, or around a place, but in what is solid, (count, 3).

        :raises ReferenceRobotError: when hardly anything is free there.
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
    """Return which of ``count`` beams to use, no more than ``most``, from all of the scan."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))
