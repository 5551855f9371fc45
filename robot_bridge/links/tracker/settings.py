"""Table ``[tracker]`` of a link's settings: what is listened to, and who is who."""

from __future__ import annotations

import ipaddress
from pathlib import Path

import msgspec

from ...messages import MessageError, check_robot_name
from ..base.errors import LinkError
from .nmea_sources import BAUDS

_PREFIX_ROOM = 32


class TrackerSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``http``, ``nmea_tcp`` and ``nmea_udp`` are addresses ``host:port`` to listen on.

    ``names`` gives devices the names that they have on the map: by the id that a phone reports, the IP
    address that NMEA comes from, or the path of a serial device. A device without a name counts for nothing,
    unless ``others`` begins the names of those. A position that is older than ``oldest_s`` is taken and not
    shown. With ``reports_every_s`` a device counts as there for so long after each report.
    """

    http: str | None = None
    nmea_tcp: str | None = None
    nmea_udp: str | None = None
    nmea_serial: list[str] = []
    baud: int = 9600
    names: dict[str, str] = {}
    others: str | None = None
    oldest_s: float = 60.0
    reports_every_s: float = 0.0

    def check(self, file: Path) -> None:
        """Raise LinkError, naming file and key, for what cannot be."""
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
