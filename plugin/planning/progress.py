"""Progress of a plan that was sent, and what keeps it from continuing."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment.job import PlanRobot
from ...robot_bridge.core.assignment.plan import ConePlan, PlanStop
from ...robot_bridge.core.assignment.plan_changes import PlanSituation
from ...robot_bridge.core.messages import (
    GetPlacements,
    PlacementReport,
    QueueReport,
    QueueTask,
    RobotState,
    TaskReport,
    TaskState,
)
from ..control.fleet_controller import FleetController
from ..control.messages import PLAN_TROUBLE
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.report_caches import MOST_ASKED
from ..ui.language import first_of, tr
from .plan_settings import ConeFacts
from .proposal import ClosedWay, ClosureCheck, PlanProposal
from .queue_steps import SentStop, sent_stops

# --- How far the robots are with a plan that was sent, from what the gateway tells of their queues ---

AWAY = (RobotState.LOST, RobotState.OFFLINE)
_OPEN = (TaskState.WAITING, TaskState.CURRENT, TaskState.FAILED)
_GIVEN_UP = (TaskState.SKIPPED, TaskState.REMOVED, TaskState.FAILED)


@dataclass
class PlanProgress:
    """What became of each stop that was sent, by its task, and of each cone, by its target's id.

    Only the newest ends of a queue are told, so what was heard once is kept.
    """

    name: str
    facts: Mapping[str, ConeFacts]
    began_at: float
    stops: dict[str, SentStop] = field(default_factory=dict)
    reports: dict[str, TaskReport] = field(default_factory=dict)
    placed: dict[str, PlacementReport] = field(default_factory=dict)
    done: set[str] = field(default_factory=set)
    _sent_for: dict[str, list[str]] = field(default_factory=dict, init=False, repr=False)
    """The tasks that were sent for a target, the newest last."""

    def sent(self, stops: Iterable[SentStop]) -> None:
        """Note stops that are in a robot's queue from now on."""
        for one in stops:
            self.stops[one.task] = one
            self._sent_for.setdefault(one.stop.id, []).append(one.task)

    def forget(self, tasks: Iterable[str]) -> None:
        """Pass over tasks that others took the place of."""
        for task in tasks:
            known = self.stops.pop(task, None)
            if known is not None:
                self._sent_for[known.stop.id].remove(task)

    def take_queue(self, queue: QueueReport) -> None:
        """Take in how a robot's queue stands."""
        open_ones = {task.task for task in queue.tasks}
        for task in (*reversed(queue.ended), *queue.tasks):
            self._note(task)
        theirs = [task for task, one in self.stops.items() if one.robot == queue.robot]
        for task in theirs:
            known = self.reports.get(task)
            if task not in open_ones and known is not None and known.state in _OPEN:
                # It ended while nobody listened; of a cone, what was written down says the rest.
                self.reports[task] = replace(known, state=TaskState.DONE)

    def take_placement(self, report: PlacementReport) -> None:
        """Take in a cone that was put down or collected."""
        for target, facts in self.facts.items():
            if facts.placement is not None:
                if facts.placement == report.placement and report.collected_at is not None:
                    self.placed[target] = report
                    self.done.add(target)
            elif report.plan == self.name and report.cone == facts.cone:
                self.placed[target] = report
                self.done.add(target)

    def state_of(self, target: str) -> TaskState | None:
        """Return what became of a cone, None before it was sent."""
        if target in self.done:
            return TaskState.DONE
        found = self._newest(target)
        return None if found is None else found.state

    def why_not(self, target: str) -> str:
        """Return why a cone failed or was given up, nothing for another."""
        found = self._newest(target)
        return (found.reason or "") if found is not None and found.state in _GIVEN_UP else ""

    def remark_on(self, target: str) -> str:
        """Return what is said of a cone: why it failed, was given up, or is not begun yet."""
        if target in self.done:
            return ""
        found = self._newest(target)
        said = found is not None and found.state in (*_GIVEN_UP, TaskState.WAITING)
        return (found.reason or "") if said else ""

    def is_finished(self, plan: ConePlan) -> bool:
        """Tell whether every cone of ``plan`` is done or left out."""
        out = {one.target.id for one in plan.left_out}
        return all(target.id in self.done or target.id in out for target in plan.targets)

    def _note(self, task: TaskReport) -> None:
        stop = self.stops.get(task.task)
        if stop is None:
            return
        self.reports[task.task] = task
        if task.state is TaskState.DONE and stop.stop.is_target:
            self.done.add(stop.stop.id)

    def _newest(self, target: str) -> TaskReport | None:
        sent = reversed(self._sent_for.get(target, []))
        return next((self.reports[task] for task in sent if task in self.reports), None)


@dataclass(frozen=True)
class PlanProblem:
    """Why a plan does not go on as it is: robots that are away, cones that failed, with why, closed roads."""

    away: tuple[str, ...] = ()
    failed: tuple[tuple[str, str], ...] = ()
    closed: tuple[ClosedWay, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.away or self.failed or self.closed)

    def in_words(self) -> str:
        """Return what happened, for the operator."""
        away = [tr("{robot} is lost or offline", robot=robot) for robot in self.away]
        failed = [
            tr("cone {cone} failed{why}", cone=cone, why=f": {why}" if why else "")
            for cone, why in self.failed
        ]
        closed = [one.in_words() for one in self.closed]
        return "; ".join(text for texts in (away, failed, closed) for text in first_of(texts))


def problem_of(
    plan: ConePlan,
    progress: PlanProgress,
    queues: Mapping[str, QueueReport],
    closed: tuple[ClosedWay, ...] = (),
) -> PlanProblem:
    """Return what is wrong: a robot with cones to come that is away, a cone of this plan that failed, a
    way that is ``closed``."""
    away, failed = [], []
    for one in plan.robots:
        if one.lost:
            continue
        left = [stop.id for stop in one.stops if stop.is_target and stop.id not in progress.done]
        report = queues.get(one.robot.id)
        if left and report is not None and report.robot_state in AWAY:
            away.append(one.robot.id)
        failed += [
            (target, progress.why_not(target))
            for target in left
            if progress.state_of(target) in (TaskState.FAILED, TaskState.SKIPPED)
        ]
    return PlanProblem(tuple(away), tuple(failed), closed)


def situation_of(
    plan: ConePlan,
    progress: PlanProgress,
    places: Mapping[str, tuple[float, float]],
    trouble: PlanProblem,
    now: float,
    *,
    try_again: bool,
) -> PlanSituation:
    """Return how things are at ``now``, seconds since 1970, for a plan of what is left.

    What a robot is doing it finishes: that counts as done, and the robot is where it ends. ``places`` is
    where robots are (metres, site frame). With ``try_again`` cones that failed are tried by somebody again.
    """
    now_s = max(now - progress.began_at, 0.0)
    done, robots, currents = set(progress.done), {}, current_tasks(progress)
    for one in plan.robots:
        name = one.robot.id
        if one.lost or name in trouble.away:
            continue
        robot = replace(one.robot, ready_s=now_s)
        if name in places:
            robot = replace(robot, x=places[name][0], y=places[name][1])
        robot = _loaded(robot, plan, progress, name)
        if name in currents:
            current = progress.stops[currents[name]].stop
            done |= {current.id} if current.is_target else set()
            robot = replace(robot, x=current.x, y=current.y, ready_s=max(current.end_s, now_s))
        robots[name] = robot
    failed = {} if try_again else {cone: why or "failed" for cone, why in trouble.failed}
    return PlanSituation(now_s, frozenset(done), frozenset(trouble.away), failed, robots)


def current_tasks(progress: PlanProgress) -> dict[str, str]:
    """Return the task that each robot is doing, by the robot."""
    return {
        one.robot: task
        for task, one in progress.stops.items()
        if task in progress.reports and progress.reports[task].state is TaskState.CURRENT
    }


def committed_stops(progress: PlanProgress) -> list[PlanStop]:
    """Return the stops that robots have made or are on their way to: the gateway leads them on itself."""
    return [one.stop for task, one in progress.stops.items() if _is_behind(progress, task)]


def current_stops(progress: PlanProgress) -> dict[str, SentStop]:
    """Return what each robot is at, by the robot."""
    return {robot: progress.stops[task] for robot, task in current_tasks(progress).items()}


def current_cones(progress: PlanProgress) -> set[str]:
    """Return the cones that robots are at."""
    return {one.stop.id for one in current_stops(progress).values()}


def _loaded(robot: PlanRobot, plan: ConePlan, progress: PlanProgress, name: str) -> PlanRobot:
    """Return the robot with what it carries once what it is doing is done."""
    own = plan.robot(name)
    theirs = [(task, one.stop) for task, one in progress.stops.items() if one.robot == name]
    behind = [stop for task, stop in theirs if _is_behind(progress, task)]
    stops = [stop for stop in (own.stops if own is not None else ()) if stop in behind]
    if not stops:
        return robot
    return replace(robot, aboard=stops[-1].aboard, collected=stops[-1].collected)


def _is_behind(progress: PlanProgress, task: str) -> bool:
    report, stop = progress.reports.get(task), progress.stops[task].stop
    done = stop.is_target and stop.id in progress.done
    return done or (report is not None and report.state in (TaskState.DONE, TaskState.CURRENT))


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
        desk.queues_changed.connect(self._take_queues)
        desk.placements_changed.connect(self._take_placements)
        desk.link_changed.connect(self._ask_for_placements)

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
        self._take_queues([one.robot for one in self._desk.queues])

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
            report = self._desk.queues.get(robot)
            if report is not None:
                self.progress.take_queue(report)
        self._judge()

    def _take_placements(self, numbers: Sequence[int]) -> None:
        if self.progress is None:
            return
        new = set(numbers)
        for report in self._desk.placements:
            if report.placement in new:
                self.progress.take_placement(report)
        self._judge()

    def _ask_for_placements(self) -> None:
        """Ask for what was put down while this desk was not connected."""
        if self.progress is None or self._desk.link.phase is not ConnectionPhase.CONNECTED:
            return
        request = GetPlacements(plan=self.progress.name, limit=MOST_ASKED)
        self._desk.ask(request, tr("Placed cones of the plan"))

    def _judge(self) -> None:
        """Find out what is wrong, and tell of what was not wrong before."""
        plan, queues = self.draft.plan, {one.robot: one for one in self._desk.queues}
        made = {id(stop) for stop in committed_stops(self.progress)}
        closed = tuple(one for one in self.draft.closed if id(one.at) not in made)
        before, self.trouble = self.trouble, problem_of(plan, self.progress, queues, closed)
        self.changed.emit()
        if not self.trouble:
            self._settle()
        if not self.trouble or self.trouble == self.seen_to:
            return
        if self.trouble != before:
            why = self.trouble.in_words()
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
