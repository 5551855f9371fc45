"""A picture in metres: geometries in the site frame painted, smooth at the edges, onto an array of pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from PIL import Image, ImageDraw
from scipy import ndimage

METRES_PER_PIXEL = 0.08


@dataclass(frozen=True)
class Patch:
    """A part of the canvas: its rows and columns, and how much of each pixel is covered, 0 to 1."""

    rows: slice
    columns: slice
    cover: np.ndarray


class Canvas:
    """RGB pixels, (rows, columns, 3) float32 of 0 to 255; row 0 is the north edge."""

    def __init__(self, width: float, height: float) -> None:
        self.height = height
        self.shape = (round(height / METRES_PER_PIXEL), round(width / METRES_PER_PIXEL))
        self.pixels = np.zeros((*self.shape, 3), dtype=np.float32)

    def patch(self, geometry: shapely.Geometry, blur: float = 0.0) -> Patch:
        """Return the part of the canvas that ``geometry`` covers; ``blur`` is a Gaussian sigma in metres."""
        x0, y0, x1, y1 = geometry.bounds
        margin = 3 * blur + 0.2
        left, right = self._range((x0 - margin, x1 + margin), self.shape[1])
        top, bottom = self._range((self.height - y1 - margin, self.height - y0 + margin), self.shape[0])
        if right <= left or bottom <= top:
            return Patch(slice(0, 0), slice(0, 0), np.zeros((0, 0), dtype=np.float32))
        cover = self._raster(geometry, left, top, right - left, bottom - top)
        if blur > 0:
            cover = ndimage.gaussian_filter(cover, blur / METRES_PER_PIXEL)
        return Patch(slice(top, bottom), slice(left, right), cover)

    def mask(self, geometry: shapely.Geometry, blur: float = 0.0) -> np.ndarray:
        """Return the cover of the whole canvas, (rows, columns) float32."""
        whole = np.zeros(self.shape, dtype=np.float32)
        patch = self.patch(geometry, blur)
        whole[patch.rows, patch.columns] = patch.cover
        return whole

    def paint(
        self, geometry: shapely.Geometry, colour: tuple | np.ndarray, opacity: float = 1.0, blur: float = 0.0
    ) -> None:
        """Lay ``colour``, one RGB or an array of the canvas's shape, over ``geometry``."""
        self.lay(self.patch(geometry, blur), colour, opacity)

    def lay(self, patch: Patch, colour: tuple | np.ndarray, opacity: float = 1.0) -> None:
        """Lay ``colour`` over ``patch`` as :meth:`paint` does."""
        colour = np.asarray(colour, dtype=np.float32)
        if colour.ndim == 3:
            colour = colour[patch.rows, patch.columns]
        below = self.pixels[patch.rows, patch.columns]
        below += (colour - below) * (patch.cover * opacity)[..., None]

    def dim(self, patch: Patch, factor: tuple[float, float, float], strength: float = 1.0) -> None:
        """Multiply the covered pixels by ``factor``."""
        loss = (1 - np.asarray(factor, dtype=np.float32)) * strength
        self.pixels[patch.rows, patch.columns] *= 1 - patch.cover[..., None] * loss

    def to_pixels(self, xy: np.ndarray) -> np.ndarray:
        """Return (n, 2) site metres as (n, 2) column and row."""
        xy = np.asarray(xy, dtype=float)
        return np.column_stack([xy[:, 0], self.height - xy[:, 1]]) / METRES_PER_PIXEL

    def _range(self, metres: tuple[float, float], limit: int) -> tuple[int, int]:
        low, high = np.array(metres) / METRES_PER_PIXEL
        return max(0, int(np.floor(low))), min(limit, int(np.ceil(high)))

    def _raster(self, geometry: shapely.Geometry, left: int, top: int, columns: int, rows: int) -> np.ndarray:
        fine = 4 if rows * columns < 600_000 else 2
        image = Image.new("L", (columns * fine, rows * fine), 0)
        draw = ImageDraw.Draw(image)
        for polygon in shapely.get_parts(geometry):
            if polygon.geom_type != "Polygon" or polygon.is_empty:
                continue
            for ring, value in [(polygon.exterior, 255), *((hole, 0) for hole in polygon.interiors)]:
                pixels = (self.to_pixels(np.array(ring.coords)[:, :2]) - (left, top)) * fine
                draw.polygon([tuple(point) for point in pixels], fill=value)
        array = np.asarray(image, dtype=np.float32).reshape(rows, fine, columns, fine)
        return array.mean(axis=(1, 3)) / 255


def stroke(points: np.ndarray, width: float, cap: str = "flat") -> shapely.Geometry:
    """Return a line as the area that a stroke of ``width`` metres covers."""
    return shapely.LineString(points).buffer(width / 2, cap_style=cap, quad_segs=6)
