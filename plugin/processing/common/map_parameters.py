"""Parameters of a robot map: window and frame, format, simplification of outlines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExtent,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
)

from ....robot_bridge.core.robotmap.binary import CODEC_COLUMNS, CODEC_TEXT, encode
from ....robot_bridge.core.robotmap.model import Border, RobotMap, Window
from ....robot_bridge.core.robotmap.shaping import Shaping, shapely_module
from ....robot_bridge.core.robotmap.text_format import write_text
from ....robot_bridge.core.sites.frame import SiteFrame
from ...layers.crs import crs_name, frame_in_project
from ...ui.language import tr
from .algorithm import ParameterError, Parameters
from .parameters import (
    ORIGIN,
    ROTATION,
    advanced,
    enum_parameter,
    extent_in,
    frame_in_crs_parameters,
    point_in,
    site_crs_parameter,
)

# --- The window of a robot map, and the frame it lies in, from an algorithm's parameters ---

CENTER, WIDTH, HEIGHT, EXTENT = "CENTER", "WIDTH", "HEIGHT", "EXTENT"
LOCAL = "LOCAL"
PAPERS_SIDE_M = 100.0

_REAL = QgsProcessingParameterNumber.Type.Double


def window_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say where the map is and in which frame."""
    return [
        QgsProcessingParameterPoint(CENTER, tr("Centre of the window (or choose an extent)"), optional=True),
        QgsProcessingParameterNumber(WIDTH, tr("Width of the window, along x [m]"), _REAL, PAPERS_SIDE_M),
        QgsProcessingParameterNumber(HEIGHT, tr("Height of the window, along y [m]"), _REAL, PAPERS_SIDE_M),
        QgsProcessingParameterExtent(
            EXTENT, tr("Extent (instead of centre, width and height)"), optional=True
        ),
        *frame_parameters(),
    ]


def frame_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the advanced parameters that say which frame the site has."""
    title = tr("Site CRS, in metres (default: the project's, else the layers')")
    local = QgsProcessingParameterBoolean(
        LOCAL, tr("Layers without a CRS are in metres of the site"), defaultValue=False
    )
    return [advanced(one) for one in (site_crs_parameter(title), *frame_in_crs_parameters(), local)]


def window_problem(parameters: Parameters) -> str:
    """Return what is wrong with the choice of window, or nothing."""
    has_center, has_extent = _given(parameters, CENTER), _given(parameters, EXTENT)
    if has_center and has_extent:
        return tr("Both CENTER and EXTENT are given: give one of them, the window cannot be both.")
    if not has_center and not has_extent:
        return tr(
            "Neither CENTER nor EXTENT is given: give the centre of the window with WIDTH and HEIGHT in "
            "metres, or an extent."
        )
    for side in (WIDTH, HEIGHT):
        if not _is_number(parameters.get(side, PAPERS_SIDE_M)):
            return tr(
                "{side} is {length}: give a finite number of metres.", side=side, length=parameters[side]
            )
    return ""


def site_frame(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
) -> SiteFrame:
    """Return the site frame: from ORIGIN and ROTATION, else as the project has it, else ``crs`` itself."""
    name = crs.authid() or (crs_name(crs) if crs.isValid() else "")
    if not _given(parameters, ORIGIN) and not _given(parameters, ROTATION):
        known = frame_in_project(context.project(), crs) if context.project() is not None else None
        return known or SiteFrame(name, (0.0, 0.0))
    origin = (0.0, 0.0)
    if _given(parameters, ORIGIN):
        origin = point_in(algorithm, parameters, ORIGIN, context, crs)
    degrees = algorithm.parameterAsDouble(parameters, ROTATION, context)
    if not math.isfinite(degrees):
        raise ParameterError(tr("ROTATION {degrees} is not finite: give a number.", degrees=degrees))
    return SiteFrame(name, origin, math.radians(degrees))


def map_window(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
    frame: SiteFrame,
) -> Window:
    """Return the window in the site frame.

    Positions without a CRS of their own are in ``crs``. An extent whose sides are not parallel to the site's
    axes becomes the smallest window that holds it.

    :raises ParameterError: when the window has no place in ``crs``; WindowError when it encloses nothing.
    """
    if _given(parameters, EXTENT):
        corners = frame.to_site(extent_in(algorithm, parameters, EXTENT, context, crs))
        return Window.from_bounds(*_rounded(corners.min(axis=0)), *_rounded(corners.max(axis=0)))
    ((x, y),) = frame.to_site([point_in(algorithm, parameters, CENTER, context, crs)])
    return Window(
        float(x),
        float(y),
        algorithm.parameterAsDouble(parameters, WIDTH, context),
        algorithm.parameterAsDouble(parameters, HEIGHT, context),
    )


def _given(parameters: Parameters, name: str) -> bool:
    value = parameters.get(name)
    return value is not None and value != ""


def _is_number(value: Any) -> bool:
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        # None is the default, and QGIS knows more kinds of values than numbers, such as properties.
        return not isinstance(value, str)


def _rounded(corner: np.ndarray) -> list[float]:
    """Return the corner without the noise of a rotation there and back."""
    return [float(value) for value in np.round(corner, 6)]


# --- The parameters that say how a map is written: as text, or in one of the two binary codecs ---

FORMAT, STRICT = "FORMAT", "STRICT"
# No comma in a choice: QGIS would take it for two.
TEXT, BINARY, COMPACT = "text", "binary", "compact"
_CODECS = {TEXT: None, BINARY: CODEC_TEXT, COMPACT: CODEC_COLUMNS}
_NAMES = {
    TEXT: tr("text"),
    BINARY: tr("binary: the text compressed"),
    COMPACT: tr("compact: binary in columns"),
}
_NOTHING = RobotMap(Border(0.0, 0.0, 1.0, 1.0), ())


@dataclass(frozen=True)
class MapFormat:
    """How a map is written; ``codec`` is nothing for text."""

    codec: int | None = None
    strict: bool = False

    @property
    def suffix(self) -> str:
        """The end of a file's name."""
        return "txt" if self.codec is None else "rmap"

    def written(self, robot_map: RobotMap) -> tuple[str, bytes]:
        """Return the map's text, and the bytes of its file.

        :raises RobotMapError: when it cannot be written so, or a package for it is missing.
        """
        text = write_text(robot_map, strict=self.strict)
        if self.codec is None:
            return text, text.encode()
        whole = self.codec == CODEC_COLUMNS and not self.strict
        return text, encode(robot_map if whole else text, self.codec)


def format_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters."""
    title = tr("Format (compact: binary in columns, about a third of binary)")
    how = enum_parameter(FORMAT, title, _NAMES, TEXT)
    how.setHelp(
        tr(
            "text: lines that people and scripts read. binary: that text compressed, with a check sum. "
            "compact: the same map in columns of centimetres, also with a check sum (codec 2)."
        )
    )
    strict = QgsProcessingParameterBoolean(
        STRICT, tr("Bare map: no leading lines, no extras"), defaultValue=False
    )
    return [how, strict]


def read_map_format(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> MapFormat:
    """Return the chosen format.

    :raises MissingCodecError: when it needs a package that this Python does not have.
    """
    codec = _CODECS[algorithm.parameterAsEnumString(parameters, FORMAT, context)]
    chosen = MapFormat(codec, algorithm.parameterAsBool(parameters, STRICT, context))
    # Before the run: a city is read for nothing where its map cannot be written.
    chosen.written(_NOTHING)
    return chosen


# --- The parameters that reduce outlines to what a robot needs, before a map is built of them ---

PLANE_LOW, PLANE_HIGH, HEIGHT_STEP = "PLANE_LOW", "PLANE_HIGH", "HEIGHT_STEP"
DISSOLVE, CHAIN, TOLERANCE, SHORTEST = "DISSOLVE", "CHAIN", "TOLERANCE", "SHORTEST"

_HEIGHTS = {
    PLANE_LOW: (
        tr("Robot's plane from [m above the ground]"),
        tr(
            "What is not higher than this is left out: the robot drives over it. Stairs and ramps stay. "
            "Give the lower and the upper height together, or neither."
        ),
    ),
    PLANE_HIGH: (
        tr("Robot's plane up to [m above the ground]"),
        tr(
            "What begins at this height or above it is left out: the robot drives under it. Where things "
            "begin is said by the layers or by the parameter BASE_EXPRESSION."
        ),
    ),
}
_FLAGS = {
    DISSOLVE: (
        tr("Leave out walls that no robot outside can meet"),
        tr(
            "Those between buildings that touch, and lines inside or along buildings. What stays keeps its "
            "height and its source. Needs the Python package shapely 2."
        ),
    ),
    CHAIN: (
        tr("Join lines that meet end to end into one obstacle"),
        tr(
            "Only lines that are alike in height, label and all else. The source of a joined line is that "
            "of its first part and how many others are in it, such as walls:3+7."
        ),
    ),
}
_LENGTHS = {
    TOLERANCE: (
        tr("Fewer corners: how far an outline may then be from the drawn one [m]"),
        tr(
            "0 is off. An outline that would cross itself stays as it is. Needs the Python package shapely 2."
        ),
    ),
    SHORTEST: (
        tr("Shortest segment: corners nearer than this to the one before are left out [m]"),
        tr("0 is off. Ends of lines stay and rings keep three corners. Needs the Python package shapely 2."),
    ),
    HEIGHT_STEP: (
        tr("Heights are rounded up to a multiple of this [m]"),
        tr("0 is off. Half a metre makes a compact map smaller still, and no obstacle lower than it is."),
    ),
}


def shaping_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters: advanced, each off unless it is asked for."""
    described: list[tuple[QgsProcessingParameterDefinition, str]] = [
        *((QgsProcessingParameterNumber(n, t, _REAL, optional=True), h) for n, (t, h) in _HEIGHTS.items()),
        *((QgsProcessingParameterBoolean(n, t, defaultValue=False), h) for n, (t, h) in _FLAGS.items()),
        *((QgsProcessingParameterNumber(n, t, _REAL, 0.0), h) for n, (t, h) in _LENGTHS.items()),
    ]
    for parameter, help in described:
        parameter.setHelp(help)
    return [advanced(parameter) for parameter, _ in described]


def read_shaping(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> Shaping | None:
    """Return what is asked for, None for nothing.

    :raises ParameterError: when a value cannot be used.
    :raises MissingGeometryError: when something asked for needs a package that this Python does not have.
    """
    lengths = {name: algorithm.parameterAsDouble(parameters, name, context) for name in _LENGTHS}
    for name, value in lengths.items():
        if not 0 <= value < math.inf:
            raise ParameterError(
                tr("{name} is {value:g}: give a number of metres of 0 or more.", name=name, value=value)
            )
    dissolve, chain = (algorithm.parameterAsBool(parameters, name, context) for name in _FLAGS)
    if dissolve or lengths[TOLERANCE] or lengths[SHORTEST]:
        _check_shapely()
    plane = _plane(algorithm, parameters, context)
    if plane is None and not (dissolve or chain or any(lengths.values())):
        return None
    return Shaping(
        plane=plane,
        height_step=lengths[HEIGHT_STEP],
        dissolve=dissolve,
        chain=chain,
        tolerance=lengths[TOLERANCE],
        shortest=lengths[SHORTEST],
    )


def _plane(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> tuple[float, float] | None:
    given = [parameters.get(name) not in (None, "") for name in _HEIGHTS]
    if not any(given):
        return None
    if not all(given):
        missing, other = (PLANE_HIGH, PLANE_LOW) if given[0] else (PLANE_LOW, PLANE_HIGH)
        raise ParameterError(
            tr(
                "{other} is given and {missing} is not: give both heights in metres, or none.",
                other=other,
                missing=missing,
            )
        )
    low, high = (algorithm.parameterAsDouble(parameters, name, context) for name in _HEIGHTS)
    if not -math.inf < low < high < math.inf:
        raise ParameterError(
            tr(
                "PLANE_LOW is {low:g} and PLANE_HIGH {high:g}: give the lower and the upper height in "
                "metres.",
                low=low,
                high=high,
            )
        )
    return low, high


def _check_shapely() -> None:
    version = shapely_module().__version__
    if int(version.partition(".")[0]) < 2:
        raise ParameterError(
            tr(
                "DISSOLVE, TOLERANCE and SHORTEST need the Python package shapely 2, and {version} is "
                "installed here: install a newer one (python3 -m pip install 'shapely>=2'), or leave them "
                "off.",
                version=version,
            )
        )
