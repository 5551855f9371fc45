"""The picture put together in the order in which light and paint fall, and written as a GeoTIFF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import shapely
from osgeo import gdal, osr
from plan import CRS, HEIGHT, ORIGIN, WIDTH, Plan
from scipy import ndimage

from .asphalt import draw_roads
from .canvas import METRES_PER_PIXEL, Canvas
from .ground import draw_ground
from .light import shadow
from .markings import draw_markings
from .noise import clouds
from .objects import bodies, draw_low_things, draw_things
from .roofs import draw_buildings
from .trees import dim_by, draw_trees, hedges, plant_trees, shade_trees

JPEG_QUALITY = 87


def write_orthophoto(file: Path, plan: Plan) -> None:
    """Draw ``plan`` and write it as a tiled JPEG GeoTIFF with overviews inside."""
    pixels = draw(plan)
    gdal.UseExceptions()
    memory = gdal.GetDriverByName("MEM").Create("", pixels.shape[1], pixels.shape[0], 3, gdal.GDT_Byte)
    memory.SetGeoTransform((ORIGIN[0], METRES_PER_PIXEL, 0, ORIGIN[1] + HEIGHT, 0, -METRES_PER_PIXEL))
    reference = osr.SpatialReference()
    reference.SetFromUserInput(CRS)
    memory.SetProjection(reference.ExportToWkt())
    for band in range(3):
        memory.GetRasterBand(band + 1).WriteRaster(
            0, 0, pixels.shape[1], pixels.shape[0], pixels[..., band].tobytes()
        )
    memory.BuildOverviews("AVERAGE", [2, 4, 8, 16])
    options = ["TILED=YES", "COMPRESS=JPEG", "PHOTOMETRIC=YCBCR", f"JPEG_QUALITY={JPEG_QUALITY}"]
    options += ["COPY_SRC_OVERVIEWS=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256"]
    file.unlink(missing_ok=True)
    with_overviews = gdal.GetDriverByName("GTiff").CreateCopy(str(file), memory, options=options)
    with_overviews.FlushCache()


def draw(plan: Plan) -> np.ndarray:
    """Return the photograph as (rows, columns, 3) uint8."""
    canvas = Canvas(WIDTH, HEIGHT)
    trees = plant_trees(plan)
    draw_ground(canvas, plan)
    draw_roads(canvas, plan)
    draw_markings(canvas, plan)
    draw_low_things(canvas, plan)
    shade = shade_trees(canvas, trees + hedges())
    dim_by(canvas, np.maximum(shade, _shade_of_bodies(canvas, plan)))
    draw_things(canvas, plan)
    draw_buildings(canvas, plan)
    draw_trees(canvas, hedges() + trees)
    return _develop(canvas)


def _shade_of_bodies(canvas: Canvas, plan: Plan) -> np.ndarray:
    shadows = [shadow(item.geometry, item.height) for item in plan.buildings]
    shadows += [shadow(outline, height) for outline, height in bodies(plan)]
    return canvas.mask(shapely.unary_union(shadows), blur=0.06)


def _develop(canvas: Canvas) -> np.ndarray:
    """Give the drawing what a lens and a sensor do: a little blur, uneven light, haze, grain, contrast."""
    rng = np.random.default_rng(77)
    light = 1 + 0.025 * clouds(rng, canvas.shape, 60.0, 2)
    pixels = ndimage.gaussian_filter(canvas.pixels * light[..., None], (0.55, 0.55, 0))
    pixels += rng.normal(0, 1.6, canvas.shape)[..., None]
    pixels = 255 * np.clip(pixels / 255, 0, 1) ** 0.94
    pixels = pixels * 0.97 + np.array([5, 6, 9])
    return np.clip(np.rint(pixels), 0, 255).astype(np.uint8)
