"""Table ``[vda5050]`` of a link's settings: the broker, the vehicles' names, and control of the vehicles."""

from __future__ import annotations

import ssl
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import msgspec
from msgspec import field

from ...core.errors import AccessError
from ...core.messages.base import ROBOT_NAME
from ...core.reconnection import client_context
from ..base.errors import LinkError
from ..base.frames import FrameSettings, LinkFrame
from ..base.settings import LinkSettings
from .messages import Topics, Vda5050Error, VehicleId
from .presence import MapFrame
from .stopping import StopLimits
from .tasks import RouteLimits
from .vehicle import VehicleSettings

PLAIN, ENCRYPTED = "mqtt", "mqtts"
_PORTS = {PLAIN: 1883, ENCRYPTED: 8883}


class NamedVehicle(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One of ``[[vda5050.vehicles]]``: the robot's name of a vehicle."""

    manufacturer: str
    serial: str
    robot: str


class Vda5050Settings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Table ``[vda5050]``; files are beside the settings.

    ``names`` makes a robot's name of ``{manufacturer}`` and ``{serial}``; with ``vehicles`` only those listed
    are controlled. ``major_version`` v3 is for vehicles of 3.0, all else for those of 2.x. Without ``maps``
    every map uses ``[frame]``, else each its own table. Lengths are metres, times seconds: see
    :class:`.tasks.RouteLimits` and :class:`.stopping.StopLimits`.
    """

    broker: str = "mqtt://127.0.0.1:1883"
    user: str | None = None
    password_file: str | None = None
    ca: str | None = None
    certificate: str | None = None
    key_file: str | None = None
    client_id: str | None = None
    interface: str = "uagv"
    major_version: str = "v2"
    names: str = "{serial}"
    vehicles: list[NamedVehicle] = field(default_factory=list)
    maps: dict[str, FrameSettings] = field(default_factory=dict)
    most_vehicles: int = 1000
    base_length_m: float = 30.0
    simplify_m: float = 0.05
    start_deviation_m: float = 1.0
    passing_deviation_m: float = 0.5
    end_deviation_m: float = 0.1
    heading_deviation_deg: float = 6.0
    max_speed: float | None = None
    pause_after_s: float = 2.0
    unanswered_after_s: float = 5.0
    silent_after_s: float = 40.0


@dataclass(frozen=True)
class BrokerAddress:
    """Address and credentials of the broker; the password is read again for each connection."""

    host: str
    port: int
    user: str | None
    password_file: Path | None
    tls: ssl.SSLContext | None
    client_id: str

    def password(self) -> str | None:
        """Return the password; raises Vda5050Error when the file cannot be read."""
        if self.password_file is None:
            return None
        try:
            return self.password_file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or error
            raise Vda5050Error(
                f"vda5050.password_file {self.password_file} cannot be read: {reason}"
            ) from None

    def __str__(self) -> str:
        return f"{self.host}:{self.port}"


class VehicleNames:
    """The robots' names of vehicles."""

    def __init__(self, own: Vda5050Settings) -> None:
        self._pattern = own.names
        self._named = {VehicleId(one.manufacturer, one.serial): one.robot for one in own.vehicles}

    def name(self, vehicle: VehicleId) -> str | None:
        """Return the robot's name; None for a vehicle that must not be controlled.

        :raises Vda5050Error: for an invalid name of a robot.
        """
        if self._named:
            return self._named.get(vehicle)
        name = self._pattern.replace("{manufacturer}", vehicle.manufacturer).replace(
            "{serial}", vehicle.serial_number
        )
        if not ROBOT_NAME.fullmatch(name):
            raise Vda5050Error(
                f"vehicle {str(vehicle)[:80]!r} would be robot {name[:80]!r}, which no robot can be called; "
                "name it under [[vda5050.vehicles]]"
            )
        return name


class _Placed:
    """A map placed by a frame of the link."""

    def __init__(self, frame: LinkFrame) -> None:
        self._frame = frame

    def to_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        return self._frame.pose_to_site(x, y, theta)

    def from_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        return self._frame.pose_from_site(x, y, theta)


class AnyMap(Mapping[str, MapFrame]):
    """All maps in one frame, under any id."""

    def __init__(self, frame: LinkFrame) -> None:
        self._frame = _Placed(frame)

    def __getitem__(self, map_id: str) -> MapFrame:
        return self._frame

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


def placed_maps(frames: Mapping[str, LinkFrame]) -> dict[str, MapFrame]:
    """Return maps by their ids, each in its own frame."""
    return {map_id: _Placed(frame) for map_id, frame in frames.items()}


def check(settings: LinkSettings, own: Vda5050Settings) -> None:
    """Check the settings; raises LinkError naming file and key."""
    where = f"{settings.file}: vda5050."
    lengths = ("base_length_m", "simplify_m", "start_deviation_m", "passing_deviation_m", "end_deviation_m")
    times = ("pause_after_s", "unanswered_after_s", "silent_after_s", "heading_deviation_deg")
    for key in (*lengths, *times):
        if not 0 < getattr(own, key) <= 10_000:
            raise LinkError(f"{where}{key} = {getattr(own, key)!r}: write a number above 0 and up to 10000")
    if own.max_speed is not None and not 0 < own.max_speed <= 100:
        raise LinkError(f"{where}max_speed = {own.max_speed!r}: write m/s, above 0 and up to 100")
    if not 1 <= own.most_vehicles <= 100_000:
        raise LinkError(f"{where}most_vehicles = {own.most_vehicles!r}: write 1 to 100000")
    robots = [one.robot for one in own.vehicles]
    for robot in robots:
        if not ROBOT_NAME.fullmatch(robot):
            raise LinkError(f"{where}vehicles: no robot can be called {robot!r}")
        if robots.count(robot) > 1:
            raise LinkError(f"{where}vehicles: two vehicles are called {robot!r}")
    _check_frames(settings, own)
    try:
        topics(own)
    except Vda5050Error as error:
        raise LinkError(f"{where}{error}") from None
    broker_address(settings, own)


def _check_frames(settings: LinkSettings, own: Vda5050Settings) -> None:
    frames = {"frame": settings.frame, **{f"vda5050.maps.{id}": one for id, one in own.maps.items()}}
    for key, frame in frames.items():
        frame.check_metres(f"{settings.file}: {key}")


def topics(own: Vda5050Settings) -> Topics:
    """Return the topics of the interface; raises Vda5050Error."""
    return Topics(own.interface, own.major_version)


def vehicle_settings(settings: LinkSettings, own: Vda5050Settings) -> VehicleSettings:
    """Return the settings of vehicles; a command is refused before the gateway gives it up."""
    route = RouteLimits(
        base_length=own.base_length_m,
        tolerance=own.simplify_m,
        start_deviation=own.start_deviation_m,
        passing_deviation=own.passing_deviation_m,
        end_deviation=own.end_deviation_m,
        heading_deviation=min(3.14, own.heading_deviation_deg * 0.017453292519943295),
        max_speed=own.max_speed,
    )
    stop = StopLimits(pause_after=own.pause_after_s, unanswered_after=own.unanswered_after_s)
    accept_within = 0.8 * settings.answer_within_s
    version = "3.0.0" if topics(own).major == "3" else "2.1.0"
    return VehicleSettings(route, stop, accept_within, own.silent_after_s, version=version)


def broker_address(settings: LinkSettings, own: Vda5050Settings) -> BrokerAddress:
    """Return the broker's address; raises LinkError naming the key."""
    where = f"{settings.file}: vda5050."
    parts = urlsplit(own.broker)
    try:
        port = parts.port or _PORTS.get(parts.scheme, 0)
    except ValueError:
        port = 0
    bare = not (parts.path.strip("/") or parts.query or parts.username)
    if parts.scheme not in _PORTS or not parts.hostname or not port or not bare:
        raise LinkError(
            f"{where}broker = {own.broker!r}: write mqtt://HOST:1883, or mqtts://HOST:8883 for TLS"
        )
    if own.password_file is not None and own.user is None:
        raise LinkError(f"{where}user is missing: a password without a user is not sent")
    tls = _tls(settings, own) if parts.scheme == ENCRYPTED else None
    if tls is None and (own.ca or own.certificate or own.key_file):
        raise LinkError(
            f"{where}broker = {own.broker!r} has no TLS; write mqtts:// for what certificates are for"
        )
    return BrokerAddress(
        host=parts.hostname,
        port=port,
        user=own.user,
        password_file=None if own.password_file is None else settings.beside(own.password_file),
        tls=tls,
        client_id=own.client_id or f"fleet-{settings.name}",
    )


def _tls(settings: LinkSettings, own: Vda5050Settings) -> ssl.SSLContext:
    where = f"{settings.file}: vda5050."
    try:
        context = client_context(None if own.ca is None else settings.beside(own.ca))
    except AccessError as error:
        raise LinkError(f"{where}ca: {error}") from None
    if own.certificate is None:
        return context
    key = None if own.key_file is None else settings.beside(own.key_file)
    try:
        context.load_cert_chain(settings.beside(own.certificate), key)
    except (OSError, ssl.SSLError) as error:
        raise LinkError(f"{where}certificate: {error.strerror or error}; give PEM files") from None
    return context
