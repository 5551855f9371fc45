"""Ways along roads: how far they are, and the paths that robots drive on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..roads.dense import Driving, dense_path
from ..roads.errors import OffNetworkError
from ..roads.matrix import road_matrix
from ..roads.routes import REACH, Restrictions, Router
from .job import Floats, Job
from .travel import straight


class RoadTravel:
    """The shortest ways on the roads of ``router`` that ``wanted`` allows.

    From each place a straight line of at most ``reach`` metres leads to the nearest road. ``progress`` is
    told which share of the distances is known, and may raise to end it.

    :raises OffNetworkError: naming the places that are farther from every road.
    """

    def __init__(
        self,
        job: Job,
        router: Router,
        driving: Driving | None = None,
        wanted: Restrictions | None = None,
        reach: float = REACH,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        self._job, self._router = job, router
        self._driving, self._reach = driving or Driving(), reach
        self._wanted = replace(wanted or Restrictions(), fastest=False)
        places = [(float(x), float(y)) for x, y in job.places]
        found = road_matrix(router.network, places, self._wanted, reach, router.closed, progress)
        far = np.flatnonzero(np.isinf(found.away)).tolist()
        if far:
            names = ", ".join(job.name(place) for place in far[:10]) + (
                " and others" if len(far) > 10 else ""
            )
            raise OffNetworkError(
                f"More than {reach:g} m from every road that may be used: {names}. Choose places nearer to a "
                "road, or allow a greater distance."
            )
        self.name = f"roads ({found.engine})"
        off = found.away
        self.metres: Floats = found.costs + off[:, None] + off[None, :]
        np.fill_diagonal(self.metres, 0.0)

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place: to the road, along it with rounded corners, and off it."""
        a, b = self._job.places[start], self._job.places[goal]
        if start == goal:
            return straight(a, b, self._driving.spacing)
        route = self._router.route(_place(a), _place(b), self._wanted, self._reach)
        path = dense_path(route.points, route.widths, self._driving).points
        spacing = self._driving.spacing
        parts = [straight(a, path[0], spacing), path, straight(path[-1], b, spacing)]
        points = np.concatenate(parts)
        moves = np.hypot(*np.diff(points, axis=0).T) > 1e-6
        kept: Floats = points[np.concatenate([[True], moves])]
        return kept if len(kept) > 1 else straight(a, b, spacing)


def _place(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])
