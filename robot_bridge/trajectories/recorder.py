"""Positions on their way into the database: thinned, kept while it is away or slow."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterable, Sequence

from ..sites.settings import TrajectorySettings
from ..store.trajectories import Fix, PackedFix, pack
from .thinning import Thinning

log = logging.getLogger(__name__)

BATCH = 5000
"""positions in one transaction: a few hundredths of a second of the database's thread."""
LOOK_INTERVAL = 1.0
"""seconds between two looks for robots that have fallen silent."""


class Recorder:
    """Collects positions and hands them out in batches; ``settings`` is asked each time, so it may change.

    Where more than ``largest_backlog`` of them wait, the database is away or takes them more slowly than they
    come: the oldest are given up, which is logged once and counted.
    """

    def __init__(self, settings: Callable[[], TrajectorySettings]) -> None:
        self._settings = settings
        self._thinning = Thinning()
        self._waiting: deque[PackedFix] = deque()
        self._told = False
        self._looked_at = 0.0
        self.given_up = 0

    @property
    def waiting(self) -> int:
        """Return how many positions wait to be stored."""
        return len(self._waiting)

    def observe(self, fixes: Sequence[Fix]) -> None:
        """Take in where robots are."""
        settings = self._settings()
        kept = [pack(fix) for fix in fixes if self._thinning.keeps(fix, settings)]
        if kept:
            self._waiting.extend(kept)
            if len(self._waiting) > settings.largest_backlog:
                self._give_up_the_oldest()

    def take(self, now: float) -> list[PackedFix]:
        """Return the oldest positions to be stored; what cannot be stored is handed to :meth:`give_back`."""
        # Not each time: it looks at every robot, and this is called for every few requests.
        if not 0 <= now - self._looked_at < LOOK_INTERVAL:
            self._looked_at = now
            self._wait(self._thinning.silent(now - self._settings().max_interval_s))
        self._told = self._told and len(self._waiting) > self._settings().largest_backlog / 2
        return [self._waiting.popleft() for _ in range(min(BATCH, len(self._waiting)))]

    def finish(self) -> None:
        """Let the last position of every robot be stored, however near the one before: no more will come."""
        self._wait(self._thinning.silent())

    def give_back(self, fixes: Sequence[PackedFix]) -> None:
        """Keep positions that could not be stored; they are the oldest."""
        self._waiting.extendleft(reversed(fixes))
        self._give_up_the_oldest()

    def _wait(self, fixes: Iterable[Fix]) -> None:
        self._waiting.extend(map(pack, fixes))
        self._give_up_the_oldest()

    def _give_up_the_oldest(self) -> None:
        too_many = len(self._waiting) - self._settings().largest_backlog
        if too_many <= 0:
            return
        for _ in range(too_many):
            self._waiting.popleft()
        if not self._told:
            log.error(
                "positions are given up, the oldest first: more than %d wait to be stored, since the "
                "database is away or takes them more slowly than they come "
                "(trajectories.largest_backlog of site.toml)",
                len(self._waiting),
            )
        self._told = True
        self.given_up += too_many
