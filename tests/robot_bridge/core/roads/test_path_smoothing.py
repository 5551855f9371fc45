"""Dense paths can be driven: close points, round corners, and all of it on the road."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import RoadInputError
from robot_bridge.core.roads.path_smoothing import DensePath, Driving, dense_path

CORNER = np.array([(0.0, 0.0), (20.0, 0.0), (20.0, 20.0)])


def path(line: np.ndarray, width: float, **driving: float) -> DensePath:
    return dense_path(line, np.full(len(line) - 1, width), Driving(**driving))


def steps(points: np.ndarray) -> np.ndarray:
    return np.hypot(*np.diff(points, axis=0).T)


def test_points_are_as_close_as_asked_and_none_repeats() -> None:
    made = path(CORNER, 10.0, spacing=0.5, turning_radius=3.0)
    assert steps(made.points).max() <= 0.5 + 1e-9
    assert steps(made.points).min() > 1e-6
    assert made.points[0].tolist() == [0.0, 0.0]
    assert made.points[-1].tolist() == [20.0, 20.0]


def test_a_corner_becomes_an_arc_of_the_turning_radius() -> None:
    made = path(CORNER, 10.0, spacing=0.1, turning_radius=3.0)
    arc = made.points[(made.points[:, 0] > 17.0 + 1e-6) & (made.points[:, 1] < 3.0 - 1e-6)]
    away = np.hypot(*(arc - (17.0, 3.0)).T)
    assert len(arc) > 5
    # Between its points the arc is chords, at most 10 degrees each.
    assert away.max() == pytest.approx(3.0, abs=1e-6)
    assert away.min() >= 3.0 * math.cos(math.radians(5.0)) - 1e-9
    assert made.least_radius == pytest.approx(3.0)
    assert len(made.tight) == 0
    assert made.greatest_offset == pytest.approx(3.0 * (math.sqrt(2) - 1))


def test_on_a_narrow_road_the_corner_is_cut_no_further_than_the_road_is_wide() -> None:
    made = path(CORNER, 1.5, turning_radius=3.0, robot_width=0.5)
    assert made.greatest_offset == pytest.approx(0.5)
    assert made.least_radius == pytest.approx(0.5 / (math.sqrt(2) - 1))
    assert made.tight.tolist() == [[20.0, 0.0]]


def test_a_road_no_wider_than_the_robot_keeps_its_corner() -> None:
    made = path(CORNER, 0.5, robot_width=0.5)
    assert made.least_radius == 0.0
    assert [20.0, 0.0] in made.points.tolist()


def test_turning_back_is_a_tight_corner() -> None:
    made = path(np.array([(0.0, 0.0), (9.0, 0.0), (2.0, 0.0)]), 5.0)
    assert made.tight.tolist() == [[9.0, 0.0]]
    assert np.isfinite(made.points).all()


def test_a_digitised_bend_is_as_round_as_it_was_drawn() -> None:
    angles = np.linspace(0, math.pi / 2, 19)
    made = path(10.0 * np.column_stack([np.cos(angles), np.sin(angles)]), 4.0, turning_radius=2.0)
    assert len(made.tight) == 0
    assert made.greatest_offset < 0.05


def test_wobbles_of_digitising_are_no_bends() -> None:
    x = np.arange(0, 20, 0.2)
    made = path(np.column_stack([x, 0.01 * (-1.0) ** np.arange(len(x))]), 3.0)
    assert made.least_radius == math.inf


def test_standing_still_has_two_points() -> None:
    assert path(np.zeros((2, 2)), 3.0).points.tolist() == [[0.0, 0.0], [0.0, 0.0]]


@pytest.mark.parametrize("wrong", [{"spacing": 0.0}, {"turning_radius": -1.0}, {"robot_width": math.nan}])
def test_what_cannot_be_driven_is_refused_by_name(wrong: dict[str, float]) -> None:
    with pytest.raises(RoadInputError, match=next(iter(wrong))):
        Driving(**wrong)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_no_robot_leaves_the_road_whatever_its_shape(seed: int) -> None:
    shapely = pytest.importorskip("shapely")
    random = np.random.default_rng(seed)
    line = np.cumsum(random.normal(0, 5, (8, 2)), axis=0)
    widths = random.uniform(0.6, 8.0, 7)
    made = dense_path(line, widths, Driving(turning_radius=4.0, robot_width=0.5))
    road = shapely.union_all(
        [shapely.LineString(line[k : k + 2]).buffer(widths[k] / 2 + 1e-6, quad_segs=64) for k in range(7)]
    )
    robot = shapely.LineString(made.points).buffer(0.25, quad_segs=16)
    assert shapely.difference(robot, road).area < 1e-3
