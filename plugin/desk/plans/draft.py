"""A plan together with the ground that it is planned on, and what speaks against it there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ....robot_bridge.assignment.plan import Plan
from ....robot_bridge.messages import ClosureReport
from ..time_slices import Steps, whole
from .closed_ways import ClosedWay, closed_ways
from .cone_source import ConeFacts
from .near_meetings import Meeting, meetings
from .plan_ways import PlanWays


@dataclass(frozen=True)
class Draft:
    """A plan with the ground that it is planned on. Its tasks and cones are written down with ``name``."""

    plan: Plan
    ways: PlanWays
    facts: Mapping[str, ConeFacts]
    name: str
    meetings: tuple[Meeting, ...] = field(default=())
    closed: tuple[ClosedWay, ...] = field(default=())
    """Ways along roads that are closed at the gateway, which would not take them."""

    def with_plan(self, plan: Plan, apart_m: float, closures: Sequence[ClosureReport]) -> Draft:
        """Return ``plan`` on the same ground, judged: where robots come nearer to each other than ``apart_m``
        metres, and what of it leads along ``closures``.

        That takes seconds for a plan of an hour among a thousand robots: not in the window's thread.
        """
        ways = self.ways
        near = tuple(meetings(plan, apart_m, ways.standing, ways.settings.off_standing_m))
        return replace(self, plan=plan, meetings=near, closed=whole(closed_ways(plan, closures)))

    def with_closures(self, closures: Sequence[ClosureReport]) -> Steps[Draft]:
        """Return the same with other roads closed; itself if that changes nothing."""
        closed = yield from closed_ways(self.plan, closures)
        return self if closed == self.closed else replace(self, closed=closed)
