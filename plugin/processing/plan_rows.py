"""An assignment's plan as rows of layers, and the figures that sum it up."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from qgis.core import QgsGeometry, QgsPointXY

from ...robot_bridge.assignment.plan import Plan, PlannedTrip, RobotPlan, Stop
from ..language import tr
from .sinks import line

_COMMON = {"robot": "string", "trip": "integer", "sequence": "integer", "kind": "string", "id": "string"}
TARGET_FIELDS = {
    **_COMMON,
    "eta_s": "double",
    "begin_s": "double",
    "end_s": "double",
    "loaded": "integer",
    "unloaded": "integer",
    "aboard": "integer",
    "collected": "integer",
}
PATH_FIELDS = {**_COMMON, "metres": "double", "start_s": "double", "eta_s": "double"}
FIGURES = {
    "END_S": tr("Seconds until the last robot has finished"),
    "SERVED_S": tr("Seconds until the last cone is done"),
    "METRES": tr("Metres of all robots"),
    "TRIP_COUNT": tr("Trips"),
    "ROBOT_COUNT": tr("Robots that drive"),
}

Rows = list[tuple[QgsGeometry, list[Any]]]


def _stops(plan: Plan) -> Iterator[tuple[RobotPlan, PlannedTrip, int, Stop]]:
    for one in plan.robots:
        sequence = 0
        for trip in one.trips:
            for stop in trip.stops:
                sequence += 1
                yield one, trip, sequence, stop


def target_rows(plan: Plan) -> Rows:
    """Return a point for each stop, with the values of ``TARGET_FIELDS``."""
    return [
        (
            QgsGeometry.fromPointXY(QgsPointXY(stop.x, stop.y)),
            [
                *_common(one, trip, sequence, stop),
                *(round(value, 2) for value in (stop.arrival_s, stop.begin_s, stop.end_s)),
                stop.loaded,
                stop.unloaded,
                stop.aboard,
                stop.collected,
            ],
        )
        for one, trip, sequence, stop in _stops(plan)
    ]


def path_rows(plan: Plan) -> Rows:
    """Return the way to each stop, with the values of ``PATH_FIELDS``."""
    return [
        (
            line(np.array(stop.path)),
            [
                *_common(one, trip, sequence, stop),
                round(stop.metres, 3),
                round(stop.arrival_s - stop.metres / one.robot.speed, 2),
                round(stop.arrival_s, 2),
            ],
        )
        for one, trip, sequence, stop in _stops(plan)
    ]


def _common(one: RobotPlan, trip: PlannedTrip, sequence: int, stop: Stop) -> list:
    return [one.robot.id, trip.number, sequence, stop.kind, stop.id]


def figures(plan: Plan) -> dict[str, float]:
    """Return the values of ``FIGURES``."""
    driving = [one for one in plan.robots if one.stops]
    trips = sum(len(one.trips) for one in driving)
    values = (plan.end_s, plan.served_s, plan.metres, trips, len(driving))
    return dict(zip(FIGURES, values, strict=True))
