"""Whether a target is clear of those of other robots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import CommandReport, SetPath, SetPosEnd, TaskState
from ...language import tr
from ..close_pairs import pairs_between
from ..command_book import CommandBook
from ..drafts import START, TARGETS, Draft, Findings
from ..queue_book import QueueBook

CLEAR_M = 1.0
"""Metres between the targets of two robots."""


class Target(NamedTuple):
    """Where a robot is to go, metres in the site frame, and ``what`` that is in words."""

    robot: str
    what: str
    x: float
    y: float


class TargetCheck:
    """Knows the targets of all robots, now and in their queues; reads anew only those of robots with news."""

    def __init__(self, book: CommandBook, queues: QueueBook):
        self._book = book
        self._queues = queues
        self._of: dict[str, list[Target]] = {}
        self._with_news: set[str] = set()
        self._targets: list[Target] = []
        self._places: npt.NDArray[np.float64] = np.empty((0, 2))

    def take(self, robots: Iterable[str]) -> None:
        """Take in that something new is known of what these robots have to do."""
        self._with_news.update(robots)

    def clear(self) -> None:
        """Forget every robot."""
        self._of.clear()
        self._with_news.clear()
        self._targets, self._places = [], np.empty((0, 2))

    def look(self, draft: Draft) -> Findings:
        """Find the targets of other robots that a draft ends too near to."""
        if draft.kind == START:
            return Findings()
        self._read_news()
        ends = np.array(draft.points if draft.kind == TARGETS else draft.points[-1:], dtype=np.float64)
        if not self._targets:
            return Findings()
        one, other, apart = pairs_between(ends, self._places, CLEAR_M)
        found: dict[str, None] = {}
        for end, number, away in sorted(zip(one.tolist(), other.tolist(), apart.tolist(), strict=True)):
            target = self._targets[number]
            if target.robot != draft.robot and away < CLEAR_M:
                found[_told(*ends[end].tolist(), target, away)] = None
        return Findings(overridable=tuple(found))

    def _read_news(self) -> None:
        if not self._with_news:
            return
        for robot in self._with_news:
            self._of[robot] = [*_now(self._book.task_of(robot)), *self._later(robot)]
            if not self._of[robot]:
                del self._of[robot]
        self._with_news.clear()
        self._targets = [target for targets in self._of.values() for target in targets]
        self._places = np.array([target[2:] for target in self._targets], dtype=np.float64).reshape(-1, 2)

    def _later(self, robot: str) -> Iterator[Target]:
        queue = self._queues.get(robot)
        for task in queue.tasks if queue is not None else ():
            # The current one is under way, as a command.
            if task.state is not TaskState.CURRENT:
                yield Target(robot, tr("a task"), task.x, task.y)


def _now(report: CommandReport | None) -> Iterator[Target]:
    if report is None:
        return
    if report.op == SetPosEnd.__name__:
        yield Target(report.robot, tr("the target"), report.params["x"], report.params["y"])
    elif report.op == SetPath.__name__:
        x, y = report.params["points"][-1]
        yield Target(report.robot, tr("the end of the route"), x, y)


def _told(x: float, y: float, target: Target, away: float) -> str:
    return tr(
        "({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, {other_y:.2f}: keep "
        "{clear_m:g} m between targets.",
        x=x,
        y=y,
        away=away,
        what=target.what,
        robot=target.robot,
        other_x=target.x,
        other_y=target.y,
        clear_m=CLEAR_M,
    )
