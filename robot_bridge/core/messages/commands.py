"""Commands of operators to robots: sent, aborted and reported."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from ..errors import RefusedError
from . import base
from .base import DeskRequest, Done, MessageError, Priority, Role, known_fields
from .robots import Abort
from .safety import check_override, check_reason

ABORT_VALID_S = 86_400.0
"""seconds for which an Abort waits for its robot, or for a database: then the robot does something else."""


class CommandState(str, Enum):
    """The state of a command (see ``gateway/commands/active_command.py``)."""

    QUEUED = "queued"
    DELIVERED = "delivered"
    ACKNOWLEDGED = "acknowledged"
    REACHED = "reached"
    ABORTED = "aborted"
    FAILED = "failed"
    EXPIRED = "expired"
    SUPERSEDED = "superseded"

    @property
    def is_open(self) -> bool:
        """Whether a command in this state still has a step to come."""
        return self in (CommandState.QUEUED, CommandState.DELIVERED, CommandState.ACKNOWLEDGED)


@dataclass(frozen=True)
class CommandStep:
    """One step in the life of a command: the new state, when, by whom, and why."""

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
class RefusedRobot:
    """A robot to which nothing was sent, and why."""

    robot: str
    reason: str


@dataclass(frozen=True)
class Commands:
    """Commands with all their steps.

    After ``set_positions`` for robots of several gateways, ``refused`` lists those that got no target.
    """

    commands: list[CommandReport]
    refused: list[RefusedRobot] | None = None


LONGEST_EXPIRY = 366 * 86400.0
"""seconds."""


@dataclass(frozen=True)
class TargetPosition:
    """One robot's target in SetPositions: metres in the site frame, or coordinates in the CRS ``crs``.

    ``cone``: place one there; only if requested, as with SetPosEnd.

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
        base.check_crs(self.crs)
        base.check_finite(x=self.x, y=self.y, theta=self.theta)


@dataclass(frozen=True)
class SetPositions(DeskRequest[Commands]):
    """Send target positions (the second paper's ``set_positions``): all of them are accepted, or none.

    Robots of several gateways are the exception: then it holds for each gateway by itself.
    """

    method = "set_positions"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    positions: list[TargetPosition]

    def check_named_once(self) -> None:
        """Raise RefusedError where a robot is named more than once."""
        names = [position.robot for position in self.positions]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise RefusedError(
                f"positions: {', '.join(twice)} is named more than once; give each robot one target"
            )


@dataclass(frozen=True)
class Send(DeskRequest[CommandReport]):
    """Ask for one command. ``command`` is an id that the client chooses: sent twice, done once.

    ``params`` are those of ``op``, with places in metres in the site frame, or with ``crs`` among them in
    that CRS, such as ``EPSG:4326``: x (longitude, easting) before y. ``theta`` is the site frame's always.

    It is given up when the robot has not fetched it within ``expires_in`` seconds, if that is given, else
    within the time that the site's settings say. ``override`` states the objections and the reason to
    proceed: it is stored in the command's log, and requires the role that the site's settings say.
    """

    method = "send"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    command: str
    robot: str
    op: str
    params: dict[str, Any] = field(default_factory=dict)
    expires_in: float | None = None
    reason: str | None = None
    override: str | None = None

    def __post_init__(self) -> None:
        base.check_command_id(self.command)
        check_reason(self.reason)
        check_override(self.override)
        base.check_expires_in(self.expires_in, LONGEST_EXPIRY)


@dataclass(frozen=True)
class SendMap(DeskRequest[Done]):
    """Send a robot the map of the whole site now, as when it connects."""

    method = "send_map"
    least_role = Role.OPERATOR
    robot: str

    def __post_init__(self) -> None:
        base.check_robot_name(self.robot)


@dataclass(frozen=True)
class AbortAll(DeskRequest[Commands]):
    """Ask every robot to abort its task; answered with the commands for that.

    ``command`` is an id that the client chooses: sent twice, done once.
    """

    method = "abort_all"
    least_role = Role.OPERATOR
    priority = Priority.STOP
    stops = True
    command: str | None = None
    reason: str | None = None

    def __post_init__(self) -> None:
        check_reason(self.reason)
        if self.command is not None:
            base.check_command_id(self.command)


@dataclass(frozen=True)
class GetCommands(DeskRequest[Commands]):
    """Ask for the newest ``limit`` commands with their steps, newest first, of one robot or of all."""

    method = "get_commands"
    least_role = Role.VIEWER
    robot: str | None = None
    limit: int = 200

    def __post_init__(self) -> None:
        if not 1 <= self.limit <= 10_000:
            raise MessageError(f"limit is {self.limit}; give a number from 1 to 10000")


@dataclass(frozen=True)
class AbortTask(DeskRequest[CommandReport]):
    """Ask to abort one command, named by ``aborts``, or the present task of ``robot``.

    ``command`` is an id that the client chooses: sent twice, done once. If that command was superseded or has
    ended in the meantime, the request is refused, and its successor is not aborted either.
    """

    method = "abort"
    least_role = Role.OPERATOR
    priority = Priority.STOP
    stops = True
    command: str
    robot: str | None = None
    aborts: str | None = None
    reason: str | None = None

    def __post_init__(self) -> None:
        base.check_command_id(self.command)
        check_reason(self.reason)
        if (self.robot is None) == (self.aborts is None):
            raise MessageError("give one of robot and aborts: whose task is to end, or which command")
        if self.robot is not None:
            base.check_robot_name(self.robot)


# --- Requests overtaken by a stop, on the way from the desk and at the gateway ---

MOVING = (Priority.MOVE, Priority.MOVE_SEVERAL)


def stops_robots(request: type[DeskRequest[Any]], op: str | None) -> bool:
    """Return whether a request stops robots at once; ``op`` is that of a ``send``, which may be an Abort."""
    return request.priority is Priority.STOP or (request is Send and op == Abort.__name__)


def is_overtaken(request: type[DeskRequest[Any]], robot: str | None, stopped: str | None) -> bool:
    """Return whether a request for ``robot`` would start a motion that a later stop of ``stopped`` prevents.

    None means every robot, or more than the one named. The caller must except an Abort by ``send``.
    """
    if request.priority not in MOVING:
        return False
    several = request.priority is Priority.MOVE_SEVERAL
    return several or robot is None or stopped is None or robot == stopped


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def command_report(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON."""
    steps = [
        CommandStep(**{**known_fields(CommandStep, step), "state": CommandState(step["state"])})
        for step in values.get("steps", [])
    ]
    report = CommandReport(
        **{**known_fields(CommandReport, values), "state": CommandState(values["state"]), "steps": steps}
    )
    if report.stood is None:
        return report
    x, y, theta = report.stood
    return replace(report, stood=(x, y, theta))
