"""Details across gateways: battery, status, latency and what robots declared, when they have changed."""

from __future__ import annotations

import asyncio
import math

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
        self._told: dict[str, RobotDetails] = {}
        self._told_all_at = -math.inf
        self._newest: dict[str, float] = {}
        exchange.subscribe(DetailBatch, self._take)

    async def run(self) -> None:
        """Tell until cancelled."""
        while True:
            await asyncio.sleep(TICK_S)
            self.send_changes()

    def send_changes(self) -> None:
        """Tell what changed since the last time, and everything once in a while."""
        now = self._membership.database_time()
        if not self._exchange.connected or now - self._told_all_at >= ALL_S:
            self._told.clear()
            self._told_all_at = now
        mine = {robot.name: _details(robot) for robot in self._robots.changed(-1) if robot.gateway is None}
        changed = [details for name, details in mine.items() if self._told.get(name) != details]
        self._told = mine
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


def _details(robot: Robot) -> RobotDetails:
    pose = robot.pose
    return RobotDetails(
        robot.name,
        # Not told again for less than an operator sees.
        None if pose is None or pose.battery is None else round(pose.battery, 2),
        None if pose is None else pose.status,
        None if robot.doubt is None else one_line(robot.doubt, LONGEST_STATUS),
        None if robot.latency is None else round(robot.latency, 3),
        robot.paths,
        robot.abilities,
        robot.magic,
    )
