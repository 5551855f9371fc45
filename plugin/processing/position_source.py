"""Stored positions, read from the layer that an algorithm is given."""

from __future__ import annotations

import math
from datetime import datetime, timezone

import numpy as np
from qgis.core import QgsFeature, QgsProcessingFeatureSource, QgsProcessingFeedback
from qgis.PyQt.QtCore import QDateTime, Qt

from ..language import tr
from .drives import Positions
from .errors import ParameterError

LOOK_EVERY = 1000
"""Features between two looks for a cancel."""


class PositionSource:
    """Points with a robot's name and a time in two fields, and the speed in a third one if there is one.

    :raises ParameterError: when a field is not there.
    """

    def __init__(self, source: QgsProcessingFeatureSource, robot: str, time: str, speed: str) -> None:
        self._source = source
        names = source.fields().names()
        for what, name in ((tr("robot"), robot), (tr("time"), time)):
            if name not in names:
                raise ParameterError(
                    tr(
                        "The positions have no field {name} for the {what}: they have {names}. Give the "
                        "layer 'positions' of 'robot-bridge trajectories export', or say which field it is.",
                        name=name,
                        what=what,
                        names=", ".join(names) or tr("none"),
                    )
                )
        self._robot, self._time = names.index(robot), names.index(time)
        self._speed = names.index(speed) if speed in names else None

    def read(self, feedback: QgsProcessingFeedback) -> tuple[Positions, int] | None:
        """Return the positions, and how many features were none; None when cancelled."""
        robots: list[str] = []
        rows: list[tuple[float, float, float, float]] = []
        odd, total = 0, max(self._source.featureCount(), 1)
        for count, feature in enumerate(self._source.getFeatures()):
            if count % LOOK_EVERY == 0:
                if feedback.isCanceled():
                    return None
                feedback.setProgress(60.0 * count / total)
            row = self._row(feature)
            if row is None:
                odd += 1
                continue
            robots.append(str(feature.attribute(self._robot)))
            rows.append(row)
        numbers = np.array(rows, dtype=np.float64).reshape(-1, 4)
        return Positions(np.array(robots, dtype=np.str_), numbers[:, 0], numbers[:, 1:3], numbers[:, 3]), odd

    def _row(self, feature: QgsFeature) -> tuple[float, float, float, float] | None:
        """Return time, x, y and speed, None for a feature that is no position."""
        geometry = feature.geometry()
        robot, time = feature.attribute(self._robot), seconds(feature.attribute(self._time))
        # Of several points nobody can tell where the robot was.
        if (
            geometry.isNull()
            or geometry.constGet().nCoordinates() != 1
            or robot in (None, "")
            or time is None
        ):
            return None
        point = next(geometry.vertices())
        if not (math.isfinite(point.x()) and math.isfinite(point.y())):
            return None
        speed = None if self._speed is None else feature.attribute(self._speed)
        return time, point.x(), point.y(), float(speed) if isinstance(speed, (int, float)) else math.nan


def seconds(value: object) -> float | None:
    """Return a time in seconds since 1970, of a date and time, seconds, or ISO 8601 (UTC unless it says)."""
    if isinstance(value, QDateTime):
        if value.timeSpec() == Qt.TimeSpec.LocalTime:
            # Without an offset, or read by QGIS 3.22, which drops it: a gateway exports UTC.
            value = QDateTime(value.date(), value.time(), Qt.TimeSpec.UTC)
        return value.toMSecsSinceEpoch() / 1000.0 if value.isValid() else None
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value) if math.isfinite(value) else None
    if not isinstance(value, str):
        return None
    try:
        at = datetime.fromisoformat(value.strip().replace("Z", "+00:00"))
    except ValueError:
        return None
    return (at if at.tzinfo else at.replace(tzinfo=timezone.utc)).timestamp()


def utc(at: float) -> QDateTime:
    """Return seconds since 1970 as a date and time in UTC."""
    return QDateTime.fromMSecsSinceEpoch(round(at * 1000), Qt.TimeSpec.UTC)
