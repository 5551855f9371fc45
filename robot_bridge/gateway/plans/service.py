"""Service of cone plans: submitted, followed, paused and resumed, cleared, and replanned."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import AsyncIterator, Sequence
from functools import partial
from typing import Protocol

from ...core.assignment.plan import ConePlan
from ...core.assignment.progress import tasks_of
from ...core.errors import BridgeError, OutdatedError, RefusedError, StoreError
from ...core.logs import log_and_continue
from ...core.messages.plans import (
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
from ...core.messages.queues import PauseQueue
from ..commands.active_command import GATEWAY
from ..model.events import EventBus, Listeners, handles
from ..queues.registry import TRIES, QueueContext
from ..queues.requests import QueueEditor, QueueEntries
from ..traffic.closures import ClosureService
from .following import FollowedPlans, PlanMovedError, add_plan, save_plan, unknown_plan
from .model import LONGEST_PAUSE_REASON, DrivenPlan, FollowedPlan, PlanTerms, plan_in, stops_of
from .replanning import Replanner, Stops

log = logging.getLogger(__name__)

MOST_PLANS = 50
"""most plans that are driven at the same time."""


class Leadership(Protocol):
    """Leadership: whether this gateway does the work that must be done once per database."""

    @property
    def leads(self) -> bool:
        """Whether this gateway leads."""


class SoleLeadership:
    """Leadership of the only gateway on a database."""

    leads = True


class PlanService:
    """The plans that robots drive. Each method returns when its change is stored.

    Operators may send requests to any gateway of the fleet. The leading one does the automatic steps of
    plans; when it dies another one continues from the stored state.
    """

    def __init__(
        self,
        context: QueueContext,
        editor: QueueEditor,
        closures: ClosureService,
        stops: Stops,
        listeners: Listeners,
        events: EventBus,
        leadership: Leadership | None = None,
    ) -> None:
        self._context = context
        self._editor = editor
        self._stops = stops
        self._leadership = leadership or SoleLeadership()
        self._plans = FollowedPlans(context, closures, listeners, events)
        self._replanner = Replanner(context, editor, self._plans, stops)
        self._began = context.clock.steady()

    async def restore(self) -> None:
        """Continue the plans that an earlier gateway left."""
        async with self._plans.lock:
            await self._plans.refresh()
            for one in self._plans.all():
                self._keep_planning(one)

    @handles(SubmitPlan)
    async def submit(self, request: SubmitPlan, operator: str) -> PlanReport:
        """Enter all tasks of a plan, and follow it; a repetition changes nothing.

        :raises MessageError: for a document that is no plan; RefusedError and OutdatedError for tasks that
            cannot be entered, and StoreError. Nothing is entered then.
        """
        document = await asyncio.to_thread(plan_in, request)
        async with self._plans.lock:
            for _ in range(TRIES - 1):
                # Another gateway may have entered a plan since they were read.
                with contextlib.suppress(PlanMovedError):
                    return await self._enter(request, document, operator)
            return await self._enter(request, document, operator)

    async def _enter(self, request: SubmitPlan, document: ConePlan, operator: str) -> PlanReport:
        await self._plans.refresh()
        if (known := await self._plans.find(request.plan)) is not None:
            return known.report()
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
            resumed=[robot for robot, theirs in tasks.items() if theirs],
            override=request.override,
        )
        also = partial(add_plan, plan=plan, stops=stops, beside=self._plans.names())
        try:
            await self._editor.enter(entries, operator, also)
        except (OutdatedError, StoreError):
            # Of two simultaneous requests at two gateways, one has entered it.
            await self._plans.refresh()
            if request.plan not in self._plans:
                raise
            return self._plans.get(request.plan).report()
        return self._plans.accept(await self._plans.add(plan, stops), plan)

    @handles(GetPlans)
    async def read(self, request: GetPlans) -> Plans:
        """Return the present plans; raises RefusedError for an unknown one."""
        async with self._plans.lock:
            await self._plans.refresh()
        if request.plan is not None:
            one = await self._plans.find(request.plan)
            if one is None:
                raise unknown_plan(request.plan)
            return Plans([one.report(documents=request.documents)])
        ended = await self._plans.newest_ended(request.ended)
        # Driven plans are read last, so that no newer report of one can be sent before this answer.
        followed = [*self._plans.all(), *(one for one in ended if one.plan.name not in self._plans)]
        return Plans([one.report(documents=request.documents) for one in followed])

    @handles(PausePlan)
    async def pause(self, request: PausePlan, operator: str) -> PlanReport:
        """Pause the robots' queues first, then store the plan as paused."""
        if request.plan not in self._plans:
            async with self._plans.lock:
                await self._plans.refresh()
        one = self._plans.get(request.plan)
        why = f"plan {request.plan}" + (f": {request.reason}" if request.reason else "")
        failed: list[BridgeError] = []
        for robot in one.plan.staying:
            if robot in self._context.robots:
                try:
                    await self._editor.pause(PauseQueue(robot, why[:LONGEST_PAUSE_REASON]), operator)
                except BridgeError as error:
                    # The others must stand all the same.
                    failed.append(error)
        if failed:
            raise failed[0]
        # A pause is never refused, whatever another gateway has changed in the plan meanwhile.
        for _ in range(TRIES - 1):
            with contextlib.suppress(OutdatedError):
                return await self._record_pause(request, operator)
        return await self._record_pause(request, operator)

    async def _record_pause(self, request: PausePlan, operator: str) -> PlanReport:
        async with self._changing(request.plan) as one:
            self._replanner.cancel(request.plan)
            return await self._plans.change(
                one, PlanState.PAUSED, operator, request.reason, proposal=None, held={}
            )

    @handles(ResumePlan)
    async def resume(self, request: ResumePlan, operator: str) -> PlanReport:
        """Resume the paused robots."""
        async with self._changing(request.plan, request.revision) as one:
            self._check_no_emergency()
            if one.plan.state not in (PlanState.PAUSED, PlanState.DRIVEN):
                raise RefusedError(
                    f"plan {request.plan!r} is {one.plan.state.value}; confirm or discard that first"
                )
            robots = [robot for robot in self._plans.paused(one.plan) if not self._plans.has_failed(robot)]
            if not robots and one.plan.state is PlanState.DRIVEN:
                raise RefusedError(
                    f"no queue of plan {request.plan!r} is paused, or a plan of what is left is needed"
                )
            return await self._resume(one, robots, operator)

    @handles(Replan)
    async def replan(self, request: Replan, operator: str) -> PlanReport:
        """Hold the robots and begin to plan the rest."""
        async with self._changing(request.plan, request.revision) as one:
            self._check_no_emergency()
            report = await self._replanner.hold(one, operator, try_again=request.try_again)
            self._keep_planning(one)
            return report

    @handles(ConfirmReplan)
    async def confirm(self, request: ConfirmReplan, operator: str) -> PlanReport:
        """Enter the tasks of the proposed plan in place of the remaining ones."""
        async with self._changing(request.plan, request.revision) as one:
            self._check_no_emergency()
            return await self._replanner.confirm(one, operator, request.override)

    @handles(DiscardReplan)
    async def discard(self, request: DiscardReplan, operator: str) -> PlanReport:
        """Discard the plan of the rest; robots held for it continue."""
        async with self._changing(request.plan, request.revision) as one:
            self._check_no_emergency()
            if one.plan.state not in (PlanState.REPLANNING, PlanState.PROPOSED):
                raise RefusedError(
                    f"plan {request.plan!r} has no plan of what is left; there is nothing to discard"
                )
            self._replanner.cancel(request.plan)
            return await self._resume(one, self._plans.still_held(one.plan), operator)

    @handles(ClearPlan)
    async def clear(self, request: ClearPlan, operator: str) -> PlanReport:
        """Stop following a plan; its tasks stay in the queues."""
        async with self._plans.lock:
            await self._plans.refresh()
            if request.plan not in self._plans and (known := await self._plans.find(request.plan)):
                return known.report()
        async with self._changing(request.plan) as one:
            self._replanner.cancel(request.plan)
            await self._plans.follow(one)
            return await self._plans.change(one, PlanState.CLEARED, operator, None, proposal=None, held={})

    @property
    def goes_on(self) -> bool:
        """Whether there are plans: they progress with their robots."""
        return bool(self._plans.all())

    async def follow(self) -> None:
        """Follow all plans; called twice a second. Raises StoreError."""
        async with self._plans.lock:
            await self._plans.refresh()
        for one in self._plans.all():
            # An unforeseen error in one plan must not prevent following the others.
            with log_and_continue(log, f"plan {one.plan.name}", except_for=StoreError):
                async with self._plans.lock:
                    if one.plan.name in self._plans:
                        await self._check(self._plans.get(one.plan.name))

    async def finish(self) -> None:
        """Cancel all planning: the gateway ends."""
        await self._replanner.finish()

    # --- following ------------------------------------------------------------------------------------

    async def _check(self, one: FollowedPlan) -> None:
        if not self._leadership.leads:
            self._replanner.cancel(one.plan.name)
            if await self._plans.follow(one):
                self._plans.announce(one)
            return
        with contextlib.suppress(PlanMovedError):
            await self._carry_on(one)

    async def _carry_on(self, one: FollowedPlan) -> None:
        self._keep_planning(one)
        if self._stops.in_force and (one.plan.by_itself or one.plan.state is PlanState.DRIVEN):
            # Nothing continues by itself after an emergency stop: an operator must resume.
            state = PlanState.PAUSED if one.plan.state is PlanState.DRIVEN else one.plan.state
            await self._plans.change(one, state, GATEWAY, "an emergency stop", by_itself=False)
        plan = one.plan
        if await self._plans.follow(one):
            queued = {task.id for robot in plan.staying for task in self._plans.queue(robot).tasks}
            if one.progress.is_finished(plan.document) and not queued & one.progress.stops.keys():
                await self._plans.change(one, PlanState.FINISHED, GATEWAY, None, proposal=None, held={})
                return
            self._plans.announce(one)
        new = bool(one.problem) and one.problem != one.seen_to
        if plan.by_itself and plan.state is PlanState.DRIVEN and new and not self._is_settling():
            before, one.seen_to = one.seen_to, one.problem
            try:
                await self._replanner.hold(one, GATEWAY, try_again=False)
                self._keep_planning(one)
            except (OutdatedError, PlanMovedError):
                # Its queues change all the time, or another gateway was first: it is checked again.
                one.seen_to = before
            except RefusedError as error:
                await self._plans.change(one, PlanState.DRIVEN, GATEWAY, str(error))

    def _keep_planning(self, one: FollowedPlan) -> None:
        """Plan the rest of a plan while it is stored as REPLANNING, and only then."""
        if self._leadership.leads and one.plan.state is PlanState.REPLANNING:
            self._replanner.begin(one)
        else:
            self._replanner.cancel(one.plan.name)

    def _is_settling(self) -> bool:
        """Return whether the gateway has just begun: robots that drive on may not have reported yet."""
        return self._context.clock.steady() < self._began + self._context.site.report.lost_after

    # --- small parts ----------------------------------------------------------------------------------

    @contextlib.asynccontextmanager
    async def _changing(self, name: str, revision: int | None = None) -> AsyncIterator[FollowedPlan]:
        """Hold the lock with a plan as stored, at a ``revision`` if one is given.

        :raises OutdatedError: where it is at another one, or is changed at another gateway meanwhile;
            RefusedError where it is not driven, and StoreError.
        """
        async with self._plans.lock:
            await self._plans.refresh()
            one = self._plans.get(name) if revision is None else self._plans.of_revision(name, revision)
            await self._context.registry.read_elsewhere(one.plan.staying)
            try:
                yield one
            except PlanMovedError as error:
                await self._plans.refresh()
                raise self._plans.outdated(name, str(error)) from None

    async def _resume(self, one: FollowedPlan, robots: Sequence[str], operator: str) -> PlanReport:
        now = self._context.clock.time()
        after = one.plan.changed(PlanState.DRIVEN, operator, now, None, proposal=None, held={})
        entries = QueueEntries(dict.fromkeys(robots), resumed=robots)
        await self._editor.enter(entries, operator, partial(save_plan, plan=after))
        self._replanner.cancel(after.name)
        return self._plans.accept(one, after)

    def _check_no_emergency(self) -> None:
        if self._stops.in_force:
            raise RefusedError("an emergency stop is in force; it has to be cleared first")

    def _check_free(self, document: ConePlan) -> None:
        if len(self._plans) >= MOST_PLANS:
            raise RefusedError(f"{MOST_PLANS} plans are driven already; clear one of them first")
        for robot in (one.robot.id for one in document.robots if not one.lost and one.stops):
            self._context.robots.check_known(robot)
            for other in self._plans.all():
                if robot in other.plan.staying:
                    raise RefusedError(
                        f"robot {robot!r} drives plan {other.plan.name!r}; clear that first, or leave it out"
                    )
