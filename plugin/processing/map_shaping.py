"""The parameters that reduce outlines to what a robot needs, before a map is built of them."""

from __future__ import annotations

import math

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterNumber,
)

from ...robot_bridge.robotmap.dissolving import shapely_module
from ...robot_bridge.robotmap.shaping import Shaping
from ..language import tr
from .errors import ParameterError
from .fleet_algorithm import Parameters

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
_REAL = QgsProcessingParameterNumber.Type.Double


def shaping_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters: advanced, each off unless it is asked for."""
    described: list[tuple[QgsProcessingParameterDefinition, str]] = [
        *((QgsProcessingParameterNumber(n, t, _REAL, optional=True), h) for n, (t, h) in _HEIGHTS.items()),
        *((QgsProcessingParameterBoolean(n, t, defaultValue=False), h) for n, (t, h) in _FLAGS.items()),
        *((QgsProcessingParameterNumber(n, t, _REAL, 0.0), h) for n, (t, h) in _LENGTHS.items()),
    ]
    for parameter, help in described:
        parameter.setHelp(help)
    parameters = [parameter for parameter, _ in described]
    for parameter in parameters:
        parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagAdvanced)
    return parameters


def shaping_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> Shaping:
    """Return what is asked for.

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
    return Shaping(
        plane=_plane(algorithm, parameters, context),
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
