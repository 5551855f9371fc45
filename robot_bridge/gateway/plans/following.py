"""Followed plans: the state of each by queues, robots, roads and the database; changes are stored first.

The outcome of a plan's tasks is derived from the queues and the stored state, never from received messages:
a gateway that was killed, or another one, continues every plan where it stopped.
"""

from __future__ import annotations

import asyncio
import dataclasses
import json
import logging
from collections.abc import Collection, Iterable, Sequence
from typing import Any

from sqlalchemy import Connection, delete, insert, select, update

from ...core.assignment.plan import ConePlan, plan_from_json, plan_to_json, stop_document, stop_of_document
from ...core.assignment.progress import ClosedWay, ConeFacts, SentStop, committed_stops, problem_of
from ...core.errors import OutdatedError, PlanFileError, RefusedError, StoreError
from ...core.json_decoder import DOCUMENT, decode_json
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
from ..storage.rows import readable
from ..storage.schema import plan_stops, plans
from ..traffic.closures import ClosureService
from ..traffic.road_planning import RoadPlanner
from .model import ENDS, DrivenPlan, FollowedPlan, PlanTerms, progress_from, ways_along_closed_roads

# --- Plans in the database: each is written whole when it changes, with the stops in queues ---

_ENDED = [state.value for state in ENDS]


class PlanMovedError(RefusedError):
    """A stored plan is not as assumed: another gateway has changed it. Nothing is written."""


# Built once: it runs twice a second.
_OPEN_REVISIONS = (
    select(plans.c.name, plans.c.revision).where(plans.c.state.not_in(_ENDED)).order_by(plans.c.submitted_at)
)


def open_revisions(connection: Connection) -> dict[str, int]:
    """Return the revision of each plan that is driven, the oldest plan first."""
    return dict(connection.execute(_OPEN_REVISIONS).all())


def find_plan(connection: Connection, name: str) -> DrivenPlan | None:
    """Return one plan, driven or ended."""
    return next(iter(_read(connection, select(plans).where(plans.c.name == name))), None)


def newest_ended_plans(connection: Connection, limit: int) -> list[DrivenPlan]:
    """Return the plans that ended, newest first."""
    query = select(plans).where(plans.c.state.in_(_ENDED)).order_by(plans.c.ended_at.desc()).limit(limit)
    return _read(connection, query)


def load_stops(connection: Connection, name: str) -> list[SentStop]:
    """Return the stops of a plan in the order in which they were sent."""
    query = select(plan_stops).where(plan_stops.c.plan == name).order_by(plan_stops.c.place)
    return list(readable(connection.execute(query).mappings(), _stop, lambda row: f"stop {row['task']}"))


def add_plan(
    connection: Connection, plan: DrivenPlan, stops: Sequence[SentStop], beside: Collection[str]
) -> None:
    """Write a new plan with its stops.

    :raises PlanMovedError: when other plans are driven by now than those in ``beside``, or it is stored
        already: nothing may be written then.
    """
    if not open_revisions(connection).keys() <= {*beside}:
        raise PlanMovedError("another plan was submitted meanwhile; look at the plans again")
    save_plan(connection, plan, stops)


def save_plan(
    connection: Connection,
    plan: DrivenPlan,
    new: Sequence[SentStop] = (),
    gone: Sequence[str] = (),
    place: int = 0,
) -> None:
    """Write a plan, its ``new`` stops from ``place`` on, and delete the stops of the tasks ``gone``.

    :raises PlanMovedError: when the stored revision is not the one before: nothing may be written then.
    """
    found = connection.scalar(select(plans.c.revision).where(plans.c.name == plan.name).with_for_update())
    if found != (plan.revision - 1 or None):
        raise PlanMovedError(f"plan {plan.name!r} was changed meanwhile; look at it again")
    if found is None:
        connection.execute(insert(plans).values(name=plan.name, **_row(plan)))
    else:
        connection.execute(update(plans).where(plans.c.name == plan.name).values(_row(plan)))
    for begin in range(0, len(gone), 500):
        connection.execute(delete(plan_stops).where(plan_stops.c.task.in_(gone[begin : begin + 500])))
    rows = [
        {
            "task": one.task,
            "plan": plan.name,
            "robot": one.robot,
            "place": place + k,
            "number": one.number,
            "content": json.dumps(stop_document(one.stop)),
        }
        for k, one in enumerate(new)
    ]
    if rows:
        connection.execute(insert(plan_stops), rows)


def _read(connection: Connection, query: Any) -> list[DrivenPlan]:
    rows: Iterable[Any] = connection.execute(query).mappings()
    return list(readable(rows, _plan, lambda row: f"plan {row['name']}"))


def _row(plan: DrivenPlan) -> dict[str, Any]:
    return {
        "revision": plan.revision,
        "state": plan.state.value,
        "submitted_by": plan.submitted_by,
        "submitted_at": plan.submitted_at,
        "by_itself": int(plan.by_itself),
        "content": json.dumps(dataclasses.asdict(plan.terms)),
        "document": plan_to_json(plan.document),
        "proposal": None if plan.proposal is None else plan_to_json(plan.proposal),
        "held": json.dumps(dict(plan.held)),
        "reason": plan.reason,
        "by": plan.by,
        "at": plan.at,
        "ended_at": plan.ended_at,
        "try_again": int(plan.try_again),
        "meetings": plan.meetings,
        "closed": plan.closed,
    }


def _document(text: str) -> ConePlan:
    try:
        return plan_from_json(text)
    except PlanFileError as error:
        raise ValueError(str(error)) from error


def _plan(row: Any) -> DrivenPlan:
    content = decode_json(row["content"], DOCUMENT)
    cones = {name: ConeFacts(**facts) for name, facts in content.pop("cones").items()}
    stand = [(x, y) for x, y in content.pop("stand")]
    return DrivenPlan(
        name=row["name"],
        document=_document(row["document"]),
        terms=PlanTerms(cones, stand, **content),
        submitted_by=row["submitted_by"],
        submitted_at=row["submitted_at"],
        by_itself=bool(row["by_itself"]),
        state=PlanState(row["state"]),
        revision=row["revision"],
        proposal=None if row["proposal"] is None else _document(row["proposal"]),
        held=decode_json(row["held"], DOCUMENT),
        reason=row["reason"],
        by=row["by"],
        at=row["at"],
        ended_at=row["ended_at"],
        try_again=bool(row["try_again"]),
        meetings=row["meetings"],
        closed=row["closed"],
    )


def _stop(row: Any) -> SentStop:
    try:
        stop = stop_of_document(decode_json(row["content"], DOCUMENT))
    except PlanFileError as error:
        raise ValueError(str(error)) from error
    return SentStop(row["robot"], row["number"], stop, row["task"])


# --- Followed plans ---

log = logging.getLogger(__name__)

MOST_PLACED = 5000


class FollowedPlans:
    """The plans that robots drive, by name; :attr:`lock` must be held to change one.

    Other gateways may change them, too: :meth:`refresh` reads that, and a change of a plan that was changed
    there since is refused with PlanMovedError. PlanChanged is published for changes stored here.
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
        """revision of each driven plan as last read or stored."""

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

    async def refresh(self) -> None:
        """Apply what an earlier gateway, or others, submitted, changed and ended; raises StoreError."""
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
            is_new = plan.state is PlanState.REPLANNING is not before.plan.state
            one.seen_to = one.problem if is_new else before.seen_to
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
        """Return the refusal of a change, with the present plan."""
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
        """Store a plan in another state, and report it; raises StoreError."""
        after = one.plan.changed(state, by, self._context.clock.time(), reason, **more)
        await self._context.database.run(save_plan, after)
        return self.accept(one, after)

    def accept(self, one: FollowedPlan, after: DrivenPlan) -> PlanReport:
        """Apply the stored plan ``after``, and report it."""
        one.plan = after
        if after.state in ENDS:
            self._plans.pop(after.name, None)
            self._revisions.pop(after.name, None)
        else:
            self._revisions[after.name] = after.revision
        self._events.publish(PlanChanged(after.name))
        return self.announce(one)

    def announce(self, one: FollowedPlan) -> PlanReport:
        """Report a plan to operators."""
        report = one.report()
        self._listeners.announce("plan", one.plan.name, to_json(report))
        return report

    # --- state of queues, robots and roads ------------------------------------------------------------

    async def follow(self, one: FollowedPlan) -> bool:
        """Update the plan from its queues, robots and roads; return false when nothing has changed."""
        await self._context.registry.read_elsewhere(one.plan.staying)
        closed = None if self.planner is None else self.planner.closed
        present = [robot for robot in one.plan.staying if robot in self._context.robots]
        seen = [(robot, self.queue(robot), self._context.robots.get(robot).state) for robot in present]
        if one.seen is not None and _is_same(one.seen, (one.plan, closed, seen)):
            return False
        await self._update_progress(one, {robot: queue for robot, queue, _ in seen})
        reports = {robot: queue_report(queue, state) for robot, queue, state in seen}
        behind = {id(stop) for stop in committed_stops(one.progress)}
        ways = await self.closed_ways(one.plan.document)
        ways = tuple(way for way in ways if id(way.at) not in behind)
        one.problem = problem_of(one.plan.document, one.progress, reports, ways)
        one.seen = (one.plan, closed, seen)
        return True

    async def closed_ways(self, document: ConePlan) -> tuple[ClosedWay, ...]:
        """Return the ways of a plan along roads that are closed now."""
        closed = None if self.planner is None else self.planner.closed
        if closed is None or not closed.closures:
            return ()
        closures = {one.closure: one for one in self._closures.report().closures}
        return await asyncio.to_thread(ways_along_closed_roads, document, closed, closures)

    def queue(self, robot: str) -> Queue:
        """Return a robot's queue."""
        return self._context.registry.get(robot)

    def has_failed(self, robot: str) -> bool:
        """Return whether a task of a robot's queue has failed."""
        return any(task.state is TaskState.FAILED for task in self.queue(robot).tasks)

    def paused(self, plan: DrivenPlan) -> list[str]:
        """Return the robots of a plan that are connected, and have tasks in a paused queue."""
        robots = self._context.robots
        here = [robot for robot in plan.staying if robot in robots and robots.get(robot).state not in AWAY]
        return [
            robot
            for robot in here
            if self.queue(robot).state is QueueState.PAUSED and self.queue(robot).tasks
        ]

    def still_held(self, plan: DrivenPlan) -> list[str]:
        """Return the robots that are held for a plan, with no other pause since."""
        return [
            robot
            for robot, at in plan.held.items()
            if robot in self._context.robots
            and self.queue(robot).state is QueueState.PAUSED
            and self.queue(robot).at == at
        ]

    async def _update_progress(self, one: FollowedPlan, found: dict[str, Queue]) -> None:
        """Update the progress from queues and the database."""
        progress = one.progress
        for robot, queue in found.items():
            progress.apply_queue(queue_report(queue, self._context.robots.get(robot).state))
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
            progress.apply_placement(report)

    async def _recalled(self, plan: DrivenPlan) -> FollowedPlan:
        """Return an ended plan with its outcome."""
        stops = await self._context.database.read(load_stops, plan.name)
        one = FollowedPlan(plan, progress_from(plan, stops))
        await self._update_progress(one, {})
        return one


def unknown_plan(name: str) -> RefusedError:
    """Return the refusal of a request on a plan that does not exist."""
    return RefusedError(f"no plan {name!r} is driven; see get_plans")


def _is_same(before: Any, now: Any) -> bool:
    if before[0] is not now[0] or before[1] is not now[1] or len(before[2]) != len(now[2]):
        return False
    return all(a[1] is b[1] and a[2] is b[2] for a, b in zip(before[2], now[2], strict=True))
