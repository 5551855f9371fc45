"""All robots at one moment, as the table shows, sorts and filters them: columns, not objects."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import QueueState, RobotState
from ...language import tr
from ...wire.sightings import STATES
from ..command_book import CommandBook
from ..picture import RobotPicture
from ..queue_book import QueueBook
from ..state_words import ROBOT_STATES
from .columns import SHORT, idle_in_words, task_in_words
from .deviations import Deviations

Floats = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]
Bools = npt.NDArray[np.bool_]
FRESH = STATES.index(RobotState.FRESH)


class Which(str, Enum):
    """Which robots are listed."""

    ALL = "all"
    TROUBLED = "troubled"
    BUSY = "busy"
    IDLE = "idle"


@dataclass
class FleetRows:
    """Row k is the robot in row k of the picture. ``numbers`` has (n,) by column title, NaN where unknown."""

    picture: RobotPicture
    book: CommandBook
    deviations: Deviations
    names: list[str]
    state: npt.NDArray[np.intp]
    xy: Floats
    numbers: dict[str, Floats]
    paused: frozenset[str]
    """Robots with a queue that is paused."""
    _off: dict[int, float] = field(default_factory=dict)
    _texts: dict[str, list[str]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.names)

    def told(self, row: int) -> dict[str, Any]:
        """Return what was told last of a robot."""
        return self.picture.told(row)

    def task(self, row: int) -> str:
        """Return what a robot is doing, in words."""
        name = self.names[row]
        return task_in_words(self.book.task_of(name), self.told(row), paused=name in self.paused)

    def off(self, row: int) -> float:
        """Return how far a robot is from where it was told to be, NaN where nobody can tell."""
        known = self._off.get(row)
        if known is None:
            x, y = self.xy[row].tolist()
            at = (x, y) if np.isfinite(x) and np.isfinite(y) else None
            found = self.deviations.of(self.names[row], at)
            known = self._off[row] = np.nan if found is None else found
        return known

    def shown(self, which: Which, text: str, troubled: set[str]) -> Rows:
        """Return the rows that are listed, by name: each word of ``text`` is in name, state, task or link."""
        rows = np.array(self.picture.by_name(), dtype=np.intp)
        if which is Which.TROUBLED:
            bad = self.state != FRESH
            bad[[row for name in troubled if (row := self.picture.row(name)) is not None]] = True
            rows = rows[bad[rows]]
        elif which is not Which.ALL:
            busy = np.zeros(len(self), dtype=bool)
            for task in self.book.under_way():
                row = self.picture.row(task.robot)
                if row is not None:
                    busy[row] = True
            rows = rows[busy[rows] == (which is Which.BUSY)]
        words = text.casefold().split()
        if not words:
            return rows
        names = [name.casefold() for name in self.names]
        has = np.logical_and.reduce([self._has(word, names) for word in words])
        return rows[has[rows]]

    def sorted(self, rows: Rows, title: str, descending: bool) -> Rows:
        """Return ``rows``, which come by name, sorted by a column; what is not known comes last."""
        if title == "Robot":
            return rows[::-1] if descending else rows
        keys = self._keys(rows, title)
        # NaN comes last either way.
        return rows[np.argsort(-keys if descending else keys, kind="stable")]

    def _keys(self, rows: Rows, title: str) -> Floats:
        if title == "State":
            return self.state[rows].astype(np.float64)
        if title == "Off":
            return self._offs()[rows]
        if title == "Position":
            return self.xy[rows, 0]
        if title in self.numbers:
            return self.numbers[title][rows]
        words = self._text(title)
        rank = {word: float(place) for place, word in enumerate(sorted(set(words) - {""}, key=str.casefold))}
        return np.array([rank.get(word, np.nan) for word in words], dtype=np.float64)[rows]

    def _offs(self) -> Floats:
        """Return what :meth:`off` says of everybody; only who was told to be somewhere can be off."""
        told = {report.robot for report in self.book}
        offs = np.full(len(self), np.nan)
        for robot in told:
            row = self.picture.row(robot)
            if row is not None:
                offs[row] = self.off(row)
        return offs

    def _text(self, title: str) -> list[str]:
        """Return the texts of Task or Link of every robot."""
        known = self._texts.get(title)
        if known is None:
            known = self._texts[title] = self._links() if title == "Link" else self._tasks()
        return known

    def _links(self) -> list[str]:
        links = self.picture.texts("link")
        return [SHORT.get(link, link) for link in links]

    def _tasks(self) -> list[str]:
        stopped = self.picture.column("stopped").tolist()
        says = self.picture.texts("status")
        silent = ("", tr("stopped"))
        texts = [text or silent[bool(stands)] for text, stands in zip(says, stopped, strict=True)]
        for row in self._paused_rows():
            texts[row] = says[row] or idle_in_words(stopped=True, paused=True)
        for task in self.book.under_way():
            row = self.picture.row(task.robot)
            if row is not None:
                texts[row] = task_in_words(task, {})
        return texts

    def _has(self, word: str, names: list[str]) -> Bools:
        """Tell which robots have ``word`` in their name, state, task or link; each text is looked at once,
        however many robots say it."""
        has = np.fromiter((word in name for name in names), dtype=bool, count=len(names))
        has |= np.array([word in ROBOT_STATES[state].casefold() for state in STATES])[self.state]
        return has | self.picture.says("link", word) | self._has_task(word)

    def _has_task(self, word: str) -> Bools:
        has = self.picture.says("status", word)
        if word in tr("stopped").casefold():
            has |= (self.picture.column("stopped") == 1.0) & ~self.picture.says("status", "")
        told = ~self.picture.says("status", "")
        for row in self._paused_rows():
            has[row] |= bool(told[row]) and word in tr("paused").casefold()
        for task in self.book.under_way():
            row = self.picture.row(task.robot)
            if row is not None:
                has[row] = word in task_in_words(task, {}).casefold()
        return has

    def _paused_rows(self) -> list[int]:
        return [row for robot in self.paused if (row := self.picture.row(robot)) is not None]


def fleet_rows(
    picture: RobotPicture, book: CommandBook, queues: QueueBook, deviations: Deviations, moment: float
) -> FleetRows:
    """Return all robots at ``moment`` of the desk's clock."""
    robots = picture.arrays(moment)
    numbers = {
        "Speed": robots.v,
        "Batt.": picture.column("battery"),
        "Age": robots.age,
        "Ping": picture.column("latency"),
    }
    paused = frozenset(queue.robot for queue in queues if queue.state is QueueState.PAUSED)
    return FleetRows(picture, book, deviations, robots.names, robots.state, robots.xy, numbers, paused)
