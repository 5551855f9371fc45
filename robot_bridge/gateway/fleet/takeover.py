"""Takeover: what is known of a robot is taken up when this gateway gets it, and dropped when it goes."""

from __future__ import annotations

import logging
from collections.abc import Collection, Sequence

from ...core.clock import Clock
from ...core.errors import StoreError
from ...core.logs import log_and_continue
from ..cluster.exchange import Exchange
from ..cluster.ownership import Ownership
from ..commands.service import CommandService
from ..model.events import EventBus, RobotLeft
from ..model.robots import AWAY, Robots
from ..queues.registry import QueueRegistry
from ..storage.database import Database
from ..storage.repositories import robots as stored_robots
from ..trajectories.recording import TrajectoryWriter
from .emergency_stop import EmergencyStops

log = logging.getLogger(__name__)

AT_ONCE = 500
"""robots whose commands and queues are read in one piece."""


class Takeover:
    """Follows who has which robot. One of another gateway is known by what that tells, and not commanded."""

    def __init__(
        self,
        ownership: Ownership,
        exchange: Exchange,
        robots: Robots,
        commands: CommandService,
        queues: QueueRegistry,
        emergency: EmergencyStops,
        saving: TrajectoryWriter,
        database: Database,
        clock: Clock,
        events: EventBus,
    ) -> None:
        self._ownership = ownership
        self._exchange = exchange
        self._robots = robots
        self._commands = commands
        self._queues = queues
        self._emergency = emergency
        self._saving = saving
        self._database = database
        self._clock = clock
        self._events = events

    async def claim(self, robot: str) -> None:
        """Have a robot that says Ready here, whoever had it, and take up what is stored of it.

        :raises StoreError: when that cannot be done; the robot is not in then.
        """
        before = self._robots.gateway_of(robot)
        if await self._ownership.claim(robot) or before is not None:
            await self._take_up([robot])
            if before is not None:
                self._exchange.wake("owners", before)

    async def claim_left(self) -> None:
        """Have the robots that no living gateway has, if this gateway leads; raises StoreError."""
        await self._take_up(await self._ownership.claim_left())

    async def follow(self) -> None:
        """Drop the robots that another gateway has by now, and learn which others there are (StoreError)."""
        changes = await self._ownership.refresh()
        for robot in sorted(changes.lost):
            self._drop(robot, changes.gateways.get(robot))
        if changes.new:
            await self._take_up(sorted(changes.new))
        for robot in changes.gone:
            if self._robots.gateway_of(robot) is not None and self._robots.get(robot).state in AWAY:
                self._robots.remove(robot)
        strange = [r for r in changes.gateways if r not in self._robots and r not in changes.gone]
        if strange:
            await self._meet(strange, changes.gateways)
        for robot, gateway in changes.gateways.items():
            if self._robots.gateway_of(robot) not in (None, gateway):
                self._robots.let_go(robot, gateway)

    async def _meet(self, names: Collection[str], gateways: dict[str, str]) -> None:
        """Get to know robots that other gateways have."""
        for robot in await self._database.read(stored_robots.load, sorted(names)):
            if robot.name not in self._robots and not self._ownership.owns(robot.name):
                robot.gateway = gateways[robot.name]
                robot.link = f"gateway {robot.gateway}"
                self._robots.restore(robot, self._clock.time())

    async def _take_up(self, names: Sequence[str]) -> None:
        for begin in range(0, len(names), AT_ONCE):
            some = names[begin : begin + AT_ONCE]
            try:
                await self._read(some)
            except StoreError:
                # Taken up by a later look, as robots that turn out to be this gateway's.
                self._ownership.forget(names[begin:])
                raise

    async def _read(self, some: Sequence[str]) -> None:
        self._commands.drop(some)
        self._queues.drop(some)
        known = await self._database.run(stored_robots.load, some)
        await self._commands.take_up(some)
        for robot in known:
            self._robots.restore(robot, self._clock.time())
            self._robots.assign(robot.name, self._commands.busy_with(robot.name))
        # One that is stored nowhere yet is known to this gateway by its Ready alone.
        for name in set(some) - {robot.name for robot in known}:
            self._robots.remove(name)
        self._saving.begin([robot.name for robot in known])
        await self._queues.take_up(some)
        self._emergency.take_over([robot.name for robot in known if robot.abilities != ""])

    def _drop(self, robot: str, gateway: str | None) -> None:
        log.warning("robot %s has connected to gateway %s", robot, gateway or "none")
        self._commands.drop([robot])
        self._queues.drop([robot])
        self._saving.drop([robot])
        with log_and_continue(log, f"counting robot {robot!r} no more"):
            self._emergency.forget(robot)
        if gateway is None:
            self._robots.remove(robot)
        else:
            self._robots.let_go(robot, gateway)
        self._events.publish(RobotLeft(robot, gateway or "none"))
