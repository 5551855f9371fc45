"""Walls, stairs, columns, bins, cars and people: what stands on the ground and is smaller than a house."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import shapely
import shapely.affinity
from plan import Plan

from .canvas import Canvas, stroke
from .markings import STALL_ROWS, STALL_WIDTH, stall_edges

PAINTS = (
    (198, 200, 202), (226, 226, 224), (54, 56, 60), (92, 96, 102), (140, 30, 32), (38, 60, 104),
    (128, 132, 136), (236, 236, 234), (28, 30, 34), (150, 142, 126), (70, 88, 74), (186, 188, 190),
)  # fmt: skip
UMBRELLAS = ((181.0, 119.0), (181.2, 123.2), (184.6, 121.0), (184.4, 125.6), (181.6, 128.0), (185.2, 130.0))


def car(x: float, y: float, angle: float) -> shapely.Geometry:
    """Return a car's outline, 4.4 m × 1.8 m; ``angle`` in degrees from the x axis."""
    body = shapely.box(-1.9, -0.6, 1.9, 0.6).buffer(0.3, quad_segs=4)
    return shapely.affinity.translate(shapely.affinity.rotate(body, angle, origin=(0, 0)), x, y)


def parked_cars() -> list[tuple[float, float, float]]:
    """Return (x, y, angle) of the cars in the car park, at the workshop and by the tower."""
    rng = np.random.default_rng(61)
    cars = []
    for row in STALL_ROWS:
        edges = stall_edges(row)
        for x in edges[:-1][np.diff(edges) < STALL_WIDTH + 0.1]:
            if rng.uniform() < 0.62:
                turn = rng.choice([90, 270]) + rng.normal(0, 1.5)
                cars.append(
                    (
                        x + STALL_WIDTH / 2 + rng.normal(0, 0.1),
                        (row[0] + row[1]) / 2 + rng.normal(0, 0.2),
                        turn,
                    )
                )
    cars += [(87.5, 113.6, 91), (91.0, 113.8, 88), (104.0, 113.4, 272), (133.4, 73.6, 90), (133.4, 68.4, 268)]
    return cars


def bodies(plan: Plan) -> Iterator[tuple[shapely.Geometry, float]]:
    """Yield (outline, height) of everything small that casts a shadow on the ground."""
    for wall in plan.walls:
        yield wall.geometry.buffer(0.15, cap_style="flat", join_style="mitre"), wall.height
    for items in (plan.columns, plan.litter_bins, plan.benches):
        for item in items:
            yield item.geometry, item.height
    for x, y, angle in parked_cars():
        yield car(x, y, angle), 1.35
    for x, y in UMBRELLAS:
        yield shapely.Point(x, y).buffer(1.25, quad_segs=2), 2.2
    for x, y in people():
        yield shapely.Point(x, y).buffer(0.22), 1.7


def people() -> list[tuple[float, float]]:
    rng = np.random.default_rng(62)
    near = [
        (150, 60),
        (165, 62),
        (172, 56),
        (183, 59),
        (163, 45),
        (150, 92),
        (177, 110),
        (186, 122),
        (45, 101),
        (97, 114),
    ]
    return [
        (x + rng.normal(0, 1.6), y + rng.normal(0, 1.2)) for x, y in near for _ in range(rng.integers(1, 4))
    ]


def draw_low_things(canvas: Canvas, plan: Plan) -> None:
    """Draw stairs and ramp: what lies on the ground and takes shadows."""
    outline = plan.ramps[0].item.geometry
    x0, y0, x1, y1 = outline.bounds
    canvas.paint(outline, (170, 167, 160))
    for k, x in enumerate(np.linspace(x0, x1, 22)):
        canvas.paint(stroke([(x, y0), (x, y1)], 0.06), (120, 118, 112), opacity=0.6 if k % 3 else 0.9)
    for stairs in plan.stairs:
        lines = np.array([np.array(line.coords) for line in stairs.geometry.geoms])
        for low, high in pairwise(lines):
            step = shapely.MultiPoint(np.concatenate([low, high])).convex_hull
            canvas.paint(step, (188, 184, 175))
            canvas.paint(stroke(low, 0.10), (108, 106, 100))


def draw_things(canvas: Canvas, plan: Plan) -> None:
    """Draw what stands up, on top of the shadows."""
    for wall in plan.walls:
        colour = (158, 112, 90) if wall.kind == "brick" else (186, 184, 178)
        canvas.paint(wall.geometry.buffer(0.15, cap_style="flat", join_style="mitre"), colour)
    for column in plan.columns:
        canvas.paint(column.geometry, (204, 200, 190))
    for item in plan.litter_bins:
        canvas.paint(item.geometry.buffer(0.05), (58, 66, 62))
        canvas.paint(item.geometry.buffer(-0.1), (30, 32, 32))
    for bench in plan.benches:
        canvas.paint(bench.geometry, (134, 96, 62))
    _draw_cars(canvas)
    for k, (x, y) in enumerate(UMBRELLAS):
        disc = shapely.Point(x, y).buffer(1.25, quad_segs=2)
        canvas.paint(disc, (214, 206, 186) if k % 2 else (172, 70, 56))
        canvas.paint(disc.intersection(shapely.box(x - 2, y, x + 2, y + 2)), (60, 50, 44), opacity=0.18)
    rng = np.random.default_rng(63)
    for x, y in people():
        canvas.paint(shapely.Point(x, y).buffer(0.22), tuple(int(v) for v in rng.integers(40, 210, 3)))
        canvas.paint(shapely.Point(x, y).buffer(0.10), (58, 44, 36))


def _draw_cars(canvas: Canvas) -> None:
    rng = np.random.default_rng(64)
    for x, y, angle in parked_cars():
        paint = PAINTS[rng.integers(len(PAINTS))]
        body = car(x, y, angle)
        canvas.paint(body, paint)
        for box, colour in (
            ((0.45, -0.72, 1.15, 0.72), (38, 44, 52)),
            ((-1.75, -0.70, -1.25, 0.70), (42, 48, 56)),
            ((-1.15, -0.66, 0.40, 0.66), tuple(min(255, int(c * 1.12 + 8)) for c in paint)),
        ):
            part = shapely.affinity.rotate(shapely.box(*box).buffer(-0.05), angle, origin=(0, 0))
            canvas.paint(shapely.affinity.translate(part, x, y), colour)
