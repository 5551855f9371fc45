"""Requests of robots (paper 1, table II) and answers of the server (table III).

Each message stands under its own operation code, which is the class's name. On SQL it is a row (``op``,
``params`` as JSON, ``payload``); on WebSocket it is JSON-RPC 2.0 with the operation code as the method. A
robot on SQL may add the ``magic`` number of its Ready to every message, which distinguishes it from another
robot under its account.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

from . import base
from .roads import GetSurface, SetSurface
from .safety import Ability, PathDeclaration

_SURELY_NEAR = 10_000.0
_SPEED_FOR_PLACE = _SURELY_NEAR / base.SPEED[1]
"""A place, altitude and speed whose sum is below this are within all bounds, as with most robots."""


def is_status(text: str) -> bool:
    """Return whether ``text`` is a valid status: not too long, and on one line."""
    return len(text) <= base.LONGEST_STATUS and text.isprintable()


@dataclass(frozen=True)
class Ready:
    """The robot is ready to start tasks and listens for answers; ``magic`` comes back in the OpAck.

    ``asks_path`` (our addition) declares that it requests its path (GetPath) after every SetPosEnd and does
    not drive before the answer; ``path_cones`` that it understands ``cone`` and ``collect`` of SetPath. A
    robot that leaves them out is taken to do neither: it drives straight to a target. ``abilities`` (ours
    too) are all that it can do, none for one that is only observed; a robot that leaves them out can do
    everything.
    """

    magic: int
    asks_path: bool | None = None
    path_cones: bool | None = None
    abilities: list[Ability] | None = None
    acknowledged: ClassVar[bool] = True

    def __post_init__(self) -> None:
        base.check_stored_number(magic=self.magic)

    @property
    def paths(self) -> PathDeclaration | None:
        """The declaration about paths, None without one."""
        if self.path_cones:
            return "asks and cones" if self.asks_path else "cones"
        return "asks" if self.asks_path else None

    @property
    def can(self) -> str | None:
        """Its abilities separated by spaces, None for one that can do everything."""
        return None if self.abilities is None else " ".join(sorted(set(self.abilities)))


@dataclass(frozen=True)
class Stopped:
    """The robot stands and does nothing; one that falls silent after this is offline, not lost."""

    magic: int | None = None
    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class Alive:
    """The robot is alive; sent at least every second when nothing else is."""

    magic: int | None = None
    acknowledged: ClassVar[bool] = False


@dataclass(frozen=True)
class OpAck:
    """The other side received message ``id``; with ``ok`` false it will not do it, and ``reason`` says why.

    The answer to Ready returns the robot's ``magic`` number, the name it is known by, and the ``database``
    that the ids of the server's messages belong to. ``gateways`` are as in :class:`Start`, in the answer to
    Ready and in the next one after they have changed.
    """

    id: int | None = None
    ok: bool = True
    reason: str | None = None
    magic: int | None = None
    robot: str | None = None
    database: str | None = None
    gateways: list[str] | None = None
    acknowledged: ClassVar[bool] = False

    def __post_init__(self) -> None:
        base.check_stored_number(id=self.id, magic=self.magic)
        if self.gateways is not None:
            object.__setattr__(self, "gateways", base.usable_addresses(self.gateways))


@dataclass(frozen=True)
class SendPos:
    """Where the robot is: pose, velocity (m/s), and optionally device time, battery (0 to 1), status.

    ``fix_t`` is when the position was measured, ``t`` when it was sent, both by the robot's clock;
    ``accuracy`` is the standard deviation of the position in metres. ``theta_from`` says that theta was not
    measured: it is the ``course`` over ground, the ``last`` one known, or ``unknown`` and then 0. A longer
    status than 256 characters is cut, and theta is kept in [-π, π].
    """

    x: float
    y: float
    theta: float
    v: float
    t: float | None = None
    battery: float | None = None
    status: str | None = None
    fix_t: float | None = None
    accuracy: float | None = None
    altitude: float | None = None
    theta_from: Literal["course", "last", "unknown"] | None = None
    magic: int | None = None
    acknowledged: ClassVar[bool] = False
    ranges: ClassVar[base.Ranges] = {
        "x": base.COORDINATE,
        "y": base.COORDINATE,
        "theta": base.THETA,
        "v": base.SPEED,
        "t": base.CLOCK,
        "fix_t": base.CLOCK,
        "altitude": base.ALTITUDE,
        "battery": (0, 1),
        "accuracy": base.ACCURACY,
    }

    def __post_init__(self) -> None:
        # Ten thousand arrive every second: the wrong parameter is searched only after a quick check of all
        # failed.
        place = abs(self.x) + abs(self.y) + abs(self.altitude or 0.0) + abs(self.v) * _SPEED_FOR_PLACE
        clocks = abs(self.t or 0.0) + abs(self.fix_t or 0.0)
        if not (place <= _SURELY_NEAR and clocks <= base.CLOCK[1] and -math.pi <= self.theta <= math.pi):
            base.check_ranges(self)
            object.__setattr__(self, "theta", base.direction(self.theta))
        if not (0 <= (self.battery or 0) <= 1 and 0 <= (self.accuracy or 0) <= base.ACCURACY[1]):
            base.check_ranges(self)
        if self.status is not None and not is_status(self.status):
            object.__setattr__(self, "status", base.one_line(self.status, base.LONGEST_STATUS))

    @classmethod
    def of_checked(cls, names: Sequence[str], values: Sequence[Any]) -> SendPos:
        """Return a pose of parameters that are known to be valid, ``values`` by ``names``.

        Takes a quarter of the constructor's time, which checks and freezes fields; the others are None.
        """
        pose = object.__new__(cls)
        pose.__dict__.update(zip(names, values, strict=True))
        return pose


@dataclass(frozen=True)
class SendGPS:
    """Where the robot is on the earth: WGS 84 latitude and longitude in degrees.

    ``heading`` is in degrees clockwise from true north, ``altitude`` in metres above the ellipsoid,
    ``accuracy`` the standard deviation of the position in metres, ``v`` in m/s; ``fix_t``, ``t``,
    ``battery`` and ``status`` are as in :class:`SendPos`.
    """

    lat: float
    lon: float
    altitude: float | None = None
    heading: float | None = None
    v: float | None = None
    t: float | None = None
    fix_t: float | None = None
    accuracy: float | None = None
    battery: float | None = None
    status: str | None = None
    magic: int | None = None
    acknowledged: ClassVar[bool] = False
    ranges: ClassVar[base.Ranges] = {
        "lat": (-90, 90),
        "lon": (-180, 180),
        "heading": (0, 360),
        "altitude": base.ALTITUDE,
        "v": base.SPEED,
        "t": base.CLOCK,
        "fix_t": base.CLOCK,
        "accuracy": base.ACCURACY,
        "battery": (0, 1),
    }

    def __post_init__(self) -> None:
        base.check_ranges(self)
        if self.status is not None:
            object.__setattr__(self, "status", base.one_line(self.status, base.LONGEST_STATUS))

    @property
    def has_fix(self) -> bool:
        """Return whether it has a position: receivers without a fix send 0, 0, far out at sea."""
        return self.lat != 0 or self.lon != 0


@dataclass(frozen=True)
class GetMap:
    """The robot requests the map of a square of ``area`` square metres centred on (x, y)."""

    x: float
    y: float
    area: float
    magic: int | None = None
    acknowledged: ClassVar[bool] = True
    ranges: ClassVar[base.Ranges] = {
        "x": base.COORDINATE,
        "y": base.COORDINATE,
        "area": base.AREA,
    }

    def __post_init__(self) -> None:
        base.check_ranges(self)
        if self.area <= 0:
            raise base.MessageError(f"area is {self.area}; give square metres above 0")


@dataclass(frozen=True)
class GetPath:
    """The robot requests the path from where it is to the end of its task."""

    magic: int | None = None
    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class GetPosIni:
    """The robot requests the beginning of its track."""

    magic: int | None = None
    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class GetPosEnd:
    """The robot requests the end of its track."""

    magic: int | None = None
    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class SetObject:
    """The robot saw ``object`` at (x, y), metres in the site frame, and it belongs on the map.

    ``label`` says what it is, ``height`` and ``radius`` are in metres, ``t`` is when it was seen by the
    robot's clock. ``source`` is a number or name that the robot gives to its report: repeated under the same
    one, it is stored once. With ``doubts`` it is the reverse: ``source`` is the ``src`` of an obstacle of the
    map around (x, y), through which the robot's sensors see again and again.
    """

    x: float
    y: float
    object: str
    label: str | None = None
    height: float | None = None
    radius: float | None = None
    t: float | None = None
    source: str | None = None
    magic: int | None = None
    doubts: str | None = None
    acknowledged: ClassVar[bool] = True
    ranges: ClassVar[base.Ranges] = {
        "x": base.COORDINATE,
        "y": base.COORDINATE,
        "height": (0, 1000),
        "radius": (0.01, 50),
        "t": base.CLOCK,
    }
    texts: ClassVar[base.Texts] = {
        "object": base.LONGEST_LABEL,
        "label": base.LONGEST_LABEL,
        "source": base.LONGEST_LABEL,
        "doubts": base.LONGEST_LABEL,
    }

    def __post_init__(self) -> None:
        base.check_ranges(self)
        base.check_texts(self)


@dataclass(frozen=True)
class SendImage:
    """An image (JPEG, PNG or WebP) that the robot took at (x, y) of ``object``; the bytes are the payload.

    ``media_type`` may be left out: it is derived from the bytes. ``t`` and ``source`` are as in
    :class:`SetObject`.
    """

    image: bytes
    x: float
    y: float
    object: str
    media_type: str | None = None
    t: float | None = None
    source: str | None = None
    magic: int | None = None
    acknowledged: ClassVar[bool] = True
    ranges: ClassVar[base.Ranges] = {
        "x": base.COORDINATE,
        "y": base.COORDINATE,
        "t": base.CLOCK,
    }
    texts: ClassVar[base.Texts] = {
        "object": base.LONGEST_LABEL,
        "media_type": base.LONGEST_LABEL,
        "source": base.LONGEST_LABEL,
    }

    def __post_init__(self) -> None:
        base.check_ranges(self)
        base.check_texts(self)


@dataclass(frozen=True)
class Start:
    """The server accepts requests from now on; ``database`` identifies its database.

    ``gateways`` are the URLs of all gateways that serve the fleet, this one's first, where several do: at any
    of them the robot may connect, under its name, when its own does not answer.
    """

    database: str | None = None
    gateways: list[str] | None = None

    def __post_init__(self) -> None:
        if self.gateways is not None:
            object.__setattr__(self, "gateways", base.usable_addresses(self.gateways))


@dataclass(frozen=True)
class Abort:
    """The robot must abort its current task; with ``emergency`` every robot must, and this comes first."""

    emergency: bool = False
    stops: ClassVar[bool] = True


@dataclass(frozen=True)
class SetMap:
    """A robot map in the binary format; the bytes travel as the message's payload."""

    map: bytes


@dataclass(frozen=True)
class SetPath:
    """A path to drive to its end: at least two points, metres; ``theta`` the heading to stand in there.

    ``cone`` and ``collect`` (our additions): place a cone at the end, or pick up the one that stands
    there. They are sent only to robots that declare ``path_cones`` in Ready.
    """

    points: list[tuple[float, float]]
    theta: float | None = None
    cone: bool | None = None
    collect: bool | None = None

    def __post_init__(self) -> None:
        base.check_finite(theta=self.theta)
        _check_cone(self)
        if len(self.points) < 2:
            raise base.MessageError(f"points holds {len(self.points)} points; a path has at least two")
        for number, (x, y) in enumerate(self.points):
            base.check_finite(**{f"points[{number}].x": x, f"points[{number}].y": y})


@dataclass(frozen=True)
class SetPosEnd:
    """The end of the track: a target, the heading to stand in if it matters; ``cone``: place one there.

    ``collect`` (our addition): pick up the cone that stands there.
    """

    x: float
    y: float
    theta: float | None = None
    cone: bool = False
    collect: bool | None = None

    def __post_init__(self) -> None:
        base.check_finite(x=self.x, y=self.y, theta=self.theta)
        _check_cone(self)


def path_to_end(task: SetPosEnd | SetPath, points: list[tuple[float, float]]) -> SetPath:
    """Return the path along ``points`` to the end of ``task``.

    The way to a target carries no cone: that stays the robot's task. A path takes the cone of the one before.
    """
    if isinstance(task, SetPath):
        return replace(task, points=points)
    return SetPath(points, task.theta)


def _check_cone(end: SetPosEnd | SetPath) -> None:
    if end.cone and end.collect:
        raise base.MessageError("cone and collect are both true; a cone is placed or collected, not both")


@dataclass(frozen=True)
class SetPosIni:
    """The beginning of the track: where the robot is to take itself to be, and its heading if known."""

    x: float
    y: float
    theta: float | None = None

    def __post_init__(self) -> None:
        base.check_finite(x=self.x, y=self.y, theta=self.theta)


Position = SendPos | SendGPS
Observed = SetObject | SendImage
Question = GetMap | GetPath | GetPosIni | GetPosEnd | GetSurface
Request = Ready | Stopped | Alive | OpAck | Position | Question | Observed
Command = SetPosEnd | SetPath | SetPosIni | Abort
MOTIONS = SetPosEnd, SetPath
"""Commands that set a robot in motion: a stop holds them back, and an Abort makes them void."""
MOTION_OPS = tuple(motion.__name__ for motion in MOTIONS)
Answer = Start | OpAck | SetMap | SetSurface | Command

REQUESTS: dict[str, type[Request]] = {
    cls.__name__: cls
    for cls in (
        Ready,
        Stopped,
        Alive,
        OpAck,
        SendPos,
        SendGPS,
        SendImage,
        GetMap,
        GetPath,
        GetPosIni,
        GetPosEnd,
        SetObject,
        GetSurface,
    )
}
ANSWERS: dict[str, type[Answer]] = {
    cls.__name__: cls for cls in (Start, OpAck, Abort, SetMap, SetPath, SetPosIni, SetPosEnd, SetSurface)
}
COMMANDS: dict[str, type[Command]] = {cls.__name__: cls for cls in (SetPosEnd, SetPath, SetPosIni, Abort)}
"""The answers that an operator can send as commands."""
PAYLOADS: dict[str, str] = {"SetMap": "map", "SendImage": "image"}
"""The binary parameter of a message: the payload on SQL, base64 text inside the JSON on WebSocket."""
