"""Service of cone plans: submitted, followed, paused, planned again for what is left, cleared.

What became of a plan's tasks is seen from the queues and from what is stored, never from what was heard: a
gateway that was killed goes on with every plan where it stopped.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple, Protocol

from ...core.assignment.plan import ConePlan, check_plan, plan_of_document
from ...core.assignment.progress import (
    PlanProblem,
    PlanProgress,
    committed_stops,
    current_stops,
    problem_of,
    situation_of,
    standing_cones,
    tasks_of,
)
from ...core.errors import AssignmentError, OutdatedError, PlanFileError, RefusedError, RoadsError, StoreError
from ...core.logs import log_and_continue, log_unforeseen
from ...core.messages.json_values import to_json
from ...core.messages.plans import (
    MOST_CONES,
    ClearPlan,
    ConfirmReplan,
    DiscardReplan,
    GetPlans,
    PausePlan,
    PlanReport,
    Plans,
    PlanState,
    Replan,
    ResumePlan,
    SubmitPlan,
)
from ...core.messages.queues import PauseQueue, QueueState, TaskState
from ...core.messages.records import GetPlacements
from ...core.messages.validation import MessageError
from ..model.events import Listeners
from ..model.request_handlers import handles
from ..model.robots import AWAY
from ..model.task_queue import ENDS as TASK_ENDS
from ..model.task_queue import Queue, queue_report, task_report
from ..queues.registry import QueueContext
from ..queues.requests import QueueEditor, QueueEntries
from ..storage.repositories import queues, records
from ..traffic.closures import ClosureService
from ..traffic.road_planning import RoadPlanner
from .model import (
    ENDS,
    LONGEST_PAUSE_REASON,
    DrivenPlan,
    PlanTerms,
    ReplanGround,
    Replanning,
    check_proposal,
    count_meetings,
    plan_report,
    problem_in_words,
    progress_from,
    stops_of,
    superseded,
    ways_along_closed_roads,
)
from .persistence import find_plan, load_open, load_stops, newest_ended_plans, save_plan

log = logging.getLogger(__name__)

GATEWAY = "gateway"
MOST_PLANS = 50
"""plans that are driven at the same time."""
MOST_PLACED = 5000


class Stops(Protocol):
    """What knows whether an emergency stop is in force."""

    @property
    def in_force(self) -> bool:
        """Whether it is."""


@dataclass
class _Followed:
    """A plan that is driven, and what is known of it."""

    plan: DrivenPlan
    progress: PlanProgress
    problem: PlanProblem = field(default_factory=PlanProblem)
    seen_to: PlanProblem = field(default_factory=PlanProblem)
    """the problem that a new plan was made for, or was tried to be."""
    seen: Any = None
    ended: set[str] = field(default_factory=set)
    """the tasks that are known to be at their ends, from the database."""
    making: Replanning | None = None
    meetings: int | None = None
    closed: int | None = None

    def cancel_planning(self) -> None:
        if self.making is not None:
            self.making.cancel()

    def report(self, *, documents: bool = False) -> PlanReport:
        proposed = self.plan.proposal is not None
        return plan_report(
            self.plan,
            self.progress,
            self.problem,
            meetings=self.meetings if proposed else None,
            closed=self.closed if proposed else None,
            documents=documents,
        )


class _Proposal(NamedTuple):
    """A plan of what is left, where its robots come too near to one another, and its ways on closed roads."""

    document: ConePlan
    meetings: int
    closed: int


class PlanService:
    """The plans that robots drive. Each method returns when what it changed is stored."""

    def __init__(
        self,
        context: QueueContext,
        editor: QueueEditor,
        closures: ClosureService,
        stops: Stops,
        listeners: Listeners,
    ) -> None:
        self._context = context
        self._editor = editor
        self._closures = closures
        self._planner = context.planner if isinstance(context.planner, RoadPlanner) else None
        self._stops = stops
        self._listeners = listeners
        self._plans: dict[str, _Followed] = {}
        self._lock = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()
        self._began = context.clock.steady()

    async def restore(self) -> None:
        """Go on with the plans that an earlier gateway left."""
        for plan in await self._context.database.run(load_open):
            with log_and_continue(log, f"plan {plan.name}", except_for=StoreError):
                stops = await self._context.database.run(load_stops, plan.name)
                one = self._plans[plan.name] = _Followed(plan, progress_from(plan, stops))
                await self._follow(one)
                if plan.state is PlanState.REPLANNING:
                    self._begin(one, try_again=False)

    @handles(SubmitPlan)
    async def submit(self, request: SubmitPlan, operator: str) -> PlanReport:
        """Enter all tasks of a plan, and follow it; the same again changes nothing.

        :raises MessageError: for a document that is no plan; RefusedError and OutdatedError for what cannot
            be entered, and StoreError. Nothing is entered then.
        """
        document = await asyncio.to_thread(_document, request)
        async with self._lock:
            if (known := await self._known(request.plan)) is not None:
                return known
            self._check_no_emergency()
            self._check_free(document)
            now = self._context.clock.time()
            terms = PlanTerms.of(request)
            plan = DrivenPlan(
                request.plan, document, terms, operator, now, request.by_itself, by=operator, at=now
            )
            tasks = tasks_of(document, plan.name, terms.cones)
            stops = stops_of(document, tasks)
            entries = QueueEntries(
                {robot: theirs for robot, theirs in tasks.items() if theirs},
                {robot: seen for robot, seen in request.revisions.items() if tasks.get(robot)},
                [robot for robot, theirs in tasks.items() if theirs],
                override=request.override,
            )
            await self._editor.enter(entries, operator, partial(_save, plan=plan, new=stops))
            one = self._plans[plan.name] = _Followed(plan, progress_from(plan, stops))
            await self._follow(one)
            return self._announced(one)

    @handles(GetPlans)
    async def read(self, request: GetPlans) -> Plans:
        """Return plans as they are; raises RefusedError for one that is not known."""
        if request.plan is not None:
            one = self._plans.get(request.plan) or await self._ended(request.plan)
            if one is None:
                raise _unknown(request.plan)
            return Plans([one.report(documents=request.documents)])
        newest = await self._context.database.read(newest_ended_plans, request.ended)
        ended = [await self._recalled(plan) for plan in newest]
        # What is driven is read last, so that no newer report of it can be on its way before this answer.
        followed = [*self._plans.values(), *(one for one in ended if one.plan.name not in self._plans)]
        return Plans([one.report(documents=request.documents) for one in followed])

    @handles(PausePlan)
    async def pause(self, request: PausePlan, operator: str) -> PlanReport:
        """Send the robots of a plan nothing more; first that, then it is stored that the plan is paused."""
        one = self._plan(request.plan)
        why = f"plan {request.plan}" + (f": {request.reason}" if request.reason else "")
        for robot in one.plan.staying:
            if robot in self._context.robots:
                await self._editor.pause(PauseQueue(robot, why[:LONGEST_PAUSE_REASON]), operator)
        async with self._lock:
            one = self._plan(request.plan)
            one.cancel_planning()
            return await self._put(one, PlanState.PAUSED, operator, request.reason, proposal=None, held={})

    @handles(ResumePlan)
    async def resume(self, request: ResumePlan, operator: str) -> PlanReport:
        """Let the robots go on that are paused."""
        async with self._lock:
            one = self._of_revision(request.plan, request.revision)
            self._check_no_emergency()
            if one.plan.state not in (PlanState.PAUSED, PlanState.DRIVEN):
                raise RefusedError(
                    f"plan {request.plan!r} is {one.plan.state.value}; confirm or discard that first"
                )
            robots = [robot for robot in self._paused(one) if not self._has_failed(robot)]
            if not robots and one.plan.state is PlanState.DRIVEN:
                raise RefusedError(
                    f"no queue of plan {request.plan!r} is paused, or a plan of what is left is needed"
                )
            return await self._let_go_on(one, robots, operator)

    @handles(Replan)
    async def replan(self, request: Replan, operator: str) -> PlanReport:
        """Hold the robots and begin to plan what is left."""
        async with self._lock:
            one = self._of_revision(request.plan, request.revision)
            self._check_no_emergency()
            return await self._hold(one, operator, try_again=request.try_again)

    @handles(ConfirmReplan)
    async def confirm(self, request: ConfirmReplan, operator: str) -> PlanReport:
        """Enter the tasks of the proposed plan in place of what is left."""
        async with self._lock:
            one = self._of_revision(request.plan, request.revision)
            self._check_no_emergency()
            await self._follow(one)
            return await self._confirm(one, operator, request.override)

    @handles(DiscardReplan)
    async def discard(self, request: DiscardReplan, operator: str) -> PlanReport:
        """Give up the plan of what is left; robots held for it go on."""
        async with self._lock:
            one = self._of_revision(request.plan, request.revision)
            self._check_no_emergency()
            if one.plan.state not in (PlanState.REPLANNING, PlanState.PROPOSED):
                raise RefusedError(
                    f"plan {request.plan!r} has no plan of what is left; there is nothing to discard"
                )
            one.cancel_planning()
            return await self._let_go_on(one, self._still_held(one.plan), operator)

    @handles(ClearPlan)
    async def clear(self, request: ClearPlan, operator: str) -> PlanReport:
        """Follow a plan no more; its tasks stay in the queues."""
        async with self._lock:
            if request.plan not in self._plans and (known := await self._known(request.plan)) is not None:
                return known
            one = self._plan(request.plan)
            one.cancel_planning()
            await self._follow(one)
            return await self._put(one, PlanState.CLEARED, operator, None, proposal=None, held={})

    async def watch(self) -> None:
        """Follow all plans; called twice a second. Raises StoreError."""
        for one in list(self._plans.values()):
            # What nobody foresaw of one plan must not keep the others from being followed.
            with log_and_continue(log, f"plan {one.plan.name}", except_for=StoreError):
                async with self._lock:
                    if self._plans.get(one.plan.name) is one:
                        await self._look(one)

    async def finish(self) -> None:
        """Wait for what is being planned, after it was cancelled: the gateway ends."""
        for one in self._plans.values():
            if one.making is not None:
                one.making.cancel()
                # It stays stored as being planned again: the next gateway begins that again.
                one.making = None
        await asyncio.gather(*self._tasks, return_exceptions=True)

    # --- following ------------------------------------------------------------------------------------

    async def _look(self, one: _Followed) -> None:
        if self._stops.in_force and (one.plan.by_itself or one.plan.state is PlanState.DRIVEN):
            # Nothing goes on by itself after an emergency stop: somebody has to resume.
            state = PlanState.PAUSED if one.plan.state is PlanState.DRIVEN else one.plan.state
            await self._put(one, state, GATEWAY, "an emergency stop", by_itself=False)
        plan = one.plan
        if await self._follow(one):
            queued = {task.id for robot in plan.staying for task in self._queue(robot).tasks}
            if one.progress.is_finished(plan.document) and not queued & one.progress.stops.keys():
                await self._put(one, PlanState.FINISHED, GATEWAY, None, proposal=None, held={})
                return
            self._announced(one)
        new = bool(one.problem) and one.problem != one.seen_to
        if plan.by_itself and plan.state is PlanState.DRIVEN and new and not self._is_settling():
            one.seen_to = one.problem
            try:
                await self._hold(one, GATEWAY, try_again=False)
            except RefusedError as error:
                await self._put(one, PlanState.DRIVEN, GATEWAY, str(error))

    def _is_settling(self) -> bool:
        """Tell whether the gateway has only begun: robots that drive on are not heard of yet."""
        return self._context.clock.steady() < self._began + self._context.site.report.lost_after

    async def _follow(self, one: _Followed) -> bool:
        """Take in how the plan's queues, robots and roads are; false when nothing has changed."""
        robots, closed = one.plan.staying, None if self._planner is None else self._planner.closed
        present = [robot for robot in robots if robot in self._context.robots]
        seen = [(robot, self._queue(robot), self._context.robots.get(robot).state) for robot in present]
        if one.seen is not None and _is_same(one.seen, (one.plan, closed, seen)):
            return False
        await self._take_in(one, {robot: queue for robot, queue, _ in seen})
        reports = {robot: queue_report(queue, state) for robot, queue, state in seen}
        ways = () if closed is None or not closed.closures else await asyncio.to_thread(
            ways_along_closed_roads, one.plan.document, closed, self._closed_now()
        )  # fmt: skip
        behind = {id(stop) for stop in committed_stops(one.progress)}
        ways = tuple(way for way in ways if id(way.at) not in behind)
        one.problem = problem_of(one.plan.document, one.progress, reports, ways)
        one.seen = (one.plan, closed, seen)
        return True

    async def _take_in(self, one: _Followed, found: dict[str, Queue]) -> None:
        """Bring the progress up to what queues and the database hold."""
        progress = one.progress
        for robot, queue in found.items():
            progress.take_queue(queue_report(queue, self._context.robots.get(robot).state))
        queued = {task.id for queue in found.values() for task in queue.tasks}
        gone = [task for task in progress.stops if task not in queued and task not in one.ended]
        if not gone:
            return
        stored = await self._context.database.run(queues.find_all, gone)
        for task, (robot, queued_task) in stored.items():
            progress.reports[task] = task_report(robot, queued_task)
            if queued_task.state is TaskState.DONE and progress.stops[task].stop.is_target:
                progress.done.add(progress.stops[task].stop.id)
            if queued_task.state in TASK_ENDS:
                one.ended.add(task)
        query = GetPlacements(plan=one.plan.name, limit=MOST_PLACED)
        for report in await self._context.database.run(records.newest_placed_cones, query):
            progress.take_placement(report)

    def _closed_now(self) -> dict[str, Any]:
        return {one.closure: one for one in self._closures.report().closures}

    # --- what is left ---------------------------------------------------------------------------------

    async def _hold(self, one: _Followed, operator: str, *, try_again: bool) -> PlanReport:
        plan = one.plan
        if plan.state is PlanState.REPLANNING:
            raise RefusedError(f"plan {plan.name!r} is being planned again already")
        staying = [robot for robot in plan.staying if robot not in one.problem.away]
        if not staying:
            raise RefusedError(
                f"no robot of plan {plan.name!r} is left to take over; connect one, and plan anew"
            )
        why = "plan of what is left" + (f": {problem_in_words(one.problem)}" if one.problem else "")
        held = {robot: at for robot, at in plan.held.items() if robot in self._still_held(plan)}
        for robot in staying:
            if self._queue(robot).running or self._has_failed(robot):
                report = await self._editor.pause(PauseQueue(robot, why[:LONGEST_PAUSE_REASON]), operator)
                held[robot] = report.at
        one.seen_to = one.problem
        begun = await self._put(one, PlanState.REPLANNING, operator, why, proposal=None, held=held)
        self._begin(one, try_again=try_again)
        return begun

    def _begin(self, one: _Followed, *, try_again: bool) -> None:
        plan, robots = one.plan, self._context.robots
        places = {
            name: (pose.x, pose.y)
            for name in robots.commanded()
            if (pose := robots.get(name).pose) is not None
        }
        drive = set(plan.staying) - set(one.problem.away)
        standing = {name: place for name, place in places.items() if name not in drive}
        now = self._context.clock.time()
        situation = situation_of(plan.document, one.progress, places, one.problem, now, try_again=try_again)
        ground = ReplanGround(plan.terms, standing_cones(one.progress), standing, self._planner)
        one.making = making = Replanning(plan.document, ground, situation)
        task = asyncio.create_task(self._make(one, making, ground))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _make(self, one: _Followed, making: Replanning, ground: ReplanGround) -> None:
        try:
            document = await asyncio.to_thread(making.run)
            meetings = await asyncio.to_thread(count_meetings, document, ground)
            closed = 0
            if self._planner is not None:
                ways = await asyncio.to_thread(
                    ways_along_closed_roads, document, self._planner.closed, self._closed_now()
                )
                closed = len(ways)
        except (AssignmentError, RoadsError, RefusedError) as error:
            await self._made(one, making, None, str(error))
        except Exception:
            # Else the robots would stay held, and nobody would hear why.
            log_unforeseen(log, f"plan of what is left of {one.plan.name}")
            await self._made(one, making, None, "it could not be planned; see the gateway's log")
        else:
            await self._made(one, making, _Proposal(document, meetings, closed), None)

    async def _made(
        self, one: _Followed, making: Replanning, proposal: _Proposal | None, why: str | None
    ) -> None:
        try:
            async with self._lock:
                if one.making is not making or one.plan.state is not PlanState.REPLANNING:
                    return
                one.making = None
                if proposal is None:
                    reason = f"what is left could not be planned: {why}"
                    await self._put(one, PlanState.PAUSED, GATEWAY, reason, held={})
                    return
                one.meetings, one.closed = proposal.meetings, proposal.closed
                await self._put(one, PlanState.PROPOSED, GATEWAY, one.plan.reason, proposal=proposal.document)
                if one.plan.by_itself and not one.meetings and not one.closed and not self._stops.in_force:
                    await self._follow(one)
                    try:
                        await self._confirm(one, GATEWAY, None)
                    except (RefusedError, MessageError) as error:
                        await self._put(one, PlanState.PROPOSED, GATEWAY, str(error))
        except StoreError as error:
            # It is stored as being planned again: it is, when the gateway starts next, or somebody asks.
            log.error("plan %s: %s", one.plan.name, error)

    async def _confirm(self, one: _Followed, operator: str, override: str | None) -> PlanReport:
        plan, progress = one.plan, one.progress
        proposal = check_proposal(plan, progress)
        tasks = tasks_of(proposal, plan.name, plan.terms.cones, under_way=current_stops(progress))
        away = [one.robot.id for one in proposal.robots if one.lost and one.robot.id in plan.staying]
        stops, gone = stops_of(proposal, tasks), superseded(progress, away)
        after = plan.changed(
            PlanState.DRIVEN,
            operator,
            self._context.clock.time(),
            plan.reason,
            document=proposal,
            proposal=None,
            held={},
        )
        entries = QueueEntries(
            tasks,
            resumed=self._still_held(plan),
            away=[robot for robot in away if robot in self._context.robots],
            withdrawn={task for task in gone if progress.stops[task].robot in away},
            reason="its robot is lost",
            override=override,
        )
        place = len(progress.stops)
        also = partial(_save, plan=after, new=stops, gone=gone, place=place + plan.revision * MOST_CONES)
        await self._editor.enter(entries, operator, also)
        progress.forget(gone)
        progress.sent(stops)
        one.plan, one.seen = after, None
        await self._follow(one)
        return self._announced(one)

    # --- small parts ----------------------------------------------------------------------------------

    async def _let_go_on(self, one: _Followed, robots: Sequence[str], operator: str) -> PlanReport:
        now = self._context.clock.time()
        after = one.plan.changed(PlanState.DRIVEN, operator, now, None, proposal=None, held={})
        entries = QueueEntries(dict.fromkeys(robots), resumed=robots)
        await self._editor.enter(entries, operator, partial(_save, plan=after))
        one.plan, one.making = after, None
        return self._announced(one)

    async def _put(
        self, one: _Followed, state: PlanState, by: str, reason: str | None, **more: Any
    ) -> PlanReport:
        after = one.plan.changed(state, by, self._context.clock.time(), reason, **more)
        await self._context.database.run(save_plan, after)
        one.plan = after
        if state in ENDS:
            self._plans.pop(after.name, None)
        return self._announced(one)

    def _announced(self, one: _Followed) -> PlanReport:
        report = one.report()
        self._listeners.announce("plan", one.plan.name, to_json(report))
        return report

    def _queue(self, robot: str) -> Queue:
        return self._context.book.get(robot)

    def _has_failed(self, robot: str) -> bool:
        return any(task.state is TaskState.FAILED for task in self._queue(robot).tasks)

    def _paused(self, one: _Followed) -> list[str]:
        robots = [robot for robot in one.plan.staying if robot in self._context.robots]
        here = [robot for robot in robots if self._context.robots.get(robot).state not in AWAY]
        return [
            robot
            for robot in here
            if self._queue(robot).state is QueueState.PAUSED and self._queue(robot).tasks
        ]

    def _still_held(self, plan: DrivenPlan) -> list[str]:
        """Return the robots that are held for a plan, and by nobody else since."""
        return [
            robot
            for robot, at in plan.held.items()
            if robot in self._context.robots
            and self._queue(robot).state is QueueState.PAUSED
            and self._queue(robot).at == at
        ]

    def _check_no_emergency(self) -> None:
        if self._stops.in_force:
            raise RefusedError("an emergency stop is in force; it has to be cleared first")

    def _check_free(self, document: ConePlan) -> None:
        if len(self._plans) >= MOST_PLANS:
            raise RefusedError(f"{MOST_PLANS} plans are driven already; clear one of them first")
        for robot in (one.robot.id for one in document.robots if not one.lost and one.stops):
            self._context.robots.check_known(robot)
            for name, other in self._plans.items():
                if robot in other.plan.staying:
                    raise RefusedError(
                        f"robot {robot!r} drives plan {name!r}; clear that first, or leave it out"
                    )

    def _plan(self, name: str) -> _Followed:
        if name not in self._plans:
            raise _unknown(name)
        return self._plans[name]

    def _of_revision(self, name: str, revision: int) -> _Followed:
        one = self._plan(name)
        if revision != one.plan.revision:
            raise OutdatedError(
                f"plan {name!r} is at revision {one.plan.revision}, not {revision}; look at it again",
                to_json(one.report()),
            )
        return one

    async def _known(self, name: str) -> PlanReport | None:
        one = self._plans.get(name) or await self._ended(name)
        return None if one is None else one.report()

    async def _ended(self, name: str) -> _Followed | None:
        plan = await self._context.database.read(find_plan, name)
        return None if plan is None else await self._recalled(plan)

    async def _recalled(self, plan: DrivenPlan) -> _Followed:
        """Return a plan that ended, with what became of it."""
        stops = await self._context.database.read(load_stops, plan.name)
        one = _Followed(plan, progress_from(plan, stops))
        await self._take_in(one, {})
        return one


def _save(connection: Any, plan: DrivenPlan, **more: Any) -> None:
    save_plan(connection, plan, **more)


def _is_same(before: Any, now: Any) -> bool:
    if before[0] is not now[0] or before[1] is not now[1] or len(before[2]) != len(now[2]):
        return False
    return all(a[1] is b[1] and a[2] is b[2] for a, b in zip(before[2], now[2], strict=True))


def _unknown(name: str) -> RefusedError:
    return RefusedError(f"no plan {name!r} is driven; see get_plans")


def _document(request: SubmitPlan) -> ConePlan:
    """Return the plan of a request; raises RefusedError for what is none, or cannot be driven."""
    try:
        plan = plan_of_document(request.document)
    except PlanFileError as error:
        raise RefusedError(f"submit_plan: {error}") from error
    if sum(1 for _ in plan.all_stops()) > MOST_CONES or len(plan.targets) > MOST_CONES:
        raise RefusedError(f"submit_plan: a plan holds {MOST_CONES} cones and as many stops at most")
    if plan.crs:
        raise RefusedError(f"submit_plan: the plan is in {plan.crs}; give it in metres of the site frame")
    # A desk leads ways round cones and standing robots, and counts them without these few decimetres.
    faults = check_plan(plan, led_round=True)
    if faults:
        more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
        raise RefusedError(f"submit_plan: the plan cannot be driven: {faults[0]}{more}")
    known = {one.id for one in request.cones}
    unnamed = [stop.id for _, stop in plan.all_stops() if stop.is_target and stop.id not in known]
    if unnamed:
        raise RefusedError(f"submit_plan: cones does not name cone {unnamed[0]!r} of the plan")
    return plan
