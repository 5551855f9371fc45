"""Stored positions of robots, read from layers, and their drives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timezone

import numpy as np
import numpy.typing as npt
from qgis.core import QgsFeature, QgsProcessingFeatureSource, QgsProcessingFeedback
from qgis.PyQt.QtCore import QDateTime, Qt

from ...layers.layer_source import each_feature
from ...ui.language import tr
from .algorithm import ParameterError

# --- Positions put together to drives: what each robot drove without a gap ---

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PositionArrays:
    """Where robots were: ``robots`` (n,) names, ``times`` (n,) seconds since 1970, ``xy`` (n, 2).

    ``speeds`` (n,) in m/s as the robots told them, NaN where they did not.
    """

    robots: npt.NDArray[np.str_]
    times: Numbers
    xy: Numbers
    speeds: Numbers

    def __len__(self) -> int:
        return len(self.times)


@dataclass(frozen=True)
class RobotDrive:
    """One robot on its way: ``times`` (m,) rising, ``xy`` (m, 2), ``speeds`` (m,), with m of at least 2."""

    robot: str
    times: Numbers
    xy: Numbers
    speeds: Numbers

    @property
    def seconds(self) -> float:
        """How long it took."""
        return float(self.times[-1] - self.times[0])

    def top_speed(self, steps: Numbers) -> float:
        """Return the highest speed in m/s; ``steps`` (m - 1,) are the metres from position to position.

        As the robot told it, else the mean of its fastest step.
        """
        if np.isfinite(self.speeds).any():
            return float(np.nanmax(np.abs(self.speeds)))
        return float((steps / np.diff(self.times)).max())


def drives(positions: PositionArrays, gap: float, *, steps: bool = False) -> Iterator[RobotDrive]:
    """Yield what each robot drove, robot by robot, oldest first; after more than ``gap`` seconds a new one.

    With ``steps`` each step from one position to the next is a drive of its own. Of several positions of a
    robot at one time the last counts. A position without another one near in time is no drive.
    """
    order = np.lexsort((positions.times, positions.robots))
    robots, times = positions.robots[order], positions.times[order]
    again = (robots[1:] == robots[:-1]) & (times[1:] == times[:-1])
    kept = np.append(~again, True)[: len(order)]
    order, robots, times = order[kept], robots[kept], times[kept]
    begins = np.flatnonzero((robots[1:] != robots[:-1]) | (np.diff(times) > gap)) + 1
    for part in np.split(order, begins):
        pieces = [part[k : k + 2] for k in range(len(part) - 1)] if steps else [part]
        for piece in pieces:
            if len(piece) > 1:
                robot = str(positions.robots[piece[0]])
                yield RobotDrive(robot, positions.times[piece], positions.xy[piece], positions.speeds[piece])


# --- Stored positions, read from the layer that an algorithm is given ---


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

    def read(self, feedback: QgsProcessingFeedback) -> tuple[PositionArrays, int] | None:
        """Return the positions, and how many features were none; None when cancelled."""
        robots: list[str] = []
        rows: list[tuple[float, float, float, float]] = []
        odd = 0
        for feature in each_feature(self._source, feedback, 60.0):
            row = self._row(feature)
            if row is None:
                odd += 1
                continue
            robots.append(str(feature.attribute(self._robot)))
            rows.append(row)
        if feedback.isCanceled():
            return None
        numbers = np.array(rows, dtype=np.float64).reshape(-1, 4)
        return PositionArrays(
            np.array(robots, dtype=np.str_), numbers[:, 0], numbers[:, 1:3], numbers[:, 3]
        ), odd

    def _row(self, feature: QgsFeature) -> tuple[float, float, float, float] | None:
        """Return time, x, y and speed, None for a feature that is no position."""
        geometry = feature.geometry()
        robot, time = feature.attribute(self._robot), parse_seconds(feature.attribute(self._time))
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


def parse_seconds(value: object) -> float | None:
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


def utc_datetime(at: float) -> QDateTime:
    """Return seconds since 1970 as a date and time in UTC."""
    return QDateTime.fromMSecsSinceEpoch(round(at * 1000), Qt.TimeSpec.UTC)
