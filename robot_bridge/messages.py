"""The messages of the bridge: one definition for every wire.

The first part is the paper's: what robots ask (table II) and what the server answers (table III), each
under its own operation code, which is the class's name. The second part is what operators ask and are
told. On SQL a message is a row (``op``, ``params`` as JSON, ``payload``); on WebSocket it is JSON-RPC 2.0
with the operation code as the method.

Positions are metres in the site frame, angles radians counter-clockwise from its x axis, times seconds
since 1970-01-01 UTC. Nothing here is imported but the standard library, so that QGIS can load it.
"""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, ClassVar

PROTOCOL_VERSION = 1
ROBOT_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,62}")
LARGEST_NUMBER = 2**63 - 1
"""What an integer column of a database holds."""


class MessageError(ValueError):
    """A message that cannot be understood; the text names the operation, the parameter and what is right."""


def check_finite(**numbers: float | None) -> None:
    """Refuse NaN and infinity; raises MessageError naming the parameter."""
    for name, value in numbers.items():
        if value is not None and not math.isfinite(value):
            raise MessageError(f"{name} is {value}; give a finite number")


def check_stored_number(**numbers: int | None) -> None:
    """Refuse an integer that a database column cannot hold; raises MessageError naming the parameter."""
    for name, value in numbers.items():
        if value is not None and not 0 <= value <= LARGEST_NUMBER:
            raise MessageError(f"{name} is {value}; give a whole number from 0 to {LARGEST_NUMBER}")


def check_robot_name(name: str) -> str:
    """Return ``name`` if it can name a robot, else raise MessageError."""
    if not ROBOT_NAME.fullmatch(name):
        raise MessageError(
            f"robot name {name!r} cannot be used; take 1 to 63 letters, digits, '_', '.' or '-', "
            "beginning with a letter or digit"
        )
    return name


def check_command_id(command: str) -> None:
    """Refuse an id that cannot tell one command from every other; raises MessageError."""
    if not 8 <= len(command) <= 64:
        raise MessageError(f"command is {command!r}; give an id of 8 to 64 characters, say a UUID")


# --- what robots ask and servers answer (paper 1, tables II and III) --------------------------------------


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


# --- what operators ask and are told ----------------------------------------------------------------------


class RobotState(str, Enum):
    """How far the knowledge of a robot can be trusted (see :mod:`.liveness`)."""

    FRESH = "fresh"
    STALE = "stale"
    LOST = "lost"
    OFFLINE = "offline"


class CommandState(str, Enum):
    """Where a command is in its life (see :mod:`.command_life`)."""

    QUEUED = "queued"
    DELIVERED = "delivered"
    ACKNOWLEDGED = "acknowledged"
    REACHED = "reached"
    ABORTED = "aborted"
    FAILED = "failed"
    EXPIRED = "expired"
    SUPERSEDED = "superseded"


@dataclass(frozen=True)
class RobotReport:
    """One robot as the gateway knows it. ``age`` is seconds since its last message, when this was sent.

    A robot that has said Ready and not yet where it is has no pose: x, y, theta, v are None.
    """

    robot: str
    state: RobotState
    age: float
    link: str
    stopped: bool = False
    x: float | None = None
    y: float | None = None
    theta: float | None = None
    v: float | None = None
    device_time: float | None = None
    battery: float | None = None
    status: str | None = None
    command: str | None = None


@dataclass(frozen=True)
class CommandStep:
    """One step in the life of a command: what it became, when, by whom, and why."""

    state: CommandState
    at: float
    by: str
    reason: str | None = None


@dataclass(frozen=True)
class CommandReport:
    """A command with every step so far; ``deviation`` is metres between target and robot when reached."""

    command: str
    robot: str
    op: str
    params: dict[str, Any]
    operator: str
    state: CommandState
    steps: list[CommandStep] = field(default_factory=list)
    deviation: float | None = None


@dataclass(frozen=True)
class SiteReport:
    """The site that a gateway serves: its frame (CRS, origin, rotation in radians) and its bounds.

    ``bounds`` is x_min, y_min, x_max, y_max in the site frame.
    """

    id: str
    name: str
    version: int
    crs: str
    origin: tuple[float, float]
    rotation: float
    bounds: tuple[float, float, float, float]
    reached_tolerance: float
    stale_after: float
    lost_after: float


@dataclass(frozen=True)
class Hello:
    """An operator's first message; answered with a SiteReport under ``site`` and the protocol's version."""

    method: ClassVar[str] = "hello"
    operator: str
    protocol: int = PROTOCOL_VERSION


@dataclass(frozen=True)
class Subscribe:
    """Ask for ``positions`` up to ``rate`` times a second, what changed only; everything at first."""

    method: ClassVar[str] = "subscribe"
    rate: float = 5.0

    def __post_init__(self) -> None:
        check_finite(rate=self.rate)
        if not 0 < self.rate <= 50:
            raise MessageError(f"rate is {self.rate}; give snapshots a second, above 0 and up to 50")


@dataclass(frozen=True)
class GetPositions:
    """Ask for the position of every robot (the second paper's ``get_positions``)."""

    method: ClassVar[str] = "get_positions"


@dataclass(frozen=True)
class TargetPosition:
    """One robot's target in SetPositions."""

    robot: str
    x: float
    y: float
    theta: float | None = None
    cone: bool = True

    def __post_init__(self) -> None:
        check_finite(x=self.x, y=self.y, theta=self.theta)


@dataclass(frozen=True)
class SetPositions:
    """Send target positions (the second paper's ``set_positions``): all of them are accepted, or none."""

    method: ClassVar[str] = "set_positions"
    positions: list[TargetPosition]


@dataclass(frozen=True)
class Send:
    """Ask for one command. ``command`` is an id that the operator's side invents: sent twice, done once."""

    method: ClassVar[str] = "send"
    command: str
    robot: str
    op: str
    params: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_command_id(self.command)


@dataclass(frozen=True)
class AbortAll:
    """Ask every robot to abort its task; answered with the commands that do it.

    ``command`` is an id that the operator's side invents: sent twice, done once.
    """

    method: ClassVar[str] = "abort_all"
    command: str | None = None

    def __post_init__(self) -> None:
        if self.command is not None:
            check_command_id(self.command)


@dataclass(frozen=True)
class GetCommands:
    """Ask for the newest ``limit`` commands with their steps, newest first, of one robot or of all."""

    method: ClassVar[str] = "get_commands"
    robot: str | None = None
    limit: int = 200

    def __post_init__(self) -> None:
        if not 1 <= self.limit <= 10_000:
            raise MessageError(f"limit is {self.limit}; give a number from 1 to 10000")


DeskRequest = Hello | Subscribe | GetPositions | SetPositions | Send | AbortAll | GetCommands

DESK_REQUESTS: dict[str, type[DeskRequest]] = {
    cls.method: cls
    for cls in (Hello, Subscribe, GetPositions, SetPositions, Send, AbortAll, GetCommands)
}


# --- to and from plain JSON values ------------------------------------------------------------------------


def to_json(message: Any) -> dict[str, Any]:
    """Return a message as JSON values; what is None is left out, a bytes field is left to the payload."""
    return {
        name: _plain(value)
        for name, value in ((f.name, getattr(message, f.name)) for f in dataclasses.fields(message))
        if value is not None and not isinstance(value, bytes)
    }


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return to_json(value)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def robot_report(values: dict[str, Any]) -> RobotReport:
    """Return the report that a gateway sent as JSON; unknown fields of newer gateways are passed over."""
    return RobotReport(**{**_known(RobotReport, values), "state": RobotState(values["state"])})


def command_report(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON."""
    steps = [
        CommandStep(**{**_known(CommandStep, step), "state": CommandState(step["state"])})
        for step in values.get("steps", [])
    ]
    return CommandReport(
        **{**_known(CommandReport, values), "state": CommandState(values["state"]), "steps": steps}
    )


def site_report(values: dict[str, Any]) -> SiteReport:
    """Return the site that a gateway sent as JSON."""
    known = _known(SiteReport, values)
    return SiteReport(**{**known, "origin": tuple(values["origin"]), "bounds": tuple(values["bounds"])})


def _known(cls: type, values: dict[str, Any]) -> dict[str, Any]:
    names = {f.name for f in dataclasses.fields(cls)}
    return {name: value for name, value in values.items() if name in names}
