"""What robots ask (paper 1, table II) and what the server answers (table III).

Each message stands under its own operation code, which is the class's name. On SQL it is a row (``op``,
``params`` as JSON, ``payload``); on WebSocket it is JSON-RPC 2.0 with the operation code as the method.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .checks import MessageError, check_finite, check_stored_number


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

    The answer to Ready carries the robot's ``magic`` number back and the name it is known by.
    """

    id: int | None = None
    ok: bool = True
    reason: str | None = None
    magic: int | None = None
    robot: str | None = None
    acknowledged: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_stored_number(id=self.id, magic=self.magic)


@dataclass(frozen=True)
class SendPos:
    """Where the robot is: pose, velocity (m/s), and optionally device time, battery (0 to 1), status."""

    x: float
    y: float
    theta: float
    v: float
    t: float | None = None
    battery: float | None = None
    status: str | None = None
    acknowledged: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, theta=self.theta, v=self.v, t=self.t, battery=self.battery)
        if self.battery is not None and not 0 <= self.battery <= 1:
            raise MessageError(f"battery is {self.battery}; give the charge from 0 (empty) to 1 (full)")


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
class Start:
    """The server listens to requests from now on."""


@dataclass(frozen=True)
class Abort:
    """The robot must abort its current task."""


@dataclass(frozen=True)
class SetMap:
    """A robot map in the binary format; the bytes travel as the message's payload."""

    map: bytes


@dataclass(frozen=True)
class SetPath:
    """A path to drive to its end: at least two points, metres."""

    points: list[tuple[float, float]]

    def __post_init__(self) -> None:
        if len(self.points) < 2:
            raise MessageError(f"points holds {len(self.points)} points; a path has at least two")
        for number, (x, y) in enumerate(self.points):
            check_finite(**{f"points[{number}].x": x, f"points[{number}].y": y})


@dataclass(frozen=True)
class SetPosEnd:
    """The end of the track: a target, the heading to stand in if it matters; ``cone``: place one there."""

    x: float
    y: float
    theta: float | None = None
    cone: bool = False

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, theta=self.theta)


Request = Ready | Stopped | Alive | OpAck | SendPos | GetMap
Answer = Start | OpAck | Abort | SetMap | SetPath | SetPosEnd

REQUESTS: dict[str, type[Request]] = {
    cls.__name__: cls for cls in (Ready, Stopped, Alive, OpAck, SendPos, GetMap)
}
ANSWERS: dict[str, type[Answer]] = {
    cls.__name__: cls for cls in (Start, OpAck, Abort, SetMap, SetPath, SetPosEnd)
}
COMMANDS: dict[str, type[SetPosEnd | SetPath | Abort]] = {
    cls.__name__: cls for cls in (SetPosEnd, SetPath, Abort)
}
"""The answers that an operator can ask for as a command."""
