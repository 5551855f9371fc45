"""What a site holds, on its way from QGIS layers into a publication."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...robot_bridge.roads.surfaces.surface import Surface
from ...robot_bridge.robotmap.outlines import OutlineRow
from ...robot_bridge.sites.features import Area, Centreline


@dataclass(frozen=True)
class SiteContent:
    """Obstacles, roads, road surfaces and keepouts in the site frame, metres."""

    obstacles: Sequence[OutlineRow] = ()
    centrelines: Sequence[Centreline] = ()
    surfaces: Sequence[Surface] = ()
    keepouts: Sequence[Area] = ()
    warnings: list[str] = field(default_factory=list)

    @property
    def extent(self) -> tuple[float, float, float, float] | None:
        """Return x_min, y_min, x_max, y_max of everything; None where there is nothing."""
        boxes = [np.concatenate([points.min(axis=0), points.max(axis=0)]) for points in self._points()]
        if not boxes:
            return None
        low, high = np.min(boxes, axis=0)[:2], np.max(boxes, axis=0)[2:]
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def _points(self) -> list[np.ndarray]:
        areas = (*self.surfaces, *self.keepouts)
        return [
            *(row.points for row in self.obstacles),
            *(line.points for line in self.centrelines),
            *(area.rings[0] for area in areas),
        ]
