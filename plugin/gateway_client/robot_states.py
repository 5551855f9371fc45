"""States of all robots as last reported, how far they can be trusted as time goes on, and states as text."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages.commands import CommandState
from ...robot_bridge.core.messages.json_values import robot_report
from ...robot_bridge.core.messages.positions import FleetView, RobotReport
from ...robot_bridge.core.messages.queues import QueueReport, QueueState, TaskKind, TaskReport, TaskState
from ...robot_bridge.core.messages.safety import RobotState
from ..ui.language import time_of_day, tr, tr_count
from .robot_table import STATES, RemovedRobots, RobotTable

_NUMBER = re.compile(r"[0-9]+")
_DIGITS = 20
"""To so many digits numbers within names are compared as numbers."""


def name_order(name: str) -> str:
    """Return what ``name`` is sorted by; no two names have the same."""
    filled = _NUMBER.sub(lambda number: number[0].zfill(_DIGITS), name.casefold())
    return f"{filled}\0{name}"


__all__ = ["STATES", "RemovedRobots", "RobotArrays", "RobotStates", "RobotView"]

_FRESH, _STALE, _LOST, _OFFLINE = range(len(STATES))
Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RobotView:
    """One robot at one moment: what was told of it last, its state now and its age in seconds now."""

    name: str
    values: dict[str, Any]
    state: RobotState
    age: float

    @cached_property
    def report(self) -> RobotReport:
        """The newest report."""
        return robot_report(self.values)

    @property
    def has_pose(self) -> bool:
        """Whether the robot ever said where it is."""
        return self.values.get("x") is not None and self.values.get("y") is not None


@dataclass(frozen=True)
class RobotArrays:
    """The robots at one moment, as arrays of one row each; a robot keeps its row in one arrangement.

    ``xy`` (n, 2) metres in the site frame, ``theta`` (n,) radians in the site frame, ``v`` (n,) metres a
    second, ``accuracy`` (n,) metres, each NaN where not known; ``state`` (n,) index into :data:`STATES`;
    ``age`` (n,) seconds since the last message.
    """

    names: list[str]
    xy: Numbers
    theta: Numbers
    v: Numbers
    accuracy: Numbers
    state: npt.NDArray[np.intp]
    age: Numbers


class RobotStates:
    """The newest sighting of every robot, aged by this computer's own clock.

    A gateway that falls silent says nothing about its robots any more: they turn stale and lost here all
    the same, and stay on the map.
    """

    def __init__(self, stale_after: float = 3.0, lost_after: float = 10.0):
        self.stale_after = stale_after
        self.lost_after = lost_after
        self.generation = 0
        """Counts how often everything was forgotten: rows of another generation are other robots."""
        self.arrangement = 0
        """Counts how often rows became other robots': all were forgotten, or one was removed."""
        self.revision = 0
        """Counts how often something was taken in."""
        self.fleet: FleetView | None = None
        """The fleet as a whole, where the desk is told of the robots in its view; None where of every one."""
        self._seen = RobotTable()
        self._names: list[str] = []
        self._by_name: list[int] = []
        self._orders: list[str] = []
        """What the robots are sorted by, by row."""

    def __len__(self) -> int:
        return len(self._seen)

    @property
    def count(self) -> int:
        """How many robots there are, those out of view among them."""
        return len(self._seen) if self.fleet is None else self.fleet.robots

    def set_limits(self, stale_after: float, lost_after: float) -> None:
        """Have robots count as stale and as lost after so many seconds without a message."""
        self.stale_after, self.lost_after = stale_after, lost_after

    def merge(self, sightings: RobotTable) -> RemovedRobots:
        """Take in newer sightings; one that arrived before what is known is passed over.

        Return the robots that are there no more, or out of view.
        """
        if sightings.tells_nothing:
            return RemovedRobots(frozenset(), np.empty(0, dtype=np.intp))
        gone = self._seen.merge(sightings)
        if sightings.view is not None or sightings.everything:
            self.fleet = sightings.view
        self.revision += 1
        if len(gone.rows):
            # To find again what thousands are sorted by takes longer than all else, and robots leave views
            # all the time.
            rows = set(gone.rows.tolist())
            self._orders = [order for row, order in enumerate(self._orders) if row not in rows]
            self._names, self._by_name = [], []
            self.arrangement += 1
        return gone

    def clear(self) -> None:
        """Forget every robot."""
        self._seen = RobotTable()
        self._names, self._by_name, self._orders = [], [], []
        self.fleet = None
        self.generation += 1
        self.arrangement += 1
        self.revision += 1

    def row(self, name: str) -> int | None:
        """Return the row of robot ``name`` in the arrays, None if it is not known."""
        return self._seen.row(name)

    def view(self, name: str, now: float) -> RobotView | None:
        """Return robot ``name`` as it is to be shown at ``now`` (monotonic clock), None if not known."""
        row = self._seen.row(name)
        return None if row is None else self.views(now, [row])[0]

    def views(self, now: float, rows: list[int] | None = None) -> list[RobotView]:
        """Return the robots in ``rows``, or every one by name, as they are to be shown at ``now``."""
        rows = self._sorted() if rows is None else rows
        state, age = self._aged(now, rows)
        return [
            RobotView(self._seen.names[row], self._seen.row_values(row), STATES[code], seconds)
            for row, code, seconds in zip(rows, state.tolist(), age.tolist(), strict=True)
        ]

    def arrays(self, now: float, rows: slice = slice(None)) -> RobotArrays:
        """Return the robots in ``rows`` at ``now``; NaN is the place of one that never said where it is."""
        seen = self._seen
        state, age = self._aged(now, rows)
        x = seen.column("x")[rows]
        xy = np.empty((len(x), 2))
        xy[:, 0], xy[:, 1] = x, seen.column("y")[rows]
        return RobotArrays(
            names=self._all_names() if rows == slice(None) else seen.names[rows],
            xy=xy,
            theta=seen.column("theta")[rows].copy(),
            v=seen.column("v")[rows].copy(),
            accuracy=seen.column("accuracy")[rows].copy(),
            state=state,
            age=age,
        )

    def column(self, name: str) -> Numbers:
        """Return (n,) of one of :data:`~.sightings.COLUMNS` of every robot, NaN where nothing was told."""
        return self._seen.column(name).copy()

    def texts(self, name: str, rows: slice = slice(None)) -> list[str]:
        """Return what the robots in ``rows`` told last as the text ``name``, empty where nothing."""
        places, words = self._seen.texts(name)
        # What is not known points behind the last word.
        found = [*words, ""]
        at = np.nan_to_num(places[rows], nan=len(words)).astype(np.intp)
        return [found[place] for place in at.tolist()]

    def says(self, name: str, word: str) -> npt.NDArray[np.bool_]:
        """Tell which robots' text ``name`` holds ``word``, in lower case; the empty word is in any text."""
        places, words = self._seen.texts(name)
        # What is not known points behind the last word.
        holds = np.array([bool(text) and word in text.casefold() for text in words] + [False])
        return holds[np.nan_to_num(places, nan=len(words)).astype(np.intp)]

    def only_seen(self) -> npt.NDArray[np.bool_]:
        """Tell which robots said that they take no commands."""
        places, words = self._seen.texts("abilities")
        return places == words.index("") if "" in words else np.zeros(len(places), dtype=bool)

    def row_values(self, row: int) -> dict[str, Any]:
        """Return what was told last of the robot in ``row``, as it came."""
        return self._seen.row_values(row)

    def by_name(self) -> list[int]:
        """Return every row, in the order of the robots' names."""
        return self._sorted()

    def _all_names(self) -> list[str]:
        """Return every name by row: the same list until there are more of them."""
        if len(self._names) != len(self._seen):
            self._names = list(self._seen.names)
        return self._names

    def _sorted(self) -> list[int]:
        names = self._seen.names
        if len(self._by_name) != len(names):
            self._orders += [name_order(name) for name in names[len(self._orders) :]]
            self._by_name = sorted(range(len(names)), key=self._orders.__getitem__)
        return self._by_name

    def _aged(self, now: float, rows: list[int] | slice) -> tuple[npt.NDArray[np.intp], Numbers]:
        """Return states and ages, as ``gateway.model.robots.liveness`` says for each robot."""
        age = self._seen.column("age")[rows] + np.maximum(0.0, now - self._seen.column("received")[rows])
        state = self._seen.column("state")[rows].astype(np.intp)
        silent = np.flatnonzero(~(age < self.stale_after))
        reported, ended_in_order = state[silent], self._seen.column("stopped")[rows][silent] == 1.0
        here = np.where(ended_in_order, _OFFLINE, np.where(age[silent] < self.lost_after, _STALE, _LOST))
        # The gateway may know more than the age tells, such as a link closed in good order.
        state[silent] = np.where((reported == _LOST) | (reported == _OFFLINE), reported, here)
        return state, age


# --- States in words ---

ROBOT_STATES = {
    RobotState.FRESH: tr("fresh"),
    RobotState.STALE: tr("stale"),
    RobotState.LOST: tr("lost"),
    RobotState.OFFLINE: tr("offline"),
}
COMMAND_STATES = {
    CommandState.QUEUED: tr("queued"),
    CommandState.DELIVERED: tr("delivered"),
    CommandState.ACKNOWLEDGED: tr("acknowledged"),
    CommandState.REACHED: tr("reached"),
    CommandState.ABORTED: tr("aborted"),
    CommandState.FAILED: tr("failed"),
    CommandState.EXPIRED: tr("expired"),
    CommandState.SUPERSEDED: tr("superseded"),
}
TASK_STATES = {
    TaskState.WAITING: tr("waiting"),
    TaskState.CURRENT: tr("now"),
    TaskState.FAILED: tr("failed"),
    TaskState.DONE: tr("done"),
    TaskState.SKIPPED: tr("skipped"),
    TaskState.REMOVED: tr("removed"),
}
MEETINGS = {
    "head-on": tr("head-on"),
    "crossing": tr("crossing"),
    "following": tr("following"),
    "standing": tr("standing"),
}
"""How two robots come into each other's way, by the kind of a ConflictReport."""


def part_in_words(robots: RobotStates) -> str:
    """Return of how many of all robots the desk is told; empty where of every one."""
    if robots.fleet is None:
        return ""
    return tr(
        "This desk is told of {known} of {all} robots: those in view, selected, or with an alarm.",
        known=len(robots),
        all=robots.count,
    )


def longest_word(words: dict) -> str:
    """Return the word that needs the widest column."""
    return max(words.values(), key=len)


TASK_KINDS = {
    TaskKind.DRIVE: tr("drive"),
    TaskKind.PLACE: tr("place cone"),
    TaskKind.COLLECT: tr("collect cone"),
}


def task_in_words(task: TaskReport) -> str:
    """Return what is done where, as in ``place cone K7 at 12.30, 40.00``."""
    name = f" {task.label or task.cone}" if task.label or task.cone else ""
    way = tr(", a path of {path_points} points", path_points=task.path_points) if task.path_points else ""
    return tr(
        "{kind}{name} at {x:.2f}, {y:.2f}{way}",
        kind=TASK_KINDS[task.kind],
        name=name,
        x=task.x,
        y=task.y,
        way=way,
    )


def task_state_in_words(task: TaskReport) -> str:
    """Return how far a task is, and why where there is something to say."""
    text = TASK_STATES[task.state]
    return f"{text}: {task.reason}" if task.reason else text


def queue_in_words(queue: QueueReport) -> str:
    """Return whether a queue goes on, and who paused it when and why."""
    count = tr_count(len(queue.tasks), "1 task", "%n tasks")
    if queue.state is QueueState.PAUSED:
        when = f", {time_of_day(queue.at)}" if queue.at is not None else ""
        # The gateway's reasons name who did it; where they do not, the name stands alone.
        why = queue.reason or (tr("by {by}", by=queue.by) if queue.by else "")
        text = tr(
            "{robot}: {count}, PAUSED{when}{why}",
            robot=queue.robot,
            count=count,
            when=when,
            why=f": {why}" if why else "",
        )
    else:
        text = f"{queue.robot}: {count}, {tr('running') if queue.tasks else tr('nothing to do')}"
    if queue.robot_state in (RobotState.LOST, RobotState.OFFLINE):
        text += tr(
            ". The robot is {state}: it is sent nothing until it is heard again",
            state=ROBOT_STATES[queue.robot_state],
        )
    return text


def last_ended_in_words(queue: QueueReport) -> str:
    """Return what ended last; empty where nothing did."""
    if not queue.ended:
        return ""
    task = queue.ended[0]
    off = "" if task.deviation is None else tr(", {deviation:.2f} m off", deviation=task.deviation)
    why = f": {task.reason}" if task.reason else ""
    return tr(
        "Last: {task} {state} {time}{off}{why}",
        task=task_in_words(task),
        state=TASK_STATES[task.state],
        time=time_of_day(task.ended_at),
        off=off,
        why=why,
    )
