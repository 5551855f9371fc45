"""Buildings from above: roofs with parapets, seams, vents and panels, each with its own small shadows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import shapely
import shapely.affinity
from plan import Item, Plan

from .canvas import METRES_PER_PIXEL, Canvas, stroke
from .light import SHADE, shadow
from .noise import blotches, clouds


def draw_buildings(canvas: Canvas, plan: Plan) -> None:
    """Draw the roof of every building of ``plan``."""
    roofs: dict[str, Callable[[Canvas, np.random.Generator, Item], None]] = {
        "flat": _flat_roof,
        "metal": _metal_roof,
        "pitched": _pitched_roof,
        "tower": _tower_roof,
        "green": _green_roof,
        "solar": _solar_roof,
    }
    for number, building in enumerate(plan.buildings):
        roofs[building.kind](canvas, np.random.default_rng(100 + number), building)


def box_on_roof(canvas: Canvas, body: shapely.Geometry, height: float, colour: tuple) -> None:
    """Draw a body standing on a roof with its shadow and a light rim."""
    canvas.dim(canvas.patch(shadow(body, height).difference(body), 0.05), SHADE)
    canvas.paint(body, colour)
    rim = body.difference(body.buffer(-0.12, join_style="mitre"))
    canvas.paint(rim, tuple(min(255, c + 22) for c in colour), opacity=0.7)


def _deck(
    canvas: Canvas, rng: np.random.Generator, outline: shapely.Geometry, colour: tuple
) -> shapely.Geometry:
    """Draw a flat deck with a parapet around it; return the deck inside."""
    light = 1 + 0.04 * clouds(rng, canvas.shape, 7.0, 5) + 0.03 * rng.standard_normal(canvas.shape)
    canvas.paint(outline, (196, 193, 186))
    deck = outline.buffer(-0.45, join_style="mitre")
    canvas.paint(deck, np.asarray(colour, np.float32) * light[..., None].astype(np.float32))
    parapet = outline.difference(deck)
    canvas.dim(canvas.patch(shadow(parapet, 0.9).intersection(deck), 0.05), SHADE, 0.85)
    return deck


def _seams(canvas: Canvas, deck: shapely.Geometry, spacing: float, opacity: float, vertical: bool) -> None:
    x0, y0, x1, y1 = deck.bounds
    stops = np.arange(x0 if vertical else y0, x1 if vertical else y1, spacing)
    lines = [[(s, y0), (s, y1)] if vertical else [(x0, s), (x1, s)] for s in stops]
    seams = shapely.unary_union([stroke(line, 0.09) for line in lines]).intersection(deck)
    canvas.paint(seams, (70, 70, 70), opacity=opacity)


def _stains(canvas: Canvas, rng: np.random.Generator, deck: shapely.Geometry) -> None:
    wet = np.clip(clouds(rng, canvas.shape, 5.0, 4) - 0.8, 0, 1)
    patch = canvas.patch(deck)
    patch.cover[:] *= wet[patch.rows, patch.columns]
    canvas.dim(patch, (0.72, 0.73, 0.75))


def _scatter(canvas: Canvas, rng: np.random.Generator, deck: shapely.Geometry, count: int) -> None:
    """Put vents and hatches where there is room on ``deck``."""
    x0, y0, x1, y1 = deck.bounds
    for _ in range(count):
        x, y = rng.uniform(x0, x1), rng.uniform(y0, y1)
        w, d = rng.choice([(0.7, 0.7), (1.4, 1.0), (0.5, 0.5)])
        body = shapely.box(x - w / 2, y - d / 2, x + w / 2, y + d / 2)
        if deck.buffer(-0.8).contains(body):
            box_on_roof(
                canvas, body, rng.uniform(0.5, 1.2), tuple(rng.choice([(188, 190, 190), (150, 150, 148)]))
            )


def _plant(canvas: Canvas, x: float, y: float, wide: float, deep: float) -> None:
    """Draw an air handling unit with two fans."""
    body = shapely.box(x, y, x + wide, y + deep)
    box_on_roof(canvas, body, 1.8, (178, 181, 182))
    for share in (0.27, 0.73):
        fan = shapely.Point(x + share * wide, y + deep / 2).buffer(min(wide / 5, deep / 2.6))
        canvas.paint(fan, (72, 76, 80))
        canvas.paint(fan.buffer(-0.28), (112, 116, 120))


def _flat_roof(canvas: Canvas, rng: np.random.Generator, building: Item) -> None:
    deck = _deck(canvas, rng, building.geometry, (150, 147, 140))
    _seams(canvas, deck, 2.0, 0.16, vertical=True)
    _stains(canvas, rng, deck)
    for x, y in ((132.5, 108.0), (132.5, 113.0), (163.0, 128.0)):
        _plant(canvas, x, y, 5.2, 2.6)
    for k in range(7):
        box_on_roof(canvas, shapely.box(143 + 2.2 * k, 107, 144.4 + 2.2 * k, 110.6), 0.6, (188, 206, 214))
    box_on_roof(canvas, shapely.box(162.5, 108.5, 168.0, 112.5), 2.6, (172, 168, 160))
    _scatter(canvas, rng, deck, 34)


def _metal_roof(canvas: Canvas, rng: np.random.Generator, building: Item) -> None:
    outline = building.geometry
    x0, y0, x1, y1 = outline.bounds
    y = np.arange(canvas.shape[0])[:, None] * METRES_PER_PIXEL
    ridge = canvas.height - (y0 + y1) / 2
    light = np.where(y > ridge, 1.06, 0.90) * (1 + 0.05 * clouds(rng, canvas.shape, 6.0, 4))
    canvas.paint(outline, np.asarray((148, 156, 162), np.float32) * light[..., None].astype(np.float32))
    _seams(canvas, outline, 0.6, 0.20, vertical=True)
    strips = [(x, x + 1.2) for x in np.arange(x0 + 3, x1 - 2, 4.8)] if x1 - x0 > 10 else []
    for a, b in strips:
        for low, high in ((y0 + 2, (y0 + y1) / 2 - 1), ((y0 + y1) / 2 + 1, y1 - 2)):
            canvas.paint(shapely.box(a, low, b, high), (196, 206, 204), opacity=0.85)
    canvas.paint(stroke([(x0, (y0 + y1) / 2), (x1, (y0 + y1) / 2)], 0.4), (186, 190, 192))
    rust = np.clip(blotches(rng, canvas.shape, 2.0) - 1.3, 0, 1)
    patch = canvas.patch(outline)
    patch.cover[:] *= rust[patch.rows, patch.columns]
    canvas.lay(patch, (140, 104, 78), 0.6)
    canvas.paint(outline.difference(outline.buffer(-0.2)), (120, 124, 126))


def _pitched_roof(canvas: Canvas, rng: np.random.Generator, building: Item) -> None:
    """A hipped tile roof: every face has its own light from the one sun."""
    x0, y0, x1, y1 = building.geometry.bounds
    half, middle = (y1 - y0) / 2, (y0 + y1) / 2
    west, east = (x0 + half, middle), (x1 - half, middle)
    faces = [
        ([(x0, y0), (x1, y0), east, west], 1.10),
        ([(x1, y0), (x1, y1), east], 1.00),
        ([(x0, y1), (x1, y1), east, west], 0.66),
        ([(x0, y0), (x0, y1), west], 0.76),
    ]
    rows = np.sin(np.arange(canvas.shape[0]) * METRES_PER_PIXEL * 2 * np.pi / 0.34)[:, None]
    tiles = (
        1 + 0.05 * rows + 0.07 * blotches(rng, canvas.shape, 0.35) + 0.06 * clouds(rng, canvas.shape, 4.0, 4)
    )
    for corners, light in faces:
        colour = np.asarray((166, 96, 70), np.float32) * (tiles * light)[..., None].astype(np.float32)
        canvas.paint(shapely.Polygon(corners), colour)
    hips = [[west, east], [(x0, y0), west], [(x0, y1), west], [(x1, y0), east], [(x1, y1), east]]
    for hip in hips:
        canvas.paint(stroke(hip, 0.3), (176, 116, 90), opacity=0.85)
    for x in (x0 + 9, x0 + 18):
        box_on_roof(canvas, shapely.box(x, middle + 1.2, x + 0.9, middle + 2.1), 1.6, (150, 104, 84))
    for x in np.arange(x0 + 7, x1 - 7, 3.4):
        canvas.paint(shapely.box(x, y0 + 2.2, x + 1.0, y0 + 3.6), (92, 108, 122))
    canvas.paint(building.geometry.difference(building.geometry.buffer(-0.25)), (104, 82, 70))


def _tower_roof(canvas: Canvas, rng: np.random.Generator, building: Item) -> None:
    deck = _deck(canvas, rng, building.geometry, (168, 166, 160))
    middle = building.geometry.centroid
    cabin = middle.buffer(2.5, quad_segs=2)
    box_on_roof(canvas, cabin, 2.6, (92, 116, 134))
    box_on_roof(canvas, middle.buffer(1.9, quad_segs=2), 0.4, (202, 202, 198))
    mast = stroke([(middle.x, middle.y), (middle.x + 0.1, middle.y + 0.1)], 0.25)
    canvas.dim(canvas.patch(shadow(mast, 5.0)), SHADE, 0.8)
    canvas.paint(mast, (206, 70, 60))
    _scatter(canvas, rng, deck, 6)


def _green_roof(canvas: Canvas, rng: np.random.Generator, building: Item) -> None:
    deck = _deck(canvas, rng, building.geometry, (150, 147, 138))
    bed = deck.buffer(-0.7, join_style="mitre")
    mix = clouds(rng, canvas.shape, 3.0, 5, 0.75)
    sedum = np.asarray((112, 114, 72), np.float32) + mix[..., None] * np.asarray((15, 4, 8), np.float32)
    canvas.paint(bed, sedum * (1 + 0.06 * blotches(rng, canvas.shape, 0.3))[..., None])
    for x, y in ((190.2, 121.0), (190.2, 127.0), (185.5, 107.5)):
        box_on_roof(canvas, shapely.box(x, y, x + 2.4, y + 2.4), 0.7, (186, 204, 212))
    _plant(canvas, 189.3, 104.5, 4.2, 2.2)


def _solar_roof(canvas: Canvas, rng: np.random.Generator, building: Item) -> None:
    deck = _deck(canvas, rng, building.geometry, (166, 163, 156))
    _seams(canvas, deck, 1.8, 0.12, vertical=False)
    _stains(canvas, rng, deck)
    for y in (20.4, 23.4, 26.4):
        for x in np.arange(153.0, 176.0, 5.6):
            panel = shapely.box(x, y, x + 5.2, y + 1.8)
            box_on_roof(canvas, panel, 0.5, (44, 58, 84))
            cells = [stroke([(x + c, y), (x + c, y + 1.8)], 0.07) for c in np.arange(1.04, 5.2, 1.04)]
            canvas.paint(
                shapely.unary_union([*cells, stroke([(x, y + 0.9), (x + 5.2, y + 0.9)], 0.07)]),
                (96, 108, 126),
            )
    box_on_roof(canvas, shapely.box(179.5, 24.5, 184.5, 30.5), 2.8, (176, 172, 164))
    _plant(canvas, 178.5, 19.6, 5.0, 2.4)
    _scatter(canvas, rng, deck, 16)
