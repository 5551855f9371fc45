"""How far robots still have to go."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.scene import TaskPaths
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState


def task(op, params, command="c1", robot="r1"):
    return CommandReport(command, robot, op, params, "anna", CommandState.ACKNOWLEDGED)


def at(x, y):
    return np.array([x, y], dtype=float)


def test_to_a_target_it_is_the_straight_line():
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPosEnd", {"x": 3.0, "y": 4.0, "cone": True})])
    assert plan.cone and not plan.is_way
    assert plans.remaining(plan, at(0, 0)) == pytest.approx(5.0)


def test_along_a_way_it_is_the_way_and_not_the_straight_line():
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [10, 0], [10, 10], [0, 10]]})])
    assert plans.remaining(plan, at(0, 0)) == pytest.approx(30.0)
    assert plans.remaining(plan, at(10, 4)) == pytest.approx(16.0)
    assert plans.remaining(plan, at(0, 10)) == pytest.approx(0.0)


def test_on_a_second_lap_the_first_is_done():
    lap = [[0, 0], [50, 0], [50, 50], [0, 50], [0, 0]]
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": lap + lap[1:]})])
    left = [plans.remaining(plan, at(*point)) for point in (lap + lap[1:])]
    assert left == pytest.approx([400 - 50 * k for k in range(9)])


@pytest.mark.parametrize("shift", [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.0, -0.1), (0.4, 0.7)])
def test_on_a_lap_that_ends_where_it_begins_all_of_it_is_still_to_go_at_first(shift):
    dx, dy = shift
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [50, 0], [50, 50], [0, 50], [0, 0]]})])
    assert plans.remaining(plan, at(dx, dy)) == pytest.approx(200.0, abs=1.0)
    assert plans.remaining(plan, at(50 + dx, dy)) == pytest.approx(150.0, abs=1.0)
    assert plans.remaining(plan, at(50 + dx, 50 + dy)) == pytest.approx(100.0, abs=1.0)
    assert plans.remaining(plan, at(dx, 50 + dy)) == pytest.approx(50.0, abs=1.5)
    assert plans.remaining(plan, at(dx, 1 + dy)) == pytest.approx(1.0, abs=1.5)


def test_who_has_left_the_way_has_to_come_back_to_it():
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [100, 0]]})])
    assert plans.remaining(plan, at(30, 0)) == pytest.approx(70.0)
    assert plans.remaining(plan, at(40, 30)) == pytest.approx(90.0)


def test_who_has_not_come_to_the_way_yet_goes_to_its_first_point_though_its_end_is_nearer():
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [60, 0]]})])
    assert plans.remaining(plan, at(60, 20)) == pytest.approx(np.hypot(60, 20) + 60)
    assert plans.remaining(plan, at(30, 10)) == pytest.approx(np.hypot(30, 10) + 60)
    assert plans.remaining(plan, at(0.3, 0.2)) == pytest.approx(60.0, abs=0.5)
    assert plans.remaining(plan, at(20, 0)) == pytest.approx(40.0)


def test_who_passes_the_first_point_far_beside_is_on_the_way_from_there():
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [60, 0]]})])
    assert plans.remaining(plan, at(-10, 3)) == pytest.approx(np.hypot(10, 3) + 60)
    assert plans.remaining(plan, at(0, 3)) == pytest.approx(63.0)
    assert plans.remaining(plan, at(5, 3)) == pytest.approx(58.0)


def test_a_desk_that_comes_in_the_middle_of_a_way_sees_the_rest_of_it():
    plans = TaskPaths()
    (plan,) = plans.of([task("SetPath", {"points": [[k * 0.5, 0] for k in range(201)]})])
    assert plans.remaining(plan, at(40, 0.2)) == pytest.approx(60.0, abs=0.3)


@pytest.mark.parametrize("params", [{}, {"x": None, "y": 1.0}, {"x": "here", "y": 2.0}])
def test_a_command_that_says_no_place_has_no_plan(params):
    assert TaskPaths().of([task("SendMap", params)]) == []


def test_a_plan_is_made_once_and_forgotten_with_its_command():
    plans = TaskPaths()
    wanted = [task("SetPosEnd", {"x": 1.0, "y": 1.0})]
    assert plans.of(wanted)[0] is plans.of(wanted)[0]
    assert plans.of([]) == []
    assert not plans._known


def test_many_new_plans_are_made_bit_by_bit_and_each_once():
    plans, wanted = TaskPaths(), [task("SetPosEnd", {"x": 1.0, "y": 1.0}, f"c{k}") for k in range(5)]
    counts, first = [], plans.of(wanted, at_once=2)[0]
    while not plans.is_whole:
        counts.append(len(plans.of(wanted, at_once=2)))
    assert counts == [4, 5]
    assert plans.of(wanted, at_once=2)[0] is first


def test_the_list_of_plans_is_another_when_and_only_when_a_task_is():
    plans, wanted = (
        TaskPaths(),
        [task("SetPosEnd", {"x": 1.0, "y": 1.0}), task("SetPosEnd", {"x": 2.0, "y": 1.0}, "c2")],
    )
    before = plans.of(wanted)
    assert plans.of(list(wanted)) is before
    assert plans.of(wanted[:1]) is not before
    assert [plan.command for plan in plans.of(wanted[:1])] == ["c1"]
