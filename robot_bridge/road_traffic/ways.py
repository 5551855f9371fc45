"""The ways that robots are on now, as far as the gateway knows them."""

from __future__ import annotations

from typing import NamedTuple

from ..commanding.book import CommandBook
from ..messages import SetPath, SetPosEnd
from ..planning import Point, StraightPlanner, way_left
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


class Underway(NamedTuple):
    """A robot's task, where it is, the metres it has driven of a path, and the way that it was told last."""

    robot: str
    command: str
    task: SetPosEnd | SetPath
    place: Point
    driven: float
    told: SetPath | None

    def way(self) -> Way:
        """Return what is left; takes as long as the path has points, and may be called in any thread."""
        if isinstance(self.task, SetPath):
            return Way(self.robot, self.command, self.task, _left(self.task, self.place, self.driven), True)
        if self.told is not None:
            # Nothing counts the metres of it that are driven, so that the robot is looked for on all of it.
            foot = _foot(self.told, self.place)
            return Way(self.robot, self.command, self.task, _left(self.told, self.place, foot), True)
        return Way(self.robot, self.command, self.task, [self.place, (self.task.x, self.task.y)], False)


class Ways:
    """Remembers what GetPath was answered with, and knows what was commanded."""

    def __init__(self, robots: Robots, book: CommandBook) -> None:
        self._robots = robots
        self._book = book
        self._told: dict[str, tuple[SetPosEnd, SetPath]] = {}

    def told(self, robot: str, task: SetPosEnd | SetPath, way: SetPath) -> None:
        """Note the way to ``task`` that a robot was told."""
        if isinstance(task, SetPosEnd):
            self._told[robot] = task, way

    def of(self, robot: str) -> Underway | None:
        """Return what a robot is doing, None for one that has no task or has not said where it is."""
        given, command = self._book.task(robot), self._book.busy_with(robot)
        pose = self._robots.get(robot).pose if robot in self._robots else None
        if given is None or command is None or pose is None:
            return None
        task, driven = given
        told = self._told.get(robot)
        path = told[1] if told is not None and told[0] == task else None
        return Underway(robot, command, task, (pose.x, pose.y), driven, path)

    def all(self) -> list[Underway]:
        """Return what all robots are doing that have a task."""
        underway = (self.of(robot) for robot in self._robots.names())
        return [one for one in underway if one is not None]


def _left(path: SetPath, place: Point, driven: float) -> list[Point]:
    return list(way_left(path, place, driven, StraightPlanner()).message.points)


def _foot(path: SetPath, place: Point) -> float:
    station, off = Polyline(path.points).feet(*place)
    return float(station[int(off.argmin())])
