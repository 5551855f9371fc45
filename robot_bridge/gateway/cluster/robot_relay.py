"""Robots across gateways: positions, details that change seldom, and geofence reports.

Changed positions are sent in columns, newest only; old messages are dropped. Details are sent when changed.
Each gateway reports which of its robots are in keepouts and at obstacles.
"""

from __future__ import annotations

import asyncio
import logging
import math
import secrets
from collections.abc import Iterable, Iterator
from dataclasses import fields, replace
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from ...core.logs import log_and_continue
from ...core.messages.base import LONGEST_STATUS, one_line
from ...core.messages.safety import FenceAlarm, FenceKind, Geofence
from ..model.events import EventBus, FenceJudged, FenceJudgedElsewhere
from ..model.robot_columns import (
    POSE_AT,
    REPORTED_FLAGS,
    REPORTED_NUMBERS,
    DescribedElsewhere,
    ReportedElsewhere,
    RobotPlaces,
)
from ..model.robots import Robot, Robots
from ..monitoring import until_tick, wait_at_most
from .bus import EVERYBODY, POSITIONS
from .membership import Membership
from .messages import (
    LARGEST,
    LONGEST_NAME,
    MOST_ALARMS,
    MOST_IDS,
    MOST_UNJUDGED,
    DetailBatch,
    Exchange,
    FencedRobot,
    FenceReport,
    PositionBatch,
    RobotDetails,
    Wake,
    batches,
    fitting_report,
    position_batches,
)

log = logging.getLogger(__name__)


class NewestBatches:
    """Accepts batches unless they are older than ``old_s``, or overtaken."""

    def __init__(self, old_s: float) -> None:
        self._old_s = old_s
        self._newest: dict[str, float] = {}

    def accept(self, batch: PositionBatch | DetailBatch | FenceReport, now: float) -> bool:
        """Return whether ``batch`` is valid at ``now`` (database clock); then it becomes the newest."""
        if abs(now - batch.t) > self._old_s or batch.t < self._newest.get(batch.gw, -math.inf):
            return False
        self._newest[batch.gw] = batch.t
        return True


# --- Positions of robots: changes are sent in columns ---

POSITION_TICK_S = 0.25
"""seconds between messages: only the newest position of each robot in a tick is sent."""
POSITION_OLD_S = 1.0
"""seconds after which a message is dropped: it was delayed, and newer ones follow it."""
TOGETHER_S = 0.02
"""seconds for which messages are collected before they are applied: all gateways send at the same ticks, and
one by one, between other work, they take three times as long."""
NAMES_AGAIN_S = 1.0
"""seconds between requests to a gateway to name its robots."""
POSITION_ALL_S = 10.0
"""seconds after which unchanged robots are sent again: a message may have been lost. A gateway that starts,
learns of another owner of a robot, or misses a name, requests all with their names."""


class PositionRelay:
    """Sends positions of this gateway's robots to other gateways, and receives theirs."""

    def __init__(
        self, robots: Robots, membership: Membership, exchange: Exchange, largest: int = LARGEST
    ) -> None:
        """:param largest: bytes of a message, which the bus takes."""
        self._robots = robots
        self._membership = membership
        self._exchange = exchange
        self._largest = largest
        self._revision = -1
        self._sent_all_at, self._was_cut_off = -math.inf, True
        self._newest = NewestBatches(POSITION_OLD_S)
        self._received, self._has_received = list[PositionBatch](), asyncio.Event()
        self._asked, self._asked_at = asyncio.Event(), -math.inf
        self._run, self._ids = secrets.randbits(62), dict[str, int]()
        """numbers in place of the robots' names, which take longer to send and to read than all else."""
        exchange.subscribe(PositionBatch, self._receive)
        exchange.subscribe(Wake, self._woken)

    async def run(self) -> None:
        """Send, and apply what others send, until cancelled."""
        applying = asyncio.create_task(self._apply_together())
        try:
            while True:
                await wait_at_most(self._asked, until_tick(POSITION_TICK_S))
                self._asked.clear()
                self.send_changes()
        finally:
            applying.cancel()

    def send_changes(self) -> None:
        """Send changes since the last time, and everything at intervals."""
        if not self._exchange.connected:
            # The last message was not received: once the bus is back, all is sent at once.
            self._sent_all_at, self._was_cut_off = -math.inf, True
            return
        if self._was_cut_off:
            # Others that were back earlier sent theirs before this one could receive it.
            self._was_cut_off = False
            self._exchange.wake("positions")
        now = self._membership.database_time()
        is_asked, everything = self._sent_all_at == -math.inf, now - self._sent_all_at >= POSITION_ALL_S
        since, self._revision = (-1 if everything else self._revision), self._robots.revision
        if everything:
            self._sent_all_at = now
        mine = self._robots.own_places(since)
        if mine.names:
            for batch in position_batches(self._batch(mine, now, name_all=is_asked), self._largest):
                self._exchange.send(POSITIONS, batch)

    def _batch(self, robots: RobotPlaces, now: float, *, name_all: bool) -> PositionBatch:
        """Return the robots' positions; new robots are named, with ``name_all`` all."""
        names = robots.names
        if len(self._ids) + len(names) > MOST_IDS:
            # Most of the earlier robots are gone.
            self._run, self._ids, name_all = self._run + 1, {}, True
        known, ids = len(self._ids), self._ids
        numbers = np.array([ids.setdefault(name, len(ids)) for name in names], dtype="<u4")
        table = robots.table[:REPORTED_NUMBERS].T
        table[:, POSE_AT:] = now - self._membership.clock_offset - table[:, POSE_AT:]
        flags, named = robots.flags & REPORTED_FLAGS, len(names) if name_all else len(ids) - known
        if 0 < named < len(names):
            # Named robots come first.
            order = np.argsort(numbers < known, kind="stable")
            names = [names[row] for row in order[:named].tolist()]
            numbers, table, flags = numbers[order], table[order], flags[order]
        return PositionBatch(
            self._exchange.gateway,
            now,
            self._run,
            numbers.tobytes(),
            names[:named],
            table.astype("<f4").tobytes(),
            flags.tobytes(),
        )

    def _woken(self, wake: Wake) -> None:
        if wake.what == "positions":
            self._sent_all_at = -math.inf
            self._asked.set()

    def apply_received(self) -> None:
        """Apply the messages received since the last time."""
        received, self._received = self._received, []
        for batch in received:
            with log_and_continue(log, "applying positions of gateway %s", batch.gw):
                self._apply(batch)

    async def _apply_together(self) -> None:
        while True:
            await self._has_received.wait()
            await asyncio.sleep(TOGETHER_S)
            self._has_received.clear()
            self.apply_received()

    def _receive(self, batch: PositionBatch) -> None:
        self._received.append(batch)
        self._has_received.set()

    def _apply(self, batch: PositionBatch) -> None:
        if not self._newest.accept(batch, self._membership.database_time()):
            return
        wall = batch.t - self._membership.clock_offset
        flags = np.frombuffer(batch.flags, dtype=np.uint8)
        report = ReportedElsewhere(
            batch.gw, batch.run, batch.robots(), batch.names, batch.table(), flags, wall
        )
        if not self._robots.observe_elsewhere(report) and batch.t - self._asked_at >= NAMES_AGAIN_S:
            # A message was lost, or came before this gateway knew that the other one owns the robot.
            self._asked_at = batch.t
            self._exchange.wake("positions", batch.gw)


# --- Details: battery, status, latency and what robots declared; sent on changes ---

DETAIL_TICK_S = 1.0
"""seconds between messages."""
DETAIL_ALL_S = 60.0
"""seconds after which all is sent again: a message may have been lost."""
DETAIL_ALL_AGAIN_S = 5.0
"""minimum seconds between full transmissions: gateways of a fleet start together and request them."""
DETAIL_OLD_S = 5.0
"""seconds after which a message is dropped: it was delayed."""

LATENCY_S, LATENCY_PART = 0.02, 0.5
"""Absolute (s) and relative change of latency below which it is not sent: each robot's is measured every few
seconds, never twice the same."""
PIECE = 500
"""robots checked before other tasks have their turn: less than a millisecond."""

_OF_ROBOT = attrgetter("doubt", "latency", "paths", "abilities", "magic")
_OF_POSE = attrgetter("battery", "status")
_UNKNOWN = (None, None)
_Facts = tuple[Any, ...]


class _Sent(NamedTuple):
    """The details last sent of a robot, and their source values: usually those are unchanged."""

    of_robot: _Facts
    of_pose: _Facts
    facts: _Facts


class DetailRelay:
    """Sends details of this gateway's robots to other gateways, and receives theirs.

    A robot becomes known by its position, which is sent more often and in the same order.
    """

    def __init__(
        self, robots: Robots, membership: Membership, exchange: Exchange, largest: int = LARGEST
    ) -> None:
        """:param largest: bytes of a message, which the bus takes."""
        self._robots = robots
        self._membership = membership
        self._exchange = exchange
        self._largest = largest
        self._sent: dict[str, _Sent] = {}
        self._revision, self._sent_all_at, self._is_asked = -1, -math.inf, False
        self._newest = NewestBatches(DETAIL_OLD_S)
        exchange.subscribe(DetailBatch, self._apply)
        exchange.subscribe(Wake, self._woken)

    async def run(self) -> None:
        """Send until cancelled."""
        while True:
            await asyncio.sleep(until_tick(DETAIL_TICK_S))
            await self.send_changes()

    async def send_changes(self) -> None:
        """Send changes since the last time, everything at intervals; other tasks run in between."""
        now = self._membership.database_time()
        if not self._exchange.connected:
            self._sent_all_at = -math.inf
            return
        if now - self._sent_all_at >= (DETAIL_ALL_AGAIN_S if self._is_asked else DETAIL_ALL_S):
            self._sent, self._revision, self._sent_all_at, self._is_asked = {}, -1, now, False
        since, self._revision = self._revision, self._robots.revision
        robots = self._robots.own_described(since)
        for begin in range(0, len(robots), PIECE):
            self._send_changed(robots[begin : begin + PIECE], now)
            await asyncio.sleep(0)

    def _woken(self, wake: Wake) -> None:
        self._is_asked |= wake.what == "positions"

    def _send_changed(self, robots: Iterable[Robot], now: float) -> None:
        changed, sent = [], self._sent
        for robot in robots:
            name, last = robot.name, sent.get(robot.name)
            of_robot, of_pose = _OF_ROBOT(robot), _OF_POSE(robot.pose) if robot.pose else _UNKNOWN
            if last is not None and last.of_robot == of_robot and last.of_pose == of_pose:
                continue
            facts = _facts(of_robot, of_pose, None if last is None else last.facts)
            sent[name] = _Sent(of_robot, of_pose, facts)
            if last is None or last.facts != facts:
                changed.append(_details(name, facts))
        for some in batches(changed, self._largest):
            self._exchange.send(POSITIONS, DetailBatch(self._exchange.gateway, now, some))

    def _apply(self, batch: DetailBatch) -> None:
        if not self._newest.accept(batch, self._membership.database_time()):
            return
        for one in batch.robots:
            described = DescribedElsewhere(
                one.battery, one.status, one.doubt, one.latency, one.paths, one.abilities, one.magic
            )
            self._robots.describe_elsewhere(one.name, batch.gw, described)


def _facts(of_robot: _Facts, of_pose: _Facts, sent: _Facts | None) -> _Facts:
    """Return the values to send, in the order of :class:`RobotDetails`; ``sent`` are the last ones."""
    doubt, latency, *declared = of_robot
    battery, status = of_pose
    # Rounded: smaller changes do not matter to an operator.
    battery = None if battery is None else round(battery, 2)
    return battery, status, doubt, _latency(latency, None if sent is None else sent[3]), *declared


def _latency(now: float | None, sent: float | None) -> float | None:
    if now is None:
        return None
    is_same = sent is not None and abs(now - sent) <= max(LATENCY_S, LATENCY_PART * sent)
    return sent if is_same else round(now, 3)


def _details(name: str, facts: _Facts) -> RobotDetails:
    battery, status, doubt, *more = facts
    return RobotDetails(
        name, battery, status, None if doubt is None else one_line(doubt, LONGEST_STATUS), *more
    )


# --- Robots in keepouts and at obstacles: each gateway checks its own

FENCE_OLD_S = 5.0
"""seconds after which a report is dropped: it was delayed."""
_LONGEST_LINE = 500
_OF_ALARM = attrgetter(*(field.name for field in fields(FenceAlarm)))


class FenceRelay:
    """Sends geofence reports on this gateway's robots to other gateways, and receives theirs."""

    def __init__(
        self, membership: Membership, exchange: Exchange, events: EventBus, largest: int = LARGEST
    ) -> None:
        """:param largest: bytes of a message, which the bus takes."""
        self._membership = membership
        self._exchange = exchange
        self._events = events
        self._largest = largest
        self._newest = NewestBatches(FENCE_OLD_S)
        events.subscribe(FenceJudged, self._send)
        exchange.subscribe(FenceReport, self._apply)

    def _send(self, judged: FenceJudged) -> None:
        found, offset = judged.report, self._membership.clock_offset
        report = FenceReport(
            self._exchange.gateway,
            self._membership.database_time(),
            [_fenced(alarm, alarm.since + offset) for alarm in found.alarms],
            found.more,
            found.unjudged,
            found.unjudged_more,
            _line(found.fault),
        )
        self._exchange.send(EVERYBODY, fitting_report(report, self._largest))

    def _apply(self, report: FenceReport) -> None:
        if not self._newest.accept(report, self._membership.database_time()):
            return
        offset = self._membership.clock_offset
        found = Geofence(
            t=report.t - offset,
            alarms=[_alarm(fenced, fenced.since - offset) for fenced in report.alarms],
            more=report.more,
            unjudged=report.unjudged,
            unjudged_more=report.unjudged_more,
            fault=report.fault,
        )
        self._events.publish(FenceJudgedElsewhere(report.gw, found))


REPORT_HOLDS_S = 10.0
"""seconds after its last report until a gateway no longer counts as checking its robots."""


class ReportsElsewhere:
    """The newest report of each other gateway, of its own robots; times by the steady clock."""

    def __init__(self) -> None:
        self._reports: dict[str, tuple[float, Geofence]] = {}
        self._kept: dict[str, tuple[float, list[FenceAlarm]]] = {}
        """Alarms of robots when they moved here, with the time of that."""

    def add_report(self, gateway: str, report: Geofence, now: float) -> None:
        """Store a gateway's report."""
        self._reports[gateway] = now, report

    def at(self, now: float) -> dict[str, Geofence]:
        """Return the reports valid at time ``now``, by gateway."""
        return {
            gateway: report
            for gateway, (came, report) in self._reports.items()
            if now - came < REPORT_HOLDS_S
        }

    def keep_alarms(self, robot: str, now: float) -> None:
        """Keep a robot's alarms at time ``now``: it moves here, and its old gateway stops reporting it."""
        self.drop_alarms([robot])
        if alarms := [alarm for alarm in self._alarms(now) if alarm.robot == robot]:
            self._kept[robot] = now, alarms

    def drop_alarms(self, robots: Iterable[str]) -> None:
        """Drop the alarms of robots that are checked here, or are gone."""
        if self._kept:
            for robot in robots:
                self._kept.pop(robot, None)

    def alarm(self, robot: str, kind: FenceKind, name: str, now: float) -> FenceAlarm | None:
        """Return the alarm that a gateway reported of a robot in an area before it moved here.

        None without such an alarm in a report valid at ``now``, or when the robot moved here recently.
        """
        same = robot, kind, name[:LONGEST_NAME]
        came, kept = self._kept.get(robot, (-math.inf, []))
        alarms = (*(kept if now - came < REPORT_HOLDS_S else ()), *self._alarms(now))
        return next((alarm for alarm in alarms if (alarm.robot, alarm.kind, alarm.name) == same), None)

    def _alarms(self, now: float) -> Iterator[FenceAlarm]:
        return (alarm for report in self.at(now).values() for alarm in report.alarms)


def join_reports(first: Geofence, others: Iterable[Geofence]) -> Geofence:
    """Return ``first`` with the alarms of ``others`` in the same areas, within the same limits."""
    reports = [first, *others]
    alarms = sorted((alarm for one in reports for alarm in one.alarms), key=lambda alarm: -alarm.since)
    unjudged = sorted(name for one in reports for name in one.unjudged)
    return replace(
        first,
        alarms=alarms[:MOST_ALARMS],
        more=sum(one.more for one in reports) + max(len(alarms) - MOST_ALARMS, 0),
        unjudged=unjudged[:MOST_UNJUDGED],
        unjudged_more=sum(one.unjudged_more for one in reports) + max(len(unjudged) - MOST_UNJUDGED, 0),
        fault=next((one.fault for one in reports if one.fault is not None), None),
    )


def _fenced(alarm: FenceAlarm, since: float) -> FencedRobot:
    robot, kind, name, _, x, y, action, outcome, reason, current = _OF_ALARM(alarm)
    return FencedRobot(robot, kind, name[:LONGEST_NAME], since, x, y, action, outcome, _line(reason), current)


def _alarm(fenced: FencedRobot, since: float) -> FenceAlarm:
    robot, kind, name, _, *more = _OF_ALARM(fenced)
    return FenceAlarm(robot, kind, name, round(since, 1), *more)


def _line(text: str | None) -> str | None:
    return None if text is None else one_line(text, _LONGEST_LINE)
