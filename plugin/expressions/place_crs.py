"""Which CRS a place in an expression is in."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsCoordinateReferenceSystem, QgsProject

from ..errors import FleetError
from ..language import tr


def crs_of_place(given: Any, of_layer: Any) -> QgsCoordinateReferenceSystem:
    """Return the CRS of a place: as given, that of the layer that is looked at, that of the project.

    :raises FleetError: when QGIS does not know the one that is given.
    """
    if given is not None:
        crs = QgsCoordinateReferenceSystem(str(given))
        if not crs.isValid():
            raise FleetError(
                tr("crs {given!r} is no CRS that QGIS knows; write a code such as 'EPSG:32633'", given=given)
            )
        return crs
    crs = QgsCoordinateReferenceSystem(str(of_layer or ""))
    return crs if crs.isValid() else QgsProject.instance().crs()
