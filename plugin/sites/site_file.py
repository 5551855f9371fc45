"""``site.gpkg`` written by the GDAL that every QGIS has: no pyogrio, no shapely.

The layers and fields are those of ``robot_bridge.sites.layers``, and the stamp is the one that
``robot_bridge.sites`` looks for when it reads the file.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import chain
from pathlib import Path
from typing import Any

from qgis.core import QgsFeedback

from ...robot_bridge.sites.geopackage import STAMP_KEY
from ...robot_bridge.sites.layers import LayerSpec
from ...robot_bridge.sites.settings import SiteSettings
from ..language import tr
from .errors import PublicationError
from .site_content import SiteContent
from .site_rows import SiteRow, site_rows

_GEOMETRIES = {"Unknown": "wkbUnknown", "LineString": "wkbLineString", "Polygon": "wkbPolygon"}
_EVERY = 1000
"""After how many features a cancel is looked for."""


def write_site_file(file: Path, content: SiteContent, settings: SiteSettings, feedback: QgsFeedback) -> bool:
    """Write ``content`` to the new GeoPackage ``file``; return whether it is whole, false after a cancel.

    Version 1.3 of the format, which GDAL 3.6 and older read.

    :raises PublicationError: when the file cannot be written.
    """
    with _named_failures(file) as gdal:
        _, _, osr = _bindings()
        crs = osr.SpatialReference()
        _done(crs.SetFromUserInput(settings.crs))
        crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        options = ["VERSION=1.3"]
        target = _there(gdal.GetDriverByName("GPKG").Create(str(file), 0, 0, 0, gdal.GDT_Unknown, options))
        for spec, rows in site_rows(content, settings.frame):
            if not _write_layer(target, spec, rows, crs, settings.stamp, feedback):
                return False
        _done(target.FlushCache())
        return True


def stamp_in(file: Path) -> str:
    """Return which publication the GeoPackage ``file`` belongs to; nothing when it does not say."""
    with suppress(PublicationError), _named_failures(file) as gdal:
        source = _there(gdal.OpenEx(str(file), gdal.OF_VECTOR | gdal.OF_READONLY, ["GPKG"]))
        return str(_there(source.GetLayer(0)).GetMetadataItem(STAMP_KEY) or "")
    return ""


def _write_layer(
    target: Any, spec: LayerSpec, rows: Iterator[SiteRow], crs: Any, stamp: str, feedback: QgsFeedback
) -> bool:
    _, ogr, _ = _bindings()
    first = next(rows, None)
    declared = _GEOMETRIES[spec.declared_geometry(first is None)]
    layer = _there(target.CreateLayer(spec.name, crs, getattr(ogr, declared)))
    for name, kind in spec.fields.items():
        _done(layer.CreateField(_field(name, kind)))
    # On the layer, not the file: GDAL would put that into an .aux.xml file beside the site on every reading.
    _done(layer.SetMetadataItem(STAMP_KEY, stamp))
    _done(target.StartTransaction())
    for number, row in enumerate(chain([] if first is None else [first], rows)):
        if number % _EVERY == 0 and feedback.isCanceled():
            target.RollbackTransaction()
            return False
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometryDirectly(_there(ogr.CreateGeometryFromWkb(row.wkb)))
        for name, kind in spec.fields.items():
            feature.SetField(name, int(row.values[name]) if kind is bool else row.values[name])
        _done(layer.CreateFeature(feature))
    _done(target.CommitTransaction())
    return True


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
    except RuntimeError as error:
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
