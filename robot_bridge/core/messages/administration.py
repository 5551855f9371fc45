"""Administration: accounts, roles, sessions, audit, sites, removal of robots, state of the gateway."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any, ClassVar

from . import base
from .base import DeskRequest, MessageError, Role, known_fields
from .safety import EmergencyReport, check_reason

# --- The connection of an operator: the served site and the operator's identity ---

PROTOCOL_VERSION = 1


@dataclass(frozen=True)
class SiteReport:
    """The site that a gateway serves: its frame (CRS, origin, rotation in radians) and its bounds.

    ``bounds`` is x_min, y_min, x_max, y_max in the site frame. ``roads`` says that the gateway finds routes
    along roads on it. ``problem`` says why this gateway does not serve the site chosen for its fleet.
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
    problem: str | None = None


@dataclass(frozen=True)
class HelloResult:
    """The answer to ``hello``: the protocol's version, the site, and the operator's identity.

    ``database`` identifies the gateway's database: in another one, robots and commands of the same names are
    different ones. ``robots`` is their present number; a gateway that sends it supports views. ``gateway``
    and ``gateways`` are as in :class:`Gateways`, where several gateways serve the fleet. ``now`` is the
    gateway's time in seconds on a clock that nobody sets, for the deadlines of requests.
    """

    protocol: int
    site: SiteReport
    operator: str
    role: Role
    emergency: EmergencyReport
    database: str = ""
    robots: int | None = None
    gateway: str | None = None
    gateways: list[str] | None = None
    now: float | None = None


@dataclass(frozen=True)
class Gateways:
    """The addresses of all gateways of a fleet that several serve.

    ``gateway`` is the sender's name; ``gateways`` are the URLs of all, its own first, of at most 256
    characters each: operators, robots and links may connect to any of them when this one does not answer.
    """

    gateway: str
    gateways: list[str]
    method: ClassVar[str] = "gateways"

    def __post_init__(self) -> None:
        object.__setattr__(self, "gateways", base.usable_addresses(self.gateways) or [])


@dataclass(frozen=True)
class Hello(DeskRequest[HelloResult]):
    """An operator's first message; answered with a SiteReport under ``site`` and the protocol's version.

    ``operator`` is a name on one line, of at most 128 printable characters.
    """

    method = "hello"
    least_role = Role.VIEWER
    operator: str
    protocol: int = PROTOCOL_VERSION

    def __post_init__(self) -> None:
        if not (len(self.operator) <= base.LONGEST_OPERATOR and self.operator.strip().isprintable()):
            raise MessageError(
                f"operator has {len(self.operator)} characters and begins {self.operator[:40]!r}; give a "
                f"name of at most {base.LONGEST_OPERATOR} printable characters on one line"
            )


# --- Requests of supervisors about operators' accounts, their roles and their tokens

LONGEST_VALIDITY = 3660 * 86400.0
"""seconds."""


class TokenState(str, Enum):
    """The state of an operator's newest token; ``none`` if there never was one."""

    VALID = "valid"
    EXPIRED = "expired"
    REVOKED = "revoked"
    NONE = "none"


@dataclass(frozen=True)
class Operators:
    """Every operator's account, by name."""

    operators: list[OperatorReport]


@dataclass(frozen=True)
class GetOperators(DeskRequest[Operators]):
    """Ask for every operator's account, by name."""

    method = "get_operators"
    least_role = Role.SUPERVISOR


@dataclass(frozen=True)
class NewToken:
    """A new token. It is stored nowhere, and sent in this answer only."""

    operator: str
    role: Role
    token: str
    expires_at: float | None = None


@dataclass(frozen=True)
class AddOperator(DeskRequest[NewToken]):
    """Create an account; answered with its token, which expires after ``expires_in`` seconds, if given."""

    method = "add_operator"
    least_role = Role.SUPERVISOR
    operator: str
    role: Role
    expires_in: float | None = None

    def __post_init__(self) -> None:
        base.check_expires_in(self.expires_in, LONGEST_VALIDITY)


@dataclass(frozen=True)
class RotateToken(DeskRequest[NewToken]):
    """Ask for a new token of an operator. It replaces all earlier ones, whose connections end."""

    method = "rotate_token"
    least_role = Role.SUPERVISOR
    operator: str
    expires_in: float | None = None

    def __post_init__(self) -> None:
        base.check_expires_in(self.expires_in, LONGEST_VALIDITY)


@dataclass(frozen=True)
class OperatorReport:
    """An account and the state of its newest token; times are seconds since 1970."""

    operator: str
    role: Role
    created_at: float
    token: TokenState
    expires_at: float | None = None
    revoked_at: float | None = None
    used_at: float | None = None


@dataclass(frozen=True)
class RevokeToken(DeskRequest[OperatorReport]):
    """Revoke an operator's token; connections opened with it end. The account stays."""

    method = "revoke_token"
    least_role = Role.SUPERVISOR
    operator: str


@dataclass(frozen=True)
class SetRole(DeskRequest[OperatorReport]):
    """Change an operator's role, for open connections too."""

    method = "set_role"
    least_role = Role.SUPERVISOR
    operator: str
    role: Role


# --- Requests of supervisors about other operators: sessions and audit ---

LONGEST_REASON = 200
MOST_ENTRIES = 10_000


@dataclass(frozen=True)
class Sessions:
    """Operators' connections, newest first."""

    sessions: list[SessionReport]


@dataclass(frozen=True)
class GetSessions(DeskRequest[Sessions]):
    """Ask for the operators' open connections, newest first; with ``ended`` also for closed ones."""

    method = "get_sessions"
    least_role = Role.SUPERVISOR
    ended: bool = False
    limit: int = 200

    def __post_init__(self) -> None:
        _check_limit(self.limit)


@dataclass(frozen=True)
class SessionReport:
    """One connection of an operator; ``address`` is its origin, times are seconds since 1970."""

    session: str
    operator: str
    role: str
    address: str
    began_at: float
    ended_at: float | None = None
    reason: str | None = None


@dataclass(frozen=True)
class EndSession(DeskRequest[SessionReport]):
    """End an operator's connection, by its id or a prefix of it; ``reason`` is sent to the operator."""

    method = "end_session"
    least_role = Role.SUPERVISOR
    session: str
    reason: str = "ended by a supervisor"

    def __post_init__(self) -> None:
        if len(self.reason) > LONGEST_REASON:
            raise MessageError(f"reason has {len(self.reason)} characters; give at most {LONGEST_REASON}")


@dataclass(frozen=True)
class Audit:
    """Who did what, newest first."""

    entries: list[AuditReport]


@dataclass(frozen=True)
class GetAudit(DeskRequest[Audit]):
    """Ask who did what, newest first: since a time, by one account, before an entry's id."""

    method = "get_audit"
    least_role = Role.SUPERVISOR
    since: float | None = None
    who: str | None = None
    before: int | None = None
    limit: int = 200

    def __post_init__(self) -> None:
        base.check_finite(since=self.since)
        _check_limit(self.limit)
        if self.before is not None and not 0 <= self.before < 2**63:
            raise MessageError(f"before is {self.before}; give the id of an entry")


@dataclass(frozen=True)
class AuditReport:
    """One action that was done, or refused (``done`` is false)."""

    id: int
    at: float
    who: str
    action: str
    done: bool
    role: str | None = None
    address: str | None = None
    subject: str | None = None
    detail: str | None = None


def _check_limit(limit: int) -> None:
    if not 1 <= limit <= MOST_ENTRIES:
        raise MessageError(f"limit is {limit}; give a number from 1 to {MOST_ENTRIES}")


# --- Requests of supervisors about the sites that a gateway may serve ---


@dataclass(frozen=True)
class Sites:
    """The sites that a gateway may serve, by the names of their folders."""

    sites: list[SiteOffer]


@dataclass(frozen=True)
class GetSites(DeskRequest[Sites]):
    """Ask for the served site and the published sites beside it."""

    method = "get_sites"
    least_role = Role.SUPERVISOR


@dataclass(frozen=True)
class ChooseSite(DeskRequest[SiteReport]):
    """Switch to another site: ``site`` is the name of its folder, as in ``get_sites``."""

    method = "choose_site"
    least_role = Role.SUPERVISOR
    site: str


@dataclass(frozen=True)
class SiteOffer:
    """A folder with a published site. ``refusal`` says why it cannot be chosen, if so.

    ``id``, ``name`` and ``version`` are the publication's own; None if that cannot be read.
    """

    site: str
    served: bool
    id: str | None = None
    name: str | None = None
    version: int | None = None
    refusal: str | None = None


# --- Requests of supervisors about robots that are gone ---

MOST_REMOVED = 10_000
"""Robots of one request."""


@dataclass(frozen=True)
class RobotsRemoved:
    """The robots that were removed, by name, and those that were not."""

    removed: list[str]
    kept: list[KeptRobot] = field(default_factory=list)


@dataclass(frozen=True)
class RemoveRobots(DeskRequest[RobotsRemoved]):
    """Remove ``robots`` that are lost or offline, with their queues and open commands.

    Their history stays. One that comes back is sent Abort, and counts as a new robot.
    """

    method = "remove_robots"
    least_role = Role.SUPERVISOR
    robots: list[str]
    reason: str | None = None

    def __post_init__(self) -> None:
        if not 1 <= len(self.robots) <= MOST_REMOVED:
            raise MessageError(f"robots names {len(self.robots)}; give 1 to {MOST_REMOVED}")
        for robot in self.robots:
            base.check_robot_name(robot)
        check_reason(self.reason)


@dataclass(frozen=True)
class KeptRobot:
    """A robot that was not removed, and why."""

    robot: str
    reason: str


# --- Notifications to clients about the gateway itself and its links ---


@dataclass(frozen=True)
class Stopping:
    """The gateway shuts down in good order and closes its connections with code 1012. ``reason`` is for
    people."""

    reason: str


@dataclass(frozen=True)
class Suspension:
    """A robot's database account that is locked because it kept the others waiting.

    ``until`` is in seconds since 1970; without it the account could not be locked, and continues.
    """

    robot: str
    reason: str
    until: float | None = None


@dataclass(frozen=True)
class Suspensions:
    """All accounts that are locked now: none where ``robots`` is empty."""

    robots: list[Suspension] = field(default_factory=list)


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def site_report(values: dict[str, Any]) -> SiteReport:
    """Return the site that a gateway sent as JSON."""
    known = known_fields(SiteReport, values)
    return SiteReport(**{**known, "origin": tuple(values["origin"]), "bounds": tuple(values["bounds"])})


def operators_report(values: dict[str, Any]) -> Operators:
    """Return all accounts that a gateway sent as JSON."""
    return Operators([_operator_report(one) for one in values["operators"]])


def _operator_report(values: dict[str, Any]) -> OperatorReport:
    enums = {"role": Role(values["role"]), "token": TokenState(values["token"])}
    return OperatorReport(**{**known_fields(OperatorReport, values), **enums})


def new_token(values: dict[str, Any]) -> NewToken:
    """Return the new token that a gateway sent as JSON."""
    return NewToken(**{**known_fields(NewToken, values), "role": Role(values["role"])})


def open_session(values: dict[str, Any]) -> SessionReport:
    """Return one connection of an operator, as a gateway sent it as JSON."""
    return SessionReport(**known_fields(SessionReport, values))


def suspensions_report(values: dict[str, Any]) -> Suspensions:
    """Return which robots' accounts are locked, as a gateway sent it as JSON."""
    return Suspensions([Suspension(**known_fields(Suspension, one)) for one in values["robots"]])


def sites_report(values: dict[str, Any]) -> Sites:
    """Return the sites that a gateway may serve, as it sent them as JSON."""
    return Sites([SiteOffer(**known_fields(SiteOffer, one)) for one in values["sites"]])
