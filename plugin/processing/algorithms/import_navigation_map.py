"""``fleet:importnavigationmap``: a map of Nav2 in, a raster and polygons of occupied cells out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsGeometry,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterRasterDestination,
    QgsRasterFileWriter,
    QgsWkbTypes,
)

from ....robot_bridge.core.errors import NavigationMapError
from ....robot_bridge.core.robotmap import nav2_reader
from ...ui.errors import FleetError
from ...ui.language import tr, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, fields_of, shown_by_processing
from ..common.map_files import MapPlace, map_parameters, map_place
from ..common.outputs import WholeFolder, fill_sink

# --- Images of Nav2's maps read, and their cells converted to rasters and polygons, by GDAL ---

DRIVERS = ["PNM", "PNG", "BMP", "JPEG"]
"""The formats that map servers load, and none that could refer to other files."""
GeoTransform = tuple[float, float, float, float, float, float]
"""x and y of the upper left corner, each with its steps per column and row, in GDAL's order."""


class MapImageError(FleetError):
    """An image that cannot be read, or a raster that cannot be written; names the file."""


def read_image(file: Path) -> tuple[np.ndarray, bool]:
    """Return the bands, (bands, rows, columns) uint8, and whether the last is opacity.

    :raises MapImageError: :raises NavigationMapError: when it cannot be read, or is too large.
    """
    with _quiet() as gdal:
        if not file.is_file():
            raise MapImageError(
                tr(
                    "There is no image {file}, which the map names: put it there, or correct the YAML.",
                    file=file,
                )
            )
        image = _opened(gdal, file)
        nav2_reader.check_size(image.RasterXSize, image.RasterYSize)
        bands = [image.GetRasterBand(number + 1) for number in range(image.RasterCount)]
        colours = [band.GetColorInterpretation() for band in bands]
        depth_fits = all(band.DataType == gdal.GDT_Byte for band in bands) and len(bands) <= 4
        if not depth_fits or gdal.GCI_PaletteIndex in colours:
            raise MapImageError(
                tr("The image {file} has no bands of 8 bits: save it as grey, without a palette.", file=file)
            )
        try:
            values = image.ReadAsArray()
        except RuntimeError:
            values = None
        if values is None:
            raise MapImageError(_unreadable(gdal, file))
        alpha = colours[-1] == gdal.GCI_AlphaBand
    return values.reshape(len(bands), *values.shape[-2:]), alpha


def write_raster(file: Path, cells: np.ndarray, place: GeoTransform, crs: str) -> None:
    """Write ``cells``, (rows, columns) int16, as a raster in the CRS given as WKT.

    :raises MapImageError: naming the file, when it cannot be written.
    """
    with _quiet() as gdal:
        driver = QgsRasterFileWriter.driverForExtension(file.suffix.lstrip(".")) or "GTiff"
        options = ["COMPRESS=DEFLATE", "TILED=YES"] if driver == "GTiff" else []
        rows, columns = cells.shape
        known = gdal.GetDriverByName(driver)
        if known is None or known.GetMetadataItem(gdal.DCAP_CREATE) is None:
            raise MapImageError(
                tr(
                    "The raster {file} cannot be written: QGIS reads rasters of this kind, and writes none. "
                    "Give it a name that ends in .tif.",
                    file=file.name,
                )
            )
        try:
            raster = known.Create(str(file), columns, rows, 1, gdal.GDT_Int16, options)
            _fill(raster, cells, place, crs)
        except (AttributeError, RuntimeError):
            raise MapImageError(
                tr("The raster {file} cannot be written: {why}", file=file.name, why=gdal.GetLastErrorMsg())
            ) from None


def outlines_of(
    chosen: np.ndarray, place: GeoTransform, cancelled: Callable[[], bool]
) -> Iterator[tuple[QgsGeometry, int]]:
    """Yield the polygon of each patch of ``chosen``, (rows, columns) bool, and its cells."""
    from osgeo import ogr

    with _quiet() as gdal:
        rows, columns = chosen.shape
        raster = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Byte)
        _fill(raster, chosen.astype(np.uint8), place, "")
        band = raster.GetRasterBand(1)
        # Held in a variable: a layer of a freed source crashes the program.
        source = ogr.GetDriverByName("Memory").CreateDataSource("outlines")
        layer = source.CreateLayer("outlines", None, ogr.wkbPolygon)
        try:
            gdal.Polygonize(band, band, layer, -1, [], callback=lambda *_: 0 if cancelled() else 1)
        except RuntimeError:
            if not cancelled():
                raise
    side = abs(place[1] * place[5] - place[2] * place[4])
    for feature in layer:
        geometry = QgsGeometry()
        geometry.fromWkb(bytes(feature.GetGeometryRef().ExportToWkb()))
        yield geometry, round(geometry.area() / side)


def _fill(raster: Any, values: np.ndarray, place: GeoTransform, crs: str) -> None:
    raster.SetGeoTransform(place)
    if crs:
        raster.SetProjection(crs)
    raster.GetRasterBand(1).WriteArray(values)
    raster.FlushCache()


def _opened(gdal: Any, file: Path) -> Any:
    try:
        image = gdal.OpenEx(str(file), gdal.OF_RASTER, allowed_drivers=DRIVERS)
    except RuntimeError:
        image = None
    if image is None:
        raise MapImageError(_unreadable(gdal, file))
    return image


def _unreadable(gdal: Any, file: Path) -> str:
    return tr(
        "The image {file} cannot be read as PGM, PNG, BMP or JPEG: {why}",
        file=file,
        why=gdal.GetLastErrorMsg(),
    )


@contextmanager
def _quiet() -> Iterator[Any]:
    """Yield the module ``gdal``, whose messages are kept for an error's text.

    Whether GDAL raises is a setting of the whole program, which is left alone: failures are found either way.
    """
    from osgeo import gdal

    gdal.PushErrorHandler("CPLQuietErrorHandler")
    try:
        yield gdal
    finally:
        gdal.PopErrorHandler()


# --- ``fleet:importnavigationmap``: a map of Nav2 in, a raster and polygons of occupied cells out ---

MAP, OCCUPIED_FROM, RASTER, OBSTACLES = "MAP", "OCCUPIED_FROM", "RASTER", "OBSTACLES"
NUMBERS = {
    "OCCUPIED_COUNT": tr("Occupied cells"),
    "UNKNOWN_COUNT": tr("Unknown cells"),
    "OBSTACLE_COUNT": tr("Obstacles"),
}
_COLUMNS = {"number": "integer", "cells": "integer", "area_m2": "double", "map": "string"}


class ImportNavigationMap(FleetAlgorithm):
    """Reads the YAML and the image of a Nav2 map into layers."""

    NAME = "importnavigationmap"
    TITLE = tr("Import navigation map")
    SUMMARY = tr("Reads a Nav2 occupancy grid or mask as raster, and polygons of what is occupied.")
    ICON = "import_navigation_map.svg"
    TAGS = ("nav2", "ros", "occupancy grid", "pgm", "slam", "costmap", "keepout", "mask", "import")
    HELP = tr_page("""
    <p>Reads a map of Nav2: the <b>YAML</b> and the image that it names (PGM, PNG, BMP or JPEG), in the modes
    <i>trinary</i>, <i>scale</i> and <i>raw</i>, with its thresholds, <i>negate</i>, and origin with yaw.</p>
    <p><b>Raster</b>: a value for each cell, 0 free to 100 occupied, -1 unknown. <b>Obstacles</b>: a polygon
    for each patch of cells of at least <i>OCCUPIED_FROM</i>, along the edges of the cells.</p>
    <p><b>Place</b>: the map's metres are those of the site frame. <i>SITE_CRS</i>, <i>ORIGIN</i> and
    <i>ROTATION</i> say where that is; files of <i>Export navigation map</i> say it themselves. Where neither
    does, the layers are in local metres, said in a warning.</p>
    <pre>qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633
    ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        filters = tr("Nav2 maps (*.yaml *.yml);;All files (*)")
        whole = QgsProcessingParameterNumber.Type.Integer
        for parameter in (
            QgsProcessingParameterFile(MAP, tr("Nav2 map (YAML)"), fileFilter=filters),
            QgsProcessingParameterNumber(
                OCCUPIED_FROM, tr("Occupied from [of 100]"), whole, 65, False, 1, nav2_reader.OCCUPIED
            ),
            *map_parameters()[1:],
            QgsProcessingParameterRasterDestination(RASTER, tr("Raster"), optional=True),
            QgsProcessingParameterFeatureSink(
                OBSTACLES, tr("Obstacles"), QgsProcessing.SourceType.TypeVectorPolygon, optional=True
            ),
        ):
            self.addParameter(parameter)
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        file = parameters.get(MAP)
        if isinstance(file, (str, Path)) and str(file) and not Path(file).is_file():
            return False, tr("There is no file {file}: choose the YAML of a Nav2 map (MAP).", file=file)
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_COLUMNS)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        file = Path(self.parameterAsFile(parameters, MAP, context))
        with shown_by_processing(feedback):
            described, cells = _read(file)
            feedback.setProgress(30)
            place = map_place(self, parameters, context, described.meta, feedback)
            transform = _transform(described, cells, place)
            made: dict[str, Any] = {}
            raster = self.parameterAsOutputLayer(parameters, RASTER, context)
            # Beside its place until all is done: an older one stays after an error or a cancel.
            whole = WholeFolder(Path(raster).parent, tr("The raster")) if raster else None
            with whole or nullcontext():
                if whole is not None:
                    write_raster(whole.folder / Path(raster).name, cells, transform, _wkt(place))
                    made[RASTER] = raster
                feedback.setProgress(50)
                level = self.parameterAsInt(parameters, OCCUPIED_FROM, context)
                count = self._write_obstacles(
                    cells >= level, (file, described), transform, place, parameters, context, feedback, made
                )
                if feedback.isCanceled():
                    return {}
                if whole is not None:
                    whole.publish()
        figures = int((cells >= level).sum()), int((cells == nav2_reader.UNKNOWN).sum()), count
        return {**made, **dict(zip(NUMBERS, figures, strict=True))}

    def _write_obstacles(
        self,
        occupied: np.ndarray,
        read: tuple[Path, nav2_reader.Nav2Map],
        transform: GeoTransform,
        place: MapPlace,
        parameters: Parameters,
        context: QgsProcessingContext,
        feedback: QgsProcessingFeedback,
        made: dict[str, Any],
    ) -> int:
        """Write the polygons if requested, and return their number."""
        kind = QgsWkbTypes.Type.Polygon
        sink, layer = self.parameterAsSink(parameters, OBSTACLES, context, self._fields, kind, place.crs)
        if sink is None:
            return 0
        file, described = read
        cell = described.resolution**2
        rows = [
            (outline, [number, cells, round(cells * cell, 6), file.stem])
            for number, (outline, cells) in enumerate(
                outlines_of(occupied, transform, feedback.isCanceled), 1
            )
        ]
        fill_sink(sink, self._fields, rows, feedback)
        made[OBSTACLES] = layer
        return len(rows)


def _read(file: Path) -> tuple[nav2_reader.Nav2Map, np.ndarray]:
    """Return the content of the YAML, and the cells; raises ParameterError, naming the file and the key."""
    try:
        with file.open(encoding="utf-8-sig") as text:
            described = nav2_reader.read_yaml(text.read(nav2_reader.LARGEST_YAML + 1))
        bands, alpha = read_image(file.parent / described.image)
        return described, nav2_reader.cells_of(bands, described, alpha=alpha)
    except (OSError, UnicodeDecodeError, NavigationMapError) as error:
        raise ParameterError(
            tr("The Nav2 map {file} cannot be read: {error}", file=file, error=error)
        ) from error


def _transform(described: nav2_reader.Nav2Map, cells: np.ndarray, place: MapPlace) -> GeoTransform:
    """Return the position of the cells in the CRS of the layers."""
    rows, columns = cells.shape
    first, right, below = place.points(described.corners(columns, rows))
    across, down = (right - first) / columns, (below - first) / rows
    return first[0], across[0], down[0], first[1], across[1], down[1]


def _wkt(place: MapPlace) -> str:
    return place.crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT2_2019)
