"""Where the connection's thread leaves what it learns, and the window's thread picks it up.

Only the newest of each thing is kept, so that a window that is busy for a while costs no memory and then
paints what is true now, not what was.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ...robot_bridge.messages import (
    CommandReport,
    EmergencyReport,
    ObservationReport,
    PlacementReport,
    QueueReport,
    SiteReport,
)
from .observation_news import ObservationNews
from .outbox import Answer
from .placement_news import PlacementNews
from .queue_news import QueueNews
from .road_news import RoadNews
from .sightings import Sightings
from .status import LinkStatus, Phase

MOST_COMMANDS = 1000


@dataclass
class News:
    """What arrived since the last look; ``site`` is set when a gateway said which site it serves.

    ``is_greeting`` when it said so on a new link: it may be another gateway than before.
    """

    link: LinkStatus
    site: SiteReport | None = None
    is_greeting: bool = False
    robots: Sightings = field(default_factory=Sightings)
    commands: dict[str, CommandReport] = field(default_factory=dict)
    answers: list[Answer] = field(default_factory=list)
    emergency: EmergencyReport | None = None
    roads: RoadNews = field(default_factory=RoadNews)
    queues: QueueNews = field(default_factory=QueueNews)
    placements: PlacementNews = field(default_factory=PlacementNews)
    observations: ObservationNews = field(default_factory=ObservationNews)


class Mailbox:
    """The newest state of everything, safe to use from two threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._news = News(LinkStatus(Phase.CLOSED))

    def put_link(self, link: LinkStatus) -> None:
        """Leave how the link stands."""
        with self._lock:
            self._news.link = link

    def put_site(self, site: SiteReport, *, is_greeting: bool = False) -> None:
        """Leave the site that the gateway serves; ``is_greeting`` where it is the first word on a link."""
        with self._lock:
            self._news.site = site
            self._news.is_greeting |= is_greeting

    def put_robots(self, robots: Sightings) -> None:
        """Leave what was told of robots; it replaces what is older of the same robots."""
        with self._lock:
            if self._news.robots.tells_nothing:
                self._news.robots = robots
            else:
                self._news.robots.merge(robots)

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

    def put_roads(self, method: str, params: dict[str, Any]) -> None:
        """Leave what was told of roads."""
        with self._lock:
            self._news.roads.take(method, params)

    def put_queue(self, report: QueueReport) -> None:
        """Leave how a robot's queue stands."""
        with self._lock:
            self._news.queues.take(report)

    def put_every_queue(self, reports: Iterable[QueueReport]) -> None:
        """Leave how every queue stands: there are no others."""
        with self._lock:
            self._news.queues.take_all(reports)

    def put_placements(self, reports: Iterable[PlacementReport]) -> None:
        """Leave which cones were put down or collected."""
        with self._lock:
            self._news.placements.take(reports)

    def put_observations(self, reports: Iterable[ObservationReport]) -> None:
        """Leave what robots saw, and what became of it."""
        with self._lock:
            self._news.observations.take(reports)

    def put_answer(self, answer: Answer) -> None:
        """Leave what became of an order; every one of them is kept."""
        with self._lock:
            self._news.answers.append(answer)

    def take(self) -> News:
        """Return all that arrived since the last call and begin anew; the link's state stays."""
        with self._lock:
            news, self._news = self._news, News(self._news.link)
        return news
