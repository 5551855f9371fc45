"""Administration: accounts, roles, sessions, audit, sites, removal of robots, state of the gateway."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import ClassVar

from .safety import check_reason
from .validation import MessageError, check_expires_in, check_finite, check_robot_name

# --- What operators' accounts may do ---


class Role(str, Enum):
    """What an operator's account may do; each role may do what the one before it may."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    SUPERVISOR = "supervisor"

    def includes(self, other: Role) -> bool:
        """Tell whether this role may do what ``other`` may."""
        order = list(Role)
        return order.index(self) >= order.index(other)


# --- What supervisors ask about operators' accounts: who has one, with which role, and how its token stands

LONGEST_VALIDITY = 3660 * 86400.0
"""seconds."""


class TokenState(str, Enum):
    """How an operator's newest token stands; ``none`` where there never was one."""

    VALID = "valid"
    EXPIRED = "expired"
    REVOKED = "revoked"
    NONE = "none"


@dataclass(frozen=True)
class GetOperators:
    """Ask for every operator's account, by name."""

    method: ClassVar[str] = "get_operators"


@dataclass(frozen=True)
class AddOperator:
    """Make an account; answered with its token. That expires after ``expires_in`` seconds, if given."""

    method: ClassVar[str] = "add_operator"
    operator: str
    role: Role
    expires_in: float | None = None

    def __post_init__(self) -> None:
        check_expires_in(self.expires_in, LONGEST_VALIDITY)


@dataclass(frozen=True)
class RotateToken:
    """Ask for a new token of an operator, in place of every one before, whose connections end."""

    method: ClassVar[str] = "rotate_token"
    operator: str
    expires_in: float | None = None

    def __post_init__(self) -> None:
        check_expires_in(self.expires_in, LONGEST_VALIDITY)


@dataclass(frozen=True)
class RevokeToken:
    """Take an operator's token away; connections that it opened end. The account stays."""

    method: ClassVar[str] = "revoke_token"
    operator: str


@dataclass(frozen=True)
class SetRole:
    """Give an operator another role, which holds for open connections too."""

    method: ClassVar[str] = "set_role"
    operator: str
    role: Role


@dataclass(frozen=True)
class OperatorReport:
    """An account and how its newest token stands; times are seconds since 1970."""

    operator: str
    role: Role
    created_at: float
    token: TokenState
    expires_at: float | None = None
    revoked_at: float | None = None
    used_at: float | None = None


@dataclass(frozen=True)
class NewToken:
    """A token that was just made. It is kept nowhere, and told in this answer only."""

    operator: str
    role: Role
    token: str
    expires_at: float | None = None


@dataclass(frozen=True)
class Operators:
    """Every operator's account, by name."""

    operators: list[OperatorReport]


# --- What supervisors ask about the other operators: who is connected, and who did what ---

LONGEST_REASON = 200
MOST_ENTRIES = 10_000


@dataclass(frozen=True)
class GetSessions:
    """Ask for the operators' open connections, newest first; with ``ended`` also for those that were."""

    method: ClassVar[str] = "get_sessions"
    ended: bool = False
    limit: int = 200

    def __post_init__(self) -> None:
        _check_limit(self.limit)


@dataclass(frozen=True)
class EndSession:
    """End an operator's connection, by its id or how that begins; the operator is told ``reason``."""

    method: ClassVar[str] = "end_session"
    session: str
    reason: str = "ended by a supervisor"

    def __post_init__(self) -> None:
        if len(self.reason) > LONGEST_REASON:
            raise MessageError(f"reason has {len(self.reason)} characters; give at most {LONGEST_REASON}")


@dataclass(frozen=True)
class GetAudit:
    """Ask who did what, newest first: since a time, by one account, before an entry's id."""

    method: ClassVar[str] = "get_audit"
    since: float | None = None
    who: str | None = None
    before: int | None = None
    limit: int = 200

    def __post_init__(self) -> None:
        check_finite(since=self.since)
        _check_limit(self.limit)
        if self.before is not None and not 0 <= self.before < 2**63:
            raise MessageError(f"before is {self.before}; give the id of an entry")


@dataclass(frozen=True)
class SessionReport:
    """One connection of an operator; ``address`` is where it comes from, times are seconds since 1970."""

    session: str
    operator: str
    role: str
    address: str
    began_at: float
    ended_at: float | None = None
    reason: str | None = None


@dataclass(frozen=True)
class AuditReport:
    """One thing that somebody did, or was refused (``done`` is false)."""

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


# --- What supervisors ask about the sites that a gateway may serve ---


@dataclass(frozen=True)
class GetSites:
    """Ask for the published sites that lie beside the one that is served, and that one."""

    method: ClassVar[str] = "get_sites"


@dataclass(frozen=True)
class ChooseSite:
    """Have another site served from now on: ``site`` is the name of its folder, as in ``get_sites``."""

    method: ClassVar[str] = "choose_site"
    site: str


@dataclass(frozen=True)
class SiteOffer:
    """A folder with a published site. ``refusal`` says why it cannot be chosen, where it cannot.

    ``id``, ``name`` and ``version`` are the publication's own; None where that cannot be read.
    """

    site: str
    served: bool
    id: str | None = None
    name: str | None = None
    version: int | None = None
    refusal: str | None = None


@dataclass(frozen=True)
class Sites:
    """The sites that a gateway may serve, by the names of their folders."""

    sites: list[SiteOffer]


# --- What supervisors ask of robots that are gone ---

MOST_REMOVED = 10_000
"""Robots of one request."""


@dataclass(frozen=True)
class RemoveRobots:
    """Remove ``robots`` that are lost or offline, with their queues and open commands.

    Their history stays. One that comes back is told to abort, and is a new robot.
    """

    method: ClassVar[str] = "remove_robots"
    robots: list[str]
    reason: str | None = None

    def __post_init__(self) -> None:
        if not 1 <= len(self.robots) <= MOST_REMOVED:
            raise MessageError(f"robots names {len(self.robots)}; give 1 to {MOST_REMOVED}")
        for robot in self.robots:
            check_robot_name(robot)
        check_reason(self.reason)


@dataclass(frozen=True)
class KeptRobot:
    """A robot that was not removed, and why."""

    robot: str
    reason: str


@dataclass(frozen=True)
class RobotsRemoved:
    """The robots that were removed, by name, and those that were not."""

    removed: list[str]
    kept: list[KeptRobot] = field(default_factory=list)


# --- What clients are told about the gateway itself, and about its links ---


@dataclass(frozen=True)
class Stopping:
    """The gateway ends in good order, and closes its connections with code 1012. ``reason`` is for people."""

    reason: str


@dataclass(frozen=True)
class Suspension:
    """A robot's account of the database that is locked because it kept the others waiting.

    ``until`` is in seconds since 1970; without it the account could not be locked, and goes on.
    """

    robot: str
    reason: str
    until: float | None = None


@dataclass(frozen=True)
class Suspensions:
    """All accounts that are locked now: none where ``robots`` is empty."""

    robots: list[Suspension] = field(default_factory=list)


@dataclass(frozen=True)
class LinkReport:
    """A link, which speaks for many robots; ``up``: it is connected, and its robots can be reached.

    Otherwise ``text`` says what is wrong, and ``robots`` are those that it spoke for: fifty names at most, of
    ``count`` in all. Where it is up ``text`` says what is the matter with some of its robots, if anything is.
    """

    link: str
    kind: str | None
    up: bool
    text: str | None = None
    robots: list[str] = field(default_factory=list)
    count: int = 0


@dataclass(frozen=True)
class Links:
    """All links that a site names, and those that have been connected since the gateway's start."""

    links: list[LinkReport] = field(default_factory=list)


@dataclass(frozen=True)
class Playback:
    """How a link is to play its recording on; what is left out stays as it is.

    ``speed`` is in seconds of the recording for each second, ``place_s`` in seconds after its begin.
    """

    speed: float | None = None
    paused: bool | None = None
    loop: bool | None = None
    place_s: float | None = None
    method: ClassVar[str] = "playback"

    def __post_init__(self) -> None:
        check_finite(speed=self.speed, place_s=self.place_s)


@dataclass(frozen=True)
class SetPlayback:
    """Play the recording of ``link`` on otherwise, as :class:`Playback`; with nothing else, only ask how."""

    link: str
    speed: float | None = None
    paused: bool | None = None
    loop: bool | None = None
    place_s: float | None = None
    method: ClassVar[str] = "set_playback"

    def __post_init__(self) -> None:
        check_finite(speed=self.speed, place_s=self.place_s)

    @property
    def change(self) -> Playback:
        """What the link is told."""
        return Playback(self.speed, self.paused, self.loop, self.place_s)


@dataclass(frozen=True)
class PlaybackReport:
    """How a recording is played: the name of its file, and where in its ``length_s`` seconds it is."""

    file: str
    speed: float
    paused: bool
    loop: bool
    place_s: float
    length_s: float
