"""NMEA 0183 as GPS receivers speak it: sentences in, fixes out; no I/O.

A fix is told with RMC; GGA, GST and VTG before it say more about it. Of receivers that speak no RMC it is
told with GGA.
"""

from __future__ import annotations

import math
import re
from datetime import UTC, datetime, timedelta

from ...messages import MessageError, SendGPS
from .osmand import KNOT, MOVING, ReportError

LONGEST = 120
"""characters of a sentence; the standard has 82, and some receivers say more."""
_SENTENCE = re.compile(r"[$!]([A-Z]{2})([A-Z]{3}),([\x20-\x7e]*)\*([0-9A-Fa-f]{2})")
_UNCHECKED = re.compile(r"[$!][A-Z]{5},[^*]*")
WITHOUT_RMC = 3
"""GGA sentences in a row after which a receiver counts as one that says no RMC."""


class Receiver:
    """One receiver; ``feed`` it sentence by sentence."""

    def __init__(self) -> None:
        self._altitude: float | None = None
        self._accuracy: float | None = None
        self._day: datetime | None = None
        self._speed: float | None = None
        self._course: float | None = None
        self._without_rmc = 0

    def feed(self, line: str) -> SendGPS | None:
        """Return the fix that a sentence completes, None for most; raises ReportError for what is no NMEA."""
        fields, kind = _fields(line)
        if kind == "RMC":
            return self._rmc(fields)
        if kind == "GGA":
            return self._gga(fields)
        if kind == "GST":
            sigmas = [_number(one) for one in fields[5:7]]
            if len(sigmas) == 2 and None not in sigmas:
                self._accuracy = math.hypot(*(s for s in sigmas if s is not None)) / math.sqrt(2)
        elif kind == "VTG":
            self._course = _number(_at(fields, 0))
            knots = _number(_at(fields, 4))
            self._speed = None if knots is None else knots * KNOT
        return None

    def _rmc(self, fields: list[str]) -> SendGPS | None:
        self._without_rmc = 0
        if _at(fields, 1) != "A":
            return None
        self._day = _day(_at(fields, 8))
        knots = _number(_at(fields, 6))
        speed = self._speed if knots is None else knots * KNOT
        course = _number(_at(fields, 7))
        return self._fix(fields[2:6], _at(fields, 0), speed, self._course if course is None else course)

    def _gga(self, fields: list[str]) -> SendGPS | None:
        if _at(fields, 5) in ("", "0"):
            self._altitude = None
            return None
        above_sea, geoid = _number(_at(fields, 8)), _number(_at(fields, 10))
        self._altitude = None if above_sea is None or geoid is None else above_sea + geoid
        self._without_rmc += 1
        if self._without_rmc < WITHOUT_RMC:
            return None
        return self._fix(fields[1:5], _at(fields, 0), self._speed, self._course)

    def _fix(self, place: list[str], clock: str, speed: float | None, course: float | None) -> SendGPS:
        lat, lon = _degrees(_at(place, 0), _at(place, 1), 2), _degrees(_at(place, 2), _at(place, 3), 3)
        heading = course % 360 if course is not None and speed is not None and speed > MOVING else None
        altitude, accuracy, self._accuracy = self._altitude, self._accuracy, None
        try:
            return SendGPS(
                lat,
                lon,
                altitude=altitude,
                heading=heading,
                v=speed,
                fix_t=self._moment(clock),
                accuracy=accuracy,
            )
        except MessageError as error:
            raise ReportError(str(error)) from None

    def _moment(self, clock: str) -> float | None:
        """Return the time of a fix in seconds since 1970, None before the receiver has said the date."""
        if self._day is None or not re.fullmatch(r"\d{6}(\.\d{1,6})?", clock):
            return None
        seconds = int(clock[:2]) * 3600 + int(clock[2:4]) * 60 + float(clock[4:])
        return (self._day + timedelta(seconds=seconds)).timestamp()


def _fields(line: str) -> tuple[list[str], str]:
    """Return the fields of a sentence behind its name, and its kind; raises ReportError."""
    line = line.strip()
    if len(line) > LONGEST:
        raise ReportError(f"a sentence of {len(line)} characters; {LONGEST} are the most")
    found = _SENTENCE.fullmatch(line)
    if found is None:
        why = "a sentence without its checksum" if _UNCHECKED.fullmatch(line) else "this is no NMEA sentence"
        raise ReportError(f"{why}: {line[:40]!r}")
    talker, kind, content, told = found.groups()
    total = 0
    for character in f"{talker}{kind},{content}":
        total ^= ord(character)
    if total != int(told, 16):
        raise ReportError(f"the checksum is {told}, and {total:02X} would be right: {line[:40]!r}")
    return content.split(","), kind


def _at(fields: list[str], place: int) -> str:
    return fields[place].strip() if place < len(fields) else ""


def _number(text: str) -> float | None:
    if not text:
        return None
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ReportError(f"{text[:20]!r} is no number")
    return number


def _degrees(text: str, side: str, digits: int) -> float:
    """Return ``ddmm.mmm`` with its hemisphere in degrees; longitudes have three digits before the minutes."""
    if not re.fullmatch(rf"\d{{{digits + 2}}}(\.\d{{1,9}})?", text) or side not in tuple("NSEW"):
        raise ReportError(f"{text[:20]!r} {side[:2]!r} is no latitude or longitude")
    minutes = float(text[digits:])
    if minutes >= 60:
        raise ReportError(f"{text[:20]!r} has {minutes:g} minutes")
    degrees = int(text[:digits]) + minutes / 60
    return -degrees if side in "SW" else degrees


def _day(text: str) -> datetime | None:
    """Return the day of ``ddmmyy``: of the years 2000 to 2099."""
    if not re.fullmatch(r"\d{6}", text):
        return None
    try:
        return datetime(2000 + int(text[4:]), int(text[2:4]), int(text[:2]), tzinfo=UTC)
    except ValueError:
        raise ReportError(f"{text!r} is no date") from None
