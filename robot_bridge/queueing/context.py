"""What everything works with that works on queues."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from ..commanding.book import CommandBook
from ..planning import Planner, StraightPlanner
from ..robots import Robots
from ..served_site import ServedSite
from ..store.database import Database
from .book import QueueBook


@dataclass(frozen=True)
class QueueContext:
    """The queues in their ``book``, and what they depend on: site, robots, commands, database, clock (s).

    ``planner`` finds the ways to tasks without a path.
    """

    site: ServedSite
    robots: Robots
    commands: CommandBook
    book: QueueBook
    database: Database
    clock: Callable[[], float]
    planner: Planner = field(default_factory=StraightPlanner)
