"""How far a submitted plan is, and what keeps it from going on, from what the gateway reports of it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...robot_bridge.core.assignment.job import COLLECT, PLACE
from ...robot_bridge.core.messages.plans import PlanProblemKind, PlanProblemReport, PlanReport, PlanStopReport
from ...robot_bridge.core.messages.queues import TaskState
from ...robot_bridge.core.messages.records import PlacementReport
from ..ui.language import first_of, tr

_REMARKED = (TaskState.SKIPPED, TaskState.REMOVED, TaskState.FAILED, TaskState.WAITING)
"""States with a reason that is shown: why a cone failed, was given up, or is not begun yet."""


def problem_in_words(problems: Sequence[PlanProblemReport]) -> str:
    """Return what happened, for the operator."""
    away = [
        tr("{robot} is lost or offline", robot=one.robot)
        for one in problems
        if one.kind is PlanProblemKind.AWAY
    ]
    failed = [
        tr("cone {cone} failed{why}", cone=one.stop, why=f": {one.reason}" if one.reason else "")
        for one in problems
        if one.kind is PlanProblemKind.FAILED
    ]
    closed = [
        tr(
            "the way of {robot} to {stop} leads along a closed road{why}",
            robot=one.robot,
            stop=one.stop,
            why=f" ({one.reason})" if one.reason else "",
        )
        for one in problems
        if one.kind is PlanProblemKind.CLOSED
    ]
    return "; ".join(text for texts in (away, failed, closed) for text in first_of(texts))


class ReportedProgress:
    """What became of each cone of a submitted plan, by its target's id."""

    def __init__(self, report: PlanReport, placements: Iterable[PlacementReport]):
        self.began_at = report.submitted_at
        """Seconds since 1970, from which the plan's own times count."""
        self._stops: dict[str, PlanStopReport] = {
            one.id: one for one in report.stops if one.kind in (PLACE, COLLECT)
        }
        placed, collected = {}, {}
        for one in placements:
            placed[one.task] = one.deviation
            collected[one.placement] = one.deviation
        self._placed, self._collected = placed, collected

    def state_of(self, target: str) -> TaskState | None:
        """Return what became of a cone, None for one that no robot has as a task."""
        stop = self._stops.get(target)
        return None if stop is None else stop.state

    def remark_on(self, target: str) -> str:
        """Return what is said of a cone: why it failed, was given up, or is not begun yet."""
        stop = self._stops.get(target)
        return (stop.reason or "") if stop is not None and stop.state in _REMARKED else ""

    def deviation_of(self, target: str) -> float | None:
        """Return how far off a cone stands, or stood before it was collected, in metres."""
        stop = self._stops.get(target)
        if stop is None or stop.state is not TaskState.DONE:
            return None
        return self._placed.get(stop.task) if stop.placement is None else self._collected.get(stop.placement)
