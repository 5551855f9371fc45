"""The adapter of trackers: listens to phones and receivers, and tells where they are."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re
import time
from collections import Counter
from pathlib import Path
from typing import ClassVar

from ...messages import LONGEST_OPERATOR, MessageError, check_robot_name, one_line
from ..base.adapter import Adapter, Command
from ..base.errors import CommandRefusedError, LinkError
from ..base.link import Link
from ..base.settings import LinkSettings, read_settings
from .http_reports import LARGEST_HEAD, HttpReports
from .nmea import LONGEST
from .nmea_sources import Datagrams, NmeaSources
from .osmand import Report, ReportError
from .settings import TrackerSettings, address

log = logging.getLogger(__name__)

MOST_TRACKERS = 2000
ALIVE_EVERY = 1.0
REPORT_EVERY = 5.0
"""seconds between two reports of what was counted."""
SAID_OF_ONE = 5
"""lines of the log about what one device does wrong."""
ONLY_SEEN = "a tracker is seen and not commanded"
_UNUSABLE = re.compile(r"[^A-Za-z0-9_.-]")


class TrackerAdapter(Adapter):
    """Phones and receivers, each under the name that the settings give it."""

    kind: ClassVar[str] = "tracker"

    def __init__(self, settings: TrackerSettings, where: str) -> None:
        self._settings = settings
        self._where = where
        self._link: Link | None = None
        self._heard: dict[str, float] = {}
        """when each was heard last, by a clock that only goes forward."""
        self._devices: dict[str, str] = {}
        """the device that each name stands for."""
        self._counts: Counter[str] = Counter()
        self._said: Counter[str] = Counter()

    async def run(self, link: Link) -> None:
        """Listen until cancelled."""
        self._link = link
        async with contextlib.AsyncExitStack() as stack, asyncio.TaskGroup() as group:
            await self._listen(stack, group)
            group.create_task(self._keep_alive(link))
            while True:
                link.report(ok=True, text=f"{len(self._heard)} seen", counts=dict(self._counts))
                await asyncio.sleep(REPORT_EVERY)

    async def command(self, command: Command) -> None:
        """Refuse it: the gateway does not send any."""
        raise CommandRefusedError(ONLY_SEEN)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Do nothing: who is only seen cannot be stopped."""

    def accept(self, report: Report) -> None:
        """Show where a device is; raises ReportError where it is not shown."""
        assert self._link is not None
        name = self._name(report.device)
        self._counts["reports"] += 1
        age = 0.0 if report.fix.fix_t is None else time.time() - report.fix.fix_t
        if age > self._settings.oldest_s:
            # A phone that was out of reach tells all that it kept, and would keep it if this were refused.
            self._counts["too_old"] += 1
            return
        if name not in self._heard:
            self._link.add(name)
        self._heard[name] = time.monotonic()
        self._link.position(name, report.fix)

    def refuse(self, source: str, error: Exception) -> None:
        """Count what cannot be shown of a source, and say so in the log for the first few."""
        self._counts["refused"] += 1
        if len(self._said) < MOST_TRACKERS and self._said[source] < SAID_OF_ONE:
            self._said[source] += 1
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

    def _accept_or_refuse(self, report: Report) -> None:
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
            for name, heard in self._heard.items():
                if now - heard < self._settings.reports_every_s:
                    link.alive(name)


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter that goes by them; raises LinkError."""
    settings, own = read_settings(file, "tracker", TrackerSettings)
    own.check(file)
    return settings, TrackerAdapter(own, f"{file}: tracker")
