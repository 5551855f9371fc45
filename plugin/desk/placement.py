"""From the site frame to the canvas and back, many points at once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsPointXY,
)

from ...robot_bridge.messages import SiteReport
from ...robot_bridge.sites.frame import SiteFrame
from ..errors import PlacementError
from ..language import tr
from ..sites.crs_way import check_way
from ..sites.many_points import moved_together
from ..sites.site_crs import crs_name

Points = npt.NDArray[np.float64]


def frame_of(site: SiteReport) -> SiteFrame:
    """Return the frame of a site as the gateway tells of it."""
    return SiteFrame(site.crs, site.origin, site.rotation)


class Placement:
    """Site frame → site CRS → a map's CRS, and back.

    :raises PlacementError: when QGIS does not know the site's CRS.
    """

    def __init__(
        self,
        site: SiteReport,
        map_crs: QgsCoordinateReferenceSystem,
        context: QgsCoordinateTransformContext,
    ):
        self.site_crs = QgsCoordinateReferenceSystem(site.crs)
        if not self.site_crs.isValid():
            raise PlacementError(
                tr(
                    "The site {name} is in the CRS {crs}, which this QGIS does not know: its robots cannot "
                    "be placed on the map. Correct crs in the site's site.toml, or update QGIS.",
                    name=site.name,
                    crs=site.crs,
                )
            )
        self.site = site
        self.map_crs = map_crs
        self._context = context
        self.frame = frame_of(site)
        self._forward = QgsCoordinateTransform(self.site_crs, map_crs, context)

    def leads_to(self, crs: QgsCoordinateReferenceSystem, context: QgsCoordinateTransformContext) -> bool:
        """Tell whether this is the way to ``crs`` by the operations that ``context`` prefers."""
        return self.map_crs == crs and self._context == context

    def to_map(self, xy: Points) -> Points:
        """Return (n, 2) metres in the site frame as (n, 2) coordinates of the map's CRS.

        :raises PlacementError: when a point cannot be expressed in the map's CRS.
        """
        return transformed(self.frame.to_crs(xy), self._forward)

    @property
    def axes(self) -> Points | None:
        """The site's x and y, a metre of each in the map's CRS as a row of (2, 2); None unless they are the
        same all over the map, as they are in the site's own CRS.
        """
        return self.frame.axes() if self._forward.isShortCircuited() else None

    def to_site(self, point: QgsPointXY) -> tuple[float, float]:
        """Return a point in the map's CRS as metres in the site frame.

        :raises PlacementError: when the point cannot be expressed in the site's CRS.
        """
        try:
            check_way(self._forward)
            in_site_crs = self._forward.transform(point, Qgis.TransformDirection.Reverse)
        except QgsCsException as error:
            raise _out_of_reach(self.map_crs, self.site_crs, error) from error
        ((x, y),) = self.frame.to_site([(in_site_crs.x(), in_site_crs.y())])
        return float(x), float(y)


def transformed(xy: Points, transform: QgsCoordinateTransform) -> Points:
    """Return (n, 2) coordinates through ``transform``, as one line string and not point by point.

    :raises PlacementError: when a point has no place in the target CRS.
    """
    try:
        out = moved_together(xy, transform)
    except QgsCsException as error:
        raise _out_of_reach(transform.sourceCrs(), transform.destinationCrs(), error) from error
    if not np.isfinite(out).all():
        raise _out_of_reach(transform.sourceCrs(), transform.destinationCrs(), tr("not a finite place"))
    return out


def _out_of_reach(
    source: QgsCoordinateReferenceSystem, target: QgsCoordinateReferenceSystem, error: object
) -> PlacementError:
    return PlacementError(
        tr(
            "A position in {crs} has no place in {target} ({error}). Choose the site's CRS as the "
            "project's CRS (bottom right in the QGIS window).",
            crs=crs_name(source),
            target=crs_name(target),
            error=error,
        )
    )
