"""``fleet:trajectories``: stored positions in, lines with time, length and speed out."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsDistanceArea,
    QgsFeature,
    QgsGeometry,
    QgsLineString,
    QgsPoint,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterField,
    QgsProcessingParameterNumber,
    QgsUnitTypes,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QDateTime, Qt

from ...layers.crs import is_mercator, stated_crs
from ...layers.layer_source import each_feature, parse_seconds
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, fields_of, shown_by_processing
from ..common.outputs import AT_ONCE, fill_sink

# --- Positions combined to drives of each robot without a gap ---

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PositionArrays:
    """Positions of robots: ``robots`` (n,) names, ``times`` (n,) seconds since 1970, ``xy`` (n, 2).

    ``speeds`` (n,) in m/s as reported by the robots, NaN where not.
    """

    robots: npt.NDArray[np.str_]
    times: Numbers
    xy: Numbers
    speeds: Numbers

    def __len__(self) -> int:
        return len(self.times)


@dataclass(frozen=True)
class RobotDrive:
    """One drive of a robot: ``times`` (m,) rising, ``xy`` (m, 2), ``speeds`` (m,), with m of at least 2."""

    robot: str
    times: Numbers
    xy: Numbers
    speeds: Numbers

    @property
    def seconds(self) -> float:
        """Its duration."""
        return float(self.times[-1] - self.times[0])

    def top_speed(self, steps: Numbers) -> float:
        """Return the highest speed in m/s; ``steps`` (m - 1,) are the metres from position to position.

        As reported by the robot, else the mean of its fastest step.
        """
        if np.isfinite(self.speeds).any():
            return float(np.nanmax(np.abs(self.speeds)))
        return float((steps / np.diff(self.times)).max())


def drives(positions: PositionArrays, gap: float, *, steps: bool = False) -> Iterator[RobotDrive]:
    """Yield the drives, robot by robot, oldest first; a gap of more than ``gap`` seconds begins a new one.

    With ``steps`` each step from one position to the next is a drive of its own. Of several positions of a
    robot at one time the last counts. An isolated position is no drive.
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


# --- Stored positions, read from the input layer of an algorithm ---

SPEED = "v"
"""The field of the speed unless another one is given; layers of other programs may have none."""


class PositionSource:
    """Points with a robot's name and a time in two fields, and optionally the speed in a third one.

    ``odd_speeds`` is the number of values read of that one that are no numbers. The field :data:`SPEED` may
    be missing: it is the default.

    :raises ParameterError: when a field does not exist.
    """

    def __init__(self, source: QgsProcessingFeatureSource, robot: str, time: str, speed: str) -> None:
        self._source = source
        names = source.fields().names()
        speeds = () if speed in ("", SPEED) else ((tr("speed"), speed),)
        for what, name in ((tr("robot"), robot), (tr("time"), time), *speeds):
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
        self.odd_speeds = 0

    def read(self, feedback: QgsProcessingFeedback) -> tuple[PositionArrays, int] | None:
        """Return the positions, and the number of other features; None if cancelled."""
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
        # With several points the robot's position is ambiguous.
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
        is_number = isinstance(speed, (int, float))
        self.odd_speeds += not is_number and speed not in (None, "")
        return time, point.x(), point.y(), float(speed) if is_number else math.nan


# --- The algorithm ---

INPUT, OUTPUT = "INPUT", "OUTPUT"
ROBOT_FIELD, TIME_FIELD, SPEED_FIELD, GAP, STEPS = "ROBOT_FIELD", "TIME_FIELD", "SPEED_FIELD", "GAP", "STEPS"
NUMBERS = {
    "LINE_COUNT": tr("Lines"),
    "POSITION_COUNT": tr("Positions"),
    "TOTAL_LENGTH": tr("Metres driven, all robots"),
}
_FIELDS = {
    "robot": "string",
    "begin": "datetime",
    "end": "datetime",
    "duration_s": "double",
    "length_m": "double",
    "mean_speed": "double",
    "top_speed": "double",
    "count": "integer",
}


class Trajectories(FleetAlgorithm):
    """Makes lines of robots' stored positions."""

    GROUP = ("records", tr("Records"))
    NAME = "trajectories"
    TITLE = tr("Trajectories")
    SUMMARY = tr("Makes lines of stored positions, with their time, length and speed.")
    ICON = "trajectories.svg"
    TAGS = ("trajectory", "track", "path", "history", "temporal", "replay", "speed")
    STYLES = {OUTPUT: "trajectories.qml"}  # noqa: RUF012
    HELP = tr_page("""
    <p>Makes of the positions that a gateway stored one line for each drive of each robot: a robot that
    was not heard of for longer than the gap begins a new line. Or, with <b>a line for each step</b>, one
    for each pair of positions, for colours by speed and for QGIS's temporal controller.</p>
    <p>The positions are the layer <i>positions</i> of <i>robot-bridge trajectories export drives.gpkg
    --site site</i>, or any points, in any CRS, with a field for the robot and one for the time (date and
    time, seconds since 1970, or ISO 8601; without an offset UTC).</p>
    <p>Fields: <b>begin</b> and <b>end</b> (UTC), <b>duration_s</b>, <b>length_m</b>, <b>mean_speed</b>
    and <b>top_speed</b> in m/s (as the robot told it, else its fastest step), <b>count</b> of positions.
    The measure M of each vertex is its time in seconds since 1970. Lengths are measured in the layer's
    CRS if that is in true metres, as robots drive them, else on its ellipsoid.</p>
    <p>The layer's times are set: open QGIS's temporal controller to play them.</p>
    <pre>qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions"
    OUTPUT=lines.gpkg</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        points = QgsProcessing.SourceType.TypeVectorPoint
        self.addParameter(QgsProcessingParameterFeatureSource(INPUT, tr("Positions"), [points]))
        fields = (
            (ROBOT_FIELD, tr("Field of the robot"), "robot"),
            (TIME_FIELD, tr("Field of the time"), "time"),
        )
        for name, title, default in fields:
            self.addParameter(QgsProcessingParameterField(name, title, default, INPUT, optional=True))
        self.addParameter(
            QgsProcessingParameterField(
                SPEED_FIELD, tr("Field of the speed [m/s]"), SPEED, INPUT, optional=True
            )
        )
        real = QgsProcessingParameterNumber.Type.Double
        title = tr("Longest gap in a line [s]")
        self.addParameter(QgsProcessingParameterNumber(GAP, title, real, 60.0, minValue=0.001))
        self.addParameter(QgsProcessingParameterBoolean(STEPS, tr("A line for each step"), False))
        lines = QgsProcessing.SourceType.TypeVectorLine
        self.addParameter(QgsProcessingParameterFeatureSink(OUTPUT, tr("Trajectories"), lines))
        for name, title in {**NUMBERS, "WARNING_COUNT": tr("Warnings")}.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_FIELDS)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        source = self.parameterAsSource(parameters, INPUT, context)
        if source is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, INPUT))
        with shown_by_processing(feedback):
            names = [
                self.parameterAsString(parameters, n, context) for n in (ROBOT_FIELD, TIME_FIELD, SPEED_FIELD)
            ]
            positions_in = PositionSource(source, *names)
            read = positions_in.read(feedback)
            if read is None:
                return {}
            positions, odd = read
            if odd:
                feedback.pushWarning(
                    tr_count(
                        odd,
                        "1 feature has no place, robot or time; it is left out.",
                        "%n features have no place, robot or time; they are left out.",
                    )
                )
            _warn_of_speeds(positions_in.odd_speeds, names[-1], feedback)
            metres = Metres(source.sourceCrs(), context.transformContext())
            made = self._write(parameters, context, feedback, source, positions, metres)
        if made is None:
            return {}
        layer, lines, length = made
        self.remember({OUTPUT: layer})
        feedback.pushInfo(
            tr(
                "{lines} of {positions}, {length:.1f} m in all.",
                lines=tr_count(lines, "1 line", "%n lines"),
                positions=tr_count(len(positions), "1 position", "%n positions"),
                length=length,
            )
        )
        counts = dict(zip(NUMBERS, (lines, len(positions), length), strict=True))
        return {OUTPUT: layer, **counts, "WARNING_COUNT": int(odd > 0) + int(positions_in.odd_speeds > 0)}

    def _write(
        self,
        parameters: Parameters,
        context: QgsProcessingContext,
        feedback: QgsProcessingFeedback,
        source: QgsProcessingFeatureSource,
        positions: PositionArrays,
        metres: Metres,
    ):
        """Return the layer, the number of lines written and their length; None if cancelled."""
        kind = QgsWkbTypes.Type.LineStringM
        sink, layer = self.parameterAsSink(
            parameters, OUTPUT, context, self._fields, kind, source.sourceCrs()
        )
        gap = self.parameterAsDouble(parameters, GAP, context)
        steps = self.parameterAsBoolean(parameters, STEPS, context)
        lines, done, length, rows = 0, 0, 0.0, []
        for drive in drives(positions, gap, steps=steps):
            along = metres.of(drive.xy)
            rows.append((_line(drive), _values(drive, along)))
            length += float(along.sum())
            lines += 1
            done += len(drive.times)
            if len(rows) == AT_ONCE:
                if not fill_sink(sink, self._fields, rows, feedback):
                    return None
                rows = []
                feedback.setProgress(min(99.0, 60.0 + 40.0 * done / max(len(positions), 1)))
        return (layer, lines, length) if fill_sink(sink, self._fields, rows, feedback) else None


def _warn_of_speeds(odd: int, name: str, feedback: QgsProcessingFeedback) -> None:
    if odd:
        feedback.pushWarning(
            tr_count(
                odd,
                "1 value of the field {name} is no number, and counts as no speed.",
                "%n values of the field {name} are no numbers, and count as no speed.",
                name=name,
            )
        )


class Metres:
    """Measures steps: in the CRS where its units are metres on the ground, else on its ellipsoid."""

    def __init__(self, crs: QgsCoordinateReferenceSystem, transforms: QgsCoordinateTransformContext) -> None:
        # Without a CRS positions are the site's metres; a GeoPackage would have them in degrees.
        crs = stated_crs(crs)
        true = crs.mapUnits() == QgsUnitTypes.DistanceUnit.DistanceMeters and not crs.isGeographic()
        self._measure = None
        if crs.isValid() and (not true or is_mercator(crs)):
            self._measure = QgsDistanceArea()
            self._measure.setSourceCrs(crs, transforms)
            self._measure.setEllipsoid(crs.ellipsoidAcronym() or "WGS84")

    def of(self, xy: np.ndarray) -> np.ndarray:
        """Return the (n - 1,) metres from each of (n, 2) ``xy`` to the next."""
        if self._measure is None:
            return np.hypot(*np.diff(xy, axis=0).T)
        points = [QgsPointXY(x, y) for x, y in xy.tolist()]
        pairs = zip(points, points[1:])  # noqa: B905, RUF007
        return np.array([self._measure.measureLine(a, b) for a, b in pairs])


def _line(drive: RobotDrive) -> QgsGeometry:
    rows = np.column_stack([drive.xy, drive.times]).tolist()
    return QgsGeometry(QgsLineString([QgsPoint(x, y, m=at) for x, y, at in rows]))


def _values(drive: RobotDrive, steps: np.ndarray) -> list:
    length = float(steps.sum())
    return [
        drive.robot,
        _utc_datetime(drive.times[0]),
        _utc_datetime(drive.times[-1]),
        drive.seconds,
        length,
        length / drive.seconds,
        drive.top_speed(steps),
        len(drive.times),
    ]


def _utc_datetime(at: float) -> QDateTime:
    """Return seconds since 1970 as a date and time in UTC."""
    return QDateTime.fromMSecsSinceEpoch(round(at * 1000), Qt.TimeSpec.UTC)
