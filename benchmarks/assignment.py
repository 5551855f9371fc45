"""The part on assignment: 200 cones for five robots, against nearest neighbour, savings, and PyVRP alone."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks import e_n51_k5
from benchmarks.clock import spread
from benchmarks.page import Part, goal
from benchmarks.road_data import track
from benchmarks.trial import size
from robot_bridge.core.assignment.job import (
    TO_START,
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    RoadTravel,
    Store,
    StraightTravel,
    Travel,
)
from robot_bridge.core.assignment.local_search import TripLimits, saving_pairs, trips_by_savings
from robot_bridge.core.assignment.plan import ConePlan, check_plan
from robot_bridge.core.assignment.pyvrp_search import load_pyvrp
from robot_bridge.core.assignment.schedules import ScheduleEvaluator
from robot_bridge.core.assignment.solver import PREVIEW, PYVRP, Objective, assign
from robot_bridge.core.roads.network_checks import repaired_network
from robot_bridge.core.roads.routes import Router, stretch

CONES, ROBOTS, CAPACITY = 200, 5, 8
SHORT_S, LONG_S = size((2.0, 10.0), (0.5, 1.0))
GOAL = 1.005
SEEDS = size((1, 2, 3), (1,))
LOADED = ((20, 3), (40, 4), (60, 5), (100, 5))
"""Cones and robots of the jobs in which all cones are aboard."""
RUNS = size(5, 2)
GROUPS, SPREAD = 10, 15.0
"""places around which cones stand together, and the metres by which they do."""
FIELD, SMALL_FIELD = 300, 100
"""metres along each side of what is made up, with and without a store."""

TEXT = """\
{cones} cones, room for {room}, {robots} robots that begin at the one store; metres of all robots, and in
brackets how many times the median of what PyVRP alone finds in {long:g} s, with its own defaults. Ours and
PyVRP alone ran {runs} times in turn, each time with another seed, and search for so long by the wall's clock:
on a busy machine both find less. What has no seed comes to the same each time; its seconds are processor time.

| | nearest neighbour | Clarke and Wright | preview | ours, {short:g} s | PyVRP alone, {short:g} s | PyVRP alone, {long:g} s |
|---|---|---|---|---|---|---|
{metres}

The preview took {preview:.2f} s; places and all distances on the track's roads took {matrix:.2f} s, once.
Of all {count} runs ours is {median:.4f} times PyVRP's in {long:g} s at the median ({goal}), {worst:.4f}
times at worst.

Balanced, the last robot finishes at (seconds; {service:g} s for each cone, {loading:g} s at each visit to
the store):

| | preview | ours, {short:g} s | an even share of the shortest plan |
|---|---|---|---|
{ends}

Robots here and there on a field of {small} m that have all cones aboard, without a store, each to end where
it began; metres of all robots where the fewest are asked for, and the seconds after which the last one is
home where even work is:

| | metres: preview | ours, {short:g} s | last finishes: preview | ours, {short:g} s |
|---|---|---|---|---|
{loaded}

E-n51-k5 (Christofides and Eilon, 1969; {customers} customers, optimum {optimum}): preview
{instance_preview:.0f}, ours {instance:.0f} in {short:g} s. {faults} of {plans} plans have faults by the
checker ({no_faults}).
"""  # noqa: E501


@dataclass(frozen=True)
class Case:
    """One set of cones, and what was found for it."""

    name: str
    job: AssignmentJob
    travel: Travel


def measure(data: Path) -> Part:
    """Measure on made-up places, on the roads of ZalaZONE's track, and on a public instance."""
    load_pyvrp()
    cases = [*(_made_up(seed) for seed in SEEDS), _in_groups(SEEDS[0])]
    begun = time.process_time()
    cases.append(_on_the_track(data))
    matrix_s = time.process_time() - begun
    rows, ends, ratios, previews, plans = [], [], [], [], []
    for case in cases:
        seconds, preview = _planned(case, "distance", PREVIEW)
        ours, short, long = [], [], []
        for seed in range(RUNS):
            ours.append(_planned(case, "distance", PYVRP, seed)[1])
            short.append(_pyvrp_alone(case, SHORT_S, seed))
            long.append(_pyvrp_alone(case, LONG_S, seed))
        best, metres = float(np.median(long)), [plan.metres for plan in ours]
        plain = [_nearest_neighbour(case), _savings(case), preview.metres]
        cells = [f"{one:.0f} ({one / best:.4f})" for one in plain]
        cells += [f"{one:.0f} ({one.median / best:.4f})" for one in map(spread, (metres, short, long))]
        rows.append(_row(case.name, cells))
        ratios += [one / best for one in metres]
        previews.append(seconds)
        even = [_planned(case, "balanced", method)[1] for method in (PREVIEW, PYVRP)]
        shortest = min(ours, key=lambda plan: plan.metres)
        ends.append(_row(case.name, [*(f"{one.end_s:.0f}" for one in even), f"{_even_share(shortest):.0f}"]))
        plans += [preview, *ours, *even]
    loaded, of_loaded = _loaded_rows()
    plans += of_loaded
    solved, quick = _instance(PYVRP), _instance(PREVIEW)
    faults = sum(bool(check_plan(plan)) for plan in plans)
    median = float(np.median(ratios))
    text = TEXT.format(
        cones=CONES, room=CAPACITY, robots=ROBOTS, short=SHORT_S, long=LONG_S,
        metres="\n".join(rows), ends="\n".join(ends),
        loaded="\n".join(loaded),
        preview=spread(previews), matrix=matrix_s, goal=goal(f"at most {GOAL} times", median <= GOAL),
        service=ConeTarget.service_s, loading=Store.service_s, small=SMALL_FIELD,
        customers=len(e_n51_k5.customers()), no_faults=goal("none", faults == 0), runs=RUNS,
        count=len(ratios), median=median, worst=max(ratios),
        optimum=e_n51_k5.OPTIMUM, instance=solved, instance_preview=quick, faults=faults, plans=len(plans),
    )  # fmt: skip
    return Part("Assignment of cones", text, failed=median > GOAL or faults > 0)


def _made_up(seed: int) -> Case:
    places = np.random.default_rng(seed).uniform(0, FIELD, (CONES, 2))
    job = _job(places, (FIELD / 2, FIELD / 2))
    return Case(f"field of {FIELD} m, seed {seed}", job, StraightTravel(job))


def _in_groups(seed: int) -> Case:
    random = np.random.default_rng(seed)
    groups = random.uniform(0.1 * FIELD, 0.9 * FIELD, (GROUPS, 2))
    places = groups[random.integers(GROUPS, size=CONES)] + random.normal(0, SPREAD, (CONES, 2))
    job = _job(places, (FIELD / 2, FIELD / 2))
    return Case(f"{GROUPS} groups in {FIELD} m", job, StraightTravel(job))


def _on_the_track(data: Path) -> Case:
    network, _ = repaired_network(track(data), 0.5)
    random = np.random.default_rng(1)
    # One way where the lanes are: places that can be reached are those of the greatest strong part.
    edges, shares = random.integers(0, len(network), 6 * CONES), random.uniform(size=6 * CONES)
    stations = shares * network.lengths[edges]
    places = np.array(
        [stretch(network.edges.line(k), 0.0, at)[-1] for k, at in zip(edges, stations, strict=True)]
    )
    job = _job(places, tuple(places[0]))
    metres = RoadTravel(job, Router(network)).metres
    store = job.first_store
    reached = np.flatnonzero(np.isfinite(metres[store]) & np.isfinite(metres[:, store]))
    kept = reached[reached >= job.first_target][:CONES] - job.first_target
    job = _job(places[kept], tuple(places[0]))
    return Case("roads of ZalaZONE's track", job, RoadTravel(job, Router(network)))


def _job(places: np.ndarray, store: tuple[float, float]) -> AssignmentJob:
    return AssignmentJob(
        tuple(ConeTarget(f"c{k}", float(x), float(y)) for k, (x, y) in enumerate(places, 1)),
        tuple(PlanRobot(f"r{k}", *store, CAPACITY) for k in range(1, ROBOTS + 1)),
        (Store("store", *store),),
    )


def _loaded_rows() -> tuple[list[str], list[ConePlan]]:
    """Return the rows of the jobs without a store, and all their plans."""
    rows, made = [], []
    for cones, robots in LOADED:
        case = _loaded(cones, robots)
        plans = [
            _planned(case, objective, method)[1]
            for objective in ("distance", "balanced")
            for method in (PREVIEW, PYVRP)
        ]
        made += plans
        cells = [f"{plan.metres:.0f}" for plan in plans[:2]] + [f"{plan.end_s:.0f}" for plan in plans[2:]]
        rows.append(_row(case.name, cells))
    return rows, made


def _loaded(cones: int, robots: int) -> Case:
    """Return a job whose robots have a few cones more aboard than an even share."""
    random = np.random.default_rng(cones)
    places, starts = (random.uniform(0, SMALL_FIELD, (count, 2)).tolist() for count in (cones, robots))
    room = cones // robots + 4
    job = AssignmentJob(
        tuple(ConeTarget(f"c{k}", *place) for k, place in enumerate(places, 1)),
        tuple(PlanRobot(f"r{k}", *start, room, aboard=room) for k, start in enumerate(starts, 1)),
        (),
        TO_START,
    )
    return Case(f"{cones} cones, {robots} robots", job, StraightTravel(job))


def _planned(case: Case, objective: str, method: str, seed: int = 0) -> tuple[float, ConePlan]:
    begun = time.process_time()
    plan = assign(case.job, case.travel, Objective(objective, method, SHORT_S, seed))
    return time.process_time() - begun, plan


def _nearest_neighbour(case: Case) -> float:
    metres, store = case.travel.metres, case.job.first_store
    left = set(range(case.job.first_target, len(case.job.places)))
    total, at, room = 0.0, store, CAPACITY
    while left:
        if room == 0:
            total, at, room = total + metres[at, store], store, CAPACITY
        place = min(left, key=lambda one: metres[at, one])
        total, at, room = total + metres[at, place], place, room - 1
        left.remove(place)
    return float(total + metres[at, store])


def _savings(case: Case) -> float:
    days = ScheduleEvaluator(case.job, case.travel.metres)
    targets = list(range(case.job.first_target, len(case.job.places)))
    trips = trips_by_savings(days, targets, saving_pairs(days, targets), TripLimits(CAPACITY))
    return sum(days.trip_metres(trip) for trip in trips)


def _pyvrp_alone(case: Case, seconds: float, seed: int) -> float:
    """Return what PyVRP finds with its own defaults, one vehicle for each trip."""
    from pyvrp.stop import MaxRuntime

    pyvrp = load_pyvrp()
    places = [case.job.first_store, *range(case.job.first_target, len(case.job.places))]
    whole = np.rint(case.travel.metres[np.ix_(places, places)] * 10).astype(np.int64)
    np.fill_diagonal(whole, 0)
    data = pyvrp.ProblemData(
        [pyvrp.Location(*map(float, case.job.places[place])) for place in places],
        [pyvrp.Client(k, delivery=[1]) for k in range(1, len(places))],
        [pyvrp.Depot(0)],
        [pyvrp.VehicleType(len(places) // CAPACITY + ROBOTS, [CAPACITY])],
        [whole],
        [whole],
    )
    best = pyvrp.solve(data, MaxRuntime(seconds), seed=seed, collect_stats=False).best
    return float(best.distance()) / 10 if best.is_feasible() else float("inf")


def _even_share(plan: ConePlan) -> float:
    return sum(one.end_s for one in plan.robots) / len(plan.robots)


def _instance(method: str) -> float:
    customers = e_n51_k5.customers()
    x, y = map(float, e_n51_k5.DEPOT)
    job = AssignmentJob(
        tuple(ConeTarget(f"c{k}", *row[:2], demand=row[2]) for k, row in enumerate(customers, 1)),
        (PlanRobot("r", x, y, e_n51_k5.CAPACITY),),
        (Store("store", x, y),),
    )
    travel = StraightTravel(job)
    travel.metres = e_n51_k5.rounded(travel.metres)
    return assign(job, travel, Objective("distance", method, SHORT_S)).metres


def _row(name: str, cells: list[str]) -> str:
    return f"| {name} | {' | '.join(cells)} |"
