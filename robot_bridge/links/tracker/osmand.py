"""The OsmAnd protocol, which Traccar Client and others speak over HTTP: texts in, fixes out; no I/O.

A report is the query of a GET or the form of a POST, or (newer clients) JSON. Speeds are knots in the first
and m/s in the second, batteries per cent and a fraction.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any
from urllib.parse import parse_qsl

from ...core.decoding import Bounds, DecodingError, decode_json
from ...messages import MessageError, SendGPS

KNOT = 0.514444
"""m/s."""
MOVING = 0.5
"""m/s above which a course over ground says which way somebody goes."""
MOST_FIELDS = 100
LONGEST_DEVICE = 64
MILLISECONDS_FROM = 1e11
"""A time stamp above this counts milliseconds: as seconds it would be in the year 5138."""
_JSON = Bounds(depth=12, length=256 << 10, values=5_000)


class ReportError(ValueError):
    """A report that cannot be understood; the text says what is wrong in it."""


@dataclass(frozen=True)
class Report:
    """Where a ``device``, as it calls itself, was."""

    device: str
    fix: SendGPS


def reports_in_form(text: str) -> list[Report]:
    """Return the report in a query or a form; raises ReportError."""
    try:
        fields = dict(parse_qsl(text, keep_blank_values=True, max_num_fields=MOST_FIELDS))
    except ValueError as error:
        raise ReportError(f"the report cannot be read: {error}") from None
    device = _device(fields.get("id") or fields.get("deviceid"))
    if fields.get("valid", "true").lower() not in ("true", "1"):
        raise ReportError("the device has no fix (valid)")
    lat, lon = fields.get("lat"), fields.get("lon")
    if "location" in fields:
        lat, _, lon = fields["location"].partition(",")
    speed = _number(fields, "speed")
    battery = _number(fields, "batt")
    return [
        _report(
            device,
            _needed("lat", lat),
            _needed("lon", lon),
            v=None if speed is None else speed * KNOT,
            course=_number(fields, "bearing" if "bearing" in fields else "heading"),
            altitude=_number(fields, "altitude"),
            accuracy=_number(fields, "accuracy"),
            battery=None if battery is None else battery / 100,
            fix_t=_time(fields.get("timestamp")),
        )
    ]


def reports_in_json(body: bytes) -> list[Report]:
    """Return the reports in a JSON body, of one location or of several; raises ReportError."""
    try:
        root = decode_json(body, _JSON)
    except DecodingError as error:
        raise ReportError(f"the report is not JSON: {error}") from None
    if not isinstance(root, dict):
        raise ReportError("the report is no JSON object")
    device = _device(root.get("device_id"))
    locations = root.get("location")
    return [_location(device, one) for one in (locations if isinstance(locations, list) else [locations])]


def _location(device: str, location: Any) -> Report:
    coords = location.get("coords") if isinstance(location, dict) else None
    if not isinstance(coords, dict):
        raise ReportError("location.coords is missing")
    battery = location.get("battery")
    return _report(
        device,
        _needed("location.coords.latitude", coords.get("latitude")),
        _needed("location.coords.longitude", coords.get("longitude")),
        v=_known(coords, "speed"),
        course=_known(coords, "heading"),
        altitude=_number(coords, "altitude"),
        accuracy=_known(coords, "accuracy"),
        battery=_known(battery, "level") if isinstance(battery, dict) else None,
        fix_t=_time(location.get("timestamp")),
    )


def _report(
    device: str,
    lat: float,
    lon: float,
    *,
    v: float | None,
    course: float | None,
    altitude: float | None,
    accuracy: float | None,
    battery: float | None,
    fix_t: float | None,
) -> Report:
    # Whoever stands has no course, and some receivers say 0 then, which would be north.
    heading = course % 360 if course is not None and v is not None and v > MOVING else None
    try:
        fix = SendGPS(
            lat,
            lon,
            altitude=altitude,
            heading=heading,
            v=v,
            fix_t=fix_t,
            accuracy=accuracy,
            battery=battery,
        )
    except MessageError as error:
        raise ReportError(str(error)) from None
    if not fix.has_fix:
        raise ReportError("lat and lon are 0: the device has no fix")
    return Report(device, fix)


def _device(value: Any) -> str:
    if isinstance(value, int) and not isinstance(value, bool):
        value = str(value)
    if not isinstance(value, str) or not 0 < len(value) <= LONGEST_DEVICE or not value.isprintable():
        raise ReportError(f"id is missing, or not 1 to {LONGEST_DEVICE} printable characters")
    return value


def _needed(name: str, value: Any) -> float:
    number = _number({name: value}, name)
    if number is None:
        raise ReportError(f"{name} is missing")
    return number


def _known(fields: Mapping[str, Any], name: str) -> float | None:
    """Return a number; phones say -1 for what they do not know."""
    number = _number(fields, name)
    return None if number is not None and number < 0 else number


def _number(fields: Mapping[str, Any], name: str) -> float | None:
    value = fields.get(name)
    if value is None or value == "":
        return None
    try:
        number = float(value) if not isinstance(value, (bool, list, dict)) else math.nan
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ReportError(f"{name} is {str(value)[:40]!r}; give a number")
    return number


def _time(value: Any) -> float | None:
    """Return a time stamp in seconds since 1970: seconds, milliseconds, or ISO 8601."""
    if value is None or value == "":
        return None
    try:
        number = float(value)
    except (TypeError, ValueError):
        return _moment(str(value))
    if not math.isfinite(number):
        raise ReportError(f"timestamp is {str(value)[:40]!r}; give seconds or a date")
    return number / 1000 if number > MILLISECONDS_FROM else number


def _moment(text: str) -> float:
    try:
        moment = datetime.fromisoformat(text.strip())
        return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        raise ReportError(f"timestamp is {text[:40]!r}; give seconds or a date") from None
