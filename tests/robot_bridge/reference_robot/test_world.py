"""What the laser sees of a map, and how the world may differ from it."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.reference_robot.localisation.settings import WorldSettings
from robot_bridge.reference_robot.localisation.world import changed, inside_solids, walls_of


def test_stairs_ramps_and_what_is_lower_than_the_laser_are_not_seen(yard):
    walls = walls_of(yard)
    assert len(walls) == 4 + 6 + 4 + 4 + 4 + 4 + 1
    assert len(walls.higher_than(0.4)) == len(walls) - 1  # the kerb
    assert set(walls.higher_than(1.0).height) == {3.0, 6.0, 9.0}


def test_a_world_without_changes_is_the_map(yard):
    walls = walls_of(yard).higher_than(0.4)
    same = changed(walls, WorldSettings(), np.random.default_rng(1))
    lines = [shapely.union_all(shapely.linestrings(np.stack([w.a, w.b], axis=1))) for w in (walls, same)]
    assert shapely.hausdorff_distance(*lines) < 1e-6


@pytest.mark.parametrize("seed", range(5))
def test_walls_and_furniture_are_moved_by_as_much_as_is_set_and_no_more(yard, seed):
    walls = walls_of(yard).higher_than(0.4)
    world = changed(walls, WorldSettings(moved=0.1), np.random.default_rng(seed))
    before, after = (shapely.linestrings(np.stack([w.a, w.b], axis=1)) for w in (walls, world))
    away = [min(shapely.hausdorff_distance(one, other) for other in before) for one in after]
    assert 0.05 < max(away) < 0.1 * np.sqrt(2) + 1e-9
    np.testing.assert_allclose(shapely.length(after).sum(), shapely.length(before).sum())
    # The four sides of a bin stay together.
    bins = shapely.polygonize(after[-8:]).geoms
    assert sorted(round(one.area, 6) for one in bins) == [0.25, 0.9]


def test_the_share_of_furniture_that_is_set_is_missing(yard):
    walls = walls_of(yard).higher_than(0.4)
    rng = np.random.default_rng(3)
    assert len(changed(walls, WorldSettings(missing=0.5), rng)) == len(walls) - 4
    assert len(changed(walls, WorldSettings(missing=1.0), rng)) == len(walls) - 8
    # The smaller house is furniture to one who says so.
    assert len(changed(walls, WorldSettings(missing=1.0, furniture=9.5), rng)) == 4


def test_the_same_seed_makes_the_same_world_and_another_one_another(yard):
    walls = walls_of(yard)
    settings = WorldSettings(moved=0.1, missing=0.5)
    first, again, other = (changed(walls, settings, np.random.default_rng(seed)) for seed in (7, 7, 8))
    np.testing.assert_array_equal(first.a, again.a)
    assert first.a.shape != other.a.shape or (first.a != other.a).any()


def test_inside_is_what_shapely_finds_inside(yard):
    points = np.random.default_rng(2).uniform((-1, -1), (31, 21), (2000, 2))
    solids = shapely.Polygon()
    for one in yard.obstacles:
        if one.shape_type == ShapeType.CLOSED_POLYGON:
            area = shapely.Polygon(one.a)
            solids = solids - area if area.exterior.is_ccw is False else solids | area
    inside = shapely.contains_xy(solids, points)
    np.testing.assert_array_equal(inside_solids(yard, points), inside)
    assert 0.05 < inside.mean() < 0.5
