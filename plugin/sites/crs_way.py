"""Whether anything is known of how two CRSs lie to one another."""

from __future__ import annotations

from qgis.core import QgsCoordinateTransform, QgsCsException

from ..language import tr


def check_way(way: QgsCoordinateTransform) -> None:
    """Refuse a ``way`` of which nothing is known, such as one from or to the metres of a local CRS.

    QGIS leaves coordinates as they are there: degrees become metres. Where an end has no CRS at all nothing
    is to be done, and that is no error.

    :raises QgsCsException: when both ends have a CRS and no operation leads from one to the other.
    """
    if way.sourceCrs().isValid() and way.destinationCrs().isValid() and not way.isValid():
        raise QgsCsException(tr("nothing is known of how the two lie to each other"))
