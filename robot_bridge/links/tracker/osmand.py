"""OsmAnd protocol over HTTP, as used by Traccar Client: server, requests, fixes."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from ...core.json_decoder import DecodingError, JsonBounds, decode_json
from ...core.messages.base import MessageError
from ...core.messages.robots import SendGPS

# --- The OsmAnd protocol of Traccar Client and others over HTTP: texts in, fixes out; no I/O
# A report is the query of a GET or the form of a POST, or (newer clients) JSON. Speeds are knots in the
# first
# and m/s in the second, batteries per cent and a fraction.

KNOT = 0.514444
"""m/s."""
MOVING = 0.5
"""m/s above which a course over ground is used as the heading."""
MOST_FIELDS = 100
LONGEST_DEVICE = 64
MILLISECONDS_FROM = 1e11
"""A time stamp above this counts milliseconds: as seconds it would be in the year 5138."""
_JSON = JsonBounds(depth=12, length=256 << 10, values=5_000)


class ReportError(ValueError):
    """An invalid report; the text says what is wrong with it."""


@dataclass(frozen=True)
class TrackerReport:
    """A position of a ``device``, under its own id."""

    device: str
    fix: SendGPS


def reports_in_form(text: str) -> list[TrackerReport]:
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


def reports_in_json(body: bytes) -> list[TrackerReport]:
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


def _location(device: str, location: Any) -> TrackerReport:
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
) -> TrackerReport:
    # A standing device has no course, and some receivers send 0 then, which would be north.
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
    return TrackerReport(device, fix)


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
    """Return a number; phones send -1 for unknown values."""
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


# --- The HTTP server for phones: small requests, answered at once, each bounded in size and time

log = logging.getLogger(__name__)

MOST_CONNECTIONS = 500
REQUEST_WITHIN = 15.0
"""seconds for a request, from its first byte to its last, and for the next one on the same connection."""
LARGEST_HEAD = 16 << 10
LARGEST_BODY = 256 << 10

Accept = Callable[[TrackerReport], None]
"""Receives a report; raises ReportError for a rejected one."""


class RequestError(Exception):
    """An invalid request; the connection is closed after the answer."""

    def __init__(self, status: str, text: str) -> None:
        super().__init__(text)
        self.status = status


class HttpReports:
    """Answers phones: 200 for an accepted report, 400 with the reason for a rejected one."""

    def __init__(self, accept: Accept) -> None:
        self._accept = accept
        self._open = 0

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve one connection to its end."""
        self._open += 1
        try:
            if self._open > MOST_CONNECTIONS:
                await _answer(writer, "503 Service Unavailable", "too many connections", goes_on=False)
                return
            while await self._request(reader, writer):
                pass
        except (OSError, EOFError, TimeoutError, ValueError):
            # The client disconnected within a request, or never completed one.
            return
        finally:
            self._open -= 1
            writer.close()
            with contextlib.suppress(OSError):
                await writer.wait_closed()

    async def _request(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bool:
        """Process one request; return whether the client may send another."""
        try:
            async with asyncio.timeout(REQUEST_WITHIN):
                method, target, headers = _head(await _head_of(reader))
                body = await reader.readexactly(_length(headers))
            for report in _reports(method, target, headers, body):
                self._accept(report)
        except RequestError as error:
            await _answer(writer, error.status, str(error), goes_on=False)
            return False
        except ReportError as error:
            goes_on = headers.get("connection", "").lower() != "close"
            await _answer(writer, "400 Bad Request", str(error), goes_on=goes_on)
            return goes_on
        goes_on = headers.get("connection", "").lower() != "close"
        await _answer(writer, "200 OK", "", goes_on=goes_on)
        return goes_on


async def _head_of(reader: asyncio.StreamReader) -> bytes:
    try:
        return await reader.readuntil(b"\r\n\r\n")
    except asyncio.LimitOverrunError:
        raise RequestError("431 Request Header Fields Too Large", "the request is too large") from None


def _head(head: bytes) -> tuple[str, str, dict[str, str]]:
    lines = head.decode("latin-1").split("\r\n")
    parts = lines[0].split(" ")
    if len(parts) != 3 or not parts[2].startswith("HTTP/1."):
        raise RequestError("400 Bad Request", "this is no HTTP request")
    headers = {}
    for line in lines[1:]:
        name, colon, value = line.partition(":")
        if colon:
            headers[name.strip().lower()] = value.strip()
    if parts[2] == "HTTP/1.0":
        headers.setdefault("connection", "close")
    return parts[0], parts[1], headers


def _length(headers: dict[str, str]) -> int:
    if "transfer-encoding" in headers:
        raise RequestError("411 Length Required", "say how long the body is (Content-Length)")
    text = headers.get("content-length", "0")
    if not (text.isascii() and text.isdigit() and len(text) < 12):
        raise RequestError("400 Bad Request", "Content-Length is no number")
    if int(text) > LARGEST_BODY:
        raise RequestError("413 Content Too Large", f"a body has at most {LARGEST_BODY} bytes")
    return int(text)


def _reports(method: str, target: str, headers: dict[str, str], body: bytes) -> list[TrackerReport]:
    if method not in ("GET", "POST"):
        raise RequestError("405 Method Not Allowed", "report with GET or POST")
    try:
        query = urlsplit(target).query
    except ValueError:
        raise RequestError("400 Bad Request", "the address cannot be read") from None
    if method == "POST" and (headers.get("content-type", "").startswith("application/json")):
        return reports_in_json(body)
    return reports_in_form(query or body.decode("utf-8", "replace"))


async def _answer(writer: asyncio.StreamWriter, status: str, text: str, *, goes_on: bool) -> None:
    content = f"{text}\n".encode() if text else b""
    head = (
        f"HTTP/1.1 {status}\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {len(content)}\r\n"
        f"Connection: {'keep-alive' if goes_on else 'close'}\r\n\r\n"
    )
    writer.write(head.encode() + content)
    async with asyncio.timeout(REQUEST_WITHIN):
        await writer.drain()
