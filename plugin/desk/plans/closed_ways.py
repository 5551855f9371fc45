"""Which ways of a plan lead along roads that are closed at the gateway."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ....robot_bridge.assignment.plan import Plan, Stop
from ....robot_bridge.messages import ClosureReport
from ....robot_bridge.roads.along import edges_along
from ....robot_bridge.roads.centrelines import centrelines
from ....robot_bridge.roads.nearest import NearestEdge
from ....robot_bridge.roads.network import build_network
from ....robot_bridge.roads.route import stretch
from ...language import tr
from ...sites.ground_reading import DEFAULT_WIDTH_M
from ..time_slices import Steps

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ClosedWay:
    """The way of ``robot`` to ``stop`` leads along a road that ``by`` closed."""

    robot: str
    stop: str
    by: str
    reason: str = ""
    at: Stop | None = field(default=None, compare=False, repr=False)

    def in_words(self) -> str:
        """Return whose way that is, and who closed the road and why."""
        return tr(
            "the way of {robot} to {stop} leads along a road that {by} closed{why}",
            robot=self.robot,
            stop=self.stop,
            by=self.by,
            why=f" ({self.reason})" if self.reason else "",
        )


def closed_ways(plan: Plan, closures: Sequence[ClosureReport]) -> Steps[tuple[ClosedWay, ...]]:
    """Find the ways of ``plan`` that lead along a closed road, one step for each road and each way.

    A way that only crosses one, or turns off where it begins, may be driven. The gateway says of closures no
    width, so that a road counts as wide as one of which none is known.
    """
    if not closures:
        return ()
    ways = [(one.robot.id, stop) for one in plan.robots if not one.lost for stop in one.stops]
    count = len(closures) + len(ways)
    roads = []
    for number, closure in enumerate(closures):
        yield number / count
        roads.append(_Road(closure))
    found = []
    for number, (robot, stop) in enumerate(ways, len(roads)):
        yield number / count
        path = np.array(stop.path, dtype=float)
        road = next((road for road in roads if road.is_along(path)), None)
        if road is not None:
            found.append(ClosedWay(robot, stop.id, road.by, road.reason, stop))
    return tuple(found)


class _Road:
    def __init__(self, closure: ClosureReport) -> None:
        self.by, self.reason = closure.closed_by, closure.reason or ""
        line = _without_ends(np.array(closure.line, dtype=float))
        self._low, self._high = line.min(axis=0) - DEFAULT_WIDTH_M, line.max(axis=0) + DEFAULT_WIDTH_M
        self._nearest = NearestEdge(build_network(centrelines([line], width=[DEFAULT_WIDTH_M])))
        self._all = np.ones(len(self._nearest.network), dtype=bool)

    def is_along(self, path: Floats) -> bool:
        """Tell whether ``path``, (n, 2) in the site frame, runs along the road."""
        low, high = np.minimum(path[:-1], path[1:]), np.maximum(path[:-1], path[1:])
        legs = np.flatnonzero(((low <= self._high) & (high >= self._low)).all(axis=1))
        if len(legs) == 0:
            return False
        # Most of a long way is far from the road, and need not be looked at.
        return len(edges_along(self._nearest, path[legs[0] : legs[-1] + 2], self._all)) > 0


def _without_ends(line: Floats) -> Floats:
    """Return ``line``, (n, 2), without half a road's width at either end, at most nine tenths of it.

    A way is on a road up to half its width beyond the road's end, which is where other roads begin.
    """
    metres = float(np.hypot(*np.diff(line, axis=0).T).sum())
    cut = min(DEFAULT_WIDTH_M / 2, 0.45 * metres)
    return stretch(line, cut, metres - cut)
