"""A yard that looks different from everywhere: what the robot finds itself in."""

from __future__ import annotations

import pytest

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines


def ring(*points):
    return [*points, points[0]]


def box(x, y, width, height):
    return ring((x, y), (x + width, y), (x + width, y + height), (x, y + height))


@pytest.fixture(scope="session")
def yard():
    """A wall of 30 m × 20 m round two houses, one with a court, two bins, a kerb, stairs and a ramp."""
    closed, opened = ShapeType.CLOSED_POLYGON, ShapeType.OPEN_POLYGON
    house = [(6, 5), (12, 5), (12, 9), (9, 9), (9, 14), (6, 14)]
    rows = [
        OutlineRow(box(0, 0, 30, 20), opened, 3.0, "wall", "walls:1"),
        OutlineRow(ring(*house), closed, 9.0, "building,L", "buildings:1"),
        OutlineRow(box(17, 11, 9, 5), closed, 6.0, "building,court", "buildings:2"),
        OutlineRow(box(19, 12, 4, 3), closed, 6.0, "building,court", "buildings:2", courtyard=True),
        OutlineRow(box(18, 4, 0.5, 0.5), closed, 1.0, "litter_bin", "furniture:1"),
        OutlineRow(box(24, 6, 1.5, 0.6), closed, 0.9, "bench", "furniture:2"),
        OutlineRow([(14, 0), (14, 20)], opened, 0.15, "kerb", "kerbs:1"),
        OutlineRow([(2, 16), (4, 16), (2, 17), (4, 17)], ShapeType.STAIRS, 0.6, "stairs", "stairs:1"),
        OutlineRow(box(27, 1, 2, 2), ShapeType.RAMP, 0.0, "ramp", "ramps:1"),
    ]
    return build_map(Outlines.from_rows(rows), Window.from_bounds(0, 0, 30, 20), {"id": "yard"})
