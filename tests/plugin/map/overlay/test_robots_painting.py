"""Robots are painted where they are, pointing where they point, whatever the map's CRS and rotation."""

from __future__ import annotations

import dataclasses
import math
from functools import partial

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import STATES
from fleet_supervisor.plugin.map.overlay import robots_painter
from fleet_supervisor.plugin.map.overlay.robots_painter import Sprites
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer, in_view
from fleet_supervisor.plugin.ui.glyphs import SELECTED, STATE_COLOURS, UNSURE_COLOUR
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor, QImage, QPainter

from tests.plugin.map.on_canvas import expected, placement_of, scene_of, show, spots, where

BLUE = STATE_COLOURS[RobotState.FRESH]


@pytest.mark.parametrize("site_rotation", [0.0, 0.7])
@pytest.mark.parametrize("map_rotation", [0.0, 35.0, 180.0])
@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:3857", "EPSG:4326"])
def test_a_robot_is_painted_where_it_is_and_points_where_it_points(
    canvas, site, crs, map_rotation, site_rotation
):
    site = dataclasses.replace(site, rotation=site_rotation)
    theta = 0.4
    show(canvas, site, scene_of((60, 50, theta, RobotState.FRESH)), crs, map_rotation)
    blue = spots(canvas, BLUE)
    assert len(blue) > 60
    at = expected(canvas, site, 60, 50)
    assert np.hypot(*(blue - at).T).max() < 16.0
    # The arrow's point is the blue farthest ahead of the robot's place; its last pixels are blended.
    ahead = expected(canvas, site, 60 + 5 * math.cos(theta), 50 + 5 * math.sin(theta)) - at
    tip = blue[np.argmax((blue - at) @ ahead)] - at
    turn = math.degrees(math.atan2(tip[1], tip[0]) - math.atan2(ahead[1], ahead[0]))
    assert abs((turn + 180) % 360 - 180) < 8.0
    assert np.hypot(*tip) == pytest.approx(10.5, abs=2.0)
    assert ((blue - at) @ ahead).min() / np.hypot(*ahead) > -11.0


@pytest.mark.parametrize("state", STATES)
def test_each_state_has_its_colour_and_its_own_shape(canvas, site, state):
    show(canvas, site, scene_of((60, 50, 0.0, state), age=5.0))
    assert len(spots(canvas, STATE_COLOURS[state])) > 20


def test_a_fresh_robot_that_may_be_elsewhere_is_hollow_with_a_broken_outline(canvas, site):
    def pixels(state, **how):
        overlay = show(canvas, site, scene_of((60, 50, 0.0, state), **how))
        seen = canvas.grab().toImage()
        counts = [len(spots(canvas, colour)) for colour in (BLUE, UNSURE_COLOUR)]
        canvas.scene().removeItem(overlay)
        return seen, counts

    _, (blue, amber) = pixels(RobotState.FRESH)
    assert blue > 60 and amber == 0
    _, (blue, amber) = pixels(RobotState.FRESH, doubted=True)
    _, (_, unbroken) = pixels(RobotState.STALE)
    assert blue == 0 and 20 < amber < 0.8 * unbroken
    # Of one that is not heard nobody knows where it is, whatever it said last.
    for state in (RobotState.STALE, RobotState.LOST, RobotState.OFFLINE):
        assert pixels(state)[0] == pixels(state, doubted=True)[0]


def test_what_may_be_elsewhere_is_drawn_among_thousands_and_on_top_of_those_that_are_there(canvas, site):
    rng = np.random.default_rng(1)
    at = rng.uniform((0, 0), (120, 100), (3000, 2))
    scene = scene_of(
        *[(x, y, 0.5, RobotState.FRESH) for x, y in at.tolist()], (60, 50, 0.5, RobotState.FRESH)
    )
    scene.robots.doubted[3000] = True
    show(canvas, site, scene)
    found = spots(canvas, UNSURE_COLOUR)
    assert len(found) > 15
    assert np.hypot(*(found - expected(canvas, site, 60, 50)).T).max() < 16


def test_drawings_are_made_before_robots_are_painted(canvas, site, monkeypatch):
    overlay = show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    made, make = [], robots_painter.robot_atlas
    monkeypatch.setattr(
        robots_painter, "robot_atlas", lambda *of, **how: (made.append(of[-1]), make(*of, **how))[1]
    )
    scene = scene_of((60, 50, 0.0, RobotState.FRESH), (70, 50, 0.0, RobotState.LOST))
    overlay.show_scene(SceneTransformer().placed(scene, placement_of(canvas, site)))
    assert made == [RobotState.LOST]
    canvas.grab()
    assert made == [RobotState.LOST]


def test_states_differ_without_their_colours(qgis_app):
    from fleet_supervisor.plugin.map.overlay.robots_painter import in_a_column, robot_atlas
    from fleet_supervisor.plugin.ui.glyphs import CELL

    grey = QImage.Format.Format_Grayscale8
    drawings = [
        *map(partial(robot_atlas, 1.0, 1.0), STATES),
        robot_atlas(1.0, 1.0, RobotState.FRESH, unsure=True),
    ]
    atlases = [in_a_column(drawing).toImage().convertToFormat(grey) for drawing in drawings]
    cells = [atlas.copy(0, 0, CELL, CELL) for atlas in atlases]
    tables = [np.frombuffer(as_bytes(cell), np.uint8) for cell in cells]
    for first in range(len(tables)):
        for second in range(first):
            assert (np.abs(tables[first].astype(int) - tables[second]) > 40).sum() > 60


def as_bytes(image: QImage) -> bytes:
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return bytes(bits)


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_on_a_dense_screen_robots_have_the_same_size_and_place(canvas, site, ratio):
    overlay = show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    image = QImage(QSize(600, 500) * ratio, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    image.fill(QColor("white"))
    painter = QPainter(image)
    overlay.paint(painter)
    painter.end()
    blue = where(image, BLUE) / ratio
    assert np.hypot(*(blue - expected(canvas, site, 60, 50)).T).max() < 16.0
    assert blue[:, 0].max() - blue[:, 0].min() == pytest.approx(20.0, abs=2.5)


def test_the_selected_robot_wears_a_ring(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), chosen=("r1",)))
    ring = spots(canvas, SELECTED) - expected(canvas, site, 60, 50)
    assert len(ring) > 60
    assert np.hypot(*ring.T) == pytest.approx(18.0, abs=2.0)


def test_speed_is_a_line_to_where_the_robot_will_be_soon(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), v=4.0), rotation=30.0)
    image = canvas.grab().toImage()

    def brightness(x, y):
        at = expected(canvas, site, x, y)
        return QColor(image.pixel(round(at[0]), round(at[1]))).lightness()

    # White on a casing that is darker than the white canvas, up to 2 s ahead and no farther.
    off = [brightness(67.2, 50 + side) for side in (-0.42, 0.42)]
    assert brightness(67.2, 50) > 240 and min(off) < 200
    assert brightness(70, 50.35) == brightness(50, 50.35) == 255


def test_a_robot_whose_heading_is_not_known_has_no_line_of_speed(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), v=0.0))
    still = canvas.grab().toImage()
    show(canvas, site, scene_of((60, 50, np.nan, RobotState.FRESH), v=4.0))
    image = canvas.grab().toImage()
    ahead = expected(canvas, site, 67.2, 50).round().astype(int)
    around = [(ahead[0], ahead[1] + side) for side in (-2, -1, 0, 1, 2)]
    assert [image.pixel(x, y) for x, y in around] == [still.pixel(x, y) for x, y in around]


@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:3857", "EPSG:4326"])
def test_accuracy_is_a_circle_of_so_many_metres_in_any_crs(canvas, site, crs):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), accuracy=20.0), crs)
    image = canvas.grab().toImage()
    inside, outside = [], []
    for turn in np.linspace(0, 2 * np.pi, 16, endpoint=False):
        for metres, found in ((18.5, inside), (21.5, outside)):
            at = expected(canvas, site, 60 + metres * math.cos(turn), 50 + metres * math.sin(turn))
            found.append(QColor(image.pixel(round(at[0]), round(at[1]))).name())
    assert "#ffffff" not in inside
    assert set(outside) == {"#ffffff"}


def test_a_circle_larger_than_the_map_knows_takes_no_other_from_it(canvas, site):
    scene = scene_of((60, 50, 0.0, RobotState.FRESH), (70, 50, 0.0, RobotState.FRESH))
    scene = dataclasses.replace(
        scene, robots=dataclasses.replace(scene.robots, accuracy=np.array([20.0, 1e8]))
    )
    overlay = show(canvas, site, scene, "EPSG:4326")
    placed, screen = SceneTransformer().placed(scene, placement_of(canvas, site)), overlay.screen()
    rows, corners = robots_painter.circles(placed, in_view(placed, screen))
    assert rows.tolist() == [0]
    assert np.isfinite(corners).all()


@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:4326"])
def test_a_circle_of_accuracy_is_painted_from_its_picture_as_it_is_drawn(canvas, site, crs, monkeypatch):
    scene = scene_of(
        (60.3, 50.4, math.nan, RobotState.LOST), (75, 60, math.nan, RobotState.FRESH), accuracy=15
    )
    overlay = show(canvas, site, scene, crs, 20.0)
    overlay.draw_arrows(False)
    by_pictures = canvas.grab().toImage()
    monkeypatch.setattr(robots_painter, "LARGEST_PICTURE", 0.0)
    overlay.prepare()
    drawn = canvas.grab().toImage()
    pictures, drawings = (
        robots_painter.pixels_of(image.convertToFormat(QImage.Format.Format_RGB32)).view(np.uint8)
        for image in (by_pictures, drawn)
    )
    off = np.abs(pictures.astype(int) - drawings).reshape(-1, 4).max(axis=1)
    # The picture is moved by at most half a pixel; by a whole one the rims would be off by 0.7 on average.
    assert 0 < off[off > 8].sum() / len(off) < 0.5
    assert np.count_nonzero(drawings != 255) > 0.05 * len(off)


def test_circles_of_accuracy_are_drawn_once_for_each_size_a_few_in_a_frame(canvas, site, monkeypatch):
    made, make = [], robots_painter._circle_picture
    monkeypatch.setattr(robots_painter, "_circle_picture", lambda *of: (made.append(of[-1]), make(*of))[1])
    number = 2 * robots_painter.NEW_PICTURES
    scene = scene_of(*[(3.0 + 2.0 * k, 50, 0.0, RobotState.FRESH) for k in range(2 * number)])
    scene = dataclasses.replace(
        scene, robots=dataclasses.replace(scene.robots, accuracy=np.tile(4.0 + np.arange(number) * 0.4, 2))
    )
    overlay = show(canvas, site, scene)
    assert len(made) == robots_painter.NEW_PICTURES and not overlay.is_whole
    overlay.prepare()
    assert overlay.is_whole
    canvas.grab()
    drawn = len(made)
    assert drawn == len({*made}) <= number
    scene.robots.xy[:, 1] += 0.37
    overlay.show_scene(SceneTransformer().placed(scene, placement_of(canvas, site)))
    canvas.grab()
    assert len(made) == drawn


def test_many_large_circles_of_accuracy_are_lines_without_a_filling(canvas, site):
    def tinted(number):
        overlay = show(canvas, site, scene_of(*[(60, 50, 0.0, RobotState.FRESH)] * number, accuracy=35.0))
        at = expected(canvas, site, 60, 80)
        inside = QColor(canvas.grab().toImage().pixel(*map(round, at))).name()
        rim = len(spots(canvas, BLUE, 60))
        canvas.scene().removeItem(overlay)
        return inside != "#ffffff", rim > 300

    assert tinted(robots_painter.MOST_LARGE) == (True, True)
    assert tinted(robots_painter.MOST_LARGE + 1) == (False, True)


def test_many_robots_are_drawn_small_and_those_to_be_noticed_larger(canvas, site):
    def width(colour, number):
        grid = [(3.0 * (k % 40), 3.0 * (k // 40), math.nan, RobotState.FRESH) for k in range(number)]
        overlay = show(canvas, site, scene_of(*grid, (60, 95, math.nan, RobotState.LOST)))
        found = spots(canvas, colour)
        canvas.scene().removeItem(overlay)
        at = expected(canvas, site, 60, 95)
        near = found[np.hypot(*(found - at).T) < 16]
        return np.ptp(near[:, 0])

    red = STATE_COLOURS[RobotState.LOST]
    assert width(red, 10) > width(red, 1240) > 8


def test_a_lost_robot_lies_over_a_fresh_one_and_a_selected_one_over_both(canvas, site):
    def colours(*states, chosen=()):
        overlay = show(canvas, site, scene_of(*[(60, 50, 0.0, state) for state in states], chosen=chosen))
        counts = [len(spots(canvas, STATE_COLOURS[state])) for state in (RobotState.FRESH, RobotState.LOST)]
        canvas.scene().removeItem(overlay)
        return counts

    lost, fresh = RobotState.LOST, RobotState.FRESH
    (_, red), (blue, _) = colours(lost), colours(fresh)
    assert colours(lost, fresh)[1] == colours(fresh, lost)[1] == red > 20
    assert colours(lost, fresh, chosen=("r2",))[0] == blue > 20
    assert colours(fresh, lost, chosen=("r1",))[0] == blue


def test_a_robot_that_is_off_lies_under_a_live_one_at_its_place(canvas, site):
    def blue(*states):
        overlay = show(canvas, site, scene_of(*[(60, 50, 0.0, state) for state in states]))
        count = len(spots(canvas, STATE_COLOURS[RobotState.FRESH]))
        canvas.scene().removeItem(overlay)
        return count

    fresh, offline = RobotState.FRESH, RobotState.OFFLINE
    assert blue(fresh, offline) == blue(offline, fresh) == blue(fresh) > 20


def test_robots_are_painted_layer_after_layer_from_the_top_and_those_side_by_side_in_their_order(qgis_app):
    from fleet_supervisor.plugin.map.overlay.robots_painter import STRIP, _from_the_top

    y = np.array([790.0, 3.0, 2.0, -9.0, 5000.0, 790.0 - STRIP])
    assert _from_the_top(np.array([0, 0, 0, 0, 0, 0]), y).tolist() == [1, 2, 3, 5, 0, 4]
    assert _from_the_top(np.array([0, 7, 0, 7, 2, 0]), y).tolist() == [2, 5, 0, 4, 1, 3]
    in_a_strip = np.random.default_rng(1).uniform(STRIP, 2 * STRIP, 300)
    assert _from_the_top(np.ones(300, dtype=np.intp), in_a_strip).tolist() == list(range(300))
    assert _from_the_top(np.array([], dtype=np.intp), y[:0]).tolist() == []


def test_robots_that_the_layers_style_draws_keep_their_rings(canvas, site):
    overlay = show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), chosen=("r1",)))
    assert len(spots(canvas, BLUE)) > 20
    overlay.draw_arrows(False)
    overlay.update()
    assert len(spots(canvas, BLUE)) == 0
    assert len(spots(canvas, SELECTED)) > 20


def test_only_what_is_drawn_of_a_cell_is_kept_and_painted_where_the_cell_would_be(qgis_app):
    cells = np.zeros((2, 9, 9), dtype=np.uint32)
    cells[0, 2:4, 5:8] = 0xFF336699
    cells[1, 8, 0] = 0xFF993366
    image = QImage(40, 30, QImage.Format.Format_RGB32)
    image.fill(0)
    painter = QPainter(image)
    Sprites([np.zeros((1, 4, 4), dtype=np.uint32), cells], 1.0).paint(
        painter, np.array([[10.4, 10.0], [20.0, 20.0]]), np.array([1, 2])
    )
    painter.end()
    found = {(x, y): image.pixel(x, y) for x in range(40) for y in range(30) if image.pixel(x, y) & 0xFFFFFF}
    expected = {(6 + x, 6 + y): 0xFF336699 for x in (5, 6, 7) for y in (2, 3)}
    assert found == {**expected, (16, 24): 0xFF993366}


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("size", [0.3, 0.46, 0.7, 1.0])
def test_many_are_painted_pixel_for_pixel_like_each_alone(qgis_app, size, ratio):
    cells = robots_painter.robot_atlas(ratio, size, RobotState.FRESH)
    random = np.random.default_rng(3)
    centre = random.uniform((-12.0, -12.0), (132.0, 112.0), (300, 2))
    of = random.integers(0, len(cells), 300)
    together, alone = (QImage(QSize(120, 100) * ratio, QImage.Format.Format_RGB32) for _ in range(2))
    for image in (together, alone):
        image.fill(QColor("#88aa66"))
    together.setDevicePixelRatio(ratio)
    painter = QPainter(together)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    Sprites([cells], ratio).paint(painter, centre, of)
    painter.end()
    painter = QPainter(alone)
    side = cells.shape[1]
    for (x, y), k in zip(np.rint(centre * ratio - side / 2).astype(int).tolist(), of.tolist(), strict=True):
        picture = QImage(cells[k].tobytes(), side, side, 4 * side, robots_painter.FORMAT)
        painter.drawImage(x, y, picture)
    painter.end()
    together.setDevicePixelRatio(1.0)
    assert together == alone


def test_wherever_a_picture_is_painted_qt_blends_what_is_inked_in_whole_blocks(qgis_app):
    cells = np.zeros((2, 9, 9), dtype=np.uint32)
    cells[1, 2:4, 1:8] = 0xFF336699
    sprites, block = Sprites([cells], 1.0), robots_painter.BLOCK
    left, top, width, height = sprites._cells[1, 2:6].astype(int).tolist()
    picture = robots_painter.pixels_of(sprites._atlas.toImage())[top : top + height, left : left + width]
    assert np.count_nonzero(picture) == 14

    def is_whole(picture):
        # Whole blocks begin at any of its pixels: it depends on where it is painted.
        width = picture.shape[1]
        ends = [(first, first + (width - first) // block * block) for first in range(block)]
        return not any(picture[:, :first].any() or picture[:, end:].any() for first, end in ends)

    assert is_whole(picture)
    # No wider than that takes.
    assert not is_whole(picture[:, 1:]) and not is_whole(picture[:, :-1])


def test_what_is_inked_of_a_cell_is_found_up_to_its_edges(qgis_app):
    cells = np.zeros((4, 5, 5), dtype=np.uint32)
    cells[0, 1:3, 2:5] = 1
    cells[1] = 1
    cells[2, 4, 0] = 1
    found = robots_painter.trimmed(cells).T.tolist()
    assert found[:3] == [[1, 3, 2, 5], [0, 5, 0, 5], [4, 5, 0, 1]]
    # Of one that is empty a pixel is kept.
    assert found[3] == [0, 1, 0, 1]
