"""Plans that are followed: what queues, robots, roads and the database say of each; changes are stored first.

What became of a plan's tasks is seen from the queues and from what is stored, never from what was heard: a
gateway that was killed, or another one, goes on with every plan where it stopped.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable
from typing import Any

from ...core.assignment.plan import ConePlan
from ...core.assignment.progress import ClosedWay, SentStop, committed_stops, problem_of
from ...core.errors import OutdatedError, RefusedError, StoreError
from ...core.logs import log_and_continue
from ...core.messages.base import to_json
from ...core.messages.plans import PlanReport, PlanState
from ...core.messages.queues import QueueState, TaskState
from ...core.messages.records import GetPlacements
from ..model.events import EventBus, Listeners, PlanChanged
from ..model.robots import AWAY
from ..model.task_queue import ENDS as TASK_ENDS
from ..model.task_queue import Queue, queue_report, task_report
from ..queues.registry import QueueContext
from ..storage.repositories import queues, records
from ..traffic.closures import ClosureService
from ..traffic.road_planning import RoadPlanner
from .model import ENDS, DrivenPlan, FollowedPlan, progress_from, ways_along_closed_roads
from .persistence import find_plan, load_stops, newest_ended_plans, open_revisions, save_plan

log = logging.getLogger(__name__)

MOST_PLACED = 5000


class FollowedPlans:
    """The plans that robots drive, by name; whoever changes one holds :attr:`lock`.

    Other gateways may change them, too: :meth:`take_up` learns of that, and what is stored of one that was
    changed since is refused with PlanMovedError. PlanChanged is published for what is stored here.
    """

    def __init__(
        self, context: QueueContext, closures: ClosureService, listeners: Listeners, events: EventBus
    ) -> None:
        self.lock = asyncio.Lock()
        self.planner = context.planner if isinstance(context.planner, RoadPlanner) else None
        self._context = context
        self._closures = closures
        self._listeners = listeners
        self._events = events
        self._plans: dict[str, FollowedPlan] = {}
        self._revisions: dict[str, int] = {}
        """the revision of each plan that is driven as it was read or stored last."""

    def __len__(self) -> int:
        return len(self._plans)

    def __contains__(self, name: str) -> bool:
        return name in self._plans

    def names(self) -> set[str]:
        """Return the names of the plans that are driven."""
        return set(self._plans)

    def all(self) -> list[FollowedPlan]:
        """Return the plans that are driven, oldest first."""
        return sorted(self._plans.values(), key=lambda one: one.plan.submitted_at)

    async def take_up(self) -> None:
        """Take in what an earlier gateway, or others, submitted, changed and ended; raises StoreError."""
        stored = await self._context.database.read(open_revisions)
        for name in [*stored, *(self._plans.keys() - stored.keys())]:
            if self._revisions.get(name) != stored.get(name):
                with log_and_continue(log, f"plan {name}", except_for=StoreError):
                    await self._read(name)
        self._revisions = stored

    async def _read(self, name: str) -> None:
        plan = await self._context.database.read(find_plan, name)
        before = self._plans.pop(name, None)
        if plan is None:
            return
        if plan.state in ENDS:
            if before is not None:
                self.announce(await self._recalled(plan))
            return
        one = await self.add(plan, await self._context.database.read(load_stops, name))
        if before is not None:
            is_anew = plan.state is PlanState.REPLANNING is not before.plan.state
            one.seen_to = one.problem if is_anew else before.seen_to
        self.announce(one)

    async def add(self, plan: DrivenPlan, stops: Iterable[SentStop]) -> FollowedPlan:
        """Follow a plan whose ``stops`` are in queues."""
        one = self._plans[plan.name] = FollowedPlan(plan, progress_from(plan, stops))
        self._revisions[plan.name] = plan.revision
        await self.follow(one)
        return one

    def get(self, name: str) -> FollowedPlan:
        """Return a plan that is driven; raises RefusedError where there is none of that name."""
        if name not in self._plans:
            raise unknown_plan(name)
        return self._plans[name]

    def of_revision(self, name: str, revision: int) -> FollowedPlan:
        """Return a plan as :meth:`get`; raises OutdatedError where it is at another revision."""
        one = self.get(name)
        if revision != one.plan.revision:
            raise self.outdated(
                name, f"plan {name!r} is at revision {one.plan.revision}, not {revision}; look at it again"
            )
        return one

    def outdated(self, name: str, text: str) -> OutdatedError:
        """Return the refusal of a change, with the plan as it is."""
        return OutdatedError(text, to_json(self.get(name).report()))

    async def find(self, name: str) -> FollowedPlan | None:
        """Return a plan that is driven or has ended, None where there was none."""
        if name in self._plans:
            return self._plans[name]
        plan = await self._context.database.read(find_plan, name)
        return None if plan is None else await self._recalled(plan)

    async def newest_ended(self, limit: int) -> list[FollowedPlan]:
        """Return plans that ended, newest first."""
        plans = await self._context.database.read(newest_ended_plans, limit)
        return [await self._recalled(plan) for plan in plans]

    async def change(
        self, one: FollowedPlan, state: PlanState, by: str, reason: str | None, **more: Any
    ) -> PlanReport:
        """Store a plan in another state, and tell it; raises StoreError."""
        after = one.plan.changed(state, by, self._context.clock.time(), reason, **more)
        await self._context.database.run(save_plan, after)
        return self.accept(one, after)

    def accept(self, one: FollowedPlan, after: DrivenPlan) -> PlanReport:
        """Take over a plan that is stored as ``after``, and tell it."""
        one.plan = after
        if after.state in ENDS:
            self._plans.pop(after.name, None)
            self._revisions.pop(after.name, None)
        else:
            self._revisions[after.name] = after.revision
        self._events.publish(PlanChanged(after.name))
        return self.announce(one)

    def announce(self, one: FollowedPlan) -> PlanReport:
        """Tell operators of a plan."""
        report = one.report()
        self._listeners.announce("plan", one.plan.name, to_json(report))
        return report

    # --- what queues, robots and roads say ------------------------------------------------------------

    async def follow(self, one: FollowedPlan) -> bool:
        """Take in how the plan's queues, robots and roads are; false when nothing has changed."""
        await self._context.book.look_elsewhere(one.plan.staying)
        closed = None if self.planner is None else self.planner.closed
        present = [robot for robot in one.plan.staying if robot in self._context.robots]
        seen = [(robot, self.queue(robot), self._context.robots.get(robot).state) for robot in present]
        if one.seen is not None and _is_same(one.seen, (one.plan, closed, seen)):
            return False
        await self._take_in(one, {robot: queue for robot, queue, _ in seen})
        reports = {robot: queue_report(queue, state) for robot, queue, state in seen}
        behind = {id(stop) for stop in committed_stops(one.progress)}
        ways = await self.closed_ways(one.plan.document)
        ways = tuple(way for way in ways if id(way.at) not in behind)
        one.problem = problem_of(one.plan.document, one.progress, reports, ways)
        one.seen = (one.plan, closed, seen)
        return True

    async def closed_ways(self, document: ConePlan) -> tuple[ClosedWay, ...]:
        """Return the ways of a plan that lead along roads that are closed now."""
        closed = None if self.planner is None else self.planner.closed
        if closed is None or not closed.closures:
            return ()
        closures = {one.closure: one for one in self._closures.report().closures}
        return await asyncio.to_thread(ways_along_closed_roads, document, closed, closures)

    def queue(self, robot: str) -> Queue:
        """Return a robot's queue."""
        return self._context.book.get(robot)

    def has_failed(self, robot: str) -> bool:
        """Tell whether a task of a robot's queue has failed."""
        return any(task.state is TaskState.FAILED for task in self.queue(robot).tasks)

    def paused(self, plan: DrivenPlan) -> list[str]:
        """Return the robots of a plan that are heard, and have tasks in a queue that is paused."""
        robots = self._context.robots
        here = [robot for robot in plan.staying if robot in robots and robots.get(robot).state not in AWAY]
        return [
            robot
            for robot in here
            if self.queue(robot).state is QueueState.PAUSED and self.queue(robot).tasks
        ]

    def still_held(self, plan: DrivenPlan) -> list[str]:
        """Return the robots that are held for a plan, and by nobody else since."""
        return [
            robot
            for robot, at in plan.held.items()
            if robot in self._context.robots
            and self.queue(robot).state is QueueState.PAUSED
            and self.queue(robot).at == at
        ]

    async def _take_in(self, one: FollowedPlan, found: dict[str, Queue]) -> None:
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

    async def _recalled(self, plan: DrivenPlan) -> FollowedPlan:
        """Return a plan that ended, with what became of it."""
        stops = await self._context.database.read(load_stops, plan.name)
        one = FollowedPlan(plan, progress_from(plan, stops))
        await self._take_in(one, {})
        return one


def unknown_plan(name: str) -> RefusedError:
    """Return the refusal of what is asked of a plan that there is not."""
    return RefusedError(f"no plan {name!r} is driven; see get_plans")


def _is_same(before: Any, now: Any) -> bool:
    if before[0] is not now[0] or before[1] is not now[1] or len(before[2]) != len(now[2]):
        return False
    return all(a[1] is b[1] and a[2] is b[2] for a, b in zip(before[2], now[2], strict=True))
