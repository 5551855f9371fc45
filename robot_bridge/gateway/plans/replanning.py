"""Replanning the rest of a plan: its robots are held, the new plan is proposed, entered when confirmed."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, Protocol

import numpy as np

from ...core.assignment.clearance import ClearTravel, Floats, NearOrByRoad, meetings
from ...core.assignment.job import AssignmentJob, CancellableTravel, RoadTravel, StraightTravel, Travel
from ...core.assignment.plan import ConePlan, PlanSituation
from ...core.assignment.plan_changes import replan
from ...core.assignment.progress import current_stops, situation_of, standing_cones, tasks_of
from ...core.assignment.solver import Objective
from ...core.errors import (
    AssignmentCancelledError,
    AssignmentError,
    OutdatedError,
    RefusedError,
    RoadsError,
    StoreError,
)
from ...core.logs import log_unforeseen
from ...core.messages.base import MessageError
from ...core.messages.plans import MOST_CONES, PlanReport, PlanState
from ..commands.active_command import GATEWAY
from ..monitoring import BackgroundTasks
from ..queues.registry import TRIES, QueueContext
from ..queues.requests import QueueEditor, QueueEntries
from ..traffic.road_planning import RoadPlanner
from . import model
from .following import FollowedPlans, save_plan

log = logging.getLogger(__name__)

# --- Computing the plan of the rest, in a worker thread ---

Place = tuple[float, float]
PATIENCE = 5.0
"""factor on the requested seconds for planning in all: ways and the search are timed separately."""


@dataclass(frozen=True)
class ReplanGround:
    """Data for planning: ``placed`` cones, ``standing`` robots by name, roads; metres."""

    terms: model.PlanTerms
    placed: list[Place]
    standing: Mapping[str, Place]
    planner: RoadPlanner | None


class Replanning:
    """Computation of one plan of the rest; :meth:`run` is for a worker thread."""

    def __init__(self, plan: ConePlan, ground: ReplanGround, situation: PlanSituation) -> None:
        self._plan, self._ground, self._situation = plan, ground, situation
        self._cancelled = threading.Event()
        self._until = 0.0

    def cancel(self) -> None:
        """Make :meth:`run` end soon."""
        self._cancelled.set()

    def run(self) -> ConePlan:
        """Return the plan; raises AssignmentError, RoadsError and RefusedError when there is none."""
        seconds = self._ground.terms.seconds
        self._until = time.monotonic() + PATIENCE * seconds
        objective = Objective(self._plan.objective, time_limit_s=seconds)
        return replan(
            self._plan, self._travel, self._situation, objective, lambda share: self._may_continue()
        )

    def _travel(self, job: AssignmentJob) -> Travel:
        terms, planner = self._ground.terms, self._ground.planner
        travel: Travel = StraightTravel(job)
        router = planner.router_of_its_own() if planner is not None and terms.on_roads else None
        if router is not None:
            roads = RoadTravel(job, router, progress=lambda share: self._check())
            name = f"{roads.name}, straight within {terms.direct_m:g} m"
            travel = NearOrByRoad(travel, roads, terms.direct_m, name)
        cones = np.concatenate(
            [job.places[job.first_target :], _places(terms.stand), _places(self._ground.placed)]
        )
        robots = _places(list(self._ground.standing.values()))
        room = np.repeat([terms.clearance_m, terms.off_standing_m], [len(cones), len(robots)])
        clear = ClearTravel(travel, job.places, np.concatenate([cones, robots]), room)
        return CancellableTravel(clear, self._may_continue)

    def _may_continue(self) -> bool:
        return not self._cancelled.is_set() and time.monotonic() < self._until

    def _check(self) -> None:
        if not self._may_continue():
            raise AssignmentCancelledError("The plan of what is left took too long, or was given up.")


def count_meetings(plan: ConePlan, ground: ReplanGround) -> int:
    """Return how often robots come too near to one another in ``plan``; for a worker thread."""
    return len(meetings(plan, ground.terms.apart_m, ground.standing, ground.terms.off_standing_m))


def _places(places: Sequence[Place]) -> Floats:
    return np.array(places, dtype=np.float64).reshape(-1, 2)


# --- Holding the robots, proposing the plan, and confirming it ---


class Stops(Protocol):
    """State of emergency stops."""

    @property
    def in_force(self) -> bool:
        """Whether an emergency stop is in force."""


class _Making(NamedTuple):
    """Computation in progress for the rest of a plan, as of ``revision``."""

    planning: Replanning
    revision: int


class _Proposal(NamedTuple):
    """A plan of the rest, the number of near encounters of its robots, and of its ways on closed roads."""

    document: ConePlan
    meetings: int
    closed: int


class Replanner:
    """Replans the rest of plans; callers of :meth:`hold` and :meth:`confirm` hold the lock of ``plans``."""

    def __init__(
        self, context: QueueContext, editor: QueueEditor, plans: FollowedPlans, stops: Stops
    ) -> None:
        self._context = context
        self._editor = editor
        self._plans = plans
        self._stops = stops
        self._making: dict[str, _Making] = {}
        self._tasks = BackgroundTasks()

    async def hold(self, one: model.FollowedPlan, operator: str, *, try_again: bool) -> PlanReport:
        """Hold the robots of a plan, so that the leading gateway plans the rest.

        :raises RefusedError: when this is in progress already, or no robot is left; StoreError.
        """
        for _ in range(TRIES - 1):
            with contextlib.suppress(OutdatedError):
                return await self._hold(one, operator, try_again=try_again)
        return await self._hold(one, operator, try_again=try_again)

    async def _hold(self, one: model.FollowedPlan, operator: str, *, try_again: bool) -> PlanReport:
        await self._plans.follow(one)
        plan = one.plan
        if plan.state is PlanState.REPLANNING:
            raise RefusedError(f"plan {plan.name!r} is being planned again already")
        staying = [robot for robot in plan.staying if robot not in one.problem.away]
        if not staying:
            raise RefusedError(
                f"no robot of plan {plan.name!r} is left to take over; connect one, and plan anew"
            )
        why = "plan of what is left" + (f": {model.problem_in_words(one.problem)}" if one.problem else "")
        now = self._context.clock.time()
        held = {robot: at for robot, at in plan.held.items() if robot in self._plans.still_held(plan)}
        seen = {
            robot: queue
            for robot in staying
            if (queue := self._plans.queue(robot)).running or self._plans.has_failed(robot)
        }
        held |= {robot: now if queue.running else queue.at for robot, queue in seen.items()}
        after = plan.changed(
            PlanState.REPLANNING, operator, now, why, proposal=None, held=held, try_again=try_again
        )
        entries = QueueEntries(
            dict.fromkeys(seen),
            seen=seen,
            paused=list(seen),
            reason=why[: model.LONGEST_PAUSE_REASON],
            at=now,
        )
        await self._editor.enter(entries, operator, partial(save_plan, plan=after))
        one.seen_to = one.problem
        self._plans.accept(one, after)
        await self._plans.follow(one)
        return self._plans.announce(one)

    def begin(self, one: model.FollowedPlan) -> None:
        """Begin to plan the rest of a plan that is stored as REPLANNING, unless already begun."""
        plan, robots = one.plan, self._context.robots
        if plan.name in self._making:
            if self._making[plan.name].revision == plan.revision:
                return
            self.cancel(plan.name)
        places = {
            name: (pose.x, pose.y)
            for name in [*robots.commanded(), *robots.commanded_elsewhere()]
            if (pose := robots.get(name).pose) is not None
        }
        drive = set(plan.staying) - set(one.problem.away)
        standing = {name: place for name, place in places.items() if name not in drive}
        now = self._context.clock.time()
        situation = situation_of(
            plan.document, one.progress, places, one.problem, now, try_again=plan.try_again
        )
        ground = ReplanGround(plan.terms, standing_cones(one.progress), standing, self._plans.planner)
        making = _Making(Replanning(plan.document, ground, situation), plan.revision)
        self._making[plan.name] = making
        self._tasks.start(self._make(plan.name, making, ground))

    def cancel(self, plan: str) -> None:
        """Cancel the planning of the rest of a plan; its result is dropped."""
        if (making := self._making.pop(plan, None)) is not None:
            making.planning.cancel()

    async def confirm(self, one: model.FollowedPlan, operator: str, override: str | None) -> PlanReport:
        """Enter the tasks of the proposed plan in place of the remaining ones.

        :raises RefusedError: where there is no proposal, or its tasks cannot be entered; StoreError.
        """
        for _ in range(TRIES - 1):
            with contextlib.suppress(OutdatedError):
                return await self._confirm(one, operator, override)
        return await self._confirm(one, operator, override)

    async def _confirm(self, one: model.FollowedPlan, operator: str, override: str | None) -> PlanReport:
        await self._plans.follow(one)
        plan, progress = one.plan, one.progress
        proposal = model.check_proposal(plan, progress)
        tasks = tasks_of(proposal, plan.name, plan.terms.cones, under_way=current_stops(progress))
        away = [one.robot.id for one in proposal.robots if one.lost and one.robot.id in plan.staying]
        stops, gone = model.stops_of(proposal, tasks), model.superseded(progress, away)
        after = plan.changed(
            PlanState.DRIVEN,
            operator,
            self._context.clock.time(),
            plan.reason,
            document=proposal,
            proposal=None,
            held={},
        )
        away = [robot for robot in away if robot in self._context.robots]
        entries = QueueEntries(
            tasks,
            # A task that a robot has begun or done since is not given to another one.
            seen={robot: self._plans.queue(robot) for robot in (*tasks, *away)},
            resumed=self._plans.still_held(plan),
            away=away,
            withdrawn={task for task in gone if progress.stops[task].robot in away},
            reason="its robot is lost",
            override=override,
        )
        place = len(progress.stops) + plan.revision * MOST_CONES
        also = partial(save_plan, plan=after, new=stops, gone=gone, place=place)
        await self._editor.enter(entries, operator, also)
        progress.forget(gone)
        progress.sent(stops)
        one.seen = None
        self._plans.accept(one, after)
        await self._plans.follow(one)
        return self._plans.announce(one)

    async def finish(self) -> None:
        """Cancel all planning and wait for its end: the gateway ends."""
        # The plans stay stored as REPLANNING: the next gateway begins again.
        for plan in list(self._making):
            self.cancel(plan)
        await self._tasks.wait()

    async def _make(self, plan: str, making: _Making, ground: ReplanGround) -> None:
        try:
            document = await asyncio.to_thread(making.planning.run)
            meetings = await asyncio.to_thread(count_meetings, document, ground)
            closed = len(await self._plans.closed_ways(document))
        except (AssignmentError, RoadsError, RefusedError) as error:
            await self._made(plan, making, None, str(error))
        except Exception:
            # Else the robots would stay held without a reported reason.
            log_unforeseen(log, f"plan of what is left of {plan}")
            await self._made(plan, making, None, "it could not be planned; see the gateway's log")
        else:
            await self._made(plan, making, _Proposal(document, meetings, closed), None)

    async def _made(self, plan: str, making: _Making, proposal: _Proposal | None, why: str | None) -> None:
        try:
            async with self._plans.lock:
                if self._making.get(plan) is not making:
                    return
                await self._plans.refresh()
                self._making.pop(plan, None)
                one = self._plans.get(plan)
                if one.plan.revision != making.revision:
                    return
                if proposal is None:
                    reason = f"what is left could not be planned: {why}"
                    await self._plans.change(one, PlanState.PAUSED, GATEWAY, reason, held={})
                    return
                await self._propose(one, proposal)
        except (RefusedError, StoreError) as error:
            # It is stored as REPLANNING: the leading gateway plans again, unless an operator ended that.
            self._making.pop(plan, None)
            log.error("plan %s: %s", plan, error)

    async def _propose(self, one: model.FollowedPlan, proposal: _Proposal) -> None:
        """Store a proposal, and confirm it where that was chosen and it has no faults."""
        await self._plans.change(
            one,
            PlanState.PROPOSED,
            GATEWAY,
            one.plan.reason,
            proposal=proposal.document,
            meetings=proposal.meetings,
            closed=proposal.closed,
        )
        if one.plan.by_itself and not proposal.meetings and not proposal.closed and not self._stops.in_force:
            try:
                await self.confirm(one, GATEWAY, None)
            except (RefusedError, MessageError) as error:
                await self._plans.change(one, PlanState.PROPOSED, GATEWAY, str(error))
