"""Content of a site: its layers' features, read in batches, as rows of the layers of ``site.gpkg``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, islice, pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
from qgis.core import QgsFeedback

from ....robot_bridge.core.roads.network import Surface
from ....robot_bridge.core.robotmap.model import ShapeType
from ....robot_bridge.core.robotmap.outlines import Outlines
from ....robot_bridge.core.sites import geopackage
from ....robot_bridge.core.sites.frame import SiteFrame
from ....robot_bridge.core.sites.site_cache import CacheWriter
from ....robot_bridge.core.sites.site_layers import group_spans
from ..geometry import line_wkb, multi_line_wkb, polygon_heads, polygon_wkb
from ..layer_source import ObstacleSource
from ..obstacle_layers import ObstacleReader, check_sources
from ..road_layers import GroundReading, check_ground_sources, each_area, each_centreline, each_surface
from ..roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE
from ..site_transform import Bounds, SiteGeoreference, widen_bounds

# --- The data that a site publishes, from QGIS layers to a publication ---

LAYERS = (geopackage.OBSTACLES, geopackage.CENTRELINES, geopackage.SURFACES, geopackage.KEEPOUTS)
"""The layers of a site in the order in which they are read."""


@dataclass(frozen=True)
class SiteSources:
    """The layers of a site, by the kind of their content."""

    obstacles: Sequence[ObstacleSource] = ()
    centrelines: Sequence[ObstacleSource] = ()
    surfaces: Sequence[ObstacleSource] = ()
    keepouts: Sequence[ObstacleSource] = ()

    def all(self) -> list[ObstacleSource]:
        """Return every source."""
        return [*self.obstacles, *self.centrelines, *self.surfaces, *self.keepouts]


_TOGETHER = 1000
"""Roads or areas that are placed and written together."""
Item = TypeVar("Item", bound="geopackage.Centreline | geopackage.Area | Surface")


class SiteContent:
    """The content of ``sources``, in the site frame, metres; each part is read once, on request.

    Nothing is kept: a city is larger than memory should be.
    Obstacles are read near ``bounds`` if given, else all.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """

    def __init__(
        self,
        sources: SiteSources,
        site: SiteGeoreference,
        bounds: Bounds | None,
        default_height: float,
        default_width: float,
    ) -> None:
        near = widen_bounds(bounds, geopackage.KNOWN_BEYOND) if bounds is not None else None
        self._sources, self._site, self._default_width = sources, site, default_width
        self._obstacles = ObstacleReader(sources.obstacles, site, near, default_height)
        self._roads: GroundReading[geopackage.Centreline] = GroundReading()
        self._surfaces: GroundReading[Surface] = GroundReading()
        self._keepouts: GroundReading[geopackage.Area] = GroundReading()
        self._low, self._high = np.full(2, np.inf), np.full(2, -np.inf)
        self.counts = dict.fromkeys((layer.name for layer in LAYERS), 0)
        """Numbers of outlines, roads and areas read so far, by the names of their layers."""

    @property
    def complete(self) -> bool:
        """Whether everything requested was read; false if cancelled."""
        ground = (self._roads, self._surfaces, self._keepouts)
        return self._obstacles.complete and all(reading.complete for reading in ground)

    @property
    def extent(self) -> Bounds | None:
        """x_min, y_min, x_max, y_max of the content read so far; None where there is none."""
        if not any(self.counts.values()):
            return None
        (x_min, y_min), (x_max, y_max) = self._low.tolist(), self._high.tolist()
        return x_min, y_min, x_max, y_max

    def warnings(self) -> list[str]:
        """Return the warnings about the content read so far."""
        read = (self._obstacles.warnings, self._roads.notes, self._surfaces.notes, self._keepouts.notes)
        return [text for notes in read for text in notes.texts()]

    def obstacles(self, feedback: QgsFeedback) -> Iterator[Outlines]:
        """Yield the obstacles, in batches."""
        for some in self._obstacles.parts(feedback):
            self._counted(geopackage.OBSTACLES.name, some.coordinates, len(some))
            yield some

    def centrelines(self, feedback: QgsFeedback) -> Iterator[list[geopackage.Centreline]]:
        """Yield the roads, in batches."""
        sources = self._sources.centrelines
        for some in _some(each_centreline(sources, self._site, self._default_width, self._roads, feedback)):
            self._counted(
                geopackage.CENTRELINES.name, np.concatenate([line.points for line in some]), len(some)
            )
            yield some

    def surfaces(self, feedback: QgsFeedback) -> Iterator[list[Surface]]:
        """Yield the road surfaces, in batches."""
        for some in _some(each_surface(self._sources.surfaces, self._site, self._surfaces, feedback)):
            self._counted(geopackage.SURFACES.name, np.concatenate([one.rings[0] for one in some]), len(some))
            yield some

    def keepouts(self, feedback: QgsFeedback) -> Iterator[list[geopackage.Area]]:
        """Yield the keepouts, in batches."""
        for some in _some(each_area(self._sources.keepouts, self._site, KEEPOUT, self._keepouts, feedback)):
            self._counted(geopackage.KEEPOUTS.name, np.concatenate([one.rings[0] for one in some]), len(some))
            yield some

    def _counted(self, layer: str, points: np.ndarray, count: int) -> None:
        self.counts[layer] += count
        self._low = np.minimum(self._low, points.min(axis=0)[:2])
        self._high = np.maximum(self._high, points.max(axis=0)[:2])


def _some(items: Iterator[Item]) -> Iterator[list[Item]]:
    while some := list(islice(items, _TOGETHER)):
        yield some


def check_content_sources(sources: SiteSources, site: SiteGeoreference) -> None:
    """Raise :class:`LayerReadingError` for what reading ``sources`` would refuse, without reading."""
    check_sources(sources.obstacles, site)
    check_ground_sources(sources.centrelines, site, ROAD_CENTRELINE)
    check_ground_sources(sources.surfaces, site, ROAD_SURFACE)
    check_ground_sources(sources.keepouts, site, KEEPOUT)


# --- The content of a site as rows of the layers of ``site.gpkg``: geometries and values, in batches

_RINGS = tuple(int(one) for one in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP))
_STAIRS = int(ShapeType.STAIRS)
_POINT_BYTES = 16


class SiteRows(NamedTuple):
    """Features of one layer: the geometry of each without its GeoPackage header, and its box.

    ``boxes`` is (n, 4), x_min, y_min, x_max and y_max in the site CRS; ``columns`` are the values of each
    field of the layer, n of them.
    """

    wkb: Sequence[bytes]
    boxes: np.ndarray
    columns: Sequence[Iterable[Any]]


def site_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> list[tuple[geopackage.LayerSpec, Iterator[SiteRows]]]:
    """Return the four layers of a site with the rows of each, which are read on request.

    ``cache`` receives the obstacles as they are read, as they are read only once.
    """
    return [
        (geopackage.OBSTACLES, _obstacle_rows(content, frame, cache, feedback)),
        (geopackage.CENTRELINES, _centreline_rows(content, frame, feedback)),
        (geopackage.SURFACES, _surface_rows(content, frame, feedback)),
        (geopackage.KEEPOUTS, _keepout_rows(content, frame, feedback)),
    ]


def _obstacle_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> Iterator[SiteRows]:
    for some in content.obstacles(feedback):
        cache.add(some)
        yield _rows_of(some, frame)


def _rows_of(some: Outlines, frame: SiteFrame) -> SiteRows:
    """Return ``some`` as features; a courtyard is a hole of the ring before it."""
    shut = np.isin(some.shape_type, _RINGS)
    shapes = _PlacedShapes(some.coordinates, some.offsets, shut, frame)
    rows, ends = group_spans(some).T
    groups = list(zip(rows.tolist(), ends.tolist(), strict=True))
    wkb = shapes.wkb(groups)
    for k in np.flatnonzero(some.shape_type[rows] == _STAIRS).tolist():
        wkb[k] = multi_line_wkb(_risers(shapes.points(groups[k][0])))
    extras = some.extras
    values: dict[str, Iterable[Any]] = {
        "source": [some.source[first] for first, _ in groups],
        "semantics": [some.semantics[first] for first, _ in groups],
        "height_m": some.height[rows].tolist(),
        "outdoor": some.outdoor[rows].astype(int).tolist(),
        "shape_type": some.shape_type[rows].tolist(),
        "base_m": some.bases[rows].tolist(),
        "ext": [geopackage.extras_text(extras[first]) for first, _ in groups],
    }
    return SiteRows(wkb, shapes.boxes()[rows], _in_order(geopackage.OBSTACLES, values))


def _risers(points: bytes) -> list[bytes]:
    return [points[at : at + 2 * _POINT_BYTES] for at in range(0, len(points), 2 * _POINT_BYTES)]


def _centreline_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRows]:
    for some in content.centrelines(feedback):
        shapes = _PlacedShapes.of([line.points for line in some], frame, closed=False)
        values: dict[str, Iterable[Any]] = {
            name: [getattr(line, name) for line in some] for name in geopackage.CENTRELINES.fields
        }
        values["closed"] = map(int, values["closed"])
        wkb = shapes.wkb([(k, k + 1) for k in range(len(some))])
        yield SiteRows(wkb, shapes.boxes(), _in_order(geopackage.CENTRELINES, values))


def _surface_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRows]:
    for some in content.surfaces(feedback):
        values = {
            "surface": [one.label for one in some],
            "name": [one.name for one in some],
            "origin": [one.origin for one in some],
        }
        yield _area_rows(geopackage.SURFACES, [one.rings for one in some], values, frame)


def _keepout_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRows]:
    for some in content.keepouts(feedback):
        names = [one.label for one in some]
        yield _area_rows(geopackage.KEEPOUTS, [one.rings for one in some], {"name": names}, frame)


def _area_rows(
    spec: geopackage.LayerSpec,
    areas: Sequence[Sequence[np.ndarray]],
    values: Mapping[str, Iterable[Any]],
    frame: SiteFrame,
) -> SiteRows:
    shapes = _PlacedShapes.of(list(chain.from_iterable(areas)), frame, closed=True)
    edges = np.concatenate([[0], np.cumsum([len(rings) for rings in areas])])
    wkb = shapes.wkb(list(pairwise(edges.tolist())))
    return SiteRows(wkb, shapes.boxes()[edges[:-1]], _in_order(spec, values))


def _in_order(spec: geopackage.LayerSpec, values: Mapping[str, Iterable[Any]]) -> list[Iterable[Any]]:
    return [values[name] for name in spec.fields]


class _PlacedShapes:
    """Rings and lines in the site CRS: ``coordinates``, (m, 2) in the site frame, one after the other.

    ``offsets``, (n + 1,), is where each begins, ``closed``, (n,), which are rings. None is without points.
    """

    def __init__(
        self, coordinates: np.ndarray, offsets: np.ndarray, closed: np.ndarray, frame: SiteFrame
    ) -> None:
        self._xy = frame.to_crs(coordinates)
        self._starts, ends = offsets[:-1], offsets[1:]
        # Rotating forth and back may leave the two ends a rounding error apart.
        self._xy[ends[closed] - 1] = self._xy[self._starts[closed]]
        self._closed = closed.tolist()
        self._lengths = ends - self._starts
        self._data, self._edges = self._xy.tobytes(), (offsets * _POINT_BYTES).tolist()

    @classmethod
    def of(cls, shapes: Sequence[np.ndarray], frame: SiteFrame, *, closed: bool) -> _PlacedShapes:
        """Return ``shapes``, each (n, 2) in the site frame, all rings or all lines."""
        offsets = np.concatenate([[0], np.cumsum([len(one) for one in shapes])])
        return cls(np.concatenate(shapes), offsets, np.full(len(shapes), closed), frame)

    def boxes(self) -> np.ndarray:
        """Return x_min, y_min, x_max and y_max of each, (n, 4)."""
        low = np.minimum.reduceat(self._xy, self._starts)
        return np.hstack([low, np.maximum.reduceat(self._xy, self._starts)])

    def points(self, number: int) -> bytes:
        """Return x and y of each point of one of them."""
        return self._data[self._edges[number] : self._edges[number + 1]]

    def wkb(self, groups: Sequence[tuple[int, int]]) -> list[bytes]:
        """Return the geometry of each of ``groups``, the index of its first ring and the one after its last.

        A polygon, its other rings as holes; if the first one is a line, that line.
        """
        data, edges, heads = self._data, self._edges, polygon_heads(self._lengths)
        made = []
        for first, last in groups:
            if not self._closed[first]:
                made.append(line_wkb(self.points(first)))
            elif last - first > 1:
                made.append(polygon_wkb([self.points(k) for k in range(first, last)]))
            else:
                made.append(heads[first] + data[edges[first] : edges[last]])
        return made
