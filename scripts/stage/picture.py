"""Makes a picture small enough for a repository."""

from __future__ import annotations

from pathlib import Path

COLOURS = 256


def reduce_colours(path: Path) -> None:
    """Replace the PNG at ``path`` by one of 256 colours, dithered: less than half the bytes."""
    from osgeo import gdal

    gdal.UseExceptions()
    image = gdal.Open(str(path))
    bands = [image.GetRasterBand(number) for number in (1, 2, 3)]
    table = gdal.ColorTable()
    gdal.ComputeMedianCutPCT(*bands, COLOURS, table)
    few = gdal.GetDriverByName("MEM").Create("", image.RasterXSize, image.RasterYSize, 1)
    few.GetRasterBand(1).SetColorTable(table)
    gdal.DitherRGB2PCT(*bands, few.GetRasterBand(1), table)
    reduced = path.with_suffix(".reduced.png")
    gdal.GetDriverByName("PNG").CreateCopy(str(reduced), few, options=["ZLEVEL=9"])
    reduced.replace(path)
    Path(f"{reduced}.aux.xml").unlink(missing_ok=True)
