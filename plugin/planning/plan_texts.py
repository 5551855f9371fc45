"""Cone plans in words and rows: their progress, their stops, and findings against sending them."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from ...robot_bridge.core.assignment.job import COLLECT, PLACE, STRAIGHT, PlanRobot
from ...robot_bridge.core.assignment.plan import ConePlan, PlanStop, RobotPlan
from ...robot_bridge.core.messages.plans import PlanProblemKind, PlanProblemReport, PlanReport, PlanStopReport
from ...robot_bridge.core.messages.queues import QueueReport, QueueState, TaskState
from ...robot_bridge.core.messages.records import PlacementReport
from ...robot_bridge.core.messages.safety import RobotState
from ..cone_texts import RESULT_QUALITY
from ..control.fleet_controller import FleetController
from ..gateway_client.state_words import ROBOT_STATES
from ..ui.language import first_of, time_of_day, tr, tr_count
from .proposal import PlanProposal, closed_in_words, meeting_in_words

# --- The progress of a submitted plan, and its obstacles, from the gateway's reports ---

_REMARKED = (TaskState.SKIPPED, TaskState.REMOVED, TaskState.FAILED, TaskState.WAITING)
"""States with a reason that is shown: why a cone failed, was given up, or is not begun yet."""


def problem_in_words(problems: Sequence[PlanProblemReport]) -> str:
    """Return the problems as text for the operator."""
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
    """The state of each cone of a submitted plan, by its target's id."""

    def __init__(self, report: PlanReport, placements: Iterable[PlacementReport]):
        self.began_at = report.submitted_at
        """Seconds since 1970, the origin of the plan's own times."""
        self._stops: dict[str, PlanStopReport] = {
            one.id: one for one in report.stops if one.kind in (PLACE, COLLECT)
        }
        placed, collected = {}, {}
        for one in placements:
            placed[one.task] = one.deviation
            collected[one.placement] = one.deviation
        self._placed, self._collected = placed, collected

    def state_of(self, target: str) -> TaskState | None:
        """Return the state of a cone, None for one that is no robot's task."""
        stop = self._stops.get(target)
        return None if stop is None else stop.state

    def remark_on(self, target: str) -> str:
        """Return the remark on a cone: why it failed, was given up, or is not begun yet."""
        stop = self._stops.get(target)
        return (stop.reason or "") if stop is not None and stop.state in _REMARKED else ""

    def deviation_of(self, target: str) -> float | None:
        """Return the deviation of a cone, or that before it was collected, in metres."""
        stop = self._stops.get(target)
        if stop is None or stop.state is not TaskState.DONE:
            return None
        return self._placed.get(stop.task) if stop.placement is None else self._collected.get(stop.placement)


# --- A plan in words and numbers, for table, map and messages ---

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C510A", "#6A3D9A")
"""Okabe and Ito's palette and two more; with more robots colours repeat, and the numbers distinguish them."""

_WORDS = {
    TaskState.WAITING: tr("in the queue"),
    TaskState.CURRENT: tr("under way"),
    TaskState.FAILED: tr("FAILED"),
    TaskState.DONE: tr("done"),
    TaskState.SKIPPED: tr("skipped"),
    TaskState.REMOVED: tr("taken out"),
}
NOT_DONE = (TaskState.FAILED, TaskState.SKIPPED)


@dataclass(frozen=True)
class PlanStopRow:
    """One stop for display. ``number`` counts the stops of its robot, from 1, completed ones first.

    ``state`` is that of a cone that was sent, ``why`` the remark on it; ``deviation`` is in metres.
    """

    robot: str
    number: int
    trip: int
    stop: PlanStop
    arrives: str
    state: TaskState | None = None
    why: str = ""
    deviation: float | None = None

    def in_words(self) -> str:
        """Return state and reason for the operator, empty for a cone that was not sent."""
        words = "" if self.state is None else _WORDS[self.state]
        return f"{words}: {self.why}" if self.why else words


def colour_of(plan: ConePlan, robot: str) -> str:
    """Return a robot's colour in the plan, as ``#rrggbb``."""
    names = [one.robot.id for one in plan.robots]
    return COLOURS[names.index(robot) % len(COLOURS)]


def stop_rows(plan: ConePlan, progress: ReportedProgress | None) -> dict[str, list[PlanStopRow]]:
    """Return the stops of each robot, completed ones first."""
    began = None if progress is None else progress.began_at
    rows: dict[str, list[PlanStopRow]] = {}
    for one in plan.robots:
        behind = [(0, stop) for stop in one.done]
        to_come = [(trip.number, stop) for trip in one.trips for stop in trip.stops]
        rows[one.robot.id] = [
            _row(one.robot.id, number, trip, stop, began, progress)
            for number, (trip, stop) in enumerate([*behind, *to_come], 1)
        ]
    return rows


def plan_title(report: PlanReport) -> str:
    """Return who submitted a plan and when, and for which robots."""
    return tr(
        "{by}, {time}: {robots}",
        by=report.submitted_by,
        time=time_of_day(report.submitted_at),
        robots=", ".join(first_of(report.robots)),
    )


def plan_summary(plan: ConePlan) -> str:
    """Return the quality of a plan and the cones that it leaves out."""
    cones = sum(stop.is_target for _, stop in plan.all_stops())
    robots = sum(bool(one.stops) for one in plan.robots)
    text = tr(
        "{cones}, {robots}, {metres:.0f} m, done after {span} ({method}, along {travel})",
        cones=tr_count(cones, "1 cone", "%n cones"),
        robots=tr_count(robots, "1 robot", "%n robots"),
        metres=plan.metres,
        span=_span(plan.end_s),
        method=RESULT_QUALITY.get(plan.method, plan.method),
        travel=tr("straight lines") if plan.travel == STRAIGHT else tr("the roads"),
    )
    out = plan.left_out
    return (
        tr(
            "{text}. Left out: {names}",
            text=text,
            names=", ".join(first_of([f"{one.target.id} ({one.reason})" for one in out])),
        )
        if out
        else text
    )


def method_text(plan: ConePlan) -> str:
    """Return the parts of the method by which a plan was made, for those interested."""
    return tr("Found by: {method}. Ways along: {travel}.", method=plan.method, travel=plan.travel)


def time_text(seconds: float, began_at: float | None) -> str:
    """Return the time of day once the plan has begun, before that the time after its beginning."""
    if began_at is None:
        return f"+{_span(seconds)}"
    return time.strftime("%H:%M:%S", time.localtime(began_at + seconds))


def _row(
    robot: str, number: int, trip: int, stop: PlanStop, began: float | None, progress: ReportedProgress | None
) -> PlanStopRow:
    row = PlanStopRow(robot, number, trip, stop, time_text(stop.arrival_s, began))
    if progress is None or not stop.is_target:
        return row
    return replace(
        row,
        state=progress.state_of(stop.id),
        why=progress.remark_on(stop.id),
        deviation=progress.deviation_of(stop.id),
    )


def _span(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


# --- Messages to the operator before and after a plan is sent ---

MOVED = 1.0
"""Metres that a robot may have moved since the plan was made."""

LISTED = 5
"""Robots, doubts, closed ways and meetings named in the question: it must fit on a screen."""


def before_sending(desk: FleetController, draft: PlanProposal) -> str:
    """Return the consequences of sending, and the findings against it."""
    driving = [one for one in draft.plan.robots if one.stops and not one.lost]
    lines = [plan_summary(draft.plan) + ".", ""]
    lines += first_of([f"{one.robot.id}: {_cones(one)}" for one in driving], LISTED)
    doubts = [doubt for one in driving for doubt in _doubts(desk, one.robot)]
    closed = [closed_in_words(one) for one in draft.closed]
    meetings = [meeting_in_words(meeting) for meeting in draft.meetings]
    minded = [text for texts in (doubts, closed, meetings) for text in first_of(texts, LISTED)]
    if minded:
        lines += ["", tr("Mind:"), *(f"• {text}" for text in minded)]
    return "\n".join([*lines, "", tr("The robots set off at once.")])


def after_sending(desk: FleetController, robots: Sequence[str]) -> list[str]:
    """Return the plan's robots that do not start, since their queues are paused."""
    texts = []
    for robot in robots:
        report = desk.state.queues.get(robot)
        if report is not None and report.tasks and report.state is QueueState.PAUSED:
            texts.append(
                tr(
                    "The queue of {robot} stays paused ({reason}): its cones wait until it is resumed.",
                    robot=report.robot,
                    reason=report.reason or "",
                )
            )
    return texts


def _cones(one: RobotPlan) -> str:
    return tr_count(sum(stop.is_target for stop in one.stops), "1 cone", "%n cones")


def _doubts(desk: FleetController, robot: PlanRobot) -> list[str]:
    queue = desk.state.queues.get(robot.id)
    return [*_doubts_of_place(desk, robot), *(_doubts_of_queue(queue) if queue is not None else ())]


def _doubts_of_place(desk: FleetController, robot: PlanRobot) -> Iterator[str]:
    """Yield whether the robot is elsewhere than where the plan begins, or away."""
    view = desk.state.robots.view(robot.id, desk.clock.steady())
    if view is None or not view.has_pose:
        yield tr("it is not known where {id} is", id=robot.id)
        return
    away = math.hypot(view.report.x - robot.x, view.report.y - robot.y)
    if away > MOVED:
        yield tr("{id} is {away:.1f} m from where the plan begins: better plan anew", id=robot.id, away=away)
    if view.state not in (RobotState.FRESH, RobotState.STALE):
        yield tr(
            "{id} is {state}: it gets its queue when it is heard of again",
            id=robot.id,
            state=ROBOT_STATES[view.state],
        )


def _doubts_of_queue(queue: QueueReport) -> Iterator[str]:
    """Yield the fate of the tasks that are in the robot's queue already."""
    waiting = sum(task.state is not TaskState.CURRENT for task in queue.tasks)
    if waiting:
        yield tr_count(
            waiting,
            "1 task that waits in the queue of {id} is replaced",
            "%n tasks that wait in the queue of {id} are replaced",
            id=queue.robot,
        )
    if waiting < len(queue.tasks):
        yield tr("{id} finishes first what it is doing", id=queue.robot)
    if queue.state is QueueState.PAUSED:
        yield tr(
            "the queue of {id} is paused ({reason}): it is resumed",
            id=queue.robot,
            reason=queue.reason or tr("no reason"),
        )
