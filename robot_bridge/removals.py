"""Robots that somebody removes while the gateway runs, with a program or at a desk: gone everywhere."""

from __future__ import annotations

import logging
from collections.abc import Iterable

from .commanding.book import CommandBook
from .emergency.stops import EmergencyStops
from .errors import RefusedError, StoreError
from .known_names import told
from .messages import KeptRobot, RemoveRobots, RobotsRemoved
from .queueing.orders import QueueOrders
from .road_traffic.waiting_robots import WaitingRobots
from .robots import AWAY, Robots
from .store import robots as stored_robots
from .store.database import Database
from .trajectories.saving import Saving

log = logging.getLogger(__name__)

REASON = "the robot was removed"
MOST_NAMED = 10
"""Robots that a text names."""


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
        queues: QueueOrders,
        database: Database,
    ) -> None:
        self._robots = robots
        self._saving = saving
        self._book = book
        self._emergency = emergency
        self._waiting = waiting
        self._queues = queues
        self._database = database
        self._leaving: set[str] = set()
        """robots that are gone, and of whose commands that may not be stored yet."""

    def begin(self, known: Iterable[str]) -> None:
        """Take note of the robots that are stored: others were removed while no gateway ran."""
        self._saving.begin(known)
        self._leaving = self._book.robots().difference(known)

    async def remove(self, request: RemoveRobots, operator: str) -> RobotsRemoved:
        """Remove those of the robots that are lost or offline, with their queues and commands.

        What they say next is answered with an Abort: one that comes back may still be under way.

        :raises RefusedError: when none of them can be removed, or an emergency stop is in force; StoreError.
        """
        if self._emergency.in_force:
            raise RefusedError(
                "remove_robots: an emergency stop is in force, and who has not answered it has to be seen; "
                "clear it first"
            )
        for robot in self._gone(request.robots):
            await self._queues.end(robot, operator, REASON)
        # Storing that took time, in which robots may have come back.
        removed = self._gone(request.robots)
        kept = [KeptRobot(robot, why) for robot in request.robots if (why := self._why_kept(robot))]
        if not removed:
            raise RefusedError(f"remove_robots: {'; '.join(one.reason for one in kept[:MOST_NAMED])}")
        await self._database.run(stored_robots.forget_all, removed)
        log.warning("%s removes %d robots: %s", operator, len(removed), told(removed))
        try:
            await self._saving.save()
            await self.carry_out()
        except StoreError as error:
            # They are removed, and the rest is done with what is stored next.
            log.error("%s", error)
        return RobotsRemoved(removed, kept)

    def _gone(self, robots: Iterable[str]) -> list[str]:
        return sorted({robot for robot in robots if self._why_kept(robot) is None})

    def _why_kept(self, robot: str) -> str | None:
        """Return why a robot is not removed; None for one that is lost or offline."""
        if robot not in self._robots:
            return f"robot {robot!r} is not known to this gateway"
        state = self._robots.get(robot).state
        if state in AWAY:
            return None
        return f"robot {robot!r} is {state.value}; only robots that are lost or offline are removed"

    async def carry_out(self) -> None:
        """Take out who was removed since the last call; raises StoreError, and goes on at the next."""
        for robot in sorted(self._saving.take_removed()):
            log.warning("robot %s was removed", robot)
            self._robots.remove(robot)
            self._leaving.add(robot)
        failed: list[StoreError] = []
        for robot in sorted(self._leaving):
            try:
                await self._take_out(robot)
            except StoreError as error:
                failed.append(error)
        if failed:
            raise failed[0]

    async def _take_out(self, robot: str) -> None:
        if robot not in self._robots:
            await self._book.give_up(robot, REASON)
            await self._waiting.forget(robot)
            # Behind the end of its Abort, which would count as its answer.
            self._emergency.forget(robot)
        self._leaving.discard(robot)
