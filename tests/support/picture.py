"""Makes a picture small enough for a repository."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from osgeo import gdal

COLOURS = 256
COMPRESSION = "ZLEVEL=5"
"""Level 7 makes a screen 1 % smaller and takes twice as long."""


def reduce_colours(path: Path) -> None:
    """Replace the PNG at ``path`` by one of 256 colours, dithered: less than half the bytes."""
    from osgeo import gdal

    gdal.UseExceptions()
    image = gdal.Open(str(path))
    reduced = path.with_suffix(".reduced.png")
    save_few_colours(image, reduced)
    reduced.replace(path)


def save_few_colours(image: gdal.Dataset, path: Path) -> None:
    """Save ``image``, whose first bands are red, green and blue, as a PNG of 256 colours, dithered."""
    from osgeo import gdal

    bands = [image.GetRasterBand(number) for number in (1, 2, 3)]
    table = gdal.ColorTable()
    gdal.ComputeMedianCutPCT(*bands, COLOURS, table)
    few = gdal.GetDriverByName("MEM").Create("", image.RasterXSize, image.RasterYSize, 1)
    few.GetRasterBand(1).SetColorTable(table)
    gdal.DitherRGB2PCT(*bands, few.GetRasterBand(1), table)
    gdal.GetDriverByName("PNG").CreateCopy(str(path), few, options=[COMPRESSION])
    Path(f"{path}.aux.xml").unlink(missing_ok=True)
