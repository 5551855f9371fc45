"""Robots are painted where they are, pointing where they point, whatever the map's CRS and rotation."""

from __future__ import annotations

import dataclasses
import math
import time

import numpy as np
import pytest
from fleet_supervisor.plugin.desk.colours import SELECTED, STATE_COLOURS, TRAIL
from fleet_supervisor.plugin.desk.drafts import CONE, Draft
from fleet_supervisor.plugin.desk.overlay import FleetOverlay
from fleet_supervisor.plugin.desk.picture import STATES, RobotArrays
from fleet_supervisor.plugin.desk.placement import Placement
from fleet_supervisor.plugin.desk.scene import Scene, Target, placed
from fleet_supervisor.plugin.errors import PlacementError
from fleet_supervisor.robot_bridge.messages import RobotState
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsProject, QgsRectangle
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor, QImage, QPainter
from qgis.PyQt.QtWidgets import QApplication

BLUE = STATE_COLOURS[RobotState.FRESH]


@pytest.fixture
def canvas(qgis_app):
    made = QgsMapCanvas()
    made.resize(600, 500)
    made.show()
    QApplication.processEvents()
    yield made
    made.stopRendering()
    made.close()
    made.deleteLater()


def arrays(*robots) -> RobotArrays:
    return RobotArrays(
        [f"r{number}" for number in range(1, len(robots) + 1)],
        np.array([(x, y) for x, y, _, _ in robots], dtype=float).reshape(-1, 2),
        np.array([theta for _, _, theta, _ in robots], dtype=float),
        np.array([STATES.index(state) for _, _, _, state in robots], dtype=np.intp),
    )


def show(canvas, site, scene, crs="EPSG:32633", rotation=0.0) -> FleetOverlay:
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem(crs))
    placement = Placement(
        site, canvas.mapSettings().destinationCrs(), QgsProject.instance().transformContext()
    )
    canvas.setRotation(rotation)
    corners = placement.to_map(np.array([(0, 0), (120, 0), (120, 100), (0, 100)], dtype=float))
    canvas.setExtent(QgsRectangle(*corners.min(axis=0), *corners.max(axis=0)))
    QApplication.processEvents()
    overlay = FleetOverlay(canvas)
    overlay.show_scene(placed(scene, placement))
    QApplication.processEvents()
    return overlay


def spots(canvas, colour: QColor, tolerance: int = 12) -> np.ndarray:
    """Return the (n, 2) pixels of the canvas that have ``colour``."""
    image = canvas.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    return where(image, colour, tolerance)


def where(image: QImage, colour: QColor, tolerance: int = 12) -> np.ndarray:
    bits = image.bits()
    bits.setsize(image.sizeInBytes())
    pixels = np.frombuffer(bits, np.uint8).reshape(image.height(), image.bytesPerLine() // 4, 4)
    wanted = np.array([colour.blue(), colour.green(), colour.red()], dtype=int)
    y, x = np.nonzero((np.abs(pixels[:, : image.width(), :3].astype(int) - wanted) <= tolerance).all(axis=2))
    return np.column_stack([x, y])


def expected(canvas, site, x, y) -> np.ndarray:
    """Return the pixel of a place in the site frame, by a way of its own through QGIS point by point."""
    from qgis.core import QgsCoordinateTransform

    c, s = math.cos(site.rotation), math.sin(site.rotation)
    east, north = site.origin[0] + c * x - s * y, site.origin[1] + s * x + c * y
    to_map = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem(site.crs), canvas.mapSettings().destinationCrs(), QgsProject.instance()
    )
    at = canvas.getCoordinateTransform().transform(to_map.transform(QgsPointXY(east, north)))
    return np.array([at.x(), at.y()])


@pytest.mark.parametrize("site_rotation", [0.0, 0.7])
@pytest.mark.parametrize("map_rotation", [0.0, 35.0, 180.0])
@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:3857", "EPSG:4326"])
def test_a_robot_is_painted_where_it_is_and_points_where_it_points(
    canvas, site, crs, map_rotation, site_rotation
):
    site = dataclasses.replace(site, rotation=site_rotation)
    theta = 0.4
    show(canvas, site, Scene(arrays((60, 50, theta, RobotState.FRESH)), [0.0]), crs, map_rotation)
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
    show(canvas, site, Scene(arrays((60, 50, 0.0, state)), [5.0]))
    assert len(spots(canvas, STATE_COLOURS[state])) > 20


def test_states_differ_without_their_colours(qgis_app):
    from fleet_supervisor.plugin.desk.glyphs import CELL, robot_atlas

    atlas = robot_atlas(1.0).toImage().convertToFormat(QImage.Format.Format_Grayscale8)
    cells = [atlas.copy(CELL * column, 0, CELL, CELL) for column in range(len(STATES))]
    tables = [np.frombuffer(as_bytes(cell), np.uint8) for cell in cells]
    for first in range(len(tables)):
        for second in range(first):
            assert (np.abs(tables[first].astype(int) - tables[second]) > 40).sum() > 60


def as_bytes(image: QImage) -> bytes:
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return bytes(bits)


def test_what_is_gone_is_painted_no_more(canvas, site):
    overlay = show(
        canvas, site, Scene(arrays(*[(20 + 20 * i, 50, 0, RobotState.FRESH) for i in range(4)]), [0] * 4)
    )
    many = len(spots(canvas, BLUE))
    placement = Placement(
        site, canvas.mapSettings().destinationCrs(), QgsProject.instance().transformContext()
    )
    overlay.show_scene(placed(Scene(arrays((20, 50, 0, RobotState.FRESH)), [0.0]), placement))
    QApplication.processEvents()
    assert len(spots(canvas, BLUE)) == pytest.approx(many / 4, rel=0.2)
    overlay.show_scene(None)
    QApplication.processEvents()
    assert len(spots(canvas, BLUE)) == 0


def test_robots_stay_in_place_when_the_map_is_moved_and_zoomed(canvas, site):
    show(canvas, site, Scene(arrays((60, 50, 0.0, RobotState.FRESH)), [0.0]))
    canvas.zoomByFactor(0.5)
    canvas.setCenter(QgsPointXY(site.origin[0] + 70, site.origin[1] + 45))
    QApplication.processEvents()
    blue = spots(canvas, BLUE)
    assert np.hypot(*(blue.mean(axis=0) - expected(canvas, site, 60, 50))) < 4.0


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_on_a_dense_screen_robots_have_the_same_size_and_place(canvas, site, ratio):
    overlay = show(canvas, site, Scene(arrays((60, 50, 0.0, RobotState.FRESH)), [0.0]))
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
    show(canvas, site, Scene(arrays((60, 50, 0.0, RobotState.FRESH)), [0.0], selected="r1"))
    ring = spots(canvas, SELECTED) - expected(canvas, site, 60, 50)
    assert len(ring) > 60
    assert np.hypot(*ring.T) == pytest.approx(18.0, abs=2.0)


def test_a_trail_fades_with_age(canvas, site):
    way = np.array([(10.0 + i, 20.0, 89.0 - i) for i in range(90)])
    show(canvas, site, Scene(arrays(), [], trails=[way]))
    image = canvas.grab().toImage()

    def colour(x):
        at = expected(canvas, site, x, 20.0)
        return QColor(image.pixel(round(at[0]), round(at[1])))

    new, middle, old = colour(97), colour(55), colour(13)
    assert abs(new.red() - TRAIL.red()) < 30
    assert new.red() < middle.red() < old.red()


def test_a_cone_target_stands_on_its_spot(canvas, site):
    from fleet_supervisor.plugin.desk.colours import CONE as ORANGE

    show(canvas, site, Scene(arrays(), [], targets=[Target("r1", (40.0, 70.0), True)]))
    foot = expected(canvas, site, 40, 70)
    orange = spots(canvas, ORANGE) - foot
    assert len(orange) > 40
    assert abs(orange[:, 0].mean()) < 1.5
    assert -22 < orange[:, 1].min() < -15
    assert orange[:, 1].max() < 3


def test_a_draft_is_painted_and_a_refused_one_is_red(canvas, site):
    from fleet_supervisor.plugin.desk.colours import REFUSED
    from fleet_supervisor.plugin.desk.drafts import Findings

    draft = Draft("r1", CONE, ((40.0, 70.0),), Findings(refused=("outside",)))
    show(canvas, site, Scene(arrays((60, 50, 0.0, RobotState.FRESH)), [0.0], draft=draft))
    assert len(spots(canvas, REFUSED)) > 30


def test_the_robot_under_the_mouse_is_found(canvas, site):
    overlay = show(
        canvas, site, Scene(arrays((60, 50, 0, RobotState.FRESH), (70, 50, 0, RobotState.LOST)), [0, 40])
    )
    assert overlay.robot_at(*expected(canvas, site, 70, 50)) == "r2"
    x, y = expected(canvas, site, 70, 50)
    assert overlay.robot_at(x, y + 30) is None


def test_a_site_crs_that_qgis_does_not_know_is_named(site):
    with pytest.raises(PlacementError, match="EPSG:999999"):
        Placement(
            dataclasses.replace(site, crs="EPSG:999999"),
            QgsCoordinateReferenceSystem("EPSG:4326"),
            QgsProject.instance().transformContext(),
        )


def test_a_position_beyond_the_map_projection_is_an_error_in_words(site):
    placement = Placement(
        site, QgsCoordinateReferenceSystem("EPSG:3857"), QgsProject.instance().transformContext()
    )
    with pytest.raises(PlacementError, match="Choose the site's CRS"):
        placement.to_map(np.array([(1e12, 1e12)]))


def test_points_come_back_from_every_crs(site):
    site = dataclasses.replace(site, rotation=-0.9)
    for crs in ("EPSG:32633", "EPSG:3857", "EPSG:4326", "EPSG:23700"):
        placement = Placement(
            site, QgsCoordinateReferenceSystem(crs), QgsProject.instance().transformContext()
        )
        ((x, y),) = placement.to_map(np.array([(12.5, 80.25)]))
        assert placement.to_site(QgsPointXY(x, y)) == pytest.approx((12.5, 80.25), abs=0.002)


def test_a_thousand_robots_with_trails_are_painted_within_a_frame(canvas, site):
    rng = np.random.default_rng(1)
    robots = arrays(*[(x, y, t, RobotState.FRESH) for x, y, t in rng.uniform(0, 100, (1000, 3))])
    scene = Scene(robots, [0.0] * 1000)
    overlay = show(canvas, site, scene)
    image = QImage(600, 500, QImage.Format.Format_ARGB32_Premultiplied)
    painter = QPainter(image)
    overlay.paint(painter)
    began = time.perf_counter()
    for _ in range(5):
        overlay.paint(painter)
    took = (time.perf_counter() - began) / 5
    painter.end()
    assert took < 0.1
