"""Which cells lines touch and rings enclose, against shapely."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import ExportGridError
from robot_bridge.core.robotmap.exporters.nav2 import RasterGrid, enclosed_cells, touched_cells
from robot_bridge.core.robotmap.model import Border

GRID = RasterGrid(-1.0, 2.0, 0.1, 30, 20)
centimetre_x = st.integers(-150, 250).map(lambda k: k / 100)
centimetre_y = st.integers(150, 450).map(lambda k: k / 100)
points = st.tuples(centimetre_x, centimetre_y)


def boxes(grid: RasterGrid, grow: float = 0.0):
    """Return each cell as a polygon, (rows, columns), larger by ``grow`` metres on every side."""
    x = grid.x_min + np.arange(grid.columns) * grid.resolution
    y = (grid.y_min + np.arange(grid.rows) * grid.resolution)[:, None]
    return shapely.box(x - grow, y - grow, x + grid.resolution + grow, y + grid.resolution + grow)


@settings(max_examples=3 * settings.default.max_examples, deadline=None)
@given(points, points)
def test_a_line_touches_the_cells_it_runs_through_and_no_others(a, b):
    made = touched_cells(GRID, np.array([a]), np.array([b]))
    line = shapely.LineString([a, b])
    assert not (made & ~shapely.intersects(boxes(GRID, 1e-9), line)).any()
    assert not (~made & shapely.intersects(boxes(GRID, -1e-6), line)).any()


@settings(max_examples=3 * settings.default.max_examples, deadline=None)
@given(points, points)
def test_the_cells_of_a_line_share_edges_so_that_nothing_slips_through(count_regions, a, b):
    grid = RasterGrid(-2.0, 1.0, 0.1, 50, 40)
    made = touched_cells(grid, np.array([a]), np.array([b]))
    assert count_regions(made) == 1


def test_a_line_on_the_far_border_of_the_grid_is_kept_and_one_beyond_is_not():
    a = np.array([[2.0, 2.0], [-1.0, 4.0], [2.05, 2.0], [-1.0, 4.05], [-1.01, 2.0]])
    b = np.array([[2.0, 4.0], [2.0, 4.0], [2.05, 4.0], [2.0, 4.05], [-1.01, 4.0]])
    made = touched_cells(GRID, a, b)
    wanted = np.zeros_like(made)
    wanted[:, -1] = wanted[-1] = True
    assert (made == wanted).all()


@settings(max_examples=2 * settings.default.max_examples, deadline=None)
@given(st.lists(points, min_size=3, max_size=7))
def test_a_ring_encloses_the_centres_that_shapely_says(corners):
    polygon = shapely.Polygon(corners)
    if not polygon.is_valid or polygon.area == 0:
        return
    ring = np.array(polygon.exterior.coords)
    ring = ring if shapely.is_ccw(shapely.LinearRing(ring)) else ring[::-1]
    made = enclosed_cells(GRID, ring[:-1], ring[1:])
    centres = shapely.centroid(boxes(GRID))
    clear = shapely.distance(polygon.exterior, centres) > 1e-5
    assert (made == shapely.contains(polygon, centres))[clear].all()


def test_courtyards_open_and_what_stands_in_them_closes():
    def square(low, high, clockwise=False):
        ring = np.array([[low, low], [high, low], [high, high], [low, high], [low, low]], dtype=float)
        return ring[::-1] if clockwise else ring

    grid = RasterGrid(0.0, 0.0, 1.0, 10, 10)
    rings = [square(0, 10), square(2, 8, clockwise=True), square(4, 6)]
    made = enclosed_cells(
        grid, np.concatenate([r[:-1] for r in rings]), np.concatenate([r[1:] for r in rings])
    )
    assert made[5].tolist() == [True, True, False, False, True, True, False, False, True, True]
    assert made.sum() == 100 - 36 + 4


def test_nothing_is_touched_or_enclosed_by_nothing():
    nothing = np.empty((0, 2))
    assert not touched_cells(GRID, nothing, nothing).any()
    assert not enclosed_cells(GRID, nothing, nothing).any()


def test_a_grid_larger_than_one_band_is_one_grid(count_regions):
    grid = RasterGrid(0.0, 0.0, 1.0, 3000, 2000)
    made = touched_cells(grid, np.array([[0.5, 0.5]]), np.array([[1999.5, 1999.5]]))
    assert made.any(axis=1).all() and count_regions(made) == 1


def test_the_grid_covers_the_border_whole_and_begins_in_its_lower_left_corner():
    grid = RasterGrid.covering(Border(-3.0, 7.0, 7.02, 9.0), 0.05)
    assert (grid.x_min, grid.y_min, grid.columns, grid.rows) == (-3.0, 7.0, 201, 40)


@pytest.mark.parametrize("resolution", [0.0, -0.1, float("nan"), float("inf")])
def test_a_resolution_that_is_no_length_is_refused(resolution):
    with pytest.raises(ExportGridError, match="is no side of a cell; give one above 0"):
        RasterGrid.covering(Border(0, 0, 1, 1), resolution)


def test_too_many_cells_are_refused_with_a_resolution_that_is_accepted():
    border = Border(0.0, 0.0, 1234.5, 999.0)
    with pytest.raises(
        ExportGridError, match=r"24690 x 19980 = 493\.3 million cells.*choose 0\.14 m or"
    ) as error:
        RasterGrid.covering(border, 0.05)
    assert "smaller window" in str(error.value)
    RasterGrid.covering(border, 0.14)
