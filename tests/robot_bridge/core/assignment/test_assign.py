"""Plans can be driven, are as short as they can be, and keep to stages, room and batteries."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise, permutations, product

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robot_bridge.core.assignment.job import (
    COLLECT,
    FINISHES,
    PLACE,
    STAY,
    TO_START,
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    Store,
    StraightTravel,
)
from robot_bridge.core.assignment.plan import HOME, STORE, ConePlan, check_plan
from robot_bridge.core.assignment.solver import PREVIEW, PYVRP, Objective, assign
from robot_bridge.core.errors import AssignmentCancelledError, JobError, MissingSolverError, UnservedError
from tests.robot_bridge.core.assignment.jobs import scattered


@pytest.fixture(params=[PREVIEW, PYVRP])
def method(request: pytest.FixtureRequest) -> str:
    if request.param == PYVRP:
        pytest.importorskip("pyvrp")
    return request.param


def planned(
    job: AssignmentJob, objective: str = "balanced", method: str = PREVIEW, seconds: float = 1.0
) -> ConePlan:
    """Return a plan that the checker finds nothing wrong with."""
    plan = assign(job, StraightTravel(job), Objective(objective, method, seconds))
    assert check_plan(plan) == []
    return plan


def shortest_by_trying(job: AssignmentJob) -> float:
    """Return the least metres of one robot that begins at the only store, by trying every order."""
    metres = StraightTravel(job).metres
    store, targets = job.first_store, range(job.first_target, len(job.places))
    best = math.inf
    for order in permutations(targets):
        for breaks in product((False, True), repeat=len(order) - 1):
            tour, room = [store, order[0]], job.robots[0].capacity - 1
            for home, place in zip(breaks, order[1:], strict=True):
                tour += [store, place] if home else [place]
                room = job.robots[0].capacity - 1 if home else room - 1
                if room < 0:
                    break
            else:
                tour.append(store)
                best = min(best, sum(metres[a, b] for a, b in pairwise(tour)))
    return best


@pytest.mark.parametrize("seed", range(6))
def test_small_jobs_are_as_short_as_they_can_be_and_nearly_so_in_a_preview(method: str, seed: int) -> None:
    job = scattered(6, robots=1, capacity=2, seed=seed)
    least = shortest_by_trying(job)
    assert least - 1e-6 <= planned(job, "distance", method).metres
    assert planned(job, "distance", method).metres <= (least + 0.2 if method == PYVRP else 1.03 * least)


def test_work_is_shared_out_evenly(method: str) -> None:
    job = scattered(12, robots=3, capacity=12)
    plan = planned(job, "balanced", method)
    ends = [one.end_s for one in plan.robots]
    assert min(ends) > 0.7 * max(ends)
    alone = planned(replace(job, robots=job.robots[:1]), "balanced", method)
    assert plan.end_s < 0.55 * alone.end_s


def test_least_distance_is_shorter_and_balanced_is_earlier(method: str) -> None:
    job = scattered(12, robots=3, capacity=12)
    short, even = planned(job, "distance", method), planned(job, "balanced", method)
    assert short.metres < even.metres
    assert even.end_s < short.end_s


def test_robots_come_back_to_load(method: str) -> None:
    plan = planned(scattered(11, robots=1, capacity=4), "distance", method)
    (one,) = plan.robots
    assert sorted(len(trip.targets) for trip in one.trips) == [3, 4, 4]
    assert [trip.stops[0].kind for trip in one.trips] == [STORE] * 3
    assert [trip.stops[0].loaded for trip in one.trips] == [len(trip.targets) for trip in one.trips]


def test_times_are_metres_by_speed_and_service() -> None:
    job = AssignmentJob(
        (ConeTarget("a", 30.0, 0.0, service_s=7.0), ConeTarget("b", 30.0, 40.0, service_s=5.0)),
        (PlanRobot("R", 0.0, 0.0, 2, speed=2.0, ready_s=100.0),),
        (Store("s", 0.0, 0.0, service_s=20.0),),
    )
    stops = {stop.id: stop for _, stop in planned(job).all_stops()}
    first, second = sorted((stops["a"], stops["b"]), key=lambda stop: stop.begin_s)
    assert (first.id, first.arrival_s, first.end_s) == ("a", 135.0, 142.0)
    assert (second.arrival_s, second.end_s) == (162.0, 167.0)
    assert planned(job).end_s == 167.0 + 25.0 + 20.0


def test_stages_wait_for_one_another(method: str) -> None:
    job = scattered(18, robots=3, capacity=4)
    targets = tuple(replace(target, stage=k % 3) for k, target in enumerate(job.targets))
    plan = planned(replace(job, targets=targets), "balanced", method)
    stops = {stop.id: stop for _, stop in plan.all_stops() if stop.is_target}
    for stage in (0, 1):
        ends = [stops[target.id].end_s for target in targets if target.stage == stage]
        begins = [stops[target.id].begin_s for target in targets if target.stage == stage + 1]
        assert max(ends) <= min(begins)


def test_what_was_loaded_for_an_earlier_stage_is_used_in_the_next() -> None:
    targets = (ConeTarget("a", 10.0, 0.0, stage=1), ConeTarget("b", 20.0, 0.0, stage=2))
    job = AssignmentJob(targets, (PlanRobot("R", 0.0, 0.0, 2),), (Store("s", 0.0, 0.0),))
    (one,) = planned(job, "distance").robots
    assert [stop.kind for stop in one.stops] == [STORE, PLACE, PLACE, STORE]


def test_collected_cones_are_brought_to_a_store(method: str) -> None:
    job = scattered(9, robots=2, capacity=4, finish=STAY)
    targets = tuple(replace(target, kind=COLLECT) for target in job.targets)
    plan = planned(replace(job, targets=targets), "distance", method)
    unloaded = [stop.unloaded for _, stop in plan.all_stops() if stop.kind == STORE]
    assert sum(unloaded) == 9
    assert max(unloaded) <= 4


def test_what_is_aboard_is_placed_without_a_store() -> None:
    job = AssignmentJob(
        (ConeTarget("a", 5.0, 0.0), ConeTarget("b", 9.0, 0.0)),
        (PlanRobot("R", 0.0, 0.0, 4, aboard=2),),
        (),
        STAY,
    )
    (one,) = planned(job).robots
    assert [stop.id for stop in one.stops] == ["a", "b"]


def test_robots_go_where_they_are_to_end() -> None:
    robot = PlanRobot("R", 0.0, 0.0, 4)
    ends = {}
    for finish in FINISHES:
        job = AssignmentJob((ConeTarget("a", 50.0, 0.0),), (robot,), (Store("s", 20.0, 0.0),), finish)
        stop = planned(job).robots[0].stops[-1]
        ends[finish] = stop.kind, stop.x
    assert ends == {"store": (STORE, 20.0), TO_START: (HOME, 0.0), STAY: (PLACE, 50.0)}


def test_a_battery_is_not_driven_empty(method: str) -> None:
    job = scattered(12, robots=2, capacity=3)
    whole = planned(job, "distance", method).metres
    short = replace(job.robots[0], range_m=whole / 3)
    plan = planned(replace(job, robots=(short, job.robots[1])), "distance", method)
    assert plan.robots[0].metres <= whole / 3


def test_a_cone_beyond_every_battery_is_named() -> None:
    job = scattered(5, robots=2)
    far = ConeTarget("far", 1000.0, 0.0)
    robots = tuple(replace(robot, range_m=800.0) for robot in job.robots)
    with pytest.raises(UnservedError, match=r"battery for cone far|battery for far") as refused:
        assign(replace(job, targets=(*job.targets, far), robots=robots), StraightTravel(_with(job, far)))
    assert refused.value.targets == ("far",)


def _with(job: AssignmentJob, target: ConeTarget) -> AssignmentJob:
    return replace(job, targets=(*job.targets, target))


def test_batteries_that_do_not_suffice_for_all_are_told() -> None:
    job = scattered(20, robots=2, capacity=2)
    robots = tuple(replace(robot, range_m=250.0) for robot in job.robots)
    with pytest.raises(UnservedError, match="batteries do not suffice for all 20 cones") as refused:
        planned(replace(job, robots=robots))
    assert 0 < len(refused.value.targets) < 20


def test_a_cone_that_no_way_leads_to_is_named() -> None:
    job = scattered(4)
    travel = StraightTravel(job)
    travel.metres[:, job.place_of["cone-3"]] = math.inf
    with pytest.raises(UnservedError, match="no way leads from any robot to cone-3") as refused:
        assign(job, travel, Objective(method=PREVIEW))
    assert refused.value.targets == ("cone-3",)


def test_one_way_roads_are_driven_their_way(method: str) -> None:
    job = scattered(6, robots=1, capacity=6)
    travel = StraightTravel(job)
    # Round the targets in their order it is short, against it very long.
    n, begin = len(job.places), job.first_target
    for a in range(begin, n):
        for b in range(begin, n):
            travel.metres[a, b] = 1.0 if b == a + 1 else 500.0
    plan = assign(job, travel, Objective("distance", method, 1.0))
    assert plan.robots[0].trips[0].targets == tuple(target.id for target in job.targets)


def test_a_cancel_ends_it(method: str) -> None:
    told: list[float] = []

    def progress(share: float) -> bool:
        told.append(share)
        return len(told) < 5

    job = scattered(30)
    with pytest.raises(AssignmentCancelledError):
        assign(job, StraightTravel(job), Objective("distance", method, 60.0), progress)
    assert told == sorted(told)
    assert len(told) == 5


def test_without_pyvrp_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "pyvrp", None)
    job = scattered(3)
    with pytest.raises(MissingSolverError, match="pip install"):
        assign(job, StraightTravel(job), Objective(method=PYVRP))
    assert assign(job, StraightTravel(job), Objective(method="automatic")).method == PREVIEW


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"robots": ()}, "no robot"),
        ({"stores": ()}, "no store"),
        ({"finish": "moon"}, "'moon'"),
        ({"targets": (ConeTarget("a", 0, 0), ConeTarget("a", 1, 1))}, "more than one cone has the id a"),
        ({"targets": (ConeTarget("a", math.nan, 0),)}, "x of cone a is nan"),
        (
            {"targets": (ConeTarget("a", 0, 0, demand=9),)},
            "cone a takes room 9, and no robot has more than 4",
        ),
        ({"targets": (ConeTarget("a", 0, 0, kind="eat"),)}, "cone a is to be 'eat'"),
        ({"robots": (PlanRobot("R", 0, 0, 0),)}, "capacity of robot R is 0"),
        (
            {"robots": (PlanRobot("R", 0, 0, 2, aboard=2, collected=1),)},
            "robot R carries 3 and has room for 2",
        ),
        ({"robots": (PlanRobot("R", 0, 0, 2, range_m=-1),)}, "range of -1 m"),
    ],
)
def test_bad_jobs_are_refused_by_name(change: dict, told: str) -> None:
    with pytest.raises(JobError, match=rf"(?i){told}"):
        replace(scattered(3), **change)


@st.composite
def jobs(draw: st.DrawFn) -> AssignmentJob:
    """Draw jobs of all kinds at once, with enough battery."""
    number = st.floats(0, 200).map(lambda value: round(value, 1))
    targets = tuple(
        ConeTarget(
            f"c{k}", draw(number), draw(number), 0.0, draw(st.integers(0, 2)),
            draw(st.sampled_from([PLACE, COLLECT])), draw(st.integers(1, 2)), draw(st.floats(0, 30)),
        )
        for k in range(draw(st.integers(0, 10)))
    )  # fmt: skip
    robots = []
    for k in range(draw(st.integers(1, 3))):
        room = draw(st.integers(2, 5))
        aboard = draw(st.integers(0, room))
        collected = draw(st.integers(0, room - aboard))
        speed, ready = draw(st.sampled_from([0.5, 1.0, 2.0])), draw(st.floats(0, 60))
        robots.append(
            PlanRobot(f"R{k}", draw(number), draw(number), room, speed, 20_000.0, aboard, collected, ready)
        )
    stores = tuple(Store(f"s{k}", draw(number), draw(number)) for k in range(draw(st.integers(1, 2))))
    return AssignmentJob(targets, tuple(robots), stores, draw(st.sampled_from(FINISHES)))


@settings(max_examples=60, deadline=None)
@given(job=jobs(), objective=st.sampled_from(["balanced", "distance"]))
def test_whatever_the_job_the_checker_finds_nothing(job: AssignmentJob, objective: str) -> None:
    planned(job, objective, seconds=0.3)


COLLECTED_ON_THE_WAY = AssignmentJob(
    (
        ConeTarget("c0", 0, 0, stage=1),
        *(ConeTarget(f"c{k}", 0, 0) for k in (1, 2)),
        ConeTarget("c3", 0, 0, kind=COLLECT),
    ),
    (PlanRobot("R0", 0, 0, 3, 0.5, 20_000.0, aboard=3),),
    (Store("s0", 0, 0),),
    "store",
)
"""The robot still has a cone of those it began with when it has collected another."""


@example(job=COLLECTED_ON_THE_WAY)
@settings(max_examples=8, deadline=None)
@given(job=jobs())
def test_whatever_the_job_pyvrp_keeps_to_it(job: AssignmentJob) -> None:
    pytest.importorskip("pyvrp")
    planned(job, "balanced", PYVRP, seconds=0.3)


@pytest.mark.again("test_small_jobs_are_as_short_as_they_can_be_and_nearly_so_in_a_preview")
def test_a_public_instance_is_solved_to_its_optimum() -> None:
    pytest.importorskip("pyvrp")
    from benchmarks import e_n51_k5

    x, y = map(float, e_n51_k5.DEPOT)
    job = AssignmentJob(
        tuple(ConeTarget(f"c{k}", *row[:2], demand=row[2]) for k, row in enumerate(e_n51_k5.customers(), 1)),
        (PlanRobot("R", x, y, e_n51_k5.CAPACITY),),
        (Store("s", x, y),),
    )
    travel = StraightTravel(job)
    travel.metres = e_n51_k5.rounded(travel.metres)
    # It ends early; the limit is for machines that have much else to do.
    plan = assign(job, travel, Objective("distance", PYVRP, 60.0))
    assert plan.metres == e_n51_k5.OPTIMUM
    assert assign(job, travel, Objective("distance", PREVIEW, 20.0)).metres < 1.12 * e_n51_k5.OPTIMUM
