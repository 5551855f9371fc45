"""Site file: content read from layers, its rows, and ``site.gpkg`` written."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from itertools import chain, islice, pairwise
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from qgis.core import QgsFeedback

from ....robot_bridge.core.roads.centrelines import Surface
from ....robot_bridge.core.robotmap.model import ShapeType
from ....robot_bridge.core.robotmap.outlines import Outlines
from ....robot_bridge.core.sites import geopackage
from ....robot_bridge.core.sites.frame import SiteFrame
from ....robot_bridge.core.sites.settings import SiteSettings
from ....robot_bridge.core.sites.site_cache import CacheWriter
from ....robot_bridge.core.sites.site_layers import outline_groups
from ...ui.errors import PublicationError
from ...ui.language import tr
from ..geometry import line_wkb, multi_line_wkb, polygon_heads, polygon_wkb
from ..layer_source import ObstacleSource
from ..obstacle_layers import ObstacleReader, check_sources
from ..road_layers import GroundReading, check_ground_sources, each_area, each_centreline, each_surface
from ..roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE
from ..site_transform import Bounds, SiteGeoreference, widen_bounds
from .spatial_index import BoxTree

# --- Everything that a site publishes, on its way from QGIS layers into a publication ---

LAYERS = (geopackage.OBSTACLES, geopackage.CENTRELINES, geopackage.SURFACES, geopackage.KEEPOUTS)
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


_TOGETHER = 1000
"""Roads or areas that are placed and written together."""
Item = TypeVar("Item", bound="geopackage.Centreline | geopackage.Area | Surface")


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
        near = widen_bounds(bounds, geopackage.KNOWN_BEYOND) if bounds is not None else None
        self._sources, self._site, self._default_width = sources, site, default_width
        self._obstacles = ObstacleReader(sources.obstacles, site, near, default_height)
        self._roads: GroundReading[geopackage.Centreline] = GroundReading()
        self._surfaces: GroundReading[Surface] = GroundReading()
        self._keepouts: GroundReading[geopackage.Area] = GroundReading()
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
            self._counted(geopackage.OBSTACLES.name, some.coordinates, len(some))
            yield some

    def centrelines(self, feedback: QgsFeedback) -> Iterator[list[geopackage.Centreline]]:
        """Yield the roads, some at a time."""
        sources = self._sources.centrelines
        for some in _some(each_centreline(sources, self._site, self._default_width, self._roads, feedback)):
            self._counted(
                geopackage.CENTRELINES.name, np.concatenate([line.points for line in some]), len(some)
            )
            yield some

    def surfaces(self, feedback: QgsFeedback) -> Iterator[list[Surface]]:
        """Yield the road surfaces, some at a time."""
        for some in _some(each_surface(self._sources.surfaces, self._site, self._surfaces, feedback)):
            self._counted(geopackage.SURFACES.name, np.concatenate([one.rings[0] for one in some]), len(some))
            yield some

    def keepouts(self, feedback: QgsFeedback) -> Iterator[list[geopackage.Area]]:
        """Yield the keepouts, some at a time."""
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


# --- The content of a site as rows of the layers of ``site.gpkg``: geometries and values, some at a time

_RINGS = tuple(int(one) for one in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP))
_STAIRS = int(ShapeType.STAIRS)
_POINT_BYTES = 16


class SiteRows(NamedTuple):
    """Features of one layer: the geometry of each without the head that GeoPackages give it, and its box.

    ``boxes`` is (n, 4), x_min, y_min, x_max and y_max in the site CRS; ``columns`` are the values of each
    field of the layer, n of them.
    """

    wkb: Sequence[bytes]
    boxes: np.ndarray
    columns: Sequence[Iterable[Any]]


def site_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> list[tuple[geopackage.LayerSpec, Iterator[SiteRows]]]:
    """Return the four layers of a site with the rows of each, which are read as they are asked for.

    ``cache`` gets the obstacles as they are read, for they are read once.
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
    groups = list(outline_groups(some))
    rows = np.array([first for first, _ in groups], dtype=np.intp)
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

    ``offsets``, (n + 1,), says where each begins, ``closed``, (n,), which are rings. None is without points.
    """

    def __init__(
        self, coordinates: np.ndarray, offsets: np.ndarray, closed: np.ndarray, frame: SiteFrame
    ) -> None:
        self._xy = frame.to_crs(coordinates)
        self._starts, ends = offsets[:-1], offsets[1:]
        # Rotating there and back may leave the two ends a rounding error apart.
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
        """Return the geometry of each of ``groups``, the first of its rings and that behind the last.

        A polygon, its other rings as holes; of what begins with a line that one.
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


# --- ``site.gpkg`` written by the GDAL that every QGIS has: no pyogrio, no shapely ---
# The layers and fields are those of ``robot_bridge.core.sites.geopackage``, and the stamp is the one that
# ``robot_bridge.core.sites`` looks for when it reads the file.

_KINDS = {"Unknown": "wkbUnknown", "LineString": "wkbLineString", "Polygon": "wkbPolygon"}
_GEOMETRY = "geom"
_OPTIONS = ["VERSION=1.3"]
_LAYER_OPTIONS = [f"GEOMETRY_NAME={_GEOMETRY}", "SPATIAL_INDEX=NO"]
_HEAD = np.dtype([("magic", "S2"), ("version", "u1"), ("flags", "u1"), ("srs", "<i4"), ("box", "<f8", 4)])
"""What is before a geometry in a GeoPackage; the box has both x first (OGC 12-128r18, 2.1.3)."""
_LITTLE_ENDIAN_WITH_BOX = 3


def write_site_file(
    file: Path, content: SiteContent, settings: SiteSettings, cache: CacheWriter, feedback: QgsFeedback
) -> bool:
    """Write ``content`` to the new GeoPackage ``file``; return whether it is whole, false after a cancel.

    ``cache`` gets the obstacles.

    Version 1.3 of the format, which GDAL 3.6 and older read. The tables are GDAL's; features go into them by
    SQL, since an object of GDAL for each takes longer than everything else, and so they go into the spatial
    index.

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
        return True


def stamp_in(file: Path) -> str:
    """Return which publication the GeoPackage ``file`` belongs to; nothing when it does not say."""
    with suppress(PublicationError), _named_failures(file) as gdal:
        source = _there(gdal.OpenEx(str(file), gdal.OF_VECTOR | gdal.OF_READONLY, ["GPKG"]))
        return str(_there(source.GetLayer(0)).GetMetadataItem(geopackage.STAMP_KEY) or "")
    return ""


def _make_tables(
    gdal: Any, file: Path, specs: Sequence[geopackage.LayerSpec], settings: SiteSettings
) -> None:
    """Make the GeoPackage with its layers and their spatial indexes, all empty, and close it."""
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
        _done(layer.SetMetadataItem(geopackage.STAMP_KEY, settings.stamp))
    _done(target.FlushCache())
    for spec in specs:
        target.ExecuteSQL(f"SELECT CreateSpatialIndex('{spec.name}', '{_GEOMETRY}')")
    _done(target.FlushCache())


def _insert(database: sqlite3.Connection, spec: geopackage.LayerSpec, batches: Iterator[SiteRows]) -> None:
    """Insert ``batches`` into the empty table of ``spec`` and its index, and note there what it holds."""
    find = "SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = ?"
    (srs,) = database.execute(find, [spec.name]).fetchone()
    columns = ", ".join(f'"{name}"' for name in (_GEOMETRY, *spec.fields))
    places = ", ".join("?" * (len(spec.fields) + 1))
    insert = f'INSERT INTO "{spec.name}" ({columns}) VALUES ({places})'  # nosec B608 # names
    database.execute("BEGIN")
    with _without_triggers(database, spec.name):
        index = BoxTree(database, f"rtree_{spec.name}_{_GEOMETRY}")
        for rows in batches:
            database.executemany(insert, zip(_blobs(rows, srs), *rows.columns, strict=True))
            index.add(rows.boxes)
        index.end()
    if index.extent is not None:
        note = "UPDATE gpkg_contents SET min_x = ?, min_y = ?, max_x = ?, max_y = ? WHERE table_name = ?"
        database.execute(note, [*index.extent, spec.name])
    else:
        kind = spec.declared_geometry(empty=True).upper()
        note = "UPDATE gpkg_geometry_columns SET geometry_type_name = ? WHERE table_name = ?"
        database.execute(note, [kind, spec.name])
    database.execute("COMMIT")


@contextmanager
def _without_triggers(database: sqlite3.Connection, table: str) -> Iterator[None]:
    """Have ``table`` without its triggers until the block ends.

    For each row they would write into its index, by functions that only GDAL knows, and count it.
    """
    find = "SELECT name, sql FROM sqlite_master WHERE type = 'trigger' AND tbl_name = ? ORDER BY rowid"
    triggers = database.execute(find, [table]).fetchall()
    for name, _ in triggers:
        database.execute(f'DROP TRIGGER "{name}"')
    yield
    for _, made in triggers:
        database.execute(made)


def _blobs(rows: SiteRows, srs: int) -> Iterator[bytes]:
    """Yield the geometries of ``rows`` as GeoPackages keep them."""
    heads = np.empty(len(rows.wkb), _HEAD)
    heads["magic"], heads["version"], heads["flags"] = b"GP", 0, _LITTLE_ENDIAN_WITH_BOX
    heads["srs"], heads["box"] = srs, rows.boxes[:, [0, 2, 1, 3]]
    data, size = heads.tobytes(), _HEAD.itemsize
    return (data[k * size : (k + 1) * size] + wkb for k, wkb in enumerate(rows.wkb))


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
