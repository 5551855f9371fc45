"""Small changes leave alone what is not to be moved, and what they find is better."""

from __future__ import annotations

from dataclasses import replace

from robot_bridge.core.assignment.job import AssignmentJob, ConeTarget, PlanRobot, Store, StraightTravel
from robot_bridge.core.assignment.local_search import improved
from robot_bridge.core.assignment.schedules import BALANCED, LEAST_DISTANCE, ScheduleEvaluator, StageObjective

# The near ones are on the way to the far one, and not on the way back from the farther one.
PLACES = {"far": (40, 0), "farther": (40, 30), "near": (20, 0), "nearer": (10, 0), "beyond": (0, 60)}
JOB = AssignmentJob(
    tuple(ConeTarget(name, *place) for name, place in PLACES.items()),
    (PlanRobot("R", 0.0, 0.0, 3), PlanRobot("S", 0.0, 0.0, 3)),
    (Store("s", 0.0, 0.0),),
)
FAR, FARTHER, NEAR, NEARER, BEYOND = (JOB.place_of[name] for name in PLACES)


def days_of(job: AssignmentJob) -> ScheduleEvaluator:
    return ScheduleEvaluator(job, StraightTravel(job).metres)


def test_what_stays_comes_first_as_it_was() -> None:
    days = days_of(JOB)
    for start in ([[], [FAR, FARTHER, NEAR]], [[], [FAR], [FARTHER, NEAR]]):
        for objective in (BALANCED, LEAST_DISTANCE):
            plan = [[*start, [NEARER]], [[], [BEYOND]]]
            made = improved(days, plan, [NEAR, NEARER], StageObjective(objective), lambda: False)
            kept = [[place for place in trip if place not in (NEAR, NEARER)] for trip in made[0]]
            assert [trip for trip in kept if trip] == [
                [place for place in trip if place != NEAR] for trip in start if trip
            ]
            order = [place for trip in made[0] for place in trip]
            assert order[:2] == [FAR, FARTHER]
            assert next(place for trip in made[1] for place in trip) == BEYOND


def test_nothing_comes_before_what_stays_on_another_trip() -> None:
    # Robot S stands where a cone is to be placed and has one aboard, but its first trip is over.
    job = replace(JOB, robots=(JOB.robots[0], PlanRobot("S", 10.0, 0.0, 3, aboard=1)))
    plan = [[[], [FAR, FARTHER], [NEARER]], [[], [BEYOND]]]
    made = improved(days_of(job), plan, [NEARER], StageObjective(LEAST_DISTANCE), lambda: False)
    assert made[1][0] == []


def test_what_stays_does_not_change_its_robot() -> None:
    # All are far away, in two places: one robot would do, but both have been there.
    places = [(1000.0, 0.0), (1000.0, 1.0), (1000.0, 0.0), (1000.0, 1.0), (0.0, 1.0)]
    targets = tuple(replace(target, x=x, y=y) for target, (x, y) in zip(JOB.targets, places, strict=True))
    robots = (PlanRobot("R", 0.0, 0.0, 4), PlanRobot("S", 0.0, 0.0, 4))
    days = days_of(replace(JOB, targets=targets, robots=robots))
    plan = [[[], [FAR, NEAR]], [[], [FARTHER, NEARER]]]
    made = improved(days, plan, [NEAR, NEARER], StageObjective(LEAST_DISTANCE), lambda: False)
    assert made[0][1][0] == FAR
    assert made[1][1][0] == FARTHER


def test_all_that_may_move_is_moved_to_where_it_is_shortest() -> None:
    days = days_of(JOB)
    plan = [[[], [FAR, FARTHER, NEAR], [NEARER]], [[], [BEYOND]]]
    everything = [FAR, FARTHER, NEAR, NEARER, BEYOND]
    made = improved(days, plan, everything, StageObjective(LEAST_DISTANCE), lambda: False)
    metres = sum(days.cost(robot, day).metres for robot, day in enumerate(made))
    # Room for three: the far ones on one trip, the near ones on another.
    assert metres == (40.0 + 30.0 + 50.0 + 60.0) + 2 * 20.0
    assert sorted(place for day in made for trip in day for place in trip) == sorted(everything)


def test_it_stops_when_it_is_told() -> None:
    days = days_of(JOB)
    plan = [[[], [FAR, FARTHER, NEAR], [NEARER]], [[], [BEYOND]]]
    assert improved(days, plan, [NEAR, NEARER], StageObjective(), lambda: True) == plan
