"""What everything works with that works on queues."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..commanding.book import CommandBook
from ..robots import Robots
from ..served_site import ServedSite
from ..store.database import Database
from .book import QueueBook


@dataclass(frozen=True)
class QueueContext:
    """The queues in their ``book``, and what they depend on: site, robots, commands, database, clock (s)."""

    site: ServedSite
    robots: Robots
    commands: CommandBook
    book: QueueBook
    database: Database
    clock: Callable[[], float]
