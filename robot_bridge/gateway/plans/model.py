"""Cone plan as driven by the gateway: its state, tasks, problems and report; no I/O."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ...core.assignment.plan import ConePlan, check_plan, document_of, plan_of_document
from ...core.assignment.progress import (
    ClosedWay,
    ConeFacts,
    PlanProblem,
    PlanProgress,
    SentStop,
    current_stops,
    sent_stops,
)
from ...core.errors import PlanFileError, RefusedError
from ...core.messages.plans import (
    MOST_CONES,
    PlanProblemKind,
    PlanProblemReport,
    PlanReport,
    PlanState,
    PlanStopReport,
    SubmitPlan,
)
from ...core.messages.queues import QueueTask, TaskState
from ...core.messages.roads import ClosureReport
from ..traffic.site_roads import ClosedRoads

ENDS = (PlanState.FINISHED, PlanState.CLEARED)
LONGEST_PAUSE_REASON = 200
"""most characters of the reason of a queue's pause."""


@dataclass(frozen=True)
class PlanTerms:
    """Terms of a plan, submitted with its document: data on its cones, and parameters of replanning.

    Distances are metres, ``stand`` (x, y) in the site frame.
    """

    cones: Mapping[str, ConeFacts]
    stand: Sequence[tuple[float, float]] = ()
    on_roads: bool = True
    direct_m: float = 25.0
    clearance_m: float = 0.8
    apart_m: float = 2.0
    seconds: float = 2.0

    @classmethod
    def of(cls, request: SubmitPlan) -> PlanTerms:
        """Return the terms of a request."""
        cones = {one.id: ConeFacts(one.cone, one.layout, one.placement, one.theta) for one in request.cones}
        return cls(
            cones, request.stand, request.on_roads, request.direct_m, request.clearance_m, request.apart_m,
            request.seconds,
        )  # fmt: skip

    @property
    def off_standing_m(self) -> float:
        """Distance to keep from a standing robot: half of that between driving ones, as only one errs."""
        return max(self.clearance_m, self.apart_m / 2)


def plan_in(request: SubmitPlan) -> ConePlan:
    """Return the plan of a request; raises RefusedError for an invalid one, or one that cannot be driven."""
    try:
        plan = plan_of_document(request.document)
    except PlanFileError as error:
        raise RefusedError(f"submit_plan: {error}") from error
    if sum(1 for _ in plan.all_stops()) > MOST_CONES or len(plan.targets) > MOST_CONES:
        raise RefusedError(f"submit_plan: a plan holds {MOST_CONES} cones and as many stops at most")
    if plan.crs:
        raise RefusedError(f"submit_plan: the plan is in {plan.crs}; give it in metres of the site frame")
    # A desk routes around cones and standing robots, without allowance for these few decimetres.
    faults = check_plan(plan, led_round=True)
    if faults:
        more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
        raise RefusedError(f"submit_plan: the plan cannot be driven: {faults[0]}{more}")
    known = {one.id for one in request.cones}
    unnamed = [stop.id for _, stop in plan.all_stops() if stop.is_target and stop.id not in known]
    if unnamed:
        raise RefusedError(f"submit_plan: cones does not name cone {unnamed[0]!r} of the plan")
    return plan


@dataclass(frozen=True)
class DrivenPlan:
    """A plan as stored. ``held`` robots wait for a plan of the rest, paused since the given times (s).

    With ``try_again`` that plan includes another attempt at failed cones. In a ``proposal`` robots come too
    near to one another ``meetings`` times, and ``closed`` of its ways lead along closed roads.
    """

    name: str
    document: ConePlan
    terms: PlanTerms
    submitted_by: str
    submitted_at: float
    by_itself: bool = False
    state: PlanState = PlanState.DRIVEN
    revision: int = 1
    proposal: ConePlan | None = None
    held: Mapping[str, float | None] = field(default_factory=dict)
    reason: str | None = None
    by: str | None = None
    at: float | None = None
    ended_at: float | None = None
    try_again: bool = False
    meetings: int | None = None
    closed: int | None = None

    @property
    def staying(self) -> list[str]:
        """The robots that drive by it."""
        return [one.robot.id for one in self.document.robots if not one.lost]

    def changed(self, state: PlanState, by: str, at: float, reason: str | None, **more: Any) -> DrivenPlan:
        """Return the plan in another state, one revision further."""
        ended_at = at if state in ENDS else None
        return replace(
            self,
            state=state,
            by=by,
            at=at,
            reason=reason,
            ended_at=ended_at,
            revision=self.revision + 1,
            **more,
        )


def progress_from(plan: DrivenPlan, stops: Iterable[SentStop]) -> PlanProgress:
    """Return the initial progress of a plan with ``stops`` in queues, before any outcome."""
    progress = PlanProgress(plan.name, plan.terms.cones, plan.submitted_at)
    progress.sent(stops)
    return progress


def stops_of(document: ConePlan, tasks: Mapping[str, Sequence[QueueTask]]) -> list[SentStop]:
    """Return the stops of ``document`` with their ``tasks``."""
    return [
        stop
        for one in document.robots
        if one.robot.id in tasks
        for stop in sent_stops(one, list(tasks[one.robot.id]))
    ]


def superseded(progress: PlanProgress, away: Iterable[str]) -> list[str]:
    """Return the tasks that a plan of the rest replaces: not those done or being done."""
    kept, gone = (TaskState.DONE, TaskState.CURRENT), set(away)
    return [
        task
        for task, stop in progress.stops.items()
        if task not in progress.reports
        or progress.reports[task].state not in kept
        or (stop.robot in gone and progress.reports[task].state is TaskState.CURRENT)
    ]


def check_proposal(plan: DrivenPlan, progress: PlanProgress) -> ConePlan:
    """Return the proposed plan.

    :raises RefusedError: where there is none, it relies on tasks that were given up, or it would do a cone
        twice.
    """
    if plan.proposal is None or plan.state is not PlanState.PROPOSED:
        raise RefusedError(f"plan {plan.name!r} has no plan of what is left to confirm; ask for replan first")
    lost = {one.robot.id for one in plan.proposal.robots if one.lost}
    begun = {at.stop.id for robot, at in current_stops(progress).items() if robot not in lost}
    coming = {stop.id for _, stop in plan.proposal.all_stops() if stop.is_target}
    for found, what in (
        (plan.proposal.done - progress.done - begun, "given up"),
        (coming & (progress.done | begun), "begun or placed"),
    ):
        if found:
            names = ", ".join(sorted(found)[:10])
            raise RefusedError(f"{what} since the plan of what is left was made: {names}; replan")
    return plan.proposal


def problem_in_words(problem: PlanProblem) -> str:
    """Return why a plan does not continue, for queues and logs."""
    away = [f"{robot} is lost or offline" for robot in problem.away]
    failed = [f"cone {cone} failed{f': {why}' if why else ''}" for cone, why in problem.failed]
    closed = [f"the way of {one.robot} to {one.stop} leads along a closed road" for one in problem.closed]
    found = [*away, *failed, *closed]
    more = f"; and {len(found) - 5} more" if len(found) > 5 else ""
    return "; ".join(found[:5]) + more


def plan_report(
    plan: DrivenPlan, progress: PlanProgress, problem: PlanProblem, *, documents: bool = False
) -> PlanReport:
    """Return the report of a plan for operators."""
    shown = plan.document
    out = [one.target.id for one in shown.left_out]
    proposal = plan.proposal
    return PlanReport(
        plan=plan.name,
        revision=plan.revision,
        state=plan.state,
        submitted_by=plan.submitted_by,
        submitted_at=plan.submitted_at,
        by_itself=plan.by_itself,
        cones=len(shown.targets),
        done=len(progress.done),
        robots=plan.staying,
        stops=[_stop_report(progress, stop) for stop in progress.stops.values()],
        problems=_problem_reports(problem),
        left_out=out,
        reason=plan.reason,
        by=plan.by,
        at=plan.at,
        ended_at=plan.ended_at,
        meetings=None if proposal is None else plan.meetings,
        closed=None if proposal is None else plan.closed,
        document=document_of(shown) if documents else None,
        proposal=document_of(proposal) if documents and proposal is not None else None,
    )


def _stop_report(progress: PlanProgress, sent: SentStop) -> PlanStopReport:
    report, stop = progress.reports.get(sent.task), sent.stop
    done = stop.is_target and stop.id in progress.done
    state = TaskState.DONE if done else TaskState.WAITING if report is None else report.state
    reason = None if done or report is None else report.reason
    facts = progress.facts.get(stop.id) if stop.is_target else None
    placement = None if facts is None else facts.placement
    return PlanStopReport(sent.task, sent.robot, stop.kind, stop.id, stop.x, stop.y, state, reason, placement)


def _problem_reports(problem: PlanProblem) -> list[PlanProblemReport]:
    return [
        *(PlanProblemReport(PlanProblemKind.AWAY, robot) for robot in problem.away),
        *(PlanProblemReport(PlanProblemKind.FAILED, None, cone, why or None) for cone, why in problem.failed),
        *(
            PlanProblemReport(PlanProblemKind.CLOSED, one.robot, one.stop, one.reason or None)
            for one in problem.closed
        ),
    ]


@dataclass
class FollowedPlan:
    """A driven plan with its progress and problems."""

    plan: DrivenPlan
    progress: PlanProgress
    problem: PlanProblem = field(default_factory=PlanProblem)
    seen_to: PlanProblem = field(default_factory=PlanProblem)
    """the problem for which a new plan was made, or tried."""
    seen: Any = None
    ended: set[str] = field(default_factory=set)
    """the tasks that have ended according to the database."""

    def report(self, *, documents: bool = False) -> PlanReport:
        """Return the report for operators, with the plan itself and its proposal if ``documents``."""
        return plan_report(self.plan, self.progress, self.problem, documents=documents)


def ways_along_closed_roads(
    plan: ConePlan, roads: ClosedRoads, closures: Mapping[str, ClosureReport]
) -> tuple[ClosedWay, ...]:
    """Return the ways of ``plan`` along closed roads, which would not be sent; for a worker thread."""
    found = []
    for one in plan.robots:
        for stop in () if one.lost else one.stops:
            along = [id for id in roads.along(stop.path) if id in closures]
            if along:
                closure = closures[along[0]]
                found.append(ClosedWay(one.robot.id, stop.id, closure.closed_by, closure.reason or "", stop))
    return tuple(found)
