"""The live picture goes with the map and with the robots, and finds the robot under the mouse."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer
from fleet_supervisor.plugin.map.overlay.trails import Trails
from fleet_supervisor.plugin.ui.glyphs import STATE_COLOURS, TRAIL
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.core import QgsPointXY
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import QApplication

from tests.plugin.map.on_canvas import expected, placement_of, scene_of, show, spots

BLUE = STATE_COLOURS[RobotState.FRESH]


def test_what_is_gone_is_painted_no_more(canvas, site):
    overlay = show(canvas, site, scene_of(*[(20 + 20 * i, 50, 0, RobotState.FRESH) for i in range(4)]))
    many = len(spots(canvas, BLUE))
    overlay.show_scene(
        SceneTransformer().placed(scene_of((20, 50, 0, RobotState.FRESH)), placement_of(canvas, site))
    )
    QApplication.processEvents()
    assert len(spots(canvas, BLUE)) == pytest.approx(many / 4, rel=0.2)
    overlay.show_scene(None)
    QApplication.processEvents()
    assert len(spots(canvas, BLUE)) == 0


def test_robots_stay_in_place_when_the_map_is_moved_and_zoomed(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    canvas.zoomByFactor(0.5)
    canvas.setCenter(QgsPointXY(site.origin[0] + 70, site.origin[1] + 45))
    QApplication.processEvents()
    blue = spots(canvas, BLUE)
    assert np.hypot(*(blue.mean(axis=0) - expected(canvas, site, 60, 50))) < 4.0


def test_a_trail_fades_with_age(canvas, site):
    trails = Trails()
    for second in range(90):
        trails.extend(np.array([[10.0 + second, 20.0]]), float(second))
    scene = scene_of((99, 20, 0.0, RobotState.FRESH), now=89.0)
    overlay = show(canvas, site, scene, trails=trails)
    shown = SceneTransformer().placed(scene, placement_of(canvas, site))
    for _ in range(20):
        overlay.show_scene(shown)
    image = canvas.grab().toImage()

    def colour(x):
        at = expected(canvas, site, x, 20.0)
        return QColor(image.pixel(round(at[0]), round(at[1])))

    new, middle, old = colour(92), colour(55), colour(13)
    assert abs(new.red() - TRAIL.red()) < 30
    assert new.red() < middle.red() < old.red()


def test_the_robot_under_the_mouse_is_found(canvas, site):
    overlay = show(
        canvas, site, scene_of((60, 50, 0, RobotState.FRESH), (70, 50, 0, RobotState.LOST), age=40.0)
    )
    assert overlay.robot_at(*expected(canvas, site, 70, 50)) == "r2"
    x, y = expected(canvas, site, 70, 50)
    assert overlay.robot_at(x, y + 30) is None


def test_a_robot_that_the_map_cannot_place_takes_no_other_from_it(canvas, site):
    robots = [
        (60, 50, 0.0, RobotState.FRESH),
        (8e7, 9e7, 0.0, RobotState.FRESH),
        (70, 50, 0.0, RobotState.FRESH),
    ]
    trails = Trails()
    overlay = show(canvas, site, scene_of(robots[0]), crs="EPSG:4326", trails=trails)
    trails.extend(np.array([(40.0, 50.0), (7e7, 9e7), (70.0, 80.0)]), 99.0)
    trails.extend(np.array([robot[:2] for robot in robots]), 100.0)
    placed = SceneTransformer().placed(scene_of(*robots), placement_of(canvas, site))
    assert np.isfinite(placed.robots).all(axis=1).tolist() == [True, False, True]
    assert np.isfinite(placed.metre).all(axis=1).tolist() == [True, False, True]
    alone = SceneTransformer().placed(scene_of(robots[0], robots[2]), placement_of(canvas, site))
    assert np.array_equal(placed.robots[[0, 2]], alone.robots)
    for _ in range(20):
        overlay.show_scene(placed)
    image = canvas.grab().toImage()
    assert overlay.robot_at(*expected(canvas, site, 70, 50)) == "r3"
    for x, y in ((50, 50), (70, 65)):
        at = expected(canvas, site, x, y).round().astype(int).tolist()
        assert abs(QColor(image.pixel(*at)).red() - TRAIL.red()) < 30


def test_the_viewport_is_not_filled_twice_where_the_scene_covers_it(canvas, site):
    filled = Qt.WidgetAttribute.WA_OpaquePaintEvent
    overlay = show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    assert canvas.viewport().testAttribute(filled)
    # Through a background that is not whole one would see what was painted before.
    canvas.setCanvasColor(QColor(255, 255, 255, 100))
    overlay.prepare()
    assert not canvas.viewport().testAttribute(filled)
    canvas.setCanvasColor(QColor("white"))
    overlay.prepare()
    assert canvas.viewport().testAttribute(filled)
    overlay.remove()
    assert not canvas.viewport().testAttribute(filled)
    assert overlay.scene() is None
