"""Where the connection's thread leaves what it learns, and the window's thread picks it up.

Only the newest of each thing is kept, so that a window that is busy for a while costs no memory and then
paints what is true now, not what was.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field

from ...robot_bridge.messages import CommandReport, EmergencyReport, RobotReport, SiteReport
from .outbox import Answer
from .status import LinkStatus, Phase

MOST_COMMANDS = 1000


@dataclass(frozen=True)
class Sighting:
    """A robot as the gateway told it, and when that arrived here (monotonic clock)."""

    report: RobotReport
    received: float


@dataclass
class News:
    """What arrived since the last look; ``site`` is set when a gateway said which site it serves."""

    link: LinkStatus
    site: SiteReport | None = None
    robots: dict[str, Sighting] = field(default_factory=dict)
    commands: dict[str, CommandReport] = field(default_factory=dict)
    answers: list[Answer] = field(default_factory=list)
    emergency: EmergencyReport | None = None


class Mailbox:
    """The newest state of everything, safe to use from two threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._news = News(LinkStatus(Phase.CLOSED))

    def put_link(self, link: LinkStatus) -> None:
        """Leave how the link stands."""
        with self._lock:
            self._news.link = link

    def put_site(self, site: SiteReport) -> None:
        """Leave the site that the gateway serves."""
        with self._lock:
            self._news.site = site

    def put_robots(self, reports: Iterable[RobotReport], received: float) -> None:
        """Leave reports of robots; each replaces an older one of the same robot."""
        with self._lock:
            for report in reports:
                self._news.robots[report.robot] = Sighting(report, received)

    def put_commands(self, reports: Iterable[CommandReport]) -> None:
        """Leave reports of commands, which hold all their steps; those longest unchanged go first."""
        with self._lock:
            commands = self._news.commands
            for report in reports:
                commands.pop(report.command, None)
                commands[report.command] = report
            while len(commands) > MOST_COMMANDS:
                del commands[next(iter(commands))]

    def put_emergency(self, report: EmergencyReport) -> None:
        """Leave how an emergency stop stands."""
        with self._lock:
            self._news.emergency = report

    def put_answer(self, answer: Answer) -> None:
        """Leave what became of an order; every one of them is kept."""
        with self._lock:
            self._news.answers.append(answer)

    def take(self) -> News:
        """Return all that arrived since the last call and begin anew; the link's state stays."""
        with self._lock:
            news, self._news = self._news, News(self._news.link)
        return news
