"""Outlines for the tests, from as few words as possible."""

from __future__ import annotations

import numpy as np

from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines


def row(points, shape_type=ShapeType.OPEN_POLYGON, semantics="wall", source="walls:1", height=2.0, **more):
    """Return an outline."""
    return OutlineRow(np.array(points, dtype=float), shape_type, height, semantics, source, **more)


def ring(points, **more):
    """Return a closed polygon around ``points``, whose first point is repeated here."""
    more = {"semantics": "building", "source": "buildings:1", **more}
    return row([*points, points[0]], ShapeType.CLOSED_POLYGON, **more)


def box(x_min, y_min, x_max, y_max, **more):
    """Return a rectangular building, counter-clockwise from its lower left corner."""
    return ring([(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max)], **more)


def outlines(*rows):
    """Return the rows as outlines."""
    return Outlines.from_rows(rows)


def signed_area(obstacle):
    """Return the area that an obstacle's segments run around, positive counter-clockwise."""
    (ax, ay), (bx, by) = obstacle.a.T, obstacle.b.T
    return float(np.sum(ax * by - bx * ay)) / 2


def is_chain(obstacle):
    """Tell whether each segment begins where the one before it ends."""
    return bool((obstacle.b[:-1] == obstacle.a[1:]).all())
