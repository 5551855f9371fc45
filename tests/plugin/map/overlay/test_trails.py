"""Where robots came from: samples, and the image of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.scene import Screen
from fleet_supervisor.plugin.map.overlay.trails import LENGTHS, SHORTEST_WAIT, TrailImage, Trails
from qgis.PyQt.QtGui import QImage, QPainter

SCREEN = Screen((0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), 200, 100)


SAME = SimpleNamespace(to_map_or_nan=lambda xy: xy)
"""A site frame that is the map's CRS."""


def drive(trails, seconds, robots=1, step=1.0, image=None, screen=SCREEN, speed=1.0):
    """Drive along y = 50 from x = 10."""
    for number in range(int(seconds / step) + 1):
        at = np.column_stack([np.full(robots, 10.0 + speed * number * step), 50.0 + 3.0 * np.arange(robots)])
        trails.extend(at, number * step)
        if image is not None:
            image.extend(at, screen, SAME, number * step)
    return at


def painted(image, screen=SCREEN):
    """Return the alpha of what is painted, (height, width) device pixels."""
    shape = QImage(
        round(screen.width * screen.ratio),
        round(screen.height * screen.ratio),
        QImage.Format.Format_ARGB32_Premultiplied,
    )
    shape.setDevicePixelRatio(screen.ratio)
    shape.fill(0)
    painter = QPainter(shape)
    image.paint(painter, screen)
    painter.end()
    bits = shape.bits()
    bits.setsize(shape.sizeInBytes())
    return np.frombuffer(bits, np.uint8).reshape(shape.height(), shape.width(), 4)[:, :, 3].copy()


def test_a_trail_grows_with_the_way_and_is_cut_by_time(qgis_app):
    trails = Trails()
    drive(trails, 120)
    trail = trails.of(0, now=120.0)
    assert trail[-1].tolist() == [130.0, 50.0, 0.0]
    assert trail[0].tolist() == [40.0, 50.0, 90.0]
    assert len(trail) == 91
    assert len(trails.of(0, now=400.0)) == 0


def test_a_robot_that_stands_adds_nothing_and_one_without_a_place_has_none():
    trails = Trails()
    for second in range(50):
        trails.extend(np.array([[1.0, 2.0], [np.nan, np.nan]]), float(second))
    assert trails.taken.tolist() == [1, 0]


def test_robots_that_come_later_get_rows_and_many_get_shorter_trails():
    trails = Trails()
    drive(trails, 20)
    before = trails.generation
    many = 400
    for second in range(21, 60):
        at = np.column_stack([np.full(many, 10.0 + second), np.arange(many)])
        trails.extend(at, float(second))
    assert trails.length == LENGTHS[-1]
    assert trails.generation > before
    trail = trails.of(0, now=59.0)
    assert trail[-1, :2].tolist() == [69.0, 0.0]
    assert trail[0, 2] == pytest.approx(15.0)


def test_memory_is_bounded_however_long_it_lasts():
    trails = Trails()
    drive(trails, 90)
    size = trails._ring.nbytes
    drive(trails, 2000, step=0.5)
    assert trails._ring.nbytes == size


def test_a_trail_is_painted_where_the_robot_was_and_nowhere_else(qgis_app):
    trails = Trails()
    image = TrailImage(trails)
    drive(trails, 60, image=image)
    alpha = painted(image)
    assert (alpha[50, 12:70] > 0).all()
    assert alpha[50, 72:].max() == 0
    assert alpha[:45].max() == alpha[56:].max() == 0


@pytest.mark.parametrize(("robots", "seconds"), [(1, 90.0), (400, 15.0)])
def test_it_fades_and_is_gone_when_it_is_old(qgis_app, robots, seconds):
    trails = Trails()
    image = TrailImage(trails)
    at = drive(trails, 60, robots=robots, image=image)
    for _ in range(20):
        image.extend(at, SCREEN, SAME, 60.0)
    now = painted(image)[50]
    newest, middle, oldest = (round(70 - part * min(seconds, 60.0)) for part in (0.1, 0.5, 0.9))
    assert now[newest] > now[middle] > now[oldest] > 0
    for frame in range(40):
        image.extend(at, SCREEN, SAME, 61.0 + seconds + frame * 0.05)
    assert painted(image).max() == 0


def test_trails_of_many_robots_are_a_pixel_wide(qgis_app):
    trails = Trails()
    image = TrailImage(trails)
    at = drive(trails, 60, robots=400, image=image)
    for _ in range(20):
        image.extend(at, SCREEN, SAME, 60.0)
    alpha = painted(image)
    assert (alpha[50:98:3, 58:70] > 0).all()
    assert alpha[51:99:3].max() == alpha[52:99:3].max() == alpha[:50].max() == 0


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_after_the_view_has_moved_the_whole_trail_is_there_again(qgis_app, ratio):
    trails = Trails()
    image = TrailImage(trails)
    at = drive(trails, 60, image=image)
    moved = Screen((0.0, 0.0), (-20.0, -60.0), (2.0, 0.0), (0.0, 2.0), 200, 100, ratio)
    image.extend(at, moved, SAME, 60.0)
    # While the view still moves the old image goes along.
    assert painted(image, moved)[round(40 * ratio), round(60 * ratio)] > 0
    for _ in range(30):
        image.extend(at, moved, SAME, 60.0)
    alpha = painted(image, moved)
    assert (alpha[round(40 * ratio), round(4 * ratio) : round(118 * ratio)] > 0).all()
    assert alpha[: round(34 * ratio)].max() == 0


def test_robots_of_another_site_leave_no_trail_of_those_before(qgis_app):
    trails = Trails()
    image = TrailImage(trails)
    drive(trails, 60, image=image)
    trails.clear()
    at = np.array([[150.0, 20.0]])
    trails.extend(at, 61.0)
    image.extend(at, SCREEN, SAME, 61.0)
    assert painted(image)[40:60].max() == 0


def test_a_robot_that_is_put_elsewhere_far_off_draws_no_line_there(qgis_app):
    trails = Trails()
    image = TrailImage(trails)
    for second, x in enumerate((10.0, 11.0, 90_000.0, 90_001.0)):
        at = np.array([[x, 50.0]])
        trails.extend(at, float(second))
        image.extend(at, SCREEN, SAME, float(second))
    assert painted(image)[50, 20:].max() == 0


@pytest.mark.parametrize("step", [0.05, 0.3])
def test_a_robot_that_takes_many_frames_for_a_pixel_leaves_a_trail_without_gaps(qgis_app, step):
    trails = Trails()
    image = TrailImage(trails)
    drive(trails, 20.0, step=step, image=image, speed=1.0)
    row = painted(image)[49:52].max(axis=0)
    assert (row[12:29] > 0).all()
    assert not row[:9].any()
    assert not row[33:].any()


@pytest.mark.parametrize("robots", [1, 400])
def test_a_robot_that_goes_many_pixels_in_a_frame_leaves_a_trail_without_gaps(qgis_app, robots):
    trails = Trails()
    image = TrailImage(trails)
    for second in range(6):
        at = np.tile([20.5 + 30.0 * second, 10.5 + 15.0 * second], (robots, 1))
        trails.extend(at, float(second))
        image.extend(at, SCREEN, SAME, float(second))
    alpha = painted(image)
    across = np.arange(22, 170)
    for x, y in zip(across, (10.5 + (across - 20.0) / 2).astype(int), strict=True):
        assert alpha[y - 1 : y + 2, x].max() > 0
    assert alpha[:, 172:].max() == alpha[:, :18].max() == 0


def test_a_robot_is_sampled_again_only_after_a_while():
    trails = Trails()
    for step in range(41):
        trails.extend(np.array([[float(step), 0.0]]), step * SHORTEST_WAIT / 4)
    assert trails.taken.tolist() == [11]
    assert trails.of(0, 10 * SHORTEST_WAIT)[:, 0].tolist() == [4.0 * step for step in range(11)]


def test_a_trail_that_is_drawn_again_has_its_own_age_beside_those_of_others(qgis_app):
    trails = Trails()
    for second in range(5):
        trails.extend(np.array([[10.0, 20.0], [10.0 + 30.0 * second, 60.0]]), float(second))
    for second in range(50, 61):
        trails.extend(np.array([[float(second) - 40.0, 20.0], [130.0, 60.0]]), float(second))
    image = TrailImage(trails)
    for _ in range(20):
        image.extend(np.array([[20.0, 20.0], [130.0, 60.0]]), SCREEN, SAME, 60.0)
    alpha = painted(image)
    newer, older = alpha[20, 11:20].astype(int), alpha[60, 12:128].astype(int)
    assert older.min() > 0
    assert newer.min() > 2 * older.max()
