"""Headings run clockwise from north, theta counter-clockwise from east."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.core.geometry import heading_of, headings_of, theta_of


@pytest.mark.parametrize(
    ("heading", "theta"), [(90.0, 0.0), (0.0, math.pi / 2), (180.0, -math.pi / 2), (45.0, math.pi / 4)]
)
def test_a_heading_and_its_theta(heading, theta):
    assert theta_of(heading) == pytest.approx(theta)
    assert heading_of(theta) == pytest.approx(heading)


def test_a_heading_is_less_than_a_turn_whatever_theta_is():
    assert heading_of(math.pi) == pytest.approx(270.0)
    assert heading_of(-7 * math.pi) == pytest.approx(270.0)


def test_many_are_as_one_by_one_and_what_is_not_known_stays_so():
    theta = np.array([0.0, 2.0, -3.0, np.nan])
    headings = headings_of(theta)
    assert headings[:3] == pytest.approx([heading_of(one) for one in theta[:3].tolist()])
    assert np.isnan(headings[3])
