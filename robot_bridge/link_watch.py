"""How each link is: connected or not, its own side in order or not, and what operators are told of that."""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from .errors import RefusedError
from .messages import to_json
from .messages.links import LinkStatus
from .messages.service import LinkReport, Links, Playback, PlaybackReport, SetPlayback
from .robots import Robots

GRACE = 3.0
"""seconds that a link may be away before operators are told: most come back by themselves."""
MOST_NAMES = 50
AWAY = "it is not connected"
REPLAY = "replay"
"""The kind of links that play recordings."""

Announce = Callable[[str, str, dict[str, Any]], None]
Ask = Callable[[str, dict[str, Any]], Awaitable[Any]]
"""Calls a method of a link, and returns its result; raises RefusedError."""


@dataclass
class LinkProcess:
    """A link that the gateway starts; ``fault`` is why it does not run, in a line for operators."""

    name: str
    kind: str
    file: Path
    starts: int = 0
    pid: int | None = None
    fault: str | None = "it is not started yet"


@dataclass(frozen=True)
class ConnectedLink:
    """A link that is connected: its kind, None before it said hello, and what it said last of itself."""

    name: str
    kind: str | None
    status: LinkStatus | None
    robots: int


@dataclass
class _Known:
    seen_at: float
    kind: str | None = None
    status: LinkStatus | None = None
    process: LinkProcess | None = None
    robots: int = 0
    counts: Mapping[str, float] = field(default_factory=dict)
    ask: Ask | None = None
    """None while it is not connected."""


class LinkWatch:
    """The links that a site names, and those that have been connected. Operators are told of each change."""

    def __init__(
        self, robots: Robots, announce: Announce, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._robots = robots
        self._announce = announce
        self._clock = clock
        self._known: dict[str, _Known] = {}
        self._told = Links()

    def update(self, connected: Iterable[ConnectedLink], processes: Iterable[LinkProcess] = ()) -> None:
        """Take note of how things are, and tell operators what has changed."""
        now = self._clock()
        for process in processes:
            self._known.setdefault(process.name, _Known(now, process.kind)).process = process
        for known in self._known.values():
            known.robots = 0
        for link in connected:
            known = self._known.setdefault(link.name, _Known(now))
            known.seen_at, known.status, known.robots = now, link.status, link.robots
            known.kind = link.kind or known.kind
            known.counts = {} if link.status is None else link.status.counts
        report = self.report()
        if report != self._told:
            self._told = report
            self._announce("links", "", to_json(report))

    def introduce(self, link: str, kind: str, ask: Ask) -> None:
        """Note the kind of a link that has said hello, before it speaks for any robot, and how to ask it."""
        known = self._known.setdefault(link, _Known(self._clock()))
        known.kind, known.ask = kind, ask

    def withdraw(self, link: str, ask: Ask) -> None:
        """Note that a connection has ended; one that has come in its place is asked on."""
        known = self._known.get(link)
        if known is not None and known.ask == ask:
            known.ask = None

    async def set_playback(self, request: SetPlayback) -> PlaybackReport:
        """Have a link play its recording otherwise, and return how it does now; raises RefusedError."""
        known = self._known.get(request.link)
        if known is None or known.kind != REPLAY:
            played = ", ".join(sorted(name for name, one in self._known.items() if one.kind == REPLAY))
            raise RefusedError(f"{request.link[:40]!r} plays no recording; those that do: {played or 'none'}")
        if known.ask is None:
            raise RefusedError(f"link {request.link}: {AWAY}")
        result = await known.ask(Playback.method, to_json(request.change))
        try:
            return msgspec.convert(result, PlaybackReport)
        except msgspec.ValidationError as error:
            raise RefusedError(f"link {request.link} answers with what is no report: {error}") from None

    def kind_of(self, link: str) -> str | None:
        """Return the kind of a link; None for one that has not been heard, and for what is none."""
        known = self._known.get(link)
        return None if known is None else known.kind

    def report(self) -> Links:
        """Return how each link is; one that nobody starts and whose robots are all elsewhere is forgotten."""
        now = self._clock()
        found = []
        for name, known in sorted(self._known.items()):
            text = self._fault(known, now)
            robots = [] if text is None else self._of(name)
            if text is not None and known.process is None and not robots and now - known.seen_at > GRACE:
                continue
            found.append(LinkReport(name, known.kind, text is None, text, robots[:MOST_NAMES], len(robots)))
        return Links(found)

    def numbers(self, name: str) -> dict[tuple[str, ...], float]:
        """Return one number of each link by its name: ``up``, ``robots`` or ``starts``."""
        now = self._clock()
        each: dict[str, Callable[[_Known], float]] = {
            "up": lambda known: float(self._fault(known, now) is None),
            "robots": lambda known: float(known.robots),
            "starts": lambda known: float(known.process.starts if known.process else 0),
        }
        return {(link,): each[name](known) for link, known in self._known.items()}

    def counts(self) -> dict[tuple[str, ...], float]:
        """Return what links have counted, by link and name."""
        return {(link, name): n for link, known in self._known.items() for name, n in known.counts.items()}

    def _fault(self, known: _Known, now: float) -> str | None:
        """Return what is wrong with a link, None where nothing is."""
        if now - known.seen_at > GRACE:
            return (known.process.fault if known.process else None) or AWAY
        if known.status is not None and not known.status.ok:
            return known.status.text or "its own side is not in order"
        return None

    def _of(self, link: str) -> list[str]:
        return [robot.name for robot in self._robots.changed(-1) if robot.link == link]
