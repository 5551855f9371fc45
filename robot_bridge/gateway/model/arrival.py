"""Arrival and standstill judged from robots' poses, not from their own reports; the remaining path."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.geometry import Polyline
from ...core.messages.commands import CommandReport, CommandState
from ...core.messages.robots import Abort, Command, SendPos, SetPath, SetPosEnd, SetPosIni, path_to_end
from .position_checks import STANDING_SPEED
from .robot_columns import ACCURACY, RobotPlaces, V, X, Y

HEADING_TOLERANCE = 0.15
"""radians; only where the target gives a heading."""
CORRIDOR = 2.0
"""metres a robot may be off its path and still be seen to advance along it."""
LOOK_AHEAD = 5.0
"""metres of path searched ahead of the station reached last, so that a loop is not cut short."""
LOOK_AHEAD_TIME = 2.0
"""seconds of driving added to it: a fast robot is far ahead by its next pose."""
STRIDE = 0.2
"""least metres between poses that are located on a path, the costliest step in processing a pose."""


def standing(pose: SendPos) -> bool:
    """Return whether the robot stands at ``pose``, by its speed."""
    return abs(pose.v) <= STANDING_SPEED


@dataclass
class TargetArrival:
    """Judges SetPosEnd: the robot stands within ``tolerance`` metres of the target."""

    target: SetPosEnd
    tolerance: float

    def deviation(self, pose: SendPos) -> float | None:
        """Return the metres between robot and target once it has arrived, else None."""
        distance = math.hypot(pose.x - self.target.x, pose.y - self.target.y)
        if distance > self.tolerance or not standing(pose):
            return None
        if self.target.theta is not None and _turn(pose.theta, self.target.theta) > HEADING_TOLERANCE:
            return None
        return distance


class PathArrival:
    """Judges SetPath: the robot followed the path and stands within ``tolerance`` metres of its end.

    A path may end where it began, or beside that, so standing at the end counts only after the whole of it
    was driven. ``driven`` is the metres of path that the robot is known to have driven; where that is not
    known (None) it is taken to be as far as it can be. ``handed`` is its last pose before it can have
    begun, and ``under_way`` is true where it may have driven since then without being seen.

    A robot is searched for a few metres ahead of where it was, further where it has left its path and comes
    back to it, and on the whole remaining path where it was out of sight and has moved. Where it may be at
    two stations of its path the earlier one counts: a robot that stands blocked at the beginning of a loop
    has not come to its end. Whether it has, it reports itself: see :meth:`idle_deviation`.
    """

    def __init__(
        self,
        path: SetPath,
        tolerance: float,
        *,
        driven: float | None = 0.0,
        under_way: bool = False,
        handed: SendPos | None = None,
    ) -> None:
        self.line = Polyline(path.points)
        self._tolerance = tolerance
        self._theta = path.theta
        self._anywhere = driven is None
        self._last = handed
        self._on_path: SendPos | None = None
        self.driven = driven or 0.0
        self._unseen_from = self.driven if under_way else None
        self._is_lost = under_way
        self._rests = False

    def deviation(self, pose: SendPos) -> float | None:
        """Return the metres between robot and end of path once it has arrived, else None."""
        end_x, end_y = self.line.end
        distance = math.hypot(pose.x - end_x, pose.y - end_y)
        stands_there = distance <= self._tolerance and standing(pose)
        if stands_there or self._moved(pose):
            self._follow(pose)
        self._rests &= stands_there
        if self._rests and self._is_unsure:
            self.driven = self.line.length
        if not stands_there or self.driven < self.line.length - self._tolerance:
            return None
        turned = self._theta is not None and _turn(pose.theta, self._theta) > HEADING_TOLERANCE
        return None if turned else distance

    def lose_sight(self) -> None:
        """Allow for the robot having driven since its last pose without being seen."""
        self._unseen_from = self.driven
        self._is_lost = True

    def idle_deviation(self, pose: SendPos | None) -> float | None:
        """Apply the robot's report that it is idle, at ``pose`` as far as known; return as :meth:`deviation`.

        Its report decides where its poses cannot: when it was out of sight and stands at the end of a path
        that passes there more than once.
        """
        self._rests = True
        return None if pose is None or self._on_path is None else self.deviation(pose)

    @property
    def _is_unsure(self) -> bool:
        """Whether the robot was out of sight, and has not been followed for long since."""
        return self._unseen_from is not None and self.driven <= self._unseen_from + LOOK_AHEAD

    def _moved(self, pose: SendPos) -> bool:
        """Return whether the robot is far enough from the pose located last to be located again."""
        last = self._last
        return last is None or _apart(pose, last) >= STRIDE

    def _follow(self, pose: SendPos) -> None:
        station, off = self.line.feet(pose.x, pose.y)
        on_line = off <= CORRIDOR
        left = on_line & (station >= self.driven - self._tolerance)
        near = on_line & (station > self.driven) & (station <= self.driven + self._reach(pose))
        if left.any() and self._is_elsewhere(pose, station[left]):
            self.driven = max(self.driven, self._found(station[left], off[left], self._tolerance))
        elif near.any():
            followed = self._on_path is self._last
            self.driven = self._found(station[near], off[near], 0.0 if followed else self._tolerance)
        if near.any() or (on_line & (station <= self.driven)).any():
            self._on_path = pose
        self._last, self._anywhere, self._is_lost = pose, False, False

    def _is_elsewhere(self, pose: SendPos, station: NDArray[Any]) -> bool:
        """Return whether the robot came unseen to one of ``station`` rather than to where it was expected."""
        if self._anywhere:
            return True
        return self._was_missed(pose) and not (station <= self.driven + LOOK_AHEAD).any()

    def _was_missed(self, pose: SendPos) -> bool:
        """Return whether the robot has driven unseen; one that had not started may stand where it stood."""
        last = self._last
        if self._is_lost and (last is None or self.driven > LOOK_AHEAD):
            return True
        if last is None:
            return False
        return _apart(pose, last) > LOOK_AHEAD + LOOK_AHEAD_TIME * max(abs(pose.v), abs(last.v))

    def _found(self, station: NDArray[Any], off: NDArray[Any], slack: float) -> float:
        """Return the station of least ``off``, within ``slack`` metres, and the first of those."""
        best = station[off <= off.min() + slack]
        return float(best.max() if self._anywhere else best.min())

    def _reach(self, pose: SendPos) -> float:
        """Return the metres of path by which the robot may be ahead of its last station."""
        last = self._last or pose
        driving = LOOK_AHEAD_TIME * max(abs(pose.v), abs(last.v))
        # Around a corner the path is longer than the straight line.
        away = 0.0 if self._on_path is None else 2 * _apart(pose, self._on_path)
        return LOOK_AHEAD + max(driving, away)


@dataclass
class BeginArrival:
    """Judges SetPosIni: the robot reports that it is there, standing or not."""

    begin: SetPosIni
    tolerance: float

    def deviation(self, pose: SendPos) -> float | None:
        """Return the metres between robot and ``begin`` once its pose is that, else None."""
        distance = math.hypot(pose.x - self.begin.x, pose.y - self.begin.y)
        turned = self.begin.theta is not None and _turn(pose.theta, self.begin.theta) > HEADING_TOLERANCE
        return None if turned or distance > self.tolerance else distance


class AbortArrival:
    """Judges Abort: the robot stands."""

    def deviation(self, pose: SendPos) -> float | None:
        """Return 0.0 once the robot stands, else None."""
        return 0.0 if standing(pose) else None


Arrival = TargetArrival | PathArrival | BeginArrival | AbortArrival


def arrival_judge(
    command: Command,
    tolerance: float,
    *,
    driven: float | None = 0.0,
    under_way: bool = False,
    handed: SendPos | None = None,
) -> Arrival:
    """Return the arrival judge of a command; ``tolerance`` is metres, ``under_way`` if it may be driving.

    ``driven`` is the metres of a path that the robot is known to have driven, None if not known; ``handed``
    is its pose when the command was sent to it.
    """
    if isinstance(command, SetPosEnd):
        return TargetArrival(command, tolerance)
    if isinstance(command, SetPath):
        return PathArrival(command, tolerance, driven=driven, under_way=under_way, handed=handed)
    if isinstance(command, SetPosIni):
        return BeginArrival(command, tolerance)
    return AbortArrival()


def _apart(a: SendPos, b: SendPos) -> float:
    return math.hypot(a.x - b.x, a.y - b.y)


def _turn(a: float, b: float) -> float:
    return abs(math.remainder(a - b, math.tau))


# --- Answers of the robots to an emergency stop; no I/O ---

MOST_NAMES = 50


class StopAnswer(IntEnum):
    """Progress of a robot in an emergency stop, in ascending order."""

    NONE = 0
    REFUSED = 1
    ACKNOWLEDGED = 2
    STANDING = 3


_BY_STATE = {
    CommandState.FAILED: StopAnswer.REFUSED,
    CommandState.ACKNOWLEDGED: StopAnswer.ACKNOWLEDGED,
    CommandState.REACHED: StopAnswer.STANDING,
}


STILL_WITHIN, STILL_AT_MOST = 0.3, 1.0
"""metres by which positions of a robot that stands may differ, in x and y together: three standard deviations
where it says how accurate they are, within these."""
STILL_FOR = 5.0
"""seconds until a robot that has moved further than that, and reports no speed, counts as standing again."""


class _Answer:
    """Answer of one robot, and its motion since by its positions."""

    __slots__ = ("answer", "heard", "is_reported", "moved_at", "moves", "place")

    def __init__(self, answer: StopAnswer = StopAnswer.NONE) -> None:
        self.answer = answer
        self.heard = False
        """whether it is FRESH, and has reported a believed position since its Ready."""
        self.moves = False
        self.moved_at = -math.inf
        self.place: tuple[float, float] | None = None
        """position where it stood first since it reported no speed."""
        self.is_reported = False

    def observe(self, now: float, x: float, y: float, within: float, drives: bool) -> bool:
        """Apply its present position; return whether it begins, or ends, to move."""
        before = self.moves
        if drives:
            self.place = None
        elif self.place is None:
            self.place = x, y
        elif abs(x - self.place[0]) + abs(y - self.place[1]) > within:
            self.place, self.moved_at = (x, y), now
        self.moves = drives or now - self.moved_at < STILL_FOR
        return self.moves is not before

    def rests_at(self, x: float, y: float, within: float, drives: bool) -> bool:
        """Return whether it still stands there: nearly always, once robots were stopped."""
        place = self.place
        return (
            place is not None
            and not (drives or self.moves)
            and abs(x - place[0]) + abs(y - place[1]) <= within
        )

    @property
    def stands(self) -> bool:
        """Whether it was seen to stand after its answer, and nothing has contradicted that since."""
        return self.answer is StopAnswer.STANDING and self.heard and not self.moves


class StopAnswers:
    """The answer of each robot. Methods that apply an answer return whether it changed anything.

    Answers are compared with positions: a robot that moves does not stand, whatever it answered, and the
    state of one that is not received is unknown.
    """

    def __init__(self) -> None:
        self._answers: dict[str, _Answer] = {}

    def begin(self, robots: Iterable[str]) -> None:
        """Start from scratch, with no answer of these robots yet."""
        self._answers = {robot: _Answer() for robot in robots}

    def note_sent(self, robot: str) -> None:
        """Reset the answer of one robot: it is new, or restarted."""
        self._answers[robot] = _Answer()

    def forget(self, robot: str) -> bool:
        """Remove a robot; return whether it was counted."""
        return self._answers.pop(robot, None) is not None

    def answer(self, robot: str, *, refused: bool) -> bool:
        """Apply the answer of a robot to the direct call."""
        return self._raise(robot, StopAnswer.REFUSED if refused else StopAnswer.ACKNOWLEDGED)

    def note_step(self, report: CommandReport) -> bool:
        """Apply the state of a command, if it is the Abort of an emergency stop."""
        if report.op != Abort.__name__ or not report.params.get("emergency"):
            return False
        return self._raise(report.robot, _BY_STATE.get(report.state, StopAnswer.NONE))

    def observe(self, robots: RobotPlaces, now: float) -> bool:
        """Apply the positions of robots that changed, at ``now`` of the steady clock."""
        drives = np.abs(robots.table[V]) > STANDING_SPEED
        within = np.fmin(STILL_AT_MOST, np.fmax(STILL_WITHIN, 3 * robots.table[ACCURACY]))
        columns = robots.table[X], robots.table[Y], within, drives, robots.are_placed()
        changed = False
        for name, *place, is_heard in zip(robots.names, *(one.tolist() for one in columns), strict=True):
            known = self._answers.get(name)
            if known is None or (is_heard and known.heard and known.rests_at(*place)):
                continue
            changed |= known.heard is not is_heard
            known.heard = is_heard
            if is_heard:
                changed |= known.observe(now, *place)
        return changed

    def disobeying(self) -> list[str]:
        """Return the robots that were seen to stand and now move, each of them once."""
        found = [
            (robot, one)
            for robot, one in self._answers.items()
            if one.moves and one.answer is StopAnswer.STANDING and not one.is_reported
        ]
        for _, one in found:
            one.is_reported = True
        return sorted(robot for robot, _ in found)

    def counts(self) -> dict[str, Any]:
        """Return the fields of an EmergencyReport that concern robots, by name."""
        acknowledged, standing = 0, 0
        moving, unheard = [], []
        for robot, one in self._answers.items():
            if one.moves and one.heard:
                moving.append(robot)
            if one.answer >= StopAnswer.ACKNOWLEDGED:
                acknowledged += 1
                standing += one.stands
                if not one.heard:
                    unheard.append(robot)
        moving.sort()
        unheard.sort()
        return {
            "robots": len(self._answers),
            "acknowledged": acknowledged,
            "standing": standing,
            "waiting": self._names(StopAnswer.NONE),
            "refused": self._names(StopAnswer.REFUSED),
            "moving": moving[:MOST_NAMES],
            "moving_more": max(0, len(moving) - MOST_NAMES),
            "unheard": unheard[:MOST_NAMES],
            "unheard_more": max(0, len(unheard) - MOST_NAMES),
        }

    def _names(self, kind: StopAnswer) -> list[str]:
        return sorted(robot for robot, one in self._answers.items() if one.answer is kind)[:MOST_NAMES]

    def _raise(self, robot: str, answer: StopAnswer) -> bool:
        known = self._answers.setdefault(robot, _Answer())
        if answer <= known.answer:
            return False
        known.answer = answer
        return True


# --- Remaining path: from the position of a robot to the end of its task ---

Floats = NDArray[np.float64]
Point = tuple[float, float]
"""x, y in metres, site frame."""

_SAME = 1e-6
"""metres below which two points are one."""
_LOOK_AHEAD = 5.0
"""metres of a drawn path ahead on which a robot may join it again, so that a loop is not cut short."""


class PlannedPath(NamedTuple):
    """A path from start to goal, at least two points; ``note`` describes where it is unexpected.

    ``along_roads`` is false of a straight line.
    """

    points: Sequence[Point]
    note: str = ""
    along_roads: bool = False


class Planner(Protocol):
    """Plans paths. They begin at ``start`` and end at ``goal``."""

    @property
    def has_roads(self) -> bool:
        """Whether there are any roads that paths may lead along."""

    def path(self, start: Point, goal: Point) -> PlannedPath:
        """Return a path; raises RefusedError when there is none."""


class StraightPlanner:
    """Planner without roads: every path is one straight line."""

    has_roads = False

    def path(self, start: Point, goal: Point) -> PlannedPath:
        """Return ``start`` and ``goal``."""
        return PlannedPath([start, goal])


class RemainingPath(NamedTuple):
    """The remaining path of a task, and the planner's note about it."""

    message: SetPath
    note: str = ""


def remaining_path(task: SetPosEnd | SetPath, start: Point, driven: float, planner: Planner) -> RemainingPath:
    """Return the path from ``start`` to the end of ``task``.

    Of a drawn path it is the part ahead of the first ``driven`` metres. Raises RefusedError when the planner
    finds no path.
    """
    if isinstance(task, SetPosEnd):
        planned = planner.path(start, (task.x, task.y))
        return RemainingPath(path_to_end(task, list(planned.points)), planned.note)
    left = remaining_line(Polyline(task.points), start, driven)
    return RemainingPath(path_to_end(task, [(x, y) for x, y in left.tolist()]))


def remaining_line(line: Polyline, start: Point, driven: float) -> Floats:
    """Return ``line`` ahead of its first ``driven`` metres, beginning at ``start``: (n, 2), n > 1."""
    here = _joins(line, start, driven)
    corners = line.beyond(here + _SAME)
    return _without_repetition(np.vstack([start, line.at(here), corners if len(corners) else line.end]))


def _joins(line: Polyline, start: Point, driven: float) -> float:
    """Return the station nearest to ``start`` of those just ahead of ``driven`` metres."""
    station, off = line.feet(*start)
    near = (station >= driven) & (station <= driven + _LOOK_AHEAD)
    joint = line.at(driven)
    stations = [min(driven, line.length), *station[near]]
    distances = [math.hypot(joint[0] - start[0], joint[1] - start[1]), *off[near]]
    return float(stations[int(np.argmin(distances))])


def _without_repetition(points: Floats) -> Floats:
    """Return ``points`` without repetitions of the one kept before; at least two are kept."""
    kept, checked = np.ones(len(points), dtype=bool), 0
    near = np.abs(np.diff(points, axis=0)) <= _SAME
    for number in np.flatnonzero(near[:, 0] & near[:, 1]).tolist():
        if number < checked:
            continue
        checked = number + 1
        while checked < len(points) and np.abs(points[checked] - points[number]).max() <= _SAME:
            kept[checked] = False
            checked += 1
    return points[kept] if kept.sum() > 1 else points[[0, -1]]
