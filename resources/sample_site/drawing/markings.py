"""What is painted on the roads: lines, kerbs of the course, stalls, crossings, the start line."""

from __future__ import annotations

import numpy as np
import shapely
import shapely.ops
from plan import Plan
from roads_plan import Road

from .asphalt import WHITE, offset
from .canvas import Canvas, stroke


def draw_markings(canvas: Canvas, plan: Plan) -> None:
    """Paint the markings of every road of ``plan``."""
    junctions = _junctions(plan.roads)
    for road in plan.roads:
        if road.part == "track":
            _edge_lines(canvas, road, junctions)
        if road.part in ("track", "street") and road.width > 5:
            _dashes(canvas, road, junctions)
    _course_kerbs(canvas, plan.roads)
    _start_line(canvas)
    _stalls(canvas)
    for x, y, across in ((150.0, 84.0, True), (178.5, 84.0, True), (138.0, 66.0, False), (46.0, 84.0, True)):
        _crossing(canvas, x, y, across)


def _junctions(roads: list[Road]) -> shapely.Geometry:
    """Return the places where lines are left out: around ends that three or more roads share."""
    ends = np.round([point for road in roads for point in (road.points[0], road.points[-1])], 2)
    places, counts = np.unique(ends, axis=0, return_counts=True)
    return shapely.unary_union([shapely.Point(place).buffer(7.5) for place in places[counts > 2]])


def _edge_lines(canvas: Canvas, road: Road, junctions: shapely.Geometry) -> None:
    for side in (-1, 1):
        line = offset(road.points, side * (road.width / 2 - 0.3))
        canvas.paint(line.difference(junctions).buffer(0.07, cap_style="flat"), WHITE, opacity=0.8, blur=0.03)


def _dashes(canvas: Canvas, road: Road, junctions: shapely.Geometry) -> None:
    line = shapely.LineString(road.points)
    pieces = [
        shapely.ops.substring(line, start, min(start + 3.0, line.length))
        for start in np.arange(1.5, line.length, 9.0)
    ]
    for piece in pieces:
        left = piece.difference(junctions)
        if left.length > 0.5:
            canvas.paint(left.buffer(0.07, cap_style="flat"), WHITE, opacity=0.75, blur=0.03)


def _course_kerbs(canvas: Canvas, roads: list[Road]) -> None:
    """Lay red and white kerb stones inside and outside the bends of the handling loop."""
    bends = {"Handling loop south-east": 1, "Handling loop north-east": 1, "Handling loop north-west": 1}
    for road in roads:
        side = bends.get(road.name)
        if side is None:
            continue
        for distance in (side * (road.width / 2 + 0.05), -side * (road.width / 2 + 0.05)):
            kerb = offset(road.points, distance)
            for k, start in enumerate(np.arange(0, kerb.length - 1.2, 1.2)):
                middle = kerb.interpolate(start + 0.6)
                if _straight_near(road, middle) or middle.distance(shapely.Point(126, 44)) < 8:
                    continue
                stone = shapely.ops.substring(kerb, start, start + 1.2).buffer(0.35, cap_style="flat")
                canvas.paint(stone, (204, 203, 196) if k % 2 else (164, 60, 48), opacity=0.92, blur=0.03)


def _straight_near(road: Road, place: shapely.Point) -> bool:
    line = shapely.LineString(road.points)
    at = line.project(place)
    a, b, c = (np.array(line.interpolate(np.clip(at + d, 0, line.length)).coords[0]) for d in (-4, 0, 4))
    bend = np.linalg.norm(a - 2 * b + c) / 16
    return bool(bend < 0.030 or at < 6 or at > line.length - 6)


def _start_line(canvas: Canvas) -> None:
    for row in range(2):
        for k in range(16):
            if (row + k) % 2 == 0:
                x, y = 30.0 + row * 0.45, 4.4 + k * 0.45
                canvas.paint(shapely.box(x, y, x + 0.45, y + 0.45), WHITE, opacity=0.85)
    for k in range(6):
        x = 34.0 + 8 * k
        y = 6.4 if k % 2 else 9.6
        canvas.paint(stroke([(x, y - 1.1), (x, y + 1.1)], 0.12), WHITE, opacity=0.7)
        canvas.paint(stroke([(x, y + 1.1), (x + 3.5, y + 1.1)], 0.12), WHITE, opacity=0.7)
        canvas.paint(stroke([(x, y - 1.1), (x + 3.5, y - 1.1)], 0.12), WHITE, opacity=0.7)


STALL_ROWS = ((93.0, 98.0, 1), (104.0, 109.0, -1), (113.0, 118.0, 1), (124.0, 129.0, -1))
"""South edge, north edge and open side of each row of parking stalls."""
STALL_WIDTH = 2.6


def stall_edges(row: tuple[float, float, int]) -> np.ndarray:
    """Return the x of the lines between the stalls of ``row``; a gap is left where the access road enters."""
    edges = np.arange(13.0, 65.5, STALL_WIDTH)
    return edges if row[0] > 93 else edges[(edges < 36.5) | (edges > 43.5)]


def _stalls(canvas: Canvas) -> None:
    for row in STALL_ROWS:
        for x in stall_edges(row):
            canvas.paint(stroke([(x, row[0] + 0.1), (x, row[1])], 0.11), WHITE, opacity=0.75, blur=0.03)


def _crossing(canvas: Canvas, x: float, y: float, across: bool) -> None:
    for k in np.arange(-2.75, 2.8, 1.0):
        box = (
            shapely.box(x - 1.5, y + k - 0.25, x + 1.5, y + k + 0.25)
            if across
            else shapely.box(x + k - 0.25, y - 1.5, x + k + 0.25, y + 1.5)
        )
        canvas.paint(box, WHITE, opacity=0.78, blur=0.03)
