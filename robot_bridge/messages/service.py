"""What clients are told about the gateway itself, and about its links."""

from __future__ import annotations

from dataclasses import dataclass, field


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
    """A link, which speaks for many robots; ``up``: it is connected, and its own side is in order.

    Otherwise ``text`` says what is wrong, and ``robots`` are those that it spoke for: fifty names at most, of
    ``count`` in all.
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
