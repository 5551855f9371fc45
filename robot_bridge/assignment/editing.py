"""Plans changed by hand: every change gives another plan with its loads, times and paths made anew."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

from ..counting import counted
from .days import Day, Days
from .errors import EditError
from .job import Job, Target
from .plan import LeftOut, Plan
from .timetable import plan_of
from .travel import Travel

TravelOf = Callable[[Job], Travel]
"""Makes the ways between the places of a job, by roads or straight."""

Trips = list[list[list[str]]]
"""For each robot that is not lost its trips as ids of cones; trip 0 is done with what is aboard, and may be
empty."""


def job_of(plan: Plan) -> Job:
    """Return what is still to be done by ``plan``: its job without what is done, left out or lost."""
    gone = plan.done | {one.target.id for one in plan.left_out}
    return Job(
        tuple(target for target in plan.targets if target.id not in gone),
        tuple(one.robot for one in plan.robots if not one.lost),
        plan.stores,
        plan.finish,
    )


def trips_of(plan: Plan) -> Trips:
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


def moved(plan: Plan, travel_of: TravelOf, target: str, robot: str, trip: int, place: int) -> Plan:
    """Return the plan in which ``robot`` serves ``target`` as number ``place``, from 0, of its trip ``trip``.

    Trip 0 is the one on what is aboard at the start; one more than there are is a new one.

    :raises EditError: when that cannot be driven; ``plan`` is as it was.
    """
    trips = _without(plan, target)
    names = [one.robot.id for one in plan.robots if not one.lost]
    if robot not in names:
        raise EditError(f"There is no robot {robot} in the plan, or it is lost: choose another.")
    day = trips[names.index(robot)]
    if not 0 <= trip <= len(day):
        raise EditError(f"Robot {robot} has no trip {trip}: choose 0 to {len(day)}.")
    if trip == len(day):
        day.append([])
    if not 0 <= place <= len(day[trip]):
        raise EditError(f"Trip {trip} of robot {robot} has no place {place}: choose 0 to {len(day[trip])}.")
    day[trip].insert(place, target)
    return replanned_by_hand(plan, travel_of, trips)


def removed(plan: Plan, travel_of: TravelOf, target: str, reason: str = "taken out by hand") -> Plan:
    """Return the plan in which nobody serves ``target``.

    :raises EditError: when it is not to come.
    """
    trips = _without(plan, target)
    out = LeftOut(_target(plan, target), reason)
    return replanned_by_hand(replace(plan, left_out=(*plan.left_out, out)), travel_of, trips)


def reordered(plan: Plan, travel_of: TravelOf, robot: str, trip: int, targets: Sequence[str]) -> Plan:
    """Return the plan in which ``robot`` serves the cones of its trip ``trip`` in the order ``targets``.

    :raises EditError: when these are not the cones of that trip, or the order cannot be driven.
    """
    trips = trips_of(plan)
    names = [one.robot.id for one in plan.robots if not one.lost]
    if robot not in names or not 0 <= trip < len(trips[names.index(robot)]):
        raise EditError(f"There is no trip {trip} of robot {robot}: choose one that the plan has.")
    day = trips[names.index(robot)]
    if sorted(day[trip]) != sorted(targets):
        raise EditError(f"Trip {trip} of robot {robot} has the cones {', '.join(day[trip])}: order these.")
    day[trip] = list(targets)
    return replanned_by_hand(plan, travel_of, trips)


def replanned_by_hand(plan: Plan, travel_of: TravelOf, trips: Trips) -> Plan:
    """Return ``plan`` with ``trips`` instead of its own, as :func:`trips_of` returns them.

    :raises EditError: naming the robot, the trip and what is in the way.
    """
    job = job_of(plan)
    travel = travel_of(job)
    days = Days(job, travel.metres)
    rows: list[Day] = [[[job.place_of[name] for name in row] for row in day] for day in trips]
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


def _without(plan: Plan, target: str) -> Trips:
    trips = trips_of(plan)
    if target in plan.done:
        raise EditError(f"Cone {target} is done already: choose one that is to come.")
    for day in trips:
        for row in day:
            if target in row:
                row.remove(target)
                return trips
    raise EditError(f"No robot serves cone {target} in this plan: choose one that is in it.")


def _target(plan: Plan, name: str) -> Target:
    return next(target for target in plan.targets if target.id == name)


def _check_room(job: Job, days: Days, rows: Sequence[Day]) -> None:
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
            raise EditError(f"Robot {one.id} cannot serve {names} {what}. Give it fewer, or another trip.")
        if any(day[1:]) and not job.stores:
            raise EditError(f"Robot {one.id} has nowhere to load: there is no store in this plan.")


def _set_gates(job: Job, days: Days, rows: Sequence[Day]) -> None:
    """Find when each stage may begin; a day must not come back to an earlier stage."""
    for robot, day in enumerate(rows):
        stages = [days.stage[place] for row in day for place in row]
        if stages != sorted(stages):
            raise EditError(
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


def _check_ways(job: Job, days: Days, rows: Sequence[Day]) -> None:
    for robot, day in enumerate(rows):
        name = job.robots[robot].id
        tour = [robot, *days.tour(robot, day)]
        legs = [(days.metres[a][b], b) for a, b in pairwise(tour)]
        for metres, place in legs:
            if math.isinf(metres):
                raise EditError(f"No way leads robot {name} to {job.name(place)}: give it another one.")
        total = sum(metres for metres, _ in legs)
        if total > job.robots[robot].range_m:
            raise EditError(
                f"Robot {name} would drive {total:.0f} m and has battery for "
                f"{job.robots[robot].range_m:.0f} m: give it fewer cones."
            )
