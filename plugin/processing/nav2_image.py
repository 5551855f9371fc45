"""Images of Nav2's maps read, and rasters and polygons made of their cells, by GDAL."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import QgsGeometry, QgsRasterFileWriter

from ...robot_bridge.robotmap.nav2_map import check_size
from ..errors import FleetError
from ..language import tr

DRIVERS = ["PNM", "PNG", "BMP", "JPEG"]
"""What map servers load, and nothing that could lead anywhere else."""
GeoTransform = tuple[float, float, float, float, float, float]
"""x and y of the upper left corner, each with its steps for a column and a row, as GDAL orders them."""


class MapImageError(FleetError):
    """An image that cannot be read, or a raster that cannot be written; names the file."""


def read_image(file: Path) -> tuple[np.ndarray, bool]:
    """Return the bands, (bands, rows, columns) uint8, and whether the last is opacity.

    :raises MapImageError: :raises NavigationMapError: for what cannot be read, or is too large to be.
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
        check_size(image.RasterXSize, image.RasterYSize)
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
    """Write ``cells``, (rows, columns) int16, as a raster in the CRS given as WKT; raises MapImageError."""
    with _quiet() as gdal:
        driver = QgsRasterFileWriter.driverForExtension(file.suffix.lstrip(".")) or "GTiff"
        options = ["COMPRESS=DEFLATE", "TILED=YES"] if driver == "GTiff" else []
        rows, columns = cells.shape
        try:
            raster = gdal.GetDriverByName(driver).Create(str(file), columns, rows, 1, gdal.GDT_Int16, options)
            _fill(raster, cells, place, crs)
        except (AttributeError, RuntimeError):
            raise MapImageError(
                tr("The raster {file} cannot be written: {why}", file=file, why=gdal.GetLastErrorMsg())
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
        # Kept by name: a layer of a source that is gone ends the program.
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
    """Give the module ``gdal``, which keeps what it has to say for an error's text.

    Whether GDAL raises is a setting of the whole program, which is left alone: failures are told either way.
    """
    from osgeo import gdal

    gdal.PushErrorHandler("CPLQuietErrorHandler")
    try:
        yield gdal
    finally:
        gdal.PopErrorHandler()
