"""Robots that an administrator removes while the gateway runs: gone everywhere, and at once."""

from __future__ import annotations

import logging
from collections.abc import Iterable

from .commanding.book import CommandBook
from .emergency.stops import EmergencyStops
from .road_traffic.waiting_robots import WaitingRobots
from .robots import Robots
from .trajectories.saving import Saving

log = logging.getLogger(__name__)

REASON = "the robot was removed"


class Removals:
    """Takes robots out of the fleet that are found missing where they were stored.

    One that says Ready again, as it can where no tokens are asked for, is a new robot.
    """

    def __init__(
        self,
        robots: Robots,
        saving: Saving,
        book: CommandBook,
        emergency: EmergencyStops,
        waiting: WaitingRobots,
    ) -> None:
        self._robots = robots
        self._saving = saving
        self._book = book
        self._emergency = emergency
        self._waiting = waiting
        self._leaving: set[str] = set()
        """robots that are gone, and of whose commands that may not be stored yet."""

    def begin(self, known: Iterable[str]) -> None:
        """Take note of the robots that are stored: others were removed while no gateway ran."""
        self._saving.begin(known)
        self._leaving = self._book.robots().difference(known)

    async def carry_out(self) -> None:
        """Take out who was removed since the last call; raises StoreError, and goes on at the next."""
        for robot in sorted(self._saving.take_removed()):
            log.warning("robot %s was removed", robot)
            self._robots.remove(robot)
            self._leaving.add(robot)
        for robot in sorted(self._leaving):
            if robot not in self._robots:
                await self._book.give_up(robot, REASON)
                await self._waiting.forget(robot)
                # Behind the end of its Abort, which would count as its answer.
                self._emergency.forget(robot)
            self._leaving.discard(robot)
