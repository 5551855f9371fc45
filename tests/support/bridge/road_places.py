"""Places on the roads of the sample site, and what tells which road a way takes there."""

from __future__ import annotations

SOUTH = (60.0, 8.0)
"""A place on the road from (16, 8) to (120, 8); round it lead the roads by (44, 22) and (92, 22)."""
END = (190.0, 84.0)


def highest(points, low=16.0, high=120.0):
    """Return the largest y between two x: how far from the road at y = 8 a way leads."""
    return max(y for x, y in points if low < x < high)
