"""Present paths of robots, and the snapshot of all their movements."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.geometry import Polyline
from ...core.messages.commands import CommandReport
from ...core.messages.roads import ConflictReport, HoldReport
from ...core.messages.robots import SetPath, SetPosEnd
from ...core.sites.settings_tables import RouteSettings
from ...protocol.codec import decode_command
from ..commands.service import CommandService
from ..model.arrival import Floats, Point, remaining_line
from ..model.robots import Robots
from ..storage.repositories.closures import HoldRow
from .conflicts import Conflict, Movement, driving_movement, standing_movement

# --- Present paths of robots, as far as the gateway knows them ---


class RobotPath(NamedTuple):
    """The rest of a robot's task: ``points`` from its position to its goal.

    ``known`` is false where the robot has a target and plans its path itself: the points are a straight line.
    ``command`` is the task's, NOTHING where the robot only stands and waits to continue from there.
    """

    robot: str
    command: str
    task: SetPosEnd | SetPath
    points: list[Point]
    known: bool


@dataclass(frozen=True)
class ReportedPath:
    """The path to a target that was sent to a robot."""

    path: SetPath

    @cached_property
    def line(self) -> Polyline:
        """The path as a line, made once: for kilometres that takes longer than all its queries."""
        return Polyline(self.path.points)


class DrivenTask(NamedTuple):
    """A robot's task, its position, the metres it has driven of a path, and the path that it was sent last.

    ``line`` is the task's path once the robot has acknowledged it.
    """

    robot: str
    command: str
    task: SetPosEnd | SetPath
    place: Point
    driven: float
    reported: ReportedPath | None
    line: Polyline | None = None

    @property
    def known(self) -> bool:
        """Whether the gateway knows the path; else the robot plans it itself."""
        return isinstance(self.task, SetPath) or self.reported is not None

    def way(self) -> RobotPath:
        """Return the rest; takes time in proportion to the path's points, and may be called in any thread."""
        points = [(x, y) for x, y in self.points().tolist()]
        return RobotPath(self.robot, self.command, self.task, points, self.known)

    def points(self) -> Floats:
        """Return the points of the rest, (n, 2), in the fastest form."""
        if isinstance(self.task, SetPath):
            return remaining_line(self.line or Polyline(self.task.points), self.place, self.driven)
        if self.reported is not None:
            # The driven metres of it are not counted, so the robot is searched for on all of it.
            station, off = self.reported.line.feet(*self.place)
            return remaining_line(self.reported.line, self.place, float(station[int(off.argmin())]))
        return np.array([self.place, (self.task.x, self.task.y)])


class TaskElsewhere(NamedTuple):
    """Task of a robot of another gateway: to ``end``, along a ``way`` where it was sent one."""

    command: str
    end: SetPosEnd
    way: ReportedPath | None


class RobotPaths:
    """Keeps the answers to GetPath, and combines them with the robots' commands."""

    def __init__(self, robots: Robots, commands: CommandService) -> None:
        self._robots = robots
        self._commands = commands
        self._reported: dict[str, tuple[SetPosEnd, ReportedPath]] = {}
        self._elsewhere: dict[str, TaskElsewhere] = {}

    def is_placed(self, robot: str) -> bool:
        """Return whether a robot's present position is known, so that its path can be changed from there."""
        return self._robots.is_placed(robot)

    def note_reported(self, robot: str, task: SetPosEnd | SetPath, way: SetPath) -> None:
        """Record the path to ``task`` that was sent to a robot."""
        if isinstance(task, SetPosEnd):
            self._reported[robot] = task, ReportedPath(way)

    def note_elsewhere(self, report: CommandReport) -> None:
        """Record the state of a command of a robot of another gateway."""
        known = self._elsewhere.get(report.robot)
        if not report.state.is_open:
            if known is not None and known.command == report.command:
                del self._elsewhere[report.robot]
            return
        if known is not None and known.command == report.command:
            return
        message = decode_command(report.op, report.params)
        if isinstance(message, SetPosEnd):
            self._elsewhere[report.robot] = TaskElsewhere(report.command, message, None)
        elif isinstance(message, SetPath):
            end = SetPosEnd(*message.points[-1], message.theta)
            self._elsewhere[report.robot] = TaskElsewhere(report.command, end, ReportedPath(message))

    def of(self, robot: str) -> DrivenTask | None:
        """Return the task of a robot, None without a task or a reported position."""
        if self._robots.gateway_of(robot) is not None:
            return self._of_elsewhere(robot)
        given, command = self._commands.task(robot), self._commands.busy_with(robot)
        pose = self._robots.get(robot).pose if robot in self._robots else None
        if given is None or command is None or pose is None:
            return None
        task, driven = given
        reported = self._reported.get(robot)
        known_way = reported[1] if reported is not None and reported[0] == task else None
        line = self._commands.line(robot)
        return DrivenTask(robot, command, task, (pose.x, pose.y), driven, known_way, line)

    def names(self) -> list[str]:
        """Return the names of all robots."""
        return self._robots.names()

    def own(self) -> list[DrivenTask]:
        """Return the tasks of the robots of this gateway."""
        underway = (self.of(robot) for robot in self._commands.robots())
        return sorted((one for one in underway if one is not None), key=lambda one: one.robot)

    def all(self) -> list[DrivenTask]:
        """Return the tasks of all robots, including those of other gateways."""
        elsewhere = (self.of(robot) for robot in self._elsewhere if self._robots.gateway_of(robot))
        found = [*self.own(), *(one for one in elsewhere if one is not None)]
        return sorted(found, key=lambda one: one.robot)

    def _of_elsewhere(self, robot: str) -> DrivenTask | None:
        task, pose = self._elsewhere.get(robot), self._robots.pose(robot)
        if task is None or pose is None or self._robots.get(robot).command != task.command:
            return None
        return DrivenTask(robot, task.command, task.end, (pose.x, pose.y), 0.0, task.way)


# --- Movements of all robots at one moment, for the detection of conflicts; no I/O ---


class TrafficSnapshot(NamedTuple):
    """Data for movements: ``places`` has the position and the speed of each robot.

    Those in ``placed`` are there now; the others were there, and may have driven on unseen.
    """

    now: float
    settings: RouteSettings
    underway: list[DrivenTask]
    places: dict[str, tuple[Point, float]]
    holds: dict[str, HoldRow]
    placed: frozenset[str]

    @property
    def on_the_way(self) -> set[str]:
        """The robots that have a task or wait during one: the motion of others is unknown."""
        return {one.robot for one in self.underway} | set(self.holds)

    def movements(self) -> dict[str, Movement]:
        """Return the planned movement of every robot that has reported its position."""
        ways = {one.robot: one.points() for one in self.underway}
        return {name: self._movement(name, ways.get(name)) for name in self.places}

    def _movement(self, robot: str, way: Floats | None) -> Movement:
        place, speed = self.places[robot]
        radius = self.settings.radius_m
        hold = self.holds.get(robot)
        if hold is None:
            if way is None:
                return standing_movement(robot, place, self.now, radius)
            return driving_movement(robot, way, speed, self.now, radius)
        to_hold = np.array([place]) if way is None else way
        rest = np.array(SetPath(**hold.rest).points)
        joined = np.concatenate([to_hold, rest])
        moving = driving_movement(robot, joined, speed, self.now, radius)
        there = float(np.hypot(*np.diff(joined[: len(to_hold) + 1], axis=0).T).sum())
        return moving.waiting(there, max(hold.until - moving.time_at(there), 0.0))


def split_path(points: list[Point], station: float) -> tuple[list[Point], list[Point]]:
    """Return a path up to ``station`` metres along it, and the rest of it."""
    line = np.asarray(points, dtype=np.float64)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    x, y = (round(float(np.interp(station, along, line[:, k])), 3) for k in (0, 1))
    before = [point for point, at in zip(points, along.tolist(), strict=True) if at < station - 1e-3]
    after = [point for point, at in zip(points, along.tolist(), strict=True) if at > station + 1e-3]
    return [*before, (x, y)], [(x, y), *after]


def conflict_report(conflict: Conflict, clearance: float) -> ConflictReport:
    """Return the report of a conflict; ``clearance`` is the metres between the centres of two robots."""
    return ConflictReport(
        robot=conflict.robot,
        other=conflict.other,
        kind=conflict.kind,  # type: ignore[arg-type]
        begins=round(conflict.begins, 1),
        ends=None if math.isinf(conflict.ends) else round(conflict.ends, 1),
        nearest_at=round(conflict.nearest_at, 1),
        metres=round(conflict.metres, 2),
        x=round(conflict.place[0], 2),
        y=round(conflict.place[1], 2),
        clearance=round(clearance, 2),
    )


def hold_report(row: HoldRow) -> HoldReport:
    """Return the report of a robot that waits."""
    x, y = SetPath(**row.rest).points[0]
    return HoldReport(row.robot, row.other, x, y, round(row.until, 1), row.by, row.command)
