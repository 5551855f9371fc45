"""How far robots still have to go."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.desk.live.plans import Plans
from fleet_supervisor.robot_bridge.messages import CommandReport, CommandState


def task(op, params, command="c1", robot="r1"):
    return CommandReport(command, robot, op, params, "anna", CommandState.ACKNOWLEDGED)


def at(x, y):
    return np.array([x, y], dtype=float)


def test_to_a_target_it_is_the_straight_line():
    plans = Plans()
    (plan,) = plans.of([task("SetPosEnd", {"x": 3.0, "y": 4.0, "cone": True})])
    assert plan.cone and not plan.is_way
    assert plans.remaining(plan, at(0, 0)) == pytest.approx(5.0)


def test_along_a_way_it_is_the_way_and_not_the_straight_line():
    plans = Plans()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [10, 0], [10, 10], [0, 10]]})])
    assert plans.remaining(plan, at(0, 0)) == pytest.approx(30.0)
    assert plans.remaining(plan, at(10, 4)) == pytest.approx(16.0)
    assert plans.remaining(plan, at(0, 10)) == pytest.approx(0.0)


def test_on_a_second_lap_the_first_is_done():
    lap = [[0, 0], [50, 0], [50, 50], [0, 50], [0, 0]]
    plans = Plans()
    (plan,) = plans.of([task("SetPath", {"points": lap + lap[1:]})])
    left = [plans.remaining(plan, at(*point)) for point in (lap + lap[1:])]
    assert left == pytest.approx([400 - 50 * k for k in range(9)])


def test_who_is_off_the_way_has_to_come_to_it_first():
    plans = Plans()
    (plan,) = plans.of([task("SetPath", {"points": [[0, 0], [100, 0]]})])
    assert plans.remaining(plan, at(40, 30)) == pytest.approx(90.0)


@pytest.mark.parametrize("params", [{}, {"x": None, "y": 1.0}, {"x": "here", "y": 2.0}])
def test_a_command_that_says_no_place_has_no_plan(params):
    assert Plans().of([task("SendMap", params)]) == []


def test_a_plan_is_made_once_and_forgotten_with_its_command():
    plans = Plans()
    wanted = [task("SetPosEnd", {"x": 1.0, "y": 1.0})]
    assert plans.of(wanted)[0] is plans.of(wanted)[0]
    assert plans.of([]) == []
    assert not plans._known


def test_many_new_plans_are_made_bit_by_bit_and_each_once():
    plans, wanted = Plans(), [task("SetPosEnd", {"x": 1.0, "y": 1.0}, f"c{k}") for k in range(5)]
    counts, first = [], plans.of(wanted, at_once=2)[0]
    while not plans.is_whole:
        counts.append(len(plans.of(wanted, at_once=2)))
    assert counts == [4, 5]
    assert plans.of(wanted, at_once=2)[0] is first


def test_the_list_of_plans_is_another_when_and_only_when_a_task_is():
    plans, wanted = (
        Plans(),
        [task("SetPosEnd", {"x": 1.0, "y": 1.0}), task("SetPosEnd", {"x": 2.0, "y": 1.0}, "c2")],
    )
    before = plans.of(wanted)
    assert plans.of(list(wanted)) is before
    assert plans.of(wanted[:1]) is not before
    assert [plan.command for plan in plans.of(wanted[:1])] == ["c1"]
