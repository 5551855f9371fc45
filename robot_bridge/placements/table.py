"""Placed cones as columns: in the site frame, in the site's CRS, and their deviation along both axes."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Any

from ..messages import PlacementReport
from ..sites.frame import SiteFrame

Row = dict[str, Any]

TIMES = ("placed_at", "collected_at")
TEXTS = ("layout", "cone", "label", "plan", "task", "robot", "collected_by")
NUMBERS = (
    "planned_x",
    "planned_y",
    "x",
    "y",
    "dx",
    "dy",
    "deviation",
    "easting",
    "northing",
    "planned_easting",
    "planned_northing",
)
NAMES = ("placement", *TEXTS[:6], TIMES[0], *NUMBERS, TIMES[1], TEXTS[6])
"""The columns, in order."""


def rows(placed: Sequence[PlacementReport], frame: SiteFrame) -> list[Row]:
    """Return a row for each cone: metres in the site frame, easting and northing in its CRS, times in UTC.

    ``dx`` and ``dy`` are how far the cone stands off its plan along the axes of the site frame.
    """
    points = frame.to_crs([(one.x, one.y) for one in placed])
    planned = frame.to_crs([(one.planned_x, one.planned_y) for one in placed])
    return [_row(*both) for both in zip(placed, points, planned, strict=True)]


def _row(one: PlacementReport, point: Any, planned: Any) -> Row:
    return {
        "placement": one.placement,
        "layout": one.layout,
        "cone": one.cone,
        "label": one.label,
        "plan": one.plan,
        "task": one.task,
        "robot": one.robot,
        "placed_at": _time(one.placed_at),
        "planned_x": one.planned_x,
        "planned_y": one.planned_y,
        "x": one.x,
        "y": one.y,
        "dx": one.x - one.planned_x,
        "dy": one.y - one.planned_y,
        "deviation": one.deviation,
        "easting": float(point[0]),
        "northing": float(point[1]),
        "planned_easting": float(planned[0]),
        "planned_northing": float(planned[1]),
        "collected_at": _time(one.collected_at),
        "collected_by": one.collected_by,
    }


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)
