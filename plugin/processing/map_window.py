"""The window of a robot map, and the frame it lies in, from an algorithm's parameters."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExtent,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
)

from ...robot_bridge.robotmap.builder import Window
from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from ..sites.project_site import frame_in_project
from ..sites.site_crs import crs_name
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .places import extent_in, point_in
from .site_crs_choice import SITE_CRS

CENTER, WIDTH, HEIGHT, EXTENT = "CENTER", "WIDTH", "HEIGHT", "EXTENT"
ORIGIN, ROTATION, LOCAL = "ORIGIN", "ROTATION", "LOCAL"
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
    return [_advanced(parameter) for parameter in _frame_parameters()]


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


def _frame_parameters() -> list[QgsProcessingParameterDefinition]:
    return [
        QgsProcessingParameterCrs(
            SITE_CRS, tr("Site CRS, in metres (default: the project's, else the layers')"), optional=True
        ),
        QgsProcessingParameterPoint(
            ORIGIN, tr("Origin of the site frame (default: as the project has it, else 0,0)"), optional=True
        ),
        QgsProcessingParameterNumber(
            ROTATION,
            tr("Rotation of the site frame, counter-clockwise from the CRS's x axis [degrees]"),
            _REAL,
            optional=True,
        ),
        QgsProcessingParameterBoolean(
            LOCAL, tr("Layers without a CRS are in metres of the site"), defaultValue=False
        ),
    ]


def _advanced(parameter: QgsProcessingParameterDefinition) -> QgsProcessingParameterDefinition:
    parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagAdvanced)
    return parameter


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
