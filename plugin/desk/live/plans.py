"""What robots are about to do: where to, on which way, and how far it still is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import CommandReport, SetPath
from ..way_to_path import ON_PATH_M, WayToPath

Points = npt.NDArray[np.float64]
BACK = 5.0
"""Metres by which a robot may seem to go back on its way: where a way crosses itself, it went on."""


@dataclass(frozen=True, eq=False)
class Plan:
    """One robot's task: (n, 2) ``points`` in metres of the site frame, the last one the target.

    A target without a way has one point. What is reckoned along a way is so when it is first asked for: of
    many plans only those of selected robots are.
    """

    command: str
    robot: str
    points: Points
    cone: bool

    @property
    def is_way(self) -> bool:
        """Whether the robot was told which way to go."""
        return len(self.points) > 1

    @cached_property
    def steps(self) -> Points:
        """The way from each point to the next, (n - 1, 2)."""
        return np.diff(self.points, axis=0)

    @cached_property
    def lengths(self) -> Points:
        """Metres of each step, (n - 1,), more than nothing."""
        return np.maximum(np.hypot(*self.steps.T), 1e-9)

    @cached_property
    def along(self) -> Points:
        """Metres along the way from its first point to each, (n,)."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(*self.steps.T))])


class Plans:
    """Makes the plans of commands once each, and follows the robots along them."""

    def __init__(self) -> None:
        self._tasks: list[CommandReport] = []
        self._plans: list[Plan] = []
        self._known: dict[str, Plan | None] = {}
        self._driven: dict[str, float] = {}
        self._ways: dict[str, WayToPath] = {}
        """How robots come to the first points of their ways."""
        self.is_whole = True
        """Whether every plan that was asked for last is made."""

    def of(self, tasks: Iterable[CommandReport], at_once: int | None = None) -> list[Plan]:
        """Return the plans of ``tasks`` that say a place, in one list for as long as they are the same.

        At most ``at_once`` new ones are made, and the others when it is called again.
        """
        tasks = list(tasks)
        if tasks == self._tasks and self.is_whole:
            return self._plans
        new = [task for task in tasks if task.command not in self._known]
        made = {task.command: _plan(task) for task in new[:at_once]}
        known = {**self._known, **made}
        self._known = {task.command: known[task.command] for task in tasks if task.command in known}
        self._driven = {command: self._driven[command] for command in self._known if command in self._driven}
        self._ways = {command: self._ways[command] for command in self._known if command in self._ways}
        self._tasks, self.is_whole = tasks, len(made) == len(new)
        self._plans = [plan for plan in self._known.values() if plan is not None]
        return self._plans

    def remaining(self, plan: Plan, at: Points) -> float:
        """Return the metres that a robot at (2,) ``at`` still has to go, along its way if it has one.

        Before it has come to its way it goes to the first point of that.
        """
        if not plan.is_way:
            return float(np.hypot(*(plan.points[-1] - at)))
        start, step, length = plan.points[:-1], plan.steps, plan.lengths
        part = np.clip(((at - start) * step).sum(axis=1) / length**2, 0.0, 1.0)
        away = np.hypot(*(start + step * part[:, None] - at).T)
        to_first = float(np.hypot(*(plan.points[0] - at)))
        way = self._ways.setdefault(plan.command, WayToPath())
        way.go_on(float(away.min()), to_first)
        if not way.is_over:
            return to_first + float(plan.along[-1])
        along = plan.along[:-1] + part * length
        driven = self._driven.get(plan.command)
        nearest = _first_near(away) if driven is None else _near_ahead(away, along, driven)
        self._driven[plan.command] = float(along[nearest])
        return float(plan.along[-1] - along[nearest] + away[nearest])


def _first_near(away: Points) -> int:
    """Return the step on which a robot has come to its way, by how far ``away`` it is from each.

    That is the earliest where a way ends as it begins, or crosses itself.
    """
    near = away <= max(ON_PATH_M, float(away.min()))
    begin = int(near.argmax())
    beyond = np.flatnonzero(~near[begin:])
    end = begin + int(beyond[0]) if len(beyond) else len(near)
    return begin + int(away[begin:end].argmin())


def _near_ahead(away: Points, along: Points, driven: float) -> int:
    """Return the step that a robot is on which has ``driven`` so many metres of its way."""
    ahead = along >= driven - BACK
    return int(np.where(ahead, away, np.inf).argmin() if ahead.any() else away.argmin())


def _plan(task: CommandReport) -> Plan | None:
    if task.op == SetPath.__name__:
        given = task.params.get("points", [])
    else:
        given = [[task.params.get("x"), task.params.get("y")]]
    try:
        points = np.array(given, dtype=np.float64).reshape(-1, 2)
    except (TypeError, ValueError):
        return None
    if len(points) == 0 or not np.isfinite(points).all():
        return None
    return Plan(task.command, task.robot, points, bool(task.params.get("cone")))
