"""Details across gateways: battery, status, latency and what robots declared, when they have changed."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterable, Mapping
from typing import Any

from ...core.messages.validation import LONGEST_STATUS, one_line
from ..model.robots import DescribedElsewhere, Robot, Robots
from .bus import LARGEST_NOTIFICATION, POSITIONS
from .exchange import Exchange
from .membership import Membership
from .messages import LARGEST, DetailBatch, RobotDetails, in_batches

TICK_S = 1.0
"""seconds between two messages."""
ALL_S = 5.0
"""seconds after which all is told again: another gateway may have come, or a message been lost."""
OLD_S = 5.0
"""seconds after which a message is dropped: all has been told again since."""

PIECE = 500
"""robots that are looked at before others have their turn: less than a millisecond."""

_Facts = tuple[Any, ...]


class DetailRelay:
    """Tells other gateways the details of the robots of this one, and takes in those of theirs.

    A robot is known by its position first, which goes out more often and in the same order.
    """

    def __init__(
        self, robots: Robots, membership: Membership, exchange: Exchange, *, small: bool = False
    ) -> None:
        """:param small: that a message has to fit into a notification of PostgreSQL."""
        self._robots = robots
        self._membership = membership
        self._exchange = exchange
        self._largest = LARGEST_NOTIFICATION if small else LARGEST
        self._told: dict[str, _Facts] = {}
        self._told_all_at = -math.inf
        self._newest: dict[str, float] = {}
        exchange.subscribe(DetailBatch, self._take)

    async def run(self) -> None:
        """Tell until cancelled."""
        while True:
            await asyncio.sleep(TICK_S)
            await self.send_changes()

    async def send_changes(self) -> None:
        """Tell what changed since the last time, everything once in a while; others have turns meanwhile."""
        now = self._membership.database_time()
        if not self._exchange.connected or now - self._told_all_at >= ALL_S:
            self._told.clear()
            self._told_all_at = now
        told, self._told = self._told, {}
        robots = self._robots.changed(-1)
        for begin in range(0, len(robots), PIECE):
            self._send_changed(robots[begin : begin + PIECE], told, now)
            await asyncio.sleep(0)

    def _send_changed(self, robots: Iterable[Robot], told: Mapping[str, _Facts], now: float) -> None:
        changed = []
        for robot in robots:
            if robot.gateway is None:
                name, facts = robot.name, _facts(robot)
                if told.get(name) != facts:
                    changed.append(_details(name, facts))
                self._told[name] = facts
        for some in in_batches(changed, self._largest):
            self._exchange.send(POSITIONS, DetailBatch(self._exchange.gateway, now, some))

    def _take(self, batch: DetailBatch) -> None:
        age = self._membership.database_time() - batch.t
        if abs(age) > OLD_S or batch.t < self._newest.get(batch.gw, -math.inf):
            return
        self._newest[batch.gw] = batch.t
        for one in batch.robots:
            described = DescribedElsewhere(
                one.battery, one.status, one.doubt, one.latency, one.paths, one.abilities, one.magic
            )
            self._robots.describe_elsewhere(one.name, batch.gw, described)


def _facts(robot: Robot) -> _Facts:
    """Return what is told of a robot, in the order of its :class:`RobotDetails`."""
    pose, latency = robot.pose, robot.latency
    battery, status = (None, None) if pose is None else (pose.battery, pose.status)
    return (
        # Not told again for less than an operator sees.
        None if battery is None else round(battery, 2),
        status,
        robot.doubt,
        None if latency is None else round(latency, 3),
        robot.paths,
        robot.abilities,
        robot.magic,
    )


def _details(name: str, facts: _Facts) -> RobotDetails:
    battery, status, doubt, *more = facts
    return RobotDetails(
        name, battery, status, None if doubt is None else one_line(doubt, LONGEST_STATUS), *more
    )
