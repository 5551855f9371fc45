"""What is left of a plan, planned again: in a worker thread, along the roads and round what stands."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.assignment.detours import ClearTravel, Floats, NearOrByRoad
from ...core.assignment.job import AssignmentJob, CancellableTravel, RoadTravel, StraightTravel, Travel
from ...core.assignment.meetings import meetings
from ...core.assignment.plan import ConePlan, PlanSituation
from ...core.assignment.plan_changes import replan
from ...core.assignment.progress import ClosedWay
from ...core.assignment.solver import Objective
from ...core.errors import AssignmentCancelledError
from ...core.messages import ClosureReport
from ..traffic.road_planning import RoadPlanner
from ..traffic.site_roads import ClosedRoads
from .model import PlanTerms

Place = tuple[float, float]
PATIENCE = 5.0
"""times the seconds asked for that planning may take in all: ways and the search are timed apart."""


@dataclass(frozen=True)
class ReplanGround:
    """What plans are made on: ``placed`` cones, robots that are ``standing`` by name, roads; metres."""

    terms: PlanTerms
    placed: list[Place]
    standing: Mapping[str, Place]
    planner: RoadPlanner | None


class Replanning:
    """One plan of what is left in the making; :meth:`run` is for a worker thread."""

    def __init__(self, plan: ConePlan, ground: ReplanGround, situation: PlanSituation) -> None:
        self._plan, self._ground, self._situation = plan, ground, situation
        self._cancelled = threading.Event()
        self._until = 0.0

    def cancel(self) -> None:
        """Have :meth:`run` end soon."""
        self._cancelled.set()

    def run(self) -> ConePlan:
        """Return the plan; raises AssignmentError, RoadsError and RefusedError when there is none."""
        seconds = self._ground.terms.seconds
        self._until = time.monotonic() + PATIENCE * seconds
        wanted = Objective(self._plan.objective, time_limit_s=seconds)
        return replan(self._plan, self._travel, self._situation, wanted, lambda share: self._goes_on())

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
        return CancellableTravel(clear, self._goes_on)

    def _goes_on(self) -> bool:
        return not self._cancelled.is_set() and time.monotonic() < self._until

    def _check(self) -> None:
        if not self._goes_on():
            raise AssignmentCancelledError("The plan of what is left took too long, or was given up.")


def count_meetings(plan: ConePlan, ground: ReplanGround) -> int:
    """Return how often robots come too near to one another by ``plan``; for a worker thread."""
    return len(meetings(plan, ground.terms.apart_m, ground.standing, ground.terms.off_standing_m))


def ways_along_closed_roads(
    plan: ConePlan, roads: ClosedRoads, closures: Mapping[str, ClosureReport]
) -> tuple[ClosedWay, ...]:
    """Return the ways of ``plan`` that the gateway would not send; for a worker thread."""
    found = []
    for one in plan.robots:
        for stop in () if one.lost else one.stops:
            along = [id for id in roads.along(stop.path) if id in closures]
            if along:
                closure = closures[along[0]]
                found.append(ClosedWay(one.robot.id, stop.id, closure.closed_by, closure.reason or "", stop))
    return tuple(found)


def _places(places: Sequence[Place]) -> Floats:
    return np.array(places, dtype=np.float64).reshape(-1, 2)
