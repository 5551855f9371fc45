"""Reads everything that a site publishes from its layers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from qgis.core import QgsFeedback

from ...robot_bridge.sites.reach import KNOWN_BEYOND
from .ground_reading import check_ground_sources, read_areas, read_centrelines, read_surfaces
from .obstacle_source import ObstacleSource
from .placing import Bounds, SitePlacing, widened
from .reading import check_sources, read_outlines
from .roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE
from .site_content import SiteContent


@dataclass(frozen=True)
class SiteSources:
    """The layers of a site, by what is read of them."""

    obstacles: Sequence[ObstacleSource] = ()
    centrelines: Sequence[ObstacleSource] = ()
    surfaces: Sequence[ObstacleSource] = ()
    keepouts: Sequence[ObstacleSource] = ()

    def all(self) -> list[ObstacleSource]:
        """Return every source."""
        return [*self.obstacles, *self.centrelines, *self.surfaces, *self.keepouts]


def read_content(
    sources: SiteSources,
    site: SitePlacing,
    bounds: Bounds | None,
    default_height: float,
    default_width: float,
    feedback: QgsFeedback,
) -> SiteContent | None:
    """Return what the layers hold, None after a cancel; of obstacles what is near ``bounds``, else all.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """
    near = widened(bounds, KNOWN_BEYOND) if bounds is not None else None
    obstacles = read_outlines(sources.obstacles, site, near, default_height, feedback)
    centrelines = read_centrelines(sources.centrelines, site, default_width, feedback)
    surfaces = read_surfaces(sources.surfaces, site, feedback)
    keepouts = read_areas(sources.keepouts, site, KEEPOUT, feedback)
    readings = (obstacles, centrelines, surfaces, keepouts)
    if feedback.isCanceled() or not all(reading.complete for reading in readings):
        return None
    return SiteContent(
        obstacles=obstacles.rows,
        centrelines=centrelines.items,
        surfaces=surfaces.items,
        keepouts=keepouts.items,
        warnings=[warning for reading in readings for warning in reading.warnings],
    )


def check_content_sources(sources: SiteSources, site: SitePlacing) -> None:
    """Raise :class:`LayerReadingError` for what :func:`read_content` would refuse, without reading."""
    check_sources(sources.obstacles, site)
    check_ground_sources(sources.centrelines, site, ROAD_CENTRELINE)
    check_ground_sources(sources.surfaces, site, ROAD_SURFACE)
    check_ground_sources(sources.keepouts, site, KEEPOUT)
