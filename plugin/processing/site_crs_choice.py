"""The CRS of the site, as an algorithm's parameters, its layers and the project say it."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.core import QgsCoordinateReferenceSystem, QgsProcessingAlgorithm, QgsProcessingContext

from ..language import tr
from ..sites.site_crs import site_crs_for, stated_crs
from .errors import ParameterError
from .fleet_algorithm import Parameters

SITE_CRS = "SITE_CRS"


def given_crs(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> QgsCoordinateReferenceSystem:
    """Return SITE_CRS, invalid where it is not given.

    :raises ParameterError: when QGIS does not know it.
    """
    crs = algorithm.parameterAsCrs(parameters, SITE_CRS, context)
    if parameters.get(SITE_CRS) and not crs.isValid():
        raise ParameterError(
            tr(
                "SITE_CRS {crs} is no CRS that QGIS knows: write a code such as EPSG:32633.",
                crs=parameters[SITE_CRS],
            )
        )
    return crs


def chosen_crs(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    layers: Sequence[QgsCoordinateReferenceSystem],
    *,
    layer_first: bool = False,
) -> QgsCoordinateReferenceSystem:
    """Return the CRS of the site: SITE_CRS, else the project's or the layers' own.

    With ``layer_first`` that of the first layer comes before the project's, unless it is in degrees. The
    result is invalid when no CRS is known at all.

    :raises FleetError: when SITE_CRS is no CRS, or what is chosen cannot carry a site.
    """
    chosen, own = given_crs(algorithm, parameters, context), [stated_crs(crs) for crs in layers]
    if layer_first and not chosen.isValid() and own and own[0].isValid() and not own[0].isGeographic():
        chosen = own[0]
    project = context.project()
    return site_crs_for(chosen, QgsCoordinateReferenceSystem() if project is None else project.crs(), own)
