"""Ray casting held against shapely on random maps, and its two evaluations against one another."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
import shapely

from robot_bridge.reference_robot.localisation.ray_casting import FEW_CELLS, RayCaster
from robot_bridge.reference_robot.localisation.segments import merge_collinear
from robot_bridge.reference_robot.localisation.settings import ReferenceRobotError

REACH = 25.0
NUMBA = pytest.param(
    True, id="numba", marks=pytest.mark.skipif(not importlib.util.find_spec("numba"), reason="no numba")
)
EVALUATIONS = [pytest.param(False, id="numpy"), NUMBA]


def random_walls(rng, count=250, size=60.0):
    """Walls of any length and direction, all over."""
    a = rng.uniform(0, size, (count, 2))
    length, angle = rng.exponential(4.0, count), rng.uniform(0, 2 * np.pi, count)
    return a, a + length[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def blocks(rng, count=40, size=60.0):
    """Houses along the axes on whole decimetres, some with walls on one line, drawn in pieces both ways."""
    low = np.round(rng.uniform(0, size, (count, 2)), 1)
    width, height = np.round(rng.uniform(0.3, 8, (2, count)), 1)
    x, y = low.T
    corners = np.stack(
        [np.stack(c, axis=1) for c in ((x, y), (x + width, y), (x + width, y + height), (x, y + height))],
        axis=1,
    )
    a = corners.reshape(-1, 2)
    b = np.roll(corners, -1, axis=1).reshape(-1, 2)
    middle = a + (b - a) * 0.25
    return np.concatenate([a, b]), np.concatenate([middle, middle])


def by_shapely(a, b, poses, bearings, reach):
    """Return the ranges as the distance to the nearest intersection."""
    angle = poses[:, 2:] + bearings
    begin = np.repeat(poses[:, None, :2], len(bearings), axis=1)
    end = begin + reach * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    rays = shapely.linestrings(np.stack([begin, end], axis=2).reshape(-1, 2, 2))
    walls = shapely.linestrings(np.stack([a, b], axis=1))
    ray, wall = shapely.STRtree(walls).query(rays, predicate="intersects")
    met = shapely.intersection(rays[ray], walls[wall])
    ranges = np.full(len(rays), reach)
    np.minimum.at(ranges, ray, shapely.distance(met, shapely.points(begin.reshape(-1, 2))[ray]))
    return ranges.reshape(angle.shape)


@pytest.mark.parametrize("compiled", EVALUATIONS)
@pytest.mark.parametrize("walls", [random_walls, blocks])
@pytest.mark.parametrize("spread", [0.2, 30.0])
def test_ranges_are_those_of_shapely_to_the_millimetre(compiled, walls, spread):
    rng = np.random.default_rng(20)
    a, b = walls(rng)
    # Together they are cast from fine cells, apart from coarse ones.
    poses = np.append(rng.uniform(25, 35, 2), 0.0) + rng.normal(0, (spread, spread, 2.0), (100, 3))
    bearings = np.sort(rng.uniform(-np.pi, np.pi, 100))
    caster = RayCaster(a, b, REACH, compiled)
    found = caster.cast(poses, bearings)
    assert found.shape == (100, 100)
    np.testing.assert_allclose(found, by_shapely(a, b, poses, bearings, REACH), atol=1e-3)
    assert 0.2 < np.mean(found < REACH) <= 1.0


@pytest.mark.parametrize("compiled", EVALUATIONS)
def test_places_far_from_zero_cost_no_digits(compiled):
    rng = np.random.default_rng(4)
    a, b = random_walls(rng)
    poses = rng.uniform((0, 0, -3), (60, 60, 3), (20, 3))
    bearings = np.linspace(-2, 2, 30)
    far = np.array([640_000.0, 5_190_000.0])
    near_zero = RayCaster(a, b, REACH, compiled).cast(poses, bearings)
    at_utm = RayCaster(a + far, b + far, REACH, compiled).cast(poses + np.append(far, 0), bearings)
    np.testing.assert_allclose(at_utm, near_zero, atol=1e-6)


@pytest.mark.skipif(not importlib.util.find_spec("numba"), reason="no numba")
def test_both_evaluations_agree_whatever_the_turns():
    rng = np.random.default_rng(5)
    a, b = blocks(rng)
    poses = rng.uniform((0, 0, -50), (60, 60, 50), (FEW_CELLS // 2, 3))
    bearings = rng.uniform(-30, 30, 64)
    plain, compiled = (RayCaster(a, b, REACH, which).cast(poses, bearings) for which in (False, True))
    np.testing.assert_allclose(plain, compiled, atol=1e-9)


@pytest.mark.parametrize("compiled", EVALUATIONS)
def test_a_ray_through_a_corner_does_not_slip_between_its_walls(compiled):
    corner = np.array([[5.0, 3.0]])
    a, b = np.concatenate([corner, corner]), np.array([[9.0, 3.0], [5.0, 9.0]])
    caster = RayCaster(a, b, REACH, compiled)
    towards = np.arctan2(3.0, 5.0)
    assert caster.cast(np.array([[0, 0, towards]]), np.zeros(1)) == pytest.approx(np.hypot(5, 3))


@pytest.mark.parametrize("compiled", EVALUATIONS)
def test_nothing_in_reach_is_as_far_as_the_reach(compiled):
    a, b = np.array([[100.0, -1.0]]), np.array([[100.0, 1.0]])
    bearings = np.linspace(-3, 3, 7)
    assert (RayCaster(a, b, REACH, compiled).cast(np.zeros((3, 3)), bearings) == REACH).all()
    assert (RayCaster(a[:0], b[:0], REACH, compiled).cast(np.zeros((3, 3)), bearings) == REACH).all()
    # Just within and just beyond it.
    at = np.array([[100 - REACH + 0.01, 0, 0], [100 - REACH - 0.01, 0, 0]])
    near, beyond = RayCaster(a, b, REACH, compiled).cast(at, np.zeros(1))[:, 0]
    assert near == pytest.approx(REACH - 0.01) and beyond == REACH


def test_what_is_not_finite_is_refused():
    a, b = np.zeros((1, 2)), np.ones((1, 2))
    with pytest.raises(ReferenceRobotError, match="not finite"):
        RayCaster(a, b, REACH).cast(np.array([[0, np.nan, 0]]), np.zeros(1))
    with pytest.raises(ReferenceRobotError, match="not finite"):
        RayCaster(a, b, REACH).cast(np.zeros((1, 3)), np.array([np.inf]))
    with pytest.raises(ReferenceRobotError, match="all finite"):
        RayCaster(a * np.nan, b, REACH)
    with pytest.raises(ReferenceRobotError, match="reach"):
        RayCaster(a, b, 0.0)


@pytest.mark.parametrize("walls", [random_walls, blocks])
def test_merged_segments_cover_the_same(walls):
    a, b = walls(np.random.default_rng(6))
    # Each twice, the second time the other way round: one remains.
    few_a, few_b = merge_collinear(np.concatenate([a, b]), np.concatenate([b, a]))
    assert len(few_a) <= len(a)
    before, after = (
        shapely.union_all(shapely.linestrings(np.stack(ends, axis=1))) for ends in ((a, b), (few_a, few_b))
    )
    assert shapely.hausdorff_distance(before, after) < 1e-3
    assert after.length == pytest.approx(before.length, abs=1e-2)


def test_segments_on_one_line_become_one_only_where_they_meet():
    a = np.array([[0.0, 0.0], [3.0, 0.0], [1.0, 0.0], [5.0, 0.0], [0.0, 0.1]])
    b = np.array([[1.0, 0.0], [1.5, 0.0], [2.0, 0.0], [6.0, 0.0], [1.0, 0.1]])
    few_a, few_b = merge_collinear(a, b)
    assert sorted(zip(few_a[:, 0], few_b[:, 0], few_a[:, 1], strict=True)) == [
        (0.0, 1.0, 0.1),
        (0.0, 3.0, 0.0),
        (5.0, 6.0, 0.0),
    ]
