"""Robots keep to the roads: lengths, paths, one-way roads and closed ones."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from robot_bridge.core.assignment.job import AssignmentJob, ConeTarget, PlanRobot, RoadTravel, Store
from robot_bridge.core.assignment.plan import check_plan
from robot_bridge.core.assignment.solver import PREVIEW, Objective, assign
from robot_bridge.core.errors import OffNetworkError, UnservedError
from robot_bridge.core.roads.network import BOTH, FORWARD, build_network, centrelines
from robot_bridge.core.roads.path_smoothing import Driving
from robot_bridge.core.roads.routes import Router

# A block of 100 by 40 m; the south road runs east, the east road north, the north road west.
BLOCK = [[(0, 0), (100, 0)], [(100, 0), (100, 40)], [(100, 40), (0, 40)], [(0, 40), (0, 0)]]
JOB = AssignmentJob(
    (ConeTarget("south", 50.0, 1.5), ConeTarget("north", 50.0, 38.0), ConeTarget("east", 101.0, 20.0)),
    (PlanRobot("R", 0.0, 20.0, 3),),
    (Store("s", 0.0, 10.0),),
)


def block(direction: int = FORWARD) -> Router:
    return Router(build_network(centrelines(BLOCK, width=6.0, direction=direction)))


def test_a_one_way_block_is_driven_round() -> None:
    travel = RoadTravel(JOB, block(), Driving(spacing=0.5))
    plan = assign(JOB, travel, Objective("distance", PREVIEW))
    assert check_plan(plan) == []
    assert plan.robots[0].trips[0].targets == ("south", "east", "north")
    # Round the block, to each cone and back to the road, and from the robot to the store.
    assert plan.metres == pytest.approx(280 + 2 * (1.5 + 2.0 + 1.0) + 10.0)
    assert plan.travel == "roads (SciPy)"


def test_paths_lie_on_roads_and_lead_to_the_cones() -> None:
    plan = assign(JOB, RoadTravel(JOB, block(), Driving(spacing=0.5)), Objective("distance", PREVIEW))
    for _, stop in plan.all_stops():
        points = np.array(stop.path)
        assert max(np.hypot(*(b - a)) for a, b in pairwise(points)) <= 0.51
        x, y = points.T
        off = np.minimum.reduce([np.abs(x), np.abs(x - 100), np.abs(y), np.abs(y - 40)])
        assert off.max() <= 2.01
        assert points[-1].tolist() == [stop.x, stop.y]


def test_a_closed_road_is_not_driven() -> None:
    router = block(BOTH)
    store, east = 1, 4
    assert RoadTravel(JOB, router).metres[store, east] == pytest.approx(10 + 100 + 20 + 1)
    router.close([0])
    with pytest.raises(OffNetworkError, match="More than 5 m from every road that may be used: cone south"):
        RoadTravel(JOB, router, reach=5.0)
    assert RoadTravel(JOB, router, reach=60.0).metres[store, east] == pytest.approx(30 + 100 + 20 + 1)


def test_a_cone_behind_a_gap_is_named() -> None:
    islands = Router(build_network(centrelines([*BLOCK, [(300, 0), (400, 0)]], width=6.0)))
    job = AssignmentJob((*JOB.targets, ConeTarget("beyond", 350.0, 0.0)), JOB.robots, JOB.stores)
    with pytest.raises(UnservedError, match="no way leads from any robot to beyond") as refused:
        assign(job, RoadTravel(job, islands), Objective(method=PREVIEW))
    assert refused.value.targets == ("beyond",)
