"""Everything that a site publishes, on its way from QGIS layers into a publication."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from qgis.core import QgsFeedback

from ...robot_bridge.roads.surfaces.surface import Surface
from ...robot_bridge.robotmap.outlines import Outlines
from ...robot_bridge.sites.features import Area, Centreline
from ...robot_bridge.sites.layers import CENTRELINES, KEEPOUTS, OBSTACLES, SURFACES
from ...robot_bridge.sites.reach import KNOWN_BEYOND
from .ground_reading import (
    GroundReading,
    check_ground_sources,
    each_area,
    each_centreline,
    each_surface,
)
from .obstacle_source import ObstacleSource
from .placing import Bounds, SitePlacing, widened
from .reading import ObstacleReader, check_sources
from .roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE

LAYERS = (OBSTACLES, CENTRELINES, SURFACES, KEEPOUTS)
"""The layers of a site in the order in which they are read."""


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


class SiteContent:
    """What ``sources`` hold, in the site frame, metres; each part is read once, as it is asked for.

    Nothing is kept: a city has more than memory should be spent on.
    Of obstacles what is near ``bounds`` is read, else all.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """

    def __init__(
        self,
        sources: SiteSources,
        site: SitePlacing,
        bounds: Bounds | None,
        default_height: float,
        default_width: float,
    ) -> None:
        near = widened(bounds, KNOWN_BEYOND) if bounds is not None else None
        self._sources, self._site, self._default_width = sources, site, default_width
        self._obstacles = ObstacleReader(sources.obstacles, site, near, default_height)
        self._roads: GroundReading[Centreline] = GroundReading()
        self._surfaces: GroundReading[Surface] = GroundReading()
        self._keepouts: GroundReading[Area] = GroundReading()
        self._low, self._high = np.full(2, np.inf), np.full(2, -np.inf)
        self.counts = dict.fromkeys((layer.name for layer in LAYERS), 0)
        """How many outlines, roads and areas were read so far, by the names of their layers."""

    @property
    def complete(self) -> bool:
        """Whether nothing of what was asked for was left out; false after a cancel."""
        ground = (self._roads, self._surfaces, self._keepouts)
        return self._obstacles.complete and all(reading.complete for reading in ground)

    @property
    def extent(self) -> Bounds | None:
        """x_min, y_min, x_max, y_max of what was read so far; None where there is nothing."""
        if not any(self.counts.values()):
            return None
        (x_min, y_min), (x_max, y_max) = self._low.tolist(), self._high.tolist()
        return x_min, y_min, x_max, y_max

    def warnings(self) -> list[str]:
        """Return what there is to warn of in what was read so far."""
        read = (self._obstacles.warnings, self._roads.notes, self._surfaces.notes, self._keepouts.notes)
        return [text for notes in read for text in notes.texts()]

    def obstacles(self, feedback: QgsFeedback) -> Iterator[Outlines]:
        """Yield the obstacles, some at a time."""
        for some in self._obstacles.parts(feedback):
            self._counted(OBSTACLES.name, some.coordinates, len(some))
            yield some

    def centrelines(self, feedback: QgsFeedback) -> Iterator[Centreline]:
        """Yield the roads."""
        sources = self._sources.centrelines
        for line in each_centreline(sources, self._site, self._default_width, self._roads, feedback):
            self._counted(CENTRELINES.name, line.points)
            yield line

    def surfaces(self, feedback: QgsFeedback) -> Iterator[Surface]:
        """Yield the road surfaces."""
        for surface in each_surface(self._sources.surfaces, self._site, self._surfaces, feedback):
            self._counted(SURFACES.name, surface.rings[0])
            yield surface

    def keepouts(self, feedback: QgsFeedback) -> Iterator[Area]:
        """Yield the keepouts."""
        for area in each_area(self._sources.keepouts, self._site, KEEPOUT, self._keepouts, feedback):
            self._counted(KEEPOUTS.name, area.rings[0])
            yield area

    def _counted(self, layer: str, points: np.ndarray, count: int = 1) -> None:
        self.counts[layer] += count
        self._low = np.minimum(self._low, points.min(axis=0)[:2])
        self._high = np.maximum(self._high, points.max(axis=0)[:2])


def check_content_sources(sources: SiteSources, site: SitePlacing) -> None:
    """Raise :class:`LayerReadingError` for what reading ``sources`` would refuse, without reading."""
    check_sources(sources.obstacles, site)
    check_ground_sources(sources.centrelines, site, ROAD_CENTRELINE)
    check_ground_sources(sources.surfaces, site, ROAD_SURFACE)
    check_ground_sources(sources.keepouts, site, KEEPOUT)
