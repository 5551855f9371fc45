"""The quick preview is nearly as short as what PyVRP finds, with a store and without one."""

from __future__ import annotations

import numpy as np
import pytest

from robot_bridge.core.assignment.job import (
    STAY,
    TO_START,
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    Store,
    StraightTravel,
)
from robot_bridge.core.assignment.plan import ConePlan, check_plan
from robot_bridge.core.assignment.solver import PREVIEW, Objective, assign

CASES = pytest.mark.parametrize(
    "seeds", [(0, 1), pytest.param((2, 3), marks=pytest.mark.again("seeds 0, 1"))]
)


def previewed(job: AssignmentJob, objective: str = "distance") -> ConePlan:
    # It ends where no small change makes it better, long before the time is over.
    plan = assign(job, StraightTravel(job), Objective(objective, PREVIEW, 60.0))
    assert check_plan(plan) == []
    return plan


def shortest(job: AssignmentJob) -> float:
    """Return the metres of the best plan that PyVRP finds for robots that have all cones aboard."""
    pyvrp = pytest.importorskip("pyvrp")
    from pyvrp.stop import MaxIterations

    robots, metres = len(job.robots), StraightTravel(job).metres
    # Before the targets come the robots' starts, and one place that is nowhere, where those end that stay.
    size = robots + 1 + len(job.targets)
    away = np.zeros((size, size))
    away[:robots, robots + 1 :] = metres[:robots, robots:]
    away[robots + 1 :, robots + 1 :] = metres[robots:, robots:]
    away[robots + 1 :, :robots] = metres[robots:, :robots]
    whole = np.rint(away * 10).astype(np.int64)
    ends = range(robots) if job.finish == TO_START else [robots] * robots
    data = pyvrp.ProblemData(
        [pyvrp.Location(0, 0)] * size,
        [pyvrp.Client(robots + 1 + k, delivery=[1]) for k in range(len(job.targets))],
        [pyvrp.Depot(k) for k in range(robots + 1)],
        [
            pyvrp.VehicleType(1, [robot.aboard], k, end)
            for k, (robot, end) in enumerate(zip(job.robots, ends, strict=True))
        ],
        [whole],
        [whole],
    )
    best = pyvrp.solve(data, MaxIterations(500), collect_stats=False).best
    assert best.is_feasible()
    return float(best.distance()) / 10


def loaded(seed: int, finish: str, cones: int = 20, robots: int = 4, room: int = 8) -> AssignmentJob:
    """Return a job of robots here and there that have all cones aboard, without a store."""
    random = np.random.default_rng(seed)
    places, starts = random.uniform(0, 100, (cones, 2)), random.uniform(0, 100, (robots, 2))
    return AssignmentJob(
        tuple(ConeTarget(f"c{k}", *place) for k, place in enumerate(places.tolist())),
        tuple(PlanRobot(f"R{k}", *start, room, aboard=room) for k, start in enumerate(starts.tolist())),
        (),
        finish,
    )


@CASES
@pytest.mark.parametrize("finish", [STAY, TO_START])
def test_without_a_store_it_is_nearly_the_shortest(finish: str, seeds: tuple[int, int]) -> None:
    jobs = [loaded(seed, finish) for seed in seeds]
    ratios = [previewed(job).metres / shortest(job) for job in jobs]
    assert np.mean(ratios) < 1.15
    assert max(ratios) < 1.3


@pytest.mark.parametrize("objective", ["distance", "balanced"])
def test_without_a_store_the_robot_beside_the_cones_places_them(objective: str) -> None:
    robots = (PlanRobot("far", 0.0, 0.0, 2, aboard=2), PlanRobot("near", 100.0, 0.0, 2, aboard=2))
    job = AssignmentJob((ConeTarget("a", 99.0, 0.0), ConeTarget("b", 101.0, 0.0)), robots, (), STAY)
    plan = previewed(job, objective)
    assert [len(one.stops) for one in plan.robots] == [0, 2]
    assert plan.metres == pytest.approx(3.0)


@CASES
def test_with_a_store_it_is_not_much_longer_than_by_pyvrp(seeds: tuple[int, int]) -> None:
    pytest.importorskip("pyvrp")
    ratios = []
    for seed in seeds:
        places = np.random.default_rng(seed).uniform(0, 100, (12, 2)).tolist()
        targets = tuple(ConeTarget(f"c{k}", *place) for k, place in enumerate(places))
        job = AssignmentJob(targets, (PlanRobot("R", 50.0, 50.0, 4),), (Store("s", 50.0, 50.0),))
        best = assign(job, StraightTravel(job), Objective("distance", "pyvrp", 60.0))
        ratios.append(previewed(job).metres / best.metres)
    assert min(ratios) > 1.0 - 1e-9
    assert np.mean(ratios) < 1.05
    assert max(ratios) < 1.1
