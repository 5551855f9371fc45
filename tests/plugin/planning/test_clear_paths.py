"""Ways round cones: never over one, and on from where they began to where they were to end."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from fleet_supervisor.robot_bridge.core.assignment.clearance import ClearTravel, detour, obstacle_distances
from fleet_supervisor.robot_bridge.core.assignment.job import (
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    StraightTravel,
    straight_path,
)
from hypothesis import given, settings
from hypothesis import strategies as st

CLEARANCE = 0.6


def room(obstacles):
    return np.full(len(obstacles), CLEARANCE)


def way(*points):
    return np.array(points, dtype=float)


def nearest(points, obstacle):
    """How near the way comes to a point, by looking every centimetre."""
    legs = [
        a + (b - a) * np.linspace(0, 1, max(int(np.hypot(*(b - a)) / 0.01), 2))[:, None]
        for a, b in pairwise(points)
    ]
    return min(float(np.hypot(*(leg - obstacle).T).min()) for leg in legs)


def test_a_way_past_a_row_of_cones_goes_round_each_and_ends_where_it_was_to():
    row = way((5, 0), (10, 0), (15, 0))
    points = detour(straight_path(*way((0, 0), (20, 0)), 0.5), row, room(row))
    assert points[0].tolist() == [0, 0] and points[-1].tolist() == [20, 0]
    assert min(nearest(points, cone) for cone in row) >= CLEARANCE - 1e-6
    length = np.hypot(*np.diff(points, axis=0).T).sum()
    assert 20 < length < 20 + 3 * (np.pi - 2) * CLEARANCE * 1.2


def test_a_way_that_is_clear_stays_as_it_is():
    points = straight_path(*way((0, 0), (20, 0)), 0.5)
    assert np.array_equal(detour(points, way((10, 0.7), (3, -5)), room(way((0, 0), (0, 0)))), points)


def test_the_cones_that_a_way_begins_and_ends_at_are_not_in_its_way():
    points = straight_path(*way((0, 0), (10, 0)), 0.5)
    assert np.array_equal(detour(points, way((0, 0), (10, 0)), room(way((0, 0), (0, 0)))), points)


def test_beside_a_wall_of_cones_it_goes_round_on_the_side_that_is_open():
    wall = way((10, 0), (10, 0.9), (10, 1.8), (10, 2.7))
    points = detour(straight_path(*way((0, 0.1), (20, 0.1)), 0.5), wall, room(wall))
    assert min(nearest(points, cone) for cone in wall) >= CLEARANCE - 1e-6
    assert points[:, 1].min() < -0.5


@settings(max_examples=80, deadline=None)
@given(
    st.lists(st.tuples(st.integers(1, 9), st.integers(-4, 4)), max_size=12, unique=True),
    st.floats(-5, 5),
    st.floats(-5, 5),
)
def test_among_cones_three_metres_apart_every_way_is_clear(cells, first, last):
    cones = np.array([(3.0 * x, 3.0 * y) for x, y in cells]).reshape(-1, 2)
    points = straight_path(*way((0, first), (30, last)), 0.5)
    out = detour(points, cones, room(cones))
    ends = points[[0, -1]]
    for cone in cones:
        if np.hypot(*(ends - cone).T).min() > CLEARANCE:
            assert nearest(out, cone) >= CLEARANCE - 1e-6
    assert out[0].tolist() == ends[0].tolist() and out[-1].tolist() == ends[1].tolist()


def test_distances_are_those_of_the_nearest_point_of_a_leg_not_of_its_ends():
    found = obstacle_distances(way((0, 0), (10, 0)), way((5, 3), (-4, 3), (13, -4)))
    assert found == pytest.approx([3, 5, 5])


def test_the_ways_of_a_job_go_round_its_cones_and_what_stands():
    job = AssignmentJob(
        (ConeTarget("a", 20, 0), ConeTarget("b", 10, 0)), (PlanRobot("r1", 0, 0, 8, aboard=8),), (), "stay"
    )
    obstacles = np.array([(20, 0), (10, 0), (15, 0)])
    travel = ClearTravel(StraightTravel(job), job.places, obstacles, room(obstacles))
    points = travel.path(0, job.place_of["a"])
    assert min(nearest(points, way(place)[0]) for place in ((10, 0), (15, 0))) >= CLEARANCE - 1e-6
    assert travel.name == "straight lines" and travel.metres[0][job.place_of["a"]] == 20


def test_each_obstacle_is_kept_off_by_its_own_clearance():
    points = straight_path(*way((0, 0), (20, 0)), 0.5)
    out = detour(points, way((5, 0.1), (13, 0.1)), np.array([0.6, 1.0]))
    assert 0.6 <= nearest(out, (5, 0.1)) < 0.75
    assert 1.0 <= nearest(out, (13, 0.1)) < 1.2
