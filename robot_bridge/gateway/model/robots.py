"""Current state of robots: poses, clocks, liveness, link latency; no I/O."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import NamedTuple

import numpy as np

from ...core.clock import LEAST_BEHIND, UNKNOWN_AGE, ClockStep
from ...core.errors import NotReadyError, OtherRunError, RefusedError
from ...core.messages.base import check_robot_name
from ...core.messages.positions import link_elsewhere
from ...core.messages.robots import MOTIONS, Command, SendPos, SetPosEnd
from ...core.messages.safety import Ability, PathDeclaration, RobotState
from .arrival import standing
from .events import EventBus, RobotReturned
from .position_checks import AcceptedArea, PoseOrder
from .robot_columns import (
    DOUBTED,
    ONLY_SEEN,
    RECEIVED_AT,
    DescribedElsewhere,
    ReportedElsewhere,
    ReportedRows,
    RobotColumns,
    RobotPlaces,
    RobotRows,
    liveness,
)

# --- Current state of robots: poses, clocks, liveness and link latency; no I/O ---
# Three clocks are distinguished: the robot's (``t`` of a pose), that of the fix (``fix_t``), the gateway's,
# by which alone a robot is fresh, stale or lost.

RobotPose = tuple[str, SendPos]
OLD = (
    "its position was {:.0f} s old when it came, by its own time (fix_t, else t): it waited on its way, or "
    "is one that the receiver repeats. The robot may be elsewhere"
)
UNSEEN = (
    "it was driving when it said its position last, and has said none for {:g} s. The robot may be elsewhere"
)
"""Reason why a robot may not be where it is shown, after so many seconds."""
AWAY = (RobotState.LOST, RobotState.OFFLINE)
"""States of robots that no message can reach."""


@dataclass
class Robot:
    """One robot. ``received_at`` is the gateway's time of its last message, ``pose_at`` the time of its pose.

    ``latency`` is the round-trip time of its link in seconds, when last measured. ``paths`` is the
    declaration in its last Ready, to this gateway or to an earlier one. ``located`` is true once it has
    reported its position since its last Ready: until then its pose is the stored one, or the one before its
    link broke, and it may have driven on unseen. ``doubt`` is the reason why it may not be at its pose.
    ``says_magic`` is true once this run has sent its magic number with a message. ``abilities`` are its
    abilities separated by spaces, None for all. ``described`` is the last revision at which more than its
    position may have changed. ``gateway`` is the other gateway of the fleet that has it, None for this one;
    all other fields are then as that gateway reports them. ``ended_in_order`` is true from Stopped until it
    drives, and once it closed its link in good order; ``heard_since``: it has sent a message after that.
    """

    name: str
    magic: int
    link: str
    received_at: float
    ended_in_order: bool = False
    heard_since: bool = False
    pose: SendPos | None = None
    pose_at: float | None = None
    located: bool = False
    state: RobotState = RobotState.FRESH
    command: str | None = None
    latency: float | None = None
    doubt: str | None = None
    says_magic: bool = False
    revision: int = 0
    described: int = 0
    paths: PathDeclaration | None = None
    abilities: str | None = None
    gateway: str | None = None
    order: PoseOrder = field(default_factory=PoseOrder)

    @property
    def asks_path(self) -> bool:
        """Whether it declared that it requests its path to every target, and does not drive before."""
        return self.paths in ("asks", "asks and cones")

    @property
    def places_on_paths(self) -> bool:
        """Whether it declared that it places and collects cones at the ends of paths."""
        return self.paths in ("cones", "asks and cones")

    @property
    def is_placed(self) -> bool:
        """Whether its present position is known: it is FRESH, has reported a position since its last Ready,
        and is believed. Of others only a past position is known: they may have driven on unseen.
        """
        return self.located and self.state is RobotState.FRESH and self.doubt is None

    def can(self, ability: Ability) -> bool:
        """Return whether it has ``ability``: it has all where it declared none."""
        return self.abilities is None or ability in self.abilities.split()


class RobotSelection(NamedTuple):
    """Some robots by name, looked up once for repeated queries of which of them have changed."""

    names: Sequence[str]
    own: RobotRows
    others: RobotRows


class Robots:
    """All robots by name. Every change gets the next revision, so that a reader can query what is new."""

    def __init__(
        self, stale_after: float = 3.0, lost_after: float = 10.0, events: EventBus | None = None
    ) -> None:
        self._stale_after = stale_after
        self._lost_after = lost_after
        self._robots: dict[str, Robot] = {}
        self._elsewhere: dict[str, Robot] = {}
        """those of other gateways, each as it was when last read."""
        self._details: dict[str, tuple[float | None, str | None]] = {}
        """battery and status of robots of other gateways."""
        self._own_columns = RobotColumns()
        """robots of this gateway a second time, for evaluating many at once."""
        self._other_columns = RobotColumns()
        """what other gateways reported last of their robots."""
        self._removed: dict[str, int] = {}
        """robots that were removed and have not come back, with the revision of their removal."""
        self.revision = 0
        self._events = events or EventBus()

    def limit(self, stale_after: float, lost_after: float) -> None:
        """Set the limits of liveness, in seconds."""
        self._stale_after, self._lost_after = stale_after, lost_after

    def __contains__(self, name: str) -> bool:
        return name in self._robots or name in self._other_columns

    def count(self) -> int:
        """Return the number of robots."""
        return len(self._robots) + len(self._other_columns)

    def names(self) -> list[str]:
        """Return the names of all robots, sorted."""
        return sorted([*self._robots, *self._other_columns.names()])

    def own_names(self) -> list[str]:
        """Return the names of the robots of this gateway."""
        return list(self._robots)

    def commanded(self) -> list[str]:
        """Return the names of the robots of this gateway that are not only seen, sorted."""
        return sorted(name for name, robot in self._robots.items() if robot.abilities != "")

    def readers(self) -> list[str]:
        """Return the names of those of them that hear nothing but rows of the database, sorted."""
        own = self._robots.items()
        return sorted(name for name, robot in own if robot.link == "sql" and robot.abilities != "")

    def commanded_elsewhere(self) -> list[str]:
        """Return the names of the robots of other gateways that are not only seen, sorted."""
        return sorted(set(self._other_columns.names()).difference(self._other_columns.only_seen()))

    def count_commanded(self) -> int:
        """Return the number of robots, at any gateway, that are not only seen."""
        return self.count() - self._own_columns.count_only_seen() - self._other_columns.count_only_seen()

    def doing(self, command: str) -> str | None:
        """Return the name of the robot that is busy with a command, None where none is known."""
        everybody = chain(self._robots.items(), self._elsewhere.items())
        return next((name for name, robot in everybody if robot.command == command), None)

    def gateway_of(self, name: str) -> str | None:
        """Return the other gateway of the fleet that has a robot; None for this one, and for none at all."""
        robot = self._elsewhere.get(name)
        return None if robot is None else robot.gateway

    def is_only_seen(self, name: str) -> bool:
        """Return whether the robot declared no abilities, so that nothing is sent to it."""
        robot = self._find(name)
        return robot is not None and robot.abilities == ""

    def get(self, name: str) -> Robot:
        """Return the robot ``name``; raises NotReadyError if it never said Ready."""
        robot = self._find(name)
        if robot is None:
            raise NotReadyError(f"robot {name!r} has not said Ready to this gateway; send Ready first")
        return robot

    def check_known(self, name: str) -> None:
        """Raise RefusedError for a robot that never said Ready, MessageError for an invalid name."""
        check_robot_name(name)
        if name not in self:
            known = ", ".join(self.names()) or "none yet"
            raise RefusedError(f"robot {name!r} is not known to this gateway; known are: {known}")

    def pose(self, name: str) -> SendPos | None:
        """Return the last reported pose of a robot, None for one that never reported any."""
        robot = self._find(name)
        return None if robot is None else robot.pose

    def straight_from(self, name: str, message: Command) -> tuple[float, float] | None:
        """Return the position from which a robot drives straight to a target, or to a path's first point.

        This is its last reported position; None for one that never reported any, and for one that requests
        a path to the target first.
        """
        robot = self._find(name)
        if robot is None or robot.pose is None or not isinstance(message, MOTIONS):
            return None
        if isinstance(message, SetPosEnd) and robot.asks_path:
            return None
        return robot.pose.x, robot.pose.y

    def is_placed(self, name: str) -> bool:
        """Return whether the present position of a robot is known."""
        robot = self._find(name)
        return robot is not None and robot.is_placed

    def is_doubted(self, name: str) -> bool:
        """Return whether the last reported position of a robot is not believed, or is out of date."""
        robot = self._find(name)
        return robot is not None and robot.doubt is not None

    def is_unseen(self, name: str, now: float) -> bool:
        """Return whether a robot may have moved since it reported its position: too long ago, or before its
        link or the gateway broke.
        """
        robot = self._find(name)
        if robot is None or robot.pose_at is None:
            return False
        return not robot.located or now - robot.pose_at >= self._stale_after

    def restore(self, robot: Robot, now: float) -> None:
        """Add a robot that an earlier gateway knew. One last received later than ``now``, as on a computer
        whose clock stands still without power, counts as not received for long."""
        if robot.received_at > now:
            is_behind = robot.received_at - now >= LEAST_BEHIND
            robot.received_at = now - UNKNOWN_AGE if is_behind else now
        if robot.pose_at is not None:
            robot.pose_at = min(robot.pose_at, robot.received_at)
        if robot.pose is not None:
            robot.order = PoseOrder(robot.pose.fix_t, robot.pose.t, robot.link)
        robot.state = self._judge(robot, now)
        self._add(robot)

    def starts_anew(self, name: str, magic: int) -> bool:
        """Return whether a Ready with ``magic`` comes from another run of a known robot."""
        robot = self._find(name)
        return robot is not None and robot.magic != magic

    def ready(
        self,
        name: str,
        magic: int,
        link: str,
        now: float,
        paths: PathDeclaration | None = None,
        abilities: str | None = None,
    ) -> None:
        """Register a robot, or this run of it; ``paths`` and ``abilities`` are its declarations of them."""
        is_new_run = self.starts_anew(name, magic)
        robot = self._find(name) or Robot(name, magic, link, now)
        robot.gateway = None
        self._add(robot)
        if is_new_run and robot.pose is not None:
            # The clock of a robot that restarted may have restarted too.
            robot.pose = replace(robot.pose, t=None)
            robot.order.restarted()
        robot.magic, robot.link, robot.located, robot.says_magic = magic, link, False, False
        robot.doubt, robot.ended_in_order = None, False
        robot.paths, robot.abilities = paths, abilities
        self.note_received(name, link, now)

    def check_run(self, name: str, magic: int | None, link: str) -> None:
        """Raise OtherRunError for a message that is not from the registered run of the robot.

        Over SQL all runs share one name: a run that has sent its ``magic`` number sends it with everything.
        """
        robot = self.get(name)
        if robot.gateway is not None:
            raise NotReadyError(
                f"robot {name!r} said Ready to gateway {robot.gateway!r} last; send Ready first"
            )
        if magic == robot.magic:
            robot.says_magic = True
        elif magic is not None or (robot.says_magic and link == "sql"):
            came = "without a magic number" if magic is None else f"with magic {magic}"
            raise OtherRunError(
                f"this came {came}, and robot {name!r} was let in with {robot.magic}: another one under its "
                "account, or one that has not said Ready; it counts for nothing until its Ready is taken"
            )

    def note_received(
        self, name: str, link: str, now: float, *, stopped: bool = False, waited: bool = False
    ) -> Robot:
        """Record that a message of the robot was received; ``stopped`` when it is Stopped.

        One that has ``waited`` until there was a gateway to read it does not show that the robot is there.
        """
        robot = self.get(name)
        # Only driving, or a Ready, sets a robot that said Stopped in motion.
        robot.ended_in_order |= stopped
        self._record_received(robot, link, now, stopped=stopped, waited=waited)
        self._touch(robot)
        return robot

    def observe(self, name: str, pose: SendPos, link: str, now: float, *, waited: bool = False) -> bool:
        """Apply a pose; return false for a late one (see :class:`.PoseOrder`), which moves nothing.

        One that has ``waited`` is a past position of the robot.
        """
        robot = self.get(name)
        robot.ended_in_order &= standing(pose)
        self._record_received(robot, link, now, stopped=False, waited=waited)
        is_newest = robot.order.admit(pose.fix_t, pose.t, link, now)
        if is_newest:
            self._place(robot, pose, now)
            if waited:
                robot.pose_at, robot.doubt = robot.received_at, None
            else:
                robot.located = True
        self._touch(robot)
        return is_newest

    def follow(self, name: str, pose: SendPos, link: str, now: float, near: AcceptedArea) -> bool | None:
        """Apply, as :meth:`observe`, a pose that only continues from the robot's position a moment ago.

        Return false for a late one, and for one that is ``stale_after`` old or older; None, with nothing
        done, where it needs the full checks.
        """
        robot = self._robots.get(name)
        x_min, y_min, x_max, y_max, step = near
        if (
            robot is None
            or (last := robot.pose) is None
            or robot.pose_at is None
            or not (-step <= pose.x - last.x <= step and -step <= pose.y - last.y <= step)
            or not (x_min <= pose.x <= x_max and y_min <= pose.y <= y_max)
            or not now - robot.pose_at < self._stale_after
            or robot.state is not RobotState.FRESH
            or not (robot.located and robot.doubt is None and not robot.ended_in_order)
            or not (pose.magic is None and robot.link == link)
        ):
            return None
        robot.received_at = now
        robot.revision = self.revision = self.revision + 1
        if not robot.order.admit(pose.fix_t, pose.t, link, now):
            self._own_columns.write(robot)
            return False
        if robot.order.delay >= self._stale_after:
            self._place(robot, pose, now)
            self._touch(robot)
            return False
        robot.pose, robot.pose_at = pose, now - robot.order.delay
        if pose.battery == last.battery and pose.status == last.status and pose.accuracy == last.accuracy:
            self._own_columns.move(name, pose, robot.pose_at, now, robot.revision)
        else:
            robot.described = robot.revision
            self._own_columns.write(robot)
        return True

    def let_go(self, name: str, gateway: str) -> None:
        """Record that another gateway has a robot."""
        robot = self._find(name)
        if robot is not None and robot.gateway != gateway:
            robot.gateway, robot.link = gateway, link_elsewhere(gateway)
            self._add(robot)

    def observe_elsewhere(self, report: ReportedElsewhere) -> bool:
        """Apply the report of another gateway on robots that it has; others in it are ignored.

        Return whether all of them are known by their numbers: else that gateway must name them again.
        """
        self.revision, missing, all_named = self._other_columns.observe(report, self.revision)
        new = [row for row in missing if report.names[row] not in self._robots]
        if not new:
            return all_named
        link = link_elsewhere(report.gateway)
        for row in new:
            received_at = report.wall - float(report.table[row, RECEIVED_AT])
            self._add(Robot(report.names[row], 0, link, received_at, gateway=report.gateway))
        self.revision = self._other_columns.observe(report.only(new), self.revision).revision
        return all_named

    def describe_elsewhere(self, name: str, gateway: str, said: DescribedElsewhere) -> None:
        """Apply the details that another gateway reports of a robot that it has."""
        robot = self._elsewhere.get(name)
        if robot is None or robot.gateway != gateway:
            return
        known = (
            *self._details.get(name, (None, None)),
            robot.doubt,
            robot.latency,
            robot.paths,
            robot.abilities,
        )
        if (*known, None if said.magic is None else robot.magic) == said:
            # Repeated in case a message was lost: no reader has to read the robot again for that.
            return
        robot.doubt, robot.latency = said.doubt, said.latency
        robot.paths, robot.abilities = said.paths, said.abilities
        robot.magic = robot.magic if said.magic is None else said.magic
        self._details[name] = said.battery, said.status
        self.revision += 1
        flags = ONLY_SEEN * (said.abilities == "") | DOUBTED * (said.doubt is not None)
        self._other_columns.describe(name, said.battery, flags, self.revision)

    def disbelieve(self, name: str, link: str, now: float, doubt: str, *, waited: bool = False) -> None:
        """Record that the robot was received, and that its reported position is implausible."""
        self.get(name).doubt = doubt
        self.note_received(name, link, now, waited=waited)

    def remove(self, name: str) -> None:
        """Remove a robot until it says Ready again."""
        if self._forget_here(name) or self._forget_elsewhere(name):
            self.revision += 1
            self._removed[name] = self.revision

    def removed(self, since: int) -> list[str]:
        """Return the robots that were removed after revision ``since`` and have not come back."""
        return [name for name, revision in self._removed.items() if revision > since]

    def closed(self, name: str) -> None:
        """Record that the robot closed its link in good order."""
        robot = self._find(name)
        if robot is not None:
            robot.ended_in_order, robot.heard_since = True, False
            self._touch(robot)

    def measured(self, name: str, latency: float) -> None:
        """Record the round-trip time of the robot's link in seconds; sent with the robot's next change."""
        robot = self._find(name)
        if robot is not None and robot.latency != latency:
            self.revision += 1
            robot.latency, robot.described = latency, self.revision

    def assign(self, name: str, command: str | None) -> None:
        """Set the command that the robot is busy with."""
        robot = self._find(name)
        if robot is not None and robot.command != command:
            robot.command = command
            self._touch(robot)

    def clock_was_set(self, step: ClockStep) -> None:
        """Keep the ages of the last messages: silent robots would be fresh again, or all of them lost."""
        for robot in self._robots.values():
            robot.received_at = step.moved(robot.received_at)
            robot.pose_at = None if robot.pose_at is None else step.moved(robot.pose_at)
            robot.order.clock_was_set()
        self._own_columns.move_times(step)
        self._other_columns.move_times(step)

    def age(self, now: float) -> None:
        """Update the state of every robot to ``now``; each one that changed gets a new revision."""
        if not self.revision:
            # There was no robot yet.
            return
        for name in self._own_columns.outdated(now, self._stale_after, self._lost_after):
            robot = self._robots[name]
            # Were the gateway's clock set back, a silent robot would stay fresh until it has caught up.
            robot.received_at = min(robot.received_at, now)
            robot.state = self._judge(robot, now)
            self._touch(robot)
        for name in self._own_columns.driving_unseen(now - self._stale_after):
            robot = self._robots[name]
            robot.doubt = UNSEEN.format(self._stale_after)
            self._touch(robot)
        self.revision = self._other_columns.age(now, self._stale_after, self._lost_after, self.revision)

    def changed(self, since: int) -> list[Robot]:
        """Return the robots that changed after revision ``since``, those of this gateway first."""
        return self.own(since) + self._renew(self._other_columns.changed(since))

    def own(self, since: int = -1) -> list[Robot]:
        """Return the robots of this gateway that changed after revision ``since``."""
        return [robot for robot in self._robots.values() if robot.revision > since]

    def own_described(self, since: int) -> list[Robot]:
        """Return this gateway's robots with possible changes after ``since`` beyond their position."""
        return [robot for robot in self._robots.values() if robot.described > since]

    def own_places(self, since: int = -1) -> RobotPlaces:
        """Return the positions of the robots of this gateway that changed after revision ``since``."""
        return self._own_columns.places(since)

    def places_elsewhere(self, since: int = -1, without: Collection[str] = ()) -> RobotPlaces:
        """Return the positions of the robots of other gateways, except ``without``, that changed after
        revision ``since``."""
        return self._other_columns.places(since, without)

    def places(self, since: int = -1, without: Collection[str] = ()) -> RobotPlaces:
        """Return the positions of all robots that changed after revision ``since``, those of this gateway
        first, without the robots of the other gateways ``without``."""
        own, elsewhere = self.own_places(since), self.places_elsewhere(since, without)
        return own.join(elsewhere) if elsewhere.names else own

    def only_seen(self) -> list[Robot]:
        """Return the robots without any ability."""
        here = [robot for robot in self._robots.values() if robot.abilities == ""]
        return here + self._renew(self._other_columns.only_seen())

    def known(self, names: Iterable[str]) -> list[Robot]:
        """Return the robots of ``names`` that exist."""
        names = list(names)
        self._renew([name for name in names if name in self._elsewhere])
        found = (self._robots.get(name) or self._elsewhere.get(name) for name in names)
        return [robot for robot in found if robot is not None]

    def select(self, names: Iterable[str]) -> RobotSelection:
        """Return a selection of those of ``names`` that exist, in the same order."""
        known = [name for name in names if name in self]
        return RobotSelection(known, self._own_columns.find(known), self._other_columns.find(known))

    def is_outdated(self, selection: RobotSelection) -> bool:
        """Return whether robots were added, removed, or moved to another gateway since ``selection``."""
        layouts = self._own_columns.layout, self._other_columns.layout
        return (selection.own.layout, selection.others.layout) != layouts

    def changed_of(self, selection: RobotSelection, since: int) -> list[str]:
        """Return the names in a selection, which is not outdated, of robots changed after ``since``."""
        own = self._own_columns.changed_places(selection.own, since)
        others = self._other_columns.changed_places(selection.others, since)
        return [selection.names[place] for place in np.sort(np.concatenate([own, others])).tolist()]

    def reported(self, names: Sequence[str]) -> ReportedRows:
        """Return what other gateways reported last of those of ``names`` that they have."""
        return self._other_columns.reported(self._other_columns.find(names))

    def _find(self, name: str) -> Robot | None:
        robot = self._robots.get(name) or self._elsewhere.get(name)
        if robot is not None and robot.gateway is not None and self._other_columns.has_changed(robot):
            self._renew([name])
        return robot

    def _renew(self, names: Sequence[str]) -> list[Robot]:
        """Return robots of other gateways, updated to the last reports of those."""
        robots = [self._elsewhere[name] for name in names]
        self._other_columns.renew(robots, self._details)
        return robots

    def _add(self, robot: Robot) -> None:
        """Add or move a robot to the gateway that it names."""
        self._removed.pop(robot.name, None)
        if robot.gateway is None:
            self._forget_elsewhere(robot.name)
            self._robots[robot.name] = robot
        else:
            self._forget_here(robot.name)
            self._elsewhere[robot.name] = robot
            if robot.pose is not None:
                self._details[robot.name] = robot.pose.battery, robot.pose.status
        self._touch(robot)

    def _forget_here(self, name: str) -> Robot | None:
        self._own_columns.remove(name)
        return self._robots.pop(name, None)

    def _forget_elsewhere(self, name: str) -> Robot | None:
        self._details.pop(name, None)
        self._other_columns.remove(name)
        return self._elsewhere.pop(name, None)

    def _place(self, robot: Robot, pose: SendPos, now: float) -> None:
        """Set the newest pose; it is doubted where its stamp shows that the robot may have moved on."""
        delay = robot.order.delay
        robot.pose, robot.pose_at = pose, now - delay
        robot.doubt = OLD.format(delay) if delay >= self._stale_after else None

    def _judge(self, robot: Robot, now: float) -> RobotState:
        return liveness(
            now - robot.received_at,
            ended_in_order=robot.ended_in_order and not robot.heard_since,
            stale_after=self._stale_after,
            lost_after=self._lost_after,
        )

    def _record_received(self, robot: Robot, link: str, now: float, *, stopped: bool, waited: bool) -> None:
        robot.link, robot.heard_since = link, not stopped
        if not waited:
            if robot.state in AWAY:
                self._events.publish(RobotReturned(robot.name, now - robot.received_at))
            robot.received_at = now
        robot.state = self._judge(robot, now) if waited else RobotState.FRESH

    def _touch(self, robot: Robot) -> None:
        self.revision += 1
        robot.revision = robot.described = self.revision
        (self._own_columns if robot.gateway is None else self._other_columns).write(robot)
