"""Robots across gateways: where they are, and the details of them that change seldom.

Positions that changed go out in columns, newest only; what is old is dropped. Details go out when they have
changed.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ...core.messages.base import LONGEST_STATUS, one_line
from ...core.messages.robots import SendPos
from ..model.robots import DescribedElsewhere, ReportedElsewhere, Robot, Robots
from ..monitoring import wait_at_most
from .bus import LARGEST_NOTIFICATION, POSITIONS
from .membership import Membership
from .messages import (
    COLUMNS,
    LARGEST,
    MOST_ROBOTS,
    DetailBatch,
    Exchange,
    PositionBatch,
    RobotDetails,
    Wake,
    in_batches,
)


class NewestBatches:
    """Tells of batches whether they count: what is older than ``old_s``, or overtaken, does not."""

    def __init__(self, old_s: float) -> None:
        self._old_s = old_s
        self._newest: dict[str, float] = {}

    def accept(self, batch: PositionBatch | DetailBatch, now: float) -> bool:
        """Return whether ``batch`` counts at ``now``, by the database's clock; it is the newest then."""
        if abs(now - batch.t) > self._old_s or batch.t < self._newest.get(batch.gw, -math.inf):
            return False
        self._newest[batch.gw] = batch.t
        return True


# --- Where robots are: what changed goes out in columns ---

POSITION_TICK_S = 0.2
"""seconds between two messages: of each robot only the newest position of a tick goes out."""
POSITION_OLD_S = 1.0
"""seconds after which a message is dropped: it has waited somewhere, and newer ones follow it."""
POSITION_ALL_S = 1.0
"""seconds after which robots that say nothing new are told again: another gateway may have come."""
ENDED, LOCATED, ONLY_SEEN = 1, 2, 4
NAME_BYTES = 24
"""bytes that a robot's name takes on average at most, for how many fit into a notification."""


class PositionRelay:
    """Tells other gateways where the robots of this one are, and takes in where theirs are."""

    def __init__(
        self, robots: Robots, membership: Membership, exchange: Exchange, *, small: bool = False
    ) -> None:
        """:param small: that a message has to fit into a notification of PostgreSQL."""
        self._robots = robots
        self._membership = membership
        self._exchange = exchange
        self._most = LARGEST_NOTIFICATION // (4 * COLUMNS + 1 + NAME_BYTES) if small else MOST_ROBOTS
        self._revision = -1
        self._told_all_at, self._was_cut_off = -math.inf, True
        self._newest = NewestBatches(POSITION_OLD_S)
        self._asked = asyncio.Event()
        exchange.subscribe(PositionBatch, self._take)
        exchange.subscribe(Wake, self._woken)

    async def run(self) -> None:
        """Tell until cancelled."""
        while True:
            await wait_at_most(self._asked, POSITION_TICK_S)
            self._asked.clear()
            self.send_changes()

    def send_changes(self) -> None:
        """Tell what changed since the last time, and everything once in a while."""
        if not self._exchange.connected:
            # Nobody heard of what was told last: once the bus is back, all is told at once.
            self._told_all_at, self._was_cut_off = -math.inf, True
            return
        if self._was_cut_off:
            # Others that were back earlier told theirs before this one could hear it.
            self._was_cut_off = False
            self._exchange.wake("positions")
        now = self._membership.database_time()
        everything = now - self._told_all_at >= POSITION_ALL_S
        since, self._revision = (-1 if everything else self._revision), self._robots.revision
        if everything:
            self._told_all_at = now
        mine = [robot for robot in self._robots.changed(since) if robot.gateway is None]
        for begin in range(0, len(mine), self._most):
            some = mine[begin : begin + self._most]
            self._exchange.send(POSITIONS, self._batch(some, now))

    def _batch(self, robots: list[Robot], now: float) -> PositionBatch:
        wall = now - self._membership.clock_offset
        return PositionBatch(
            self._exchange.gateway,
            now,
            [robot.name for robot in robots],
            _numbers(robots, wall).tobytes(),
            bytes(_flags(robots)),
        )

    def _woken(self, wake: Wake) -> None:
        if wake.what == "positions":
            self._told_all_at = -math.inf
            self._asked.set()

    def _take(self, batch: PositionBatch) -> None:
        if not self._newest.accept(batch, self._membership.database_time()):
            return
        wall = batch.t - self._membership.clock_offset
        for name, row, flags in zip(batch.names, batch.table().tolist(), batch.flags, strict=True):
            x, y, theta, v, pose_age, age_of = row
            if not math.isfinite(age_of):
                continue
            has_pose = all(map(math.isfinite, (x, y, theta, v, pose_age)))
            before = self._robots.pose(name)
            # What changes seldom comes by itself.
            battery, status = (None, None) if before is None else (before.battery, before.status)
            seen = ReportedElsewhere(
                received_at=wall - age_of,
                ended_in_order=bool(flags & ENDED),
                located=bool(flags & LOCATED),
                only_seen=bool(flags & ONLY_SEEN),
                pose=SendPos(x, y, theta, v, battery=battery, status=status) if has_pose else None,
                pose_at=wall - pose_age if has_pose else None,
            )
            self._robots.observe_elsewhere(name, batch.gw, seen)


def _numbers(robots: Iterable[Robot], wall: float) -> npt.NDArray[np.float32]:
    rows = []
    for robot in robots:
        pose, at = robot.pose, robot.pose_at
        place = (
            (math.nan,) * 5 if pose is None or at is None else (pose.x, pose.y, pose.theta, pose.v, wall - at)
        )
        rows.append((*place, wall - robot.received_at))
    return np.array(rows, dtype="<f4").reshape(len(rows), COLUMNS)


def _flags(robots: Iterable[Robot]) -> list[int]:
    return [
        ENDED * robot.ended_in_order | LOCATED * robot.located | ONLY_SEEN * (robot.abilities == "")
        for robot in robots
    ]


# --- What changes seldom: battery, status, latency and what robots declared; told when it has changed ---

DETAIL_TICK_S = 1.0
"""seconds between two messages."""
DETAIL_ALL_S = 5.0
"""seconds after which all is told again: another gateway may have come, or a message been lost."""
DETAIL_OLD_S = 5.0
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
        self._newest = NewestBatches(DETAIL_OLD_S)
        exchange.subscribe(DetailBatch, self._take)

    async def run(self) -> None:
        """Tell until cancelled."""
        while True:
            await asyncio.sleep(DETAIL_TICK_S)
            await self.send_changes()

    async def send_changes(self) -> None:
        """Tell what changed since the last time, everything once in a while; others have turns meanwhile."""
        now = self._membership.database_time()
        if not self._exchange.connected or now - self._told_all_at >= DETAIL_ALL_S:
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
        if not self._newest.accept(batch, self._membership.database_time()):
            return
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
