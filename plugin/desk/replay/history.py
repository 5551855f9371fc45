"""Stored positions, and where every robot was at a moment; no I/O, no Qt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import RobotState
from ..picture import STATES, RobotArrays

SILENT_AFTER = 15.0
"""Seconds between stored positions after which a robot counts as silent: while it is heard of, a gateway
stores one at least every ten, unless its site.toml says otherwise."""
_FRESH, _LOST = STATES.index(RobotState.FRESH), STATES.index(RobotState.LOST)
Numbers = npt.NDArray[np.float64]


class History:
    """Positions of robots, taken in page by page, oldest first; each robot has one row in what is told."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self._rows: dict[str, int] = {}
        self._pages: list[Numbers] = []
        self._count = 0
        self._sorted: Numbers | None = None
        self._first = np.empty(0, dtype=np.intp)
        self._extent = np.empty((0, 2))

    def __len__(self) -> int:
        return self._count

    @property
    def table(self) -> Numbers:
        """All positions, robot by robot, oldest first: rows of robot's row, time, x, y, theta, v."""
        self._arrange()
        return self._sorted

    @property
    def is_arranged(self) -> bool:
        """Whether :attr:`table` is there at once: making it of very many takes longer than a window waits."""
        return self._sorted is not None

    @property
    def extent(self) -> Numbers:
        """The least and the greatest x and y of all positions, (2, 2) metres; empty where there are none."""
        self._arrange()
        return self._extent

    def add(self, places: Sequence[Sequence]) -> None:
        """Take in places as the gateway gives them: robot, time, x, y, theta, v, and more.

        :raises ValueError: when one of them is none.
        """
        if not places:
            return
        try:
            numbers = np.array([place[1:6] for place in places], dtype=np.float64)
            robots = [str(place[0]) for place in places]
        except (TypeError, IndexError) as error:
            raise ValueError(f"a stored position is not one: {error}") from error
        if numbers.shape != (len(places), 5) or not np.isfinite(numbers).all():
            raise ValueError("a stored position has no finite time or place")
        for robot in robots:
            if robot not in self._rows:
                self._rows[robot] = len(self.names)
                self.names.append(robot)
        row = np.array([self._rows[robot] for robot in robots], dtype=np.float64)
        self._pages.append(np.column_stack([row, numbers]))
        self._count += len(places)
        self._sorted = None

    def row(self, robot: str) -> int | None:
        """Return a robot's row, None for one without a position."""
        return self._rows.get(robot)

    def at(self, moment: float) -> RobotArrays:
        """Return every robot as it was at ``moment``, seconds since 1970.

        Between two positions that are near in time a robot was on the straight line; before its first one it
        has no place; after a longer silence it stays where it was last, lost, with its age.
        """
        table, count = self.table, len(self.names)
        last = self._last_before(moment)
        known = last >= self._first[:count]
        here = np.where(known, last, 0)
        following = np.minimum(here + 1, max(len(table) - 1, 0))
        if count == 0:
            return _arrays(self.names, np.empty((0, 4)), np.empty(0), np.empty(0, dtype=bool))
        now, then = table[here], table[following]
        span = then[:, 1] - now[:, 1]
        joined = (then[:, 0] == now[:, 0]) & (span > 0) & (span <= SILENT_AFTER)
        age = moment - now[:, 1]
        part = np.where(joined, age / np.where(joined, span, 1.0), 0.0)
        turn = np.remainder(then[:, 4] - now[:, 4] + np.pi, 2 * np.pi) - np.pi
        step = np.column_stack([then[:, 2:4] - now[:, 2:4], turn, then[:, 5] - now[:, 5]])
        pose = now[:, 2:6] + step * part[:, None]
        pose[~known] = np.nan
        silent = known & ~joined & (age > SILENT_AFTER)
        # A robot that is silent does not drive on.
        pose[silent, 3] = 0.0
        return _arrays(self.names, pose, np.where(joined | ~known, 0.0, age), silent | ~known)

    def _arrange(self) -> None:
        if self._sorted is not None:
            return
        whole = np.concatenate(self._pages) if self._pages else np.empty((0, 6))
        # They came oldest first: an order by robots alone, which keeps that, takes a tenth of the time.
        whole = whole[np.argsort(whole[:, 0].astype(np.uint16), kind="stable")]
        self._first = np.searchsorted(whole[:, 0], np.arange(len(self.names) + 1))
        self._extent = _extent(whole)
        # Further pages are newer than these of the same robot, so that nothing is held twice.
        self._pages = [whole]
        self._sorted = whole

    def _last_before(self, moment: float) -> npt.NDArray[np.intp]:
        """Return for each robot the row of its last position up to ``moment``, before its first if none.

        All robots are searched at once: one after the other takes several milliseconds of a thousand.
        """
        times = self.table[:, 1]
        begin, end = self._first[:-1].copy(), self._first[1:].copy()
        while (begin < end).any():
            # Where a search is over, its middle is its end, which may be that of the table.
            middle = np.minimum((begin + end) // 2, len(times) - 1)
            later = (begin >= end) | (times[middle] > moment)
            begin, end = np.where(later, begin, middle + 1), np.where(later, middle, end)
        return begin - 1


def _extent(table: Numbers) -> Numbers:
    # Column by column: numpy is slow where it goes along rows of two.
    columns = [table[:, column] for column in (2, 3)] if len(table) else []
    return np.array([[column.min() for column in columns], [column.max() for column in columns]])


def _arrays(names: list[str], pose: Numbers, age: Numbers, silent: npt.NDArray[np.bool_]) -> RobotArrays:
    return RobotArrays(
        names=list(names),
        xy=pose[:, :2],
        theta=pose[:, 2],
        v=pose[:, 3],
        accuracy=np.full(len(names), np.nan),
        state=np.where(silent, _LOST, _FRESH).astype(np.intp),
        age=age,
    )
