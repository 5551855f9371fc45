"""Site file: writing of ``site.gpkg``, with the spatial indexes of its layers."""

from __future__ import annotations

import math
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import QgsFeedback

from ....robot_bridge.core.sites import geopackage
from ....robot_bridge.core.sites.settings import SiteSettings
from ....robot_bridge.core.sites.site_cache import CacheWriter
from ...ui.errors import PublicationError
from ...ui.language import tr
from .site_content import SiteContent, SiteRows, site_rows

# --- ``site.gpkg`` written by the GDAL that every QGIS has: no pyogrio, no shapely ---
# The layers and fields are those of ``robot_bridge.core.sites.geopackage``, and the stamp is the one that
# ``robot_bridge.core.sites`` checks when it reads the file.

_KINDS = {"Unknown": "wkbUnknown", "LineString": "wkbLineString", "Polygon": "wkbPolygon"}
_GEOMETRY = "geom"
_OPTIONS = ["VERSION=1.3"]
_LAYER_OPTIONS = [f"GEOMETRY_NAME={_GEOMETRY}", "SPATIAL_INDEX=NO"]
_HEAD = np.dtype([("magic", "S2"), ("version", "u1"), ("flags", "u1"), ("srs", "<i4"), ("box", "<f8", 4)])
"""The header of a geometry in a GeoPackage; the box has both x first (OGC 12-128r18, 2.1.3)."""
_LITTLE_ENDIAN_WITH_BOX = 3


def write_site_file(
    file: Path, content: SiteContent, settings: SiteSettings, cache: CacheWriter, feedback: QgsFeedback
) -> bool:
    """Write ``content`` to the new GeoPackage ``file``; return whether it is complete, false if cancelled.

    ``cache`` receives the obstacles.

    Version 1.3 of the format, which GDAL 3.6 and older read. The tables are GDAL's; features are inserted by
    SQL, since an object of GDAL for each takes longer than everything else, and so are the entries of the
    spatial index.

    :raises PublicationError: when the file cannot be written.
    """
    with _named_failures(file) as gdal:
        layers = site_rows(content, settings.frame, cache, feedback)
        _make_tables(gdal, file, [spec for spec, _ in layers], settings)
        with closing(sqlite3.connect(file, isolation_level=None)) as database:
            # The file left by a crash is discarded as a whole.
            database.execute("PRAGMA journal_mode = OFF")
            database.execute("PRAGMA synchronous = OFF")
            for spec, rows in layers:
                _insert(database, spec, rows)
                if feedback.isCanceled() or not content.complete:
                    return False
        return True


def stamp_in(file: Path) -> str:
    """Return the stamp of the publication to which the GeoPackage ``file`` belongs; empty without one."""
    with suppress(PublicationError), _named_failures(file) as gdal:
        source = _there(gdal.OpenEx(str(file), gdal.OF_VECTOR | gdal.OF_READONLY, ["GPKG"]))
        return str(_there(source.GetLayer(0)).GetMetadataItem(geopackage.STAMP_KEY) or "")
    return ""


def _make_tables(
    gdal: Any, file: Path, specs: Sequence[geopackage.LayerSpec], settings: SiteSettings
) -> None:
    """Create the GeoPackage with its layers and their spatial indexes, all empty, and close it."""
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
    """Insert ``batches`` into the empty table of ``spec`` and its index, and record its extent and count."""
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
    """Remove the triggers of ``table`` until the block ends.

    For each row they would write to its index, by functions that only GDAL has, and count it.
    """
    find = "SELECT name, sql FROM sqlite_master WHERE type = 'trigger' AND tbl_name = ? ORDER BY rowid"
    triggers = database.execute(find, [table]).fetchall()
    for name, _ in triggers:
        database.execute(f'DROP TRIGGER "{name}"')
    yield
    for _, made in triggers:
        database.execute(made)


def _blobs(rows: SiteRows, srs: int) -> Iterator[bytes]:
    """Yield the geometries of ``rows`` in GeoPackage format."""
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
    """Yield the module ``gdal``; its failures become an error that names ``file``.

    Whether GDAL raises is a setting of the whole program, which is left alone: failures are found either way.
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


# --- The spatial index of a layer, made in one piece ---
# SQLite would insert every box separately, which takes longer than writing the features. Its tables
# hold plain numbers (https://www.sqlite.org/rtree.html, 6), and GDAL 3.8 and newer write them like this, too.

_BOXES = 100_000
"""Features whose boxes are in memory together."""
_ENTRY = np.dtype([("id", ">i8"), ("box", ">f4", 4)])
_NODE_HEAD = 4
"""Bytes of the depth, which the root has, and of the number of entries."""
_STEP = 1 / (1 << 23)
"""Relative change of a number that is rounded the other way."""


class BoxTree:
    """Fills the R-tree ``table``, which is empty, with boxes of rows 1, 2 and so on.

    With ``packed`` its nodes are written; else SQLite does it, which some builds enforce.
    """

    def __init__(self, database: sqlite3.Connection, table: str, packed: bool | None = None) -> None:
        self._database, self._table = database, table
        (root,) = database.execute(f'SELECT data FROM "{table}_node" WHERE nodeno = 1').fetchone()  # nosec B608 # names
        self._node_bytes = len(root)
        self._fits = (len(root) - _NODE_HEAD) // _ENTRY.itemsize
        self._packed = self._may_pack() if packed is None else packed
        self._waiting: list[np.ndarray] = []
        self._count = 0
        self._last_node = 1
        self._leaves: list[np.ndarray] = []
        self._low, self._high = np.full(2, np.inf), np.full(2, -np.inf)

    @property
    def extent(self) -> list[float] | None:
        """x_min, y_min, x_max and y_max of all boxes, None where there are none."""
        return [*self._low.tolist(), *self._high.tolist()] if self._count else None

    def add(self, boxes: np.ndarray) -> None:
        """Add the boxes of the next rows: (n, 4), x_min, y_min, x_max and y_max; raises sqlite3.Error."""
        self._low = np.minimum(self._low, boxes[:, :2].min(axis=0))
        self._high = np.maximum(self._high, boxes[:, 2:].max(axis=0))
        self._waiting.append(boxes)
        self._count += len(boxes)
        if sum(map(len, self._waiting)) >= _BOXES:
            self._add_waiting()

    def end(self) -> None:
        """Write the remaining boxes; raises sqlite3.Error."""
        if not self._packed:
            self._add_waiting()
            return
        depth, kind, nodes = 0, "rowid", self._entries() if self._count <= self._fits else None
        if nodes is None:
            self._add_waiting()
            depth, kind, nodes = 1, "parent", np.concatenate(self._leaves)
        while len(nodes) > self._fits:
            depth, nodes = depth + 1, self._nodes_of(nodes, kind)
        self._write(1, nodes, np.array([len(nodes)]), depth)
        self._insert(kind, nodes["id"], np.full(len(nodes), 1))

    def _may_pack(self) -> bool:
        try:
            self._database.execute(f'UPDATE "{self._table}_node" SET data = data WHERE nodeno = 0')  # nosec B608 # names
        except sqlite3.DatabaseError:
            return False
        return True

    def _add_waiting(self) -> None:
        entries = self._entries()
        if not len(entries):
            return
        if self._packed:
            self._leaves.append(self._nodes_of(entries, "rowid"))
        else:
            rows = zip(entries["id"].tolist(), *entries["box"].T.tolist(), strict=True)
            self._database.executemany(f'INSERT INTO "{self._table}" VALUES (?, ?, ?, ?, ?)', rows)  # nosec B608 # names

    def _entries(self) -> np.ndarray:
        """Return the waiting boxes with their rows, and forget them."""
        boxes = np.concatenate([np.empty((0, 4)), *self._waiting])
        self._waiting = []
        entries = np.empty(len(boxes), _ENTRY)
        entries["id"] = np.arange(self._count - len(boxes), self._count) + 1
        entries["box"] = _outwards(boxes)
        return entries

    def _nodes_of(self, entries: np.ndarray, kind: str) -> np.ndarray:
        """Write ``entries`` into nodes, neighbours together, and return those as entries of the parent nodes.

        The node of each is recorded in the table of ``kind``. All nodes are about equally full.
        """
        entries = entries[_neighbours(entries["box"], self._fits)]
        count = math.ceil(len(entries) / self._fits)
        edges = np.arange(count + 1) * len(entries) // count
        numbers = self._last_node + 1 + np.arange(count)
        self._last_node += count
        self._write(int(numbers[0]), entries, np.diff(edges), 0)
        self._insert(kind, entries["id"], np.repeat(numbers, np.diff(edges)))
        made = np.empty(count, _ENTRY)
        made["id"] = numbers
        for side, joined in enumerate((np.minimum, np.maximum, np.minimum, np.maximum)):
            made["box"][:, side] = joined.reduceat(entries["box"][:, side].astype(np.float32), edges[:-1])
        return made

    def _write(self, first: int, entries: np.ndarray, counts: np.ndarray, depth: int) -> None:
        """Write ``entries`` into nodes from ``first`` on, ``counts``, (n,), entries in each."""
        heads = np.column_stack([np.full(len(counts), depth), counts]).astype(">u2").tobytes()
        data, width = np.ascontiguousarray(entries, _ENTRY).tobytes(), _ENTRY.itemsize
        edges = np.concatenate([[0], np.cumsum(counts)]).tolist()
        nodes = (
            (
                first + k,
                (heads[k * _NODE_HEAD : (k + 1) * _NODE_HEAD] + data[low * width : high * width]).ljust(
                    self._node_bytes, b"\0"
                ),
            )
            for k, (low, high) in enumerate(pairwise(edges))
        )
        self._database.executemany(f'INSERT OR REPLACE INTO "{self._table}_node" VALUES (?, ?)', nodes)  # nosec B608 # names

    def _insert(self, kind: str, ids: np.ndarray, nodes: np.ndarray) -> None:
        order = np.argsort(ids)
        rows = zip(ids[order].tolist(), nodes[order].tolist(), strict=True)
        self._database.executemany(f'INSERT INTO "{self._table}_{kind}" VALUES (?, ?)', rows)  # nosec B608 # names


def _outwards(boxes: np.ndarray) -> np.ndarray:
    """Return x_min, x_max, y_min and y_max as float32, (n, 4), rounded as SQLite does: no box is smaller."""
    rounded = np.empty((len(boxes), 4), np.float32)
    for side, (column, away) in enumerate(((0, -1), (2, 1), (1, -1), (3, 1))):
        exact = boxes[:, column]
        near = exact.astype(np.float32)
        further = (exact * (1 + away * np.sign(exact) * _STEP)).astype(np.float32)
        rounded[:, side] = np.where(away * (near - exact) < 0, further, near)
    return rounded


def _neighbours(boxes: np.ndarray, fits: int) -> np.ndarray:
    """Return an order in which each ``fits`` of ``boxes``, from :func:`_outwards`, are close together.

    Sort-tile-recursive: strips by x, which are cut by y (Leutenegger and others, ICDE 1997).
    """
    x, y = (boxes[:, side].astype(np.float64) + boxes[:, side + 1] for side in (0, 2))
    strips = math.ceil(math.sqrt(math.ceil(len(boxes) / fits)))
    order = np.argsort(x, kind="stable")
    strip = np.arange(len(boxes)) // (fits * math.ceil(len(boxes) / fits / strips))
    return order[np.lexsort((y[order], strip))]
