"""Trees and hedges: crowns as little mountains of leaf clumps lit by the sun."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from plan import HEIGHT, WIDTH, Plan
from scipy import ndimage

from .canvas import METRES_PER_PIXEL, Canvas, Patch
from .ground import COURT, FORECOURT, PLAZA, TERRACE
from .light import SHADE, SHADOW_PER_METRE, SUN

SPECIES = ((70, 92, 46), (86, 106, 52), (58, 80, 46), (104, 112, 60), (78, 98, 60), (98, 98, 58))


@dataclass(frozen=True)
class Tree:
    """A crown: its middle and radius in metres, its height and its colour."""

    x: float
    y: float
    radius: float
    height: float
    colour: tuple[int, int, int]


def plant_trees(plan: Plan) -> list[Tree]:
    """Return the trees: belts along the north and west edges, avenues, the car park's strip, single ones."""
    rng = np.random.default_rng(42)
    wanted = [(x, 111.0, 1.7) for x in np.arange(18, 62, 5.2)]
    wanted += [(x, 90.6, 2.3) for x in (96, 104, 112, 120, 128, 136, 143, 158, 166, 186, 195)]
    wanted += [(x, 77.4, 2.1) for x in (6, 16, 26, 84, 93, 102, 111, 119, 146, 154, 162, 170, 178)]
    wanted += [(x, 54.8, 1.6) for x in (150.5, 164.5, 170.5, 184.5)]
    wanted += [(144.5, 116.8, 1.7), (156.0, 122.4, 1.9), (150.2, 116.6, 1.2)]
    wanted += [(rng.uniform(72, 200), rng.uniform(143, 163), rng.uniform(1.8, 3.9)) for _ in range(190)]
    wanted += [(rng.uniform(-2, 72), rng.uniform(134, 163), rng.uniform(1.8, 4.2)) for _ in range(190)]
    wanted += [(rng.uniform(-2, 4.5), rng.uniform(88, 135), rng.uniform(1.6, 3.0)) for _ in range(34)]
    wanted += [(rng.uniform(195, 203), rng.uniform(2, 76), rng.uniform(1.8, 3.2)) for _ in range(46)]
    wanted += [(rng.uniform(146, 200), rng.uniform(-2, 13), rng.uniform(1.8, 3.4)) for _ in range(70)]
    wanted += [(rng.uniform(0, 140), rng.uniform(50, 82), rng.uniform(1.2, 2.4)) for _ in range(16)]
    built = _built(plan)
    trees: list[Tree] = []
    for x, y, radius in wanted:
        inside = COURT.contains(shapely.Point(x, y))
        on_plaza = PLAZA.contains(shapely.Point(x, y))
        clear = inside or on_plaza or built.distance(shapely.Point(x, y)) > radius + 0.3
        if clear and all(np.hypot(x - t.x, y - t.y) > 0.62 * (radius + t.radius) for t in trees):
            colour = SPECIES[rng.integers(len(SPECIES))]
            trees.append(Tree(x, y, radius, radius * rng.uniform(2.0, 2.6), colour))
    return trees


def _built(plan: Plan) -> shapely.Geometry:
    lists = (plan.buildings, plan.walls, plan.columns, plan.keepouts, plan.benches)
    objects = [item.geometry for items in lists for item in items]
    whole = shapely.unary_union([*plan.surfaces.values(), *objects, PLAZA, TERRACE, FORECOURT])
    shapely.prepare(whole)
    return whole


def shade_trees(canvas: Canvas, trees: list[Tree]) -> np.ndarray:
    """Return how much of the trees' shade falls on each pixel, (rows, columns) of 0 to 1."""
    rng = np.random.default_rng(43)
    total = np.zeros(canvas.shape, dtype=np.float32)
    for tree in trees:
        x, y = np.array([tree.x, tree.y]) + SHADOW_PER_METRE * tree.height * 0.62
        patch = canvas.patch(_ragged(rng, x, y, tree.radius * 1.02), 0.12)
        part = total[patch.rows, patch.columns]
        np.maximum(part, patch.cover * 0.92, out=part)
    return total


def _ragged(rng: np.random.Generator, x: float, y: float, radius: float) -> shapely.Geometry:
    angles = rng.uniform(0, 2 * np.pi, 14)
    reach = rng.uniform(0.35, 0.72, 14) * radius
    discs = [
        shapely.Point(x + r * np.cos(a), y + r * np.sin(a)).buffer(
            rng.uniform(0.3, 0.48) * radius, quad_segs=4
        )
        for a, r in zip(angles, reach, strict=True)
    ]
    return shapely.unary_union([*discs, shapely.Point(x, y).buffer(0.6 * radius, quad_segs=6)])


def draw_trees(canvas: Canvas, trees: list[Tree]) -> None:
    """Draw every crown, lower ones first."""
    rng = np.random.default_rng(44)
    for tree in sorted(trees, key=lambda tree: tree.height):
        _crown(canvas, rng, tree)


def _crown(canvas: Canvas, rng: np.random.Generator, tree: Tree) -> None:
    side = int(np.ceil(tree.radius * 1.3 / METRES_PER_PIXEL))
    y, x = np.mgrid[-side : side + 1, -side : side + 1].astype(np.float32) * METRES_PER_PIXEL
    relief = np.full(x.shape, -1.0, dtype=np.float32)
    for _ in range(int(26 + 14 * tree.radius)):
        angle, share = rng.uniform(0, 2 * np.pi), np.sqrt(rng.uniform(0, 1))
        cx, cy = share * 0.78 * tree.radius * np.array([np.cos(angle), np.sin(angle)])
        size = rng.uniform(0.16, 0.34) * tree.radius + 0.12
        dome = size**2 - (x - cx) ** 2 - (y - cy) ** 2
        top = np.sqrt(np.maximum(dome, 0)) + tree.radius * 0.8 * np.sqrt(max(1 - share**2, 0.05))
        relief = np.where(dome > 0, np.maximum(relief, top), relief)
    cover = ndimage.gaussian_filter((relief > 0).astype(np.float32), 0.7)
    bumps = ndimage.gaussian_filter(np.maximum(relief, 0) + 0.10 * rng.standard_normal(x.shape), 0.8)
    south, east = (-np.gradient(bumps, METRES_PER_PIXEL, axis=axis) for axis in (0, 1))
    facing = (east * SUN[0] - south * SUN[1] + SUN[2]) / np.sqrt(1 + south**2 + east**2)
    light = 0.42 + 0.78 * np.clip(facing, 0, 1) + 0.05 * rng.standard_normal(x.shape)
    light *= 0.72 + 0.28 * np.clip(relief / (tree.radius * 0.9), 0, 1)
    tint = np.asarray(tree.colour, np.float32) * rng.uniform(0.88, 1.12)
    crown = np.clip(tint * light[..., None] * 1.12 + np.array([10, 8, 0]) * (light > 1.0)[..., None], 0, 255)
    _stamp(canvas, tree, side, cover, crown)


def _stamp(canvas: Canvas, tree: Tree, side: int, cover: np.ndarray, crown: np.ndarray) -> None:
    column, row = (int(v) for v in canvas.to_pixels(np.array([[tree.x, tree.y]]))[0])
    top, left = row - side, column - side
    rows = slice(max(top, 0), min(top + cover.shape[0], canvas.shape[0]))
    columns = slice(max(left, 0), min(left + cover.shape[1], canvas.shape[1]))
    if rows.stop <= rows.start or columns.stop <= columns.start:
        return
    inner = (slice(rows.start - top, rows.stop - top), slice(columns.start - left, columns.stop - left))
    below = canvas.pixels[rows, columns]
    below += (crown[inner] - below) * cover[inner][..., None]


def dim_by(canvas: Canvas, shade: np.ndarray) -> None:
    """Darken the canvas by ``shade``, (rows, columns) of 0 to 1."""
    canvas.dim(Patch(slice(None), slice(None), shade), SHADE)


def hedges() -> list[Tree]:
    """Return clipped hedges as rows of small crowns."""
    rng = np.random.default_rng(45)
    rows = [((147.2, 42.5), (147.2, 57.0)), ((193.3, 42), (193.3, 58)), ((180, 134.8), (187, 134.8))]
    plants = []
    for (x0, y0), (x1, y1) in rows:
        for share in np.linspace(0, 1, int(np.hypot(x1 - x0, y1 - y0) / 0.55)):
            x, y = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
            plants.append(Tree(x, y, 0.55 + rng.uniform(-0.05, 0.08), 1.0, (66, 88, 44)))
    return [p for p in plants if 0 <= p.x <= WIDTH and 0 <= p.y <= HEIGHT]
