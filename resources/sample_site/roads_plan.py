"""The sample site's roads: centrelines that meet end to end, and the surfaces they carry; metres."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
import shapely.ops

ASPHALT, PAVEMENT, SLIPPERY = "asphalt", "parking pavement", "slippery"
CHORD_SAGITTA = 0.02
FILLET_RADIUS = 2.5


@dataclass(frozen=True)
class Road:
    """One centreline: ``points`` is (n, 2); ``part`` says which drawing style it gets in the photograph."""

    name: str
    points: np.ndarray
    width: float
    surface: str
    part: str


def arc(centre: tuple[float, float], radius: float, start: float, end: float) -> np.ndarray:
    """Return (n, 2) points on an arc from ``start`` to ``end`` degrees, chords at most 2 cm off."""
    step = 2 * math.acos(1 - CHORD_SAGITTA / radius)
    angles = np.radians(np.linspace(start, end, math.ceil(abs(math.radians(end - start)) / step) + 1))
    return np.column_stack([centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)])


def bezier(*control: tuple[float, float], count: int = 24) -> np.ndarray:
    """Return (count, 2) points on the cubic Bezier curve of four control points."""
    t = np.linspace(0, 1, count)[:, None]
    a, b, c, d = (np.array(point) for point in control)
    return (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d


def spline(knots: list[tuple[float, float]], per_span: int = 12) -> list[np.ndarray]:
    """Return each span of the Catmull-Rom curve between the second and the last but one of ``knots``."""
    spans = []
    for p0, p1, p2, p3 in zip(knots, knots[1:], knots[2:], knots[3:], strict=False):
        p0, p1, p2, p3 = (np.array(p, dtype=float) for p in (p0, p1, p2, p3))
        spans.append(bezier(p1, p1 + (p2 - p0) / 6, p2 - (p3 - p1) / 6, p2, count=per_span))
    return spans


def line(*points: tuple[float, float]) -> np.ndarray:
    return np.array(points, dtype=float)


def chain(*parts: np.ndarray) -> np.ndarray:
    """Return ``parts`` as one line, each beginning where the one before it ends."""
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])


def handling_course() -> list[Road]:
    """Return the loop, its infield road with the slippery section, and the slalom straight."""
    top = spline([(116, 66), (104, 66), (88, 63.5), (72, 72), (56, 67), (42, 60.5), (28, 66), (16, 66)])
    loop = [
        ("Handling loop south", line((44, 22), (92, 22))),
        ("Handling loop south-east", chain(line((92, 22), (104, 22)), arc((104, 44), 22, -90, 0))),
        ("Handling loop north-east", chain(arc((104, 44), 22, 0, 90), top[0], top[1])),
        ("Handling loop north-west", chain(*top[2:], arc((28, 44), 22, 90, 180))),
        ("Handling loop south-west", chain(arc((28, 44), 22, 180, 270), line((28, 22), (44, 22)))),
    ]
    infield = [
        Road("Infield west", line((6, 44), (40, 44)), 6.0, ASPHALT, "track"),
        Road("Skid section", line((40, 44), (92, 44)), 12.0, SLIPPERY, "skid"),
        Road("Infield east", line((92, 44), (126, 44)), 6.0, ASPHALT, "track"),
    ]
    straight = [
        Road("Straight, west head", line((8, 8), (16, 8)), 8.0, ASPHALT, "track"),
        Road("Straight", line((16, 8), (120, 8)), 8.0, ASPHALT, "track"),
        Road("Straight, east head", line((120, 8), (128, 8)), 8.0, ASPHALT, "track"),
        Road("Merge west", bezier((44, 22), (30, 22), (30, 8), (16, 8)), 6.0, ASPHALT, "track"),
        Road("Merge east", bezier((92, 22), (106, 22), (106, 8), (120, 8)), 6.0, ASPHALT, "track"),
    ]
    return [Road(name, points, 7.0, ASPHALT, "track") for name, points in loop] + infield + straight


def campus_roads() -> list[Road]:
    """Return the roads that link the gate, the track, the car park and the buildings."""
    stops = [(0, 84), (40, 84), (72, 84), (78, 84), (138, 84), (150, 84), (178.5, 84), (190, 84), (200, 84)]
    main = [
        Road(f"Campus road {k}", line(a, b), 6.5, ASPHALT, "street")
        for k, (a, b) in enumerate(pairwise(stops), start=1)
    ]
    service = chain(
        line((78, 84), (78, 111.5)), arc((86, 111.5), 8, 180, 90), line((86, 119.5), (125.8, 119.5))
    )
    tower = chain(line((126, 44), (128, 44)), arc((128, 54), 10, -90, 0))
    return [
        *main,
        Road("Track access", line((72, 72), (72, 84)), 6.0, ASPHALT, "street"),
        Road("Tower road south", chain(tower, line((138, 54), (138, 60))), 5.5, ASPHALT, "street"),
        Road("Tower road north", line((138, 60), (138, 84)), 5.5, ASPHALT, "street"),
        Road("Service road", service, 5.0, ASPHALT, "street"),
        Road("Car park access", line((40, 84), (40, 101)), 6.0, ASPHALT, "street"),
    ]


def paved_ways(hall_ring: np.ndarray) -> list[Road]:
    """Return the car park's aisles and the footways; ``hall_ring`` is the closed loop around the hall."""
    aisles = [
        ("Aisle south-west", line((12, 101), (40, 101)), 16.0),
        ("Aisle south-east", line((40, 101), (66, 101)), 16.0),
        ("Car park east", line((66, 101), (66, 121)), 6.0),
        ("Aisle north", line((66, 121), (12, 121)), 16.0),
        ("Car park west", line((12, 121), (12, 101)), 6.0),
    ]
    footways = [
        ("Hall entrance way", line((150, 84), (150, 101.8)), 3.0),
        ("Canteen way", line((174.2, 119.5), (178.5, 119.5), (178.5, 84)), 3.0),
        ("Plaza way", line((138, 60), (190, 60), (190, 84)), 3.5),
    ]
    return [
        *(Road(name, points, width, PAVEMENT, "parking") for name, points, width in aisles),
        *(Road(name, points, width, PAVEMENT, "footway") for name, points, width in footways),
        *(Road(f"Hall loop {k}", part, 2.4, PAVEMENT, "footway") for k, part in _split(hall_ring)),
    ]


def _split(ring: np.ndarray) -> list[tuple[int, np.ndarray]]:
    """Return the hall's loop in four pieces that begin and end where ways join it."""
    joints = ((150, 101.8), (174.2, 119.5), (150, 137.2), (125.8, 119.5))
    loop = shapely.LinearRing(ring)
    stations = sorted(loop.project(shapely.Point(joint)) for joint in joints)
    pieces = [
        shapely.ops.substring(shapely.LineString(ring), a, b)
        for a, b in zip([0.0, *stations], [*stations, loop.length], strict=True)
    ]
    first = np.concatenate([np.array(pieces[-1].coords), np.array(pieces[0].coords)[1:]])
    middle = [np.array(piece.coords) for piece in pieces[1:-1]]
    return list(enumerate([first, *middle], start=1))


def surfaces(roads: list[Road]) -> dict[str, shapely.Geometry]:
    """Return one dissolved surface for each class; classes do not overlap, the slippery one wins.

    Straight ends are cut square; inner corners of junctions get the radius that a kerb has there.
    """
    taken = shapely.Polygon()
    result = {}
    for surface in (SLIPPERY, ASPHALT, PAVEMENT):
        strips = [
            shapely.LineString(road.points).buffer(road.width / 2, cap_style="flat", quad_segs=16)
            for road in roads
            if road.surface == surface
        ]
        whole = shapely.unary_union(strips)
        if surface == ASPHALT:
            whole = whole.buffer(FILLET_RADIUS).buffer(-FILLET_RADIUS)
        result[surface] = shapely.set_precision(whole.difference(taken), 0.001)
        taken = taken.union(whole)
    return result
