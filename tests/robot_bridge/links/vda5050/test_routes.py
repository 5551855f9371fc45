"""Routes become orders with a base that grows as it is driven."""

from __future__ import annotations

import math

import pytest
from fleet_supervisor.robot_bridge.links.vda5050.tasks import RouteLimits, begin_plan
from hypothesis import given
from hypothesis import strategies as st

LIMITS = RouteLimits(base_length=30.0, most_nodes=10)
PATH = [(5.0, 0.0), (40.0, 0.0), (40.0, 80.0), (0.0, 80.0)]
POINTS = st.lists(st.tuples(st.floats(-500, 500), st.floats(-500, 500)), min_size=1, max_size=40)


def plan_of(points, limits=LIMITS, position=(0.0, 0.0), theta=None):
    return begin_plan("run-7", "hall", position, points, theta, limits)


def test_a_target_is_an_order_of_two_nodes():
    order = plan_of([(10.0, 0.0)], theta=1.5).order(LIMITS)

    assert [(n.sequence_id, n.released, n.node_position.x) for n in order.nodes] == [
        (0, True, 0.0),
        (2, True, 10),
    ]
    assert [(e.sequence_id, e.released) for e in order.edges] == [(1, True)]
    assert order.nodes[1].node_position.theta == 1.5


def test_only_the_base_is_released():
    plan = plan_of(PATH)
    order = plan.order(LIMITS)

    released = [node for node in order.nodes if node.released]
    assert released[-1].node_position.x <= 30.0
    assert not order.nodes[-1].released
    assert [edge.released for edge in order.edges] == [node.released for node in order.nodes[1:]]


def test_an_update_begins_with_the_last_base_node():
    plan = plan_of(PATH)
    passed = plan.base_end
    update = plan.extended(passed, LIMITS)

    assert update is not None
    order = update.order(LIMITS)
    assert order.order_update_id == 1
    assert order.nodes[0].node_id == plan.node_id(plan.base_end)
    assert order.nodes[0].sequence_id == 2 * plan.base_end
    assert order.nodes[0].released and order.nodes[1].released


def test_a_base_is_not_lengthened_before_half_of_it_is_driven():
    assert plan_of(PATH).extended(0, LIMITS) is None


def test_a_loop_that_ends_where_it_began_is_driven_round():
    loop = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)]
    plan = plan_of(loop)

    assert plan.points[0] == plan.points[-1] == (0.0, 0.0)
    assert sum(map(math.dist, plan.points, plan.points[1:])) == pytest.approx(80.0)


def test_points_on_a_straight_line_are_one_edge():
    dense = [(x / 2, 0.0) for x in range(41)]
    assert len(plan_of(dense).points) == 2


@given(POINTS, st.floats(2, 100), st.integers(2, 30))
def test_updates_release_every_node_once_and_end_at_the_last(points, base_length, most_nodes):
    limits = RouteLimits(base_length=base_length, most_nodes=most_nodes)
    plan = plan_of(points, limits)
    released = list(range(plan.base_end + 1))
    while (longer := plan.extended(plan.base_end, limits)) is not None:
        order = longer.order(limits)
        assert len(order.nodes) <= most_nodes
        assert order.nodes[0].sequence_id == 2 * plan.base_end
        released += [n.sequence_id // 2 for n in order.nodes[1:] if n.released]
        plan = longer

    assert released == list(range(plan.last + 1))
    assert plan.end == pytest.approx(points[-1], abs=0.02)


@given(POINTS, st.floats(2, 100))
def test_no_more_than_the_base_length_is_released_ahead(points, base_length):
    limits = RouteLimits(base_length=base_length)
    plan = plan_of(points, limits)
    ahead = sum(math.dist(plan.points[i], plan.points[i + 1]) for i in range(plan.base_end))
    assert ahead <= base_length + 0.02
