"""NMEA 0183 of GPS receivers: sentences to fixes, over TCP, UDP and serial devices."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import os
import re
import termios
import tty
from collections import OrderedDict
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

from ...core.messages.base import MessageError
from ...core.messages.robots import SendGPS
from .osmand import KNOT, MOVING, ReportError, TrackerReport

# --- NMEA 0183 of GPS receivers: sentences in, fixes out; no I/O ---
# A fix is reported at RMC; GGA, GST and VTG before it add details. For receivers without RMC it is reported
# at GGA.

LONGEST = 120
"""characters of a sentence; the standard has 82, and some receivers send more."""
_SENTENCE = re.compile(r"[$!]([A-Z]{2})([A-Z]{3}),([\x20-\x7e]*)\*([0-9A-Fa-f]{2})")
_UNCHECKED = re.compile(r"[$!][A-Z]{5},[^*]*")
WITHOUT_RMC = 3
"""GGA sentences in a row after which a receiver counts as one without RMC."""


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
        """Return the fix that a sentence completes, None for most; raises ReportError for invalid NMEA."""
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
        """Return the time of a fix in seconds since 1970, None before the receiver has sent the date."""
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
    talker, kind, content, checksum = found.groups()
    total = 0
    for character in f"{talker}{kind},{content}":
        total ^= ord(character)
    if total != int(checksum, 16):
        raise ReportError(f"the checksum is {checksum}, and {total:02X} would be right: {line[:40]!r}")
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


# --- Sources of NMEA sentences: TCP and UDP, receivers identified by address, and serial devices

log = logging.getLogger(__name__)

MOST_RECEIVERS = 500
SILENT_FOR = 300.0
"""seconds after which a silent TCP connection is closed."""
OPEN_AGAIN = 2.0
"""seconds between attempts to open a missing serial device."""
BAUDS = {
    rate: getattr(termios, f"B{rate}")
    for rate in (4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800)
    if hasattr(termios, f"B{rate}")
}

Accept = Callable[[TrackerReport], None]
Refuse = Callable[[str, Exception], None]


class NmeaSources:
    """Feeds receivers with data of each source; ``refuse`` is called for rejected lines."""

    def __init__(self, accept: Accept, refuse: Refuse) -> None:
        self._accept = accept
        self._refuse = refuse
        self._receivers: OrderedDict[str, Receiver] = OrderedDict()
        self._open = 0

    def feed(self, source: str, line: bytes, receiver: Receiver) -> None:
        """Process one line of a source."""
        text = line.strip().decode("ascii", "replace")
        if not text:
            return
        try:
            fix: SendGPS | None = receiver.feed(text)
            if fix is not None:
                self._accept(TrackerReport(source, fix))
        except ReportError as error:
            self._refuse(source, error)

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve one TCP connection to its end."""
        source = str((writer.get_extra_info("peername") or ("",))[0])
        self._open += 1
        try:
            if self._open <= MOST_RECEIVERS:
                await self._read(source, reader)
        except OSError as error:
            log.info("receiver %s: %s", source, error)
        finally:
            self._open -= 1
            writer.close()
            with contextlib.suppress(OSError):
                await writer.wait_closed()

    async def _read(self, source: str, reader: asyncio.StreamReader) -> None:
        receiver = Receiver()
        while True:
            try:
                async with asyncio.timeout(SILENT_FOR):
                    line = await reader.readuntil(b"\n")
            except asyncio.LimitOverrunError:
                self._refuse(source, ReportError(f"more than {LONGEST} characters without an end of line"))
                return
            except (asyncio.IncompleteReadError, TimeoutError):
                return
            self.feed(source, line, receiver)

    def datagram(self, source: str, data: bytes) -> None:
        """Process one datagram, which may hold several sentences."""
        receiver = self._receivers.pop(source, None) or Receiver()
        self._receivers[source] = receiver
        while len(self._receivers) > MOST_RECEIVERS:
            self._receivers.popitem(last=False)
        for line in data.splitlines():
            self.feed(source, line, receiver)

    async def watch_serial(self, device: Path, baud: int) -> None:
        """Read a serial device whenever it is there, until cancelled."""
        while True:
            try:
                await self._read_device(device, baud)
                reason = "it ended"
            except (OSError, termios.error) as error:
                reason = getattr(error, "strerror", None) or str(error)
            log.warning("serial device %s: %s; trying again in %g s", device, reason, OPEN_AGAIN)
            await asyncio.sleep(OPEN_AGAIN)

    async def _read_device(self, device: Path, baud: int) -> None:
        descriptor = os.open(device, os.O_RDONLY | os.O_NOCTTY | os.O_NONBLOCK)
        with open(descriptor, "rb", buffering=0) as port:  # noqa: PTH123 - opened with flags above
            if os.isatty(descriptor):
                tty.setraw(descriptor)
                attributes = termios.tcgetattr(descriptor)
                attributes[4] = attributes[5] = BAUDS[baud]
                termios.tcsetattr(descriptor, termios.TCSANOW, attributes)
            loop = asyncio.get_running_loop()
            reader = asyncio.StreamReader(limit=2 * LONGEST)
            transport, _ = await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), port)
            try:
                await self._read(str(device), reader)
            finally:
                transport.close()


class Datagrams(asyncio.DatagramProtocol):
    """The UDP socket of :class:`NmeaSources`."""

    def __init__(self, sources: NmeaSources) -> None:
        self._sources = sources

    def datagram_received(self, data: bytes, addr: tuple[str, int]) -> None:
        """Process a datagram."""
        self._sources.datagram(str(addr[0]), data)
