"""Progress of an active plan: its tasks, their outcomes, and problems that keep it from continuing."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

from ..messages.queues import QueueReport, QueueTask, TaskKind, TaskReport, TaskState
from ..messages.records import PlacementReport
from ..messages.safety import RobotState
from .job import COLLECT, PLACE, PlanRobot
from .plan import HOME, STORE, ConePlan, PlanSituation, PlanStop, RobotPlan

# --- A plan as tasks for the robots' queues ---


@dataclass(frozen=True)
class ConeFacts:
    """Stored facts on a target: the operator's name of the cone and its layout.

    ``placement`` is the number of the placed cone that is collected, None for one to be placed.
    """

    cone: str
    layout: str = ""
    placement: int | None = None
    theta: float | None = None


_KINDS = {PLACE: TaskKind.PLACE, COLLECT: TaskKind.COLLECT}
_LABELS = {STORE: "store", HOME: "end"}


@dataclass(frozen=True)
class SentStop:
    """A stop of the plan that was sent: its robot, its number in that robot's day, and its task."""

    robot: str
    number: int
    stop: PlanStop
    task: str


def tasks_of(
    plan: ConePlan,
    name: str,
    facts: Mapping[str, ConeFacts],
    new_id: Callable[[], str] = lambda: str(uuid.uuid4()),
    under_way: Mapping[str, SentStop] | None = None,
) -> dict[str, list[QueueTask]]:
    """Return the tasks of each robot that is not lost, in their order; ``name`` is the plan's own.

    A cone comes after all cones of lower stages of other robots, also those in progress (``under_way``, by
    robot).

    :raises MessageError: naming a task that no gateway would take.
    """
    staying = [one for one in plan.robots if not one.lost]
    ids = {one.robot.id: [new_id() for _ in one.stops] for one in staying}
    stages = {target.id: target.stage for target in plan.targets}
    staged: dict[int, list[tuple[str, str]]] = {}
    for one in staying:
        sent = list(zip(one.stops, ids[one.robot.id], strict=True))
        now = (under_way or {}).get(one.robot.id)
        if now is not None:
            sent.append((now.stop, now.task))
        for stop, task in sent:
            if stop.is_target:
                staged.setdefault(stages[stop.id], []).append((one.robot.id, task))

    def after(robot: str, stop: PlanStop) -> list[str] | None:
        lower = [stage for stage in sorted(staged) if stop.is_target and stage < stages[stop.id]]
        return [task for stage in lower for by, task in staged[stage] if by != robot] or None

    return {
        one.robot.id: [
            _task(stop, name, facts, task, after(one.robot.id, stop))
            for stop, task in zip(one.stops, ids[one.robot.id], strict=True)
        ]
        for one in staying
    }


def sent_stops(one: RobotPlan, tasks: list[QueueTask]) -> list[SentStop]:
    """Return the stops of one robot together with the tasks that :func:`tasks_of` made of them."""
    return [
        SentStop(one.robot.id, number, stop, task.task)
        for number, (stop, task) in enumerate(zip(one.stops, tasks, strict=True))
    ]


def _task(
    stop: PlanStop, name: str, facts: Mapping[str, ConeFacts], task: str, after: list[str] | None
) -> QueueTask:
    path = [*stop.path[:-1], (stop.x, stop.y)]
    if not stop.is_target:
        label = f"{_LABELS[stop.kind]} {stop.id}"
        return QueueTask(task, stop.x, stop.y, path=path, label=label, plan=name)
    known = facts[stop.id]
    # A collected cone is approached as it was placed, a placed one in its own heading.
    theta = known.theta if stop.kind == COLLECT else stop.theta
    return QueueTask(
        task, stop.x, stop.y, theta, _KINDS[stop.kind], path, known.cone, stop.id, known.layout or None, name,
        known.placement, after,
    )  # fmt: skip


# --- Progress of a sent plan, from the gateway's reports on queues ---

AWAY = (RobotState.LOST, RobotState.OFFLINE)
_OPEN = (TaskState.WAITING, TaskState.CURRENT, TaskState.FAILED)
_GIVEN_UP = (TaskState.SKIPPED, TaskState.REMOVED, TaskState.FAILED)


@dataclass
class PlanProgress:
    """The outcome of each sent stop, by its task, and of each cone, by its target's id.

    A queue's report lists only its newest ended tasks, so earlier reports are kept.
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
        """Record stops that are in a robot's queue from now on."""
        for one in stops:
            self.stops[one.task] = one
            self._sent_for.setdefault(one.stop.id, []).append(one.task)

    def forget(self, tasks: Iterable[str]) -> None:
        """Ignore tasks that were replaced by others."""
        for task in tasks:
            known = self.stops.pop(task, None)
            if known is not None:
                self._sent_for[known.stop.id].remove(task)

    def apply_queue(self, queue: QueueReport) -> None:
        """Apply a report on a robot's queue."""
        open_ones = {task.task for task in queue.tasks}
        for report in (*reversed(queue.ended), *queue.tasks):
            self._record(report)
        theirs = [task for task, one in self.stops.items() if one.robot == queue.robot]
        for task in theirs:
            known = self.reports.get(task)
            if task not in open_ones and known is not None and known.state in _OPEN:
                # It ended while no client was connected; for a cone, the stored placement supplies the rest.
                self.reports[task] = replace(known, state=TaskState.DONE)

    def apply_placement(self, report: PlacementReport) -> None:
        """Apply a report on a placed or collected cone."""
        for target, facts in self.facts.items():
            if facts.placement is not None:
                if facts.placement == report.placement and report.collected_at is not None:
                    self.placed[target] = report
                    self.done.add(target)
            elif report.plan == self.name and report.cone == facts.cone:
                self.placed[target] = report
                self.done.add(target)

    def state_of(self, target: str) -> TaskState | None:
        """Return the state of a cone's task, None before it was sent."""
        if target in self.done:
            return TaskState.DONE
        found = self._newest(target)
        return None if found is None else found.state

    def why_not(self, target: str) -> str:
        """Return why a cone failed or was given up, an empty text for others."""
        found = self._newest(target)
        return (found.reason or "") if found is not None and found.state in _GIVEN_UP else ""

    def is_finished(self, plan: ConePlan) -> bool:
        """Return whether every cone of ``plan`` is done or left out."""
        out = {one.target.id for one in plan.left_out}
        return all(target.id in self.done or target.id in out for target in plan.targets)

    def _record(self, task: TaskReport) -> None:
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
class ClosedWay:
    """The path of ``robot`` to ``stop`` leads along a road that ``by`` closed."""

    robot: str
    stop: str
    by: str
    reason: str = ""
    at: PlanStop | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class PlanProblem:
    """Why a plan cannot continue unchanged: absent robots, failed cones with reasons, closed roads."""

    away: tuple[str, ...] = ()
    failed: tuple[tuple[str, str], ...] = ()
    closed: tuple[ClosedWay, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.away or self.failed or self.closed)


def problem_of(
    plan: ConePlan,
    progress: PlanProgress,
    queues: Mapping[str, QueueReport],
    closed: tuple[ClosedWay, ...] = (),
) -> PlanProblem:
    """Return the problems: absent robots with open cones, failed cones of this plan, paths that are
    ``closed``."""
    away, failed = [], []
    for one in plan.robots:
        if one.lost:
            continue
        # Including its task in progress when the plan was made, which that plan counts as done.
        stops = (*one.done, *one.stops)
        left = [stop.id for stop in stops if stop.is_target and stop.id not in progress.done]
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
    """Return the situation at ``now``, seconds since 1970, for a replan.

    A robot finishes its present task: that counts as done, and the robot is taken to be at its end from the
    time at which it can have arrived from its present place. ``places`` is where robots are (metres, site
    frame). With ``try_again`` failed cones are tried again by some robot.
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
            ready_s = max(current.end_s, now_s)
            if name in places:
                ready_s = now_s + _seconds_left(current, places[name], robot.speed)
            robot = replace(robot, x=current.x, y=current.y, ready_s=ready_s)
        robots[name] = robot
    failed = {} if try_again else {cone: why or "failed" for cone, why in trouble.failed}
    return PlanSituation(now_s, frozenset(done), frozenset(trouble.away), failed, robots)


def _seconds_left(stop: PlanStop, place: tuple[float, float], speed: float) -> float:
    """Return the remaining seconds of driving and work of a robot at ``place`` on its way to ``stop``.

    The plan's own times are unreliable by now: robots drive faster than planned, give way, or were held.
    """
    # Imported only here: the gateway starts sooner without it.
    from shapely.geometry import LineString, Point

    way, here = LineString([*stop.path, (stop.x, stop.y)]), Point(place)
    metres = way.length - way.project(here) + way.distance(here)
    return float(metres / speed + stop.end_s - stop.begin_s)


def current_tasks(progress: PlanProgress) -> dict[str, str]:
    """Return the present task of each robot, by robot."""
    return {
        one.robot: task
        for task, one in progress.stops.items()
        if task in progress.reports and progress.reports[task].state is TaskState.CURRENT
    }


def committed_stops(progress: PlanProgress) -> list[PlanStop]:
    """Return the stops that robots have made or are on their way to: the gateway handles these itself."""
    return [one.stop for task, one in progress.stops.items() if _is_behind(progress, task)]


def current_stops(progress: PlanProgress) -> dict[str, SentStop]:
    """Return the present stop of each robot, by robot."""
    return {robot: progress.stops[task] for robot, task in current_tasks(progress).items()}


def standing_cones(progress: PlanProgress) -> list[tuple[float, float]]:
    """Return where cones of the plan stand, metres in the site frame; also those that robots are placing.

    A cone in progress is neither a target of the remaining plan nor stored as placed.
    """
    placed = [(one.x, one.y) for one in progress.placed.values() if one.collected_at is None]
    coming = [one for one in committed_stops(progress) if one.kind == PLACE and one.id not in progress.placed]
    return placed + [(one.x, one.y) for one in coming]


def _loaded(robot: PlanRobot, plan: ConePlan, progress: PlanProgress, name: str) -> PlanRobot:
    """Return the robot with its load after its present task."""
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
