"""Files of other robots' maps: formats, masks from polygons, GeoPackage, PNG."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from qgis.core import (
    QgsExpression,
    QgsExpressionContext,
    QgsFeature,
    QgsFeedback,
    QgsFields,
    QgsGeometry,
    QgsProcessingFeatureSource,
    QgsVectorFileWriter,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QBuffer, QByteArray, QIODevice, Qt
from qgis.PyQt.QtGui import QImage
from qgis.PyQt.QtSvg import QSvgRenderer

from ....robot_bridge.core.robotmap.exporters import nav2, vector_files
from ....robot_bridge.core.robotmap.exporters.geometries import MapShape, obstacle_shapes, segment_shapes
from ....robot_bridge.core.robotmap.exporters.svg import svg_of
from ....robot_bridge.core.robotmap.model import RobotMap
from ...layers.geometry import polygons_of, shapes_of
from ...layers.layer_expressions import FeatureFilter
from ...layers.layer_source import FeatureReader
from ...layers.site_transform import LayerToSiteTransform, SiteGeoreference
from ...ui.errors import FleetError
from ...ui.glyphs import painting
from ...ui.language import tr
from .algorithm import ParameterError
from .map_files import PlacedMap
from .outputs import OutputError

# --- Polygons of a layer as the areas of a mask ---

Speed = Callable[[QgsFeature], float]


def areas_of(
    source: QgsProcessingFeatureSource,
    site: SiteGeoreference,
    counted: FeatureFilter | None,
    feedback: QgsFeedback,
    speed: Speed | None = None,
) -> tuple[list[nav2.MaskArea], list[str]]:
    """Return the areas of a layer in the site frame, and a warning for each feature that was changed.

    Only features that are ``counted`` are read. With ``speed`` an area without a speed above 0 is left out.
    Stops early when cancelled.

    :raises LayerCrsError: when the layer's coordinates have no known place on the site.
    """
    placing = site.of_layer(source.sourceName(), source.sourceCrs())
    areas: list[nav2.MaskArea] = []
    warnings = placing.doubts(source.sourceName())
    for feature, counts, geometry, notes in FeatureReader(
        source.sourceName(), source, placing, counted, feedback
    ):
        name = tr("Layer {sourcename}, feature {id}", sourcename=source.sourceName(), id=feature.id())
        if counts:
            limit = math.nan if speed is None else speed(feature)
            if speed is None or 0 < limit < math.inf:
                areas += [nav2.MaskArea(rings, name, limit) for rings in _polygons(geometry, placing, notes)]
            else:
                notes.append(tr("has no speed above 0 m/s, so it sets no limit; it is left out"))
        warnings += [f"{name}: {note}" for note in notes]
    return areas, warnings


def speed_by(text: str, source: QgsProcessingFeatureSource, context: QgsExpressionContext) -> Speed:
    """Return a function from a feature to its speed in m/s by an expression; NaN where it has none.

    :raises ParameterError: when the expression is invalid.
    """
    expression = QgsExpression(text)
    context.setFields(source.fields())
    if expression.hasParserError() or not expression.prepare(context):
        reason = expression.parserErrorString() or expression.evalErrorString()
        raise ParameterError(
            tr(
                "SPEED {text!r} is no expression ({reason}): write a field's name or a number.",
                text=text,
                reason=reason,
            )
        )

    def speed(feature: QgsFeature) -> float:
        context.setFeature(feature)
        value = expression.evaluate(context)
        try:
            return float(value)
        except (TypeError, ValueError):
            return math.nan

    return speed


def _polygons(
    geometry: QgsGeometry | None, placing: LayerToSiteTransform, notes: list[str]
) -> list[list[np.ndarray]]:
    """Return the rings of each polygon of ``geometry`` in the site frame; ``notes`` receive its faults."""
    if geometry is None:
        return []
    shapes, odd = shapes_of(geometry)
    notes += odd
    return [[placing.to_site(ring) for ring in rings] for rings in polygons_of(shapes)]


# --- An SVG as pixels, by Qt ---

_SHARPNESS = 2
"""Pixels of the picture for each of the SVG, so that it can be printed."""


class PictureError(FleetError):
    """Qt cannot draw the picture."""


def png_of(svg: bytes) -> bytes:
    """Return the PNG of ``svg``; raises PictureError when Qt does not accept it."""
    renderer = QSvgRenderer(QByteArray(svg))
    image = QImage(renderer.defaultSize() * _SHARPNESS, QImage.Format.Format_RGB32)
    if not renderer.isValid() or image.isNull():
        raise PictureError(
            tr("Qt cannot draw the picture of this map: choose svg and open that in a browser.")
        )
    image.fill(Qt.GlobalColor.white)
    with painting(image) as painter:
        renderer.render(painter)
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image.save(buffer, "PNG")
    return bytes(buffer.data())


# --- A robot map as a GeoPackage, written by QGIS itself: no other package is needed ---

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
    for name, shapes in vector_files.geopackage_layers(robot_map).items():
        _write_layer(name, shapes, target, place)


def _write_layer(name: str, shapes: Sequence[MapShape], target: Path, place: PlacedMap) -> None:
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.driverName, options.layerName = "GPKG", name
    # The version of the format that GDAL 3.6 and older read.
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
        geometry.fromWkb(vector_files.wkb_of(shape, place.place.points))
        feature = QgsFeature(fields)
        feature.setGeometry(geometry)
        feature.setAttributes([vector_files.column_value(value) for value in shape.attributes.values()])
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


def _fields(shape: MapShape) -> QgsFields:
    """Return fields for the attributes of a shape.

    Through a memory layer: the types of QgsField have other names in each Qt.
    """
    columns = "&".join(
        f"field={name}:{_FIELD_TYPES.get(type(value), 'string')}" for name, value in shape.attributes.items()
    )
    return QgsVectorLayer(f"NoGeometry?{columns}", "fields", "memory").fields()


# --- The files of each format that ``fleet:exportnavigationmap`` writes ---

Files = dict[str, bytes]

_KEEPOUT, _SPEED_IN_M_S = 0, 2
"""Types of Nav2's costmap filters."""


@dataclass
class NavigationExport:
    """A map, its place, and the export settings; ``warnings`` grow while files are made."""

    robot_map: RobotMap
    place: PlacedMap
    name: str
    resolution: float
    inside: nav2.Inside
    drives_over: float
    keepouts: list[nav2.MaskArea] = field(default_factory=list)
    speed_areas: list[nav2.MaskArea] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def files(self, format: str) -> Files:
        """Return names and contents of the files of a format; the first is the one to open.

        :raises FleetError: :raises RobotMapError: when the format cannot hold this map.
        """
        return FORMAT_WRITERS[format](self)

    @property
    def grid(self) -> nav2.RasterGrid:
        """The grid of the masks, which is that of the occupancy grid."""
        return nav2.RasterGrid.covering(self.robot_map.border, self.resolution)


def _occupancy(export: NavigationExport) -> Files:
    made = nav2.occupancy_of(
        export.robot_map, export.resolution, inside=export.inside, drives_over=export.drives_over
    )
    export.warnings += made.warnings
    return nav2.trinary_files(export.name, made.grid, made.cells, export.robot_map.meta)


def _keepout(export: NavigationExport) -> Files:
    name = f"{export.name}_keepout"
    cells = nav2.keepout_mask(export.grid, export.keepouts)
    files = nav2.trinary_files(name, export.grid, cells, export.robot_map.meta)
    return {**files, f"{name}_filter.yaml": nav2.filter_parameters(_KEEPOUT, "keepout")}


def _speed(export: NavigationExport) -> Files:
    name = f"{export.name}_speed"
    mask = nav2.speed_mask(export.grid, export.speed_areas)
    files = nav2.scale_files(name, mask.grid, mask.cells, export.robot_map.meta)
    return {**files, f"{name}_filter.yaml": nav2.filter_parameters(_SPEED_IN_M_S, "speed", mask.multiplier)}


def _geojson(export: NavigationExport) -> Files:
    robot_map, to_lonlat = export.robot_map, export.place.to_lonlat
    return {
        f"{export.name}_{kind}.geojson": vector_files.geojson_of(shapes, to_lonlat, robot_map.meta)
        for kind, shapes in (
            ("obstacles", obstacle_shapes(robot_map)),
            ("segments", segment_shapes(robot_map)),
        )
    }


def _geopackage(export: NavigationExport) -> Files:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{export.name}.gpkg"
        write_geopackage(export.robot_map, file, export.place)
        return {file.name: file.read_bytes()}


def _svg(export: NavigationExport) -> Files:
    return {f"{export.name}.svg": svg_of(export.robot_map)}


def _png(export: NavigationExport) -> Files:
    return {f"{export.name}.png": png_of(svg_of(export.robot_map))}


FORMAT_WRITERS: dict[str, Callable[[NavigationExport], Files]] = {
    "occupancy": _occupancy,
    "keepout": _keepout,
    "speed": _speed,
    "geojson": _geojson,
    "geopackage": _geopackage,
    "svg": _svg,
    "png": _png,
}
