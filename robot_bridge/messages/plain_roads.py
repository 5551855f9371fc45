"""What gateways tell of roads, from plain JSON values; unknown fields of newer gateways are passed over."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from .known_fields import known_fields
from .roads import (
    ClosureReport,
    Closures,
    ConflictReport,
    Conflicts,
    HoldReport,
    ReplannedRobot,
    RouteReport,
    SurfaceMetres,
    WayOut,
    WaysOut,
)

T = TypeVar("T")


def closures_report(values: dict[str, Any]) -> Closures:
    """Return the roads that are closed."""
    return Closures([closure_report(one) for one in values.get("closures", [])])


def closure_report(values: dict[str, Any]) -> ClosureReport:
    """Return one closed road."""
    return _made(ClosureReport, {**values, "line": _points(values["line"])})


def conflicts_report(values: dict[str, Any]) -> Conflicts:
    """Return where robots are in each other's way."""
    return Conflicts(
        float(values["t"]),
        [_made(ConflictReport, one) for one in values.get("conflicts", [])],
        [_made(HoldReport, one) for one in values.get("waiting", [])],
    )


def ways_out_report(values: dict[str, Any]) -> WaysOut:
    """Return what two robots in each other's way can do."""
    ways = [_made(WayOut, {**one, "points": _points(one.get("points", []))}) for one in values["ways"]]
    return WaysOut(float(values["t"]), str(values["robot"]), str(values["other"]), ways)


def replanned_robot(values: dict[str, Any]) -> ReplannedRobot:
    """Return what became of a robot whose road was closed."""
    return _made(ReplannedRobot, values)


def route_report(values: dict[str, Any]) -> RouteReport:
    """Return the way that was asked for."""
    surfaces = [_made(SurfaceMetres, one) for one in values.get("surfaces", [])]
    points, tight = _points(values["points"]), _points(values.get("tight", []))
    return _made(RouteReport, {**values, "points": points, "tight": tight, "surfaces": surfaces})


def _made(kind: type[T], values: dict[str, Any]) -> T:
    return kind(**known_fields(kind, values))


def _points(pairs: list[Any]) -> list[tuple[float, float]]:
    points = [(float(x), float(y)) for x, y in pairs]
    if not all(math.isfinite(x) and math.isfinite(y) for x, y in points):
        raise ValueError("a point has a coordinate that is no number")
    return points
