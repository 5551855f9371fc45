"""``site.gpkg`` written by the GDAL that every QGIS has: no pyogrio, no shapely.

The layers and fields are those of ``robot_bridge.sites.layers``, and the stamp is the one that
``robot_bridge.sites`` looks for when it reads the file.
"""

from __future__ import annotations

import math
import sqlite3
import struct
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any

from qgis.core import QgsFeedback

from ...robot_bridge.sites.geopackage import STAMP_KEY
from ...robot_bridge.sites.layers import LayerSpec
from ...robot_bridge.sites.mapped.writing import CacheWriter
from ...robot_bridge.sites.settings import SiteSettings
from ..language import tr
from .errors import PublicationError
from .site_content import SiteContent
from .site_rows import SiteRow, site_rows

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
        f'INSERT INTO "{spec.name}" ({columns}) VALUES ({places})',
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
