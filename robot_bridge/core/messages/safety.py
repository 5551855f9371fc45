"""State of robots, abort, emergency stop, geofence and nearness alarms."""

from __future__ import annotations

import uuid
from dataclasses import MISSING, dataclass, field, fields, replace
from enum import Enum
from typing import Any, Literal

from .base import DeskRequest, MessageError, Priority, Role, check_command_id, known_fields, one_line

# --- Freshness of the knowledge of a robot ---

PathDeclaration = Literal["asks", "cones", "asks and cones"]
"""What a robot declared in Ready: ``asks_path``, ``path_cones``, or both."""


Ability = Literal["targets", "paths", "start", "cones", "map", "images", "stop"]
"""What a robot can do: drive to targets, along paths, start elsewhere, place cones, use maps, send images.

With any of them it can be stopped; ``stop`` is for one that can do nothing else.
"""


class RobotState(str, Enum):
    """Freshness of the knowledge of a robot, by the age of its last message."""

    FRESH = "fresh"
    STALE = "stale"
    LOST = "lost"
    OFFLINE = "offline"


# --- Stops by operators: one task, one robot, and all robots in an emergency ---

LONGEST_REASON = 500
"""characters."""
LONGEST_OVERRIDE = 1000
"""characters."""


def check_reason(reason: str | None) -> None:
    """Refuse a reason that does not fit a line of the log; raises MessageError."""
    if reason is not None and not (len(reason) <= LONGEST_REASON and reason.isprintable()):
        raise MessageError(
            f"reason has {len(reason)} characters; give one line of at most {LONGEST_REASON} printable ones"
        )


def understood_stop(request: type[DeskRequest[Any]], params: object) -> dict[str, object]:
    """Return parameters of a request that stops robots with a valid id and reason, whatever was sent.

    An invalid id is replaced by one derived from it, the same each time, so that the stop is done once. A
    reason that does not fit a line of the log is adapted.
    """
    given = dict(params) if isinstance(params, dict) else {}
    # Each request is a dataclass, which its base does not say.
    known = {field.name: field for field in fields(request)}  # type: ignore[arg-type]
    sent = given.get("command")
    if "command" in known and (sent is not None or known["command"].default is MISSING):
        try:
            check_command_id(sent if isinstance(sent, str) else "")
        except MessageError:
            id = uuid.uuid4() if sent is None else uuid.uuid5(uuid.NAMESPACE_OID, repr(sent))
            given["command"] = str(id)
    if "reason" in given:
        given["reason"] = _reason_line(given["reason"])
    return given


def _reason_line(reason: object) -> str | None:
    text = reason[:LONGEST_REASON] if isinstance(reason, str) else ""
    return one_line(text, LONGEST_REASON).strip() or None


def check_override(override: str | None) -> None:
    """Refuse an override that is not one line for the log, saying what is overridden; raises MessageError."""
    if override is None:
        return
    if not (override.strip() and len(override) <= LONGEST_OVERRIDE and override.isprintable()):
        raise MessageError(
            f"override has {len(override)} characters; say in one line of at most {LONGEST_OVERRIDE} "
            "printable ones what speaks against it and why it is asked for all the same"
        )


@dataclass(frozen=True)
class StoppedGateways:
    """Where several gateways serve the fleet: an emergency stop is in force at ``reached`` ``of`` them.

    ``missing`` names the others: they have not answered yet, or cannot be reached. They learn of the stop
    within a second of reaching the database.
    """

    reached: int
    of: int
    missing: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class EmergencyReport:
    """The emergency stop in force, or the last one that was cleared; without ``stop`` there was none.

    Of ``robots`` known robots ``acknowledged`` have said that they stop and ``standing`` were seen to stand
    since; ``waiting`` names those that have not answered, ``refused`` those that answered that they will not
    (some fifty at most of either). Those of ``standing`` are in contact now, and their positions show that
    they stand: ``moving`` names robots that move now, whatever they answered, and ``unheard`` those that
    acknowledged but are silent now, so that it is unknown whether they stand; ``moving_more`` and
    ``unheard_more`` count others. ``gateways`` is None where one gateway serves the fleet. ``stored`` is
    false while the database could not be written: the stop holds, and the next gateway on this computer
    learns of it from a file.
    """

    in_force: bool = False
    stop: str | None = None
    at: float | None = None
    by: str | None = None
    reason: str | None = None
    stored: bool = True
    robots: int = 0
    acknowledged: int = 0
    standing: int = 0
    waiting: list[str] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    moving: list[str] = field(default_factory=list)
    moving_more: int = 0
    unheard: list[str] = field(default_factory=list)
    unheard_more: int = 0
    cleared_at: float | None = None
    cleared_by: str | None = None
    clear_reason: str | None = None
    gateways: StoppedGateways | None = None


@dataclass(frozen=True)
class EmergencyStop(DeskRequest[EmergencyReport]):
    """Stop every robot now and refuse motion commands until a supervisor clears it.

    ``command`` is an id that the client chooses: sent twice, done once, until the stop is cleared.
    """

    method = "emergency_stop"
    least_role = Role.OPERATOR
    priority = Priority.STOP
    stops = True
    command: str
    reason: str | None = None

    def __post_init__(self) -> None:
        check_command_id(self.command)

    @property
    def line(self) -> str | None:
        """The reason as one line of the log."""
        return _reason_line(self.reason)


@dataclass(frozen=True)
class ClearEmergencyStop(DeskRequest[EmergencyReport]):
    """Allow motion commands again. ``stop`` is the stop that the supervisor means, as last reported.

    ``stop`` prevents clearing by accident a newer one that the supervisor has not seen yet.
    """

    method = "clear_emergency_stop"
    least_role = Role.SUPERVISOR
    priority = Priority.MOVE
    reason: str | None = None
    stop: str | None = None

    def __post_init__(self) -> None:
        check_reason(self.reason)


# --- Reports to operators on robots in keepouts and at obstacles ---

FenceKind = Literal["keepout", "obstacle"]
StopAction = Literal["none", "pause", "abort"]
StopOutcome = Literal["none", "asked", "paused", "aborted", "stopped", "failed"]


@dataclass(frozen=True)
class FenceAlarm:
    """A robot that is in a keepout, or too near to an obstacle, since the time ``since``.

    ``name`` is the keepout's or the obstacle's; the robot came in at (``x``, ``y``), metres, site frame.
    ``action`` is the gateway's action by the site's settings, and ``outcome`` its result: ``asked`` until it
    is stored, ``stopped`` if an emergency stop held the robot already, ``failed`` with a ``reason`` as long
    as it could not be done; it is tried again. ``current`` is false if the robot is silent now: it was there
    at its last message.
    """

    robot: str
    kind: FenceKind
    name: str
    since: float
    x: float
    y: float
    action: StopAction = "none"
    outcome: StopOutcome = "none"
    reason: str | None = None
    current: bool = True


@dataclass(frozen=True)
class Geofence:
    """All robots in keepouts and at obstacles at the gateway's time ``t``, those that came in last first.

    ``more`` counts alarms that are not listed. ``keepouts`` and ``obstacles`` count what the published site
    has, with the objects that operators accepted: if there are none, nothing can be reported on them.
    ``unjudged`` names robots, at most 20, that may be anywhere: they have sent no position since they
    connected, or are silent; ``unjudged_more`` counts others. ``fault`` says why nothing is monitored.
    """

    t: float
    alarms: list[FenceAlarm] = field(default_factory=list)
    more: int = 0
    keepouts: int = 0
    obstacles: int = 0
    unjudged: list[str] = field(default_factory=list)
    unjudged_more: int = 0
    fault: str | None = None


def geofence_report(values: dict[str, Any]) -> Geofence:
    """Return what a gateway sent as JSON; unknown fields of newer gateways are ignored."""
    alarms = [FenceAlarm(**known_fields(FenceAlarm, one)) for one in values.get("alarms", [])]
    names = [str(name) for name in values.get("unjudged", [])]
    return Geofence(**{**known_fields(Geofence, values), "alarms": alarms, "unjudged": names})


# --- Reports to operators on people and vehicles, which are only observed, near robots ---


@dataclass(frozen=True)
class NearnessAlarm:
    """``seen``, a phone or a tracker, is near ``robot``, or will be in ``seconds``: it is near now at 0.

    ``metres`` are between the two, now or when it will be near; it is about (``x``, ``y``), metres, site
    frame. ``since`` is when that was found, seconds since 1970.
    """

    seen: str
    robot: str
    metres: float
    seconds: float
    x: float
    y: float
    since: float


@dataclass(frozen=True)
class Nearness:
    """All that are near robots, or will be, at the gateway's time ``t``, the soonest first.

    ``more`` counts alarms that are not listed; ``metres`` and ``within_s`` are the site's limits. ``fault``
    says why nothing is monitored.
    """

    t: float
    metres: float
    within_s: float
    alarms: list[NearnessAlarm] = field(default_factory=list)
    more: int = 0
    fault: str | None = None


def nearness_report(values: dict[str, Any]) -> Nearness:
    """Return what a gateway sent as JSON; unknown fields of newer gateways are ignored."""
    alarms = [NearnessAlarm(**known_fields(NearnessAlarm, one)) for one in values.get("alarms", [])]
    return Nearness(**{**known_fields(Nearness, values), "alarms": alarms})


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def emergency_report(values: dict[str, Any]) -> EmergencyReport:
    """Return the state of an emergency stop that a gateway sent as JSON."""
    report = EmergencyReport(**known_fields(EmergencyReport, values))
    if not isinstance(report.gateways, dict):
        return report
    gateways = StoppedGateways(**known_fields(StoppedGateways, report.gateways))
    return replace(report, gateways=gateways)
