"""Requests of operators and their results."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any, ClassVar, get_args

from .administration import (
    AddOperator,
    AuditReport,
    ChooseSite,
    EndSession,
    GetAudit,
    GetOperators,
    GetSessions,
    GetSites,
    RemoveRobots,
    RevokeToken,
    Role,
    RotateToken,
    SessionReport,
    SetPlayback,
    SetRole,
)
from .plans import (
    ClearPlan,
    ConfirmReplan,
    DiscardReplan,
    GetPlans,
    PausePlan,
    PlanReport,
    Replan,
    ResumePlan,
    SubmitPlan,
)
from .queues import (
    AddTasks,
    GetQueue,
    MakeCurrent,
    MoveTask,
    PauseQueue,
    PauseRobot,
    QueueReport,
    RemoveTask,
    ResumeQueue,
    SetQueue,
    TakeOver,
)
from .records import (
    CollectLayout,
    GetImage,
    GetObservations,
    GetPlacements,
    GetTrajectory,
    ObservationReport,
    ReviewObservation,
)
from .roads import (
    CloseRoad,
    GetClosures,
    GetConflicts,
    GetRoute,
    GetSurfaces,
    GetWaysOut,
    OpenRoad,
    ResolveConflict,
)
from .safety import (
    AbortTask,
    ClearEmergencyStop,
    EmergencyReport,
    EmergencyStop,
    PathDeclaration,
    RobotState,
    check_override,
    check_reason,
)
from .validation import (
    LONGEST_OPERATOR,
    MessageError,
    check_command_id,
    check_crs,
    check_expires_in,
    check_finite,
    check_robot_name,
)

# --- Positions as a table of numbers: what a desk asks for that shows thousands of robots ---
# A binary frame (:mod:`..core.position_frame`): a JSON-RPC notification ``positions`` whose params are
# :class:`PositionColumns`, and behind it each of its columns, one 64-bit float for each robot. What is not
# known of a robot is NaN. A column of :data:`POSITION_TEXTS` holds places in ``words``. A link tells the
# gateway of its robots in the same form.

POSITION_NUMBERS = (
    "age", "x", "y", "theta", "v", "device_time", "fix_time", "pose_age",
    "latency", "battery", "accuracy", "altitude",
)  # fmt: skip
POSITION_FLAGS = ("stopped",)
"""1 for true, 0 for false."""
POSITION_TEXTS = ("state", "link", "status", "command", "theta_from", "paths", "abilities")
POSITION_ALWAYS = ("age", "stopped", "state", "link")
"""What is known of every robot."""


class PositionForm(str, Enum):
    """How positions are told: a JSON object for each robot, or a table of numbers behind a JSON head."""

    ROWS = "rows"
    COLUMNS = "columns"


@dataclass(frozen=True)
class PositionColumns:
    """What the table behind it holds, at the gateway's time ``t``.

    ``columns`` are names of RobotReport's fields, in the order in which they follow, 64-bit little-endian
    floats, one for each of ``robots``; NaN is what is not known, and what is known of no robot is left out.
    In columns ``state``, ``link``, ``status``, ``command``, ``theta_from``, ``paths`` and ``abilities`` a
    number is a place in ``words``, counted from 0. With ``everything`` they are all robots that there are;
    otherwise ``removed`` are gone for good.
    """

    t: float
    robots: list[str]
    columns: list[str]
    words: list[str]
    removed: list[str] = field(default_factory=list)
    everything: bool = False


# --- What operators ask and are told ---

PROTOCOL_VERSION = 1
LONGEST_EXPIRY = 366 * 86400.0
"""seconds."""


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


@dataclass  # not frozen: thousands are made every second, and a frozen one takes three times as long
class RobotReport:
    """One robot as the gateway knows it. ``age`` is seconds since its last message, when this was sent.

    A robot that has said Ready and not yet where it is has no pose: x, y, theta, v are None. ``device_time``
    and ``fix_time`` are the robot's own clocks, ``pose_age`` is seconds since its pose came in, by the
    gateway's. ``latency`` is the seconds that the robot's link took there and back when last measured.
    ``paths`` is what the robot declared in Ready about its paths, None of one that declared nothing: it
    drives straight to a target, and places no cone at the end of a path. ``abilities`` are what it can do,
    with spaces between them: empty of one that is only seen, None of one that can do everything.
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
    fix_time: float | None = None
    pose_age: float | None = None
    latency: float | None = None
    battery: float | None = None
    status: str | None = None
    command: str | None = None
    accuracy: float | None = None
    altitude: float | None = None
    theta_from: str | None = None
    paths: PathDeclaration | None = None
    abilities: str | None = None


@dataclass(frozen=True)
class CommandStep:
    """One step in the life of a command: what it became, when, by whom, and why."""

    state: CommandState
    at: float
    by: str
    reason: str | None = None


@dataclass(frozen=True)
class CommandReport:
    """A command with every step so far; ``deviation`` is metres between target and robot when reached.

    ``stood`` is where the robot stood then: x, y in metres and theta in radians, site frame.
    """

    command: str
    robot: str
    op: str
    params: dict[str, Any]
    operator: str
    state: CommandState
    steps: list[CommandStep] = field(default_factory=list)
    deviation: float | None = None
    stood: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class SiteReport:
    """The site that a gateway serves: its frame (CRS, origin, rotation in radians) and its bounds.

    ``bounds`` is x_min, y_min, x_max, y_max in the site frame. ``roads`` says that the gateway finds ways
    along roads on it.
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
    roads: bool = False


@dataclass(frozen=True)
class Hello:
    """An operator's first message; answered with a SiteReport under ``site`` and the protocol's version.

    ``operator`` is a name on one line, of at most 128 printable characters.
    """

    method: ClassVar[str] = "hello"
    operator: str
    protocol: int = PROTOCOL_VERSION

    def __post_init__(self) -> None:
        if not (len(self.operator) <= LONGEST_OPERATOR and self.operator.strip().isprintable()):
            raise MessageError(
                f"operator has {len(self.operator)} characters and begins {self.operator[:40]!r}; give a "
                f"name of at most {LONGEST_OPERATOR} printable characters on one line"
            )


@dataclass(frozen=True)
class Subscribe:
    """Ask for ``positions`` up to ``rate`` times a second, what changed only; everything at first.

    ``form`` says whether they come as an object for each robot or as a table of numbers.
    """

    method: ClassVar[str] = "subscribe"
    rate: float = 5.0
    form: PositionForm = PositionForm.ROWS

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
    """One robot's target in SetPositions: metres in the site frame, or coordinates in the CRS ``crs``.

    ``cone``: place one there; not unless it is asked for, as with SetPosEnd.

    In a CRS such as ``EPSG:4326`` x (longitude, easting) comes before y whatever the CRS; ``theta`` is
    counted from the x axis of the site frame all the same.
    """

    robot: str
    x: float
    y: float
    theta: float | None = None
    cone: bool = False
    crs: str | None = None

    def __post_init__(self) -> None:
        check_crs(self.crs)
        check_finite(x=self.x, y=self.y, theta=self.theta)


@dataclass(frozen=True)
class SetPositions:
    """Send target positions (the second paper's ``set_positions``): all of them are accepted, or none."""

    method: ClassVar[str] = "set_positions"
    positions: list[TargetPosition]


@dataclass(frozen=True)
class Send:
    """Ask for one command. ``command`` is an id that the operator's side invents: sent twice, done once.

    ``params`` are those of ``op``, with places in metres in the site frame, or with ``crs`` among them in
    that CRS, such as ``EPSG:4326``: x (longitude, easting) before y. ``theta`` is the site frame's always.

    It is given up when the robot has not fetched it within ``expires_in`` seconds, if that is given, else
    within the time that the site's settings say. ``override`` says what speaks against it, and why it is
    asked for all the same: it stands in the command's log, and takes the role that the site's settings say.
    """

    method: ClassVar[str] = "send"
    command: str
    robot: str
    op: str
    params: dict[str, Any] = field(default_factory=dict)
    expires_in: float | None = None
    reason: str | None = None
    override: str | None = None

    def __post_init__(self) -> None:
        check_command_id(self.command)
        check_reason(self.reason)
        check_override(self.override)
        check_expires_in(self.expires_in, LONGEST_EXPIRY)


@dataclass(frozen=True)
class AbortAll:
    """Ask every robot to abort its task; answered with the commands that do it.

    ``command`` is an id that the operator's side invents: sent twice, done once.
    """

    method: ClassVar[str] = "abort_all"
    stops: ClassVar[bool] = True
    command: str | None = None
    reason: str | None = None

    def __post_init__(self) -> None:
        check_reason(self.reason)
        if self.command is not None:
            check_command_id(self.command)


@dataclass(frozen=True)
class SendMap:
    """Have a robot sent the map of the whole site now, as it is sent one when it connects."""

    method: ClassVar[str] = "send_map"
    robot: str

    def __post_init__(self) -> None:
        check_robot_name(self.robot)


@dataclass(frozen=True)
class GetCommands:
    """Ask for the newest ``limit`` commands with their steps, newest first, of one robot or of all."""

    method: ClassVar[str] = "get_commands"
    robot: str | None = None
    limit: int = 200

    def __post_init__(self) -> None:
        if not 1 <= self.limit <= 10_000:
            raise MessageError(f"limit is {self.limit}; give a number from 1 to 10000")


DeskRequest = (
    Hello
    | Subscribe
    | GetPositions
    | SetPositions
    | Send
    | SendMap
    | AbortAll
    | AbortTask
    | EmergencyStop
    | ClearEmergencyStop
    | GetCommands
    | GetObservations
    | GetImage
    | ReviewObservation
    | GetSessions
    | EndSession
    | GetAudit
    | GetOperators
    | AddOperator
    | RotateToken
    | RevokeToken
    | SetRole
    | GetSites
    | ChooseSite
    | GetTrajectory
    | GetSurfaces
    | SetQueue
    | AddTasks
    | MoveTask
    | RemoveTask
    | MakeCurrent
    | PauseQueue
    | PauseRobot
    | ResumeQueue
    | GetQueue
    | TakeOver
    | SubmitPlan
    | GetPlans
    | PausePlan
    | ResumePlan
    | Replan
    | ConfirmReplan
    | DiscardReplan
    | ClearPlan
    | GetPlacements
    | CollectLayout
    | GetRoute
    | CloseRoad
    | OpenRoad
    | GetClosures
    | GetConflicts
    | GetWaysOut
    | ResolveConflict
    | RemoveRobots
    | SetPlayback
)

DESK_REQUESTS: dict[str, type[DeskRequest]] = {cls.method: cls for cls in get_args(DeskRequest)}


# --- What operators' requests are answered with ---


@dataclass(frozen=True)
class HelloResult:
    """The answer to ``hello``: which protocol is spoken here, the site, and who you are to the gateway.

    ``database`` tells the gateway's database from every other: with another one, robots and commands of the
    same names are others.
    """

    protocol: int
    site: SiteReport
    operator: str
    role: Role
    emergency: EmergencyReport
    database: str = ""


@dataclass(frozen=True)
class Done:
    """The answer to what has nothing to tell."""


@dataclass(frozen=True)
class Positions:
    """Where robots are, at the gateway's time ``t``.

    With ``everything`` they are all robots that there are; otherwise ``removed`` are gone for good.
    """

    t: float
    robots: list[RobotReport]
    removed: list[str] = field(default_factory=list)
    everything: bool = False


@dataclass(frozen=True)
class Commands:
    """Commands with every step of their lives."""

    commands: list[CommandReport]


@dataclass(frozen=True)
class Observations:
    """What robots saw, newest first."""

    observations: list[ObservationReport]


@dataclass(frozen=True)
class Image:
    """An image, in base64."""

    media_type: str
    image: bytes


@dataclass(frozen=True)
class Sessions:
    """Operators' connections, newest first."""

    sessions: list[SessionReport]


@dataclass(frozen=True)
class Audit:
    """Who did what, newest first."""

    entries: list[AuditReport]


@dataclass(frozen=True)
class Plans:
    """Plans, those that are driven first."""

    plans: list[PlanReport]


@dataclass(frozen=True)
class Queues:
    """What robots are to do one after the other, by robot."""

    queues: list[QueueReport]
