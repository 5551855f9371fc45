"""From the place of a robot map to layers beside it and to longitudes and latitudes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsLineString,
)

from ..language import tr
from ..sites.placing import SitePlacing
from ..sites.site_crs import is_engineering
from .errors import ParameterError
from .map_file import MapPlace

WGS_84 = "EPSG:4326"


@dataclass(frozen=True)
class PlacedMap:
    """Where a map lies, with the project's choice of transforms."""

    place: MapPlace
    transform_context: QgsCoordinateTransformContext

    @property
    def is_local(self) -> bool:
        """Whether the map's metres have no known place on the Earth."""
        return is_engineering(self.place.crs)

    @property
    def layers(self) -> SitePlacing:
        """How layers come into the site frame; beside a local map their coordinates are the site's."""
        return SitePlacing(self.place.crs, self.place.frame, self.transform_context, local=self.is_local)

    def to_lonlat(self, xy: np.ndarray) -> np.ndarray:
        """Return (n, 2) metres in the site frame as (n, 2) longitudes and latitudes (WGS 84).

        :raises ParameterError: when the map's place is not known, or PROJ cannot tell.
        """
        if self.is_local:
            raise ParameterError(
                tr(
                    "GeoJSON needs longitudes and latitudes, and the map's place is not known: give "
                    "SITE_CRS, ORIGIN and ROTATION, or choose geopackage, which keeps the site's metres."
                )
            )
        line = QgsLineString(*self.place.points(xy).T.tolist())
        target = QgsCoordinateReferenceSystem(WGS_84)
        try:
            line.transform(QgsCoordinateTransform(self.place.crs, target, self.transform_context))
        except QgsCsException as error:
            raise ParameterError(
                tr(
                    "The map's positions cannot be transformed from {crs} to longitudes and latitudes "
                    "({error}): check the map's lines crs, origin and rotation.",
                    crs=self.place.crs.authid(),
                    error=error,
                )
            ) from error
        wkb = line.asWkb().data()
        # 9 bytes come first: byte order, geometry type, number of points.
        return np.frombuffer(wkb, ("<" if wkb[0] else ">") + "f8", offset=9).reshape(-1, 2)
