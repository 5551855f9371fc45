"""Resampling takes no side, and the number of particles follows the spread."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.reference_robot.localisation.scan_matching import (
    in_groups,
    low_variance,
    occupied_bins,
    particles_for,
)
from robot_bridge.reference_robot.localisation.settings import FilterSettings, RecoverySettings

weights = st.lists(st.floats(0, 1), min_size=1, max_size=40).filter(lambda given: sum(given) > 1e-3)


@given(weights, st.integers(1, 200), st.integers(0, 2**32))
def test_each_particle_is_drawn_as_often_as_its_weight_says_to_within_one(given_weights, count, seed):
    shares = np.array(given_weights) / sum(given_weights)
    drawn = low_variance(shares, count, np.random.default_rng(seed))
    assert len(drawn) == count and (np.diff(drawn) >= 0).all()
    times = np.bincount(drawn, minlength=len(shares))
    assert (times >= np.floor(shares * count - 1e-6)).all()
    assert (times <= np.ceil(shares * count + 1e-6)).all()


def test_on_average_it_is_exactly_as_often():
    rng = np.random.default_rng(1)
    shares = rng.dirichlet(np.ones(50))
    runs = 20_000
    times = sum(np.bincount(low_variance(shares, 20, rng), minlength=50) for _ in range(runs)) / runs
    # A particle is drawn n or n + 1 times: the mean of so many runs is within 5 standard errors.
    assert np.abs(times - 20 * shares).max() < 5 * 0.5 / np.sqrt(runs)


def test_as_many_particles_as_the_chi_square_quantile_asks_for():
    settings = FilterSettings(least=10, most=100_000, kld_error=0.05)
    # 99 % quantiles of chi-square with 9, 49 and 99 degrees of freedom: 21.67, 74.92, 134.64.
    for bins, quantile in ((10, 21.67), (50, 74.92), (100, 134.64)):
        assert particles_for(bins, settings) == pytest.approx(quantile / (2 * 0.05), rel=0.01)
    assert particles_for(1, settings) == 10
    assert particles_for(10**6, settings) == 100_000


def test_bins_are_of_place_and_heading():
    settings = FilterSettings(bin_size=0.5, bin_turn_deg=10.0)
    at = np.array([0.25, 0.25, 0.01])
    assert occupied_bins(np.array([at, at + 0.1]), settings) == 1
    assert occupied_bins(np.add(at, ((0, 0, 0), (0.5, 0, 0), (0, -0.5, 0), (0, 0, 0.2))), settings) == 4
    assert occupied_bins(np.add(at, ((0, 0, 0), (0, 0, 2 * np.pi))), settings) == 1


@given(st.integers(1, 12), st.integers(50, 400), st.integers(0, 2**32))
def test_groups_keep_their_weight_and_none_of_note_dies_out(groups, count, seed):
    rng = np.random.default_rng(seed)
    group = rng.integers(0, groups, 300)
    weights = rng.dirichlet(np.ones(300))
    rows, drawn = in_groups(weights, group, count, rng, RecoverySettings())
    assert drawn.sum() == pytest.approx(1)
    for one in np.unique(group):
        assert drawn[group[rows] == one].sum() == pytest.approx(weights[group == one].sum())
        assert (group[rows] == one).sum() >= 20


def test_groups_that_weigh_nothing_are_left_out():
    group = np.repeat([0, 1, 2], 10)
    weights = np.repeat([0.06, 0.03999, 0.00001], 10)
    rows, _ = in_groups(weights, group, 100, np.random.default_rng(1), RecoverySettings())
    assert set(group[rows]) == {0, 1}
