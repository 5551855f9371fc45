"""The ways that robots are on now, as far as the gateway knows them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..commanding.book import CommandBook
from ..messages import SetPath, SetPosEnd
from ..planning import Floats, Point, line_left
from ..polyline import Polyline
from ..robots import Robots


class Way(NamedTuple):
    """What is left of a robot's task: ``points`` from where it is to its goal.

    ``known`` is false where the robot has a target and finds the way itself: the points are a straight line.
    ``command`` is the task's, NOTHING where the robot only stands where it is to go on from.
    """

    robot: str
    command: str
    task: SetPosEnd | SetPath
    points: list[Point]
    known: bool


@dataclass(frozen=True)
class ToldWay:
    """The way to a target that a robot was told."""

    path: SetPath

    @cached_property
    def line(self) -> Polyline:
        """The way as a line, made once: of kilometres that takes longer than all that is asked of it."""
        return Polyline(self.path.points)


class Underway(NamedTuple):
    """A robot's task, where it is, the metres it has driven of a path, and the way that it was told last.

    ``line`` is the task's path once the robot has taken that on.
    """

    robot: str
    command: str
    task: SetPosEnd | SetPath
    place: Point
    driven: float
    told: ToldWay | None
    line: Polyline | None = None

    @property
    def known(self) -> bool:
        """Whether the gateway knows the way; else the robot finds it itself."""
        return isinstance(self.task, SetPath) or self.told is not None

    def way(self) -> Way:
        """Return what is left; takes as long as the path has points, and may be called in any thread."""
        points = [(x, y) for x, y in self.points().tolist()]
        return Way(self.robot, self.command, self.task, points, self.known)

    def points(self) -> Floats:
        """Return the points of what is left, (n, 2), as quickly as can be."""
        if isinstance(self.task, SetPath):
            return line_left(self.line or Polyline(self.task.points), self.place, self.driven)
        if self.told is not None:
            # Nothing counts the metres of it that are driven, so that the robot is looked for on all of it.
            station, off = self.told.line.feet(*self.place)
            return line_left(self.told.line, self.place, float(station[int(off.argmin())]))
        return np.array([self.place, (self.task.x, self.task.y)])


class Ways:
    """Remembers what GetPath was answered with, and knows what was commanded."""

    def __init__(self, robots: Robots, book: CommandBook) -> None:
        self._robots = robots
        self._book = book
        self._told: dict[str, tuple[SetPosEnd, ToldWay]] = {}

    def is_placed(self, robot: str) -> bool:
        """Tell whether it is known where a robot is now, so that its way can be changed from there."""
        return self._robots.is_placed(robot)

    def told(self, robot: str, task: SetPosEnd | SetPath, way: SetPath) -> None:
        """Note the way to ``task`` that a robot was told."""
        if isinstance(task, SetPosEnd):
            self._told[robot] = task, ToldWay(way)

    def of(self, robot: str) -> Underway | None:
        """Return what a robot is doing, None for one that has no task or has not said where it is."""
        given, command = self._book.task(robot), self._book.busy_with(robot)
        pose = self._robots.get(robot).pose if robot in self._robots else None
        if given is None or command is None or pose is None:
            return None
        task, driven = given
        told = self._told.get(robot)
        known_way = told[1] if told is not None and told[0] == task else None
        line = self._book.line(robot)
        return Underway(robot, command, task, (pose.x, pose.y), driven, known_way, line)

    def names(self) -> list[str]:
        """Return the names of all robots."""
        return self._robots.names()

    def all(self) -> list[Underway]:
        """Return what all robots are doing that have a task."""
        underway = (self.of(robot) for robot in self._robots.names())
        return [one for one in underway if one is not None]
