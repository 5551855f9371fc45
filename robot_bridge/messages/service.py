"""What clients are told about the gateway itself, and about its links."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from .checks import check_finite


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
