"""Grass, bare soil, paved ground and water: everything below the roads."""

from __future__ import annotations

import numpy as np
import shapely
import shapely.affinity
from plan import Plan
from scipy import ndimage

from .canvas import METRES_PER_PIXEL, Canvas, stroke
from .noise import between, blotches, clouds

PLAZA = shapely.box(147.5, 41.2, 192.5, 72.0)
TERRACE = shapely.union_all([shapely.box(152, 34, 186, 39), shapely.box(166, 39, 171.4, 41)])
FORECOURT = shapely.union_all([shapely.box(82, 110, 114, 117.2), shapely.box(179.4, 116, 188, 134.0)])
COURT = shapely.box(141, 114, 159, 125)


def draw_ground(canvas: Canvas, plan: Plan) -> None:
    """Fill the canvas with meadow, mown lawn and worn soil, then lay the paved places."""
    rng = np.random.default_rng(11)
    canvas.pixels[:] = _meadow(rng, canvas.shape)
    _mow(canvas, rng, plan)
    _wear(canvas, rng, plan)
    for place, tile in ((PLAZA, 0.9), (TERRACE, 0.6), (FORECOURT, 1.2), (COURT, 0.6)):
        canvas.paint(place.buffer(0.15), (146, 143, 136))
        canvas.paint(place, paving(rng, canvas.shape, tile, (176, 168, 154)))
    _courtyard(canvas, rng)
    _water(canvas, rng, plan.keepouts[0].geometry)
    _excavation(canvas, rng, plan.keepouts[1].geometry)


def paving(rng: np.random.Generator, shape: tuple[int, int], tile: float, colour: tuple) -> np.ndarray:
    """Return square slabs of ``tile`` metres, each a little different, with dark joints."""
    size = tile / METRES_PER_PIXEL
    rows, columns = (np.arange(n) / size for n in shape)
    tone = rng.normal(0, 0.035, (int(rows[-1]) + 1, int(columns[-1]) + 1)).astype(np.float32)
    slab = tone[rows.astype(int)][:, columns.astype(int)]
    joint = np.maximum((rows % 1 < 1 / size)[:, None], (columns % 1 < 1 / size)[None, :])
    light = 1 + slab + 0.03 * clouds(rng, shape, 6.0) + 0.02 * rng.standard_normal(shape) - 0.10 * joint
    return np.asarray(colour, np.float32) * light[..., None].astype(np.float32)


def _meadow(rng: np.random.Generator, shape: tuple[int, int]) -> np.ndarray:
    dry = 0.5 + 0.24 * clouds(rng, shape, 26.0, octaves=6, fall=0.72)
    grass = between((74, 88, 50), (138, 134, 88), dry)
    clover = np.clip(clouds(rng, shape, 5.0, octaves=4) - 0.9, 0, 1)
    grass += (between((58, 80, 44), (58, 80, 44), clover) - grass) * (0.5 * clover)[..., None]
    tufts = 1 + 0.07 * blotches(rng, shape, 0.7) + 0.06 * blotches(rng, shape, 0.25)
    return grass * tufts[..., None]


def _mow(canvas: Canvas, rng: np.random.Generator, plan: Plan) -> None:
    """Mow along the roads and between the buildings, in lanes that a mower leaves."""
    built = shapely.unary_union([*plan.surfaces.values(), *(item.geometry for item in plan.buildings)])
    lawns = [
        (built.buffer(6.0).intersection(shapely.box(0, 0, 136, 82)), 0.35),
        (shapely.box(139, 74, 200, 160).union(shapely.box(139, 0, 200, 74)), 1.35),
        (shapely.box(76, 90, 126, 144), 0.0),
    ]
    y, x = np.mgrid[0 : canvas.shape[0], 0 : canvas.shape[1]].astype(np.float32) * METRES_PER_PIXEL
    for lawn, angle in lawns:
        across = x * np.cos(angle) + y * np.sin(angle) + 0.25 * blotches(rng, canvas.shape, 9.0)
        lane = np.tanh(4 * np.sin(across * np.pi / 1.6))
        colour = between((88, 103, 56), (116, 122, 70), 0.5 + 0.26 * clouds(rng, canvas.shape, 14.0, 5, 0.7))
        colour *= (1 + 0.045 * lane + 0.05 * blotches(rng, canvas.shape, 0.3))[..., None]
        canvas.paint(lawn, colour, opacity=0.86, blur=0.35)


def _wear(canvas: Canvas, rng: np.random.Generator, plan: Plan) -> None:
    """Let soil and gravel show where wheels and feet leave the roads."""
    roads = canvas.mask(shapely.unary_union(list(plan.surfaces.values())))
    away = ndimage.distance_transform_edt(roads < 0.5) * METRES_PER_PIXEL
    ragged = away - 0.30 * clouds(rng, canvas.shape, 3.0)
    verge = np.clip(1 - ragged / 1.0, 0, 1) * 0.85
    soil = between((132, 120, 92), (166, 154, 126), 0.5 + 0.25 * clouds(rng, canvas.shape, 2.0))
    soil *= (1 + 0.06 * rng.standard_normal(canvas.shape))[..., None]
    canvas.pixels += (soil - canvas.pixels) * verge[..., None]
    trails = [
        [(128, 8), (131, 9.5), (134, 12)],
        [(112, 100), (121, 108), (124.6, 117)],
        [(130, 70), (134, 71), (137, 72)],
        [(93, 142), (94, 146)],
        [(20, 47), (32, 52), (52, 50)],
    ]
    for trail in trails:
        path = shapely.LineString(trail).buffer(0.55)
        canvas.paint(path, soil, opacity=0.7, blur=0.35)


def _courtyard(canvas: Canvas, rng: np.random.Generator) -> None:
    bed = COURT.buffer(-2.2, join_style="mitre")
    lawn = between((80, 100, 50), (104, 120, 62), 0.5 + 0.3 * clouds(rng, canvas.shape, 2.0))
    canvas.paint(bed, (150, 146, 138))
    canvas.paint(bed.buffer(-0.2, join_style="mitre"), lawn)
    canvas.paint(stroke([(141, 119.5), (159, 119.5)], 1.6), (178, 170, 156))


def _water(canvas: Canvas, rng: np.random.Generator, basin: shapely.Polygon) -> None:
    canvas.paint(basin.buffer(0.9), (120, 112, 88), opacity=0.7, blur=0.3)
    canvas.paint(basin.buffer(0.35), (158, 156, 148))
    deep = between((48, 66, 62), (74, 92, 84), 0.5 + 0.25 * clouds(rng, canvas.shape, 5.0, 3))
    canvas.paint(basin, deep)
    canvas.dim(canvas.patch(basin.difference(shapely.affinity.translate(basin, -0.5, 0.6)), 0.15), (0.6,) * 3)
    glint = shapely.affinity.translate(basin.buffer(-1.2), -1.5, 0.4)
    canvas.paint(glint, (150, 166, 170), opacity=0.16, blur=0.6)


def _excavation(canvas: Canvas, rng: np.random.Generator, pit: shapely.Polygon) -> None:
    relief = clouds(rng, canvas.shape, 4.0, octaves=4, fall=0.5)
    soil = between((116, 92, 64), (178, 150, 112), 0.5 + 0.2 * relief)
    slope = np.gradient(relief, axis=0) - np.gradient(relief, axis=1)
    soil *= (1 + np.clip(1.6 * ndimage.gaussian_filter(slope, 3.0), -0.22, 0.22))[..., None]
    canvas.paint(pit.buffer(0.8), soil, opacity=0.8, blur=0.4)
    canvas.paint(pit, soil)
    inner = pit.buffer(-1.8).buffer(-0.6).buffer(0.6)
    canvas.paint(inner, soil * 0.80, blur=0.2)
    wall = inner.difference(shapely.affinity.translate(inner, -0.5, 0.65))
    canvas.dim(canvas.patch(wall, 0.1), (0.5, 0.5, 0.52))
