"""What is closed on a network at one moment; never changed, so that any thread may ask without waiting."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..roads.along import edges_along
from ..roads.nearest import NearestEdge
from ..roads.points import flags

Place = tuple[float, float]
"""x, y in metres, site frame."""


@dataclass(frozen=True)
class ClosedRoads:
    """``closures`` tells the edges that each closure closes, ``closed`` all that are closed, (n,).

    ``nearest`` is None where the site has no roads.
    """

    nearest: NearestEdge | None = None
    closures: Mapping[str, frozenset[int]] = field(default_factory=dict)
    closed: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))

    def along(self, path: Sequence[Place], among: Collection[str] | None = None) -> list[str]:
        """Return the closures, of ``among`` or all, along whose road ``path`` leads."""
        asked = {id: self.closures.get(id, frozenset()) for id in (self.closures if among is None else among)}
        shut = frozenset().union(*asked.values())
        if self.nearest is None or not shut or len(path) < 2:
            return []
        points = np.asarray(path, dtype=np.float64)
        found = set(edges_along(self.nearest, points, self._flags(shut)).tolist())
        return [id for id, edges in asked.items() if edges & found]

    def at(self, place: Place) -> str | None:
        """Return the closure whose road ``place`` is on, if it is on no road that is open."""
        shut = frozenset().union(*self.closures.values())
        if self.nearest is None or not shut:
            return None
        width = self.nearest.network.edges.width
        reach = float(width[list(shut)].max()) / 2
        found = self.nearest.nearest(*place, reach, self._flags(shut))
        if found is None or found.away > width[found.edge] / 2:
            return None
        free = self.nearest.nearest(*place, float(width.max()) / 2, ~self.closed)
        if free is not None and free.away <= width[free.edge] / 2:
            return None
        return next(id for id, edges in self.closures.items() if found.edge in edges)

    def _flags(self, edges: Iterable[int]) -> NDArray[np.bool_]:
        assert self.nearest is not None
        return flags(len(self.nearest.network), np.array(sorted(edges), dtype=np.int64))
