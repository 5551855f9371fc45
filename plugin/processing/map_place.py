"""Where a robot map read from a file lies, in QGIS's words."""

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

from ...robot_bridge.robotmap.model import RobotMap
from ...robot_bridge.sites.errors import SiteError
from ...robot_bridge.sites.frame import SiteFrame
from ...robot_bridge.sites.map_frame import frame_of_map
from ..sites.placing import SitePlacing
from .errors import ParameterError

WGS_84 = "EPSG:4326"


@dataclass(frozen=True)
class MapPlace:
    """The site frame of a map and its CRS; ``frame`` is None where QGIS does not know the CRS."""

    frame: SiteFrame | None
    crs: QgsCoordinateReferenceSystem
    transform_context: QgsCoordinateTransformContext

    @property
    def placing(self) -> SitePlacing:
        """How layers come into the frame; without a CRS their coordinates are the site's."""
        frame = self.frame or SiteFrame("", (0.0, 0.0))
        return SitePlacing(self.crs, frame, self.transform_context, local=self.frame is None)

    def to_lonlat(self, xy: np.ndarray) -> np.ndarray:
        """Return (n, 2) metres in the site frame as (n, 2) longitudes and latitudes (WGS 84).

        :raises ParameterError: when the map does not say where it is, or PROJ cannot tell.
        """
        if self.frame is None:
            raise ParameterError(
                "GeoJSON needs longitudes and latitudes, and the map names no CRS that QGIS knows: export it "
                "with a site CRS and not strict, or choose geopackage, which keeps the site's metres."
            )
        line = QgsLineString(*self.frame.to_crs(xy).T.tolist())
        target = QgsCoordinateReferenceSystem(WGS_84)
        try:
            line.transform(QgsCoordinateTransform(self.crs, target, self.transform_context))
        except QgsCsException as error:
            raise ParameterError(
                f"The map's positions cannot be transformed from {self.frame.crs} to longitudes and "
                f"latitudes ({error}): check the map's lines crs, origin and rotation."
            ) from error
        wkb = bytes(line.asWkb())
        # 9 bytes come first: byte order, geometry type, number of points.
        return np.frombuffer(wkb, ("<" if wkb[0] else ">") + "f8", offset=9).reshape(-1, 2)


def place_of(robot_map: RobotMap, transform_context: QgsCoordinateTransformContext) -> MapPlace:
    """Return the place that the leading lines of a map give.

    :raises ParameterError: naming a line that is not what it must be.
    """
    try:
        frame = frame_of_map(robot_map.meta)
    except SiteError as error:
        raise ParameterError(str(error)) from error
    crs = QgsCoordinateReferenceSystem(frame.crs) if frame is not None else QgsCoordinateReferenceSystem()
    return MapPlace(frame if crs.isValid() else None, crs, transform_context)
