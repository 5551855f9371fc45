"""Changes of plans: by hand, and replanning while they are driven."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

from ..errors import PlanEditError, counted
from .job import AssignmentJob, ConeTarget, PlanRobot, Travel
from .plan import ConePlan, LeftOut, PlanSituation, PlanStop, RobotPlan
from .pyvrp_search import Progress
from .schedules import Schedule, ScheduleEvaluator, plan_of
from .solver import Objective, assign

# --- Plans changed by hand: every change gives a new plan with loads, times and paths recomputed ---

TravelOf = Callable[[AssignmentJob], Travel]
"""Makes the ways between the places of a job, by roads or straight."""

Trips = list[list[list[str]]]
"""For each robot that is not lost its trips as ids of cones; trip 0 uses the cones aboard, and may be
empty."""


def job_of(plan: ConePlan) -> AssignmentJob:
    """Return the remaining job of ``plan``: without targets done or left out, and without lost robots."""
    gone = plan.done | {one.target.id for one in plan.left_out}
    return AssignmentJob(
        tuple(target for target in plan.targets if target.id not in gone),
        tuple(one.robot for one in plan.robots if not one.lost),
        plan.stores,
        plan.finish,
    )


def trips_of(plan: ConePlan) -> Trips:
    """Return which cones are served on which trip."""
    trips: Trips = []
    for one in plan.robots:
        if one.lost:
            continue
        rows: list[list[str]] = [[]]
        for stop in one.stops:
            if stop.is_target:
                rows[-1].append(stop.id)
            elif rows[-1] or len(rows) == 1:
                rows.append([])
        trips.append([rows[0], *(row for row in rows[1:] if row)])
    return trips


def move_target(
    plan: ConePlan, travel_of: TravelOf, target: str, robot: str, trip: int, place: int
) -> ConePlan:
    """Return the plan with ``target`` as number ``place``, from 0, of trip ``trip`` of ``robot``.

    Trip 0 uses the cones aboard at the start; one more than there are is a new trip.

    :raises PlanEditError: when that cannot be driven; ``plan`` stays unchanged.
    """
    trips = _without(plan, target)
    names = [one.robot.id for one in plan.robots if not one.lost]
    if robot not in names:
        raise PlanEditError(f"There is no robot {robot} in the plan, or it is lost: choose another.")
    day = trips[names.index(robot)]
    if not 0 <= trip <= len(day):
        raise PlanEditError(f"Robot {robot} has no trip {trip}: choose 0 to {len(day)}.")
    if trip == len(day):
        day.append([])
    if not 0 <= place <= len(day[trip]):
        raise PlanEditError(
            f"Trip {trip} of robot {robot} has no place {place}: choose 0 to {len(day[trip])}."
        )
    day[trip].insert(place, target)
    return plan_with_trips(plan, travel_of, trips)


def remove_target(
    plan: ConePlan, travel_of: TravelOf, target: str, reason: str = "taken out by hand"
) -> ConePlan:
    """Return the plan in which no robot serves ``target``.

    :raises PlanEditError: when it is not among the open targets.
    """
    trips = _without(plan, target)
    out = LeftOut(_target(plan, target), reason)
    return plan_with_trips(replace(plan, left_out=(*plan.left_out, out)), travel_of, trips)


def reorder_trip(
    plan: ConePlan, travel_of: TravelOf, robot: str, trip: int, targets: Sequence[str]
) -> ConePlan:
    """Return the plan in which ``robot`` serves the cones of its trip ``trip`` in the order ``targets``.

    :raises PlanEditError: when these are not the cones of that trip, or the order cannot be driven.
    """
    trips = trips_of(plan)
    names = [one.robot.id for one in plan.robots if not one.lost]
    if robot not in names or not 0 <= trip < len(trips[names.index(robot)]):
        raise PlanEditError(f"There is no trip {trip} of robot {robot}: choose one that the plan has.")
    day = trips[names.index(robot)]
    if sorted(day[trip]) != sorted(targets):
        raise PlanEditError(
            f"Trip {trip} of robot {robot} has the cones {', '.join(day[trip])}: order these."
        )
    day[trip] = list(targets)
    return plan_with_trips(plan, travel_of, trips)


def plan_with_trips(plan: ConePlan, travel_of: TravelOf, trips: Trips) -> ConePlan:
    """Return ``plan`` with ``trips`` instead of its own, as :func:`trips_of` returns them.

    :raises PlanEditError: naming the robot, the trip and the obstacle to it.
    """
    job = job_of(plan)
    travel = travel_of(job)
    days = ScheduleEvaluator(job, travel.metres)
    rows: list[Schedule] = [[[job.place_of[name] for name in row] for row in day] for day in trips]
    rows = [[day[0], *(row for row in day[1:] if row)] for day in rows]
    _check_room(job, days, rows)
    _set_gates(job, days, rows)
    _check_ways(job, days, rows)
    made = plan_of(days, travel, rows, plan.objective, plan.method)
    changed = {one.robot.id: one for one in made.robots}
    robots = tuple(
        one if one.lost else replace(one, trips=changed[one.robot.id].trips) for one in plan.robots
    )
    return replace(plan, robots=robots, travel=travel.name)


def _without(plan: ConePlan, target: str) -> Trips:
    trips = trips_of(plan)
    if target in plan.done:
        raise PlanEditError(f"Cone {target} is done already: choose one that is to come.")
    for day in trips:
        for row in day:
            if target in row:
                row.remove(target)
                return trips
    raise PlanEditError(f"No robot serves cone {target} in this plan: choose one that is in it.")


def _target(plan: ConePlan, name: str) -> ConeTarget:
    return next(target for target in plan.targets if target.id == name)


def _check_room(job: AssignmentJob, days: ScheduleEvaluator, rows: Sequence[Schedule]) -> None:
    for robot, day in enumerate(rows):
        one = job.robots[robot]
        for number, row in enumerate(day):
            if days.fits(robot, row, first=number == 0):
                continue
            names = ", ".join(job.target(place).id for place in row)
            if number == 0:
                what = f"before its first visit to a store: it has {counted(one.aboard, 'cone')} aboard"
            else:
                what = f"on trip {number}: it has room for {one.capacity}"
            raise PlanEditError(
                f"Robot {one.id} cannot serve {names} {what}. Give it fewer, or another trip."
            )
        if any(day[1:]) and not job.stores:
            raise PlanEditError(f"Robot {one.id} has nowhere to load: there is no store in this plan.")


def _set_gates(job: AssignmentJob, days: ScheduleEvaluator, rows: Sequence[Schedule]) -> None:
    """Compute when each stage may begin; a day must not return to an earlier stage."""
    for robot, day in enumerate(rows):
        stages = [days.stage[place] for row in day for place in row]
        if stages != sorted(stages):
            raise PlanEditError(
                f"Robot {job.robots[robot].id} would serve a cone of a later stage before one of an earlier: "
                "keep the stages in their order."
            )
    for stage in job.stages[:-1]:
        ends = [
            days.cost(robot, part).served_s
            for robot, day in enumerate(rows)
            if any(part := [[place for place in row if days.stage[place] <= stage] for row in day])
        ]
        for later in job.stages:
            if later > stage and ends:
                days.gates[later] = max(ends)


def _check_ways(job: AssignmentJob, days: ScheduleEvaluator, rows: Sequence[Schedule]) -> None:
    for robot, day in enumerate(rows):
        name = job.robots[robot].id
        tour = [robot, *days.tour(robot, day)]
        legs = [(days.metres[a][b], b) for a, b in pairwise(tour)]
        for metres, place in legs:
            if math.isinf(metres):
                raise PlanEditError(f"No way leads robot {name} to {job.name(place)}: give it another one.")
        total = sum(metres for metres, _ in legs)
        if total > job.robots[robot].range_m:
            raise PlanEditError(
                f"Robot {name} would drive {total:.0f} m and has battery for "
                f"{job.robots[robot].range_m:.0f} m: give it fewer cones."
            )


# --- Replanning while plans are driven: done stops stay, the rest is shared out again ---


def replan(
    plan: ConePlan,
    travel_of: TravelOf,
    situation: PlanSituation,
    objective: Objective | None = None,
    progress: Progress | None = None,
) -> ConePlan:
    """Return the plan from now on: done stops are kept, the rest is shared out among the remaining robots.

    :raises JobError: when no robot is left; UnservedError, MissingSolverError and CancelledError as
        :func:`~.solver.assign` does. ``plan`` stays unchanged.
    """
    robots = tuple(_from_now_on(one, situation) for one in plan.robots)
    known = {one.target.id for one in plan.left_out}
    failed = tuple(
        LeftOut(target, situation.failed[target.id])
        for target in plan.targets
        if target.id in situation.failed and target.id not in situation.done | known
    )
    so_far = replace(plan, robots=robots, left_out=(*plan.left_out, *failed))
    job = job_of(so_far)
    made = assign(job, travel_of(job), objective or Objective(plan.objective), progress)
    replanned = {one.robot.id: one.trips for one in made.robots}
    return replace(
        so_far,
        robots=tuple(replace(one, trips=replanned.get(one.robot.id, ())) for one in robots),
        objective=made.objective,
        method=made.method,
        travel=made.travel,
    )


def expected_situation(plan: ConePlan, now_s: float) -> PlanSituation:
    """Return the situation at ``now_s`` if everything has gone by the plan."""
    done = {stop.id for _, stop in plan.all_stops() if stop.is_target and stop.end_s <= now_s}
    robots = {one.robot.id: _by_plan(one, now_s) for one in plan.robots if not one.lost}
    return PlanSituation(now_s, frozenset(done | plan.done), robots=robots)


def _from_now_on(one: RobotPlan, situation: PlanSituation) -> RobotPlan:
    lost = one.lost or one.robot.id in situation.lost
    passed = _passed(one, situation)
    robot = situation.robots.get(one.robot.id) or _by_plan(one, situation.now_s)
    if not lost:
        robot = replace(robot, ready_s=max(robot.ready_s, situation.now_s))
    # The earlier plan counted a robot's task in progress as done; a robot lost during it has not done it.
    done = [stop for stop in one.done if not stop.is_target or stop.id in situation.done]
    return RobotPlan(robot, (), (*done, *passed), lost)


def _passed(one: RobotPlan, situation: PlanSituation) -> tuple[PlanStop, ...]:
    """Return the completed stops of the robot: cones done, and stores visited by its plan."""
    stops, done = one.stops, situation.done
    last = max((k for k, stop in enumerate(stops) if stop.is_target and stop.id in done), default=-1)
    return tuple(
        stop
        for k, stop in enumerate(stops)
        if (stop.id in done if stop.is_target else k < last or stop.arrival_s <= situation.now_s)
    )


def _by_plan(one: RobotPlan, now_s: float) -> PlanRobot:
    """Return the robot as it is at ``now_s`` by its plan: on its way, or where it stops."""
    robot = one.robot
    x, y, metres, aboard, collected, ready = robot.x, robot.y, 0.0, robot.aboard, robot.collected, now_s
    clock = robot.ready_s
    for stop in one.stops:
        if stop.arrival_s > now_s:
            driven = max(now_s - clock, 0.0) * robot.speed
            x, y = _along(stop, driven)
            metres += min(driven, stop.metres)
            break
        x, y, clock = stop.x, stop.y, stop.end_s
        metres += stop.metres
        if stop.end_s > now_s and stop.is_target:
            # A begun stop counts as done only at its end: the cone is still aboard.
            break
        aboard, collected = stop.aboard, stop.collected
        ready = max(now_s, stop.end_s)
    left = robot.range_m - metres if math.isfinite(robot.range_m) else robot.range_m
    return replace(
        robot, x=x, y=y, range_m=max(left, 0.0), aboard=aboard, collected=collected,
        ready_s=max(ready, robot.ready_s),
    )  # fmt: skip


def _along(stop: PlanStop, metres: float) -> tuple[float, float]:
    left = metres
    for a, b in pairwise(stop.path):
        step = math.dist(a, b)
        if step >= left:
            share = left / step if step > 0 else 0.0
            return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
        left -= step
    return stop.path[-1]
