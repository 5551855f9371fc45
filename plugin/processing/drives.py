"""Positions put together to drives: what each robot drove without a gap."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Positions:
    """Where robots were: ``robots`` (n,) names, ``times`` (n,) seconds since 1970, ``xy`` (n, 2).

    ``speeds`` (n,) in m/s as the robots told them, NaN where they did not.
    """

    robots: npt.NDArray[np.str_]
    times: Numbers
    xy: Numbers
    speeds: Numbers

    def __len__(self) -> int:
        return len(self.times)


@dataclass(frozen=True)
class Drive:
    """One robot on its way: ``times`` (m,) rising, ``xy`` (m, 2), ``speeds`` (m,), with m of at least 2."""

    robot: str
    times: Numbers
    xy: Numbers
    speeds: Numbers

    @property
    def seconds(self) -> float:
        """How long it took."""
        return float(self.times[-1] - self.times[0])

    def top_speed(self, steps: Numbers) -> float:
        """Return the highest speed in m/s; ``steps`` (m - 1,) are the metres from position to position.

        As the robot told it, else the mean of its fastest step.
        """
        if np.isfinite(self.speeds).any():
            return float(np.nanmax(np.abs(self.speeds)))
        return float((steps / np.diff(self.times)).max())


def drives(positions: Positions, gap: float, *, steps: bool = False) -> Iterator[Drive]:
    """Yield what each robot drove, robot by robot, oldest first; after more than ``gap`` seconds a new one.

    With ``steps`` each step from one position to the next is a drive of its own. Of several positions of a
    robot at one time the last counts. A position without another one near in time is no drive.
    """
    order = np.lexsort((positions.times, positions.robots))
    robots, times = positions.robots[order], positions.times[order]
    again = (robots[1:] == robots[:-1]) & (times[1:] == times[:-1])
    kept = np.append(~again, True)[: len(order)]
    order, robots, times = order[kept], robots[kept], times[kept]
    begins = np.flatnonzero((robots[1:] != robots[:-1]) | (np.diff(times) > gap)) + 1
    for part in np.split(order, begins):
        pieces = [part[k : k + 2] for k in range(len(part) - 1)] if steps else [part]
        for piece in pieces:
            if len(piece) > 1:
                robot = str(positions.robots[piece[0]])
                yield Drive(robot, positions.times[piece], positions.xy[piece], positions.speeds[piece])
