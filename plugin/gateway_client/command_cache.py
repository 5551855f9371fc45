"""Commands: decoding, cache of the last reports, texts, and distances of robots from their paths."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages.commands import CommandReport, CommandState, command_report
from ...robot_bridge.core.messages.robots import Abort, SetPath, SetPosEnd
from ..ui.language import tr
from .state_words import COMMAND_STATES

MOST_COMMANDS = 2000
MOST_CONES = 2000
DRIVE_OPERATIONS = (SetPosEnd.__name__, SetPath.__name__)
"""Operations that lead a robot to a place; the others are carried out where it stands."""


class PathPoints(Sequence[tuple[float, float]]):
    """Immutable points, x and y in metres in the site frame; numpy reads them as an (n, 2) array."""

    __slots__ = ("_points",)

    def __init__(self, points: npt.NDArray[np.float64]) -> None:
        self._points = points

    def __len__(self) -> int:
        return len(self._points)

    def __iter__(self) -> Iterator[tuple[float, float]]:
        return map(tuple, self._points.tolist())

    def __getitem__(self, which: int | slice) -> Any:
        if isinstance(which, slice):
            return list(map(tuple, self._points[which].tolist()))
        return tuple(self._points[which].tolist())

    def __eq__(self, other: object) -> bool:
        if isinstance(other, PathPoints):
            return np.array_equal(self._points, other._points)
        return NotImplemented

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self._points, dtype=dtype)


def pack_points(points: object) -> object:
    """Return a path's points as :class:`PathPoints`; anything but a list of pairs of numbers unchanged."""
    if not isinstance(points, list):
        return points
    try:
        numbers = np.array(points, dtype=np.float64)
    except (TypeError, ValueError):
        return points
    if numbers.ndim != 2 or numbers.shape[1] != 2 or not np.isfinite(numbers).all():
        return points
    return PathPoints(numbers)


def command_in(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON.

    A path along roads has hundreds of points, which would take 90 kB as lists.
    """
    report = command_report(values)
    if report.op != SetPath.__name__ or "points" not in report.params:
        return report
    return dataclasses.replace(
        report, params={**report.params, "points": pack_points(report.params["points"])}
    )


def commands_in(result: dict[str, Any]) -> list[CommandReport]:
    """Return the reports in an answer, oldest first; get_commands answers with the newest first."""
    if "commands" in result:
        return [command_in(values) for values in reversed(result["commands"])]
    return [command_in(result)] if "command" in result and "op" in result else []


class CommandCache:
    """Commands by id. In whatever order they arrive, a robot's newest is the one requested last."""

    def __init__(self) -> None:
        self._reports: dict[str, CommandReport] = {}
        self._under_way: dict[str, CommandReport] = {}
        self._reached: dict[str, CommandReport] = {}
        self._cones: dict[str, CommandReport] = {}
        """Commands that put down a cone, also those that are too old for the others."""

    def __len__(self) -> int:
        return len(self._reports)

    def __contains__(self, command: str) -> bool:
        return command in self._reports

    def __iter__(self) -> Iterator[CommandReport]:
        return iter(self._reports.values())

    def merge(self, reports: Iterable[CommandReport]) -> list[CommandReport]:
        """Apply reports and return those with new information.

        A report with fewer steps than the known one was overtaken on its way and is ignored.
        """
        changed = []
        late = False
        newest = requested_at(next(reversed(self._reports.values()))) if self._reports else 0.0
        for report in reports:
            known = self._reports.get(report.command)
            if known is not None and (len(report.steps) < len(known.steps) or report == known):
                continue
            if known is None:
                late, newest = late or requested_at(report) < newest, max(newest, requested_at(report))
            self._reports[report.command] = report
            changed.append(report)
            if is_cone_put_down(report):
                self._cones[report.command] = report
        if not changed:
            return []
        if late:
            # Commands requested before this desk connected arrive after those requested since.
            self._reports = dict(sorted(self._reports.items(), key=lambda item: requested_at(item[1])))
        for command in list(self._cones)[:-MOST_CONES]:
            del self._cones[command]
        self._forget_oldest()
        self._find_newest()
        return [report for report in changed if report.command in self._reports]

    def clear(self) -> None:
        """Forget every command."""
        self._reports.clear()
        self._under_way.clear()
        self._reached.clear()
        self._cones.clear()

    def get(self, command: str) -> CommandReport | None:
        """Return a command, None if it is not known."""
        return self._reports.get(command)

    def under_way(self) -> list[CommandReport]:
        """Return the commands under way: of each robot the newest target or path that is not finished."""
        return list(self._under_way.values())

    def task_of(self, robot: str) -> CommandReport | None:
        """Return the current command of ``robot``, None if none is known."""
        return self._under_way.get(robot)

    def reached_by(self, robot: str) -> CommandReport | None:
        """Return the target or path that ``robot`` reached last, None if none is known."""
        return self._reached.get(robot)

    def cones_put_down(self) -> Iterable[CommandReport]:
        """Return the commands that put down a cone, of very many the newest, as they were reached."""
        return self._cones.values()

    def of(self, robot: str, most: int) -> list[CommandReport]:
        """Return the newest commands of a robot, newest first."""
        found = [report for report in reversed(self._reports.values()) if report.robot == robot]
        return found[:most]

    def _forget_oldest(self) -> None:
        too_many = len(self._reports) - MOST_COMMANDS
        if too_many <= 0:
            return
        ended = [key for key, report in self._reports.items() if not report.state.is_open]
        for command in ended[:too_many]:
            del self._reports[command]
        for command in list(self._reports)[: max(0, len(self._reports) - 2 * MOST_COMMANDS)]:
            del self._reports[command]

    def _find_newest(self) -> None:
        self._under_way.clear()
        self._reached.clear()
        for report in self._reports.values():
            if report.op != Abort.__name__:
                if report.state.is_open:
                    self._under_way[report.robot] = report
                elif report.state is CommandState.REACHED:
                    self._reached[report.robot] = report


def requested_at(report: CommandReport) -> float:
    """Return when a command was requested, seconds since 1970; 0 where that is not reported."""
    return report.steps[0].at if report.steps else 0.0


def command_in_words(report: CommandReport) -> str:
    """Return the purpose of a command, as in ``cone at 12.30, 40.00``."""
    if report.op == SetPosEnd.__name__:
        x, y = _metres(report.params.get("x")), _metres(report.params.get("y"))
        if report.params.get("cone"):
            return tr("cone at {x}, {y}", x=x, y=y)
        return tr("target at {x}, {y}", x=x, y=y)
    if report.op == SetPath.__name__ and report.params.get("cone") and (place := place_of(report)):
        return tr("cone at {x}, {y}", x=_metres(place[0]), y=_metres(place[1]))
    if report.op == SetPath.__name__:
        return tr("route of {number} points", number=len(report.params.get("points", [])))
    return {Abort.__name__: tr("abort")}.get(report.op, report.op)


def state_word(op: str, state: CommandState) -> str:
    """Return a word for a state of a command: an abort leads nowhere, it is done where others are reached."""
    if state is CommandState.REACHED and op not in DRIVE_OPERATIONS:
        return tr("done")
    return COMMAND_STATES[state]


def command_state_in_words(report: CommandReport) -> str:
    """Return the progress of a command, with the reason if reported, as in ``failed: battery empty``."""
    word = state_word(report.op, report.state)
    if word == tr("done"):
        return word
    reason = report.steps[-1].reason if report.steps else None
    return word + (f": {reason}" if reason else "")


def place_of(report: CommandReport) -> tuple[float, float] | None:
    """Return the goal of a command, metres in the site frame; None for one that leads nowhere."""
    if report.op == SetPath.__name__:
        points = report.params.get("points") or [(None, None)]
        x, y = points[-1][:2]
    else:
        x, y = report.params.get("x"), report.params.get("y")
    if isinstance(x, (int, float)) and isinstance(y, (int, float)):
        return float(x), float(y)
    return None


def is_cone_put_down(report: CommandReport) -> bool:
    """Return whether a robot reached a target, straight or along a path, to put down a cone."""
    is_cone = report.op in DRIVE_OPERATIONS and report.params.get("cone") is True
    return is_cone and report.state is CommandState.REACHED


def _metres(value: object) -> str:
    return f"{value:.2f}" if isinstance(value, (int, float)) else "?"


ON_PATH_M = 1.0
"""Distance in metres within which a robot has come to its path."""
AWAY_M = 1.0
"""Metres by which a robot must move away from a path's first point to have passed it."""


@dataclass
class PathApproach:
    """The approach of a robot to its path: ``nearest`` is the least distance to its first point, metres."""

    nearest: float = math.inf
    is_over: bool = False

    def go_on(self, off: float, to_first: float) -> None:
        """Apply the robot's position: metres beside the path and to its first point.

        A robot that never comes near still passes the first point, when it moves away from it again.
        """
        self.is_over = self.is_over or off <= ON_PATH_M or to_first > self.nearest + AWAY_M
        self.nearest = min(self.nearest, to_first)


Floats = npt.NDArray[np.float64]


class PathDeviations:
    """Remembers of each robot whether it has come to its path: its way there is not prescribed."""

    def __init__(self, commands: CommandCache):
        self._commands = commands
        self._ways: dict[str, tuple[str, PathApproach]] = {}
        """By robot, the command whose path it drives, and its approach to that."""

    def of(self, robot: str, xy: tuple[float, float] | None) -> float | None:
        """Return the distance from the path that ``robot`` drives, else from the target reached last, metres.

        ``xy`` is its position in the site frame. None where it has neither, or is on its way to a target or
        to the first point of its path: that way is not prescribed.
        """
        task = self._commands.task_of(robot)
        if task is None:
            reached = self._commands.reached_by(robot)
            return None if reached is None else reached.deviation
        points = _path_points(task) if task.op == SetPath.__name__ else np.empty((0, 2))
        if xy is None or len(points) == 0:
            return None
        off = distance_to_line(points, np.array(xy))
        command, way = self._ways.get(robot, ("", PathApproach()))
        if command != task.command:
            way = PathApproach()
            self._ways[robot] = task.command, way
        way.go_on(off, math.dist(points[0], xy))
        return off if way.is_over else None

    def forget(self, robots: Iterable[str]) -> None:
        """Forget ``robots``, which were removed."""
        for robot in robots:
            self._ways.pop(robot, None)


def distance_to_line(points: Floats, at: Floats) -> float:
    """Return the distance of (2,) ``at`` from the line through (n, 2) ``points``, n > 0."""
    if len(points) == 1:
        return float(np.hypot(*(points[0] - at)))
    start, step = points[:-1], np.diff(points, axis=0)
    square = np.maximum((step**2).sum(axis=1), 1e-18)
    part = np.clip(((at - start) * step).sum(axis=1) / square, 0.0, 1.0)
    return float(np.hypot(*(start + step * part[:, None] - at).T).min())


def _path_points(task: CommandReport) -> Floats:
    try:
        points = np.array(task.params.get("points", []), dtype=np.float64)
    except (TypeError, ValueError):
        return np.empty((0, 2))
    return points[:, :2] if points.ndim == 2 and points.shape[1] >= 2 else np.empty((0, 2))
