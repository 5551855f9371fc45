"""Points and extents that parameters give, brought into one CRS."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
)

from ..language import tr
from ..sites.crs_way import check_way
from ..sites.site_crs import crs_name
from .errors import ParameterError
from .fleet_algorithm import Parameters


def point_in(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    name: str,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
) -> tuple[float, float]:
    """Return the point of the parameter ``name`` in ``crs``; one that names no CRS is in it already.

    :raises ParameterError: when it has no place there: QGIS itself would take degrees for metres.
    """
    point = algorithm.parameterAsPoint(parameters, name, context)
    # A context without a project, or a point that names no CRS would be in the project's.
    own = algorithm.parameterAsPointCrs(parameters, name, QgsProcessingContext())
    if own.isValid() and own != crs:
        way = _way(name, parameters.get(name), own, crs, context)
        try:
            point = way.transform(point)
        except QgsCsException as error:
            raise _no_place(name, parameters.get(name), crs) from error
    if not (math.isfinite(point.x()) and math.isfinite(point.y())):
        raise _no_place(name, parameters.get(name), crs)
    return point.x(), point.y()


def extent_in(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    name: str,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
) -> np.ndarray:
    """Return the outline, (n, 2) in ``crs``, of the extent of the parameter ``name``.

    :raises ParameterError: when it is none, or has no place there.
    """
    own = algorithm.parameterAsExtentCrs(parameters, name, QgsProcessingContext())
    if own.isValid():
        _way(name, parameters.get(name), own, crs, context)
    outline = algorithm.parameterAsExtentGeometry(parameters, name, context, crs)
    corners = np.array([(vertex.x(), vertex.y()) for vertex in outline.vertices()])
    if not len(corners):
        raise ParameterError(
            tr(
                "{name} {extent} is no extent: write 'xmin,xmax,ymin,ymax'.",
                name=name,
                extent=parameters.get(name),
            )
        )
    if not np.isfinite(corners).all():
        raise _no_place(name, parameters.get(name), crs)
    return corners


def _way(
    name: str,
    value: Any,
    own: QgsCoordinateReferenceSystem,
    crs: QgsCoordinateReferenceSystem,
    context: QgsProcessingContext,
) -> QgsCoordinateTransform:
    way = QgsCoordinateTransform(own, crs, context.transformContext())
    try:
        check_way(way)
    except QgsCsException as error:
        raise ParameterError(
            tr(
                "{name} {value} is in the CRS {own}, which has no known relation to the CRS {crs}: give it "
                "in that one.",
                name=name,
                value=value,
                own=crs_name(own),
                crs=crs_name(crs),
            )
        ) from error
    return way


def _no_place(name: str, value: Any, crs: QgsCoordinateReferenceSystem) -> ParameterError:
    return ParameterError(
        tr(
            "{name} {value} has no place in the CRS {crs}: give finite numbers, x or longitude first, and "
            "the CRS that they are in.",
            name=name,
            value=value,
            crs=crs_name(crs),
        )
    )
