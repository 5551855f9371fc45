"""Places of the site from coordinates that were typed or pasted in any CRS."""

from __future__ import annotations

import math

from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransformContext, QgsPointXY

from ....robot_bridge.messages import SiteReport
from ...errors import FleetError, PlacementError
from ...language import tr
from ..drafts import Point
from ..placement import Placement
from .place_text import read_place

FURTHEST_M = 10_000.0
"""Metres outside the site's bounds up to which a place is accepted: further off, the numbers are wrong."""


class FarPlaceError(FleetError):
    """Coordinates that are a place, but nowhere near the site."""


def read_site_place(
    text: str,
    crs: QgsCoordinateReferenceSystem,
    site: SiteReport,
    context: QgsCoordinateTransformContext,
) -> Point:
    """Return the place that ``text`` names in ``crs``, as metres in the site frame.

    :raises PlaceTextError: when the text is no pair of coordinates.
    :raises FarPlaceError: when the place is far from the site, or the site holds it with the numbers swapped.
    :raises PlacementError: when the place cannot be expressed in the site's CRS.
    """
    placement = Placement(site, crs, context)
    x, y = read_place(text, geographic=crs.isGeographic())
    swapped = _swapped_pair(x, y, crs)
    try:
        point = placement.to_site(QgsPointXY(x, y))
    except PlacementError:
        if _is_inside(swapped, placement):
            raise _swapped_error(text, swapped, site, crs) from None
        raise
    away = metres_outside(point, site)
    if away and _is_inside(swapped, placement):
        raise _swapped_error(text, swapped, site, crs)
    if away > FURTHEST_M:
        raise _far_error(text, away, site, crs)
    return point


def metres_outside(point: Point, site: SiteReport) -> float:
    """Return how far a place of the site frame is from the site's bounds; 0 inside them."""
    x_min, y_min, x_max, y_max = site.bounds
    x, y = point
    return math.hypot(max(x_min - x, 0.0, x - x_max), max(y_min - y, 0.0, y - y_max))


def _swapped_pair(x: float, y: float, crs: QgsCoordinateReferenceSystem) -> Point | None:
    """Return the same two numbers the other way round, None where they are no place then."""
    if crs.isGeographic() and abs(x) > 90:
        return None
    return y, x


def _is_inside(swapped: Point | None, placement: Placement) -> bool:
    if swapped is None:
        return False
    try:
        point = placement.to_site(QgsPointXY(*swapped))
    except PlacementError:
        return False
    return not metres_outside(point, placement.site)


def _swapped_error(
    text: str, swapped: Point, site: SiteReport, crs: QgsCoordinateReferenceSystem
) -> FarPlaceError:
    first, second = swapped[::-1] if crs.isGeographic() else swapped
    return FarPlaceError(
        tr(
            "{text!r} is not on the site {name}; with its two numbers swapped it is. Write {order}: "
            "{first:.10g}, {second:.10g}.",
            text=text.strip(),
            name=site.name,
            order=_order(crs),
            first=first,
            second=second,
        )
    )


def _far_error(text: str, away: float, site: SiteReport, crs: QgsCoordinateReferenceSystem) -> FarPlaceError:
    return FarPlaceError(
        tr(
            "{text!r} is {away:.0f} km outside the site {name}. Write {order}, and check the numbers and "
            "the CRS that they are in ({crs}).",
            text=text.strip(),
            away=away / 1000,
            name=site.name,
            order=_order(crs),
            crs=crs.authid(),
        )
    )


def _order(crs: QgsCoordinateReferenceSystem) -> str:
    return tr("latitude, longitude") if crs.isGeographic() else tr("x, y")
