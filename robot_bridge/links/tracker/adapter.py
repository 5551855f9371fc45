"""Adapter of trackers, with its settings: listens to phones and GPS receivers."""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import logging
import re
import time
from collections import Counter
from pathlib import Path
from typing import ClassVar

import msgspec

from ...core.messages.base import LONGEST_OPERATOR, MessageError, check_robot_name, one_line
from ..base.adapter import Adapter, Command, Link
from ..base.errors import CommandRefusedError, LinkError
from ..base.settings import LinkSettings, read_settings
from .nmea import BAUDS, LONGEST, Datagrams, NmeaSources
from .osmand import LARGEST_HEAD, HttpReports, ReportError, TrackerReport

# --- Table ``[tracker]`` of a link's settings: listening addresses, and names of devices ---

_PREFIX_ROOM = 32


class TrackerSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``http``, ``nmea_tcp`` and ``nmea_udp`` are addresses ``host:port`` to listen on.

    ``names`` maps devices to their names on the map: by the id that a phone reports, the IP address of an
    NMEA sender, or the path of a serial device. A device without a name is ignored, unless ``others`` gives a
    prefix for such names. A position older than ``oldest_s`` is accepted but not shown. With
    ``reports_every_s`` a device counts as alive for so long after each report.
    """

    http: str | None = None
    nmea_tcp: str | None = None
    nmea_udp: str | None = None
    nmea_serial: list[str] = []
    baud: int = 9600
    names: dict[str, str] = {}
    others: str | None = None
    oldest_s: float = 10.0
    reports_every_s: float = 0.0

    def check(self, file: Path) -> None:
        """Raise LinkError, naming file and key, for invalid values."""
        for key in ("http", "nmea_tcp", "nmea_udp"):
            address(getattr(self, key), f"{file}: tracker.{key}")
        if not (self.http or self.nmea_tcp or self.nmea_udp or self.nmea_serial):
            raise LinkError(f"{file}: tracker listens to nothing; give http = '127.0.0.1:5055'")
        if self.baud not in BAUDS:
            raise LinkError(f"{file}: tracker.baud = {self.baud}: give one of {', '.join(map(str, BAUDS))}")
        for key in ("oldest_s", "reports_every_s"):
            if not 0 <= getattr(self, key) <= 86400:
                raise LinkError(f"{file}: tracker.{key} = {getattr(self, key)}: give 0 to 86400 seconds")
        for device, name in self.names.items():
            _check(name, f"{file}: tracker.names.{device}")
        if len(set(self.names.values())) < len(self.names):
            raise LinkError(f"{file}: tracker.names: two devices have one name")
        if self.others is not None:
            if len(self.others) > _PREFIX_ROOM:
                raise LinkError(f"{file}: tracker.others has more than {_PREFIX_ROOM} characters")
            _check(f"{self.others}1", f"{file}: tracker.others")


def address(text: str | None, where: str) -> tuple[str, int] | None:
    """Return (host, port) of ``host:port``, or of ``[host]:port`` in IPv6; raises LinkError."""
    if text is None:
        return None
    host, _, port = text.rpartition(":")
    try:
        host = str(ipaddress.ip_address(host.strip("[]")))
        if not (port.isascii() and port.isdigit() and int(port) < 65536):
            raise ValueError
    except ValueError:
        raise LinkError(f"{where} = {text!r}: write an IP address and a port, as 0.0.0.0:5055") from None
    return host, int(port)


def _check(name: str, where: str) -> None:
    try:
        check_robot_name(name)
    except MessageError as error:
        raise LinkError(f"{where}: {error}") from None


# --- The adapter of trackers: listens to phones and receivers, and reports their positions ---

log = logging.getLogger(__name__)

MOST_TRACKERS = 2000
ALIVE_EVERY = 1.0
REPORT_EVERY = 5.0
"""seconds between reports of the counts."""
MOST_REFUSALS_LOGGED = 5
"""log lines about errors of one device."""
ONLY_SEEN = "a tracker is seen and not commanded"
_UNUSABLE = re.compile(r"[^A-Za-z0-9_.-]")


class TrackerAdapter(Adapter):
    """Phones and receivers, each under its name in the settings."""

    kind: ClassVar[str] = "tracker"

    def __init__(self, settings: TrackerSettings, where: str) -> None:
        self._settings = settings
        self._where = where
        self._link: Link | None = None
        self._last_seen: dict[str, float] = {}
        """when each was last heard, by a monotonic clock."""
        self._devices: dict[str, str] = {}
        """the device of each name."""
        self._counts: Counter[str] = Counter()
        self._refusals: Counter[str] = Counter()

    async def run(self, link: Link) -> None:
        """Listen until cancelled."""
        self._link = link
        async with contextlib.AsyncExitStack() as stack, asyncio.TaskGroup() as group:
            await self._listen(stack, group)
            group.create_task(self._keep_alive(link))
            while True:
                link.report(ok=True, text=f"{len(self._last_seen)} seen", counts=dict(self._counts))
                await asyncio.sleep(REPORT_EVERY)

    async def command(self, command: Command) -> None:
        """Refuse it: the gateway does not send any."""
        raise CommandRefusedError(ONLY_SEEN)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Do nothing: trackers cannot be stopped."""

    def accept(self, report: TrackerReport) -> None:
        """Report a device's position; raises ReportError if it is rejected."""
        assert self._link is not None
        name = self._name(report.device)
        self._counts["reports"] += 1
        age = 0.0 if report.fix.fix_t is None else time.time() - report.fix.fix_t
        if age > self._settings.oldest_s:
            # A phone that was out of reach sends all stored reports, and would keep them if refused.
            self._counts["too_old"] += 1
            return
        if name not in self._last_seen:
            self._link.add(name)
        self._last_seen[name] = time.monotonic()
        self._link.position(name, report.fix)

    def refuse(self, source: str, error: Exception) -> None:
        """Count rejected reports of a source, and log the first few."""
        self._counts["refused"] += 1
        if len(self._refusals) < MOST_TRACKERS and self._refusals[source] < MOST_REFUSALS_LOGGED:
            self._refusals[source] += 1
            log.warning("%s: %s", one_line(source, LONGEST_OPERATOR), error)

    def _name(self, device: str) -> str:
        name = self._settings.names.get(device)
        if name is None:
            if self._settings.others is None:
                raise ReportError(f"device {device!r} is not in [tracker.names] of the link's settings")
            name = self._settings.others + _UNUSABLE.sub("-", device)
            try:
                check_robot_name(name)
            except MessageError as error:
                raise ReportError(str(error)) from None
            if name in self._settings.names.values():
                raise ReportError(f"device {device!r} would be called {name}, as another is")
        if self._devices.get(name, device) != device:
            raise ReportError(f"device {device!r} would be called {name}, as {self._devices[name]!r} is")
        if name not in self._devices and len(self._devices) >= MOST_TRACKERS:
            raise ReportError(f"{MOST_TRACKERS} devices are shown, and no more")
        self._devices[name] = device
        return name

    def _accept_or_refuse(self, report: TrackerReport) -> None:
        try:
            self.accept(report)
        except ReportError as error:
            self.refuse(report.device, error)
            raise

    async def _listen(self, stack: contextlib.AsyncExitStack, group: asyncio.TaskGroup) -> None:
        settings, loop = self._settings, asyncio.get_running_loop()
        sources = NmeaSources(self.accept, self.refuse)
        try:
            if (http := address(settings.http, "http")) is not None:
                phones = HttpReports(self._accept_or_refuse)
                server = await asyncio.start_server(phones.serve, *http, limit=LARGEST_HEAD)
                stack.callback(server.close)
            if (tcp := address(settings.nmea_tcp, "nmea_tcp")) is not None:
                server = await asyncio.start_server(sources.serve, *tcp, limit=2 * LONGEST)
                stack.callback(server.close)
            if (udp := address(settings.nmea_udp, "nmea_udp")) is not None:
                transport, _ = await loop.create_datagram_endpoint(lambda: Datagrams(sources), udp)
                stack.callback(transport.close)
        except OSError as error:
            raise LinkError(f"{self._where}: cannot listen: {error.strerror or error}") from None
        for device in settings.nmea_serial:
            group.create_task(sources.watch_serial(Path(device), settings.baud))

    async def _keep_alive(self, link: Link) -> None:
        while True:
            await asyncio.sleep(ALIVE_EVERY)
            now = time.monotonic()
            for name, last_seen in self._last_seen.items():
                if now - last_seen < self._settings.reports_every_s:
                    link.alive(name)


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter with them; raises LinkError."""
    settings, own = read_settings(file, "tracker", TrackerSettings)
    own.check(file)
    return settings, TrackerAdapter(own, f"{file}: tracker")
