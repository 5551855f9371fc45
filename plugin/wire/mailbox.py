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
    Geofence,
    Links,
    Nearness,
    ObservationReport,
    PlacementReport,
    QueueReport,
    SiteReport,
    Suspensions,
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

    ``greeting_of`` names the database of the gateway that said so on a new link, empty where it does not say:
    it may be another gateway than before. None on a link that goes on.
    """

    link: LinkStatus
    site: SiteReport | None = None
    greeting_of: str | None = None
    robots: Sightings = field(default_factory=Sightings)
    commands: dict[str, CommandReport] = field(default_factory=dict)
    answers: list[Answer] = field(default_factory=list)
    emergency: EmergencyReport | None = None
    suspensions: Suspensions | None = None
    links: Links | None = None
    roads: RoadNews = field(default_factory=RoadNews)
    geofence: Geofence | None = None
    nearness: Nearness | None = None
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

    def put_site(self, site: SiteReport, *, greeting_of: str | None = None) -> None:
        """Leave the site that the gateway serves; ``greeting_of`` its database as first word on a link."""
        with self._lock:
            self._news.site = site
            if greeting_of is not None:
                self._news.greeting_of = greeting_of

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

    def put_suspensions(self, report: Suspensions) -> None:
        """Leave which robots' accounts are locked."""
        with self._lock:
            self._news.suspensions = report

    def put_links(self, report: Links) -> None:
        """Leave how links to robots of another kind are."""
        with self._lock:
            self._news.links = report

    def put_roads(self, method: str, params: dict[str, Any]) -> None:
        """Leave what was told of roads."""
        with self._lock:
            self._news.roads.take(method, params)

    def put_geofence(self, report: Geofence) -> None:
        """Leave which robots are in keepouts and at obstacles."""
        with self._lock:
            self._news.geofence = report

    def put_nearness(self, report: Nearness) -> None:
        """Leave who is near which robot."""
        with self._lock:
            self._news.nearness = report

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
