"""The robot map: a border and oriented obstacle segments (paper 1, section II)."""

from __future__ import annotations

from enum import IntEnum


class ShapeType(IntEnum):
    """How an obstacle is represented: the integer ST of the paper, in the order of its text."""

    CLOSED_POLYGON = 1
    OPEN_POLYGON = 2
    CLOSED_CURVE = 3
    OPEN_CURVE = 4
    STAIRS = 5
    RAMP = 6
