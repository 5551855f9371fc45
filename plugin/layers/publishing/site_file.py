"""Site file: content read from layers, its rows, and ``site.gpkg`` written."""

from __future__ import annotations

import math
import sqlite3
import struct
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from qgis.core import QgsFeedback

from ....robot_bridge.core.roads.centrelines import Surface
from ....robot_bridge.core.robotmap.model import ShapeType
from ....robot_bridge.core.robotmap.outlines import Outlines
from ....robot_bridge.core.sites.frame import SiteFrame
from ....robot_bridge.core.sites.geopackage import (
    CENTRELINES,
    KEEPOUTS,
    KNOWN_BEYOND,
    OBSTACLES,
    STAMP_KEY,
    SURFACES,
    Area,
    Centreline,
    LayerSpec,
    extras_text,
)
from ....robot_bridge.core.sites.settings import SiteSettings
from ....robot_bridge.core.sites.site_cache import CacheWriter
from ....robot_bridge.core.sites.site_layers import outline_groups
from ...ui.errors import PublicationError
from ...ui.language import tr
from ..geometry import line_wkb, multi_line_wkb, polygon_wkb
from ..layer_source import ObstacleSource
from ..obstacle_layers import ObstacleReader, check_sources
from ..road_layers import GroundReading, check_ground_sources, each_area, each_centreline, each_surface
from ..roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE
from ..site_transform import Bounds, SiteGeoreference, widen_bounds

# --- Everything that a site publishes, on its way from QGIS layers into a publication ---

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
        site: SiteGeoreference,
        bounds: Bounds | None,
        default_height: float,
        default_width: float,
    ) -> None:
        near = widen_bounds(bounds, KNOWN_BEYOND) if bounds is not None else None
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


def check_content_sources(sources: SiteSources, site: SiteGeoreference) -> None:
    """Raise :class:`LayerReadingError` for what reading ``sources`` would refuse, without reading."""
    check_sources(sources.obstacles, site)
    check_ground_sources(sources.centrelines, site, ROAD_CENTRELINE)
    check_ground_sources(sources.surfaces, site, ROAD_SURFACE)
    check_ground_sources(sources.keepouts, site, KEEPOUT)


# --- The content of a site as rows of the layers of ``site.gpkg``: well-known binary and values ---

_RINGS = tuple(int(one) for one in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP))
_STAIRS = int(ShapeType.STAIRS)
_POINT_BYTES = 16


class SiteRow(NamedTuple):
    """One feature: its geometry in the site CRS, the box around that, and the values of its fields.

    ``values`` are in the order of the layer's fields.
    """

    wkb: bytes
    box: Sequence[float]
    values: tuple[Any, ...]


def site_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> list[tuple[LayerSpec, Iterator[SiteRow]]]:
    """Return the four layers of a site with the rows of each, which are read as they are asked for.

    ``cache`` gets the obstacles as they are read, for they are read once.
    """
    return [
        (OBSTACLES, _obstacle_rows(content, frame, cache, feedback)),
        (CENTRELINES, _centreline_rows(content, frame, feedback)),
        (SURFACES, _surface_rows(content, frame, feedback)),
        (KEEPOUTS, _keepout_rows(content, frame, feedback)),
    ]


def _obstacle_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> Iterator[SiteRow]:
    for some in content.obstacles(feedback):
        cache.add(some)
        yield from _rows_of(some, frame)


def _rows_of(some: Outlines, frame: SiteFrame) -> Iterator[SiteRow]:
    """Yield ``some`` as features; a courtyard is a hole of the ring before it."""
    xy = frame.to_crs(some.coordinates)
    starts, ends = some.offsets[:-1], some.offsets[1:]
    shut = np.isin(some.shape_type, _RINGS)
    # Rotating there and back may leave the two ends a rounding error apart.
    xy[ends[shut] - 1] = xy[starts[shut]]
    boxes = np.hstack([np.minimum.reduceat(xy, starts), np.maximum.reduceat(xy, starts)]).tolist()
    data, edges, kinds = xy.tobytes(), (some.offsets * _POINT_BYTES).tolist(), some.shape_type.tolist()
    height, outdoor, base = some.height.tolist(), some.outdoor.tolist(), some.bases.tolist()
    extras = [extras_text(one) if one else "" for one in some.extras]
    for first, last in outline_groups(some):
        rings = [data[edges[k] : edges[k + 1]] for k in range(first, last)]
        kind = kinds[first]
        if kind in _RINGS:
            wkb = polygon_wkb(rings)
        else:
            wkb = multi_line_wkb(_risers(rings[0])) if kind == _STAIRS else line_wkb(rings[0])
        values = {
            "source": some.source[first],
            "semantics": some.semantics[first],
            "height_m": height[first],
            "outdoor": int(outdoor[first]),
            "shape_type": kind,
            "base_m": base[first],
            "ext": extras[first],
        }
        yield SiteRow(wkb, boxes[first], _in_order(OBSTACLES, values))


def _risers(points: bytes) -> list[bytes]:
    return [points[at : at + 2 * _POINT_BYTES] for at in range(0, len(points), 2 * _POINT_BYTES)]


def _centreline_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRow]:
    for line in content.centrelines(feedback):
        points = frame.to_crs(line.points)
        values = {name: getattr(line, name) for name in CENTRELINES.fields}
        values["closed"] = int(line.closed)
        yield SiteRow(line_wkb(points.tobytes()), _box(points), _in_order(CENTRELINES, values))


def _surface_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRow]:
    for one in content.surfaces(feedback):
        values = {"surface": one.label, "name": one.name, "origin": one.origin}
        yield _area_row(SURFACES, one.rings, values, frame)


def _keepout_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRow]:
    for one in content.keepouts(feedback):
        yield _area_row(KEEPOUTS, one.rings, {"name": one.label}, frame)


def _area_row(
    spec: LayerSpec, rings: tuple[np.ndarray, ...], values: Mapping[str, Any], frame: SiteFrame
) -> SiteRow:
    placed = [frame.to_crs(ring) for ring in rings]
    for ring in placed:
        ring[-1] = ring[0]
    return SiteRow(polygon_wkb([ring.tobytes() for ring in placed]), _box(placed[0]), _in_order(spec, values))


def _box(points: np.ndarray) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


def _in_order(spec: LayerSpec, values: Mapping[str, Any]) -> tuple[Any, ...]:
    return tuple([values[name] for name in spec.fields])


# --- ``site.gpkg`` written by the GDAL that every QGIS has: no pyogrio, no shapely ---
# The layers and fields are those of ``robot_bridge.core.sites.geopackage``, and the stamp is the one that
# ``robot_bridge.core.sites`` looks for when it reads the file.

_KINDS = {"Unknown": "wkbUnknown", "LineString": "wkbLineString", "Polygon": "wkbPolygon"}
_GEOMETRY = "geom"
_OPTIONS = ["VERSION=1.3"]
_LAYER_OPTIONS = [f"GEOMETRY_NAME={_GEOMETRY}", "SPATIAL_INDEX=NO"]
_HEAD = struct.Struct("<2sBBi4d")
"""Magic, version, flags, CRS and box of a geometry in a GeoPackage (OGC 12-128r18, 2.1.3)."""
_LITTLE_ENDIAN_WITH_BOX = 3


def write_site_file(
    file: Path, content: SiteContent, settings: SiteSettings, cache: CacheWriter, feedback: QgsFeedback
) -> bool:
    """Write ``content`` to the new GeoPackage ``file``; return whether it is whole, false after a cancel.

    ``cache`` gets the obstacles.

    Version 1.3 of the format, which GDAL 3.6 and older read. The tables are GDAL's; features go into them by
    SQL, since an object of GDAL for each takes longer than everything else.

    :raises PublicationError: when the file cannot be written.
    """
    with _named_failures(file) as gdal:
        layers = site_rows(content, settings.frame, cache, feedback)
        _make_tables(gdal, file, [spec for spec, _ in layers], settings)
        with closing(sqlite3.connect(file, isolation_level=None)) as database:
            # What is left after a crash is thrown away whole.
            database.execute("PRAGMA journal_mode = OFF")
            database.execute("PRAGMA synchronous = OFF")
            for spec, rows in layers:
                _insert(database, spec, rows)
                if feedback.isCanceled() or not content.complete:
                    return False
        target = _there(gdal.OpenEx(str(file), gdal.OF_VECTOR | gdal.OF_UPDATE, ["GPKG"]))
        for spec, _ in layers:
            target.ExecuteSQL(f"SELECT CreateSpatialIndex('{spec.name}', '{_GEOMETRY}')")
        _done(target.FlushCache())
        return True


def stamp_in(file: Path) -> str:
    """Return which publication the GeoPackage ``file`` belongs to; nothing when it does not say."""
    with suppress(PublicationError), _named_failures(file) as gdal:
        source = _there(gdal.OpenEx(str(file), gdal.OF_VECTOR | gdal.OF_READONLY, ["GPKG"]))
        return str(_there(source.GetLayer(0)).GetMetadataItem(STAMP_KEY) or "")
    return ""


def _make_tables(gdal: Any, file: Path, specs: Sequence[LayerSpec], settings: SiteSettings) -> None:
    """Make the GeoPackage with its layers, empty and without spatial index, and close it."""
    _, ogr, osr = _bindings()
    crs = osr.SpatialReference()
    _done(crs.SetFromUserInput(settings.crs))
    crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    target = _there(gdal.GetDriverByName("GPKG").Create(str(file), 0, 0, 0, gdal.GDT_Unknown, _OPTIONS))
    for spec in specs:
        kind = getattr(ogr, _KINDS[spec.geometry])
        layer = _there(target.CreateLayer(spec.name, crs, kind, _LAYER_OPTIONS))
        for name, type_ in spec.fields.items():
            _done(layer.CreateField(_field(name, type_)))
        # On the layer, not the file: GDAL would put that into an .aux.xml file beside the site each time.
        _done(layer.SetMetadataItem(STAMP_KEY, settings.stamp))
    _done(target.FlushCache())


def _insert(database: sqlite3.Connection, spec: LayerSpec, rows: Iterator[SiteRow]) -> None:
    """Insert ``rows`` into the table of ``spec`` and note there what the table holds."""
    find = "SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = ?"
    (srs,) = database.execute(find, [spec.name]).fetchone()
    box = [math.inf, math.inf, -math.inf, -math.inf]
    columns = ", ".join(f'"{name}"' for name in (_GEOMETRY, *spec.fields))
    places = ", ".join("?" * (len(spec.fields) + 1))
    database.execute("BEGIN")
    database.executemany(
        f'INSERT INTO "{spec.name}" ({columns}) VALUES ({places})',  # nosec B608 # names
        ((_blob(row, srs, box), *row.values) for row in rows),
    )
    if box[0] <= box[2]:
        note = "UPDATE gpkg_contents SET min_x = ?, min_y = ?, max_x = ?, max_y = ? WHERE table_name = ?"
        database.execute(note, [*box, spec.name])
    else:
        kind = spec.declared_geometry(empty=True).upper()
        note = "UPDATE gpkg_geometry_columns SET geometry_type_name = ? WHERE table_name = ?"
        database.execute(note, [kind, spec.name])
    database.execute("COMMIT")


def _blob(row: SiteRow, srs: int, box: list[float]) -> bytes:
    """Return the geometry of ``row`` as GeoPackages keep it, and widen ``box`` by it."""
    x_min, y_min, x_max, y_max = row.box
    if x_min < box[0]:
        box[0] = x_min
    if y_min < box[1]:
        box[1] = y_min
    if x_max > box[2]:
        box[2] = x_max
    if y_max > box[3]:
        box[3] = y_max
    return _HEAD.pack(b"GP", 0, _LITTLE_ENDIAN_WITH_BOX, srs, x_min, x_max, y_min, y_max) + row.wkb


def _field(name: str, kind: type) -> Any:
    _, ogr, _ = _bindings()
    kinds = {str: ogr.OFTString, float: ogr.OFTReal, bool: ogr.OFTInteger, int: ogr.OFTInteger64}
    field = ogr.FieldDefn(name, kinds[kind])
    if kind is bool:
        field.SetSubType(ogr.OFSTBoolean)
    return field


@contextmanager
def _named_failures(file: Path) -> Iterator[Any]:
    """Give the module ``gdal``; what it fails at becomes an error that names ``file``.

    Whether GDAL raises is a setting of the whole program, which is left alone: failures are told either way.
    """
    gdal, _, _ = _bindings()
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    try:
        yield gdal
    except (RuntimeError, sqlite3.Error) as error:
        raise PublicationError(
            tr(
                "{file} cannot be written in {folder}: {error}. Check the folder's rights and the free "
                "space.",
                file=file.name,
                folder=file.parent.parent,
                error=error,
            )
        ) from error
    finally:
        gdal.PopErrorHandler()


def _there(made: Any) -> Any:
    if made is None:
        raise RuntimeError(_last_message())
    return made


def _done(status: int | None) -> None:
    if status:
        raise RuntimeError(_last_message())


def _last_message() -> str:
    gdal, _, _ = _bindings()
    return gdal.GetLastErrorMsg() or tr("GDAL does not say why")


def _bindings() -> tuple[Any, Any, Any]:
    try:
        from osgeo import gdal, ogr, osr
    except ImportError as error:
        raise PublicationError(
            tr(
                "The Python bindings of GDAL (osgeo) are missing in this QGIS, which write site.gpkg: "
                "install the distribution's package, such as python3-gdal."
            )
        ) from error
    return gdal, ogr, osr
