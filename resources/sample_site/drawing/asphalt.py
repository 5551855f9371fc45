"""Roads: asphalt with its wear, wet skid surface, paved ways, and everything painted on them."""

from __future__ import annotations

import numpy as np
import shapely
import shapely.ops
from plan import Plan
from roads_plan import ASPHALT, PAVEMENT, SLIPPERY, Road

from .canvas import Canvas, stroke
from .ground import paving
from .noise import between, clouds

WHITE = (222, 221, 214)


def draw_roads(canvas: Canvas, plan: Plan) -> None:
    """Draw every surface of ``plan``, its kerbs, its wear and its markings."""
    rng = np.random.default_rng(23)
    for surface in (PAVEMENT, ASPHALT):
        canvas.paint(plan.surfaces[surface].buffer(0.22), (158, 155, 147))
    slabs = paving(rng, canvas.shape, 0.48, (158, 152, 143))
    canvas.paint(plan.surfaces[PAVEMENT], slabs)
    _lay_asphalt(canvas, rng, plan)
    _skid_surface(canvas, rng, plan.surfaces[SLIPPERY])
    _wheel_paths(canvas, rng, plan)
    _patches_and_cracks(canvas, rng, plan)
    _tyre_marks(canvas, rng, plan)


def _lay_asphalt(canvas: Canvas, rng: np.random.Generator, plan: Plan) -> None:
    grain = 1 + 0.045 * rng.standard_normal(canvas.shape) + 0.035 * clouds(rng, canvas.shape, 9.0, 5, 0.7)
    street = np.asarray((128, 127, 123), np.float32) * grain[..., None].astype(np.float32)
    track = np.asarray((98, 98, 99), np.float32) * grain[..., None].astype(np.float32)
    canvas.paint(plan.surfaces[ASPHALT], street)
    strips = [stroke(road.points, road.width) for road in plan.roads if road.part == "track"]
    course = shapely.unary_union(strips).buffer(2.5).buffer(-2.5).intersection(plan.surfaces[ASPHALT])
    canvas.paint(course, track)


def _skid_surface(canvas: Canvas, rng: np.random.Generator, pad: shapely.Geometry) -> None:
    """Polished basalt tiles under a film of water, with a blue edge line."""
    tiles = paving(rng, canvas.shape, 1.0, (124, 132, 138))
    canvas.paint(pad, tiles)
    wet = np.clip(0.5 + 0.7 * clouds(rng, canvas.shape, 7.0, 4), 0, 1)
    film = between((86, 98, 108), (150, 164, 174), 0.5 + 0.3 * clouds(rng, canvas.shape, 2.5, 3))
    patch = canvas.patch(pad.buffer(-0.3))
    patch.cover[:] *= wet[patch.rows, patch.columns] * 0.5
    canvas.lay(patch, film)
    canvas.paint(pad.difference(pad.buffer(-0.25)), (66, 104, 150), opacity=0.85)
    for x in range(44, 92, 6):
        for y in (37.6, 50.4):
            canvas.paint(shapely.Point(x, y).buffer(0.14), (60, 64, 66))


def _wheel_paths(canvas: Canvas, rng: np.random.Generator, plan: Plan) -> None:
    """Darken where wheels run and lighten the middle of each lane."""
    patchy = np.clip(0.6 + 0.35 * clouds(rng, canvas.shape, 6.0, 3), 0, 1)
    for road in plan.roads:
        if road.part in ("footway", "parking"):
            continue
        lane = road.width / 4 if road.width > 5 else 0.0
        for middle in {-lane, lane}:
            for wheel in (-0.8, 0.8):
                path = offset(road.points, middle + wheel)
                patch = canvas.patch(path.buffer(0.28, cap_style="flat"), blur=0.22)
                patch.cover[:] *= patchy[patch.rows, patch.columns]
                canvas.dim(patch, (0.84, 0.84, 0.85))


def _patches_and_cracks(canvas: Canvas, rng: np.random.Generator, plan: Plan) -> None:
    for road in plan.roads:
        if road.part in ("footway", "skid"):
            continue
        line = shapely.LineString(road.points)
        for _ in range(rng.poisson(line.length / 45)):
            _repair(canvas, rng, line, road)
        for _ in range(rng.poisson(line.length / 9)):
            _crack(canvas, rng, line, road)


def _repair(canvas: Canvas, rng: np.random.Generator, line: shapely.LineString, road: Road) -> None:
    start = rng.uniform(0, max(line.length - 6, 0.1))
    piece = shapely.ops.substring(line, start, start + rng.uniform(2, 6))
    side = rng.uniform(-0.25, 0.25) * road.width
    shape = offset(np.array(piece.coords), side).buffer(rng.uniform(0.5, 1.1), cap_style="flat")
    tone = rng.choice([0.80, 0.87, 1.10])
    canvas.dim(canvas.patch(shape), (tone,) * 3)
    canvas.paint(shape.exterior.buffer(0.04), (62, 62, 62), opacity=0.5)


def _crack(canvas: Canvas, rng: np.random.Generator, line: shapely.LineString, road: Road) -> None:
    place = line.interpolate(rng.uniform(0, line.length))
    angle, points = (
        rng.uniform(0, np.pi),
        [np.array([place.x, place.y]) + rng.uniform(-0.3, 0.3, 2) * road.width],
    )
    for _ in range(rng.integers(6, 22)):
        angle += rng.normal(0, 0.45)
        points.append(points[-1] + 0.35 * np.array([np.cos(angle), np.sin(angle)]))
    strip = shapely.LineString(road.points).buffer(road.width / 2 - 0.1, cap_style="flat")
    crack = stroke(np.array(points), rng.choice([0.05, 0.05, 0.11])).intersection(strip)
    if not crack.is_empty:
        canvas.paint(crack, (58, 58, 58), opacity=0.55)


def _tyre_marks(canvas: Canvas, rng: np.random.Generator, plan: Plan) -> None:
    """Leave pairs of black marks where the course bends and where cars brake."""
    for road in plan.roads:
        if road.part not in ("track", "skid"):
            continue
        line = shapely.LineString(road.points)
        for _ in range(rng.poisson(line.length / 8)):
            start = rng.uniform(0, max(line.length - 8, 0.1))
            piece = np.array(shapely.ops.substring(line, start, start + rng.uniform(6, 26)).coords)
            if len(piece) < 2:
                continue
            drift = np.linspace(0, rng.normal(0, 0.9), len(piece))
            side = rng.uniform(-0.25, 0.25) * road.width
            for wheel in (-0.75, 0.75):
                moved = np.array(offset(piece, side + wheel).coords)
                if len(moved) == len(piece):
                    moved[:, 1] += drift
                canvas.paint(stroke(moved, 0.2), (34, 34, 36), opacity=rng.uniform(0.12, 0.42), blur=0.06)


def offset(points: np.ndarray, distance: float) -> shapely.LineString:
    """Return the line ``distance`` metres to the left of ``points``, or right where negative."""
    points = np.asarray(points, dtype=float)
    ahead = np.gradient(points, axis=0)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-9)
    return shapely.LineString(points + distance * np.column_stack([-ahead[:, 1], ahead[:, 0]]))
