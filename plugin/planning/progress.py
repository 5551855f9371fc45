"""Progress of a plan that was sent, and what keeps it from continuing."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment.plan import ConePlan
from ...robot_bridge.core.assignment.progress import (
    PlanProblem,
    PlanProgress,
    committed_stops,
    problem_of,
    sent_stops,
)
from ...robot_bridge.core.messages import (
    GetPlacements,
    QueueTask,
    TaskState,
)
from ..control.fleet_controller import FleetController
from ..control.messages import PLAN_TROUBLE
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.report_caches import MOST_ASKED
from ..ui.language import first_of, tr
from .proposal import ClosureCheck, PlanProposal, closed_in_words


def problem_in_words(problem: PlanProblem) -> str:
    """Return what happened, for the operator."""
    away = [tr("{robot} is lost or offline", robot=robot) for robot in problem.away]
    failed = [
        tr("cone {cone} failed{why}", cone=cone, why=f": {why}" if why else "")
        for cone, why in problem.failed
    ]
    closed = [closed_in_words(one) for one in problem.closed]
    return "; ".join(text for texts in (away, failed, closed) for text in first_of(texts))


# --- What becomes of the plan that robots drive: how far they are, and what keeps it from going on as it is

Tasks = Mapping[str, Sequence[QueueTask]]
"""What was sent to each robot, by its name."""


class PlanMonitor(QObject):
    """Takes in what the gateway tells of queues, placed cones and roads. Sends nothing to robots."""

    changed = pyqtSignal()
    """Something new is known of the plan."""
    troubled = pyqtSignal()
    """The plan does not go on as it is; told at each news until somebody has seen to that."""

    def __init__(self, desk: FleetController, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self.draft: PlanProposal | None = None
        """The plan as it was sent, None while none is followed."""
        self.progress: PlanProgress | None = None
        self.trouble = PlanProblem()
        self.seen_to = PlanProblem()
        """The trouble that a new plan was made for, or was tried to be."""
        self._look = ClosureCheck(self)
        desk.roads.closures_changed.connect(self.look_at_closures)
        desk.state.queues_changed.connect(self._take_queues)
        desk.state.placed_cones_changed.connect(self._take_placements)
        desk.state.link_changed.connect(self._ask_for_placements)

    def begin(self, draft: PlanProposal, tasks: Tasks) -> None:
        """Follow a plan from its beginning, of which ``tasks`` are sent."""
        self.draft, self.progress = draft, PlanProgress(draft.name, draft.facts, time.time())
        self._note(draft.plan, tasks)
        self.trouble = self.seen_to = PlanProblem()
        self._settle()

    def go_on(self, draft: PlanProposal, tasks: Tasks) -> None:
        """Follow a plan of what was left, whose ``tasks`` take the place of those that nobody has begun."""
        away = [one.robot.id for one in draft.plan.robots if one.lost]
        known = self.progress.reports
        self.progress.forget(
            task
            for task, stop in list(self.progress.stops.items())
            if task not in known
            or known[task].state not in (TaskState.DONE, TaskState.CURRENT)
            or stop.robot in away
        )
        self._note(draft.plan, tasks)
        self.draft = draft
        self._settle()

    def see_to(self) -> PlanProblem:
        """Return what is wrong; it is not told again unless something else goes wrong."""
        self.seen_to = self.trouble
        return self.trouble

    def clear(self) -> None:
        """Follow no plan any more."""
        self.draft = self.progress = None
        self.trouble = PlanProblem()
        self._settle()

    def shut_down(self) -> None:
        """Look at nothing any more."""
        self._look.stop()

    def look_at_queues(self) -> None:
        """Take in all queues as they are known now."""
        self._take_queues([one.robot for one in self._desk.state.queues])

    def look_at_closures(self) -> None:
        """Find out anew which ways lead along closed roads."""
        draft = self.draft
        if draft is None:
            return

        def found(drafts: list[PlanProposal]) -> None:
            if self.draft is draft:
                self.draft = drafts[0]
                self._judge()

        self._look.begin([draft], self._desk.roads.closures, found)

    def _take_queues(self, robots: Sequence[str]) -> None:
        if self.progress is None:
            return
        for robot in robots:
            report = self._desk.state.queues.get(robot)
            if report is not None:
                self.progress.take_queue(report)
        self._judge()

    def _take_placements(self, numbers: Sequence[int]) -> None:
        if self.progress is None:
            return
        new = set(numbers)
        for report in self._desk.state.placed_cones:
            if report.placement in new:
                self.progress.take_placement(report)
        self._judge()

    def _ask_for_placements(self) -> None:
        """Ask for what was put down while this desk was not connected."""
        if self.progress is None or self._desk.state.link.phase is not ConnectionPhase.CONNECTED:
            return
        request = GetPlacements(plan=self.progress.name, limit=MOST_ASKED)
        self._desk.orders.ask(request, tr("Placed cones of the plan"))

    def _judge(self) -> None:
        """Find out what is wrong, and tell of what was not wrong before."""
        plan, queues = self.draft.plan, {one.robot: one for one in self._desk.state.queues}
        made = {id(stop) for stop in committed_stops(self.progress)}
        closed = tuple(one for one in self.draft.closed if id(one.at) not in made)
        before, self.trouble = self.trouble, problem_of(plan, self.progress, queues, closed)
        self.changed.emit()
        if not self.trouble:
            self._settle()
        if not self.trouble or self.trouble == self.seen_to:
            return
        if self.trouble != before:
            why = problem_in_words(self.trouble)
            self._complain(tr("The cone plan cannot go on as it is: {why}. Plan what is left.", why=why))
        self.troubled.emit()

    def _complain(self, text: str) -> None:
        """Tell what a new plan is to mend: it hangs there until one was agreed to, and no longer."""
        self._settle()
        self._desk.report_failure(text, PLAN_TROUBLE)

    def _settle(self) -> None:
        self._desk.messages.end(PLAN_TROUBLE)

    def _note(self, plan: ConePlan, tasks: Tasks) -> None:
        for one in plan.robots:
            if one.robot.id in tasks:
                self.progress.sent(sent_stops(one, tasks[one.robot.id]))
