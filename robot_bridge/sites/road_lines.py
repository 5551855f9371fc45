"""The roads of a site as the network takes them."""

from __future__ import annotations

from collections.abc import Sequence

from ..roads.centrelines import Centrelines, centrelines
from .features import Centreline


def road_lines(roads: Sequence[Centreline]) -> Centrelines:
    """Return ``roads``, at least one, with all that is known of each."""
    return centrelines(
        [road.points for road in roads],
        width=[road.width_m for road in roads],
        surface=[road.surface for road in roads],
        direction=[road.direction for road in roads],
        speed=[road.speed_ms for road in roads],
        closed=[road.closed for road in roads],
        level=[road.level for road in roads],
    )
