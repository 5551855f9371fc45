"""Coordinates as people type them, in any CRS: parsed, transformed to the site, with their accuracy."""

from __future__ import annotations

import math
import re

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsPointXY,
)

from ...robot_bridge.core.messages.administration import SiteReport
from ..layers.site_transform import SiteToMapTransform
from ..ui.errors import FleetError, MapTransformError
from ..ui.language import tr
from .pending_command import Point

_NUMBER = r"\d+(?:[.,]\d+)?"
_ANGLE = re.compile(
    rf"""(?P<before>[NSEWO])?\s*(?P<sign>[-+−])?\s*
    (?P<degrees>{_NUMBER})\s*(?:°|º|deg|d)?\s*
    (?:(?P<minutes>{_NUMBER})\s*(?:'|′|’|m(?![a-z]))\s*)?
    (?:(?P<seconds>{_NUMBER})\s*(?:"|″|”|''|s(?![a-z]))\s*)?
    (?P<after>[NSEWO](?![a-z]))?""",
    re.VERBOSE | re.IGNORECASE,
)
_WORDS = re.compile(r"\b(lat(itude)?|lon(gitude)?|lng|x|y|easting|northing)\b\s*[:=]?\s*", re.IGNORECASE)


class PlaceTextError(FleetError):
    """A text is not a pair of coordinates."""


def read_place(text: str, *, geographic: bool) -> tuple[float, float]:
    """Return x, y of a text: longitude, latitude in degrees where ``geographic``, else easting, northing.

    In geographic texts latitude comes first unless letters say otherwise: ``48.2, 16.37``; ``48,2; 16,37``;
    ``N 48° 12' 30.5"  E 16° 22'``; ``16.37E 48.2N``. Others say x first.

    :raises PlaceTextError: naming the text read and the form expected.
    """
    pair = _halves(_WORDS.sub("", text.strip().strip("()[]")))
    if pair is None:
        raise _wrong(text, geographic)
    (first, letter), (second, other) = pair
    if not geographic:
        if letter or other:
            raise _wrong(text, geographic)
        return first, second
    lat, lon = first, second
    if letter in ("E", "W") or other in ("N", "S"):
        lat, lon = second, first
    if (letter in ("N", "S")) == (other in ("N", "S")) and letter and other:
        raise _wrong(text, geographic)
    if not (-90 <= lat <= 90 and -180 <= lon <= 180):
        raise PlaceTextError(
            tr(
                "{text!r}: latitude {lat:g} and longitude {lon:g} are not on the earth; write latitude "
                "first, or choose the CRS that the numbers are in.",
                text=text.strip(),
                lat=lat,
                lon=lon,
            )
        )
    return lon, lat


def _halves(text: str) -> tuple[tuple[float, str], tuple[float, str]] | None:
    for pattern in (r"\s*;\s*", r"\s*,\s+", r"\s*,\s*", r"\s*\t\s*"):
        parts = [part for part in re.split(pattern, text) if part]
        first, second = map(_angle, parts) if len(parts) == 2 else (None, None)
        if first is not None and second is not None:
            return first, second
    # Without a separator: split where two complete angles are adjacent.
    for gap in re.finditer(r"\s+", text):
        first, second = _angle(text[: gap.start()]), _angle(text[gap.end() :])
        if first is not None and second is not None:
            return first, second
    return None


def _angle(text: str) -> tuple[float, str] | None:
    """Return the number of one half, negative for south and west, and its letter."""
    found = _ANGLE.fullmatch(text.strip())
    if found is None or (found["before"] and found["after"]):
        return None
    minutes, seconds = (_value(found[name] or "0") for name in ("minutes", "seconds"))
    if minutes >= 60 or seconds >= 60:
        return None
    value = _value(found["degrees"]) + minutes / 60 + seconds / 3600
    # O is west in Spanish and Catalan, and east in German: only unambiguous letters are accepted.
    letter = (found["before"] or found["after"] or "").upper()
    if letter == "O" or (letter and found["sign"]):
        return None
    return (-value if found["sign"] in ("-", "−") or letter in ("S", "W") else value), letter


def _value(text: str) -> float:
    return float(text.replace(",", "."))


def _wrong(text: str, geographic: bool) -> PlaceTextError:
    shown = text.strip()[:60]
    right = tr("x, y, as in 488070.50, 5190055.20")
    if geographic:
        right = tr("latitude, longitude, as in 48.2083, 16.3725")
    return PlaceTextError(tr("{shown!r} is no place: write {right}.", shown=shown, right=right))


FURTHEST_M = 10_000.0
"""Metres outside the site's bounds up to which a place is accepted: beyond that the numbers are wrong."""


class FarPlaceError(FleetError):
    """Coordinates of a valid place that is nowhere near the site."""


def read_site_place(
    text: str,
    crs: QgsCoordinateReferenceSystem,
    site: SiteReport,
    context: QgsCoordinateTransformContext,
) -> Point:
    """Return the place that ``text`` names in ``crs``, as metres in the site frame.

    :raises PlaceTextError: when the text is no pair of coordinates.
    :raises FarPlaceError: when the place is far from the site, or the site holds it with the numbers swapped.
    :raises MapTransformError: when the place cannot be expressed in the site's CRS.
    """
    transform = SiteToMapTransform(site, crs, context)
    x, y = read_place(text, geographic=crs.isGeographic())
    swapped = _swapped_pair(x, y, crs)
    try:
        point = transform.to_site(QgsPointXY(x, y))
    except MapTransformError:
        if _is_inside(swapped, transform):
            raise _swapped_error(text, swapped, site, crs) from None
        raise
    away = metres_outside(point, site)
    if away and _is_inside(swapped, transform):
        raise _swapped_error(text, swapped, site, crs)
    if away > FURTHEST_M:
        raise _far_error(text, away, site, crs)
    return point


def metres_outside(point: Point, site: SiteReport) -> float:
    """Return the distance of a place in the site frame from the site's bounds; 0 inside them."""
    x_min, y_min, x_max, y_max = site.bounds
    x, y = point
    return math.hypot(max(x_min - x, 0.0, x - x_max), max(y_min - y, 0.0, y - y_max))


def _swapped_pair(x: float, y: float, crs: QgsCoordinateReferenceSystem) -> Point | None:
    """Return the two numbers swapped, None where they are not a place then."""
    if crs.isGeographic() and abs(x) > 90:
        return None
    return y, x


def _is_inside(swapped: Point | None, transform: SiteToMapTransform) -> bool:
    if swapped is None:
        return False
    try:
        point = transform.to_site(QgsPointXY(*swapped))
    except MapTransformError:
        return False
    return not metres_outside(point, transform.site)


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
