"""A robot map as a GeoPackage, written by QGIS itself: nothing has to be installed beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from qgis.core import (
    QgsFeature,
    QgsFields,
    QgsGeometry,
    QgsVectorFileWriter,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ...robot_bridge.robotmap.exporters.geopackage import column_value, geopackage_layers, wkb_of
from ...robot_bridge.robotmap.exporters.shapes import Shape
from ...robot_bridge.robotmap.model import RobotMap
from ..language import tr
from .map_place import PlacedMap
from .whole_file import OutputError

_WKB_TYPES = {
    "Polygon": QgsWkbTypes.Type.Polygon,
    "LineString": QgsWkbTypes.Type.LineString,
    "MultiLineString": QgsWkbTypes.Type.MultiLineString,
}
_FIELD_TYPES = {bool: "bool", int: "int8", float: "double"}


def write_geopackage(robot_map: RobotMap, target: Path, place: PlacedMap) -> None:
    """Write the layers of a map to the new file ``target``, in the site's CRS, or in local metres.

    :raises OutputError: naming the layer that could not be written, and why.
    """
    for name, shapes in geopackage_layers(robot_map).items():
        _write_layer(name, shapes, target, place)


def _write_layer(name: str, shapes: Sequence[Shape], target: Path, place: PlacedMap) -> None:
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.driverName, options.layerName = "GPKG", name
    # Of the format's versions the one that GDAL 3.6 and older read.
    options.datasourceOptions = ["VERSION=1.3"]
    if target.exists():
        options.actionOnExistingFile = QgsVectorFileWriter.ActionOnExistingFile.CreateOrOverwriteLayer
    fields = _fields(shapes[0])
    kind = _WKB_TYPES[shapes[0].kind]
    writer = QgsVectorFileWriter.create(
        str(target), fields, kind, place.place.crs, place.transform_context, options
    )
    for shape in shapes:
        geometry = QgsGeometry()
        geometry.fromWkb(wkb_of(shape, place.place.points))
        feature = QgsFeature(fields)
        feature.setGeometry(geometry)
        feature.setAttributes([column_value(value) for value in shape.attributes.values()])
        writer.addFeature(feature)
    writer.flushBuffer()
    if writer.hasError() != QgsVectorFileWriter.WriterError.NoError:
        raise OutputError(
            tr(
                "The layer {name} of the GeoPackage cannot be written: {error}.",
                name=name,
                error=writer.errorMessage(),
            )
        )


def _fields(shape: Shape) -> QgsFields:
    """Return fields for the attributes of a shape.

    By way of a layer in memory: the types of QgsField have other names in each Qt.
    """
    columns = "&".join(
        f"field={name}:{_FIELD_TYPES.get(type(value), 'string')}" for name, value in shape.attributes.items()
    )
    return QgsVectorLayer(f"NoGeometry?{columns}", "fields", "memory").fields()
