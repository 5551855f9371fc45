"""The grid finds exactly the pairs that looking at every pair finds."""

import numpy as np
import pytest

from robot_bridge.core.geometry import close_pairs, pairs_between


def brute_force(xy, reach):
    i, j = np.triu_indices(len(xy), 1)
    apart = np.hypot(*(xy[i] - xy[j]).T)
    return {(a, b): d for a, b, d in zip(i.tolist(), j.tolist(), apart.tolist(), strict=True) if d <= reach}


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    ("count", "side", "reach"), [(2, 1, 2.0), (300, 40, 1.3), (400, 10, 0.9), (50, 3, 5.0)]
)
def test_the_pairs_are_those_of_brute_force(seed, count, side, reach):
    xy = np.random.default_rng(seed).uniform(-side, side, (count, 2))
    one, other, apart = close_pairs(xy, reach)
    found = dict(zip(zip(one.tolist(), other.tolist(), strict=True), apart.tolist(), strict=True))
    assert len(found) == len(one)
    assert found == pytest.approx(brute_force(xy, reach))


def test_robots_on_the_borders_of_cells_and_on_one_spot_are_pairs():
    xy = np.array([(-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (0.0, 0.0), (0.0, -1.0), (1.0, 1.0)])
    one, other, _ = close_pairs(xy, 1.0)
    assert set(zip(one.tolist(), other.tolist(), strict=True)) == set(brute_force(xy, 1.0))


@pytest.mark.parametrize("xy", [np.empty((0, 2)), np.array([(1.0, 2.0)])])
def test_nobody_is_near_where_there_is_one_or_none(xy):
    assert [len(part) for part in close_pairs(xy, 1.0)] == [0, 0, 0]


def test_no_reach_makes_no_pair():
    assert len(close_pairs(np.zeros((3, 2)), 0.0)[0]) == 0


@pytest.mark.parametrize("seed", range(4))
def test_the_pairs_between_two_crowds_are_those_of_brute_force(seed):
    random = np.random.default_rng(seed)
    ones, others = random.uniform(-9, 9, (60, 2)), random.uniform(-9, 9, (80, 2))
    others[:3] = ones[:3]
    one, other, apart = pairs_between(ones, others, 1.5)
    found = dict(zip(zip(one.tolist(), other.tolist(), strict=True), apart.tolist(), strict=True))
    assert len(found) == len(one)
    away = np.hypot(*(ones[:, None] - others[None]).transpose(2, 0, 1))
    near = {(i, j): away[i, j] for i, j in zip(*np.nonzero(away <= 1.5), strict=True)}
    assert found == pytest.approx(near)
    assert {(0, 0), (1, 1), (2, 2)} <= set(found)
