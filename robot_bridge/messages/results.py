"""What operators' requests are answered with."""

from __future__ import annotations

from dataclasses import dataclass, field

from .desk import CommandReport, RobotReport, SiteReport
from .observations import ObservationReport
from .queues import QueueReport
from .roles import Role
from .stopping import EmergencyReport
from .supervision import AuditReport, SessionReport


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
class Queues:
    """What robots are to do one after the other, by robot."""

    queues: list[QueueReport]
