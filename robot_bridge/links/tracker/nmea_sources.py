"""Where NMEA sentences come from: TCP and UDP, each receiver told by its address, and serial devices."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import termios
import tty
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path

from ...messages import SendGPS
from .nmea import LONGEST, Receiver
from .osmand import Report, ReportError

log = logging.getLogger(__name__)

MOST_RECEIVERS = 500
SILENT_FOR = 300.0
"""seconds after which a TCP connection that says nothing is closed."""
OPEN_AGAIN = 2.0
"""seconds after which a serial device that is not there is looked for again."""
BAUDS = {
    rate: getattr(termios, f"B{rate}")
    for rate in (4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800)
    if hasattr(termios, f"B{rate}")
}

Accept = Callable[[Report], None]
Refuse = Callable[[str, Exception], None]


class NmeaSources:
    """Feeds receivers with what comes from each source; ``refuse`` is told what counts for nothing."""

    def __init__(self, accept: Accept, refuse: Refuse) -> None:
        self._accept = accept
        self._refuse = refuse
        self._receivers: OrderedDict[str, Receiver] = OrderedDict()
        self._open = 0

    def feed(self, source: str, line: bytes, receiver: Receiver) -> None:
        """Deal with one line of a source."""
        text = line.strip().decode("ascii", "replace")
        if not text:
            return
        try:
            fix: SendGPS | None = receiver.feed(text)
            if fix is not None:
                self._accept(Report(source, fix))
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
        """Deal with one datagram, which may hold several sentences."""
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
        """Deal with a datagram."""
        self._sources.datagram(str(addr[0]), data)
