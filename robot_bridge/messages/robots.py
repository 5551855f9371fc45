"""What robots ask (paper 1, table II) and what the server answers (table III).

Each message stands under its own operation code, which is the class's name. On SQL it is a row (``op``,
``params`` as JSON, ``payload``); on WebSocket it is JSON-RPC 2.0 with the operation code as the method.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

from .checks import (
    MessageError,
    Ranges,
    Texts,
    check_finite,
    check_ranges,
    check_stored_number,
    check_texts,
)
from .surfaces import GetSurface, SetSurface

LONGEST_LABEL = 128
"""characters; of an object's id, its label and a robot's own number of an observation."""


@dataclass(frozen=True)
class Ready:
    """The robot is ready to start tasks and listens for answers; ``magic`` comes back in the OpAck."""

    magic: int
    acknowledged: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_stored_number(magic=self.magic)


@dataclass(frozen=True)
class Stopped:
    """The robot stands and does nothing; one that falls silent after this is offline, not lost."""

    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class Alive:
    """The robot is alive; sent at least every second when nothing else is."""

    acknowledged: ClassVar[bool] = False


@dataclass(frozen=True)
class OpAck:
    """The other side received message ``id``; with ``ok`` false it will not do it, and ``reason`` says why.

    The answer to Ready carries the robot's ``magic`` number back, the name it is known by, and the
    ``database`` that the ids of the server's messages belong to.
    """

    id: int | None = None
    ok: bool = True
    reason: str | None = None
    magic: int | None = None
    robot: str | None = None
    database: str | None = None
    acknowledged: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_stored_number(id=self.id, magic=self.magic)


@dataclass(frozen=True)
class SendPos:
    """Where the robot is: pose, velocity (m/s), and optionally device time, battery (0 to 1), status.

    ``fix_t`` is when the position was measured, ``t`` when it was sent, both by the robot's clock;
    ``accuracy`` is the standard deviation of the position in metres. ``theta_from`` says that theta was not
    measured: it is the ``course`` over ground, the ``last`` one known, or ``unknown`` and then 0.
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
    acknowledged: ClassVar[bool] = False
    ranges: ClassVar[Ranges] = {"battery": (0, 1), "accuracy": (0, 1e6)}

    def __post_init__(self) -> None:
        # Ten thousand of them come every second: what is wrong is looked for when something is.
        optional = (self.t or 0.0) + (self.fix_t or 0.0) + (self.altitude or 0.0)
        if not math.isfinite(self.x + self.y + self.theta + self.v + optional):
            check_finite(x=self.x, y=self.y, theta=self.theta, v=self.v)
            check_finite(t=self.t, fix_t=self.fix_t, altitude=self.altitude)
        if self.battery is not None or self.accuracy is not None:
            check_ranges(self)


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
    acknowledged: ClassVar[bool] = False
    ranges: ClassVar[Ranges] = {
        "lat": (-90, 90),
        "lon": (-180, 180),
        "heading": (0, 360),
        "accuracy": (0, 1e6),
        "battery": (0, 1),
    }

    def __post_init__(self) -> None:
        check_finite(altitude=self.altitude, v=self.v, t=self.t, fix_t=self.fix_t)
        check_ranges(self)


@dataclass(frozen=True)
class GetMap:
    """The robot asks for the map of a square of ``area`` square metres centred on (x, y)."""

    x: float
    y: float
    area: float
    acknowledged: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, area=self.area)
        if self.area <= 0:
            raise MessageError(f"area is {self.area}; give square metres above 0")


@dataclass(frozen=True)
class GetPath:
    """The robot asks for the path from where it is to the end of its task."""

    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class GetPosIni:
    """The robot asks for the beginning of its track."""

    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class GetPosEnd:
    """The robot asks for the end of its track."""

    acknowledged: ClassVar[bool] = True


@dataclass(frozen=True)
class SetObject:
    """The robot saw ``object`` at (x, y), metres in the site frame, and it belongs on the map.

    ``label`` says what it is, ``height`` and ``radius`` are in metres, ``t`` is when it was seen by the
    robot's clock. ``source`` is a number or name that the robot gives to what it tells: told again under the
    same one, it is stored once.
    """

    x: float
    y: float
    object: str
    label: str | None = None
    height: float | None = None
    radius: float | None = None
    t: float | None = None
    source: str | None = None
    acknowledged: ClassVar[bool] = True
    ranges: ClassVar[Ranges] = {"height": (0, 1000), "radius": (0.01, 50)}
    texts: ClassVar[Texts] = {"object": LONGEST_LABEL, "label": LONGEST_LABEL, "source": LONGEST_LABEL}

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, t=self.t)
        check_ranges(self)
        check_texts(self)


@dataclass(frozen=True)
class SendImage:
    """An image (JPEG, PNG or WebP) that the robot took at (x, y) of ``object``; the bytes are the payload.

    ``media_type`` may be left out: the bytes tell. ``t`` and ``source`` are as in :class:`SetObject`.
    """

    image: bytes
    x: float
    y: float
    object: str
    media_type: str | None = None
    t: float | None = None
    source: str | None = None
    acknowledged: ClassVar[bool] = True
    texts: ClassVar[Texts] = {"object": LONGEST_LABEL, "media_type": LONGEST_LABEL, "source": LONGEST_LABEL}

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, t=self.t)
        check_texts(self)


@dataclass(frozen=True)
class Start:
    """The server listens to requests from now on, with ``database`` behind it."""

    database: str | None = None


@dataclass(frozen=True)
class Abort:
    """The robot must abort its current task; with ``emergency`` every robot must, and this comes first."""

    emergency: bool = False


@dataclass(frozen=True)
class SetMap:
    """A robot map in the binary format; the bytes travel as the message's payload."""

    map: bytes


@dataclass(frozen=True)
class SetPath:
    """A path to drive to its end: at least two points, metres; ``theta`` the heading to stand in there."""

    points: list[tuple[float, float]]
    theta: float | None = None

    def __post_init__(self) -> None:
        check_finite(theta=self.theta)
        if len(self.points) < 2:
            raise MessageError(f"points holds {len(self.points)} points; a path has at least two")
        for number, (x, y) in enumerate(self.points):
            check_finite(**{f"points[{number}].x": x, f"points[{number}].y": y})


@dataclass(frozen=True)
class SetPosEnd:
    """The end of the track: a target, the heading to stand in if it matters; ``cone``: place one there.

    ``collect`` (an addition of ours): pick up the cone that stands there.
    """

    x: float
    y: float
    theta: float | None = None
    cone: bool = False
    collect: bool | None = None

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, theta=self.theta)
        if self.cone and self.collect:
            raise MessageError("cone and collect are both true; a cone is placed or collected, not both")


@dataclass(frozen=True)
class SetPosIni:
    """The beginning of the track: where the robot is to take itself to be, and its heading if known."""

    x: float
    y: float
    theta: float | None = None

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, theta=self.theta)


Position = SendPos | SendGPS
Observed = SetObject | SendImage
Question = GetMap | GetPath | GetPosIni | GetPosEnd | GetSurface
Request = Ready | Stopped | Alive | OpAck | Position | Question | Observed
Command = SetPosEnd | SetPath | SetPosIni | Abort
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
"""The answers that an operator can ask for as a command."""
PAYLOADS: dict[str, str] = {"SetMap": "map", "SendImage": "image"}
"""The parameter that is bytes: the payload on SQL, base64 text inside the JSON on WebSocket."""
